"""Demands as terms of a solver, beside the kit's own reading of them, scan by scan."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from typing import Any

import pytest
import z3

from modeproof.ground.errors import Unjudged
from modeproof.kit.demands import Demands, Watch, read_demands
from modeproof.kit.signals import read_signals
from programs.demands.expressions import Evaluation, Items, Text
from programs.demands.observer import Observer
from programs.demands.subject import plain_value

INPUTS = read_signals(
    {
        "ON": {"type": "bool"},
        "KEY": {"type": "bool"},
        "W": {"type": "word"},
        "level": {"type": "mode", "modes": [0, 1, 2, 3, 4]},
        "touch": {"type": "text", "values": ["", "up", "down"]},
    },
    "toy",
)
OUTPUTS = read_signals(
    {
        "LAMP": {"type": "bool"},
        "shown": {"type": "modes", "modes": [0, 1, 2, 3, 4]},
        "screen": {"type": "word"},
    },
    "toy",
)
PARAMETERS: dict[str, dict[str, Any]] = {
    "T_ms": {"type": "ms", "default": 20},
    "PERMITS_0": {"type": "modes", "default": [0, 1]},
    "PERMITS_1": {"type": "modes", "default": []},
}
RULES: list[dict[str, Any]] = [
    {"name": "chosen", "kind": "value", "is": "index(CODES, W) if ON else -1"},
    {"name": "permits", "kind": "value", "is": "[PERMITS_0, PERMITS_1][level] if 0 <= level < 2 else []"},
    {"name": "chosens", "kind": "recent", "is": "chosen"},
    {"name": "touches", "kind": "recent", "is": "touch"},
    {"name": "words", "kind": "recent", "is": "W"},
    {"name": "keys", "kind": "recent", "is": "KEY and not was_KEY"},
    {"name": "seen", "kind": "memory", "starts": False, "is": "ON and (seen or chosen >= 0 or later > 2)"},
    {"name": "on_ms", "kind": "memory", "starts": 0, "is": "min(on_ms + dt_ms, T_ms + T_ms) if ON else 0"},
    {"name": "later", "kind": "memory", "starts": 0, "is": "count(ON, KEY, seen) + sum([later, -later])"},
    {
        "name": "stages",
        "kind": "memory",
        "starts": [-1, -1],
        "is": "[stages[1], level if KEY else stages[1]]",
    },
]
ASKED = {
    "Once": ("LAMP and not was_LAMP", "seen and True in keys"),
    "Word": ("screen != 0", "screen in words or screen - 1 == 3"),
    "Text": ("touch == 'up' or was_touch != ''", "'down' not in touches or max(chosens) >= 1"),
    "Level": ("level in permits", "shown == [level] or len(shown) == 0"),
    "Time": ("on_ms >= T_ms and len(keys) > latency", "LAMP or min(chosens) < 0 and not max(keys)"),
    "Stage": ("stages[0] != stages[1]", "KEY != was_KEY or shown == was_shown"),
    "Most": ("shown != []", "max(shown) < 4"),
    "Oldest": ("True", "chosens[0] != 1 or W >= 16 and W < 600 and not level > was_level"),
}
COMES = {"Lit": ("ON and seen", "LAMP"), "Dark": ("not ON", "not LAMP and shown == []")}


def demands() -> Demands:
    """Demands of a toy that use all that an expression may have."""
    rows = [
        {"id": id, "says": id, "clauses": ["TOY-1"], "when": when, asked: holds}
        for asked, table in (("holds", ASKED), ("comes", COMES))
        for id, (when, holds) in table.items()
    ]
    table = {"constants": {"CODES": [16, 255]}, "rules": RULES, "demands": rows}
    return read_demands(table, INPUTS, OUTPUTS, PARAMETERS, "toy")


def wires() -> dict[str, Any]:
    """Symbols of all wires."""
    modes = Items(tuple((z3.Bool(f"shown {mode}"), mode) for mode in range(5)))
    texts = ("", "up", "down")
    words = {name: z3.BitVec(name, 16) for name in ("W", "screen")}
    bools = {name: z3.Bool(name) for name in ("ON", "KEY", "LAMP")}
    return {**bools, **words, "level": z3.Int("level"), "touch": Text(z3.Int("touch"), texts), "shown": modes}


def steady() -> dict[str, Any]:
    """Symbols of the parameters."""
    sets = {
        name: Items(tuple((z3.Bool(f"{name} {mode}"), mode) for mode in range(5)))
        for name in ("PERMITS_0", "PERMITS_1")
    }
    return {"T_ms": z3.Int("T_ms"), **sets}


def random_scans(seed: int, count: int) -> Iterator[tuple[int, dict[str, Any], dict[str, Any]]]:
    """Scans with values of the wire."""
    values = random.Random(seed)
    for _ in range(count):
        inputs = {
            "ON": values.random() < 0.7,
            "KEY": values.random() < 0.5,
            "W": values.choice(["0000", "0010", "00FF", "0004"]),
            "level": values.choice([None, 0, 1, 4]),
            "touch": values.choice([None, "up", "down"]),
        }
        outputs = {
            "LAMP": values.random() < 0.5,
            "shown": values.choice([[], [0], [1], [0, 4]]),
            "screen": values.choice(["0000", "0010", "0004"]),
        }
        yield values.choice([0, 1, 15, 30]), inputs, outputs


@pytest.mark.parametrize("latency", [0, 1, 3])
def test_plain_values_break_what_the_kit_says(latency: int) -> None:
    found, broken = demands(), set()
    for seed in range(8):
        watches = {row.id: Watch(found, latency) for row in found.rows}
        for id, watch in watches.items():
            watch.judged = tuple(row for row in found.rows if row.id == id)
        observer = Observer(found, found.rows, wires(), steady(), latency)
        given = {name: row["default"] for name, row in PARAMETERS.items()}
        fixed = {
            name: plain_value(read_signals({name: row | {"modes": [0, 1, 2, 3, 4]}}, "")[name], given[name])
            for name, row in PARAMETERS.items()
        }
        memory: Mapping[str, Any] = start_of(observer)
        for dt_ms, inputs, outputs in random_scans(seed, 60):
            signals = {**INPUTS, **OUTPUTS}
            seen = {name: plain_value(signals[name], value) for name, value in {**inputs, **outputs}.items()}
            said = observer.plain(seen, fixed, memory, dt_ms)
            memory = said.after
            for id, watch in watches.items():
                assert bool(said.broken[id]) == (watch.scan(dt_ms, inputs, outputs) is not None), id
                broken |= {id} if said.broken[id] else set()
    assert broken == {*ASKED, *COMES}


def start_of(observer: Observer) -> dict[str, Any]:
    """What it remembers at power-up."""
    return {
        name: z3.is_true(first) if z3.is_bool(first) else first.as_long()
        for name, (_, first) in observer.state.items()
    }


@pytest.mark.parametrize("latency", [0, 1, 2])
def test_terms_give_what_plain_values_give(latency: int) -> None:
    found = demands()
    observer = Observer(found, found.rows, wires(), steady(), latency)
    terms = observer.terms(wires(), z3.Int("dt_ms"))
    given = {"T_ms": 20, "PERMITS_0": [0, 1], "PERMITS_1": [4]}
    signals = {**INPUTS, **OUTPUTS} | read_signals(
        {name: row | {"modes": [0, 1, 2, 3, 4]} for name, row in PARAMETERS.items()}, ""
    )
    fixed = {name: plain_value(signals[name], value) for name, value in given.items()}
    memory: Mapping[str, Any] = start_of(observer)
    for dt_ms, inputs, outputs in random_scans(5, 25):
        seen = {name: plain_value(signals[name], value) for name, value in {**inputs, **outputs}.items()}
        where = [(z3.Int("dt_ms"), z3.IntVal(dt_ms))]
        for name, symbol in {**wires(), **steady()}.items():
            where += list(pairs(symbol, {**seen, **fixed}[name]))
        where += [(symbol, constant(symbol, memory[name])) for name, (symbol, _) in observer.state.items()]
        said = observer.plain(seen, fixed, memory, dt_ms)
        for table, plain in (
            (terms.after, said.after),
            (terms.broken, said.broken),
            (terms.asked, said.asked),
        ):
            for name, term in table.items():
                value = z3.simplify(z3.substitute(term, *where))
                assert value.eq(z3.simplify(constant(term, plain[name]))), name
        memory = said.after


def pairs(symbol: Any, value: Any) -> Iterator[tuple[Any, Any]]:
    """The single symbols of a wire with their values."""
    if isinstance(symbol, Items):
        for (there, _), (is_there, _) in zip(symbol.entries, value.entries, strict=True):
            yield there, z3.BoolVal(is_there)
    elif isinstance(symbol, Text):
        yield symbol.term, z3.IntVal(value.term)
    else:
        yield symbol, constant(symbol, value)


def constant(term: Any, value: Any) -> Any:
    """A plain value in the sort of a term."""
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), 16) if z3.is_bv(term) else z3.IntVal(int(value))


def test_an_index_outside_a_list_is_told() -> None:
    at = Evaluation({"values": Items.of([1, 2]), "n": z3.Int("n")})
    assert at.value("values[n] if 0 <= n else 0", "toy") is not None
    solver = z3.Solver()
    solver.add(at.wrong[0], z3.Int("n") < 2)
    assert len(at.wrong) == 1 and solver.check() == z3.unsat


def test_an_expression_that_cannot_be_a_term_is_refused() -> None:
    with pytest.raises(Unjudged, match="toy: `in` needs a list: 1 in n"):
        Evaluation({"n": z3.Int("n")}).value("1 in n", "toy")

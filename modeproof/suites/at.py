"""Graphs of a target at other parameters than the OPEN runs have: with longer ticks, or by TLC anew.

A specification counts time in ticks. How long a tick is, it does not say: a graph with a deadline of 2 ticks
is that of a program with 200 ms in scans of 100 ms, and of one with 66 s in scans of 33 s. So the same graph
does for all parameters whose times are in the same proportion. That does not go where a tick is one
millisecond: such a specification may name lengths in milliseconds. For other proportions, and for other
choices, TLC makes a graph, with the constants that replay.toml gives for the parameters.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, product
from math import gcd
from pathlib import Path
from typing import Any

import msgspec

from modeproof.graph.device import DeviceGraph, graph_file, load_device_graph, open_runs, read_device_graph
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meanings
from modeproof.ground.places import build
from modeproof.kit.signals import read_signals
from modeproof.registers.cfg import Constant, parse_cfg
from modeproof.registers.load import load_interface
from modeproof.registers.made import cfg_text
from modeproof.registers.replay import load_targets
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run
from modeproof.suites.demands import declare_parameters
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import find_toolchain

MOST_TICKS = 16
"""So many ticks may the longest time of a graph have that is made for given parameters: its size grows with
it."""
_PARAMETER = re.compile(r"\$([a-z][a-z0-9_]*)\.(\w+)")
Params = Mapping[str, Any]


def scaled(device: DeviceGraph, factor: Fraction | int) -> DeviceGraph:
    """The same graph with all times `factor` times as long, which must be whole milliseconds then."""
    times = {name: int(value * factor) for name, value in _times(device.device, device.params).items()}
    params = {**device.params, **times}
    alphabet = tuple({**letter, "dt_ms": int(letter["dt_ms"] * factor)} for letter in device.alphabet)
    return replace(device, alphabet=alphabet, params=params)


def tick_of(device: DeviceGraph) -> int:
    """The length in ms of which all times of a graph and of its parameters are multiples; 0 without times."""
    return gcd(
        *{letter["dt_ms"] for letter in device.alphabet}, *_times(device.device, device.params).values()
    )


def scalable(device: DeviceGraph) -> bool:
    """Whether the graph is that of other lengths of a tick too: not where the model counts in ms."""
    return device.tick_ms > 1


def _times(device: Device, params: Params) -> dict[str, int]:
    """The times, those that are left out with their defaults."""
    given = whole(device, params)
    return {name: value for name, value in given.items() if device.parameters[name].type == "ms"}


def whole(device: Device, params: Params) -> dict[str, Any]:
    """All parameters: those that are given, and the defaults of the others."""
    wanted = {name: of.default for name, of in device.parameters.items() if of.type != "function"}
    return {**wanted, **params}


def check_params(device: Device, modes: Sequence[int], params: Params) -> None:
    """Raises Unjudged for a parameter that the target does not have, or a value that it cannot have."""
    signals = read_signals(declare_parameters(device, list(modes)), device.id)
    for name, value in params.items():
        if name not in signals:
            raise Unjudged(f"{device.id} has no parameter {name!r}; {suggestion(name, signals)}")
        if fault := signals[name].fault(value):
            raise Unjudged(fault)


def graph_at(place: Path, document: str, target: str, params: Params, tick_ms: int = 0) -> DeviceGraph:
    """The graph of a target with these parameters (the others have their defaults), by TLC where none is
    there.

    `tick_ms` is the length of a tick where TLC is needed; 0 leaves it open. Raises Unjudged for parameters
    that do not fit the target, for times of which the longest would have more than `MOST_TICKS` ticks, and
    where the specification refuses them.
    """
    runs = open_runs(place, document, target)
    if not runs:
        raise Unjudged(f"{document}: no OPEN run prints a graph of {target}")
    interface = load_interface(place, document)
    device = interface.devices[target]
    check_params(device, [int(mode) for mode in interface.constants.get("MODES", ())], params)
    wanted = whole(device, params)
    for run in runs:
        if (factor := _factor(device, run, wanted)) is not None:
            graph = load_device_graph(place, run)
            if factor == 1 or (scalable(graph) and (tick_of(graph) * factor).denominator == 1):
                return replace(scaled(graph, factor), params=wanted)
    base = min(runs, key=lambda run: _unlike(device, run, wanted))
    assert base.graph is not None, "an OPEN run"
    times = [abs(value) for value in _times(device, wanted).values()]
    tick = 1 if base.graph.tick_ms == 1 else tick_ms or gcd(*times) or base.graph.tick_ms
    if not tick_ms and tick == max(times, default=0):  # a time of one tick would never come in two scans
        tick //= next((ticks for ticks in range(2, MOST_TICKS + 1) if tick % ticks == 0), 1)
    most = MOST_TICKS * (MOST_TICKS if tick == 1 else 1)
    if (longest := max(times, default=0)) > tick * most:
        raise Unjudged(
            f"{target}: with these parameters the longest time, {longest:,} ms, has "
            f"{longest // tick:,} ticks of "
            f"{tick:,} ms, and at most {most} can be judged; give times with a larger common "
            f"measure, or judge a "
            "log of the program with `modeproof trace`, which takes any times"
        )
    return _by_tlc(place, base, device, wanted, tick)


def _factor(device: Device, run: Run, wanted: Params) -> Fraction | None:
    """How many times as long all times are as those of a run that is otherwise the same; None where none
    is."""
    assert run.graph is not None, "an OPEN run"
    factors = set()
    for name, value in whole(device, run.graph.params).items():
        if device.parameters[name].type == "ms" and value > 0 < wanted[name]:
            factors.add(Fraction(wanted[name], value))
        elif value != wanted[name]:
            return None
    return None if len(factors) > 1 else next(iter(factors), Fraction(1))


def _unlike(device: Device, run: Run, wanted: Params) -> int:
    """How far a run is from these parameters; a time counts most, for the inputs of the graph may fit it."""
    assert run.graph is not None, "an OPEN run"
    have = whole(device, run.graph.params)
    return sum(
        1 + (device.parameters[name].type == "ms") for name, value in have.items() if value != wanted[name]
    )


def _by_tlc(place: Path, base: Run, device: Device, wanted: Params, tick_ms: int) -> DeviceGraph:
    """Let TLC make the graph, unless it is there already. Raises Unjudged where TLC does not hold."""
    assert base.graph is not None, "an OPEN run"
    cfg = parse_cfg(cfg_text(place, base), base.name)
    constants = _constants(place, base.document, device, wanted, tick_ms, cfg.constants)
    named = {name: Constant(f"At_{name}", True) for name in constants}
    body = "".join(f"At_{name} == {text}\n" for name, text in constants.items())
    shared = set.intersection(*(set(run.properties) for run in open_runs(place, base.document, device.id)))
    text = replace(
        cfg,
        constants={**cfg.constants, **named},
        invariants=tuple(name for name in cfg.invariants if name in shared),
        properties=tuple(name for name in cfg.properties if name in shared),
    ).text()
    modules = [path for of in (base.document, "common") for path in (place / "spec" / of).glob("*.tla")]
    said = f"{body}{text}{sorted(meanings(place, modules).items())}"
    name = f"{base.id}_at_{hashlib.sha256(said.encode()).hexdigest()[:10]}"
    graph = msgspec.structs.replace(base.graph, params=dict(wanted), tick_ms=tick_ms, states=None, edges=None)
    run = msgspec.structs.replace(
        base, id=name, module=name, cfg=f"{name}.cfg", base="", reading=(), constants={}, graph=graph
    )
    if not graph_file(place, run).is_file():
        folder = build(place) / "tlc" / base.document / "made" / name
        root = base.id if base.base and base.readings else base.module
        module = f"---- MODULE {name} ----\nEXTENDS {root}\n{body}====\n"
        write_whole(folder / f"{name}.tla", module.encode())
        write_whole(folder / f"{name}.cfg", text.encode())
        outcome = run_tlc(place, run, find_toolchain(), made_in=folder)
        if outcome.status != 0 or outcome.log.errors or not outcome.log.success:
            graph_file(place, run).unlink(missing_ok=True)
            words = [text for _, text in outcome.log.errors][:1] or [outcome.stderr or str(outcome.status)]
            raise Unjudged(
                f"{device.id}: no graph with {_shown(device, wanted)}: the specification refuses these "
                f"parameters, or TLC failed: {' '.join(words[0].split())[:200]}"
            )
    return read_device_graph(place, run)  # its name holds a hash of every text that it rests on


def _constants(
    place: Path, document: str, device: Device, wanted: Params, tick_ms: int, known: Container[str]
) -> dict[str, str]:
    """What replay.toml gives for each constant that a parameter of the device sets, with times in ticks.

    Raises Unjudged where a parameter sets none of the constants of the model.
    """
    texts: Mapping[str, str] = load_targets(place, document).get(device.id, {}).get("constants", {})
    found: dict[str, str] = {}
    set_by: set[str] = set()
    for constant, text in texts.items():
        names = _PARAMETER.findall(text)
        if constant in known and any(group == device.id for group, _ in names):
            set_by.update(name for _, name in names)
            found[constant] = _PARAMETER.sub(
                lambda match: _tla(
                    wanted[match[2]] // tick_ms
                    if device.parameters[match[2]].type == "ms"
                    else wanted[match[2]]
                ),
                text,
            )
    for name in wanted:
        if name not in set_by:
            raise Unjudged(
                f"spec/{document}/replay.toml: no constant of the model is set by {device.id}.{name}"
            )
    return found


def _tla(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, list | tuple):
        return "{" + ", ".join(map(_tla, value)) + "}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _shown(device: Device, params: Params) -> str:
    given = [f"{name}={value}" for name, value in params.items() if value != device.parameters[name].default]
    return ", ".join(given) or "the defaults"


def every_pair(
    place: Path, document: str, graphs: Sequence[DeviceGraph], on_trouble: Callable[[str], None]
) -> list[DeviceGraph]:
    """Graphs so that each value of each parameter is there with each value of each other one.

    Values are those of `graphs`, all choices that interface.toml declares, and each time one tick longer than
    in the first graph; sets of modes go together. The defaults are there too. What the specification refuses
    is left out, with a line.
    """
    first, device = graphs[0], graphs[0].device
    names = [name for name, of in device.parameters.items() if of.type != "function"]
    have = [whole(device, graph.params) for graph in graphs]
    values: dict[str, list[Any]] = {}
    for name in names:
        of, known = device.parameters[name], [row[name] for row in have]
        if of.type == "ms":
            known = [*known, have[0][name] + tick_of(first), *([0] if of.minimum == 0 else [])]
        more = [False, True] if of.type == "bool" else list(of.values)
        values[name] = [value for n, value in enumerate(known + more) if value not in (known + more)[:n]]
    modes = [name for name in names if device.parameters[name].type == "modes"]
    rows = list(have)
    if whole(device, {}) not in rows:
        rows.append(whole(device, {}))
    left = [pair for pair in _pairs(names, values, modes) if not any(_in(pair, row) for row in rows)]
    while left:
        row = dict(have[0])
        taken: set[str] = set()
        for pair in left:
            if all(name not in taken or row[name] == value for name, value in pair.items()):
                row.update(pair)
                taken.update(pair)
        rows.append(row)
        left = [pair for pair in left if not _in(pair, row)]
    found = []
    for row in rows[len(have) :]:
        try:
            found.append(graph_at(place, document, device.id, row, tick_of(first)))
        except Unjudged as error:
            on_trouble(f"left out: {error}")
    return found


def _pairs(names: list[str], values: Mapping[str, list[Any]], modes: list[str]) -> list[dict[str, Any]]:
    """Each value with each; the sets of modes that levels permit go together, as they are in one graph."""
    groups = [[name] for name in names if name not in modes] + ([modes] if modes else [])
    rows = []
    for group in groups:
        most = max(len(values[name]) for name in group)
        rows.append(
            [{name: values[name][min(n, len(values[name]) - 1)] for name in group} for n in range(most)]
        )
    return [{**a, **b} for one, other in combinations(rows, 2) for a, b in product(one, other)]


def _in(pair: Params, row: Params) -> bool:
    return all(row[name] == value for name, value in pair.items())

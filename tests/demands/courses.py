"""What happens on the wires of the devices of the note: as it says, or with one thing that goes wrong."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from typing import Any

from tests.demands.fplc_programs import CH, RE, SE, SW

Wires = tuple[int, dict[str, Any]]
HOLD = 56
"""Scans for which inputs stay, with a latency of 1: more than a procedure of 24 rows may take."""


def fplc(LA: bool = False, outputs: Sequence[int] = (), MW03: int = 0, MW07: int = 0) -> dict[str, Any]:
    """What the F-PLC reads in one scan."""
    set_ = {name: n in outputs for n, name in enumerate(("A", "B", "C", "D", "STR"))}
    return {"LA": LA, **set_, "MW03": f"{MW03:04X}", "MW07": f"{MW07:04X}"}


def plc(MW01: int = 0, MW05: int = 0, SelectMSO: int = 0, SwitchMSO: int = 0) -> dict[str, Any]:
    """What the PLC reads in one scan."""
    words = {"MW01": MW01, "MW05": MW05, "SelectMSO": SelectMSO, "SwitchMSO": SwitchMSO}
    return {name: f"{word:04X}" for name, word in words.items()}


def hmi(ReadAuthorization: int = 0, CheckMSO: int = 0, touch: str = "", active: int = 3) -> dict[str, Any]:
    """What the panel reads in one scan."""
    words = {"ReadAuthorization": f"{ReadAuthorization:04X}", "CheckMSO": f"{CheckMSO:04X}"}
    return {**words, "ActiveMSO": active, "touch": touch}


def _held(scans: int, *inputs: dict[str, Any]) -> list[Wires]:
    return [(10, one) for one in inputs for _ in range(scans)]


REST = [(200, fplc())] * 26


def pulse(*last: dict[str, Any]) -> list[Wires]:
    """A key is put in; in the end of its test pulse comes what is given, instead of none."""
    parts = [fplc(True), fplc(True, range(5)), fplc(True)][: 3 - len(last)]
    return [*REST, *_held(14, *parts), *_held(HOLD * 3 if last else 0, *last)]


def insertion(level: int, mode: int, other: int = 0, answer: int = 0) -> list[Wires]:
    """A key, its selection and its acknowledgment, or the words that are given; then it is taken out."""
    key, word, reply = (True, [level]), other or SE[mode], answer or SW[mode]
    return [
        *pulse(),
        *_held(20, fplc(*key)),
        *_held(HOLD, fplc(*key, word), fplc(*key, word, reply), fplc(*key), fplc()),
    ]


BEFORE_WORDS = len(REST) + 3 * 14 + 20


def fplc_courses() -> dict[str, list[Wires]]:
    """What the F-PLC meets, by name."""
    modes = [(0, 0), (1, 1), (2, 2), (3, 1), (3, 3), (4, 0), (4, 4)]
    answers = [(1, 0), (2, 1), (2, 3), (0, 4), (4, 3)]
    started, selected = insertion(2, 1)[:BEFORE_WORDS], insertion(2, 1)[: BEFORE_WORDS + HOLD]
    two = fplc(True, [1, 2])
    return {
        **{f"level {level}, mode {mode}": insertion(level, mode) for level, mode in modes},
        "a selection that is no code": insertion(4, 0, other=1),
        **{f"mode {mode} above the level": insertion(mode - 1, mode) for mode in (1, 4)},
        "an acknowledgment that is no code": insertion(4, 2, answer=1),
        **{
            f"mode {mode}, {other} acknowledged": insertion(4, mode, answer=SW[other])
            for mode, other in answers
        },
        "no ones": [*REST, *_held(HOLD * 3, fplc(True)), *insertion(3, 2)],
        "ones that stay": pulse(fplc(True, range(5))),
        "no output after the pulse": [*pulse()[:-14], *_held(HOLD * 3, fplc(True))],
        "an output without a pulse": [*REST, *_held(14, fplc(True)), *_held(HOLD, fplc(True, [2]))],
        "two outputs": [*started, *_held(HOLD, two)],
        "two outputs later": [*selected, *_held(HOLD, two)],
        "pulled before the selection": [*started, *_held(HOLD, fplc(False, [], SE[1], SW[1]))],
        "pulled before the acknowledgment": [*selected, *_held(HOLD, fplc(False, [], SE[1], SW[1]))],
        "LA goes, the output stays": [*selected, *_held(HOLD, fplc(False, [2], SE[1], SW[1]))],
        "pulled at once after the pulse": [*pulse(), *_held(1, fplc(True, [2])), *_held(HOLD, fplc())],
    }


def plc_courses() -> dict[str, list[Wires]]:
    """What the PLC meets, by name."""

    def one(level: int, selection: int, echo: int, reply: int) -> list[Wires]:
        given = plc(level, echo, selection), plc(level, echo, selection, reply)
        return _held(40, plc(), plc(level), plc(level, 0, selection), *given, plc())

    modes = {f"mode {mode}": one(RE[4], SE[mode], CH[mode], SW[mode]) for mode in range(5)}
    return {**modes, "no codes": one(1, 2, 3, 4)}


def hmi_courses() -> dict[str, list[Wires]]:
    """What the panel meets, by name."""

    def one(level: int, mode: int, touch: int = -1, echo: int = -1, answer: str = "confirm") -> list[Wires]:
        field, code = f"select:{mode if touch < 0 else touch}", CH[mode if echo < 0 else echo]
        opened = hmi(), hmi(RE[level]), hmi(RE[level], 0, field), hmi(RE[level])
        asked = hmi(RE[level], code), hmi(RE[level], code, answer), hmi(RE[level]), hmi()
        return _held(30, *opened, *asked)

    return {
        **{
            f"level {level}, mode {mode}": one(level, mode) for level in range(5) for mode in range(level + 1)
        },
        "rejected": one(2, 1, answer="reject"),
        "a closed field": one(2, 1, touch=4),
        "another echo": one(4, 1, echo=2),
        "pulled before the end": [*one(4, 1)[: 30 * 6], *_held(30, hmi(0, CH[1]), hmi())],
        "pulled after the touch": [
            *_held(30, hmi(), hmi(RE[4])),
            *_held(1, hmi(RE[4], 0, "select:1")),
            *_held(30, hmi()),
        ],
    }


def disturbed(seed: int, parts: Sequence[Wires], scans: int) -> Iterator[Wires]:
    """A course in which single inputs change at any moment, and parts are long or short."""
    dice = random.Random(seed)
    changes = [parts[n] for n in range(len(parts)) if n == 0 or parts[n][1] != parts[n - 1][1]]
    values = {name: [one[name] for _, one in changes] for name in changes[0][1]}
    for name, seen in values.items():
        if isinstance(seen[0], str) and name not in ("touch",):
            seen += ["0001", "0FF0", "33CC"]
    at, inputs = 0, dict(changes[0][1])
    while scans > 0:
        if dice.random() < 0.7:
            at = (at + 1) % len(changes)
            inputs = dict(changes[at][1])
        else:
            name = dice.choice(list(inputs))
            inputs[name] = dice.choice(values[name])
        for _ in range(dice.choice([1, 1, 2, 3, 14, 20, HOLD, HOLD])):
            scans -= 1
            yield dice.choice([0, 10, 10, 10, 200 if at == 0 else 5]), dict(inputs)

"""From a demand to the contactors: the page's table is that of the properties, and its times do occur."""

from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from machines.concrete_runs import Rule, Scan, rule_of
from machines.verdicts import Machine
from refimpl.machine_cell import cell as reference

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
SAFETY = {row["id"]: row for row in tomllib.loads((FOLDER / "safety.toml").read_text("utf-8"))["property"]}
PAGE = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
SAME = "same scan"
IN_THE_TEST = [{"BeamTest": True}, {"BeamTest": False, "S_BeamFree": False}, *[{}] * 30]
NO_PICK_UP: list[Mapping[str, Any]] = [
    {"Stop": False, "scans": 1},
    {"Stop": True},
    {},
    {"Start": True},
    *[{"Start": False, "S_Contactor1": True}] * 50,
]
WELDED = [{"Stop": False, "S_Contactor1": False}, *[{"S_Contactor1": False}] * 50]
DEMANDS: Mapping[str, tuple[Sequence[Mapping[str, Any]], Sequence[int]]] = {
    "beam-stops": (IN_THE_TEST, [10, 5, 50, 49]),
    "beam-stops-manual": (IN_THE_TEST, [10, 5, 50, 49]),
    "missed-pick-up-is-found": (NO_PICK_UP, [10, 10, 10, 10, 50, 50, 50, 49]),
    "contactor-fault-stops": (NO_PICK_UP, [10, 10, 10, 10, 50, 50, 50, 49]),
    "welded-is-found": (WELDED, [10, 50, 50, 50, 49]),
}
"""What happens after a start, and the scan times in ms that make the answer late; then 50 each."""


def rows() -> list[list[str]]:
    part = PAGE.partition("## How fast")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| (.*) \|$", part, re.MULTILINE)[1:]
    return [line.split(" | ") for line in lines]


def machine() -> Machine:
    text = (FOLDER / "wiring.toml").read_text("utf-8")
    return Machine(
        text, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml", triggers=[[]] * len(SAFETY)
    )


def demanded(shipped: Machine, id: str, times: Sequence[int], last: int) -> list[Scan]:
    """A start in the mode of the demand, then the demand, with these scan times and then `last`."""
    runner = shipped.runner
    mode = "choose manual" if "manual" in id else "choose automatic"
    before = [row for name in (mode, "begin") for row in runner.stories()[name]]
    rows, given = DEMANDS[id][0], itertools.chain([10] * len(before), times, itertools.repeat(last))
    inputs = {name: kind == "WORD" and 0 for name, kind in runner.cell.inputs.items()} | dict(runner.use.rest)
    state, values, scans = reference.power_up(runner.cell), dict[str, Any](), list[Scan]()
    for row, dt_ms in zip([*before, *rows], given, strict=False):
        inputs = inputs | {name: source(values) for name, source in runner.follows.items() if values}
        inputs |= {name: value for name, value in row.items() if name != "scans"}
        state, _ = reference.step(runner.cell, state, inputs, dt_ms)
        values = reference.values_after(runner.cell, state, inputs)
        scans.append((dt_ms, inputs))
    return scans


def within(shipped: Machine, id: str, within_ms: int) -> Rule:
    return rule_of({**SAFETY[id], "within_ms": within_ms}, [], shipped.runner.named)


def longest(shipped: Machine, id: str, scans: Sequence[Scan]) -> int:
    """How long the demand waits in these scans, in ms."""
    rule = within(shipped, id, 10_000)
    memory, waited = rule.start(), 0
    for (dt_ms, _), values in zip(scans, shipped.runner.replayed(scans), strict=True):
        _, memory = rule.after(memory, values, dt_ms)
        waited = max(waited, memory[1])
    assert not memory[0]
    return waited


def test_the_page_says_how_fast_as_the_properties_do() -> None:
    told = {id: row for row in rows() for id in re.findall("`(.*?)`", row[2])}
    assert len(rows()) > 9
    assert {id for id, row in SAFETY.items() if "within_ms" in row} <= set(told)
    for id, (_, _, _, usual, worst) in told.items():
        assert id in SAFETY
        if "within_ms" in SAFETY[id]:
            assert worst.startswith(f"{SAFETY[id]['within_ms']} ms")
        else:
            assert (usual, worst) == (SAME, SAME)
            assert "never" in SAFETY[id] or "only_if" in SAFETY[id]


def test_the_page_names_every_property() -> None:
    part = PAGE.partition("## What is proved")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| .* \| (.*) \|$", part, re.MULTILINE)
    assert {id for line in lines for id in re.findall("`(.*?)`", line)} == set(SAFETY)


@pytest.mark.parametrize("id", DEMANDS)
def test_the_time_on_the_page_does_occur(id: str) -> None:
    shipped = machine()
    row = next(row for row in rows() if f"`{id}`" in row[2])
    scans = demanded(shipped, id, DEMANDS[id][1], 50)
    occurs = longest(shipped, id, scans)
    assert row[4] == f"{SAFETY[id]['within_ms']} ms; {occurs} ms occur"
    assert shipped.runner.broken(scans, within(shipped, id, occurs - 1)) is not None
    assert shipped.runner.broken(scans, within(shipped, id, occurs)) is None
    usual = longest(shipped, id, demanded(shipped, id, [], 10))
    assert row[3] == f"{usual // 10} scans, {usual} ms"


def test_a_key_that_is_pulled_does_not_stop_the_drive() -> None:
    runner = machine().runner
    scans = demanded(machine(), "welded-is-found", [], 10)[: -len(WELDED)]
    pulled = [*scans, *[(10, {**scans[-1][1], "LA": False, "STR": False})] * 40]
    values = list(runner.replayed(pulled))
    assert values[-1]["S_DriveEnable"]
    assert values[-1]["automatic"]
    assert "| the key is pulled | all | none |" in PAGE

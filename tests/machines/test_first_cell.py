"""Our first machine cell: hazards that 42 properties did not see are refuted; the cell of today has none."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import pytest

from machines.concrete_runs import Scan, rule_of
from machines.machine_command import rows_of_trace
from machines.verdicts import Machine
from refimpl.machine_cell.expression import Value

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
FIRST, TODAY = ROOT / "examples/machines/first_cell.toml", FOLDER / "wiring.toml"
PAGE = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")

Rows = Sequence[Mapping[str, Value]]
HELD = {"S_Enable1": True, "S_Enable2": False, "S_Enable3": True}
LET_GO = {"S_Enable1": False, "S_Enable2": True, "S_Enable3": False}
MOVES = {"S_Standstill": False, "S_Contactor1": False, "S_Contactor2": False}
OPEN = {"S_GuardClosed": False, "S_GuardBolt": False}
RESET = {"Reset": True}
START: Rows = ({"Reset": False, **HELD}, {"Start": True})
HAZARDS: Mapping[str, tuple[str, Rows]] = {
    "reaching-is-slow": ("choose setup", ({"ResetGuard": True, **RESET, "S_BeamFree": False}, *START)),
    "setup-is-slow": ("choose setup", ({"ResetGuard": True, **RESET}, *START)),
    "fast-only-by-start": (
        "choose setup",
        (RESET, *START, {"Start": False, **MOVES}, {"ResetGuard": True}),
    ),
    "letting-go-stops-inside": (
        "choose manual",
        (
            RESET,
            *START,
            {"Start": False, **MOVES},
            {"ResetGuard": True, "ResetBeam": True},
            LET_GO,
        ),
    ),
    "letting-go-stops-reaching": (
        "choose manual",
        ({"ResetGuard": True, **RESET}, *START, {"Start": False, **MOVES}, {"ResetBeam": True}, LET_GO),
    ),
    "lamp-is-an-error": ("choose setup", ({**OPEN, **RESET}, *START, {"Start": False, **MOVES})),
    "standstill-then-start": ("choose setup", (RESET, *START[:1], {"S_Standstill": False, "Start": True})),
}
"""The mode that is chosen first, and what changes in each scan after it."""
SHOWN = ("setup-is-slow", "fast-only-by-start", "letting-go-stops-inside", "lamp-is-an-error")


@cache
def machine(path: Path) -> Machine:
    given = path.read_text("utf-8"), path.name, FOLDER / "safety.toml", FOLDER / "use.toml"
    return Machine(*given, leave_out=True, runs=1)


def scans_of(id: str, of: Machine, pressed: bool) -> list[Scan]:
    """What happens from power-up; `pressed`: the value of a Stop that is pressed."""
    story, rows = HAZARDS[id]
    inputs: dict[str, Value] = {name: kind == "WORD" and 0 for name, kind in of.runner.cell.inputs.items()}
    inputs |= {name: value for name, value in of.runner.use.rest.items() if name in inputs}
    inputs["Stop"] = not pressed
    found: list[Scan] = []
    for row in (*of.runner.stories()[story], *rows):
        inputs = {**inputs, **row}
        found.append((10, inputs))
    return found


def broken(id: str, path: Path, pressed: bool) -> tuple[list[Scan], int | None]:
    of = machine(path)
    [row] = [row for row in of.questions.rows if row["id"] == id]
    scans = scans_of(id, of, pressed)
    return scans, of.runner.broken(scans, rule_of(row, [], of.runner.named))


@pytest.mark.parametrize("id", HAZARDS)
def test_the_first_cell_has_the_hazard_and_todays_has_not(id: str) -> None:
    scans, falls = broken(id, FIRST, True)
    assert falls == len(scans)
    assert broken(id, TODAY, False)[1] is None


def test_a_torn_wire_of_stop_stops_todays_cell_alone() -> None:
    [row] = [row for row in machine(FIRST).questions.rows if row["id"] == "stop-stops"]
    for path, stops in ((FIRST, False), (TODAY, True)):
        of = machine(path)
        torn = [
            (dt_ms, {**inputs, "Stop": False}) for dt_ms, inputs in scans_of("lamp-is-an-error", of, True)
        ]
        rule = rule_of(row, [], of.runner.named)
        assert (of.runner.broken(torn, rule) is None) == stops


def traced(id: str) -> str:
    """The last scans as the command prints them, from the choice of the mode on."""
    of, (_, rows) = machine(FIRST), HAZARDS[id]
    told = list(rows_of_trace(of, scans_of(id, of, True)))
    lines = []
    for number, (dt_ms, given, gives) in enumerate(told, 1):
        name = f"{'wrong scan' if number == len(told) else 'scan'} {number}"
        lines += [f"{name:<13} after {dt_ms} ms: {given}", *([f"{'':<13} gives {gives}"] if gives else [])]
    text = "\n".join(lines)
    first = len(told) - len(rows) + 1
    return text[text.index(f"scan {first} ") :]


@pytest.mark.parametrize("id", SHOWN)
def test_the_page_shows_the_scans_of_the_hazard(id: str) -> None:
    assert traced(id) in PAGE


@pytest.mark.deep
def test_the_search_refutes_the_hazards_of_the_first_cell() -> None:
    given = FIRST.read_text("utf-8"), FIRST.name, FOLDER / "safety.toml", FOLDER / "use.toml"
    of = Machine(*given, leave_out=True)
    of.search.look([*HAZARDS, "stop-stops"], 120)
    assert all(of.search.scans(id) for id in (*HAZARDS, "stop-stops"))


def test_the_list_of_hazards_names_questions_that_exist() -> None:
    part = PAGE.partition("## A reviewer's list")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| (.*?) \| (.*) \|$", part, re.MULTILINE)[2:]
    known = {row["id"] for row in machine(TODAY).questions.rows}
    assert len(lines) > 10
    for hazard, said in lines:
        assert set(re.findall("`([a-z]+(?:-[a-z]+)+)`", said)) <= known, hazard
        assert "`" in said or "none" in said, hazard

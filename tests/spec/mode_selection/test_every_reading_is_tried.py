"""Each literal reading is asked for by a device, belongs to a finding, and is tried alone by a run."""

from __future__ import annotations

import re

import pytest

from modeproof.places import root
from modeproof.registers.load import load_document
from tests.spec.mode_selection.planted import DOCUMENT, SPEC

CODE = {
    path.stem: re.sub(r"\\\*[^\n]*|\(\*.*?\*\)", "", path.read_text(), flags=re.S)
    for path in SPEC.glob("*.tla")
}
READINGS = re.findall(r'"(\w+)"', CODE["Readings"].split("}")[0])
REGISTERS = load_document(root(), DOCUMENT)
ALONE = {
    run.id: match[1]
    for run in REGISTERS.runs
    if (match := re.search(r'LITERAL = \{"(\w+)"\}', (SPEC / run.cfg).read_text()))
}
EVIDENCE = {
    switch: {run for one in REGISTERS.findings if switch in one.switches for run in one.evidence}
    for one in REGISTERS.findings
    for switch in one.switches
}
# Tried with NO_DWELL: alone it is a merge of steps, which hides behavior and cannot add any (finding E-52)
ONLY_TOGETHER = {"ATOMIC_COPY"}
# No reading of the note: a restart of one device (E-56, E-70)
NO_READING = {"DEVICES_RESTART"}


def askers(reading: str, code: dict[str, str] = CODE) -> list[str]:
    """The modules that ask for a reading."""
    return [name for name, text in code.items() if name != "Readings" and re.search(rf"\b{reading}\b", text)]


@pytest.mark.parametrize("reading", READINGS)
def test_a_device_asks_for_it(reading: str) -> None:
    assert askers(reading), (
        f"{reading} is in Readings, and no module asks for it: switched on, it changes nothing"
    )


def test_a_reading_that_nobody_asks_for_is_noticed() -> None:
    assert askers("LIVE_MW03", CODE | {"Fplc": CODE["Fplc"].replace("LIVE_MW03", "LIVE_MW05")}) == []


@pytest.mark.parametrize("reading", [one for one in READINGS if one not in ONLY_TOGETHER | NO_READING])
def test_a_run_that_its_finding_names_tries_it_alone(reading: str) -> None:
    runs = {run for run, switch in ALONE.items() if switch == reading}
    assert runs, f"no run has LITERAL = {{{reading}}}"
    assert runs & EVIDENCE.get(reading, set()), f"no finding with the switch {reading} names {sorted(runs)}"


def test_every_switch_of_a_finding_is_a_reading() -> None:
    assert set(EVIDENCE) <= set(READINGS)


def test_a_run_says_which_switch_it_turns_on() -> None:
    for run in REGISTERS.runs:
        if run.switch and run.id in ALONE:
            assert ALONE[run.id] == run.switch, run.id

"""Each property of external device monitoring falls to a reading that is restored, or to a planted fault."""

from __future__ import annotations

import hashlib
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.places import root
from modeproof.registers.load import load_document
from modeproof.tlc.process import run_tlc
from modeproof.tlc.runs import load_runs
from modeproof.tlc.toolchain import find_toolchain

DOCUMENT = "edm"
SPEC = root() / "spec" / DOCUMENT
REGISTERS = load_document(root(), DOCUMENT)
PROPERTIES = {one.id: one for one in REGISTERS.properties}
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}
BASE = "MC_SF_EDM_arbitrary"
FAULTS = {
    "OutputNeedsAll": (
        'ResetRequest == state = "Init"',
        'ResetRequest == state \\in {"Init", "OutputEnable"}',
    ),
    "IdleShowsNothing": ('state = "Idle" -> 0', 'state = "Idle" -> 1'),
    "CodeTellsTheRow": ('state = "EDMError22" -> \\hC050', 'state = "EDMError22" -> \\hC051'),
    "PowerUpIsSafe": ('EDMInit == state = "Idle"', 'EDMInit == state = "Init"'),
    "EveryCallIsAnswered": ("(ReturnToError(i) \\/ AwaitReleaseInError(i))", "ReturnToError(i)"),
    "StopAtOnce": (
        "~LateInEnable(i) /\\ i.S_OutControl\n    /\\ Waits(i)",
        "~LateInEnable(i)\n    /\\ Waits(i)",
    ),
    "InactiveAtOnce": (
        '~i.Activate /\\ To("Idle") /\\ Did("Deactivate")',
        '~i.Activate /\\ To("Init") /\\ Did("Deactivate")',
    ),
    "SwitchOnNeedsInitialState": (
        "Feedback(i, dropped) == i.S_EDM1 = dropped /\\ i.S_EDM2 = dropped",
        "Feedback(i, dropped) == i.S_EDM1 = dropped",
    ),
    "MissedDropOutIsAnError": (
        "    /\\ Expired(i) /\\ ~Feedback(i, TRUE)\n",
        "    /\\ Expired(i) /\\ ~i.S_EDM1\n",
    ),
    "ErrorsAreLeftAsDocumented": (
        'To("Init") /\\ Did("ReturnToInit")',
        'Disable(TRUE) /\\ Did("ReturnToInit")',
    ),
    "HeldResetIsAnError": (
        "Static(i) == ResetStatic(i)",
        'Static(i) == state = "Init" /\\ ResetStatic(i)',
    ),
    "StartsWithInhibit": (
        'To("Init") /\\ Did("Initialize")',
        'To(IF i.S_StartReset THEN "OutputEnable" ELSE "Init") /\\ Did("Initialize")',
    ),
    "OneTransitionACall": (
        'To("Init") /\\ Did("ReturnToInit")',
        'Disable(TRUE) /\\ Did("ReturnToInit")',
    ),
    "SwitchesOnAtOnce": ("stopSeen' = (stopSeen \\/ ~i.S_OutControl)", "stopSeen' = stopSeen"),
    "RemovesInhibitAtOnce": (
        "Together(i) == ResetRises(i) /\\ Rises(i.S_OutControl, outControlBefore)",
        "Together(i) == ResetRises(i) /\\ i.S_OutControl",
    ),
    "ErrorNeedsCause": (
        "~Feedback(i, FALSE) /\\ (Literal",
        "~(i.S_EDM1 /\\ ~i.S_EDM2) /\\ (Literal",
    ),
    "ResetErrorKeepsTheCode": (
        "To(EDMErrors[Number(state, ResetErrors)])",
        'To(IF state = "ResetError23" THEN "EDMError22" ELSE EDMErrors[Number(state, ResetErrors)])',
    ),
}
FALLEN = {run.violates: run.id for run in RUNS.values() if run.kind == "NEG"}


def checked(place: Path, name: str, edit: tuple[str, str]) -> list[tuple[str, str]]:
    """What TLC says of this property alone on a copy with the edit."""
    base = RUNS[BASE]
    folder = place / "spec" / DOCUMENT
    shutil.copytree(SPEC, folder)
    shutil.copytree(SPEC.parent / "common", place / "spec/common")
    text = (folder / "EDM.tla").read_text()
    assert text.count(edit[0]) == 1, edit[0]
    (folder / "EDM.tla").write_text(text.replace(*edit))
    kind = "INVARIANT" if PROPERTIES[name].kind == "invariant" else "PROPERTY"
    text = (folder / base.cfg).read_text()
    text = re.sub(r"^(INVARIANTS|PROPERTIES)(?s:.*)", f"{kind} {name}\n", text, flags=re.MULTILINE)
    (folder / base.cfg).write_text(text)
    digest = hashlib.sha256(text.encode()).hexdigest()
    run = replace(base, properties=(name,), cfg_sha256=digest)
    return list(run_tlc(place, run, find_toolchain()).log.violations)


@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    said = "invariant" if PROPERTIES[name].kind == "invariant" else "property"
    assert checked(tmp_path, name, FAULTS[name]) == [(said, name)]


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    unchanged = 'Ready == state # "Idle"'
    assert checked(tmp_path, "ErrorNeedsCause", (unchanged, unchanged)) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | {name for name in FALLEN if name} == set(PROPERTIES)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    text = "".join((SPEC.parent / file).read_text() for file in ("edm/EDM.tla", "common/CyclicBlock.tla"))
    lists = re.findall(r"Readings == (?:\w+ \\cup )?\{([^}]*)\}", text)
    readings = {name for one in lists for name in re.findall(r'"([A-Z_]+)"', one)}
    tried = {run.switch: run.kind for run in REGISTERS.runs if run.switch in readings}
    assert len(readings) == 15 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "REQUEST_WAITS",
        "RESET_SEEN_ONLY_WHILE_ACTIVE",
        "STATIC_RESET_IGNORED",
    ]


def test_every_state_code_and_transition_is_witnessed() -> None:
    device = REGISTERS.interface.devices["sf_edm"]
    (witnessed,) = [set(run.witnesses) for run in REGISTERS.runs if run.kind == "WIT"]
    assert set(device.steps) <= witnessed
    assert {f"at {state}" for state in device.states} <= witnessed
    assert len({name for name in witnessed if name.startswith("code ")}) == len(device.states) == 24
    transitions = {name for name in witnessed if re.fullmatch(r"\w+ to \w+", name)}
    assert {f"{state} to Idle" for state in device.states if state != "Idle"} <= transitions
    assert len(transitions) == 1 + 23 + 3 + 2 + 7 + 4 + 9 * 3


def test_reading_a_trace_has_a_case_for_every_step_of_the_sequence() -> None:
    text = (SPEC / "sequences.toml").read_text()
    assert re.findall(r"^    # (\d)$", text, re.MULTILINE) == list("0123456")

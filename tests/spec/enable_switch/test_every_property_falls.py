"""Each property of the enable switch falls to a reading that is restored, or to a fault planted in a copy."""

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

DOCUMENT = "enable_switch"
SPEC = root() / "spec" / DOCUMENT
REGISTERS = load_document(root(), DOCUMENT)
PROPERTIES = {one.id: one for one in REGISTERS.properties}
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}
BASE = RUNS["MC_SF_EnableSwitch_arbitrary"]

FAULTS = {
    "OutputsFollowTheCode": ("Error == state \\in Errors", "Error == state \\in Errors \\ ResetErrors"),
    "IdleIsSilent": ('Ready == state # "Idle"', 'Ready == state # "Stage2"'),
    "EnableStandsAlone": (
        'SafetyDemand == state \\in {"Stage0", ',
        'SafetyDemand == state \\in {"Stage0", "Stage1", ',
    ),
    "EveryCallIsAnswered": ("\\/ AwaitStage0(i) \\/ SeeStage0(i)", "\\/ SeeStage0(i)"),
    "PowerUpIsSilent": ('BlockInit == state = "Idle"', 'BlockInit == state = "BasicMode"'),
    "ActivateGoesFirst": ('To("Idle", i) /\\ Did("Deactivate")', 'To("BasicMode", i) /\\ Did("Deactivate")'),
    "ModeEndsOperation": (
        'To("BasicMode", i) /\\ Did("LoseSafetyActive")',
        'To("Stage0", i) /\\ Did("LoseSafetyActive")',
    ),
    "ErrorNeedsResetInTheMode": (
        "~(ResetStatic(i) /\\ ~i.S_AutoReset) /\\ Resets(i)",
        "~(ResetStatic(i) /\\ ~i.S_AutoReset)",
    ),
    "HeldResetIsAnError": ("/\\ Held(ResetErrors, i) /\\ ~i.Reset\n", "/\\ Held(ResetErrors, i)\n"),
    "OneTransitionACall": (
        '/\\ To(IF i.S_SafetyActive THEN "Stage0" ELSE "BasicMode", i)',
        '/\\ To(IF i.S_SafetyActive THEN "Stage1" ELSE "BasicMode", i)',
    ),
    "PatternsDecide": (
        '/\\ SeesStage0(i)\n    /\\ To("Stage0", i)',
        '/\\ SeesStage0(i)\n    /\\ To("SafeMode", i)',
    ),
}
FALLEN = {run.violates: run.id for run in RUNS.values() if run.kind == "NEG"}


def checked(place: Path, name: str, edit: tuple[str, str]) -> list[tuple[str, str]]:
    """What TLC says of this property alone on a copy with the edit, with 0 or 1 tick in every call."""
    folder = place / "spec" / DOCUMENT
    shutil.copytree(SPEC, folder)
    shutil.copytree(SPEC.parent / "common", place / "spec/common")
    for file, (old, new) in {
        "EnableSwitch.tla": edit,
        "EnableSwitchOpen.tla": ("N == 2 * 2 * 8 * 2 * 2 * 3", "N == 2 * 2 * 8 * 2 * 2 * 2"),
    }.items():
        text = (folder / file).read_text()
        assert text.count(old) == 1, old
        (folder / file).write_text(text.replace(old, new))
    kind = "INVARIANT" if PROPERTIES[name].kind == "invariant" else "PROPERTY"
    text = (folder / BASE.cfg).read_text()
    text = re.sub(r"^INVARIANTS(?s:.*)", f"{kind} {name}\n", text, flags=re.MULTILINE)
    (folder / BASE.cfg).write_text(text)
    digest = hashlib.sha256(text.encode()).hexdigest()
    run = replace(BASE, properties=(name,), cfg_sha256=digest)
    return list(run_tlc(place, run, find_toolchain()).log.violations)


@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    said = "invariant" if PROPERTIES[name].kind == "invariant" else "property"
    assert checked(tmp_path, name, FAULTS[name]) == [(said, name)]


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    assert checked(tmp_path, "PatternsDecide", ("Errors == Faulty", "Errors == Faulty")) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | {name for name in FALLEN if name} == set(PROPERTIES)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    text = "".join(
        (SPEC.parent / file).read_text()
        for file in ("enable_switch/EnableSwitch.tla", "common/CyclicBlock.tla")
    )
    lists = re.findall(r"Readings == (?:\w+ \\cup )?\{([^}]*)\}", text)
    readings = {name for one in lists for name in re.findall(r'"(\w+)"', one)}
    tried = {run.switch: run.kind for run in REGISTERS.runs if run.switch in readings}
    assert len(readings) == 13 and set(tried) == readings
    assert [name for name, kind in tried.items() if kind != "NEG"] == ["RESET_SEEN_ONLY_WHILE_ACTIVE"]

"""Each property of the sensor block falls to a reading of the text, or to a fault planted in a copy."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import msgspec
import pytest

from modeproof.registers.made import make
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import find_toolchain
from tests.spec.block import Block

BLOCK = Block(
    "testable_safety_sensor",
    "TestableSafetySensor.tla",
    "MC_SF_TestableSafetySensor_arbitrary",
    others={
        "EnablesAgain": "LIVE_SF_TestableSafetySensor_enables_again",
        "TestedAgain": "LIVE_SF_TestableSafetySensor_tested_again",
        "PersonStopsMachine": "MC_SF_TestableSafetySensor_field",
    },
)
NEVER_FREE = (
    '~Expired(i) /\\ Free(i) /\\ To("ESPEFreeTestOk")',
    '~Expired(i) /\\ Free(i) /\\ To("ESPEFreeNoTest")',
)
FAULTS = {
    "InactiveAtOnce": ('Released("Idle") /\\ Did("Deactivate")', 'Released("Init") /\\ Did("Deactivate")'),
    "EnableMeansNothingPending": (
        "OutputRow(\\h8402, T, F, T, F, F, F, T, F)",
        "OutputRow(\\h8402, T, T, T, F, F, F, T, F)",
    ),
    "SwitchedOffInhibitEnds": (
        "StaticAtStart(i) == ResetStatic(i) /\\ ~i.S_StartReset",
        "StaticAtStart(i) == ResetStatic(i)",
    ),
    "SenderOffIsBounded": (
        'Expired(i) /\\ To(TestErrorShown(i)) /\\ Did("ExpireRequest")',
        'Expired(i) /\\ UNCHANGED <<state, startInhibit, elapsed>> /\\ Did("ExpireRequest")',
    ),
    "DemandIsShown": (
        'Tested(i) /\\ ~Free(i) /\\ To("ESPEInterruptedExternalTest")',
        'Tested(i) /\\ ~Free(i) /\\ To("ExternalFunctionTest")',
    ),
    "TestStartsAtOnce": (
        'At("ESPEFreeTestOk", i) /\\ ~Lost(i) /\\ TestAsked(i) /\\ To("TestRequest")',
        'At("ESPEFreeTestOk", i) /\\ ~Lost(i) /\\ TestAsked(i) /\\ To("ESPEFreeNoTest")',
    ),
    "TestExecutedIsTrue": (
        'To(TestErrorShown(i)) /\\ Did("ExpireActive")',
        'To(IF Free(i) THEN "WaitForReset2" ELSE TestErrorShown(i)) /\\ Did("ExpireActive")',
    ),
    "TestExecutedStays": (
        'Lost(i) /\\ To("ESPEInterrupted2") /\\ Did("Interrupt2")',
        'Lost(i) /\\ To("ESPEInterrupted1") /\\ Did("Interrupt2")',
    ),
    "ReactionIsSeen": NEVER_FREE,
    "StaticResetIsFound": (
        "StaticInError(i) == ResetStatic(i) /\\ ~EndsByItself(i)",
        "StaticInError(i) == ResetStatic(i) /\\ ~EndsByItself(i) /\\ ~i.S_StartReset",
    ),
    "CodeTellsItsOutputs": ("OutputRow(\\h8804,", "OutputRow(\\h8004,"),
    "EdgesAreRemembered": ("sensorBefore' = i.S_OSSD_In", "sensorBefore' = (i.S_OSSD_In /\\ i.Activate)"),
    "OneTransitionPerCall": (
        'Free(i) /\\ To("EndExternalTest")',
        'Free(i) /\\ To(IF i.S_AutoReset THEN "WaitForReset1" ELSE "EndExternalTest")',
    ),
    "EveryCallIsAnswered": ("LeaveResetError(i) \\/ StayInResetError(i)", "LeaveResetError(i)"),
    "PowerUpIsSafe": ('/\\ state = "Idle" /\\ elapsed = 0', '/\\ state = "Init" /\\ elapsed = 0'),
    "EnablesAgain": (
        "NeedsExternalTest(i) == ErrorEnds(i) /\\ ~i.NoExternalTest",
        "NeedsExternalTest(i) == ErrorEnds(i) /\\ ~i.NoExternalTest /\\ ~Free(i)",
    ),
    "TestedAgain": NEVER_FREE,
    "CodeIsThePrintedOne": ("OutputRow(\\hC051,", "OutputRow(\\hC061,"),
    "DemandNeedsDarkSensor": (
        'At("ESPEInterruptedExternalTest", i) /\\ ~Free(i) /\\ Stay',
        'At("ESPEInterruptedExternalTest", i) /\\ Stay',
    ),
    "ResetEndsAtOnce": (
        "Waiting2(i) /\\ ~LostAgain(i) /\\ ~RestartAllowed(i) /\\ Stay",
        "Waiting2(i) /\\ ~LostAgain(i) /\\ Stay",
    ),
    "ResetErrorNeedsHeldReset": (
        "state \\in ResetErrors /\\ i.Activate /\\ i.Reset /\\ Stay",
        "state \\in ResetErrors /\\ i.Activate /\\ Stay",
    ),
    "ManualTestIsSeen": (
        'At("ExternalFunctionTest", i) /\\ ~Falls(i) /\\ Stay',
        'At("ExternalFunctionTest", i) /\\ Stay',
    ),
    "ParameterErrorNeedsCause": ("TEST_TIME \\in 0..150", "TEST_TIME \\in 3..150"),
    "ActiveAtOnce": ('~i.Activate /\\ state = "Idle" /\\ Stay', 'state = "Idle" /\\ Stay'),
    "PersonStopsMachine": (
        "elapsed' = Counted(elapsed, i.dt, TEST_TIME)",
        "elapsed' = Counted(elapsed, IF Free(i) THEN i.dt ELSE 0, TEST_TIME)",
    ),
}


@pytest.mark.sampled(12)
@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    assert BLOCK.checked(tmp_path, name, FAULTS[name]) == BLOCK.falls(name)


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    unchanged = "SensorOutputs == Rows[state]"
    assert BLOCK.checked(tmp_path, "ReactionIsSeen", (unchanged, unchanged)) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | BLOCK.fallen == set(BLOCK.properties)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 20 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "StaticResetBeforeTestTime",
        "WaitForResetNeedsEdge",
    ]


def test_the_reading_that_leaves_the_states_changes_transitions(tmp_path: Path) -> None:
    shutil.copytree(BLOCK.spec.parent, tmp_path / "spec")
    graphs = []
    for reading in ((), "WaitForResetNeedsEdge"):
        base = BLOCK.runs["OPEN_SF_TestableSafetySensor_zero"]
        folder, run = make(tmp_path, msgspec.structs.replace(base, reading=reading))
        file = run_tlc(tmp_path, run, find_toolchain(), made_in=folder).graph_file
        assert file is not None
        graphs.append(set(file.read_text().splitlines()))
    decided, otherwise = graphs
    assert len(decided) == len(otherwise) and len(decided - otherwise) == len(otherwise - decided) > 0


def test_every_state_step_code_and_transition_is_witnessed() -> None:
    device = BLOCK.registers.interface.devices["sf_testable_safety_sensor"]
    witnessed = {name for run in BLOCK.registers.runs if run.kind == "WIT" for name in run.witnesses}
    assert set(device.steps) <= witnessed
    assert len({name for name in witnessed if name.startswith("DiagCode")}) == len(device.states) == 22
    states = "|".join(sorted(device.states, key=len, reverse=True))
    joined = {name for name in witnessed if re.fullmatch(rf"({states})To({states})", name)}
    assert {f"{one}ToIdle" for one in device.states if one != "Idle"} <= joined
    entered = {re.fullmatch(rf"({states})To({states})", name).group(2) for name in joined}  # type: ignore[union-attr]
    assert entered == set(device.states) and len(joined) == 21 + 45

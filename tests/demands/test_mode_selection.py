"""The demands of the note: programs that follow it meet them, and a program with a fault breaks the one
that speaks of it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from itertools import product
from typing import Any, Protocol

import pytest

from modeproof.ground.places import root
from modeproof.kit.builtin import REFERENCE, Builtin
from modeproof.kit.demands import Watch, read_demands
from modeproof.kit.signals import read_signals
from modeproof.kit.vectors import open_suite
from modeproof.registers.load import load_interface
from modeproof.suites.demands import declare, declare_parameters, load_demands
from tests.demands import courses
from tests.demands.courses import Wires
from tests.demands.fplc_programs import Fplc
from tests.demands.panel_programs import COPIES, Hmi, Plc

DOCUMENT = "mode_selection"


class Program(Protocol):
    """What the courses are put to."""

    def reset(self) -> None:
        """Power-up."""

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """One scan."""


class Reference:
    """The reference implementation with some parameters."""

    def __init__(self, target: str, **params: Any) -> None:
        suite = open_suite(root() / "vectors" / target / "brief.jsonl.gz")
        self.program, self.params = Builtin(REFERENCE, suite), params

    def reset(self) -> None:
        """Power-up."""
        self.program.reset(self.params)

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """One scan."""
        return self.program.scan(dt_ms, inputs)


@cache
def watch(target: str, latency: int) -> Watch:
    """The demands on a device."""
    interface = load_interface(root(), DOCUMENT)
    device = interface.devices[target]
    table = load_demands(root(), DOCUMENT, device)
    assert table is not None
    modes = [0, 1, 2, 3, 4]
    inputs, outputs = (read_signals(declare(of, modes), "") for of in (device.inputs, device.outputs))
    return Watch(read_demands(table, inputs, outputs, declare_parameters(device, modes), ""), latency)


COURSES: Mapping[str, Mapping[str, list[Wires]]] = {
    "fplc": courses.fplc_courses(),
    "plc": courses.plc_courses(),
    "hmi": courses.hmi_courses(),
}


def broken(
    target: str,
    program: Program,
    wires: Iterable[Wires],
    latency: int = 1,
    params: Mapping[str, Any] | None = None,
) -> str:
    """The demand that a program breaks first, or nothing; of a program with the parameters of the machine."""
    judge = watch(target, latency)
    judge.reset(getattr(program, "params", {}) if params is None else params)
    program.reset()
    for dt_ms, inputs in wires:
        found = judge.scan(dt_ms, inputs, program.scan(dt_ms, inputs))
        if found is not None:
            return found.id
    return ""


def all_broken(
    target: str, make: Callable[[], Program], latency: int = 1, enough: frozenset[str] = frozenset()
) -> set[str]:
    """The demands that a program breaks first in some course; with `enough`, until those are found."""
    found = set()
    for wires in COURSES[target].values():
        found |= {broken(target, make(), wires, latency)} - {""}
        if enough and enough <= found:
            break
    return found


CAUTIOUS = {"SELECTIONS": "again", "T_SEQ_FROM": "LA", "T_DWELL_ms": 500}
DROPPING = {"ON_ERROR": "none", "T_DWELL_ms": 900}
WAYS = [
    dict(zip(("rows", "keep", "again", "latched"), way, strict=True))
    for way in product((True, False), repeat=4)
]
Following = tuple[str, Callable[[], Program], int]


def reference(target: str, latency: int, **params: Any) -> Following:
    """The reference implementation, which follows."""
    return target, lambda: Reference(target, **params), latency


def literal(latency: int, **way: bool) -> Following:
    """An F-PLC that follows."""
    return "fplc", lambda: Fplc(**way), latency


FOLLOW = [
    reference("fplc", 1, **CAUTIOUS),
    reference("fplc", 0),
    literal(1, rows=True),
    literal(1, rows=False, keep=False, again=True),
    literal(1, rows=True, check_apart=True, latched=False),
    reference("plc", 0),
    ("plc", lambda: Plc("in order"), 1),
    reference("hmi", 0),
    ("hmi", lambda: Hmi(steps=False, echo_rules=True), 1),
]
MANY = [
    *(reference("fplc", 1, **given) for given in ({}, DROPPING)),
    *(("plc", lambda way=way: Plc(way), 1) for way in ("all", "in turn")),
    *(("hmi", lambda way=way: Hmi(*way), 1) for way in product((True, False), repeat=2)),
    *(literal(late, **way) for way in WAYS for late in (0, 1)),
    *(literal(1, check_apart=True, **way) for way in WAYS if way["rows"]),
    *(literal(1, late=True, **way) for way in WAYS),
]


@pytest.mark.parametrize(("target", "make", "latency"), FOLLOW)
def test_programs_that_follow_the_note_meet_its_demands(
    target: str, make: Callable[[], Program], latency: int
) -> None:
    assert all_broken(target, make, latency) == set()


@pytest.mark.deep
@pytest.mark.parametrize(("target", "make", "latency"), [*FOLLOW, *MANY])
def test_disturbed_wires_blame_no_program_that_follows(
    target: str, make: Callable[[], Program], latency: int
) -> None:
    if (target, make, latency) in MANY:
        assert all_broken(target, make, latency) == set()
    for seed, wires in enumerate(COURSES[target].values()):
        assert broken(target, make(), courses.disturbed(seed, wires, 800), latency) == ""


@pytest.mark.parametrize(("target", "make", "latency"), [FOLLOW[2], FOLLOW[4], FOLLOW[6], FOLLOW[8]])
def test_the_published_sequences_blame_no_program_that_follows(
    target: str, make: Callable[[], Program], latency: int
) -> None:
    suite = open_suite(root() / f"vectors/{target}/sequences.jsonl.gz")
    for case in suite.cases():
        wires = [(scan.dt_ms, scan.inputs) for scan in case.scans]
        if not case.params.get("SELECTIONS"):
            assert broken(target, make(), wires, latency, case.params) == "", case.id


def test_a_narrower_permission_is_none_of_the_page() -> None:
    narrow = {"PERMITS_3": [3], "PERMITS_4": [2, 4]}
    for target, name, demand in (
        ("fplc", "level 3, mode 1", "NoErrorInAGoodCourse"),
        ("fplc", "level 4, mode 4", ""),
        ("hmi", "level 3, mode 3", "FieldsOpen"),
    ):
        assert broken(target, Reference(target, **narrow), COURSES[target][name]) == demand


FAULTS_FPLC = {
    "nothing is done": {"LevelComes", "PulseInTime"},
    "no level is published": {"LevelComes"},
    "output C is level 3": {"LevelIsTheSignalledOne"},
    "no test pulse is needed": {"LevelAfterTheTestPulse"},
    "there is no check before steps 11 and 12": {"LevelWithAKey"},
    "no time is watched": {"PulseInTime"},
    "two outputs are ignored": {"TwoOutputsAreAFault"},
    "no key is needed": {"RemovalClearsTheLevel", "TwoOutputsAreAFault", "ModeWithAKey", "EchoWithAKey"},
    "no level limits the selection": {"EchoWithinTheLevel"},
    "a selection above the level is waited out": {"AboveTheLevelIsAFault"},
    "any word is a selection": {"EchoIsASelection"},
    "a word that is no code is waited out": {"NoCodeIsAFault"},
    "no echo is given": {"EchoComes"},
    "the echo is taken from another range": {"EchoIsASelection"},
    "no acknowledgment is awaited": {"ModeWasAcknowledged"},
    "an acknowledgment that is no code is waited out": {"NoAcknowledgmentWordIsAFault"},
    "another acknowledgment is waited out": {"AnotherAcknowledgmentIsAFault"},
    "the acknowledged mode is not compared": {"ModeWasSelected"},
    "Figure 7 as printed": {"ModeWasAcknowledged", "NoErrorInAGoodCourse"},
    "a row of the code table is wrong": {"ModeWasAcknowledged", "NoErrorInAGoodCourse"},
    "the acknowledged mode never comes": {"ModeComes"},
    "manual mode is never switched off": {"OneModeAtMost"},
    "the mode ends with the key": {"ModeStays"},
    "the level stays after the removal": {"RemovalClearsTheLevel"},
    "the error mode is never left": {"NoErrorInAGoodCourse"},
    "no error is ever reported": {
        "NoCodeIsAFault",
        "AboveTheLevelIsAFault",
        "NoAcknowledgmentWordIsAFault",
        "AnotherAcknowledgmentIsAFault",
        "PulseInTime",
        "TwoOutputsAreAFault",
    },
}
FAULTS_PLC = {
    "ReadAuthorization is never written": {"LevelIsSent"},
    "MW03 is never written": {"SelectionComes"},
    "CheckMSO is never written": {"EchoIsSent"},
    "MW07 is never written": {"AcknowledgmentComes"},
    "ReadAuthorization is changed on the way": {"LevelIsSentUnchanged"},
    "MW03 is changed on the way": {"SelectionIsCopied"},
    "CheckMSO is changed on the way": {"EchoIsSentUnchanged"},
    "MW07 is changed on the way": {"AcknowledgmentIsCopied"},
    "zeros of the panel are not sent on": {"ZerosGoRound"},
    "a word that is no code is left out": {"LevelIsSent"},
}
FAULTS_HMI = {
    "the screen never opens": {"FieldsOpen"},
    "the screen opens without a level": {"ScreenNeedsAnAuthorization"},
    "the field of the level alone is enabled": {"FieldsOpen"},
    "every field is enabled": {"FieldsWithinTheLevel"},
    "a mode is selected that nobody touched": {"SelectionWasTouched"},
    "a touch of a closed field counts": {"SelectionWithinTheLevel"},
    "a selection is sent late, and no check comes before it": {"SelectionWithAnAuthorization"},
    "the selection comes from another range": {"SelectionWasTouched"},
    "nothing is sent": {"SelectionIsSent"},
    "what was touched is displayed instead of the echo": {"DisplayIsTheEcho"},
    "the echo is not displayed": {"EchoIsDisplayed"},
    "the echo is confirmed by nobody": {"AcknowledgmentWasConfirmed"},
    "a rejection counts as a confirmation": {"AcknowledgmentWasConfirmed"},
    "another mode is acknowledged": {"AcknowledgmentIsTheMode"},
    "nothing is acknowledged": {"AcknowledgmentIsSent"},
    "the screen stays open": {"ScreenCloses"},
    "the selection stays after the removal": {"SelectionReturnsToZero"},
    "the acknowledgment stays after the removal": {"AcknowledgmentReturnsToZero"},
    "the active mode is not displayed": {"ActiveModeIsDisplayed"},
}
FAULTS = [
    *(("fplc", Fplc, fault, want) for fault, want in FAULTS_FPLC.items()),
    *(("plc", Plc, fault, want) for fault, want in FAULTS_PLC.items()),
    *(("hmi", Hmi, fault, want) for fault, want in FAULTS_HMI.items()),
]


def named(value: object) -> str:
    """What a case is called: a set has no order of its own."""
    return ", ".join(sorted(value)) if isinstance(value, set) else getattr(value, "__name__", str(value))


@pytest.mark.parametrize(("target", "kind", "fault", "wanted"), FAULTS, ids=named)
def test_a_fault_breaks_the_demand_that_speaks_of_it(
    target: str, kind: type[Any], fault: str, wanted: set[str]
) -> None:
    assert all_broken(target, lambda: kind(fault=fault), enough=frozenset(wanted)) >= wanted


@pytest.mark.deep
@pytest.mark.parametrize(("target", "kind", "fault", "wanted"), FAULTS, ids=named)
def test_a_fault_breaks_no_other_demand_first(
    target: str, kind: type[Any], fault: str, wanted: set[str]
) -> None:
    assert all_broken(target, lambda: kind(fault=fault)) == wanted


def test_every_demand_is_broken_by_some_fault() -> None:
    asked = {row.id for target in COURSES for row in watch(target, 1).judged}
    assert asked == set().union(*FAULTS_FPLC.values(), *FAULTS_PLC.values(), *FAULTS_HMI.values())


def test_every_fault_that_a_program_can_have_is_tried() -> None:
    known = {fault for _, _, fault, _ in FAULTS}
    text = "".join((root() / f"tests/demands/{name}_programs.py").read_text() for name in ("fplc", "panel"))
    written = set(re.findall(r'fault [!=]= "([^"]+)"', text))
    copies = {f"{to} {what}" for to, _ in COPIES for what in ("is never written", "is changed on the way")}
    assert known == written | copies

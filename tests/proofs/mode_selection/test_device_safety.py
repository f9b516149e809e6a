"""The theorems of panel, PLC and EKS, and of the F-PLC's response, with the planted faults that they see."""

import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import z3

from modeproof.registers import load_document
from proofs.explorer.errors import ConcretizationError
from proofs.mode_selection import (
    eks_prompt,
    eks_safety,
    fplc_response,
    panel_prompt,
    panel_safety,
    plc_safety,
)
from proofs.mode_selection.devices import ROOT
from proofs.runner import prove_all
from proofs.sentences import Judge, Sentence
from proofs.solvers import ask_z3
from proofs.theorem import Theorem, TheoremError, theorems_of
from refimpl.mode_selection import fplc
from tests.any_machine import LONG_MS
from tests.proofs.block import decided
from tests.proofs.planted_steps import begun_in, breaks, built, kept, planted, refuted

MODULES: list[Any] = [panel_safety, panel_prompt, plc_safety, eks_safety, eks_prompt, fplc_response]


def _theorems(module: ModuleType) -> list[Theorem]:
    return [value for value in vars(module).values() if isinstance(value, Theorem)]


SMALL = [item for module in MODULES[:-1] for item in _theorems(module)]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("item", SMALL, ids=lambda item: item.name)
def test_both_solvers_prove_every_theorem_of_panel_plc_and_eks(item: Theorem, tmp_path: Path) -> None:
    (result,) = prove_all([item], tmp_path, lambda line: None, LONG_MS)
    assert (result.verdict, result.reason) == ("PROVED", "")


@pytest.mark.parametrize("item", _theorems(fplc_response), ids=lambda item: item.name)
def test_every_theorem_of_the_response_holds(item: Theorem) -> None:
    queries, _ = built(item)
    assert [query for query in queries if query.name.startswith("control")]
    assert not [query.name for query in queries if ask_z3(query, "", LONG_MS).answer != query.expected]


@pytest.mark.parametrize("module", MODULES, ids=lambda module: module.__name__.rsplit(".", 1)[-1])
def test_the_examples_of_all_controls_happen_in_the_real_step(module: ModuleType) -> None:
    kept = [example for item in _theorems(module) for example in built(item)[1]]
    assert kept
    for query, scans, sentence in kept:
        solver = z3.SimpleSolver()
        solver.add(*query.formulas.values())
        assert solver.check() == z3.sat, query.name
        assert breaks(scans, sentence, solver.model()), query.name


PANEL, PLC, EKS = panel_safety.JUDGE, plc_safety.JUDGE, eks_safety.JUDGE
RESPONSE = fplc_response.JUDGE
DWELL_RESTARTS = ("    return _wait(s, elapsed)\n\n\n# ---", "    return _wait(s, 0)\n\n\n# ---")
REMOVAL_RESTARTS = ("_wait(s, elapsed)  # AwaitReturnedZeros", "_wait(s, 0)  # AwaitReturnedZeros")
NEVER_IDLE = ("return _enter_idle(s)  # LeaveAwaitZeros", "return _wait(s, elapsed)")
TIMER_ANEW = ("_forget(s, AWAIT_ZEROS, elapsed)", "_forget(s, AWAIT_ZEROS, 0)")
FAULTS: list[tuple[str, Judge, str, Sentence, list[tuple[str, str]]]] = [
    (
        "SelectionWithinOffer",
        PANEL,
        "Select",
        PANEL.after_a_scan(panel_safety.selection_within_offer),
        [("if is_among(touched, _open_fields(s)):", "if touched != NONE:")],
    ),
    (
        "InhibitedSendsZeros",
        PANEL,
        "Confirm",
        PANEL.after_a_scan(panel_safety.inhibited_sends_zeros),
        [
            (
                "return State(s.params, Step.INHIBITED, NONE, NONE)",
                "return State(s.params, Step.INHIBITED, NONE, 0)",
            ),
            ('Outputs(ZERO, ZERO, "inhibited"', 'Outputs(encode(SE, s.selection), ZERO, "inhibited"'),
        ],
    ),
    (
        "SelectionNeedsEnable",
        PANEL,
        "AwaitEcho",
        panel_safety.selection_needs_enable,
        [("if level == NONE or level != s.offered:", "if level == NONE:")],
    ),
    (
        "SelectionNeedsEnable",
        PANEL,
        "Inhibited",
        panel_safety.selection_needs_enable,
        [("if level != NONE and i.CheckMSO == ZERO:", "if level != NONE:")],
    ),
    (
        "SelectionNeedsTouch",
        PANEL,
        "Select",
        panel_safety.selection_needs_touch,
        [("Step.AWAIT_ECHO, s.offered, touched)", "Step.AWAIT_ECHO, s.offered, s.offered)")],
    ),
    (
        "AcknowledgmentNeedsConfirm",
        PANEL,
        "Confirm",
        panel_safety.acknowledgment_needs_confirm,
        [
            (
                "    if i.CheckMSO != encode(CH, s.selection):\n        return _withdraw(s)",
                "    if False:\n        return s",
            )
        ],
    ),
    (
        "AcknowledgmentNeedsConfirm",
        PANEL,
        "AwaitEcho",
        panel_safety.acknowledgment_needs_confirm,
        [("return State(s.params, Step.CONFIRM,", "return State(s.params, Step.AWAIT_SWITCH,")],
    ),
    (
        "InhibitAtOnce",
        PANEL,
        "AwaitSwitch",
        panel_safety.inhibit_at_once,
        [("if level == NONE or level != s.offered:", "if level != NONE and level != s.offered:")],
    ),
    (
        "SelectionIsOffered",
        PANEL,
        "Confirm",
        kept(PANEL),
        [("Step.WITHDRAWN, s.offered, NONE)", "Step.WITHDRAWN, s.offered, 0)")],
    ),
    (
        "OpenAtALevel",
        PANEL,
        "Confirm",
        kept(PANEL),
        [("Step.WITHDRAWN, s.offered, NONE)", "Step.WITHDRAWN, NONE, NONE)")],
    ),
    (
        "the display",
        PANEL,
        "AwaitSwitch",
        panel_safety.displays_what_it_reads,
        [("return after, outputs(after, inputs.ActiveMSO)", "return after, outputs(after, state.selection)")],
    ),
    (
        "ScreenIsTrue",
        PANEL,
        "AwaitEcho",
        PANEL.after_a_scan(panel_prompt.screen_is_true),
        [('"confirm", NO_MODES, s.selection, active', '"confirm", NO_MODES, NONE, active')],
    ),
    (
        "FieldSelectsItsMode",
        PANEL,
        "Select",
        panel_prompt.field_selects_its_mode,
        [('if touch == "select:2":\n        return 2', 'if touch == "select:2":\n        return 1')],
    ),
    (
        "ClosesAtOnce",
        PANEL,
        "Confirm",
        panel_prompt.closes_at_once,
        [("if level == NONE or level != s.offered:", "if level == NONE:")],
    ),
    (
        "ClosesOverAnEcho",
        PANEL,
        "Select",
        panel_prompt.closes_over_an_echo,
        [("return _inhibit(s)  # InhibitScreen\n    touched", "return s\n    touched")],
    ),
    (
        "EndsWithTheEcho",
        PANEL,
        "Withdrawn",
        panel_prompt.ends_with_the_echo,
        [("Step.SELECT, s.offered, NONE)  # FinishSelection", "Step.INHIBITED, NONE, NONE)")],
    ),
    (
        "PanelAnswersAtOnce",
        PANEL,
        "Confirm",
        panel_prompt.panel_answers_at_once,
        [("if i.touch == CONFIRM:", "if i.touch == CONFIRM and i.ActiveMSO == NONE:")],
    ),
    (
        "CopiesUnchanged",
        PLC,
        "CopyMW03",
        plc_safety.copies_unchanged,
        [
            (
                "s.ReadAuthorization, i.SelectMSO, s.CheckMSO",
                "s.ReadAuthorization, i.SelectMSO & 0xFFFE, s.CheckMSO",
            )
        ],
    ),
    (
        "CopiesTakeTurns",
        PLC,
        "CopyCheckMSO",
        plc_safety.copies_take_turns,
        [("State(s.params, Step.COPY_MW07,", "State(s.params, Step.COPY_READ_AUTHORIZATION,")],
    ),
    (
        "LevelGoesFirst",
        PLC,
        "CopyCheckMSO",
        plc_safety.level_goes_first,
        [(" or state.ReadAuthorization != inputs.MW01", "")],
    ),
    (
        "every copy within four scans",
        PLC,
        "CopyReadAuthorization",
        plc_safety.every_copy_comes_closer,
        [("State(s.params, Step.COPY_MW03, i.MW01", "State(s.params, Step.COPY_READ_AUTHORIZATION, i.MW01")],
    ),
    (
        "OneOutputOutsideThePulse",
        EKS,
        "TestZeros",
        EKS.after_a_scan(eks_safety.one_output_outside_the_pulse),
        [("level == 0, level == 1,", "level == 0, level <= 1,")],
    ),
    (
        "NoOutputWithoutLA",
        EKS,
        "TestZeros",
        EKS.after_a_scan(eks_safety.no_output_without_la),
        [("Outputs(c == Step.SIGNAL, level == 0", "Outputs(False, level == 0")],
    ),
    (
        "LAOnlyForAcceptedKeys",
        EKS,
        "CheckLevel",
        EKS.after_a_scan(eks_safety.la_only_for_accepted_keys),
        [
            ("    if access_code > ACCESS_CODE_MAX:\n        return False\n", ""),
            ("return _enter(s, Step.SET_LA)", "return _enter(s, Step.START_TEST)"),
        ],
    ),
    (
        "LADropsAtOnce",
        EKS,
        "Signal",
        eks_safety.la_drops_at_once,
        [("        and key.KeyID == i.KeyID\n", "")],
    ),
    (
        "PulseBeforeOutput",
        EKS,
        "TestOnes",
        eks_safety.pulse_before_output,
        [("return _enter(s, Step.TEST_ZEROS)", "return _enter(s, Step.SIGNAL)")],
    ),
    (
        "PulseHalvesLast",
        EKS,
        "TestOnes",
        eks_safety.pulse_halves_last,
        [("if elapsed >= s.params.T_PULSE_ms:", "if elapsed > s.params.T_PULSE_ms:")],
    ),
    (
        "FaultIsLatched",
        EKS,
        "Fault",
        eks_safety.fault_is_latched,
        [("        return s  # StayInFault", "        return _empty(s, i)  # StayInFault")],
    ),
    (
        "ChecksumWasRight",
        EKS,
        "CheckChecksum",
        kept(EKS),
        [("return _enter(s, Step.REJECTED)  # RefuseChecksum", "return _enter(s, Step.CHECK_LEVEL)")],
    ),
    (
        "KeyWasAccepted",
        EKS,
        "CheckLevel",
        kept(EKS),
        [("if decode(RE, s.key.authorization_level) == NONE:", "if False:")],
    ),
    (
        "TimerIsTheTimeOfThisHalf",
        EKS,
        "TestOnes",
        kept(EKS),
        [("State(s.params, Step.TEST_ONES, s.key, elapsed)", "State(s.params, Step.TEST_ONES, s.key, 0)")],
    ),
    (
        "KeyIsForgotten",
        EKS,
        "ClearOutputs",
        kept(EKS),
        [("Step.CHECK_REGISTERS, NO_KEY, 0)  # ResetOutputs", "Step.CHECK_REGISTERS, s.key, 0)")],
    ),
    (
        "PulseAloneTakesTime",
        EKS,
        "TestZeros",
        kept(EKS),
        [("return _enter(s, Step.SIGNAL)", "return State(s.params, Step.SIGNAL, s.key, elapsed)")],
    ),
    (
        "ReaderStepsInOrder",
        EKS,
        "CheckChecksum",
        eks_prompt.reader_steps_in_order,
        [("_enter(s, Step.CHECK_LEVEL)  # AcceptChecksum", "_enter(s, Step.SET_LA)")],
    ),
    (
        "LABeforeOutputs",
        EKS,
        "SetLA",
        eks_prompt.la_before_outputs,
        [("_enter(s, Step.START_TEST)  # RaiseLA", "_enter(s, Step.TEST_ONES)  # RaiseLA")],
    ),
    (
        "RightKeysPass",
        EKS,
        "CheckLevel",
        eks_prompt.right_keys_pass,
        [("return access_code & dip_switches != 0", "return access_code == dip_switches")],
    ),
    (
        "FaultNeedsCause",
        EKS,
        "CheckRegisters",
        eks_prompt.fault_needs_cause,
        [("if i.registers_zero:", "if i.registers_zero and not i.inserted:")],
    ),
    (
        "KeyIsForgotten",
        EKS,
        "ClearOutputs",
        EKS.after_a_scan(eks_prompt.key_is_forgotten),
        [("Step.CHECK_REGISTERS, NO_KEY, 0)  # ResetOutputs", "Step.CHECK_REGISTERS, s.key, 0)")],
    ),
    (
        "ReaderAnswersAtOnce",
        EKS,
        "Empty",
        eks_prompt.reader_answers_at_once,
        [
            (
                "if not i.inserted:\n        return s",
                "if not i.inserted or not i.registers_zero:\n        return s",
            )
        ],
    ),
    (
        "comes closer",
        RESPONSE,
        "Error",
        fplc_response.comes_closer,
        [
            (
                "if elapsed >= s.params.T_DWELL_ms:\n        return _wait(s, s.params.T_DWELL_ms)",
                "if elapsed >= s.params.T_DWELL_ms:\n        return _wait(s, 0)",
            ),
            ("and elapsed >= s.params.T_DWELL_ms", "and elapsed > s.params.T_DWELL_ms"),
        ],
    ),
    ("a dwell time that restarts", RESPONSE, "Error", fplc_response.shrinks, [DWELL_RESTARTS]),
    ("a removal that restarts", RESPONSE, "AwaitZeros", fplc_response.shrinks, [REMOVAL_RESTARTS]),
    ("a removal that never ends", RESPONSE, "AwaitZeros", fplc_response.shrinks, [NEVER_IDLE]),
]


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    ("name", "judge", "control", "sentence", "edits"),
    FAULTS,
    ids=lambda scan: scan if isinstance(scan, str) else "",
)
def test_a_planted_fault_is_refuted_with_an_example_that_happens(
    name: str, judge: Judge, control: str, sentence: Sentence, edits: list[tuple[str, str]]
) -> None:
    with planted(judge.device, *edits) as device:
        scan = begun_in(device, control)
        assert refuted(replace(judge, device=device, explored=(scan,)), sentence, control)
    assert not refuted(judge, sentence, control)


def _off_the_way(judge: Judge, way: fplc_response.OnTheWay, times: Callable[[Any], z3.BoolRef]) -> list[str]:
    """The claims of the response within a time that are false of these scans."""
    asked = fplc_response.stays_on_the_way(way, fplc_response.ANYWHERE, times, judge)
    return [one.name for one in asked if one.expected == "unsat" and ask_z3(one, "", LONG_MS).answer == "sat"]


@pytest.mark.parametrize(
    ("control", "edit"),
    [("Error", DWELL_RESTARTS), ("AwaitZeros", REMOVAL_RESTARTS), ("AwaitZeros", NEVER_IDLE)],
)
def test_a_dwell_time_that_restarts_breaks_the_timely_response(control: str, edit: tuple[str, str]) -> None:
    with planted(RESPONSE.device, edit) as device:
        judge = replace(RESPONSE, device=device, explored=(begun_in(device, control),))
        assert _off_the_way(judge, fplc_response.on_the_way, fplc_response.any_times)


@pytest.mark.parametrize(
    ("control", "edit"), [("Clear", TIMER_ANEW), ("AwaitZeros", REMOVAL_RESTARTS), ("AwaitZeros", NEVER_IDLE)]
)
def test_a_removal_timer_that_restarts_breaks_the_clean_end(control: str, edit: tuple[str, str]) -> None:
    way, times = fplc_response.without_error, fplc_response.times_of_a_good_removal
    with planted(RESPONSE.device, edit) as device:
        judge = replace(RESPONSE, device=device, explored=(begun_in(device, control),))
        assert f"later, from {control}" in _off_the_way(judge, way, times)


def test_every_property_that_a_theorem_names_has_a_planted_fault() -> None:
    named = {name for item in SMALL for name in item.properties}
    assert len(named) >= 14
    assert named <= {name for name, *_ in FAULTS}


def test_every_property_of_one_device_is_proved_as_shipped() -> None:
    """What holds under arbitrary inputs is a promise of one device: TLC's result has a theorem beside it.

    The contract is no device: what it says of itself has no code.
    """
    properties = load_document(ROOT, "mode_selection").properties
    asked = {one.id for one in properties if "arbitrary" in one.environments}
    alone = (asked & decided("mode_selection")) - {
        one.id for one in properties if one.module == "ModeSelectionAlone"
    }
    named = {name for item in theorems_of("mode_selection") for name in item.properties}
    assert len(alone) > 30
    assert alone <= named


@pytest.mark.parametrize(
    ("other", "error", "why"),
    [
        ("State(Params(), Step.INHIBITED, NONE, NONE)", ConcretizationError, "changes its parameters"),
        ("_planted()", TheoremError, "from Confirm step raises: name '_planted' is not defined"),
    ],
)
def test_a_step_that_cannot_be_judged_is_refused(other: str, error: type[Exception], why: str) -> None:
    with planted(PANEL.device, ("State(s.params, Step.INHIBITED, NONE, NONE)", other)) as device:
        judge = replace(PANEL, device=device, explored=(begun_in(device, "Confirm"),))
        with pytest.raises(error, match=why):
            judge.scans()


QUIET: dict[str, Any] = {
    "LA": False,
    **dict.fromkeys(["A", "B", "C", "D", "STR"], False),
    "MW03": 0,
    "MW07": 0,
}


def test_real_runs_need_no_more_scans_than_proved() -> None:
    random_ = random.Random(5)
    longest = 0.0
    for _ in range(2_000):
        dwell, between = random_.choice((0, 5, 40)), random_.choice((1, 2, 10, 60))
        params = fplc.Params(T_REM_ms=dwell + random_.choice((1, between)), T_DWELL_ms=dwell)
        state = fplc.State(
            params, random_.choice([*fplc.Step]), -1, -1, -1, -1, random_.choice((0, 1, dwell))
        )
        scans = 0
        while state.state != fplc.IDLE:
            dt_ms = between + random_.choice((0, 0, 0, 1))
            state, _ = fplc.step(state, fplc.Inputs(dt_ms, **QUIET))
            scans += 1
        assert scans * between <= 4 * between + 2 * dwell
        longest = max(longest, scans * between / (4 * between + 2 * dwell))
    assert longest > 0.9


def _ms_until_idle(state: fplc.State, between: int, random_: random.Random) -> int:
    """Time from the first quiet scan to the last one before Idle."""
    state, _ = fplc.step(state, fplc.Inputs(random_.choice((0, between)), **QUIET))
    passed = last = 0
    while state.state != fplc.IDLE:
        last = passed
        dt_ms = random_.choice((1, between // 2, between - 1, between))
        state, _ = fplc.step(state, fplc.Inputs(dt_ms, **QUIET))
        passed += dt_ms
    return last


def test_the_longest_run_lies_between_half_and_the_proved_time() -> None:
    random_ = random.Random(3)
    longest = 0.0
    for _ in range(4_000):
        dwell, between = random_.choice((0, 5, 40)), random_.choice((2, 10, 60))
        params = fplc.Params(T_REM_ms=dwell + random_.choice((1, between)), T_DWELL_ms=dwell)
        elapsed = random_.choice((0, 1, params.T_REM_ms))
        state = fplc.State(params, random_.choice([*fplc.Step]), -1, -1, -1, -1, elapsed)
        passed = _ms_until_idle(state, between, random_)
        assert passed <= 2 * dwell + 2 * between
        longest = max(longest, passed / (2 * dwell + 2 * between))
    assert longest > 0.5

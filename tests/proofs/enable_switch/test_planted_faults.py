"""Each theorem that proves a property of the enable switch falls to a fault planted in a copy of its code."""

from __future__ import annotations

import pytest

from proofs.enable_switch import invariants, step_paths, switch_answers, switch_outputs, switch_safety
from proofs.enable_switch.devices import SWITCH
from tests.proofs.block import Planted, decided, named, wrong_answers
from tests.proofs.planted_steps import kept

JUDGE, ANYWHERE = invariants.JUDGE, switch_answers.ANYWHERE


_state = JUDGE.after_a_scan
LATE = ("if time_is_over(s, i):", "if time_is_over(s, i) and not sees_stage_1(i):")
RESET = ("if rises(i.Reset, s.reset_before) or automatic:", "if i.Reset or automatic:")
STATIC = ("if held(i.Reset, s.reset_before) and not automatic:", "if False:")
REMEMBERED = ("return State(s.params, control, i.Reset, 0)", "return State(s.params, control, False, 0)")
NEVER_OVER = (
    "return s.elapsed_ms + i.dt_ms >= s.params.DiscrepancyTimeCh1_Ch3_ms",
    "return s.elapsed_ms + i.dt_ms > s.params.DiscrepancyTimeCh1_Ch3_ms",
)
FAULTS = [
    Planted(
        "EnableNeedsItsConditions",
        JUDGE,
        "Stage0",
        switch_safety.enable_needs_its_conditions,
        [
            (
                "return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2 and i.S_EnableSwitchCh3",
                "return i.S_EnableSwitchCh1",
            )
        ],
    ),
    Planted(
        "EnableNeedsStage0",
        JUDGE,
        "Stage2",
        switch_safety.enable_needs_stage_0,
        [("return _at(s, i, Step.PLAUSIBILITY_ERROR)  # RefuseStage1", "return _at(s, i, Step.STAGE_1)")],
    ),
    Planted(
        "EnableStandsAlone",
        JUDGE,
        "Stage0",
        _state(switch_outputs.enable_stands_alone),
        [
            (
                "Outputs(True, True, False, False, False, 0x8000)",
                "Outputs(True, True, True, False, False, 0x8000)",
            )
        ],
    ),
    Planted(
        "IdleIsSilent",
        JUDGE,
        "Stage1",
        _state(switch_outputs.idle_is_silent),
        [
            (
                "Outputs(False, False, False, False, False, 0x0000)",
                "Outputs(False, True, False, False, False, 0x0000)",
            )
        ],
    ),
    Planted(
        "ActivateGoesFirst",
        JUDGE,
        "Stage1",
        switch_safety.activate_goes_first,
        [("if not i.Activate:", "if not i.Activate and s.state != Step.STAGE_1:")],
    ),
    Planted(
        "ModeEndsOperation",
        JUDGE,
        "Stage1",
        switch_safety.mode_ends_operation,
        [("return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive", "return _at(s, i, Step.STAGE_0)")],
    ),
    Planted(
        "ErrorNeedsReset", JUDGE, "OperationErrorAtStage0", switch_safety.error_needs_reset, [RESET, STATIC]
    ),
    Planted(
        "ErrorNeedsReset",
        JUDGE,
        "EquivalenceError",
        switch_safety.error_needs_reset,
        [("if s.params.MODE_ENDS_ERROR and not i.S_SafetyActive:", "if not i.S_SafetyActive:")],
    ),
    Planted(
        "ErrorNeedsResetInTheMode",
        JUDGE,
        "PlausibilityError",
        switch_safety.error_needs_reset_in_the_mode,
        [("if s.params.MODE_ENDS_ERROR and not i.S_SafetyActive:", "if s.params.MODE_ENDS_ERROR:")],
    ),
    Planted(
        "HeldResetNeverResets",
        JUDGE,
        "EquivalenceErrorAtStage0",
        switch_safety.held_reset_never_resets,
        [RESET, STATIC],
    ),
    Planted(
        "HeldResetIsAnError",
        JUDGE,
        "EquivalenceErrorAtStage0",
        switch_safety.held_reset_is_an_error,
        [STATIC],
    ),
    Planted(
        "DisagreementEndsInError",
        JUDGE,
        "ChangeToStage0",
        switch_safety.disagreement_ends_in_error,
        [NEVER_OVER],
    ),
    Planted(
        "ContradictionEndsInError",
        JUDGE,
        "ChangeToStage1",
        switch_safety.contradiction_ends_in_error,
        [NEVER_OVER],
    ),
    Planted("EnableComesInTime", JUDGE, "ChangeToStage1", switch_safety.enable_comes_in_time, [LATE]),
    Planted(
        "PatternsDecide",
        ANYWHERE,
        "Stage1",
        switch_answers.patterns_decide,
        [("return _at(s, i, Step.CHANGE_TO_STAGE_0)  # BeginReturn", "return _at(s, i, Step.STAGE_1)")],
    ),
    Planted(
        "OneTransitionACall",
        ANYWHERE,
        "PlausibilityErrorAtStage0",
        switch_answers.one_transition,
        [("return _at(s, i, Step.STAGE_0)  # LeaveError", "return _at(s, i, Step.SAFE_MODE)")],
    ),
    Planted(
        "HeldResetNeverResets",
        JUDGE,
        "OperationErrorAtStage0",
        switch_safety.held_reset_never_resets,
        [
            (
                "if rises(i.Reset, s.reset_before) or automatic:",
                "if rises(i.Reset, s.reset_before) or automatic or not i.S_SafetyActive:",
            )
        ],
    ),
    Planted(
        "ErrorNeedsEdge",
        JUDGE,
        "EquivalenceErrorAtStage0",
        switch_safety.error_needs_reset,
        [("automatic = s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "automatic = i.S_AutoReset")],
    ),
    Planted(
        "OutputsFollowTheCode",
        JUDGE,
        "EquivalenceError",
        _state(switch_outputs.outputs_follow_the_code),
        [
            (
                "Outputs(True, False, False, True, True, 0xC450)",
                "Outputs(True, False, False, False, True, 0xC450)",
            )
        ],
    ),
    Planted(
        "PowerUpIsSilent",
        JUDGE,
        "Stage1",
        _state(switch_outputs.idle_is_silent),
        [
            (
                "Outputs(False, False, False, False, False, 0x0000)",
                "Outputs(True, False, False, False, False, 0x0000)",
            )
        ],
    ),
    Planted(
        "EnablesAgain",
        ANYWHERE,
        "Stage0",
        switch_answers.stage_1_enables,
        [("return _at(s, i, Step.STAGE_1)  # Enable", "return _at(s, i, Step.STAGE_2)")],
    ),
    Planted(
        "EnablesAgain",
        ANYWHERE,
        "ResetError2",
        switch_answers.comes_closer,
        [
            (
                "if i.Reset:\n        return _at(s, i, s.state)",
                "if not i.Activate or not i.Reset:\n        return _at(s, i, s.state)",
            )
        ],
    ),
    Planted("the invariant", JUDGE, "Stage0", kept(JUDGE), [REMEMBERED]),
    Planted(
        "EveryStateHasItsRow",
        JUDGE,
        "Stage2",
        _state(switch_outputs.row_of_the_state),
        [("0x8832", "0x8812")],
    ),
    Planted(
        "the time",
        JUDGE,
        "ChangeToStage1",
        switch_safety.timer_counts,
        [("s.elapsed_ms + i.dt_ms)  # AwaitChange", "i.dt_ms)")],
    ),
    Planted(
        "LateChangeHasItsError",
        JUDGE,
        "ChangeToStage0",
        switch_safety.ends_by_its_cause,
        [("if all_true(i):", "if i.S_EnableSwitchCh2:")],
    ),
    Planted(
        "ResetEndsTheError",
        ANYWHERE,
        "PlausibilityErrorAtStage0",
        switch_answers.resets_lead_back,
        [("        if i.S_SafetyActive:\n            return _at(s, i, Step.STAGE_0)  # LeaveError\n", "")],
    ),
    Planted(
        "the edge",
        ANYWHERE,
        "OperationErrorAtStage0",
        switch_answers.the_edge_resets,
        [("if rises(i.Reset, s.reset_before) or automatic:", "if automatic:")],
    ),
    Planted(
        "the kind of error",
        ANYWHERE,
        "ResetError3",
        switch_answers.kept_in_error,
        [
            (
                "return _reset_error(s, i, Step.EQUIVALENCE_ERROR_AT_STAGE_0)",
                "return _reset_error(s, i, Step.OPERATION_ERROR_AT_STAGE_0)",
            )
        ],
    ),
    Planted(
        "EndOfModeEndsErrors",
        ANYWHERE,
        "EquivalenceError",
        switch_answers.parameter_ends_errors,
        [("if s.params.MODE_ENDS_ERROR and not i.S_SafetyActive:", "if False:")],
    ),
]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("fault", FAULTS, ids=[f"{fault.name}-{fault.control}" for fault in FAULTS])
def test_a_planted_fault_is_refuted_with_an_example_that_happens(fault: Planted) -> None:
    assert fault.refuted()
    assert not fault.refuted_unplanted()


def test_every_property_that_a_theorem_names_has_a_planted_fault() -> None:
    proved = named(switch_answers, switch_outputs, switch_safety, step_paths)
    assert {fault.name for fault in FAULTS} >= proved - {"EveryCallIsAnswered"}
    assert decided("enable_switch") == proved


def test_the_theorem_of_the_paths_is_true() -> None:
    queries = step_paths.every_call_of_the_switch_takes_exactly_one_path.queries()
    assert len(queries) >= 2 * len(SWITCH.register.states)
    assert not wrong_answers(queries[:8])

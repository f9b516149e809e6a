"""Each theorem about external device monitoring falls to a fault planted in a copy of its code."""

from __future__ import annotations

from dataclasses import replace

import pytest
import z3

from proofs.edm import block_resets, block_response, block_safety, rows, step_paths
from proofs.edm.devices import BLOCK
from proofs.edm.invariant import JUDGE
from tests.proofs.block import Planted, decided, named, wrong_answers
from tests.proofs.planted_steps import kept, planted

ANYWHERE = rows.FROM_ANYWHERE


_state = JUDGE.after_a_scan
OFF, ON = "OutputDisable", "OutputEnable"
STATIC = ("if s.reset_before:", "if s.reset_before and i.S_OutControl:")
DROPPED = ("return i.S_EDM1 and i.S_EDM2", "return i.S_EDM1")
PICKED = ("return not i.S_EDM1 and not i.S_EDM2", "return not i.S_EDM1")
LATE = ("s.elapsed_ms + i.dt_ms >= s.params", "s.elapsed_ms >= s.params")
ROW = "Outputs(True, False, False, True, True, code)"
FAULTS = [
    Planted(
        "OutputNeedsAll",
        ANYWHERE,
        OFF,
        _state(rows.row_of_the_state),
        [(ROW, ROW.replace("True, False, False", "True, True, False"))],
    ),
    Planted(
        "IdleShowsNothing",
        ANYWHERE,
        "Init",
        _state(rows.row_of_the_state),
        [("False, False, False, False, False, 0x0000", "False, False, True, False, False, 0x0000")],
    ),
    Planted(
        "CodeTellsTheRow",
        ANYWHERE,
        "Init",
        _state(rows.code_tells_the_row),
        [("True, False, True, False, False, 0x8810", "True, False, True, False, False, 0x8010")],
    ),
    Planted(
        "StopAtOnce",
        JUDGE,
        ON,
        block_safety.stop_at_once,
        [("    if not i.S_OutControl:\n", "    if not s.out_control_before:\n")],
    ),
    Planted(
        "InactiveAtOnce",
        JUDGE,
        "EDMError12",
        block_safety.inactive_at_once,
        [("elif not inputs.Activate:", "elif not inputs.Activate and not inputs.Reset:")],
    ),
    Planted(
        "StartsWithInhibit",
        JUDGE,
        "Idle",
        block_safety.starts_with_inhibit,
        [
            (
                "    if i.Activate:\n        return _enter(s, i, Step.INIT)",
                "    if i.Activate:\n        return _init(s, i)",
            )
        ],
    ),
    Planted(
        "OneTransitionACall",
        ANYWHERE,
        "Init",
        block_safety.one_transition,
        [("return _disable(s, i, True)  # StartWithoutInhibit", "return _output_disable(s, i)")],
    ),
    Planted("SwitchOnNeedsInitialState", JUDGE, OFF, block_safety.switch_on_needs_initial_state, [DROPPED]),
    Planted("FeedbackWrongOnlyForATime", JUDGE, ON, block_safety.wrong_only_for_a_time, [LATE]),
    Planted("MissedPickUpIsAnError", JUDGE, ON, block_safety.missed_pick_up, [PICKED]),
    Planted("MissedDropOutIsAnError", JUDGE, OFF, block_safety.missed_drop_out, [LATE]),
    Planted(
        "ResetNeverStarts",
        JUDGE,
        OFF,
        block_safety.reset_never_starts,
        [("requested = i.S_OutControl and s.stop_seen", "requested = i.S_OutControl")],
    ),
    Planted("ResetNeedsEdge", JUDGE, "EDMError33", block_resets.reset_needs_edge, [STATIC]),
    Planted("CauseIsGone", JUDGE, "EDMError21", block_resets.cause_is_gone, [DROPPED]),
    Planted(
        "ErrorsAreLeftAsDocumented",
        JUDGE,
        "ResetError1",
        block_resets.errors_are_left,
        [("return _enter(s, i, Step.INIT)  # ReturnToInit", "return _disable(s, i, True)")],
    ),
    Planted("HeldResetIsAnError", JUDGE, "Init", block_resets.held_reset, [STATIC]),
    Planted(
        "TwoEdgesAreAnError",
        JUDGE,
        "Init",
        block_resets.two_edges,
        [("if rises(i.S_OutControl, s.out_control_before):", "if s.out_control_before:")],
    ),
    Planted(
        "StartsByItself",
        JUDGE,
        "Init",
        block_resets.starts_by_itself,
        [("    if i.S_StartReset:\n", "    if i.S_StartReset and i.Reset:\n")],
    ),
    Planted(
        "RemovesInhibitAtOnce",
        JUDGE,
        "Init",
        block_resets.removes_inhibit,
        [("if rises(i.S_OutControl, s.out_control_before):", "if i.S_OutControl:")],
    ),
    Planted(
        "ResetsAtOnce",
        JUDGE,
        "EDMError13",
        block_resets.resets_at_once,
        [("if not _both_dropped_out(i):", "if not _both_dropped_out(i) or i.S_OutControl:")],
    ),
    Planted(
        "ErrorNeedsCause",
        JUDGE,
        ON,
        block_resets.error_needs_cause,
        [("if _time_is_over(s, i) and not _both_picked_up(i):", "if _time_is_over(s, i):")],
    ),
    Planted(
        "CodeNamesTheCause",
        JUDGE,
        OFF,
        block_resets.code_names_the_cause,
        [("Step.EDM_ERROR_21)  # MissDropOut", "Step.EDM_ERROR_22)  # MissDropOut")],
    ),
    Planted(
        "ResetErrorKeepsTheCode",
        JUDGE,
        "ResetError31",
        block_resets.keeps_the_code,
        [("return _enter(s, i, error)", "return _enter(s, i, Step.EDM_ERROR_11)")],
    ),
    Planted(
        "SwitchesOnAtOnce",
        JUDGE,
        OFF,
        block_response.switches_on_at_once,
        [
            (
                "    if _both_dropped_out(i):\n        if requested:",
                "    if _both_dropped_out(i):\n        if requested and not i.Reset:",
            )
        ],
    ),
    Planted(
        "EnablesAgain",
        ANYWHERE,
        "EDMError32",
        block_response.comes_closer,
        [("if not _both_dropped_out(i):", "if not _both_picked_up(i):")],
    ),
    Planted(
        "the invariant",
        JUDGE,
        "EDMError22",
        kept(JUDGE),
        [("s.params.AFTER_RESET == AT_ONCE or not i.S_OutControl", "s.params.AFTER_RESET == AT_ONCE")],
    ),
]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("fault", FAULTS, ids=[fault.name for fault in FAULTS])
def test_a_planted_fault_is_refuted_with_an_example_that_happens(fault: Planted) -> None:
    assert fault.refuted()
    assert not fault.refuted_unplanted()


def test_properties_have_theorems_and_these_have_planted_faults() -> None:
    proved = named(rows, block_safety, block_resets, block_response, step_paths)
    of_activate = {"ErrorOutlivesDeactivation"}  # it holds of whoever drives Activate, not of the block
    assert proved | of_activate == decided("edm")
    assert {fault.name for fault in FAULTS} == (proved | {"the invariant"}) - {
        "EveryCallIsAnswered",
        "PowerUpIsSafe",
    }


def test_at_power_up_a_fault_is_refuted_too() -> None:
    with planted(BLOCK, ("return State(params, Step.IDLE,", "return State(params, Step.INIT,")) as device:
        judge = replace(JUDGE, device=device)
        (query, *_) = judge.at_power_up(lambda scan, seen: z3.Not(scan.sends.Ready))
        assert wrong_answers([query])
    (query, *_) = JUDGE.at_power_up(lambda scan, seen: z3.Not(scan.sends.Ready))
    assert not wrong_answers([query])


def test_the_theorem_of_the_paths_is_true() -> None:
    queries = step_paths.every_call_takes_exactly_one_path.queries()
    assert len(queries) >= 2 * len(BLOCK.register.states)
    assert not wrong_answers(queries[:8])

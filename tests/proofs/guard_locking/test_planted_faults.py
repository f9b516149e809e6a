"""Each theorem about the guard locking falls to a fault planted in a copy of its code."""

from __future__ import annotations

import pytest
import z3

from proofs.guard_locking import (
    block_locks,
    block_losses,
    block_memory,
    block_response,
    block_safety,
    step_paths,
)
from proofs.guard_locking.devices import BLOCK
from proofs.guard_locking.invariant import JUDGE, LOCKED
from tests.proofs.block import Planted, decided, named, wrong_answers
from tests.proofs.planted_steps import kept

ANYWHERE = block_response.FROM_ANYWHERE


_state = JUDGE.after_a_scan
UNASKED = ("if i.S_SafetyActive and _requested(s, i):", "if i.UnlockRequest or i.S_SafetyActive:")
NO_EDGE = ("if rises(i.Reset, s.reset_before):", "if i.Reset:")
NO_STATIC = ("held(i.Reset, s.reset_before)", "held(i.Reset, i.Activate) and not i.Reset")
ROW = "Outputs(True, False, False, True, 0xC004)"
FAULTS = [
    Planted("RowOfDiagCode", JUDGE, "SafetyReturn", _state(block_safety.row), [("0xC002", "0xC003")]),
    Planted(
        "NothingWhileInactiveOrInError",
        JUDGE,
        "GuardOpenAndUnlocked",
        _state(block_safety.nothing_while_inactive),
        [(ROW, ROW.replace("True, False, False", "True, False, True"))],
    ),
    Planted(
        "InactiveIsNoError",
        JUDGE,
        "Init",
        _state(block_safety.nothing_while_inactive),
        [("Outputs(False, False, False, False, 0x0000)", "Outputs(False, False, False, False, 0x8002)")],
    ),
    Planted(
        "NeverEnabledAndUnlocked",
        JUDGE,
        "WaitForReset",
        _state(block_safety.never_both),
        [("Outputs(True, True, False, False, 0x8000)", "Outputs(True, True, True, False, 0x8000)")],
    ),
    Planted(
        "PowerUpIsSafe",
        JUDGE,
        "Init",
        lambda scan: (z3.Not(scan.inputs.Activate), block_safety.safe_at_power_up(scan, None)),
        [("Outputs(False, False, False, False, 0x0000)", "Outputs(True, False, False, False, 0x0000)")],
    ),
    Planted(
        "InactiveAtOnce",
        JUDGE,
        "ResetError2",
        block_safety.inactive_at_once,
        [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    ),
    Planted(
        "EnableNeedsSecuredGuard",
        JUDGE,
        "WaitForReset",
        block_safety.enable_needs_secured_guard,
        [
            (
                "if not (i.S_GuardMonitoring and i.S_GuardLock):\n        return Step.WAIT_FOR_OPERATOR",
                "if not i.S_GuardMonitoring:\n        return Step.WAIT_FOR_OPERATOR",
            )
        ],
    ),
    Planted("NoAutomaticRestart", JUDGE, "Init", block_safety.no_automatic_restart, [NO_STATIC, NO_EDGE]),
    Planted(
        "StartUpInhibitNeedsReset",
        JUDGE,
        "WaitForReset",
        block_safety.start_up_inhibit_needs_reset,
        [("alone = i.S_AutoReset and not s.start_up_inhibit", "alone = i.S_AutoReset")],
    ),
    Planted(
        "LossNeedsReset",
        JUDGE,
        "SafetyReturn",
        block_losses.loss_needs_reset,
        [
            ("return Step.WAIT_FOR_OPERATOR  # AcknowledgeError", "return Step.GUARD_CLOSED_AND_LOCKED"),
            ("if rises(i.Reset, s.reset_before):", "if i.S_AutoReset:"),
        ],
    ),
    Planted(
        "LossNeedsGuardBack",
        JUDGE,
        "SafetyReturn",
        kept(JUDGE),
        [("s.guard_lost or s.params.CAUSE_OF_LOSS == GUARD_AND_ZONE", "s.params.CAUSE_OF_LOSS == ZONE")],
    ),
    Planted(
        "StaticResetNeverResets",
        JUDGE,
        "SafetyReturn",
        block_safety.static_reset_resets_nothing,
        [NO_STATIC, NO_EDGE],
    ),
    Planted("StaticResetIsFound", JUDGE, "WaitForReset", block_safety.static_reset_is_found, [NO_STATIC]),
    Planted(
        "LossIsAnError",
        JUDGE,
        LOCKED,
        block_losses.loss_is_an_error,
        [("return Step.SAFETY_LOST  # LoseGuard", "return Step.WAIT_FOR_OPERATOR")],
    ),
    Planted(
        "ErrorNeedsCause",
        JUDGE,
        "WaitForOperator",
        block_losses.error_needs_cause,
        [("if not i.S_SafetyActive and not (i.S", "if not (i.S")],
    ),
    Planted(
        "ErrorEndsWithCause",
        JUDGE,
        "ResetError3",
        block_losses.error_ends_with_cause,
        [("return Step.WAIT_FOR_RESET  # ReleaseReset", "return Step.WAIT_FOR_OPERATOR")],
    ),
    Planted(
        "OneTransitionACall",
        JUDGE,
        "Idle",
        block_safety.in_the_table,
        [("return Step.INIT  # StartUp", "return Step.WAIT_FOR_RESET")],
    ),
    Planted(
        "CodeTellsTheGuard",
        JUDGE,
        "GuardOpenAndUnlocked",
        block_safety.code_tells_the_guard,
        [("return Step.GUARD_OPEN_AND_UNLOCKED  # StayOpen", "return Step.GUARD_CLOSED_BUT_UNLOCKED")],
    ),
    Planted("UnlockNeedsSafeZone", JUDGE, LOCKED, block_locks.unlock_needs_safe_zone, [UNASKED]),
    Planted(
        "UnlockedOnlyWhileSafe",
        JUDGE,
        "GuardOpenAndUnlocked",
        block_locks.unlocked_only_while_safe,
        [("if not i.S_SafetyActive and s.params.ZONE_LOST == ERROR:", "if False:")],
    ),
    Planted(
        "NoErrorLocksSafeZone",
        JUDGE,
        "GuardOpenAndUnlocked",
        block_locks.no_error_locks_safe_zone,
        [
            (
                "    if i.S_GuardMonitoring:\n",
                "    if i.S_GuardLock:\n        return Step.SAFETY_LOST\n    if i.S_GuardMonitoring:\n",
            )
        ],
    ),
    Planted(
        "UnlockedOnlyWhileRequested",
        JUDGE,
        "GuardOpenAndUnlocked",
        block_locks.unlocked_only_while_requested,
        [("    if _ends(s, i):\n        return Step.WAIT_FOR_OPERATOR  # WithdrawWhileOpen\n", "")],
    ),
    Planted(
        "MessageUntilReset",
        JUDGE,
        "SafetyLost",
        block_losses.message_until_reset,
        [("s.params.MESSAGE_OF_LOSS == UNTIL_RESET, 0x8014", "False, 0x8014")],
    ),
    Planted(
        "LossOfZoneNeedsNoGuard",
        JUDGE,
        "SafetyReturn",
        block_losses.loss_of_zone_needs_no_guard,
        [("guard_too = s.guard_lost or", "guard_too = s.params.CAUSE_OF_LOSS == WHAT_WAS_LOST or")],
    ),
    Planted(
        "what was lost",
        JUDGE,
        LOCKED,
        block_memory.guard_lost,
        [("if went_to == Step.SAFETY_LOST and s.state ==", "if went_to == Step.SAFETY_LOST and s.state !=")],
    ),
    Planted(
        "UnlockNeedsRequest",
        JUDGE,
        "WaitForOperator",
        block_locks.unlock_needs_request,
        [("if i.UnlockRequest and i.S_SafetyActive:", "if i.S_SafetyActive:")],
    ),
    Planted(
        "UnlockNeedsRequestWhileLocked",
        JUDGE,
        LOCKED,
        block_locks.request_while_locked,
        [("if s.params.UNLOCK_ON == LATCHED and s.request_pending:", "if s.params.UNLOCK_ON == LATCHED:")],
    ),
    Planted(
        "UnlockNeedsRequestNow",
        JUDGE,
        LOCKED,
        block_locks.request_now,
        [("return rises(i.UnlockRequest, s.unlock_request_before)", "return i.UnlockRequest")],
    ),
    Planted(
        "HeldRequestUnlocks",
        JUDGE,
        LOCKED,
        block_locks.held_request_unlocks,
        [("if s.params.UNLOCK_ON == LEVEL:", "if s.params.UNLOCK_ON == LEVEL and i.Reset:")],
    ),
    Planted(
        "RequestUnlocksAtOnce",
        JUDGE,
        LOCKED,
        block_locks.request_unlocks_at_once,
        [("return rises(i.UnlockRequest, s.unlock_request_before)", "return s.request_pending")],
    ),
    Planted(
        "LatchedRequestUnlocks",
        JUDGE,
        LOCKED,
        block_locks.latched_request_unlocks,
        [
            (
                "s.params.UNLOCK_ON == LATCHED and s.request_pending:",
                "s.params.UNLOCK_ON == LATCHED and False:",
            )
        ],
    ),
    Planted(
        "StaysUnlockedWhileRequested",
        JUDGE,
        "GuardClosedButUnlocked",
        block_locks.stays_unlocked_while_requested,
        [("if not i.UnlockRequest:\n", "if i.S_GuardLock:\n")],
    ),
    Planted(
        "StaysUnlockedWhileOpen",
        JUDGE,
        "GuardOpenAndUnlocked",
        block_locks.stays_unlocked_while_open,
        [("return Step.GUARD_OPEN_AND_UNLOCKED  # StayOpen", "return Step.WAIT_FOR_OPERATOR")],
    ),
    Planted(
        "LocksWithoutRequest",
        JUDGE,
        "GuardClosedButUnlocked",
        block_locks.locks_without_request,
        [("if not i.UnlockRequest:\n", "if not i.UnlockRequest and i.S_GuardLock:\n")],
    ),
    Planted(
        "LockedWhateverTheZone",
        JUDGE,
        LOCKED,
        block_locks.locked_whatever_the_zone,
        [("return Step.GUARD_CLOSED_AND_LOCKED  # StayLocked", "return Step.SAFETY_LOST")],
    ),
    Planted("StaysLocked", JUDGE, LOCKED, block_locks.stays_locked, [UNASKED]),
    Planted(
        "the wires",
        JUDGE,
        "SafetyLost",
        block_memory.remembers_the_wires,
        [("        inputs.Reset,\n", "        inputs.Reset and inputs.Activate,\n")],
    ),
    Planted(
        "the pending request",
        JUDGE,
        LOCKED,
        block_memory.pending,
        [("s.request_pending or not s.unlock_request_before", "not s.unlock_request_before")],
    ),
    Planted(
        "the inhibit",
        JUDGE,
        "Init",
        block_memory.inhibit,
        [("== UNTIL_RESET and not i.S_StartReset", "== UNTIL_RESET")],
    ),
    Planted(
        "AnswersAtOnce",
        JUDGE,
        "SafetyLost",
        block_response.answers_at_once,
        [
            (
                "if i.S_SafetyActive:\n        return Step.SAFETY_RETURN",
                "if i.Reset:\n        return Step.SAFETY_RETURN",
            )
        ],
    ),
    Planted(
        "LeavesForACause",
        JUDGE,
        "WaitForReset",
        block_response.leaves_for_a_cause,
        [
            (
                "if not (i.S_GuardMonitoring and i.S_GuardLock):\n        return Step.WAIT_FOR_OPERATOR",
                "if not i.S_SafetyActive:\n        return Step.WAIT_FOR_OPERATOR",
            )
        ],
    ),
    Planted(
        "EnablesAgain",
        ANYWHERE,
        "ResetError2",
        block_response.comes_closer,
        [("return Step.SAFETY_RETURN  # ReleaseReset", "return Step.SAFETY_LOST")],
    ),
    Planted(
        "EntryIsGranted",
        JUDGE,
        "WaitForOperator",
        block_response.lets_in,
        [("if i.UnlockRequest and i.S_SafetyActive:", "if i.UnlockRequest and not i.S_GuardLock:")],
    ),
    Planted(
        "the invariant",
        JUDGE,
        "Init",
        kept(JUDGE),
        [("== UNTIL_RESET and not i.S_StartReset", "== UNTIL_OPENED and not i.S_StartReset")],
    ),
]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("fault", FAULTS, ids=[fault.name for fault in FAULTS])
def test_a_planted_fault_is_refuted_with_an_example_that_happens(fault: Planted) -> None:
    assert fault.refuted()
    if fault.name != "PowerUpIsSafe":  # it speaks of power-up, and is asked of a call here
        assert not fault.refuted_unplanted()


def test_every_property_that_a_theorem_names_has_a_planted_fault() -> None:
    proved = named(block_safety, block_losses, block_locks, block_memory, block_response, step_paths)
    assert {fault.name for fault in FAULTS} >= proved - {"EveryCallIsAnswered"}
    not_of_the_block = {"NobodyInMovingZone", "NoMotionBehindOpenDoor", "NobodyShutInByAnError"}
    known = decided("guard_locking")
    assert known - proved == not_of_the_block


def test_the_theorem_of_the_paths_is_true() -> None:
    queries = step_paths.every_call_takes_exactly_one_path.queries()
    assert len(queries) >= 2 * len(BLOCK.register.states)
    assert not wrong_answers(queries[:8])

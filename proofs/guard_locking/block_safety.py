"""When the block enables: its outputs, the inhibits, Reset, and the transitions of its table.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in GuardLocking and
GuardLockingOpen.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.guard_locking.devices import chosen
from proofs.guard_locking.invariant import JUDGE
from proofs.guard_locking.observer import SEEN, reset_edge
from proofs.sentences import Obligation, Sentence
from proofs.theorem import Queries, theorem

ROWS: Final = {
    "Idle": (False, False, False, False, 0x0000),
    "Init": (True, False, False, False, 0x8001),
    "GuardClosedAndLocked": (True, True, False, False, 0x8000),
    "WaitForReset": (True, False, False, False, 0x8003),
    "WaitForOperator": (True, False, False, False, 0x8011),
    "GuardOpenAndUnlocked": (True, False, True, False, 0x8012),
    "GuardClosedButUnlocked": (True, False, True, False, 0x8013),
    "SafetyReturn": (True, False, False, False, 0x8014),
    "ResetError1": (True, False, False, True, 0xC001),
    "ResetError2": (True, False, False, True, 0xC002),
    "ResetError3": (True, False, False, True, 0xC003),
    "SafetyLost": (True, False, False, True, 0xC004),
}
"""Ready, S_GuardLocked, S_UnlockGuard, Error and DiagCode of each state; Error of SafetyReturn: GLF-06."""


def secure(scan: Scanned) -> z3.BoolRef:
    """The guard is closed and locked in this call."""
    return z3.And(scan.inputs.S_GuardMonitoring, scan.inputs.S_GuardLock)


def enables(scan: Scanned) -> z3.BoolRef:
    """S_GuardLocked rises."""
    return z3.And(z3.Not(scan.sent.S_GuardLocked), scan.sends.S_GuardLocked)


def static(scan: Scanned) -> z3.BoolRef:
    """Reset is TRUE, and was in the call before."""
    return z3.And(scan.inputs.Reset, SEEN.reset)


def allowed(scan: Scanned) -> z3.BoolRef:
    """The input of the inhibit that is due says that there is none."""
    at_start_up = scan.sent.DiagCode == 0x8001
    return z3.If(at_start_up, scan.inputs.S_StartReset, scan.inputs.S_AutoReset)


def nothing(outputs: Any) -> z3.BoolRef:
    """Every output is FALSE, and the code zero."""
    flags = (outputs.Ready, outputs.S_GuardLocked, outputs.S_UnlockGuard, outputs.Error)
    return z3.And(*[z3.Not(flag) for flag in flags], outputs.DiagCode == 0)


def row(scan: Scanned, seen: Any) -> z3.BoolRef:
    state = next(name for name in ROWS if scan.becomes(name))
    ready, locked, unlock, error, code = ROWS[state]
    o = scan.sends
    if state == "SafetyReturn":
        kept = o.Error == chosen(scan.params, "MESSAGE_OF_LOSS", "until_reset")
        off = z3.And(o.Ready, z3.Not(o.S_GuardLocked), z3.Not(o.S_UnlockGuard))
        return z3.And(kept, off, o.DiagCode == code)
    flags = ((o.Ready, ready), (o.S_GuardLocked, locked), (o.S_UnlockGuard, unlock), (o.Error, error))
    return z3.And(*[flag == z3.BoolVal(value) for flag, value in flags], o.DiagCode == code)


@theorem(
    clauses=["GL-OUT-READY", "GL-OUT-GUARDLOCKED", "GL-OUT-UNLOCKGUARD", "GL-OUT-ERROR", "GL-OUT-DIAGCODE"],
    findings=["GLF-01"],
    properties=["RowOfDiagCode"],
)
def every_state_has_its_row_of_outputs() -> Queries:
    """At power-up and after every call the five outputs are those of the row of the state, and no two states
    have the same code. Error of the state that waits for the reset after a loss is TRUE exactly with
    MESSAGE_OF_LOSS = until_reset.
    """
    yield from JUDGE.after_every_scan(row)
    codes = [outputs[4] for outputs in ROWS.values()]
    if len(set(codes)) != len(codes):
        raise ValueError("two states have the same code")
    never: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.S_GuardLocked))  # noqa: E731
    yield JUDGE.too_strong("no row enables", never, "WaitForReset")


def nothing_while_inactive(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    off = z3.Or(z3.Not(o.Ready), o.Error)
    quiet = z3.And(z3.Not(o.S_GuardLocked), z3.Not(o.S_UnlockGuard))
    return z3.And(z3.Implies(off, quiet), z3.Implies(z3.Not(o.Ready), nothing(o)))


@theorem(
    clauses=["GL-OUT-READY", "GL-OUT-ERROR", "GL-OUT-GUARDLOCKED", "GL-SEQ-0"],
    findings=["GLF-09", "GLF-17"],
    properties=["NothingWhileInactiveOrInError", "InactiveIsNoError"],
    slow=True,
)
def nothing_is_enabled_or_unlocked_while_inactive_or_in_error() -> Queries:
    """At power-up and after every call: while the block is not ready or shows an error it neither enables nor
    unlocks; and while it is not ready it shows no error and no code.
    """
    yield from JUDGE.after_every_scan(nothing_while_inactive)
    calm: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.Error))  # noqa: E731
    yield JUDGE.too_strong("there is no error", calm, "GuardOpenAndUnlocked")


def never_both(scan: Scanned, seen: Any) -> z3.BoolRef:
    return z3.Not(z3.And(scan.sends.S_GuardLocked, scan.sends.S_UnlockGuard))


@theorem(
    clauses=["GL-OUT-GUARDLOCKED", "GL-OUT-UNLOCKGUARD"],
    findings=[],
    properties=["NeverEnabledAndUnlocked"],
    slow=True,
)
def the_block_never_enables_and_unlocks_together() -> Queries:
    """At power-up and after every call S_GuardLocked and S_UnlockGuard are not both TRUE."""
    yield from JUDGE.after_every_scan(never_both)
    neither: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.S_UnlockGuard))  # noqa: E731
    yield JUDGE.too_strong("it never unlocks", neither, "GuardClosedAndLocked")


def safe_at_power_up(scan: Scanned, seen: Any) -> z3.BoolRef:
    return nothing(scan.sends) if scan.becomes("Idle") else FALSE


@theorem(
    clauses=["GL-OUT-READY", "GL-SEQ-0", "GL-IN-DEFAULT"],
    findings=[],
    properties=["PowerUpIsSafe"],
    slow=True,
)
def before_the_first_call_every_output_is_false() -> Queries:
    """After power-up and before the first call, with any parameters, the block is idle and every output is
    FALSE.
    """
    yield from JUDGE.at_power_up(safe_at_power_up)
    always = JUDGE.after_a_scan(safe_at_power_up)
    yield JUDGE.too_strong("and after every call", always, "Idle")


def inactive_at_once(scan: Scanned) -> Obligation:
    idle = z3.And(nothing(scan.sends), TRUE if scan.becomes("Idle") else FALSE)
    return TRUE, z3.And(
        scan.sends.Ready == scan.inputs.Activate, z3.Implies(z3.Not(scan.inputs.Activate), idle)
    )


@theorem(
    clauses=["GL-IN-ACTIVATE", "GL-OUT-READY", "GL-SEQ-0", "GL-SEQ-1"],
    findings=["GLF-17", "GLF-21"],
    properties=["InactiveAtOnce"],
    slow=True,
)
def without_activate_every_output_is_false_in_that_call() -> Queries:
    """A call without Activate ends idle with every output FALSE, from every state and before everything else;
    and the block is ready after every call with Activate.
    """
    yield from JUDGE.in_every_scan(inactive_at_once)
    idle: Sentence = lambda scan: (TRUE, nothing(scan.sends))  # noqa: E731
    yield JUDGE.too_strong("in every call", idle, "SafetyLost")


def enable_needs_secured_guard(scan: Scanned) -> Obligation:
    if not scan.becomes("GuardClosedAndLocked"):
        return TRUE, z3.Not(scan.sends.S_GuardLocked)
    return TRUE, z3.And(scan.sends.S_GuardLocked, scan.inputs.Activate, secure(scan))


@theorem(
    clauses=["GL-DOC-2", "GL-OUT-GUARDLOCKED", "GL-SEQ-4"],
    findings=["GLF-12"],
    properties=["EnableNeedsSecuredGuard"],
    slow=True,
)
def no_enable_without_a_closed_and_locked_guard_in_that_call() -> Queries:
    """After every call with S_GuardLocked TRUE, that very call found Activate, S_GuardMonitoring and
    S_GuardLock TRUE.
    """
    yield from JUDGE.in_every_scan(enable_needs_secured_guard)
    safe: Sentence = lambda scan: (scan.sends.S_GuardLocked, scan.inputs.S_SafetyActive)  # noqa: E731
    yield JUDGE.too_strong("and the zone is safe", safe, "WaitForReset")


# ---------------------------------------------------------------- inhibits and Reset


def no_automatic_restart(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(enables(scan), z3.Or(reset_edge(scan), allowed(scan)))


@theorem(
    clauses=["GL-IN-STARTRESET", "GL-IN-AUTORESET", "GL-SEQ-INHIBITS", "GL-SEQ-1", "GL-SEQ-2"],
    findings=["GLF-07"],
    properties=["NoAutomaticRestart"],
    slow=True,
)
def nothing_is_enabled_without_an_edge_of_reset_unless_an_input_allows_it() -> Queries:
    """A call in which S_GuardLocked rises found a rising edge of Reset, or S_StartReset TRUE at start-up, or
    S_AutoReset TRUE after the guard was closed and locked again.
    """
    yield from JUDGE.in_every_scan(no_automatic_restart)
    edge: Sentence = lambda scan: (enables(scan), reset_edge(scan))  # noqa: E731
    yield JUDGE.too_strong("always by an edge", edge, "WaitForReset")
    yield JUDGE.without(no_automatic_restart, "Init", "WiresAreRemembered")


def start_up_inhibited(scan: Scanned) -> z3.BoolRef:
    """The start-up inhibit is still to be removed."""
    return z3.And(SEEN.starting, chosen(scan.params, "START_UP_INHIBIT", "until_reset"))


def start_up_inhibit_needs_reset(scan: Scanned) -> Obligation:
    free = z3.And(scan.sent.DiagCode == 0x8001, scan.inputs.S_StartReset)
    given = z3.And(enables(scan), start_up_inhibited(scan))
    return TRUE, z3.Implies(given, z3.Or(reset_edge(scan), free))


@theorem(
    clauses=["GL-IN-STARTRESET"], findings=["GLF-08"], properties=["StartUpInhibitNeedsReset"], slow=True
)
def a_start_up_inhibit_ends_by_an_edge_of_reset() -> Queries:
    """With START_UP_INHIBIT = until_reset, the first enable after a start-up with inhibit comes in a call
    with a rising edge of Reset, whatever S_AutoReset says and wherever the guard was at start-up.
    """
    yield from JUDGE.in_every_scan(start_up_inhibit_needs_reset)
    yield JUDGE.without(start_up_inhibit_needs_reset, "WaitForReset", "InhibitIsCarried")

    def anyway(scan: Scanned) -> Obligation:
        return z3.And(enables(scan), SEEN.starting), reset_edge(scan)

    yield JUDGE.too_strong("with until_opened too", anyway, "WaitForReset")


def static_reset_resets_nothing(scan: Scanned) -> Obligation:
    waits = z3.Or(*[scan.sent.DiagCode == code for code in (0x8014, 0xC001, 0xC002, 0xC003)])
    there = z3.Or(
        scan.sends.DiagCode == scan.sent.DiagCode,
        *[scan.sends.DiagCode == code for code in (0xC002, 0xC004, 0x0000)],
    )
    kept = z3.And(z3.Implies(enables(scan), allowed(scan)), z3.Implies(waits, there))
    return static(scan), kept


@theorem(
    clauses=["GL-IN-RESET", "GL-IN-EDGE"],
    findings=["GLF-07", "GLF-15"],
    properties=["StaticResetNeverResets"],
    slow=True,
)
def a_reset_that_does_not_move_resets_nothing() -> Queries:
    """A call with a Reset that was TRUE in the call before removes no inhibit that is specified, and leads
    out of no error but with Activate.
    """
    yield from JUDGE.in_every_scan(static_reset_resets_nothing)
    yield JUDGE.without(static_reset_resets_nothing, "SafetyReturn", "WiresAreRemembered")

    def pressed(scan: Scanned) -> Obligation:
        return scan.inputs.Reset, z3.Not(enables(scan))

    yield JUDGE.too_strong("nor does one that is pressed", pressed, "WaitForReset")


def edge_awaited(scan: Scanned) -> z3.BoolRef:
    """An edge of Reset is waited for."""
    if scan.was("Init"):
        return z3.Not(scan.inputs.S_StartReset)
    if scan.was("WaitForReset"):
        return z3.Or(z3.Not(scan.inputs.S_AutoReset), start_up_inhibited(scan))
    return TRUE if scan.was("SafetyReturn") else FALSE


def static_reset_is_found(scan: Scanned) -> Obligation:
    found = scan.sends.DiagCode
    wanted = {
        "Init": z3.Implies(edge_awaited(scan), found == 0xC001),
        "SafetyReturn": found == 0xC002,
        "WaitForReset": z3.Implies(edge_awaited(scan), found == 0xC003),
    }
    where = [one_state for one_state in wanted if scan.was(one_state)]
    if not where:
        return None
    return z3.And(scan.inputs.Activate, static(scan)), wanted[where[0]]


@theorem(clauses=["GL-IN-RESET"], findings=["GLF-07"], properties=["StaticResetIsFound"], slow=True)
def a_reset_that_does_not_move_is_found() -> Queries:
    """Where an edge of Reset is waited for (at start-up and at restart only with their inhibits), an active
    call with a Reset that was TRUE in the call before ends in the reset error of that state.
    """
    yield from JUDGE.in_every_scan(static_reset_is_found)

    def pressed(scan: Scanned) -> Obligation:
        said = static_reset_is_found(scan)
        return None if said is None else (z3.And(scan.inputs.Activate, scan.inputs.Reset), said[1])

    yield JUDGE.too_strong("every Reset is an error", pressed, "SafetyReturn")


TRANSITIONS: Final = {
    "Idle": ("Init",),
    "Init": ("ResetError1", "WaitForOperator", "GuardClosedAndLocked"),
    "GuardClosedAndLocked": ("SafetyLost", "GuardClosedButUnlocked"),
    "GuardClosedButUnlocked": ("SafetyLost", "GuardOpenAndUnlocked", "WaitForOperator"),
    "GuardOpenAndUnlocked": ("SafetyLost", "GuardClosedButUnlocked", "WaitForOperator"),
    "WaitForOperator": ("SafetyLost", "GuardOpenAndUnlocked", "WaitForReset"),
    "WaitForReset": ("ResetError3", "WaitForOperator", "GuardClosedAndLocked"),
    "SafetyLost": ("SafetyReturn",),
    "SafetyReturn": ("ResetError2", "SafetyLost", "WaitForOperator"),
    "ResetError1": ("Init",),
    "ResetError2": ("SafetyReturn",),
    "ResetError3": ("WaitForReset",),
}
"""The table of transitions; besides, every state stays, or goes to Idle without Activate."""


def in_the_table(scan: Scanned) -> Obligation:
    before = next(name for name in TRANSITIONS if scan.was(name))
    return TRUE, TRUE if scan.becomes("Idle", before, *TRANSITIONS[before]) else FALSE


@theorem(clauses=["GL-SEQ-NOTE"], findings=["GLF-01"], properties=["OneTransitionACall"], slow=True)
def a_call_takes_one_transition_of_the_table() -> Queries:
    """Every call stays in its state, ends in Idle, or takes one transition of the table."""
    yield from JUDGE.in_every_scan(in_the_table)

    def stays(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("Idle", "Init") else FALSE

    yield JUDGE.too_strong("it always stays", stays, "Init")


def code_tells_the_guard(scan: Scanned) -> Obligation:
    closed = scan.inputs.S_GuardMonitoring
    by_request = TRUE if scan.was("WaitForOperator") else FALSE
    return TRUE, z3.And(
        z3.Implies(scan.sends.DiagCode == 0x8013, closed),
        z3.Implies(scan.sends.DiagCode == 0x8012, z3.Or(z3.Not(closed), by_request)),
    )


@theorem(
    clauses=["GL-OUT-DIAGCODE", "GL-IN-GUARDMONITORING"],
    findings=["GLF-11"],
    properties=["CodeTellsTheGuard"],
    slow=True,
)
def the_code_of_an_unlocked_guard_tells_whether_it_is_open() -> Queries:
    """After every call with the code of a guard that is closed but unlocked, that call found it closed; with
    the code of an open one it found it open, or came from where a request unlocks a closed one.
    """
    yield from JUDGE.in_every_scan(code_tells_the_guard)

    def open_is_open(scan: Scanned) -> Obligation:
        return scan.sends.DiagCode == 0x8012, z3.Not(scan.inputs.S_GuardMonitoring)

    yield JUDGE.too_strong("also on the way from a request", open_is_open, "WaitForOperator")

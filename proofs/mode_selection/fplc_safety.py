"""Every safety property that is the F-PLC's alone, for all words, times, inputs and parameters.

Each theorem proves the property of properties.toml that it names. It is written like the TLA+ of that
property and judged on every path of the shipped `step`, from every state of the invariant
(fplc_invariant.py); what is said of states also at power-up.
"""

# ruff: noqa: SIM300 -- the names of words are upper case
from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.invariants import HOLDING, ON_ERROR_NONE, ONCE
from proofs.mode_selection.observer import FROM_ONES, INSERTION, REMOVAL, SEEN, SETTLING, Seen
from proofs.mode_selection.vocabulary import (
    LEVELS,
    NONE,
    code,
    is_mode,
    mode,
    none_set,
    only,
    only_of,
    permits,
    several_set,
    vector,
)
from proofs.sentences import Obligation, Sentence
from proofs.theorem import Queries, theorem

TIMED: Final = (*sorted(INSERTION), *sorted(REMOVAL), *SETTLING)

# ---------------------------------------------------------------- what sentences have in common


def switched(scan: Scanned) -> bool:
    """The scan writes the active mode, and not none: also a switchover to the mode that is active. E-71"""
    return not scan.kept("mode") and not scan.after.mode.eq(z3.IntVal(NONE))


def mode_outputs(sends: Any) -> tuple[z3.BoolRef, ...]:
    """The mode outputs by mode."""
    return sends.MSO_0, sends.MSO_1, sends.MSO_2, sends.MSO_3, sends.MSO_4


def now(scan: Scanned) -> z3.ArithRef:
    """The timer of the state as this scan reads it."""
    return scan.before.elapsed_ms + scan.inputs.dt_ms


def zeros_everywhere(scan: Scanned) -> z3.BoolRef:
    """LA, all outputs of the EKS and both words are zero, and the dwell time is over. E-52"""
    i = scan.inputs
    zeros = z3.And(z3.Not(i.LA), none_set(vector(i)), i.MW03 == 0, i.MW07 == 0)
    return z3.And(zeros, now(scan) >= scan.params.T_DWELL_ms)


def mode_is_held(scan: Scanned) -> z3.BoolRef:
    """The active mode is what it was, or is dropped because the parameter says so."""
    dropped = z3.And(scan.params.ON_ERROR == ON_ERROR_NONE, scan.after.mode == NONE)
    return z3.Or(scan.after.mode == scan.before.mode, dropped)


def deadline(c: str, params: Any) -> z3.ArithRef:
    """The deadline of a state that has one."""
    if c == "PulseOnes":
        return params.T_ON_ms
    return params.T_REM_ms if c in REMOVAL | SETTLING else params.T_SEQ_ms


# ---------------------------------------------------------------- outputs and memory


def at_most_one_mode_output(scan: Scanned, seen: Seen) -> z3.BoolRef:
    same = [flag == (scan.after.mode == number) for number, flag in enumerate(mode_outputs(scan.sends))]
    return z3.And(z3.Not(several_set(mode_outputs(scan.sends))), *same)


@theorem(
    clauses=["EKS-KS-5", "EKS-SD-6", "EKS-FD-1"], findings=[], properties=["AtMostOneModeOutput"], slow=True
)
def the_fplc_never_sets_two_mode_outputs() -> Queries:
    """At power-up and after every scan the F-PLC sets at most one mode output, that of the active mode."""
    yield from JUDGE.after_every_scan(at_most_one_mode_output)
    none: Sentence = lambda scan: (TRUE, none_set(mode_outputs(scan.sends)))  # noqa: E731
    yield JUDGE.too_strong("no mode output is ever set", none, "Switch")


def echo_is_the_selection(scan: Scanned, seen: Seen) -> z3.BoolRef:
    s, o = scan.after, scan.sends
    shown = z3.And(
        s.selection != NONE,
        o.MW05 == code("CH", s.selection),
        permits(scan.params, s.authority, s.selection),
        o.MW01 == code("RE", s.authority),
    )
    return z3.Implies(o.MW05 != 0, shown)


@theorem(clauses=["EKS-2-20", "EKS-6-12"], findings=[], properties=["EchoIsTheSelection"], slow=True)
def the_fplc_echoes_only_its_latched_selection() -> Queries:
    """At power-up and after every scan MW05 is zero, or it is the word of the latched selection, which the
    machine permits to the level that MW01 shows.
    """
    yield from JUDGE.after_every_scan(echo_is_the_selection)
    sentence = JUDGE.after_a_scan(echo_is_the_selection)
    yield JUDGE.without(sentence, "EchoSelection", "SelectionIsPermitted")


def words_zero_without_key(scan: Scanned, seen: Seen) -> z3.BoolRef:
    zero = z3.And(scan.sends.MW01 == 0, scan.sends.MW05 == 0)
    return z3.Implies(scan.after.accepted == NONE, zero)


@theorem(clauses=["EKS-8-6", "EKS-8-8"], findings=["E-27"], properties=["WordsZeroWithoutKey"], slow=True)
def the_fplc_sends_zeros_without_an_accepted_key() -> Queries:
    """At power-up and after every scan that leaves no output accepted, MW01 and MW05 are zero."""
    yield from JUDGE.after_every_scan(words_zero_without_key)
    sentence = JUDGE.after_a_scan(words_zero_without_key)
    yield JUDGE.without(sentence, "AwaitSelection", "OneOutputAccepted", "AuthorityIsTheAcceptedLevel")


def selection_within_authority(scan: Scanned, seen: Seen) -> z3.BoolRef:
    s = scan.after
    return z3.And(
        z3.Implies(s.selection != NONE, permits(scan.params, s.authority, s.selection)),
        z3.Implies(s.authority != NONE, s.authority == s.accepted),
    )


@theorem(
    clauses=["EKS-2-18", "EKS-T2-2", "EKS-SD-14"],
    findings=["E-12", "E-18"],
    properties=["SelectionWithinAuthority"],
    slow=True,
)
def the_fplc_keeps_no_selection_beyond_the_accepted_level() -> Queries:
    """At power-up and after every scan a latched selection is one that the machine permits to the authority,
    and the authority is the level of the accepted output.
    """
    yield from JUDGE.after_every_scan(selection_within_authority)
    sentence = JUDGE.after_a_scan(selection_within_authority)
    yield JUDGE.without(sentence, "Match", "SelectionIsPermitted")
    yield JUDGE.without(sentence, "Idle", "NothingWithoutKey")
    yield JUDGE.without(sentence, "AwaitSelection", "SelectionOnlyInATransaction")


def error_drops_mode(scan: Scanned, seen: Seen) -> z3.BoolRef:
    if not scan.becomes("Error"):
        return TRUE
    return z3.Implies(scan.params.ON_ERROR == ON_ERROR_NONE, scan.after.mode == NONE)


@theorem(clauses=["EKS-KS-6"], findings=["E-24"], properties=["ErrorDropsMode"], slow=True)
def the_fplc_drops_the_mode_in_error_where_it_is_so_set() -> Queries:
    """With ON_ERROR = none, no mode is active after any scan that ends in the error mode."""
    yield from JUDGE.after_every_scan(error_drops_mode)
    yield JUDGE.without(JUDGE.after_a_scan(error_drops_mode), "Error", "ErrorDropsTheModeWhereSet")


# ---------------------------------------------------------------- the switchover


def switch_needs_matching_pair(scan: Scanned) -> Obligation:
    if not switched(scan):
        return None
    m, i = scan.after.mode, scan.inputs
    pair = z3.And(is_mode(m), i.MW03 == code("SE", m), i.MW07 == code("SW", m))
    return TRUE, z3.And(pair, SEEN.cleared, SEEN.selected == m, SEEN.echoed)


@theorem(
    clauses=["EKS-2-28", "EKS-2-29", "EKS-SD-2"],
    findings=["E-01", "E-15", "E-16"],
    properties=["SwitchNeedsMatchingPair"],
    slow=True,
)
def the_fplc_switches_only_on_the_pair_of_this_insertion() -> Queries:
    """A scan that writes a mode finds that mode's word in MW03 and in MW07; MW03 came after zeros of this
    insertion with MW07 still zero, and MW05 has shown it since.
    """
    yield from JUDGE.in_every_scan(switch_needs_matching_pair)
    for conjunct in ("ZerosWereSeen", "SelectionWasSeen", "EchoWasSeen"):
        yield JUDGE.without(switch_needs_matching_pair, "Switch", conjunct)


def authorization_respected(scan: Scanned) -> Obligation:
    if not switched(scan):
        return None
    signalled = [
        z3.And(only(vector(scan.inputs), level), permits(scan.params, z3.IntVal(level), scan.after.mode))
        for level in LEVELS
    ]
    return TRUE, z3.Or(*signalled)


@theorem(
    clauses=["EKS-2-18", "EKS-5-10", "EKS-T2-2", "EKS-FD-3", "EKS-FD-4"],
    findings=["E-12", "E-16", "E-18", "E-47"],
    properties=["AuthorizationRespected"],
    slow=True,
)
def the_fplc_never_switches_beyond_the_signalled_level() -> Queries:
    """In a scan that writes a mode exactly one output of the EKS is set, and the machine permits the mode to
    its level.

    Any table of permissions that permits each level its own mode and none above it.
    """
    yield from JUDGE.in_every_scan(authorization_respected)
    yield JUDGE.without(authorization_respected, "Switch", "SelectionIsPermitted")


def authorization_by_the_text(scan: Scanned) -> Obligation:
    if not switched(scan):
        return None
    flags, m = vector(scan.inputs), scan.after.mode
    own = [z3.And(only(flags, level), m == level) for level in LEVELS]
    return TRUE, z3.Or(*own, z3.And(only(flags, 3), z3.Or(m == 1, m == 2)))


@theorem(
    clauses=["EKS-T2-2", "EKS-2-18"], findings=["E-47"], properties=["AuthorizationByTheText"], slow=True
)
def the_fplc_switches_by_the_text_alone_where_it_is_so_set() -> Queries:
    """Where each level permits its own mode and level 3 modes 1 and 2 besides, no other mode is switched
    under it.
    """
    params = JUDGE.device.params()
    beyond = [
        z3.Not(getattr(params, f"PERMITS_{level}")[number].term)
        for level in LEVELS
        for number in range(level)
        if (level, number) not in ((3, 1), (3, 2))
    ]
    yield from JUDGE.in_every_scan(authorization_by_the_text, {"as the text orders them": z3.And(*beyond)})
    yield JUDGE.too_strong("by any table of permissions", authorization_by_the_text, "Switch")


def no_change_without_la(scan: Scanned) -> Obligation:
    return (TRUE, scan.inputs.LA) if switched(scan) else None


@theorem(clauses=["EKS-SD-2"], findings=["E-42"], properties=["NoChangeWithoutLA"], slow=True)
def the_fplc_switches_nothing_without_la() -> Queries:
    """No mode is written in a scan in which LA is off."""
    yield from JUDGE.in_every_scan(no_change_without_la)
    str_too: Sentence = lambda scan: (TRUE, scan.inputs.STR) if switched(scan) else None  # noqa: E731
    yield JUDGE.too_strong("nor without STR", str_too, "Switch")


def no_change_beside_switchover(scan: Scanned) -> Obligation:
    if scan.was("Switch") and scan.becomes("Complete", "Settle"):
        return TRUE, z3.Or(scan.after.mode == scan.before.mode, is_mode(scan.after.mode))
    return TRUE, scan.after.mode == scan.before.mode if not scan.becomes("Error") else mode_is_held(scan)


@theorem(
    clauses=["EKS-8-8", "EKS-SD-7", "EKS-BD-5", "EKS-SD-20"],
    findings=["E-24"],
    properties=["NoChangeBesideSwitchover"],
    slow=True,
)
def nothing_but_the_switchover_changes_the_mode() -> Queries:
    """The active mode is the same after every scan but one that goes from Switch to Settle or Complete, and,
    with ON_ERROR = none, one that ends in the error mode without a mode.
    """
    yield from JUDGE.in_every_scan(no_change_beside_switchover)
    held: Sentence = lambda scan: (TRUE, scan.after.mode == scan.before.mode)  # noqa: E731
    yield JUDGE.too_strong("the mode never changes", held, "Switch")
    yield JUDGE.too_strong("an error never drops it", held, "Idle")


# ---------------------------------------------------------------- faults of the EKS, removal


def two_outputs_lead_to_error(scan: Scanned) -> Obligation:
    if scan.was("PulseOnes", "PulseZeros"):
        return None
    several = several_set(vector(scan.inputs))
    given = z3.And(several, z3.Not(scan.inputs.LA)) if scan.was("Idle") else several
    if not scan.becomes("Error"):
        return given, z3.BoolVal(False)
    return given, z3.And(scan.sends.ERROR, mode_is_held(scan))


@theorem(
    clauses=["EKS-KS-6", "EKS-2-11", "EKS-GP-2-FPLC", "EKS-SD-10"],
    findings=["E-09", "E-06b"],
    properties=["TwoOutputsLeadToError"],
    slow=True,
)
def two_outputs_lead_the_fplc_to_error_in_that_scan() -> Queries:
    """Two outputs of the EKS or more, outside the pulse window, lead to the error mode in that scan, with
    ERROR set and no mode switched.
    """
    yield from JUDGE.in_every_scan(two_outputs_lead_to_error)

    def without_window(scan: Scanned) -> Obligation:
        return several_set(vector(scan.inputs)), TRUE if scan.becomes("Error") else z3.BoolVal(False)

    yield JUDGE.too_strong("in the pulse window too", without_window, "PulseOnes")


def removal_seen_at_once(scan: Scanned) -> Obligation:
    if not scan.was(*HOLDING):
        return None
    gone = z3.Not(z3.And(scan.inputs.LA, only_of(vector(scan.inputs), scan.before.accepted)))
    zero = z3.And(scan.sends.MW01 == 0, scan.sends.MW05 == 0)
    return gone, zero if scan.becomes("Clear", "Error") else z3.BoolVal(False)


@theorem(
    clauses=["EKS-GP-4", "EKS-3-1-FPLC", "EKS-3-0", "EKS-9-0", "EKS-SD-16"],
    findings=[],
    properties=["RemovalSeenAtOnce"],
    slow=True,
)
def the_fplc_ends_a_transaction_in_the_scan_without_its_key() -> Queries:
    """In a scan in which LA is off or another vector than the accepted output is set, MW01 and MW05 fall to
    zero and the F-PLC goes to the removal or to the error mode.
    """
    yield from JUDGE.in_every_scan(removal_seen_at_once)
    yield JUDGE.without(removal_seen_at_once, "AwaitSelection", "OneOutputAccepted")


def idle_only_over_zeros(scan: Scanned) -> Obligation:
    return (TRUE, zeros_everywhere(scan)) if scan.becomes("Idle") and not scan.was("Idle") else None


@theorem(
    clauses=["EKS-8-12", "EKS-8-13", "EKS-8-14", "EKS-8-18", "EKS-SD-9", "EKS-SUM-9"],
    findings=["E-17", "E-23", "E-29"],
    properties=["IdleOnlyOverZeros"],
    slow=True,
)
def the_fplc_comes_to_idle_only_over_zeros() -> Queries:
    """A scan that leads to Idle finds LA, all five outputs, MW03 and MW07 zero, and the dwell time over."""
    yield from JUDGE.in_every_scan(idle_only_over_zeros)

    def later(scan: Scanned) -> Obligation:
        return (TRUE, now(scan) > scan.params.T_DWELL_ms) if idle_only_over_zeros(scan) else None

    yield JUDGE.too_strong("and a millisecond more", later, "AwaitZeros")


def error_only_over_zeros(scan: Scanned) -> Obligation:
    goes_off = z3.And(scan.sent.ERROR, z3.Not(scan.sends.ERROR))
    if scan.was("Error"):
        return goes_off, zeros_everywhere(scan)
    return TRUE, z3.Implies(goes_off, zeros_everywhere(scan))


@theorem(
    clauses=["EKS-3-0", "EKS-9-0", "EKS-GP-4"],
    findings=["E-23", "E-23b"],
    properties=["ErrorOnlyOverZeros"],
    slow=True,
)
def the_error_mode_ends_only_over_zeros() -> Queries:
    """A scan in which ERROR goes off finds LA, all five outputs, MW03 and MW07 zero, and the dwell time
    over.
    """
    yield from JUDGE.in_every_scan(error_only_over_zeros)

    def later(scan: Scanned) -> Obligation:
        return z3.Not(scan.sends.ERROR), now(scan) > scan.params.T_DWELL_ms

    yield JUDGE.too_strong("and a millisecond more", later, "Error")


# ---------------------------------------------------------------- what the words rest on


def selection_needs_level(scan: Scanned) -> Obligation:
    if not (scan.was("CheckSelection") and scan.becomes("EchoSelection")):
        return None
    return TRUE, permits(scan.params, mode("RE", scan.sent.MW01), mode("SE", scan.inputs.MW03))


@theorem(
    clauses=["EKS-2-18", "EKS-5-1", "EKS-KS-8"],
    findings=["E-12"],
    properties=["SelectionNeedsLevel"],
    slow=True,
)
def the_fplc_accepts_a_selection_only_under_the_level_that_it_shows() -> Queries:
    """A selection is accepted only in a scan before which MW01 shows a level to which the machine permits the
    mode in MW03.
    """
    yield from JUDGE.in_every_scan(selection_needs_level)

    def own_mode(scan: Scanned) -> Obligation:
        return (
            None
            if selection_needs_level(scan) is None
            else (TRUE, scan.after.selection == scan.after.authority)
        )

    yield JUDGE.too_strong("only its own mode", own_mode, "CheckSelection")


def echo_needs_selection(scan: Scanned) -> Obligation:
    if z3.is_bv_value(scan.sends.MW05) and scan.sends.MW05.as_long() == 0:
        return None
    shown, flags = mode("CH", scan.sends.MW05), vector(scan.inputs)
    permitted = [
        z3.And(only(flags, level), permits(scan.params, z3.IntVal(level), shown)) for level in LEVELS
    ]
    stands = scan.inputs.MW03 == code("SE", shown)
    if scan.becomes("Complete"):
        stands = z3.Or(stands, scan.after.mode == shown)
    return scan.sends.MW05 != 0, z3.And(stands, z3.Or(*permitted))


@theorem(
    clauses=["EKS-2-20", "EKS-6-12"],
    findings=["E-15", "E-16"],
    properties=["EchoNeedsSelection"],
    slow=True,
)
def the_fplc_echoes_only_what_stands_in_mw03() -> Queries:
    """In every scan that sends an echo, MW03 carries the word of the same mode, or it was switched as the one
    selection of this insertion, one output is set, and the machine permits the mode to its level.
    """
    yield from JUDGE.in_every_scan(echo_needs_selection)
    yield JUDGE.without(echo_needs_selection, "EchoSelection", "SelectionIsPermitted")
    yield JUDGE.without(echo_needs_selection, "Complete", "OneSelectionWhereSet")


def one_selection_where_set(scan: Scanned) -> Obligation:
    once = scan.params.SELECTIONS == ONCE
    if scan.was("Complete"):
        return once, z3.BoolVal(scan.becomes("Complete", "Clear", "Error") and not switched(scan))
    if not switched(scan):
        return None
    if scan.becomes("Complete"):
        return TRUE, once
    return TRUE, z3.And(z3.Not(once), z3.BoolVal(scan.becomes("Settle")))


@theorem(clauses=["EKS-2-29", "EKS-GP-5"], findings=["E-15"], properties=["OneSelectionWhereSet"], slow=True)
def the_fplc_switches_once_in_each_insertion_where_it_is_so_set() -> Queries:
    """A scan that writes a mode leads to Complete with SELECTIONS = once, and to Settle with again. With once
    Complete is left for the removal or the error mode alone, without a switchover.
    """
    yield from JUDGE.in_every_scan(one_selection_where_set)
    yield JUDGE.too_strong(
        "in any case",
        lambda scan: (TRUE, z3.BoolVal(scan.becomes("Complete"))) if switched(scan) else None,
        "Switch",
    )


def level_needs_pulse(scan: Scanned) -> Obligation:
    appears = z3.And(scan.sent.MW01 == 0, scan.sends.MW01 != 0)
    if scan.was("Authorize", "Settle") and scan.becomes("AwaitSelection"):
        return appears, SEEN.pulse == 2
    return TRUE, z3.Implies(appears, SEEN.pulse == 2)


@theorem(
    clauses=["EKS-2-10", "EKS-4-1", "EKS-4-3"], findings=["E-10"], properties=["LevelNeedsPulse"], slow=True
)
def the_fplc_shows_a_level_only_after_the_test_pulse() -> Queries:
    """A scan in which MW01 turns from zero to a level comes after all outputs and then none were seen, with
    LA on since.
    """
    yield from JUDGE.in_every_scan(level_needs_pulse)
    yield JUDGE.without(level_needs_pulse, "Authorize", "PulseWasSeen")


# ---------------------------------------------------------------- times


def no_wait_beyond_deadline(scan: Scanned, seen: Seen) -> z3.BoolRef:
    for c in TIMED:
        if scan.becomes(c):
            return scan.after.elapsed_ms < deadline(c, scan.params)
    return TRUE


@theorem(
    clauses=["EKS-2-8", "EKS-4-4", "EKS-4-6", "EKS-8-11"],
    findings=["E-03", "E-30"],
    properties=["NoWaitBeyondDeadline"],
    slow=True,
)
def no_wait_of_the_fplc_outlasts_its_deadline() -> Queries:
    """After every scan the timer of a state that has a deadline is below it."""
    yield from JUDGE.after_every_scan(no_wait_beyond_deadline)

    def sooner(scan: Scanned) -> Obligation:
        return (TRUE, now(scan) + 1 < scan.params.T_REM_ms) if scan.becomes("AwaitZeros") else None

    yield JUDGE.too_strong("nor comes within a millisecond of it", sooner, "AwaitZeros")


def expiry_ends_the_wait(scan: Scanned) -> Obligation:
    for c in TIMED:
        if scan.was(c):
            ends = scan.becomes("Error") or (c not in REMOVAL and scan.becomes("Clear"))
            return now(scan) >= deadline(c, scan.params), TRUE if ends else z3.BoolVal(False)
    return None


@theorem(
    clauses=["EKS-2-8", "EKS-4-4", "EKS-4-6", "EKS-8-11"],
    findings=["E-03", "E-25d", "E-30", "E-64"],
    properties=["NoWaitBeyondDeadline"],
    slow=True,
)
def every_wait_with_a_deadline_ends_in_the_scan_that_reaches_it() -> Queries:
    """A scan that finds the deadline reached ends the wait, whatever else it finds: in the error mode, or, of
    an insertion and of Settle, in the removal.
    """
    yield from JUDGE.in_every_scan(expiry_ends_the_wait)

    def success_counts(scan: Scanned) -> Obligation:
        said = expiry_ends_the_wait(scan)
        return None if said is None else (said[0], TRUE if scan.becomes("Error") else z3.BoolVal(False))

    yield JUDGE.too_strong("always in the error mode", success_counts, "PulseOnes")


def shared_deadline_holds(scan: Scanned, seen: Seen) -> z3.BoolRef:
    p = scan.params
    if scan.becomes("PulseOnes"):
        whole = z3.Or(p.T_SEQ_FROM == FROM_ONES, seen.waited < p.T_SEQ_ms)
        return z3.And(seen.waited < p.T_ON_ms, whole)
    if scan.becomes(*INSERTION):
        return seen.waited < p.T_SEQ_ms
    return seen.waited < p.T_REM_ms if scan.becomes(*REMOVAL) else TRUE


@theorem(
    clauses=["EKS-2-6", "EKS-2-8", "EKS-4-2", "EKS-8-3", "EKS-8-11"],
    findings=["E-03", "E-30", "E-38"],
    properties=["SharedDeadlineHolds", "OneTimeForThePulse"],
    slow=True,
)
def all_waits_of_the_fplc_together_stay_within_their_deadline() -> Queries:
    """After every scan the time since LA was seen (or all outputs, as T_SEQ_FROM says) is below the deadline
    until one output is accepted, and the time since the key went below that of the removal.
    """
    yield from JUDGE.after_every_scan(shared_deadline_holds)
    for start in ("PulseZeros", "Clear"):
        yield JUDGE.without(JUDGE.after_a_scan(shared_deadline_holds), start, "TimerIsTheTimeWaited")


def stuck_word_is_reported(scan: Scanned, seen: Seen) -> z3.BoolRef:
    return seen.waited < scan.params.T_REM_ms if scan.becomes(*SETTLING) else TRUE


@theorem(clauses=["EKS-8-11"], findings=["E-15"], properties=["StuckWordIsReported"], slow=True)
def the_fplc_reports_a_word_that_does_not_go_back_to_zero() -> Queries:
    """After every scan in Settle the time since Settle began is below T_REM."""
    yield from JUDGE.after_every_scan(stuck_word_is_reported)
    yield JUDGE.without(JUDGE.after_a_scan(stuck_word_is_reported), "Settle", "TimerIsTheTimeWaited")


def removal_timer_goes_on(scan: Scanned) -> Obligation:
    if not (scan.was(*REMOVAL) and scan.becomes(*REMOVAL)):
        return None
    return TRUE, scan.after.elapsed_ms >= now(scan)


@theorem(clauses=["EKS-8-3", "EKS-8-11"], findings=["E-36"], properties=["RemovalTimerGoesOn"], slow=True)
def nothing_restarts_the_timer_of_a_removal() -> Queries:
    """From the scan that sees the key go until the removal is over the timer grows by the time that passes,
    whatever LA and the outputs do.
    """
    yield from JUDGE.in_every_scan(removal_timer_goes_on)

    def faster(scan: Scanned) -> Obligation:
        said = removal_timer_goes_on(scan)
        return None if said is None else (TRUE, scan.after.elapsed_ms > now(scan))

    yield JUDGE.too_strong("and runs ahead", faster, "AwaitZeros")

"""What the F-PLC does without delay, and what it never does without a cause, for all words, times and inputs.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in FplcPrompt.
"""

from __future__ import annotations

from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.fplc_safety import TIMED, deadline, now, zeros_everywhere
from proofs.mode_selection.invariants import CHOSEN, CLOCKED, HOLDING
from proofs.mode_selection.observer import INSERTION, REMOVAL, Seen
from proofs.mode_selection.vocabulary import NONE, all_set, none_set, only_of, several_set, vector
from proofs.sentences import Obligation, Sentence
from proofs.theorem import Queries, theorem

ZEROS_AWAITED: Final = ("Start", "AwaitZeros", "Error")


def no_word(scan: Scanned) -> z3.BoolRef:
    """MW03 and MW07 are zero."""
    return z3.And(scan.inputs.MW03 == 0, scan.inputs.MW07 == 0)


def signalled(scan: Scanned) -> z3.BoolRef:
    """LA is on, and the accepted output is set and no other."""
    return z3.And(scan.inputs.LA, only_of(vector(scan.inputs), scan.before.accepted))


def no_needless_wait(scan: Scanned) -> Obligation:
    c, flags = control(scan.device, scan.before), vector(scan.inputs)
    if not scan.becomes(c):
        return None
    if c in ZEROS_AWAITED:
        return TRUE, z3.Not(zeros_everywhere(scan))
    if c == "Settle":
        return TRUE, z3.Not(z3.And(no_word(scan), now(scan) >= scan.params.T_DWELL_ms))
    absent = {
        "Idle": z3.Not(scan.inputs.LA),
        "PulseOnes": z3.Not(all_set(flags)),
        "PulseZeros": z3.Not(none_set(flags)),
        "OneOutput": none_set(flags),
        "AwaitSelection": no_word(scan),
        "AwaitAcknowledgment": scan.inputs.MW07 == 0,
        "Complete": signalled(scan),
    }
    return TRUE, absent.get(c, FALSE)


@theorem(
    clauses=[
        "EKS-GP-3",
        "EKS-2-6",
        "EKS-2-17",
        "EKS-2-20",
        "EKS-4-3",
        "EKS-4-5",
        "EKS-8-18",
        "EKS-9-4-FPLC",
    ],
    findings=[],
    properties=["NoNeedlessWait"],
    slow=True,
)
def the_fplc_waits_only_for_what_is_not_there() -> Queries:
    """A scan that stays in a state has not seen what that state waits for: a key, the next part of the pulse,
    a word, the end of the key, or zeros for the dwell time; and a state that waits for nothing is left in one
    scan.
    """
    yield from JUDGE.in_every_scan(no_needless_wait)

    def never(scan: Scanned) -> Obligation:
        return None if no_needless_wait(scan) is None else (TRUE, FALSE)

    yield JUDGE.too_strong("nor for anything else", never, "OneOutput")


def error_needs_cause(scan: Scanned) -> Obligation:
    c = control(scan.device, scan.before)
    if c == "Error" or not scan.becomes("Error"):
        return None
    causes = [] if scan.was("PulseOnes", "PulseZeros") else [several_set(vector(scan.inputs))]
    if c in TIMED:
        late = now(scan) >= deadline(c, scan.params)
        causes.append(late if c in REMOVAL else z3.And(late, scan.inputs.LA))
    if c in HOLDING:
        causes.append(z3.And(signalled(scan), z3.Not(no_word(scan))))
    return TRUE, z3.Or(*causes)


@theorem(
    clauses=["EKS-KS-6", "EKS-2-8", "EKS-2-11", "EKS-2-19", "EKS-2-27", "EKS-4-4", "EKS-8-11"],
    findings=["E-07"],
    properties=["ErrorNeedsCause"],
    slow=True,
)
def the_fplc_enters_the_error_mode_only_for_a_cause() -> Queries:
    """A scan that leads to the error mode has seen two outputs or more outside the pulse, or a deadline that
    passed while LA stood or in the removal, or a word in MW03 or MW07 beside LA and the accepted output.
    """
    yield from JUDGE.in_every_scan(error_needs_cause)

    def outputs_alone(scan: Scanned) -> Obligation:
        return None if error_needs_cause(scan) is None else (TRUE, several_set(vector(scan.inputs)))

    yield JUDGE.too_strong("two outputs alone", outputs_alone, "AwaitSelection")


def removal_needs_cause(scan: Scanned) -> Obligation:
    if scan.was(*REMOVAL) or not scan.becomes(*REMOVAL):
        return None
    if scan.was(*HOLDING):
        return TRUE, z3.Not(signalled(scan))
    return TRUE, z3.Not(scan.inputs.LA) if scan.was(*INSERTION) else FALSE


@theorem(
    clauses=["EKS-3-1-FPLC", "EKS-3-4-FPLC", "EKS-8-3"],
    findings=["E-07"],
    properties=["RemovalNeedsCause"],
    slow=True,
)
def the_fplc_begins_a_removal_only_when_la_or_its_output_is_gone() -> Queries:
    """A scan that begins the removal finds LA off, or, once an output was accepted, another vector."""
    yield from JUDGE.in_every_scan(removal_needs_cause)

    def la_alone(scan: Scanned) -> Obligation:
        return None if removal_needs_cause(scan) is None else (TRUE, z3.Not(scan.inputs.LA))

    yield JUDGE.too_strong("by LA alone", la_alone, "Settle")


def insertion_needs_key(scan: Scanned) -> Obligation:
    if scan.was(*INSERTION) or not scan.becomes(*INSERTION):
        return None
    return TRUE, scan.inputs.LA if scan.was("Idle") else FALSE


@theorem(
    clauses=["EKS-2-6", "EKS-9-4-FPLC"],
    findings=["E-17", "E-25c"],
    properties=["InsertionNeedsKey"],
    slow=True,
)
def the_fplc_begins_an_insertion_only_in_idle_with_la() -> Queries:
    """A scan that begins to wait for the test pulse comes from Idle and finds LA on."""
    yield from JUDGE.in_every_scan(insertion_needs_key)
    no_output: Sentence = lambda scan: (  # noqa: E731
        None if insertion_needs_key(scan) is None else (TRUE, none_set(vector(scan.inputs)))
    )
    yield JUDGE.too_strong("and no output", no_output, "Idle")


def nothing_is_kept(scan: Scanned, seen: Seen) -> z3.BoolRef:
    c, s = control(scan.device, scan.after), scan.after
    kept = [TRUE]
    if c not in HOLDING:
        kept += [s.accepted == NONE, s.authority == NONE]
    if c not in CHOSEN:
        kept.append(s.selection == NONE)
    if c not in CLOCKED or scan.inputs is None:
        kept.append(s.elapsed_ms == 0)
    return z3.And(*kept)


@theorem(
    clauses=["EKS-8-6", "EKS-8-15", "EKS-GP-5"],
    findings=["E-18", "E-23"],
    properties=["NothingIsKept"],
    slow=True,
)
def the_fplc_keeps_nothing_beyond_its_insertion() -> Queries:
    """At power-up and after every scan no output and no level is remembered outside of an accepted key, no
    selection outside of a transaction and Complete, and no time where none runs.
    """
    yield from JUDGE.after_every_scan(nothing_is_kept)
    sentence = JUDGE.after_a_scan(nothing_is_kept)
    yield JUDGE.without(sentence, "Idle", "NoTimeWhereNoneRuns")
    yield JUDGE.without(sentence, "Start", "NothingWithoutKey")

"""How soon each device answers: the bounds of spec/mode_selection/properties.toml, stated there alone."""

from __future__ import annotations

import z3

from modeproof.registers import Response
from proofs.explorer.ends import FALSE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection import eks_safety, panel_safety, plc_safety
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.fplc_response import quiet
from proofs.mode_selection.fplc_safety import two_outputs_lead_to_error
from proofs.mode_selection.observer import REMOVAL
from proofs.mode_selection.vocabulary import NONE, mode, none_set, only_of, vector
from proofs.responses import waits_without_end, within_calls, within_time
from proofs.theorem import Queries, theorem


@theorem(clauses=["EKS-8-2"], findings=["E-41"], responses=["R-01"])
def a_key_that_is_gone_is_answered_in_the_scans_of_its_row(row: Response) -> Queries:
    """While the key in memory is not in the reader, LA is off within the scans of R-01."""
    yield from within_calls(
        eks_safety.JUDGE,
        row,
        lambda scan: z3.And(scan.sent.LA, z3.Not(eks_safety.read_is(scan, scan.before.key))),
        lambda scan: z3.Not(scan.sends.LA),
    )


@theorem(clauses=["EKS-3-1-FPLC", "EKS-8-6"], findings=["E-27"], responses=["R-02"], slow=True)
def the_end_of_la_is_answered_in_the_scans_of_its_row(row: Response) -> Queries:
    """While LA is off, MW01 and MW05 are zero within the scans of R-02, in every state of the F-PLC."""
    yield from within_calls(
        JUDGE,
        row,
        lambda scan: z3.Not(scan.inputs.LA),
        lambda scan: z3.And(scan.sends.MW01 == 0, scan.sends.MW05 == 0),
    )


@theorem(clauses=["EKS-2-13", "EKS-8-7"], findings=["E-08"], responses=["R-03"])
def mw01_is_copied_in_the_scans_of_its_row(row: Response) -> Queries:
    """From any memory of the PLC: while MW01 shows the same word in every scan, ReadAuthorization shows it
    within the scans of R-03.
    """
    word = z3.BitVec("the word", 16)
    yield from within_calls(
        plc_safety.JUDGE,
        row,
        lambda scan: word == scan.inputs.MW01,
        lambda scan: scan.sends.ReadAuthorization == word,
    )


@theorem(clauses=["EKS-3-1-HMI", "EKS-8-8", "EKS-8-9"], findings=[], responses=["R-04"])
def an_authorization_that_is_gone_is_answered_in_the_scans_of_its_row(row: Response) -> Queries:
    """While ReadAuthorization is no code word, the screen is inhibited, and SelectMSO and SwitchMSO are zero,
    within the scans of R-04.
    """

    def closed(scan: Scanned) -> z3.BoolRef:
        zero = z3.And(scan.sends.SelectMSO == 0, scan.sends.SwitchMSO == 0)
        return zero if scan.sends.screen == "inhibited" else FALSE

    yield from within_calls(
        panel_safety.JUDGE, row, lambda scan: mode("RE", scan.inputs.ReadAuthorization) == NONE, closed
    )


@theorem(clauses=["EKS-KS-6"], findings=["E-07"], responses=["R-05"], slow=True)
def two_outputs_are_answered_in_the_scans_of_its_row(row: Response) -> Queries:
    """While two outputs of the EKS or more are set, outside the test pulse, ERROR is TRUE within the scans of
    R-05.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        said = two_outputs_lead_to_error(scan)
        return FALSE if said is None else said[0]

    yield from within_calls(JUDGE, row, asks, lambda scan: scan.sends.ERROR)


@theorem(clauses=["EKS-8-3", "EKS-8-11"], findings=["E-30"], responses=["R-06"], slow=True)
def a_removal_that_does_not_end_is_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While every scan of a removal finds LA on, an output set or a word, the first one that comes the times
    of R-06 after the one that began it shows ERROR.
    """
    yield from within_time(
        JUDGE,
        row,
        lambda scan: z3.Not(quiet(scan)) if scan.was(*REMOVAL) else FALSE,
        lambda seen: seen.waited,
        lambda scan: scan.sends.ERROR,
    )


@theorem(clauses=["EKS-2-14", "EKS-2-22"], findings=[], responses=["R-08"])
def a_touch_is_waited_for_without_end(row: Response) -> Queries:
    """R-08 has no bound: while nobody touches it, a scan of the panel that offers modes, or asks for a
    confirmation, can be followed by as many like it as one likes, and neither of its words changes.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        return panel_safety.touched(scan, "") if scan.was("Select", "Confirm") else FALSE

    def answered(scan: Scanned) -> z3.BoolRef:
        sent, sends = scan.sent, scan.sends
        return z3.Or(sends.SelectMSO != sent.SelectMSO, sends.SwitchMSO != sent.SwitchMSO)

    yield from waits_without_end(panel_safety.JUDGE, row, asks, answered)


@theorem(clauses=["EKS-SD-7", "EKS-8-8"], findings=["E-75"], responses=["R-09"], slow=True)
def the_mode_output_stays_on_without_end_when_the_key_is_out(row: Response) -> Queries:
    """R-09 has no bound: a scan of the idle F-PLC that finds everything zero, with a mode output on, can be
    followed by as many like it as one likes, and the output stays on.
    """
    yield from waits_without_end(
        JUDGE,
        row,
        lambda scan: z3.And(quiet(scan), scan.before.mode != NONE) if scan.was("Idle") else FALSE,
        lambda scan: none_set(tuple(getattr(scan.sends, f"MSO_{number}") for number in range(5))),
    )


@theorem(clauses=["EKS-8-11", "EKS-GP-5"], findings=["E-15"], responses=["R-10"], slow=True)
def a_word_that_stays_in_settle_is_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While the level of the key stands, a word that stays in Settle gives ERROR in the time of R-10."""

    def asks(scan: Scanned) -> z3.BoolRef:
        if not scan.was("Settle"):
            return FALSE
        same_key = z3.And(scan.inputs.LA, only_of(vector(scan.inputs), scan.before.accepted))
        return z3.And(same_key, z3.Or(scan.inputs.MW03 != 0, scan.inputs.MW07 != 0))

    yield from within_time(JUDGE, row, asks, lambda seen: seen.waited, lambda scan: scan.sends.ERROR)

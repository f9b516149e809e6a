"""What the panel promises whatever stands on the bus and whatever is touched: its invariant and properties.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in Hmi and HmiOpen.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.devices import HMI
from proofs.mode_selection.invariants import HMI_INVARIANT
from proofs.mode_selection.vocabulary import LEVELS, NONE, code, mode, none_set, permits
from proofs.sentences import Judge, Obligation, Sentence
from proofs.theorem import Queries, theorem

JUDGE: Final = Judge(HMI, HMI_INVARIANT)
TOUCHES: Final = HMI.register.inputs["touch"].values


def touched(scan: Scanned, field: str) -> z3.BoolRef:
    """This field was touched in the scan."""
    return scan.inputs.touch == TOUCHES.index(field)


@theorem(clauses=["EKS-GP-3", "EKS-GP-5", "EKS-8-8"], findings=["E-47"])
def every_scan_of_the_panel_keeps_its_invariant() -> Queries:
    """The invariant of the panel is true at power-up, and every scan keeps it, with any words on the bus, any
    touch and any table of permissions.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()


def selection_within_offer(scan: Scanned, seen: Any) -> z3.BoolRef:
    s, sent = scan.after, mode("SE", scan.sends.SelectMSO)
    kept = z3.Implies(s.selection != NONE, permits(scan.params, s.offered, s.selection))
    return z3.And(kept, z3.Implies(scan.sends.SelectMSO != 0, permits(scan.params, s.offered, sent)))


@theorem(clauses=["EKS-2-14", "EKS-SD-4"], findings=[], properties=["SelectionWithinOffer"])
def the_panel_sends_no_selection_beyond_its_offer() -> Queries:
    """At power-up and after every scan the selection that the panel keeps and sends is one that the machine
    permits to the level with which the screen was opened.
    """
    yield from JUDGE.after_every_scan(selection_within_offer)
    sentence = JUDGE.after_a_scan(selection_within_offer)
    yield JUDGE.without(sentence, "AwaitEcho", "SelectionIsOffered")


def inhibited_sends_zeros(scan: Scanned, seen: Any) -> z3.BoolRef:
    zero = z3.And(scan.sends.SelectMSO == 0, scan.sends.SwitchMSO == 0)
    return zero if scan.becomes("Inhibited") else TRUE


@theorem(clauses=["EKS-8-8", "EKS-8-9", "EKS-8-16"], findings=[], properties=["InhibitedSendsZeros"])
def the_inhibited_panel_sends_zeros() -> Queries:
    """At power-up and after every scan after which the panel is inhibited, both of its words are zero."""
    yield from JUDGE.after_every_scan(inhibited_sends_zeros)
    zero: Sentence = lambda scan: (TRUE, scan.sends.SelectMSO == 0)  # noqa: E731
    yield JUDGE.too_strong("and so does the open one", zero, "AwaitEcho")


def selection_needs_enable(scan: Scanned) -> Obligation:
    level = mode("RE", scan.inputs.ReadAuthorization)
    sends = z3.Implies(
        scan.sends.SelectMSO != 0, permits(scan.params, level, mode("SE", scan.sends.SelectMSO))
    )
    if scan.was("Inhibited") and not scan.becomes("Inhibited"):
        return TRUE, z3.And(sends, scan.inputs.CheckMSO == 0)
    return TRUE, sends


@theorem(
    clauses=["EKS-2-14", "EKS-8-8", "EKS-SD-3", "EKS-SD-4"],
    findings=["E-57"],
    properties=["SelectionNeedsEnable"],
)
def the_panel_selects_only_under_a_level_and_opens_without_an_echo() -> Queries:
    """In every scan that sends a selection ReadAuthorization shows a level to which the machine permits it;
    and the screen opens only in a scan in which CheckMSO is zero.
    """
    yield from JUDGE.in_every_scan(selection_needs_enable)
    yield JUDGE.without(selection_needs_enable, "Confirm", "SelectionIsOffered")


def selection_needs_touch(scan: Scanned) -> Obligation:
    begins = z3.And(scan.sends.SelectMSO != 0, scan.sends.SelectMSO != scan.sent.SelectMSO)
    ways = [
        z3.And(
            scan.sent.enabled[m],
            scan.sends.SelectMSO == code("SE", z3.IntVal(m)),
            touched(scan, f"select:{m}"),
        )
        for m in LEVELS
    ]
    if scan.was("Select") and scan.becomes("AwaitEcho"):
        return begins, z3.Or(*ways)
    return TRUE, z3.Implies(begins, z3.Or(*ways))


@theorem(
    clauses=["EKS-2-14", "EKS-2-15", "EKS-2-22"],
    findings=["E-20", "E-60"],
    properties=["SelectionNeedsTouch"],
)
def the_panel_sends_only_a_selection_that_was_touched() -> Queries:
    """In a scan that begins to send a selection the field of that mode was touched, and it was enabled."""
    yield from JUDGE.in_every_scan(selection_needs_touch)

    def first_field(scan: Scanned) -> Obligation:
        said = selection_needs_touch(scan)
        return None if said is None else (said[0], touched(scan, "select:0"))

    yield JUDGE.too_strong("always the first field", first_field, "Select")


def acknowledgment_needs_confirm(scan: Scanned) -> Obligation:
    begins = z3.And(scan.sends.SwitchMSO != 0, scan.sends.SwitchMSO != scan.sent.SwitchMSO)
    acknowledged = mode("SW", scan.sends.SwitchMSO)
    if not (scan.was("Confirm") and scan.becomes("AwaitSwitch")):
        return TRUE, z3.Not(begins)
    echoed = mode("CH", scan.inputs.CheckMSO)
    return begins, z3.And(touched(scan, "confirm"), echoed == acknowledged, scan.sent.shown == acknowledged)


@theorem(
    clauses=["EKS-2-22", "EKS-2-23", "EKS-2-24", "EKS-SD-5"],
    findings=["E-19"],
    properties=["AcknowledgmentNeedsConfirm"],
)
def the_panel_acknowledges_only_what_the_user_confirmed() -> Queries:
    """A scan that begins to send an acknowledgment comes from the confirmation screen, the confirmation field
    was touched, and the acknowledged mode is the one that was shown and that CheckMSO echoes in that scan.
    """
    yield from JUDGE.in_every_scan(acknowledgment_needs_confirm)

    def never(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.SwitchMSO == 0

    yield JUDGE.too_strong("never", never, "Confirm")


def inhibit_at_once(scan: Scanned) -> Obligation:
    o = scan.sends
    closed = z3.And(o.SelectMSO == 0, o.SwitchMSO == 0, none_set(o.enabled))
    gone = mode("RE", scan.inputs.ReadAuthorization) == NONE
    return gone, closed if scan.becomes("Inhibited") else FALSE


@theorem(
    clauses=["EKS-3-1-HMI", "EKS-3-4-HMI", "EKS-8-9", "EKS-8-16"],
    findings=["E-55"],
    properties=["InhibitAtOnce"],
)
def the_panel_closes_in_the_scan_without_a_level() -> Queries:
    """In a scan in which ReadAuthorization is no code word the panel is inhibited, sends zeros, and offers no
    mode.
    """
    yield from JUDGE.in_every_scan(inhibit_at_once)

    def at_any_word(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("Inhibited") else FALSE

    yield JUDGE.too_strong("at any word", at_any_word, "Select")


def displays_what_it_reads(scan: Scanned) -> Obligation:
    return TRUE, scan.sends.active == scan.inputs.ActiveMSO


@theorem(clauses=["EKS-8-8", "EKS-8-16", "EKS-SD-7"], findings=["E-25"])
def the_panel_displays_in_every_scan_what_the_display_wire_brings() -> Queries:
    """After every scan the panel displays as active the mode, or none, that ActiveMSO has in that scan,
    whatever stands on the bus, is touched or was confirmed.

    That ActiveMSO is the mode whose output is set is no part of it: DisplayIsTheMode, A-33.
    """
    yield from JUDGE.in_every_scan(displays_what_it_reads)

    def what_it_confirmed(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.active == scan.before.selection

    yield JUDGE.too_strong("what the user confirmed", what_it_confirmed, "AwaitSwitch")

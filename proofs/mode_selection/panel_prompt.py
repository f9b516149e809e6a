"""The panel shows what it does, and does without delay what the bus and the user ask for.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in HmiPrompt: for all
words on the bus, any touch and any table of permissions.
"""

from __future__ import annotations

from typing import Any

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.mode_selection.panel_safety import JUDGE, touched
from proofs.mode_selection.vocabulary import LEVELS, NONE, code, mode
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def level(scan: Scanned) -> z3.ArithRef:
    """The level that ReadAuthorization shows in the scan; -1 for none."""
    return mode("RE", scan.inputs.ReadAuthorization)


def shows(scan: Scanned, screen: str) -> z3.BoolRef:
    """After the scan this screen is on."""
    return TRUE if scan.sends.screen == screen else FALSE


def screen_is_true(scan: Scanned, seen: Any) -> z3.BoolRef:
    screen, o = scan.sends.screen, scan.sends
    return z3.And(
        z3.BoolVal(screen in ("inhibited", "select", "confirm", "waiting")),
        z3.BoolVal(screen == "inhibited") == (scan.after.offered == NONE),
        z3.BoolVal(screen == "select") == z3.Or(*o.enabled),
        z3.BoolVal(screen == "confirm") == (o.shown != NONE),
    )


@theorem(clauses=["EKS-2-14", "EKS-2-22", "EKS-8-8", "EKS-SD-3"], findings=[], properties=["ScreenIsTrue"])
def the_screen_of_the_panel_shows_what_it_does() -> Queries:
    """At power-up and after every scan the screen is inhibited exactly while no level is offered, it is the
    selection exactly while a field is open, and the confirmation exactly while an echo is shown.
    """
    yield from JUDGE.after_every_scan(screen_is_true)
    sentence = JUDGE.after_a_scan(screen_is_true)
    yield JUDGE.without(sentence, "Inhibited", "OpenAtALevel")


def field_selects_its_mode(scan: Scanned) -> Obligation:
    begins = z3.And(scan.sent.SelectMSO == 0, scan.sends.SelectMSO != 0)
    fields = [
        z3.And(
            scan.after.selection == number,
            touched(scan, f"select:{number}"),
            scan.sends.SelectMSO == code("SE", z3.IntVal(number)),
        )
        for number in LEVELS
    ]
    if scan.was("Select") and scan.becomes("AwaitEcho"):
        return begins, z3.Or(*fields)
    return TRUE, z3.Implies(begins, z3.Or(*fields))


@theorem(clauses=["EKS-2-14", "EKS-2-15"], findings=[], properties=["FieldSelectsItsMode"])
def the_field_of_a_mode_selects_that_mode() -> Queries:
    """In a scan in which the panel begins to send a selection it is the mode whose field was touched."""
    yield from JUDGE.in_every_scan(field_selects_its_mode)

    def the_highest(scan: Scanned) -> Obligation:
        said = field_selects_its_mode(scan)
        return None if said is None else (said[0], scan.after.selection == scan.after.offered)

    yield JUDGE.too_strong("and the highest one", the_highest, "Select")


def closes_at_once(scan: Scanned) -> Obligation:
    other = z3.And(scan.before.offered != NONE, level(scan) != scan.before.offered)
    if scan.was("Inhibited"):
        return TRUE, z3.Implies(other, shows(scan, "inhibited"))
    return other, shows(scan, "inhibited")


@theorem(clauses=["EKS-3-4-HMI", "EKS-9-1-HMI"], findings=["E-55"], properties=["ClosesAtOnce"])
def the_panel_closes_in_the_scan_with_another_level() -> Queries:
    """In a scan in which ReadAuthorization shows another level than the one that the screen was opened with,
    or none, the screen is inhibited.
    """
    yield from JUDGE.in_every_scan(closes_at_once)

    def at_any_level(scan: Scanned) -> Obligation:
        return scan.before.offered != NONE, shows(scan, "inhibited")

    yield JUDGE.too_strong("at any level", at_any_level, "Confirm")


def closes_over_an_echo(scan: Scanned) -> Obligation:
    if scan.sent.screen != "select":
        return None
    return scan.inputs.CheckMSO != 0, shows(scan, "inhibited")


@theorem(clauses=["EKS-2-14"], findings=["E-57", "E-60"], properties=["ClosesOverAnEcho"])
def the_panel_closes_over_an_echo_that_nobody_asked_for() -> Queries:
    """In a scan that finds modes offered and CheckMSO not zero, the screen is inhibited."""
    yield from JUDGE.in_every_scan(closes_over_an_echo)

    def always(scan: Scanned) -> Obligation:
        return None if closes_over_an_echo(scan) is None else (TRUE, shows(scan, "inhibited"))

    yield JUDGE.too_strong("and without one", always, "Select")


def ends_with_the_echo(scan: Scanned) -> Obligation:
    if not scan.was("AwaitSwitch", "Withdrawn"):
        return None
    gone = z3.And(level(scan) == scan.before.offered, scan.inputs.CheckMSO == 0)
    return gone, z3.And(shows(scan, "select"), scan.after.selection == NONE)


@theorem(clauses=["EKS-2-25"], findings=["E-15", "E-21"], properties=["EndsWithTheEcho"])
def a_selection_on_the_panel_ends_in_the_scan_without_its_echo() -> Queries:
    """In a scan that finds the level unchanged and CheckMSO zero, a selection that was confirmed or taken
    back is over: nothing of it is kept, and the modes are offered again.
    """
    yield from JUDGE.in_every_scan(ends_with_the_echo)

    def any_word(scan: Scanned) -> Obligation:
        said = ends_with_the_echo(scan)
        return None if said is None else (level(scan) == scan.before.offered, said[1])

    yield JUDGE.too_strong("whatever CheckMSO shows", any_word, "Withdrawn")


def panel_answers_at_once(scan: Scanned) -> Obligation:
    c, before, CheckMSO = control(scan.device, scan.before), scan.before, scan.inputs.CheckMSO
    if not scan.becomes(c):
        return None
    same = z3.And(scan.after.offered == before.offered, scan.after.selection == before.selection)
    if c == "Inhibited":
        return same, z3.Or(level(scan) == NONE, CheckMSO != 0)
    echoed = CheckMSO == code("CH", before.selection)
    open_fields = [z3.And(scan.sent.enabled[field], touched(scan, f"select:{field}")) for field in LEVELS]
    absent = {
        "Select": z3.And(CheckMSO == 0, z3.Not(z3.Or(*open_fields))),
        "AwaitEcho": CheckMSO == 0,
        "Confirm": z3.And(echoed, z3.Not(touched(scan, "confirm")), z3.Not(touched(scan, "reject"))),
        "AwaitSwitch": echoed,
        "Withdrawn": CheckMSO != 0,
    }
    return same, z3.And(level(scan) == before.offered, absent[c])


@theorem(
    clauses=["EKS-GP-3", "EKS-2-14", "EKS-2-22", "EKS-2-23", "EKS-9-4-HMI"],
    findings=[],
    properties=["PanelAnswersAtOnce"],
)
def the_panel_waits_only_for_what_is_not_there() -> Queries:
    """A scan that changes nothing has seen nothing that the panel waits for: no other level, no change of the
    echo, no touch of an open field.
    """
    yield from JUDGE.in_every_scan(panel_answers_at_once)

    def no_touch(scan: Scanned) -> Obligation:
        said = panel_answers_at_once(scan)
        return None if said is None else (said[0], touched(scan, ""))

    yield JUDGE.too_strong("and no touch at all", no_touch, "Select")

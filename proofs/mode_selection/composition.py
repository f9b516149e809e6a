"""From what each device guarantees to what all of them together do, for any order and any number of scans.

The note's four devices, the user and the words between them, with the F-PLC, PLC, panel and EKS of refimpl.
Nothing is known of a device here but its guarantees (`composition_guarantees`), and of the world but the
assumptions of the register (`composition_system`). Words are all 65536; times, permissions and the number of
steps have no bound.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from proofs.mode_selection import composition_formulas as formulas
from proofs.mode_selection.composition_argument import Argument, Consequence, Invariant, Proved
from proofs.mode_selection.composition_guarantees import GUARANTEES
from proofs.mode_selection.composition_system import ASSUMPTIONS, STEPS
from proofs.theorem import Queries, Query, theorem

# ---------------------------------------------------------------- the argument

FPLC_ROW: Final = "the words of the F-PLC are the row of its state"
HMI_ROW: Final = "words and screen of the panel are the row of its state"
LEVEL: Final = "the level is that of the accepted output"
FORGOTTEN: Final = "nothing is kept without a key"
OFFERED: Final = "a pending selection was offered"
ZEROS: Final = "a new insertion begins with zeros"
SCREEN: Final = "the screen has the level of the F-PLC"
ECHO: Final = "CheckMSO is zero or the echo"
WORDS: Final = "the words are those of one selection"
UNSEEN: Final = "a key that was not seen has no LA"
SEEN: Final = "a change of key is seen"
OFF: Final = "the state of the EKS says what is off"
LOW: Final = "what was low is off"
UNSEEN_OFF: Final = "a key that was not seen finds all off"
SEEN_ANYWAY: Final = "a change of key is seen, with one broken wire"
INTENT_ANYWAY: Final = "the mode is what was touched, seen and confirmed, with one broken wire"
HISTORY: Final = "what is echoed was touched, seen, confirmed"
SIGNALLED: Final = "the one output is that of the key"
ASKED: Final = "nothing is confirmed while it is asked"
INTENT: Final = "the mode is what was touched, seen and confirmed"
WITHIN_LEVEL: Final = "the mode is permitted by the output seen"
WITHIN_KEY: Final = "the mode is permitted by the key"
ONLY_BY_SWITCHING: Final = "the mode changes only by a switchover"

F_ROW, H_ROW = "the F-PLC writes the row of its state", "the panel shows the row of its state"
F_ECHO, F_SWITCH = "the F-PLC echoes while MW03 stands", "the F-PLC switches on a pair"
F_ZEROS, F_OFFER = "the F-PLC waits for a key only over zeros", "the F-PLC offers after a key or over zeros"
F_LATCH, F_ONE = "the F-PLC latches MW03", "the F-PLC keeps one authority"
F_ACCEPT, F_FORGET = "the F-PLC accepts one output", "the F-PLC forgets without a key"
F_MODE = "the F-PLC keeps the mode"
H_OPEN, H_CLOSE = "the panel is open at one level", "the panel closes for a reason"
H_OFFER, H_SELECT = "the panel offers without an echo", "the panel selects by a touch"
H_ASK, H_ACKNOWLEDGE = "the panel asks by the echo", "the panel acknowledges by a touch"
H_GIVE_UP, H_FORGET = "the panel gives up for a reason", "the panel forgets when it is over"
GOES_ON: Final = "the F-PLC goes on while signalled"
BROKEN: Final = "one wire is broken"
CLEARED: Final = "a key goes in when all is cleared"
SCANNED_LOW: Final = "the F-PLC scanned while LA was low"
COPIES: Final = "the PLC copies or keeps"
WIRED, OUTPUTS_WIRED, DISPLAY_WIRED = "words are wired", "outputs are wired", "the display is wired"
ARRIVE, HELD, ORDERED = (
    "words arrive within the dwell time",
    "the error mode holds the mode",
    "levels are ordered",
)
GOES_IN, NOTICED = "a key goes in without LA", "a removal is noticed before LA comes again"

ARGUMENT: Final = Argument(
    GUARANTEES,
    ASSUMPTIONS,
    (
        Invariant(
            FPLC_ROW, formulas.fplc_writes_its_row, (F_ROW,), "at_most_one_mode_output_is_set_at_any_moment"
        ),
        Invariant(HMI_ROW, formulas.hmi_writes_its_row, (H_ROW,), "the_panel_sends_only_what_it_offered"),
        Invariant(
            "one mode output",
            formulas.one_mode_output,
            (FPLC_ROW,),
            "at_most_one_mode_output_is_set_at_any_moment",
        ),
        Invariant(
            LEVEL,
            formulas.level_and_selection,
            (F_ACCEPT, F_ONE, F_LATCH, F_ECHO),
            "the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits",
        ),
        Invariant(
            FORGOTTEN,
            formulas.nothing_kept_without_a_key,
            (F_FORGET,),
            "the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits",
        ),
        Invariant(
            "selection within authority",
            formulas.selection_within_authority,
            (LEVEL, FORGOTTEN),
            "the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits",
        ),
        Invariant(
            "words zero without key",
            formulas.words_zero_without_key,
            (FPLC_ROW, LEVEL),
            "the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits",
        ),
        Invariant(
            "the echo is the selection",
            formulas.echo_is_the_selection,
            (FPLC_ROW, LEVEL),
            "the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits",
        ),
        Invariant(
            OFFERED,
            formulas.pending_means_offered,
            (H_OPEN, H_SELECT, H_ASK, H_ACKNOWLEDGE, H_FORGET),
            "the_panel_sends_only_what_it_offered",
        ),
        Invariant(
            "selection within offer",
            formulas.selection_within_offer,
            (OFFERED,),
            "the_panel_sends_only_what_it_offered",
        ),
        Invariant(
            "inhibited sends zeros",
            formulas.inhibited_sends_zeros,
            (HMI_ROW,),
            "the_panel_sends_only_what_it_offered",
        ),
        Invariant(
            "one output outside the pulse",
            formulas.one_output_outside_the_pulse,
            ("the EKS sets several outputs in its pulse",),
            "the_eks_signals_one_level_and_only_with_la",
        ),
        Invariant(
            "no output without LA",
            formulas.no_output_without_la,
            ("the EKS sets no output without LA",),
            "the_eks_signals_one_level_and_only_with_la",
        ),
        Invariant(
            ZEROS,
            formulas.idle_means_zeros,
            (FPLC_ROW, HMI_ROW, F_ZEROS, H_OPEN, COPIES, WIRED, ARRIVE),
            "every_insertion_begins_with_zeros_in_all_devices",
        ),
        Invariant(
            SCREEN,
            formulas.screen_has_the_level,
            (FPLC_ROW, ZEROS, F_OFFER, F_LATCH, F_ECHO, F_ONE, H_OPEN, COPIES, WIRED, ARRIVE),
            "all_words_on_the_way_belong_to_one_selection",
        ),
        Invariant(
            ECHO,
            formulas.echo_on_the_bus,
            (FPLC_ROW, ZEROS, F_OFFER, F_LATCH, F_ECHO, COPIES, WIRED, ARRIVE),
            "all_words_on_the_way_belong_to_one_selection",
        ),
        Invariant(
            WORDS,
            formulas.words_of_one_selection,
            (
                FPLC_ROW,
                HMI_ROW,
                LEVEL,
                ZEROS,
                SCREEN,
                ECHO,
                F_OFFER,
                F_LATCH,
                F_ECHO,
                H_CLOSE,
                H_OFFER,
                H_SELECT,
                H_ASK,
                H_ACKNOWLEDGE,
                H_GIVE_UP,
                COPIES,
                WIRED,
                ARRIVE,
            ),
            "all_words_on_the_way_belong_to_one_selection",
        ),
        Invariant(
            UNSEEN,
            formulas.unseen_key_has_no_la,
            (GOES_IN, NOTICED),
            "no_key_is_changed_behind_the_back_of_the_fplc",
        ),
        Consequence(
            SEEN,
            formulas.change_of_key_is_seen,
            ("fplc",),
            (UNSEEN, OUTPUTS_WIRED),
            "no_key_is_changed_behind_the_back_of_the_fplc",
        ),
        Invariant(
            HISTORY,
            formulas.touched_seen_confirmed,
            (
                FPLC_ROW,
                HMI_ROW,
                LEVEL,
                WORDS,
                ZEROS,
                F_OFFER,
                F_LATCH,
                F_ECHO,
                H_SELECT,
                H_ACKNOWLEDGE,
                ARRIVE,
            ),
            "the_mode_that_becomes_active_was_touched_seen_and_confirmed",
        ),
        Consequence(
            INTENT,
            formulas.user_intent,
            ("fplc",),
            (LEVEL, WORDS, HISTORY, SEEN, F_SWITCH, WIRED),
            "the_mode_that_becomes_active_was_touched_seen_and_confirmed",
        ),
        Invariant(
            OFF,
            formulas.off_means_off,
            ("the EKS is off by its state",),
            "one_broken_wire_of_the_reader_leaves_the_users_intent",
        ),
        Invariant(
            LOW,
            formulas.low_means_off,
            (OFF, LEVEL, GOES_ON, BROKEN, "the EKS is off by its state"),
            "one_broken_wire_of_the_reader_leaves_the_users_intent",
        ),
        Invariant(
            UNSEEN_OFF,
            formulas.unseen_key_finds_all_off,
            (OFF, LOW, CLEARED, SCANNED_LOW, "the EKS is off by its state"),
            "one_broken_wire_of_the_reader_leaves_the_users_intent",
        ),
        Consequence(
            SEEN_ANYWAY,
            formulas.change_of_key_is_seen,
            ("fplc",),
            (UNSEEN_OFF, LEVEL, BROKEN),
            "one_broken_wire_of_the_reader_leaves_the_users_intent",
        ),
        Consequence(
            INTENT_ANYWAY,
            formulas.user_intent,
            ("fplc",),
            (LEVEL, WORDS, HISTORY, SEEN_ANYWAY, F_SWITCH, WIRED),
            "one_broken_wire_of_the_reader_leaves_the_users_intent",
        ),
        Consequence(
            "nothing but the touch",
            formulas.nothing_but_the_touch,
            ("fplc",),
            (INTENT,),
            "the_mode_that_becomes_active_was_touched_seen_and_confirmed",
        ),
        Invariant(
            "the echo is the touch",
            formulas.echo_is_the_touch,
            (FPLC_ROW, UNSEEN, HISTORY),
            "the_echo_is_of_this_users_touch",
        ),
        Consequence(
            "the pair",
            formulas.pair,
            ("fplc",),
            (LEVEL, F_SWITCH, WIRED),
            "a_mode_is_switched_only_on_its_pair_of_words",
        ),
        Consequence(
            "the pair read",
            formulas.pair_read,
            ("fplc",),
            (LEVEL, F_SWITCH),
            "a_mode_is_switched_only_on_its_pair_of_words",
        ),
        Consequence(
            WITHIN_LEVEL,
            formulas.within_level,
            ("fplc",),
            (LEVEL, F_SWITCH),
            "a_mode_is_switched_only_within_the_level_of_the_key",
        ),
        Invariant(
            SIGNALLED,
            formulas.signals_the_key,
            ("the EKS signals the level read",),
            "the_eks_signals_one_level_and_only_with_la",
        ),
        Consequence(
            WITHIN_KEY,
            formulas.within_key,
            ("fplc",),
            (WITHIN_LEVEL, F_SWITCH, SIGNALLED, OUTPUTS_WIRED, ORDERED),
            "a_mode_is_switched_only_within_the_level_of_the_key",
        ),
        Consequence(
            "with LA",
            formulas.with_la,
            ("fplc",),
            (F_SWITCH, F_MODE, HELD),
            "the_mode_changes_only_by_a_switchover_with_la",
        ),
        Consequence(
            ONLY_BY_SWITCHING,
            formulas.only_by_switching,
            STEPS,
            (F_MODE, HELD),
            "the_mode_changes_only_by_a_switchover_with_la",
        ),
        Invariant(
            "the panel displays the mode",
            formulas.displays_what_has_come,
            (H_ROW, DISPLAY_WIRED),
            "the_panel_displays_the_active_mode_that_the_display_wire_has_carried",
        ),
        Invariant(
            ASKED,
            formulas.asked_before_confirmed,
            (H_SELECT, H_ASK),
            "the_devices_together_do_only_what_the_contract_allows",
        ),
        Consequence(
            "the contract",
            formulas.allowed_by_the_contract,
            STEPS,
            (INTENT, WITHIN_LEVEL, F_SWITCH, ONLY_BY_SWITCHING, ASKED, OUTPUTS_WIRED, ORDERED),
            "the_devices_together_do_only_what_the_contract_allows",
        ),
        Invariant(
            "no offer beyond the level",
            formulas.no_offer_beyond_the_level,
            (HMI_ROW, FORGOTTEN, SCREEN),
            "the_panel_offers_nothing_beyond_the_level_in_force",
        ),
        Consequence(
            "no word is refused",
            formulas.no_word_is_refused,
            ("fplc",),
            (ZEROS, WORDS, "the F-PLC refuses only wrong words", WIRED),
            "no_word_of_an_honest_panel_is_refused",
        ),
    ),
)

# ---------------------------------------------------------------- the theorems


def _proofs_of(name: str) -> Iterator[Query]:
    """The queries of all formulas that this theorem proves."""
    for formula in proved_by(name):
        yield from ARGUMENT.queries(formula.name)


def proved_by(name: str) -> tuple[Proved, ...]:
    """The formulas that the theorem of this name proves."""
    return tuple(formula for formula in ARGUMENT.proved if formula.theorem == name)


@theorem(
    clauses=["EKS-KS-5", "EKS-SD-6", "EKS-FD-1"],
    findings=[],
    properties=["AtMostOneModeOutput"],
)
def at_most_one_mode_output_is_set_at_any_moment() -> Queries:
    """At every moment, whatever the devices do and in any order: at most one mode output is set, and what
    each device last wrote is the row of its state.
    """
    yield from _proofs_of("at_most_one_mode_output_is_set_at_any_moment")


@theorem(
    clauses=["EKS-2-11", "EKS-2-12", "EKS-2-18", "EKS-2-20", "EKS-6-12", "EKS-8-6"],
    findings=["E-12", "E-17", "E-18", "E-27"],
    properties=["SelectionWithinAuthority", "WordsZeroWithoutKey", "EchoIsTheSelection"],
)
def the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits() -> Queries:
    """At every moment, whatever words, outputs and times the F-PLC sees: its level is that of the accepted
    output, a kept selection is permitted by it, MW05 is zero or the word of that selection, and without an
    accepted key both its words are zero.
    """
    yield from _proofs_of("the_fplc_keeps_the_level_of_one_key_and_echoes_only_what_it_permits")


@theorem(
    clauses=["EKS-2-14", "EKS-8-8", "EKS-8-9", "EKS-SD-4"],
    findings=[],
    properties=["SelectionWithinOffer", "InhibitedSendsZeros"],
)
def the_panel_sends_only_what_it_offered() -> Queries:
    """At every moment, whatever stands on the bus and is touched: the panel's selection is one that the
    level it was opened with permits, and while it is inhibited it sends zeros.
    """
    yield from _proofs_of("the_panel_sends_only_what_it_offered")


@theorem(
    clauses=["EKS-KS-5", "EKS-2-7", "EKS-2-10", "EKS-8-5", "EKS-SD-2"],
    findings=["E-02"],
    properties=["OneOutputOutsideThePulse", "NoOutputWithoutLA"],
)
def the_eks_signals_one_level_and_only_with_la() -> Queries:
    """At every moment, whatever is put into the reader: the EKS sets several outputs in its test pulse
    only, none without LA but for the one scan before they are cleared, and one output alone, with LA, is
    that of the level on the key.
    """
    yield from _proofs_of("the_eks_signals_one_level_and_only_with_la")


@theorem(
    clauses=["EKS-8-6", "EKS-8-12", "EKS-8-18", "EKS-SD-9"],
    findings=["E-17", "E-27", "E-52"],
    properties=["IdleMeansZeros"],
)
def every_insertion_begins_with_zeros_in_all_devices() -> Queries:
    """Until a key is accepted, every word in every device is zero and the panel is inhibited, whatever the
    EKS signals.

    It rests on A-06 and on the guarantees of F-PLC, PLC and panel.
    """
    yield from _proofs_of("every_insertion_begins_with_zeros_in_all_devices")


@theorem(
    clauses=["EKS-2-13", "EKS-2-15", "EKS-2-16", "EKS-2-21", "EKS-2-24", "EKS-2-26"],
    findings=["E-11", "E-15", "E-16", "E-46", "E-55"],
)
def all_words_on_the_way_belong_to_one_selection() -> Queries:
    """While a level is published, the screen has that level, CheckMSO is zero or the present echo, MW03 is
    zero or the mode that the panel selects, and MW07 is zero or the acknowledgment of the echoed mode by
    this panel, whatever the EKS signals.
    """
    yield from _proofs_of("all_words_on_the_way_belong_to_one_selection")


@theorem(clauses=["EKS-8-2", "EKS-3-1-FPLC", "EKS-SD-2"], findings=["E-41"])
def no_key_is_changed_behind_the_back_of_the_fplc() -> Queries:
    """Where a key went in while a selection of the key before was going on, the F-PLC sees something else
    than LA and the output that it accepted before that selection can go on.
    """
    yield from _proofs_of("no_key_is_changed_behind_the_back_of_the_fplc")


@theorem(
    clauses=["EKS-2-14", "EKS-2-22", "EKS-2-23", "EKS-SD-5", "EKS-BD-3"],
    findings=["E-15", "E-17", "E-52"],
    properties=["UserIntent", "NothingButTheTouch"],
)
def the_mode_that_becomes_active_was_touched_seen_and_confirmed() -> Queries:
    """With an honest panel, the mode that becomes active is the one that the user touched, saw and
    confirmed since this key went in.

    It rests on A-06 (words arrive within the dwell time) and A-07 (a removal is noticed). Of the EKS
    nothing is used but that a change of key is seen; words are all 65536, so no classes of words are
    needed.
    """
    yield from _proofs_of("the_mode_that_becomes_active_was_touched_seen_and_confirmed")


@theorem(
    clauses=["EKS-2-14", "EKS-2-22", "EKS-2-23", "EKS-SD-5", "EKS-KS-6"],
    findings=["E-09", "E-49"],
    properties=["UserIntent"],
)
def one_broken_wire_of_the_reader_leaves_the_users_intent() -> Queries:
    """With an honest panel and one broken wire at a time between reader and F-PLC, or without the test pulse,
    the mode that becomes active still is the one that the user touched, saw and confirmed since this key went
    in.

    Broken is LA or one output, stuck at 0 or 1, or wired to another one beside its own; not crossed (A-20),
    and not two of them together (A-32). It may begin, end, and be another one in the next scan.
    """
    yield from _proofs_of("one_broken_wire_of_the_reader_leaves_the_users_intent")


@theorem(
    clauses=["EKS-2-20", "EKS-2-22"],
    findings=[],
    properties=["EchoIsTheTouch"],
)
def the_echo_is_of_this_users_touch() -> Queries:
    """While LA is on, what MW05 echoes is what this user touched since this key went in."""
    yield from _proofs_of("the_echo_is_of_this_users_touch")


@theorem(
    clauses=["EKS-2-28", "EKS-2-29"],
    findings=["E-01", "E-16"],
    properties=["SwitchNeedsMatchingPair"],
)
def a_mode_is_switched_only_on_its_pair_of_words() -> Queries:
    """A mode is switched only in a scan in which MW03 and MW07 carry the words of that mode: those that the
    F-PLC reads, whoever wrote them, and with a sound PLC those that it wrote.
    """
    yield from _proofs_of("a_mode_is_switched_only_on_its_pair_of_words")


@theorem(
    clauses=["EKS-2-18", "EKS-T2-2", "EKS-FD-3"],
    findings=["E-12", "E-18", "E-47"],
    properties=["AuthorizationRespected", "NeverBeyondTheKey"],
)
def a_mode_is_switched_only_within_the_level_of_the_key() -> Queries:
    """The mode that is switched never exceeds the level that is signalled in that scan, which is the level
    on the key that the EKS has read, whatever stands in MW03 and MW07.
    """
    yield from _proofs_of("a_mode_is_switched_only_within_the_level_of_the_key")


@theorem(
    clauses=["EKS-SD-2", "EKS-8-8", "EKS-SD-7"],
    findings=["E-24", "E-42"],
    properties=["NoChangeWithoutLA", "NoChangeBesideSwitchover"],
)
def the_mode_changes_only_by_a_switchover_with_la() -> Queries:
    """No mode is switched in a scan in which LA is off, and nothing but a switchover changes the mode (with
    ON_ERROR = hold), whatever words and outputs the F-PLC sees.
    """
    yield from _proofs_of("the_mode_changes_only_by_a_switchover_with_la")


@theorem(
    clauses=["EKS-8-8", "EKS-8-16", "EKS-SD-7"],
    findings=["E-25"],
    properties=["DisplayIsTheMode"],
)
def the_panel_displays_the_active_mode_that_the_display_wire_has_carried() -> Queries:
    """Once the display wire has carried the mode outputs and the panel has scanned, the mode that the panel
    displays as active is the active mode, whatever the F-PLC does.

    A-33 says of the wire that it carries the mode outputs and nothing else, at any time.
    """
    yield from _proofs_of("the_panel_displays_the_active_mode_that_the_display_wire_has_carried")


@theorem(
    clauses=["EKS-FD-1", "EKS-FD-2", "EKS-BD-5", "EKS-SD-20"],
    findings=[],
    properties=["RefinesModeSelection"],
)
def the_devices_together_do_only_what_the_contract_allows() -> Queries:
    """Each step of any device is a step of the contract ModeSelection, or changes nothing there (with
    ON_ERROR = hold).

    The level is the one that the EKS signals by LA and one output alone; history as KeyFlows records it.
    """
    yield from _proofs_of("the_devices_together_do_only_what_the_contract_allows")


@theorem(
    clauses=["EKS-2-14", "EKS-SD-4"],
    findings=["E-51"],
    properties=["NoOfferBeyondTheLevel"],
)
def the_panel_offers_nothing_beyond_the_level_in_force() -> Queries:
    """While a level is in force the panel offers no mode that this level does not permit."""
    yield from _proofs_of("the_panel_offers_nothing_beyond_the_level_in_force")


@theorem(
    clauses=["EKS-2-19", "EKS-2-27"],
    findings=["E-18"],
    properties=["NoWordIsRefused"],
)
def no_word_of_an_honest_panel_is_refused() -> Queries:
    """While LA and the accepted output stand, the F-PLC refuses no word: an honest panel sends none that it
    would have to refuse. In Settle, which judges no word, a deadline may pass (E-15).
    """
    yield from _proofs_of("no_word_of_an_honest_panel_is_refused")

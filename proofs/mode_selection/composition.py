"""From what each device guarantees to what all of them together do, for any order and any number of scans.

The note's four devices, the user and the words between them, with the F-PLC, PLC, panel and EKS of refimpl.
Nothing is known of a device here but its guarantees (`composition_guarantees`), and of the world but the
assumptions of the register (`composition_system`). Words are all 65536; times, permissions and the number of
steps have no bound.
"""

from __future__ import annotations

from typing import Final

import z3

from proofs.mode_selection.composition_argument import Argument, Consequence, Invariant
from proofs.mode_selection.composition_guarantees import (
    ECHOING,
    GUARANTEES,
    OFFERING,
    PENDING,
    QUIET,
    UNKEYED,
    fplc_row,
    hmi_row,
)
from proofs.mode_selection.composition_system import ASSUMPTIONS, ROWS, STEPS, Step, System
from proofs.mode_selection.composition_views import LEVELS, code, is_mode, none_of, permits, signals
from proofs.theorem import Queries, theorem

HOLDING: Final = (*OFFERING, *ECHOING, "Settle")

# ---------------------------------------------------------------- invariants


def _rows(s: System) -> z3.BoolRef:
    return z3.And(fplc_row(s.fplc), hmi_row(s.hmi, ROWS))


def _one_mode_output(s: System) -> z3.BoolRef:
    pairs = [(one, two) for one in LEVELS for two in LEVELS if one < two]
    return z3.And(*[z3.Not(z3.And(s.fplc.MSO[one], s.fplc.MSO[two])) for one, two in pairs])


def _level_and_selection(s: System) -> z3.BoolRef:
    """EKS-2-11, EKS-2-12, EKS-2-18, E-18"""
    f = s.fplc
    selected = z3.And(is_mode(f.selection), permits(ROWS, f.authority, f.selection))
    return z3.And(
        z3.Implies(f.at("Authorize", *HOLDING), is_mode(f.accepted)),
        z3.Implies(f.at(*HOLDING), f.authority == f.accepted),
        z3.Implies(f.at("EchoSelection", *ECHOING), selected),
    )


def _idle_means_zeros(s: System) -> z3.BoolRef:
    """EKS-8-6 to EKS-8-18, E-17, E-27"""
    words = (s.plc.ReadAuthorization, s.plc.CheckMSO, s.plc.MW03, s.plc.MW07)
    sent = (s.fplc.MW01, s.fplc.MW05, s.hmi.SelectMSO, s.hmi.SwitchMSO)
    zeros = z3.And(*[one == 0 for one in (*words, *sent)], s.hmi.at("Inhibited"))
    return z3.Implies(s.fplc.at(*QUIET), zeros)


def _mode_is_a_mode(s: System) -> z3.BoolRef:
    return z3.And(s.fplc.mode >= -1, s.fplc.mode <= 4)


def _screen_has_the_level(s: System) -> z3.BoolRef:
    """EKS-2-13, EKS-2-14, EKS-8-7, E-46, E-55"""
    f, read = s.fplc, s.plc.ReadAuthorization
    level = code("RE", f.authority)
    offered = z3.Implies(z3.Not(s.hmi.at("Inhibited")), s.hmi.offered == f.authority)
    standing = z3.Implies(z3.Not(s.hmi.at("Inhibited")), read == level)
    return z3.And(
        z3.Implies(f.at(*HOLDING), z3.And(z3.Or(read == 0, read == level), offered)),
        z3.Implies(f.at(*OFFERING, *ECHOING), standing),
    )


def _echo_on_the_bus(s: System) -> z3.BoolRef:
    """EKS-2-20, EKS-2-21, EKS-8-15"""
    f, seen = s.fplc, s.plc.CheckMSO
    return z3.And(
        z3.Implies(f.at(*OFFERING), seen == 0),
        z3.Implies(f.at(*ECHOING), z3.Or(seen == 0, seen == code("CH", f.selection))),
    )


def _words_of_one_selection(s: System) -> z3.BoolRef:
    """EKS-2-15, EKS-2-16, EKS-2-24, EKS-2-26, E-11, E-15, E-16"""
    f, h, p = s.fplc, s.hmi, s.plc
    selecting = z3.And(h.at("AwaitEcho"), is_mode(h.selection), p.MW03 == code("SE", h.selection))
    offering = z3.And(
        p.MW07 == 0,
        h.at("Inhibited", "Select", "AwaitEcho"),
        z3.Implies(h.at("AwaitEcho"), z3.And(is_mode(h.selection), permits(ROWS, f.authority, h.selection))),
        z3.Or(p.MW03 == 0, selecting),
    )
    latched = z3.And(selecting, h.selection == f.selection)
    sent = z3.And(h.selection == f.selection, p.MW03 == code("SE", f.selection))
    echoing = z3.And(
        h.at("AwaitEcho", "Confirm", "AwaitSwitch", "Withdrawn"),
        z3.Implies(z3.Not(h.at("AwaitEcho")), p.CheckMSO == code("CH", f.selection)),
        z3.Implies(z3.Not(h.at("Withdrawn")), sent),
        z3.Implies(p.MW07 != 0, z3.And(h.at("AwaitSwitch"), p.MW07 == code("SW", f.selection))),
    )
    return z3.And(
        z3.Implies(f.at(*OFFERING), offering),
        z3.Implies(f.at("EchoSelection"), latched),
        z3.Implies(f.at(*ECHOING), echoing),
    )


def _unseen_key_has_no_la(s: System) -> z3.BoolRef:
    """EKS-8-2, EKS-3-1-FPLC"""
    return z3.Implies(s.history.unseen, z3.And(z3.Not(s.eks.LA), s.fplc.at(*OFFERING, *ECHOING)))


def _touched_seen_confirmed(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-2-22, EKS-2-23"""
    f, h, user = s.fplc, s.hmi, s.history
    touching = z3.Implies(z3.And(f.at(*OFFERING), h.at("AwaitEcho")), user.touched == h.selection)
    mode = f.selection
    echoed = z3.And(
        user.touched == mode,
        z3.Implies(h.at("Confirm", "AwaitSwitch"), user.seen == mode),
        z3.Implies(h.at("AwaitSwitch"), user.confirmed == mode),
    )
    return z3.Implies(z3.Not(user.unseen), z3.And(touching, z3.Implies(f.at(*ECHOING), echoed)))


def _echo_is_the_touch(s: System) -> z3.BoolRef:
    echoed = z3.And(s.fplc.MW05 != 0, s.eks.LA)
    return z3.Implies(echoed, s.fplc.MW05 == code("CH", s.history.touched))


def _asked_before_confirmed(s: System) -> z3.BoolRef:
    """EKS-2-22, EKS-2-23: while the panel waits for the confirmation, nothing of this selection is confirmed"""
    user = s.history
    return z3.And(
        z3.Implies(s.hmi.at("AwaitEcho", "Confirm"), user.confirmed == -1),
        z3.And(*[z3.And(one >= -1, one <= 4) for one in (user.touched, user.seen, user.confirmed)]),
    )


def _displays_or_switched(s: System) -> z3.BoolRef:
    """EKS-8-8, E-25"""
    return z3.Or(s.hmi.active == s.fplc.mode, s.hmi.at("AwaitSwitch"))


def _displays_the_mode(s: System) -> z3.BoolRef:
    return z3.Implies(s.fplc.at("Idle"), s.hmi.active == s.fplc.mode)


def _signals_the_key(s: System) -> z3.BoolRef:
    """EKS-2-7, EKS-KS-5: with LA, one output alone is that of the level on the key that was read"""
    pairs = [(signals(s.eks.outputs, one), s.eks.level == code("RE", one)) for one in LEVELS]
    return z3.Implies(s.eks.LA, z3.And(*[z3.Implies(one, level) for one, level in pairs]))


def _one_output_outside_the_pulse(s: System) -> z3.BoolRef:
    """EKS-KS-5, EKS-2-10"""
    one = z3.Or(*[signals(s.eks.outputs, level) for level in (-1, *LEVELS)])
    return z3.Or(s.eks.at("TestOnes"), one)


def _no_output_without_la(s: System) -> z3.BoolRef:
    """EKS-2-3, EKS-8-5, EKS-SD-2"""
    return z3.Or(s.eks.LA, s.eks.at("ClearOutputs"), none_of(s.eks.outputs))


def _nothing_kept_without_a_key(s: System) -> z3.BoolRef:
    """EKS-8-6, E-17, E-35"""
    f = s.fplc
    keyless = f.at(*UNKEYED, "PulseOnes", "PulseZeros", "OneOutput")
    nobody = z3.And(f.accepted == -1, f.authority == -1)
    return z3.And(
        z3.Implies(keyless, nobody),
        z3.Implies(f.at("Authorize"), f.authority == -1),
        z3.Or(f.at("EchoSelection", *ECHOING), f.selection == -1),
    )


def _selection_within_authority(s: System) -> z3.BoolRef:
    """EKS-2-18, EKS-T2-2"""
    f = s.fplc
    return z3.And(
        z3.Or(f.selection == -1, permits(ROWS, f.authority, f.selection)),
        z3.Or(f.authority == -1, f.authority == f.accepted),
    )


def _words_zero_without_key(s: System) -> z3.BoolRef:
    """EKS-8-6, EKS-8-8"""
    return z3.Implies(s.fplc.accepted == -1, z3.And(s.fplc.MW01 == 0, s.fplc.MW05 == 0))


def _echo_is_the_selection(s: System) -> z3.BoolRef:
    """EKS-2-20, EKS-6-12"""
    f = s.fplc
    echo = z3.And(
        is_mode(f.selection),
        f.MW05 == code("CH", f.selection),
        permits(ROWS, f.authority, f.selection),
        f.MW01 == code("RE", f.authority),
    )
    return z3.Implies(f.MW05 != 0, echo)


def _selection_within_offer(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-SD-4"""
    return z3.Or(s.hmi.selection == -1, permits(ROWS, s.hmi.offered, s.hmi.selection))


def _pending_means_offered(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-2-25, EKS-8-9"""
    h = s.hmi
    return z3.If(h.at(*PENDING), permits(ROWS, h.offered, h.selection), h.selection == -1)


def _inhibited_sends_zeros(s: System) -> z3.BoolRef:
    """EKS-8-8, EKS-8-9, EKS-8-16"""
    return z3.Implies(s.hmi.at("Inhibited"), z3.And(s.hmi.SelectMSO == 0, s.hmi.SwitchMSO == 0))


def _no_offer_beyond_the_level(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-SD-4, E-51"""
    level = s.fplc.authority
    beyond = [z3.And(s.hmi.enabled[mode], z3.Not(permits(ROWS, level, mode))) for mode in LEVELS]
    return z3.Or(level == -1, z3.Not(z3.Or(*beyond)))


# ---------------------------------------------------------------- consequences


def _change_of_key_is_seen(step: Step) -> z3.BoolRef:
    """A-07 as the F-PLC sees it: after a key went in, it first sees another thing than LA and its output."""
    stands = z3.And(step.fplc.LA, signals(step.fplc.outputs, step.fplc.before.accepted))
    return z3.Implies(step.before.history.unseen, z3.Not(stands))


def _pair(step: Step) -> z3.BoolRef:
    mode = step.after.fplc.mode
    pair = z3.And(is_mode(mode), step.before.plc.MW03 == code("SE", mode), step.before.plc.MW07 == code("SW", mode))
    return z3.Implies(step.fplc.switches, pair)


def _within_level(step: Step) -> z3.BoolRef:
    """The mode is permitted by the one output that the F-PLC sees."""
    mode = step.after.fplc.mode
    seen = [z3.And(signals(step.fplc.outputs, one), permits(ROWS, one, mode)) for one in LEVELS]
    return z3.Implies(step.fplc.switches, z3.Or(*seen))


def _within_key(step: Step) -> z3.BoolRef:
    """The mode is permitted by the level on the key that the EKS has read."""
    mode, level = step.after.fplc.mode, step.before.eks.level
    permitted = [z3.And(level == code("RE", one), permits(ROWS, one, mode), mode <= one) for one in LEVELS]
    return z3.Implies(step.fplc.switches, z3.Or(*permitted))


def _with_la(step: Step) -> z3.BoolRef:
    return z3.Implies(z3.Or(step.fplc.switches, step.after.fplc.mode != step.before.fplc.mode), step.fplc.LA)


def _only_by_switching(step: Step) -> z3.BoolRef:
    changed = step.after.fplc.mode != step.before.fplc.mode
    return z3.Implies(changed, step.fplc.switches) if step.actor == "fplc" else z3.Not(changed)


def _pair_read(step: Step) -> z3.BoolRef:
    """The same of the words that the F-PLC reads, whoever wrote them."""
    mode = step.after.fplc.mode
    pair = z3.And(step.fplc.MW03 == code("SE", mode), step.fplc.MW07 == code("SW", mode))
    return z3.Implies(step.fplc.switches, z3.And(is_mode(mode), pair))


def _nothing_but_the_touch(step: Step) -> z3.BoolRef:
    return z3.Implies(step.fplc.switches, step.before.history.touched == step.after.fplc.mode)


def _user_intent(step: Step) -> z3.BoolRef:
    mode, user = step.after.fplc.mode, step.before.history
    all_three = z3.And(user.touched == mode, user.seen == mode, user.confirmed == mode)
    return z3.Implies(step.fplc.switches, z3.And(is_mode(mode), all_three))


def _no_word_is_refused(step: Step) -> z3.BoolRef:
    """No scan that finds LA and the accepted output ends in Error once an output was accepted."""
    scan = step.fplc
    stands = z3.And(scan.LA, signals(scan.outputs, scan.before.accepted))
    return z3.Not(z3.And(scan.before.at("Authorize", *HOLDING), stands, scan.after.at("Error")))


def _signalled(s: System) -> z3.BitVecRef:
    """The level that the EKS signals now, or none: LA and one output alone."""
    level = z3.BitVecVal(-1, 8)
    for one in LEVELS:
        level = z3.If(z3.And(s.eks.LA, signals(s.eks.outputs, one)), z3.BitVecVal(one, 8), level)
    return level


def _allowed_by_the_contract(step: Step) -> z3.BoolRef:
    """The step is one of ModeSelection.tla, or changes nothing there. EKS-FD-1, EKS-FD-2"""
    now, new = step.before.history, step.after.history
    level, mode = _signalled(step.before), step.before.fplc.mode
    level_kept, mode_kept = _signalled(step.after) == level, step.after.fplc.mode == mode
    touched_kept, seen_kept = new.touched == now.touched, new.seen == now.seen
    confirmed_kept = new.confirmed == now.confirmed
    history_kept = z3.And(touched_kept, seen_kept, confirmed_kept)
    fresh = z3.And(new.seen == -1, new.confirmed == -1)
    insert = z3.And(new.touched == -1, fresh, level_kept, mode_kept)
    signal = z3.And(history_kept, mode_kept)
    touch = z3.And(is_mode(new.touched), fresh, level_kept, mode_kept)
    show = z3.And(now.touched != -1, new.seen == now.touched, touched_kept, confirmed_kept, level_kept, mode_kept)
    confirm = z3.And(now.seen != -1, new.confirmed == now.seen, touched_kept, seen_kept, level_kept, mode_kept)
    agreed = z3.And(now.confirmed != -1, now.confirmed == now.touched, now.confirmed == now.seen)
    permitted = z3.And(level != -1, now.confirmed <= level)
    switch = z3.And(agreed, permitted, step.after.fplc.mode == now.confirmed, history_kept, level_kept)
    return z3.Or(insert, signal, touch, show, confirm, switch)


# ---------------------------------------------------------------- the argument

ROWS_HOLD: Final = "the words are the rows of the states"
LEVEL: Final = "the level is that of the accepted output"
FORGOTTEN: Final = "nothing is kept without a key"
OFFERED: Final = "a pending selection was offered"
ZEROS: Final = "a new insertion begins with zeros"
SCREEN: Final = "the screen has the level of the F-PLC"
ECHO: Final = "CheckMSO is zero or the echo"
WORDS: Final = "the words are those of one selection"
UNSEEN: Final = "a key that was not seen has no LA"
SEEN: Final = "a change of key is seen"
HISTORY: Final = "what is echoed was touched, seen, confirmed"
SIGNALLED: Final = "the one output is that of the key"
ASKED: Final = "nothing is confirmed while it is asked"
MODE: Final = "the mode is one of five, or none"
DISPLAYED: Final = "the mode is displayed, or was just switched"
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
COPIES: Final = "the PLC copies or keeps"
WIRED, OUTPUTS_WIRED, DISPLAY_WIRED = "words are wired", "outputs are wired", "the display is wired"
ARRIVE, HELD, ORDERED = "words arrive within the dwell time", "the error mode holds the mode", "levels are ordered"
GOES_IN, NOTICED = "a key goes in without LA", "a removal is noticed before LA comes again"

ARGUMENT: Final = Argument(
    GUARANTEES,
    ASSUMPTIONS,
    (
        Invariant(ROWS_HOLD, _rows, (F_ROW, H_ROW), "the_words_of_a_device_are_the_row_of_its_state"),
        Invariant("one mode output", _one_mode_output, (ROWS_HOLD,), "at_most_one_mode_output_is_set"),
        Invariant(LEVEL, _level_and_selection, (F_ACCEPT, F_ONE, F_LATCH, F_ECHO), "x"),
        Invariant(FORGOTTEN, _nothing_kept_without_a_key, (F_FORGET,), "x"),
        Invariant("selection within authority", _selection_within_authority, (LEVEL, FORGOTTEN), "x"),
        Invariant("words zero without key", _words_zero_without_key, (ROWS_HOLD, LEVEL), "x"),
        Invariant("the echo is the selection", _echo_is_the_selection, (ROWS_HOLD, LEVEL), "x"),
        Invariant(OFFERED, _pending_means_offered, (H_OPEN, H_SELECT, H_ASK, H_ACKNOWLEDGE, H_FORGET), "x"),
        Invariant("selection within offer", _selection_within_offer, (OFFERED,), "x"),
        Invariant("inhibited sends zeros", _inhibited_sends_zeros, (ROWS_HOLD,), "x"),
        Invariant("one output outside the pulse", _one_output_outside_the_pulse, ("the EKS sets several outputs in its pulse",), "x"),
        Invariant("no output without LA", _no_output_without_la, ("the EKS sets no output without LA",), "x"),
        Invariant(ZEROS, _idle_means_zeros, (ROWS_HOLD, F_ZEROS, H_OPEN, COPIES, WIRED, ARRIVE), "x"),
        Invariant(SCREEN, _screen_has_the_level, (ROWS_HOLD, ZEROS, F_OFFER, F_LATCH, F_ECHO, F_ONE, H_OPEN, COPIES, WIRED, ARRIVE), "x"),
        Invariant(ECHO, _echo_on_the_bus, (ROWS_HOLD, ZEROS, F_OFFER, F_LATCH, F_ECHO, COPIES, WIRED, ARRIVE), "x"),
        Invariant(WORDS, _words_of_one_selection, (ROWS_HOLD, LEVEL, ZEROS, SCREEN, ECHO, F_OFFER, F_LATCH, F_ECHO, H_CLOSE, H_OFFER, H_SELECT, H_ASK, H_ACKNOWLEDGE, H_GIVE_UP, COPIES, WIRED, ARRIVE), "x"),
        Invariant(UNSEEN, _unseen_key_has_no_la, (GOES_IN, NOTICED), "x"),
        Consequence(SEEN, _change_of_key_is_seen, ("fplc",), (UNSEEN, OUTPUTS_WIRED), "x"),
        Invariant(HISTORY, _touched_seen_confirmed, (ROWS_HOLD, LEVEL, WORDS, ZEROS, F_OFFER, F_LATCH, F_ECHO, H_SELECT, H_ACKNOWLEDGE, ARRIVE), "x"),
        Consequence(INTENT, _user_intent, ("fplc",), (LEVEL, WORDS, HISTORY, SEEN, F_SWITCH, WIRED), "x"),
        Consequence("nothing but the touch", _nothing_but_the_touch, ("fplc",), (INTENT,), "x"),
        Invariant("the echo is the touch", _echo_is_the_touch, (ROWS_HOLD, UNSEEN, HISTORY), "x"),
        Consequence("the pair", _pair, ("fplc",), (LEVEL, F_SWITCH, WIRED), "x"),
        Consequence("the pair read", _pair_read, ("fplc",), (LEVEL, F_SWITCH), "x"),
        Consequence(WITHIN_LEVEL, _within_level, ("fplc",), (LEVEL, F_SWITCH), "x"),
        Invariant(SIGNALLED, _signals_the_key, ("the EKS signals the level read",), "x"),
        Consequence(WITHIN_KEY, _within_key, ("fplc",), (WITHIN_LEVEL, F_SWITCH, SIGNALLED, OUTPUTS_WIRED, ORDERED), "x"),
        Consequence("with LA", _with_la, ("fplc",), (F_SWITCH, F_MODE, HELD), "x"),
        Consequence(ONLY_BY_SWITCHING, _only_by_switching, STEPS, (F_MODE, HELD), "x"),
        Invariant(MODE, _mode_is_a_mode, (LEVEL, F_SWITCH, F_MODE), "x"),
        Invariant(DISPLAYED, _displays_or_switched, (ROWS_HOLD, LEVEL, MODE, WORDS, F_SWITCH, F_MODE, HELD, H_ROW, WIRED, DISPLAY_WIRED), "x"),
        Invariant("the panel displays the mode", _displays_the_mode, (DISPLAYED, ZEROS), "x"),
        Invariant(ASKED, _asked_before_confirmed, (H_SELECT, H_ASK), "x"),
        Consequence("the contract", _allowed_by_the_contract, STEPS, (INTENT, WITHIN_LEVEL, F_SWITCH, ONLY_BY_SWITCHING, ASKED, OUTPUTS_WIRED, ORDERED), "x"),
        Invariant("no offer beyond the level", _no_offer_beyond_the_level, (ROWS_HOLD, FORGOTTEN, SCREEN), "x"),
        Consequence("no word is refused", _no_word_is_refused, ("fplc",), (ZEROS, WORDS, "the F-PLC refuses only wrong words", WIRED), "x"),
    ),
)

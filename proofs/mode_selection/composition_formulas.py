"""What is true of all devices together: formulas about one moment of the system, or about one step of it.

Each is written as properties.toml and KeyFlows.tla say it, or is a link towards one of those. What makes them
true is in `composition`.
"""

from __future__ import annotations

import z3

from proofs.mode_selection.composition_guarantees import (
    ECHOING,
    HOLDING,
    OFFERING,
    PENDING,
    QUIET,
    UNKEYED,
    fplc_row,
    hmi_row,
)
from proofs.mode_selection.composition_system import ROWS, Step, System
from proofs.mode_selection.composition_views import LEVELS, code, is_mode, none_of, permits, signals

# ---------------------------------------------------------------- of one moment


def fplc_writes_its_row(s: System) -> z3.BoolRef:
    """EKS-2-12, EKS-2-20, EKS-8-6"""
    return fplc_row(s.fplc)


def hmi_writes_its_row(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-2-15, EKS-2-22, EKS-2-24, EKS-8-9"""
    return hmi_row(s.hmi, ROWS)


def one_mode_output(s: System) -> z3.BoolRef:
    pairs = [(level, two) for level in LEVELS for two in LEVELS if level < two]
    return z3.And(*[z3.Not(z3.And(s.fplc.MSO[first], s.fplc.MSO[two])) for first, two in pairs])


def level_and_selection(s: System) -> z3.BoolRef:
    """EKS-2-11, EKS-2-12, EKS-2-18, E-18"""
    f = s.fplc
    selected = z3.And(is_mode(f.selection), permits(ROWS, f.authority, f.selection))
    return z3.And(
        z3.Implies(f.at("Authorize", *HOLDING), is_mode(f.accepted)),
        z3.Implies(f.at(*HOLDING), f.authority == f.accepted),
        z3.Implies(f.at("EchoSelection", *ECHOING), selected),
    )


def idle_means_zeros(s: System) -> z3.BoolRef:
    """EKS-8-6 to EKS-8-18, E-17, E-27"""
    words = (s.plc.ReadAuthorization, s.plc.CheckMSO, s.plc.MW03, s.plc.MW07)
    sent = (s.fplc.MW01, s.fplc.MW05, s.hmi.SelectMSO, s.hmi.SwitchMSO)
    zeros = z3.And(*[word == 0 for word in (*words, *sent)], s.hmi.at("Inhibited"))
    return z3.Implies(s.fplc.at(*QUIET), zeros)


def screen_has_the_level(s: System) -> z3.BoolRef:
    """EKS-2-13, EKS-2-14, EKS-8-7, E-46, E-55"""
    f, read = s.fplc, s.plc.ReadAuthorization
    level = code("RE", f.authority)
    offered = z3.Implies(z3.Not(s.hmi.at("Inhibited")), s.hmi.offered == f.authority)
    standing = z3.Implies(z3.Not(s.hmi.at("Inhibited")), read == level)
    return z3.And(
        z3.Implies(f.at(*HOLDING), z3.And(z3.Or(read == 0, read == level), offered)),
        z3.Implies(f.at(*OFFERING, *ECHOING), standing),
    )


def echo_on_the_bus(s: System) -> z3.BoolRef:
    """EKS-2-20, EKS-2-21, EKS-8-15"""
    f, seen = s.fplc, s.plc.CheckMSO
    return z3.And(
        z3.Implies(f.at(*OFFERING), seen == 0),
        z3.Implies(f.at(*ECHOING), z3.Or(seen == 0, seen == code("CH", f.selection))),
    )


def words_of_one_selection(s: System) -> z3.BoolRef:
    """EKS-2-15, EKS-2-16, EKS-2-24, EKS-2-26, E-11, E-15, E-16, E-61"""
    f, h, p = s.fplc, s.hmi, s.plc
    selecting = z3.And(h.at("AwaitEcho"), is_mode(h.selection), code("SE", h.selection) == p.MW03)
    offering = z3.And(
        p.MW07 == 0,
        h.at("Inhibited", "Select", "AwaitEcho"),
        z3.Implies(h.at("AwaitEcho"), z3.And(is_mode(h.selection), permits(ROWS, f.authority, h.selection))),
        z3.Or(p.MW03 == 0, selecting),
    )
    latched = z3.And(selecting, h.selection == f.selection)
    sent = z3.And(h.selection == f.selection, code("SE", f.selection) == p.MW03)
    echoing = z3.And(
        h.at("AwaitEcho", "Confirm", "AwaitSwitch", "Withdrawn"),
        z3.Implies(z3.Not(h.at("AwaitEcho")), p.CheckMSO == code("CH", f.selection)),
        z3.Implies(z3.Not(h.at("Withdrawn")), sent),
        z3.Or(p.MW03 == 0, code("SE", f.selection) == p.MW03),
        z3.Implies(p.MW07 != 0, z3.And(h.at("AwaitSwitch"), code("SW", f.selection) == p.MW07)),
    )
    return z3.And(
        z3.Implies(f.at(*OFFERING), offering),
        z3.Implies(f.at("EchoSelection"), latched),
        z3.Implies(f.at(*ECHOING), echoing),
    )


def unseen_key_has_no_la(s: System) -> z3.BoolRef:
    """EKS-8-2, EKS-3-1-FPLC"""
    return z3.Implies(s.history.unseen, z3.And(z3.Not(s.eks.LA), s.fplc.at(*OFFERING, *ECHOING)))


def off_means_off(s: System) -> z3.BoolRef:
    """EKS-2-5, EKS-8-5: LA is on in four states; without it an output is on only to be cleared"""
    on = s.eks.at("StartTest", "TestOnes", "TestZeros", "Signal")
    off = z3.Or(on, s.eks.at("ClearOutputs"), none_of(s.eks.outputs))
    return z3.And(on == s.eks.LA, off)


def low_means_off(s: System) -> z3.BoolRef:
    """EKS-8-2, EKS-8-5: the F-PLC has scanned while all was off, and holds no selection since"""
    off = z3.And(z3.Not(s.eks.LA), none_of(s.eks.outputs))
    return z3.Implies(s.history.low, z3.And(off, z3.Not(s.fplc.at(*OFFERING, *ECHOING))))


def unseen_key_finds_all_off(s: System) -> z3.BoolRef:
    """EKS-8-2, EKS-8-5, EKS-3-1-FPLC"""
    off = z3.And(z3.Not(s.eks.LA), none_of(s.eks.outputs))
    selecting = z3.And(s.fplc.at(*OFFERING, *ECHOING), z3.Not(s.history.low))
    return z3.Implies(s.history.unseen, z3.And(off, selecting))


def touched_seen_confirmed(s: System) -> z3.BoolRef:
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


def echo_is_the_touch(s: System) -> z3.BoolRef:
    echoed = z3.And(s.fplc.MW05 != 0, s.eks.LA)
    return z3.Implies(echoed, code("CH", s.history.touched) == s.fplc.MW05)


def asked_before_confirmed(s: System) -> z3.BoolRef:
    """EKS-2-22, EKS-2-23: while the panel asks, nothing of this selection is confirmed"""
    user = s.history
    return z3.And(
        z3.Implies(s.hmi.at("AwaitEcho", "Confirm"), user.confirmed == -1),
        z3.And(*[z3.And(mode >= -1, mode <= 4) for mode in (user.touched, user.seen, user.confirmed)]),
    )


def displays_what_has_come(s: System) -> z3.BoolRef:
    """EKS-8-8, E-25: what the mode outputs have reached holds out, or displays, the active mode"""
    wire, mode = s.history, s.fplc.mode
    carried = z3.Implies(wire.come >= 1, wire.carried == mode)
    return z3.And(wire.come >= 0, wire.come <= 2, carried, z3.Implies(wire.come == 2, s.hmi.active == mode))


def signals_the_key(s: System) -> z3.BoolRef:
    """EKS-2-7, EKS-KS-5: with LA, one output alone is that of the level on the key that was read"""
    pairs = [(signals(s.eks.outputs, level), s.eks.level == code("RE", level)) for level in LEVELS]
    return z3.Implies(s.eks.LA, z3.And(*[z3.Implies(permission, level) for permission, level in pairs]))


def one_output_outside_the_pulse(s: System) -> z3.BoolRef:
    """EKS-KS-5, EKS-2-10"""
    some_output = z3.Or(*[signals(s.eks.outputs, level) for level in (-1, *LEVELS)])
    return z3.Or(s.eks.at("TestOnes"), some_output)


def no_output_without_la(s: System) -> z3.BoolRef:
    """EKS-2-3, EKS-8-5, EKS-SD-2"""
    return z3.Or(s.eks.LA, s.eks.at("ClearOutputs"), none_of(s.eks.outputs))


def nothing_kept_without_a_key(s: System) -> z3.BoolRef:
    """EKS-8-6, E-17"""
    f = s.fplc
    keyless = f.at(*UNKEYED, "PulseOnes", "PulseZeros", "OneOutput")
    nobody = z3.And(f.accepted == -1, f.authority == -1)
    return z3.And(
        z3.Implies(keyless, nobody),
        z3.Implies(f.at("Authorize"), f.authority == -1),
        z3.Or(f.at("EchoSelection", *ECHOING), f.selection == -1),
    )


def selection_within_authority(s: System) -> z3.BoolRef:
    """EKS-2-18, EKS-T2-2"""
    f = s.fplc
    return z3.And(
        z3.Or(f.selection == -1, permits(ROWS, f.authority, f.selection)),
        z3.Or(f.authority == -1, f.authority == f.accepted),
    )


def words_zero_without_key(s: System) -> z3.BoolRef:
    """EKS-8-6, EKS-8-8"""
    return z3.Implies(s.fplc.accepted == -1, z3.And(s.fplc.MW01 == 0, s.fplc.MW05 == 0))


def echo_is_the_selection(s: System) -> z3.BoolRef:
    """EKS-2-20, EKS-6-12"""
    f = s.fplc
    echo = z3.And(
        is_mode(f.selection),
        code("CH", f.selection) == f.MW05,
        permits(ROWS, f.authority, f.selection),
        code("RE", f.authority) == f.MW01,
    )
    return z3.Implies(f.MW05 != 0, echo)


def selection_within_offer(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-SD-4"""
    return z3.Or(s.hmi.selection == -1, permits(ROWS, s.hmi.offered, s.hmi.selection))


def pending_means_offered(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-2-25, EKS-8-9"""
    h = s.hmi
    return z3.If(h.at(*PENDING), permits(ROWS, h.offered, h.selection), h.selection == -1)


def inhibited_sends_zeros(s: System) -> z3.BoolRef:
    """EKS-8-8, EKS-8-9, EKS-8-16"""
    return z3.Implies(s.hmi.at("Inhibited"), z3.And(s.hmi.SelectMSO == 0, s.hmi.SwitchMSO == 0))


def no_offer_beyond_the_level(s: System) -> z3.BoolRef:
    """EKS-2-14, EKS-SD-4, E-51"""
    level = s.fplc.authority
    beyond = [z3.And(s.hmi.enabled[mode], z3.Not(permits(ROWS, level, mode))) for mode in LEVELS]
    return z3.Or(level == -1, z3.Not(z3.Or(*beyond)))


# ---------------------------------------------------------------- of one step


def change_of_key_is_seen(step: Step) -> z3.BoolRef:
    """A-07 as the F-PLC sees it: after a key went in, it first sees another thing than LA and its output."""
    stands = z3.And(step.fplc.LA, signals(step.fplc.outputs, step.fplc.before.accepted))
    return z3.Implies(step.before.history.unseen, z3.Not(stands))


def pair(step: Step) -> z3.BoolRef:
    mode = step.after.fplc.mode
    pair = z3.And(
        is_mode(mode), code("SE", mode) == step.before.plc.MW03, code("SW", mode) == step.before.plc.MW07
    )
    return z3.Implies(step.fplc.switches, pair)


def within_level(step: Step) -> z3.BoolRef:
    """The mode is permitted by the one output that the F-PLC sees."""
    mode = step.after.fplc.mode
    seen = [z3.And(signals(step.fplc.outputs, level), permits(ROWS, level, mode)) for level in LEVELS]
    return z3.Implies(step.fplc.switches, z3.Or(*seen))


def within_key(step: Step) -> z3.BoolRef:
    """The mode is permitted by the level on the key that the EKS has read."""
    mode, level = step.after.fplc.mode, step.before.eks.level
    permitted = [
        z3.And(level == code("RE", number), permits(ROWS, number, mode), mode <= number) for number in LEVELS
    ]
    return z3.Implies(step.fplc.switches, z3.Or(*permitted))


def with_la(step: Step) -> z3.BoolRef:
    return z3.Implies(z3.Or(step.fplc.switches, step.after.fplc.mode != step.before.fplc.mode), step.fplc.LA)


def only_by_switching(step: Step) -> z3.BoolRef:
    changed = step.after.fplc.mode != step.before.fplc.mode
    return z3.Implies(changed, step.fplc.switches) if step.actor == "fplc" else z3.Not(changed)


def pair_read(step: Step) -> z3.BoolRef:
    """The same of the words that the F-PLC reads, whoever wrote them."""
    mode = step.after.fplc.mode
    pair = z3.And(code("SE", mode) == step.fplc.MW03, code("SW", mode) == step.fplc.MW07)
    return z3.Implies(step.fplc.switches, z3.And(is_mode(mode), pair))


def nothing_but_the_touch(step: Step) -> z3.BoolRef:
    return z3.Implies(step.fplc.switches, step.before.history.touched == step.after.fplc.mode)


def user_intent(step: Step) -> z3.BoolRef:
    mode, user = step.after.fplc.mode, step.before.history
    all_three = z3.And(user.touched == mode, user.seen == mode, user.confirmed == mode)
    return z3.Implies(step.fplc.switches, z3.And(is_mode(mode), all_three))


def no_word_is_refused(step: Step) -> z3.BoolRef:
    """No scan that finds LA and the accepted output ends in Error once an output was accepted; Settle judges
    no word, and its deadline is no refusal (E-15)
    """
    scan = step.fplc
    stands = z3.And(scan.LA, signals(scan.outputs, scan.before.accepted))
    judged = scan.before.at("Authorize", *OFFERING, *ECHOING)
    return z3.Not(z3.And(judged, stands, scan.after.at("Error")))


def signalled(s: System) -> z3.BitVecRef:
    """The level that the EKS signals now, or none: LA and one output alone."""
    level = z3.BitVecVal(-1, 8)
    for number in LEVELS:
        level = z3.If(z3.And(s.eks.LA, signals(s.eks.outputs, number)), z3.BitVecVal(number, 8), level)
    return level


def allowed_by_the_contract(step: Step) -> z3.BoolRef:
    """The step is one of ModeSelection.tla, or changes nothing there. EKS-FD-1, EKS-FD-2"""
    now, new = step.before.history, step.after.history
    level, mode = signalled(step.before), step.before.fplc.mode
    level_kept, mode_kept = signalled(step.after) == level, step.after.fplc.mode == mode
    touched_kept, seen_kept = new.touched == now.touched, new.seen == now.seen
    confirmed_kept = new.confirmed == now.confirmed
    history_kept = z3.And(touched_kept, seen_kept, confirmed_kept)
    fresh = z3.And(new.seen == -1, new.confirmed == -1)
    insert = z3.And(new.touched == -1, fresh, level_kept, mode_kept)
    signal = z3.And(history_kept, mode_kept)
    touch = z3.And(is_mode(new.touched), fresh, level_kept, mode_kept)
    show = z3.And(
        now.touched != -1, new.seen == now.touched, touched_kept, confirmed_kept, level_kept, mode_kept
    )
    confirm = z3.And(
        now.seen != -1, new.confirmed == now.seen, touched_kept, seen_kept, level_kept, mode_kept
    )
    agreed = z3.And(now.confirmed != -1, now.confirmed == now.touched, now.confirmed == now.seen)
    permitted = z3.And(level != -1, now.confirmed <= level)
    switch = z3.And(agreed, permitted, step.after.fplc.mode == now.confirmed, history_kept, level_kept)
    return z3.Or(insert, signal, touch, show, confirm, switch)

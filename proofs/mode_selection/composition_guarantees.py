"""What each device guarantees of any one of its scans, whatever the other devices do.

Each guarantee is one named formula about a scan. It is proved here of every path of the shipped `step`, with
any memory, inputs, times and parameters; the composition argument then knows nothing of the devices but these
formulas. None of them rests on another device, so that nothing is assumed in a circle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import z3

from proofs.explorer.device import LOGIC, Device
from proofs.mode_selection.composition_views import (
    LEVELS,
    EksScan,
    Fplc,
    FplcScan,
    Hmi,
    HmiScan,
    PlcScan,
    code,
    ends_of,
    is_mode,
    none_of,
    permits,
    signals,
)
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.theorem import Queries, claim, theorem

QUIET: Final = ("Idle", "PulseOnes", "PulseZeros", "OneOutput", "Authorize")
"""No level is published: a key is awaited, or is being read."""
OFFERING: Final = ("AwaitSelection", "CheckSelection", "EchoSelection")
"""A level is published, and no echo."""
ECHOING: Final = ("AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch", "Complete")
"""A level and an echo are published."""
HOLDING: Final = (*OFFERING, *ECHOING, "Settle")
"""A level is in force."""
UNKEYED: Final = ("Start", "Idle", "Clear", "AwaitZeros", "Error")
"""The F-PLC has noticed that no key is in, or takes none."""
PENDING: Final = ("AwaitEcho", "Confirm", "AwaitSwitch")
"""The panel sends a selection."""


@dataclass(frozen=True)
class Guarantee:
    """A named formula about any one scan of a device."""

    name: str
    device: Device
    of: Callable[[Any], z3.BoolRef]
    theorem: str
    """The theorem that discharges it."""


# ---------------------------------------------------------------- the F-PLC


def fplc_row(f: Fplc) -> z3.BoolRef:
    """The outputs are the row of the state. EKS-2-12, EKS-2-20, EKS-8-6, E-59"""
    level = z3.If(f.at(*OFFERING, *ECHOING), code("RE", f.authority), code("RE", -1))
    shown = z3.If(f.at(*ECHOING), code("CH", f.selection), code("CH", -1))
    modes = [f.MSO[mode] == (f.mode == mode) for mode in LEVELS]
    return z3.And(level == f.MW01, shown == f.MW05, *modes, f.at("Error") == f.ERROR)


def _writes_its_row(s: FplcScan) -> z3.BoolRef:
    return fplc_row(s.after)


def _zeros_before_a_key(s: FplcScan) -> z3.BoolRef:
    """EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-23, E-25c, E-52"""
    came = z3.And(s.after.at(*QUIET), z3.Not(s.before.at(*QUIET)))
    zeros = z3.And(s.MW03 == 0, s.MW07 == 0, z3.Not(s.LA), none_of(s.outputs), s.dwelt)
    return z3.Implies(came, z3.And(s.after.at("Idle"), s.before.at("Start", "AwaitZeros", "Error"), zeros))


def _offer_after_key_or_zeros(s: FplcScan) -> z3.BoolRef:
    """EKS-2-12, EKS-2-17, E-15, E-52"""
    zeros = z3.And(s.before.at("Settle"), s.MW03 == 0, s.MW07 == 0, s.dwelt)
    begins = z3.And(s.after.at("AwaitSelection"), z3.Not(s.before.at("AwaitSelection")))
    goes_on = z3.Implies(s.after.at("CheckSelection"), s.before.at("AwaitSelection"))
    return z3.And(z3.Implies(begins, z3.Or(s.before.at("Authorize"), zeros)), goes_on)


def _accepts_one_output(s: FplcScan) -> z3.BoolRef:
    """EKS-2-11, EKS-4-5, EKS-4-7, EKS-KS-5"""
    signalled = z3.And(s.LA, is_mode(s.after.accepted), signals(s.outputs, s.after.accepted))
    return z3.Implies(s.after.at("Authorize"), z3.And(s.before.at("OneOutput"), signalled))


def _one_authority(s: FplcScan) -> z3.BoolRef:
    """EKS-2-12, E-18: published from the accepted output, then kept to the end of the insertion"""
    published = z3.And(s.before.at("Authorize"), s.after.authority == s.before.accepted)
    kept = z3.And(s.before.at(*HOLDING), s.after.authority == s.before.authority)
    same_output = s.after.accepted == s.before.accepted
    return z3.Implies(s.after.at(*HOLDING), z3.And(z3.Or(published, kept), same_output))


def _latched_from_mw03(s: FplcScan) -> z3.BoolRef:
    """EKS-2-18, EKS-2-19, E-14, E-16"""
    latched = z3.And(
        s.before.at("CheckSelection"),
        is_mode(s.after.selection),
        code("SE", s.after.selection) == s.MW03,
        permits(s.rows, s.before.authority, s.after.selection),
    )
    return z3.Implies(s.after.at("EchoSelection"), latched)


def _echo_while_it_stands(s: FplcScan) -> z3.BoolRef:
    """EKS-2-20, E-15, E-16, E-21: or the mode was switched, and no other selection may follow"""
    over = z3.And(s.before.at("Complete"), s.after.at("Complete"))
    stands = z3.And(
        s.before.at("EchoSelection", *ECHOING),
        s.after.selection == s.before.selection,
        z3.Or(code("SE", s.before.selection) == s.MW03, over),
    )
    return z3.Implies(s.after.at(*ECHOING), stands)


def _goes_on_while_signalled(s: FplcScan) -> z3.BoolRef:
    """EKS-3-1-FPLC, EKS-3-4-FPLC, E-28, E-41"""
    stands = z3.And(s.LA, signals(s.outputs, s.before.accepted))
    return z3.Implies(s.after.at(*OFFERING, *ECHOING), z3.And(stands, s.before.at("Authorize", *HOLDING)))


def _switches_on_a_pair(s: FplcScan) -> z3.BoolRef:
    """EKS-2-28, EKS-2-29, EKS-SD-2, E-16, E-42"""
    mode = s.before.selection
    pair = z3.And(code("SE", mode) == s.MW03, code("SW", mode) == s.MW07)
    signalled = z3.And(s.LA, signals(s.outputs, s.before.accepted))
    steps = z3.And(s.before.at("Switch"), s.after.at("Complete", "Settle"), s.after.mode == mode)
    return z3.Implies(s.switches, z3.And(steps, pair, signalled))


def _mode_stays(s: FplcScan) -> z3.BoolRef:
    """EKS-8-8, EKS-SD-7, E-24"""
    dropped = z3.And(s.after.at("Error"), z3.Not(s.holds), s.after.mode == -1)
    return z3.Implies(z3.Not(s.switches), z3.Or(s.after.mode == s.before.mode, dropped))


def _forgets_without_a_key(s: FplcScan) -> z3.BoolRef:
    """EKS-8-6, EKS-3-4-FPLC, E-17, E-22"""
    keyless = (*UNKEYED, "PulseOnes", "PulseZeros", "OneOutput")
    chosen = ("EchoSelection", *ECHOING)
    nobody = z3.And(s.after.accepted == -1, s.after.authority == -1)
    kept = z3.And(s.after.accepted == s.before.accepted, s.after.authority == s.before.authority)
    nothing, as_before = s.after.selection == -1, s.after.selection == s.before.selection
    return z3.And(
        z3.Implies(s.after.at(*keyless), z3.Or(nobody, z3.And(s.before.at(*keyless), kept))),
        z3.Implies(s.after.at("Authorize"), s.after.authority == -1),
        z3.Or(s.after.at(*chosen), nothing, z3.And(z3.Not(s.before.at(*chosen)), as_before)),
    )


def _refuses_only_wrong_words(s: FplcScan) -> z3.BoolRef:
    """EKS-2-19, EKS-2-27, E-15, E-54, E-61, E-65: which words lead to Error while the accepted output stands;
    what leads there from Settle is no word but its deadline
    """
    early = z3.And(s.before.at("Authorize"), z3.Or(s.MW03 != 0, s.MW07 != 0))
    unasked = z3.And(s.before.at(*OFFERING), s.MW07 != 0)
    within = [
        z3.And(code("SE", level) == s.MW03, permits(s.rows, s.before.authority, level)) for level in LEVELS
    ]
    not_permitted = z3.And(s.before.at("CheckSelection"), s.MW03 != 0, z3.Not(z3.Or(*within)))
    unmatched = z3.And(
        s.before.at("CheckAcknowledgment", "Match", "Switch"),
        s.MW07 != 0,
        code("SW", s.before.selection) != s.MW07,
    )
    codes = [code("SE", level) == s.MW03 for level in LEVELS]
    no_code = z3.And(s.before.at("EchoSelection", *ECHOING), s.MW03 != 0, z3.Not(z3.Or(*codes)))
    stands = z3.And(s.LA, signals(s.outputs, s.before.accepted))
    refused = z3.And(s.before.at("Authorize", *OFFERING, *ECHOING), stands, s.after.at("Error"))
    return z3.Implies(refused, z3.Or(early, unasked, not_permitted, unmatched, no_code))


# ---------------------------------------------------------------- the panel


def hmi_row(h: Hmi, rows: tuple[tuple[z3.BoolRef, ...], ...]) -> z3.BoolRef:
    """The words and the screen are the row of the state. EKS-2-14, EKS-2-15, EKS-2-22, EKS-2-24, EKS-8-9"""
    return z3.And(
        h.SelectMSO == z3.If(h.at(*PENDING), code("SE", h.selection), code("SE", -1)),
        h.SwitchMSO == z3.If(h.at("AwaitSwitch"), code("SW", h.selection), code("SW", -1)),
        h.shown == z3.If(h.at("Confirm"), h.selection, -1),
        *[h.enabled[mode] == z3.And(h.at("Select"), permits(rows, h.offered, mode)) for mode in LEVELS],
    )


def _shows_its_row(s: HmiScan) -> z3.BoolRef:
    return z3.And(hmi_row(s.after, s.rows), s.after.active == s.ActiveMSO)


def _open_at_a_level(s: HmiScan) -> z3.BoolRef:
    """EKS-3-1-HMI, EKS-3-4-HMI, EKS-9-4-HMI, E-46, E-55"""
    opened = z3.And(s.before.at("Inhibited"), s.after.at("Select"))
    kept = z3.And(z3.Not(s.before.at("Inhibited")), s.after.offered == s.before.offered)
    level = z3.And(is_mode(s.after.offered), s.ReadAuthorization == code("RE", s.after.offered))
    open_ = z3.And(level, z3.Or(opened, kept))
    return z3.Implies(z3.Not(s.after.at("Inhibited")), open_)


def _closes_for_a_reason(s: HmiScan) -> z3.BoolRef:
    """EKS-3-4-HMI, EKS-8-8, E-55, E-60"""
    level = z3.And(is_mode(s.before.offered), s.ReadAuthorization == code("RE", s.before.offered))
    unasked = z3.And(s.before.at("Select"), s.CheckMSO != 0)
    return z3.Implies(s.after.at("Inhibited"), z3.Or(s.before.at("Inhibited"), z3.Not(level), unasked))


def _selects_by_a_touch(s: HmiScan) -> z3.BoolRef:
    """EKS-2-14, EKS-2-15, E-20: begun by the touch of an offered mode; until the echo it waits"""
    mode = s.after.selection
    touched = z3.And(
        s.before.at("Select"),
        s.CheckMSO == 0,
        s.selects(mode),
        is_mode(mode),
        permits(s.rows, s.before.offered, mode),
    )
    waits = z3.And(s.before.at("AwaitEcho"), s.CheckMSO == 0, mode == s.before.selection)
    return z3.Implies(s.after.at("AwaitEcho"), z3.Or(touched, waits))


def _asks_by_the_echo(s: HmiScan) -> z3.BoolRef:
    """EKS-2-22, E-19, E-20"""
    same = z3.And(
        s.before.at("AwaitEcho", "Confirm"),
        s.after.selection == s.before.selection,
        s.CheckMSO == code("CH", s.before.selection),
    )
    return z3.Implies(s.after.at("Confirm"), same)


def _acknowledges_by_a_touch(s: HmiScan) -> z3.BoolRef:
    """EKS-2-23, EKS-2-24, EKS-SD-5"""
    same = z3.And(s.after.selection == s.before.selection, s.CheckMSO == code("CH", s.before.selection))
    begins = z3.And(s.before.at("Confirm"), s.touches("confirm"))
    return z3.Implies(s.after.at("AwaitSwitch"), z3.And(same, z3.Or(begins, s.before.at("AwaitSwitch"))))


def _gives_up_for_a_reason(s: HmiScan) -> z3.BoolRef:
    """EKS-2-25, E-20, E-21, E-53"""
    echoed = s.CheckMSO == code("CH", s.before.selection)
    other = z3.And(s.CheckMSO != 0, z3.Not(echoed))
    reason = z3.Or(
        z3.And(s.before.at("AwaitEcho", "AwaitSwitch"), other),
        z3.And(s.before.at("Confirm"), z3.Or(z3.Not(echoed), s.touches("reject"))),
        z3.And(s.before.at("Withdrawn"), s.CheckMSO != 0),
    )
    return z3.Implies(s.after.at("Withdrawn"), reason)


def _forgets_when_over(s: HmiScan) -> z3.BoolRef:
    """EKS-8-9, EKS-8-16, EKS-2-25, E-21"""
    nothing, as_before = s.after.selection == -1, s.after.selection == s.before.selection
    return z3.Or(s.after.at(*PENDING), nothing, z3.And(z3.Not(s.before.at(*PENDING)), as_before))


def _offers_without_echo(s: HmiScan) -> z3.BoolRef:
    """EKS-2-14, E-15, E-57"""
    return z3.Implies(
        s.after.at("Select"),
        z3.And(s.before.at("Inhibited", "Select", "AwaitSwitch", "Withdrawn"), s.CheckMSO == 0),
    )


# ---------------------------------------------------------------- PLC and EKS


def _copies_or_keeps(s: PlcScan) -> z3.BoolRef:
    """EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26: any of the four copies, in any order"""
    pairs = (
        (s.before.ReadAuthorization, s.after.ReadAuthorization, s.MW01),
        (s.before.MW03, s.after.MW03, s.SelectMSO),
        (s.before.CheckMSO, s.after.CheckMSO, s.MW05),
        (s.before.MW07, s.after.MW07, s.SwitchMSO),
    )
    return z3.And(*[z3.Or(new == old, new == source) for old, new, source in pairs])


def _signals_the_level_read(s: EksScan) -> z3.BoolRef:
    """EKS-2-7, EKS-2-10, EKS-KS-5, EKS-T2: with LA, one output alone is that of the level on the key"""
    signalled = [
        z3.Implies(signals(s.after.outputs, level), s.after.level == code("RE", level)) for level in LEVELS
    ]
    return z3.Implies(s.after.LA, z3.And(*signalled))


def _several_outputs_in_the_pulse(s: EksScan) -> z3.BoolRef:
    """EKS-KS-5, EKS-2-10"""
    signalled = z3.Or(*[signals(s.after.outputs, level) for level in range(-1, 5)])
    return z3.Or(s.after.at("TestOnes"), signalled)


def _no_output_without_la(s: EksScan) -> z3.BoolRef:
    """EKS-2-3, EKS-2-9, EKS-8-5, EKS-SD-2"""
    return z3.Or(s.after.LA, s.after.at("ClearOutputs"), none_of(s.after.outputs))


def _off_by_state(s: EksScan) -> z3.BoolRef:
    """EKS-2-5, EKS-8-2, EKS-8-5"""
    by_state = s.after.at("StartTest", "TestOnes", "TestZeros", "Signal") == s.after.LA
    outputs = z3.Or(s.after.at("TestOnes", "Signal", "ClearOutputs"), none_of(s.after.outputs))
    clears = z3.Implies(s.after.at("ClearOutputs"), s.before.at("Signal"))
    return z3.And(by_state, outputs, clears)


FPLC_THEOREM: Final = "every_scan_of_the_fplc_keeps_its_guarantees"
HMI_THEOREM: Final = "every_scan_of_the_panel_keeps_its_guarantees"
PLC_THEOREM: Final = "every_scan_of_the_plc_keeps_its_guarantees"
EKS_THEOREM: Final = "every_scan_of_the_eks_keeps_its_guarantees"

GUARANTEES: Final = (
    Guarantee("the F-PLC writes the row of its state", FPLC, _writes_its_row, FPLC_THEOREM),
    Guarantee("the F-PLC waits for a key only over zeros", FPLC, _zeros_before_a_key, FPLC_THEOREM),
    Guarantee("the F-PLC offers after a key or over zeros", FPLC, _offer_after_key_or_zeros, FPLC_THEOREM),
    Guarantee("the F-PLC accepts one output", FPLC, _accepts_one_output, FPLC_THEOREM),
    Guarantee("the F-PLC keeps one authority", FPLC, _one_authority, FPLC_THEOREM),
    Guarantee("the F-PLC latches MW03", FPLC, _latched_from_mw03, FPLC_THEOREM),
    Guarantee("the F-PLC echoes while MW03 stands", FPLC, _echo_while_it_stands, FPLC_THEOREM),
    Guarantee("the F-PLC goes on while signalled", FPLC, _goes_on_while_signalled, FPLC_THEOREM),
    Guarantee("the F-PLC switches on a pair", FPLC, _switches_on_a_pair, FPLC_THEOREM),
    Guarantee("the F-PLC keeps the mode", FPLC, _mode_stays, FPLC_THEOREM),
    Guarantee("the F-PLC forgets without a key", FPLC, _forgets_without_a_key, FPLC_THEOREM),
    Guarantee("the F-PLC refuses only wrong words", FPLC, _refuses_only_wrong_words, FPLC_THEOREM),
    Guarantee("the panel shows the row of its state", HMI, _shows_its_row, HMI_THEOREM),
    Guarantee("the panel is open at one level", HMI, _open_at_a_level, HMI_THEOREM),
    Guarantee("the panel closes for a reason", HMI, _closes_for_a_reason, HMI_THEOREM),
    Guarantee("the panel offers without an echo", HMI, _offers_without_echo, HMI_THEOREM),
    Guarantee("the panel selects by a touch", HMI, _selects_by_a_touch, HMI_THEOREM),
    Guarantee("the panel asks by the echo", HMI, _asks_by_the_echo, HMI_THEOREM),
    Guarantee("the panel acknowledges by a touch", HMI, _acknowledges_by_a_touch, HMI_THEOREM),
    Guarantee("the panel gives up for a reason", HMI, _gives_up_for_a_reason, HMI_THEOREM),
    Guarantee("the panel forgets when it is over", HMI, _forgets_when_over, HMI_THEOREM),
    Guarantee("the PLC copies or keeps", PLC, _copies_or_keeps, PLC_THEOREM),
    Guarantee("the EKS signals the level read", EKS, _signals_the_level_read, EKS_THEOREM),
    Guarantee("the EKS sets several outputs in its pulse", EKS, _several_outputs_in_the_pulse, EKS_THEOREM),
    Guarantee("the EKS sets no output without LA", EKS, _no_output_without_la, EKS_THEOREM),
    Guarantee("the EKS is off by its state", EKS, _off_by_state, EKS_THEOREM),
)


def _keeps_its_guarantees(device: Device) -> Queries:
    """For each control state and guarantee: no path of the shipped `step` breaks it.

    What is true as soon as the ends of the paths are put in is not asked, unless nothing else is to be asked.
    """
    pairs = [(ends, guarantee) for ends in ends_of(device) for guarantee in guarantees_of(device)]
    asked = [(ends, guarantee, ends.always(guarantee.of)) for ends, guarantee in pairs]
    asked = [(ends, guarantee, then) for ends, guarantee, then in asked if not z3.is_true(then)]
    for ends, guarantee, then in asked or [
        (ends, guarantee, ends.always(guarantee.of, whole=True)) for ends, guarantee in pairs
    ]:
        given = {"all in their ranges": ends.scan.premise}
        yield from claim(f"{ends.scan.control.value}: {guarantee.name}", given, then, LOGIC)


def guarantees_of(device: Device) -> tuple[Guarantee, ...]:
    """The guarantees of one device."""
    return tuple(guarantee for guarantee in GUARANTEES if guarantee.device is device)


@theorem(
    clauses=["EKS-2-12", "EKS-2-17", "EKS-2-18", "EKS-2-20", "EKS-2-28", "EKS-2-29", "EKS-8-12", "EKS-8-18"],
    findings=["E-15", "E-16", "E-18", "E-23", "E-24", "E-42", "E-52"],
    slow=True,
)
def every_scan_of_the_fplc_keeps_its_guarantees() -> Queries:
    """In any scan, whatever its memory, inputs, times and parameters: the F-PLC leaves the states without a
    key for Idle only over zeros and after the dwell time; it offers a selection only to an accepted key or
    over zeros; it latches what stands in MW03 and is permitted, echoes it while it stands, or as the one
    selection of its insertion, and switches to it only with LA, the accepted output alone, and its pair in
    MW03 and MW07; the mode stays otherwise; and it refuses only the words that are listed.

    Each is a formula of its own, which the theorems on all devices together assume by name.
    """
    yield from _keeps_its_guarantees(FPLC)


@theorem(
    clauses=["EKS-2-14", "EKS-2-15", "EKS-2-22", "EKS-2-23", "EKS-2-24", "EKS-2-25", "EKS-8-8", "EKS-8-9"],
    findings=["E-19", "E-20", "E-21", "E-46", "E-55", "E-57"],
)
def every_scan_of_the_panel_keeps_its_guarantees() -> Queries:
    """In any scan, whatever its memory, inputs and permissions: the panel is open only at the level it was
    opened with, closes only for a reason, begins a selection only by the touch of an offered mode, asks only
    by the echo of that mode, acknowledges only by a touch of the confirmation while that echo stands, and
    gives up only for a reason.
    """
    yield from _keeps_its_guarantees(HMI)


@theorem(clauses=["EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26"], findings=["E-08"])
def every_scan_of_the_plc_keeps_its_guarantees() -> Queries:
    """In any scan each word that the PLC writes is unchanged or what its source shows in that scan."""
    yield from _keeps_its_guarantees(PLC)


@theorem(clauses=["EKS-2-7", "EKS-2-10", "EKS-8-5", "EKS-KS-5", "EKS-T2"], findings=["E-02"])
def every_scan_of_the_eks_keeps_its_guarantees() -> Queries:
    """After any scan of the EKS, whatever its memory and its reader hold: if LA is on and one output alone is
    set, it is the output of the level on the key that was read; several outputs are set in the test pulse
    only; without LA none is, but for the one scan before the outputs are cleared; and its state says whether
    LA and outputs are on.
    """
    yield from _keeps_its_guarantees(EKS)

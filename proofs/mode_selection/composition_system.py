"""All devices and the user at one moment, the steps that lead to the next, and what is taken for granted.

One step is one scan of one device, or the user putting in a key, as in refimpl's `key_flows` and in KeyFlows:
any order, any number of times. What the devices do in a scan is not in here: that are their guarantees.
Taking a key out changes nothing but the reader, which the EKS alone sees; whatever it then does is allowed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any, Final

import z3

from proofs.explorer.device import Device
from proofs.mode_selection import composition_views as views
from proofs.mode_selection.composition_guarantees import ECHOING, OFFERING, UNKEYED
from proofs.mode_selection.composition_views import (
    Eks,
    EksScan,
    Fplc,
    FplcScan,
    Hmi,
    HmiScan,
    Mode,
    Plc,
    PlcScan,
    permissions_fit,
)
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC

STEPS: Final = ("insert", "eks", "fplc", "plc", "hmi")
"""Who acts; `insert` is the user."""


@dataclass(frozen=True)
class History:
    """What the user did and saw since the key went in, each -1 for nothing; only user and panel set it.

    carried: the mode that the display wire holds out to the panel. come: how far the mode outputs have come
    since they last changed: 0, 1 the wire, 2 the panel (KeyFlowsDisplay).

    unseen: a key was put in while a selection of the key before was going on, which goes on still. low: the
    F-PLC has scanned while neither LA nor an output of the EKS was on, and LA has not come since.
    """

    touched: Mode
    seen: Mode
    confirmed: Mode
    carried: Mode
    come: Mode
    unseen: z3.BoolRef
    low: z3.BoolRef


@dataclass(frozen=True)
class System:
    """Every device with what it last wrote, and the user's history."""

    fplc: Fplc
    hmi: Hmi
    plc: Plc
    eks: Eks
    history: History


@dataclass(frozen=True)
class Step:
    """One step of one actor, with what the actor reads."""

    actor: str
    before: System
    after: System
    fplc: FplcScan
    hmi: HmiScan
    plc: PlcScan
    eks: EksScan

    @property
    def scan(self) -> Any:
        """The scan of the device that acts; None for the user."""
        return {"fplc": self.fplc, "hmi": self.hmi, "plc": self.plc, "eks": self.eks}.get(self.actor)


def _system(when: str) -> System:
    touched, seen, confirmed, carried, come = (
        views.small(f"{name}{when}")
        for name in ("user.touched", "user.seen", "user.confirmed", "display.carried", "display.come")
    )
    unseen, low = z3.Bool(f"user.unseen{when}"), z3.Bool(f"fplc.low{when}")
    history = History(touched, seen, confirmed, carried, come, unseen, low)
    return System(
        views.fplc_symbols(when),
        views.hmi_symbols(when),
        views.plc_symbols(when),
        views.eks_symbols(when),
        history,
    )


NOW: Final = _system("")
NEXT: Final = _system(" next")
ROWS: Final = views.permission_symbols()
HOLDS: Final = z3.Bool("fplc.holds_mode_on_error")
"""ON_ERROR is "hold" (E-24)."""


def _after(actor: str) -> System:
    """Who does not act keeps memory and words."""
    parts = {name: getattr(NEXT if name == actor else NOW, name) for name in ("fplc", "hmi", "plc", "eks")}
    return System(**parts, history=NEXT.history)


def _step(actor: str) -> Step:
    after = _after(actor)
    fplc = FplcScan(
        NOW.fplc,
        after.fplc,
        z3.Bool("fplc reads LA"),
        views.flags("fplc reads output"),
        views.word("fplc reads MW03"),
        views.word("fplc reads MW07"),
        z3.Bool("fplc has dwelt"),
        z3.Bool("fplc switches"),
        HOLDS,
        ROWS,
    )
    hmi = HmiScan(
        NOW.hmi,
        after.hmi,
        views.word("hmi reads ReadAuthorization"),
        views.word("hmi reads CheckMSO"),
        views.small("hmi reads ActiveMSO"),
        views.small("hmi touch"),
        ROWS,
    )
    words = [views.word(f"plc reads {name}") for name in ("MW01", "MW05", "SelectMSO", "SwitchMSO")]
    plc = PlcScan(NOW.plc, after.plc, *words)
    return Step(actor, NOW, after, fplc, hmi, plc, EksScan(NOW.eks, after.eks))


STEP: Final[Mapping[str, Step]] = {actor: _step(actor) for actor in STEPS}

# ---------------------------------------------------------------- what a step leaves alone, and the user


def same(first: Any, second: Any) -> z3.BoolRef:
    """Two records of terms are equal, field by field; the second may come from the code, with integers."""
    equal: list[z3.BoolRef] = []
    for field in fields(first):
        left, right = getattr(first, field.name), getattr(second, field.name)
        pairs = zip(left, right, strict=True) if isinstance(left, tuple) else [(left, right)]
        equal += [a == (b.as_long() if z3.is_int_value(b) else b) for a, b in pairs]
    return z3.And(*equal)


def states_are_states(system: System) -> z3.BoolRef:
    """Each control state is one of its module's Step; that is how the records are made."""
    counted: list[tuple[Any, Device]] = [(system.fplc, FPLC), (system.hmi, HMI), (system.eks, EKS)]
    return z3.And(*[z3.And(seen.state >= 0, seen.state < len(by.module.Step)) for seen, by in counted])


def wire_kept(step: Step) -> z3.BoolRef:
    """The display wire holds out what it did, or has carried the mode outputs; the panel has scanned.

    EKS-8-8, E-25
    """
    old, new = step.before.history, step.after.history
    scanned = z3.If(old.come == 1, 2, old.come) if step.actor == "hmi" else old.come
    come = z3.If(step.before.fplc.mode == step.after.fplc.mode, scanned, 0)
    kept = z3.And(new.carried == old.carried, new.come == come)
    return z3.Or(kept, new.come == z3.If(come == 0, 1, come))


def history_kept(step: Step) -> z3.BoolRef:
    """What the user did and saw, as KeyFlows records it, from touches and screens alone; the display wire.

    EKS-2-1, EKS-2-14, EKS-2-22, EKS-2-23
    """
    return z3.And(_user_kept(step), wire_kept(step))


def _user_kept(step: Step) -> z3.BoolRef:
    old, new, now = step.before.history, step.after.history, step.before
    kept = z3.And(*[getattr(new, name) == getattr(old, name) for name in ("touched", "seen", "confirmed")])
    if step.actor == "plc":
        return z3.And(kept, new.unseen == old.unseen, new.low == old.low)
    if step.actor == "insert":
        none = [mode == -1 for mode in (new.touched, new.seen, new.confirmed)]
        going_on = now.fplc.at(*OFFERING, *ECHOING)
        return z3.And(*none, new.unseen == z3.Or(old.unseen, going_on), new.low == old.low)
    if step.actor == "eks":
        rises = z3.And(z3.Not(step.eks.before.LA), step.eks.after.LA)
        return z3.And(kept, new.unseen == old.unseen, new.low == z3.And(old.low, z3.Not(rises)))
    if step.actor == "fplc":
        still = step.after.fplc.at(*OFFERING, *ECHOING)
        low = z3.And(z3.Not(now.eks.LA), views.none_of(now.eks.outputs))
        return z3.And(kept, new.unseen == z3.And(old.unseen, still), new.low == low)
    scan = step.hmi
    begins = z3.And(scan.before.at("Select"), scan.after.at("AwaitEcho"))
    nothing = z3.And(new.touched == -1, *[z3.Not(scan.selects(mode)) for mode in views.LEVELS])
    touched = z3.Or(scan.selects(new.touched), nothing)
    shows = z3.And(scan.after.at("Confirm"), scan.after.shown == old.touched, old.touched != -1)
    confirms = z3.And(scan.before.at("Confirm"), scan.after.at("AwaitSwitch"), scan.touches("confirm"))
    return z3.And(
        z3.If(begins, touched, new.touched == old.touched),
        new.seen == z3.If(begins, -1, z3.If(shows, old.touched, old.seen)),
        new.confirmed == z3.If(begins, -1, z3.If(confirms, old.seen, old.confirmed)),
        new.unseen == old.unseen,
        new.low == old.low,
    )


def power_up() -> z3.BoolRef:
    """All devices just switched on, nothing touched: `power_up` and `outputs` of the shipped code. A-19"""
    history = [mode == -1 for mode in (NOW.history.touched, NOW.history.seen, NOW.history.confirmed)]
    return z3.And(
        same(NOW.fplc, views.first_view(FPLC)),
        same(NOW.hmi, views.first_view(HMI)),
        same(NOW.plc, views.first_view(PLC)),
        same(NOW.eks, views.first_view(EKS)),
        *history,
        NOW.history.carried == -1,
        NOW.history.come == 2,
        z3.Not(NOW.history.unseen),
        z3.Not(NOW.history.low),
    )


# ---------------------------------------------------------------- what is taken for granted


@dataclass(frozen=True)
class Assumption:
    """A named formula about a step that no device guarantees; assumptions.toml or findings.toml has it."""

    name: str
    register: tuple[str, ...]
    """Ids of assumptions, or of findings."""
    of: Callable[[Step], z3.BoolRef]
    actors: tuple[str, ...]
    """Whose steps it is about."""


def _words_are_wired(step: Step) -> z3.BoolRef:
    """A-21, A-25: each reader sees what the one writer of the word last wrote."""
    now = step.before
    if step.actor == "fplc":
        return z3.And(step.fplc.MW03 == now.plc.MW03, step.fplc.MW07 == now.plc.MW07)
    if step.actor == "plc":
        seen = step.plc
        from_fplc = z3.And(seen.MW01 == now.fplc.MW01, seen.MW05 == now.fplc.MW05)
        return z3.And(from_fplc, seen.SelectMSO == now.hmi.SelectMSO, seen.SwitchMSO == now.hmi.SwitchMSO)
    read = step.hmi
    level = read.ReadAuthorization == now.plc.ReadAuthorization
    return z3.And(level, read.CheckMSO == now.plc.CheckMSO)


def _display_is_wired(step: Step) -> z3.BoolRef:
    """A-33: the display wire carries the mode whose output is set, and the panel reads what it holds out."""
    old, new, now = step.before.history, step.after.history, step.after.fplc.mode
    mode_stays = step.before.fplc.mode == now
    nothing_sent = z3.And(new.carried == old.carried, z3.Or(new.come == 0, z3.And(mode_stays, old.come > 0)))
    told = z3.Or(nothing_sent, new.carried == now)
    return z3.And(told, step.hmi.ActiveMSO == old.carried) if step.actor == "hmi" else told


def _outputs_are_wired(step: Step) -> z3.BoolRef:
    """A-20: LA and the five outputs, none crossed, none broken."""
    seen, sent = step.fplc, step.before.eks
    pairs = zip(seen.outputs, sent.outputs, strict=True)
    return z3.And(seen.LA == sent.LA, *[left == other for left, other in pairs])


def _words_arrive(step: Step) -> z3.BoolRef:
    """A-06: when the dwell time is over, F-PLC's words stand on the bus and the panel has begun to react."""
    now = step.before
    waits = z3.And(now.fplc.at("Start", "Settle", "AwaitZeros", "Error"), step.fplc.dwelt)
    words = z3.And(now.plc.ReadAuthorization == now.fplc.MW01, now.plc.CheckMSO == now.fplc.MW05)
    return z3.Implies(waits, z3.And(words, z3.Or(now.hmi.at("Inhibited"), now.fplc.MW01 != 0)))


def _key_goes_in_without_la(step: Step) -> z3.BoolRef:
    """A-07: the EKS has seen the reader empty before the next key goes in."""
    return z3.Not(step.before.eks.LA)


def _removal_is_noticed(step: Step) -> z3.BoolRef:
    """A-07: LA does not come again before the F-PLC has seen it low."""
    rises = z3.And(z3.Not(step.eks.before.LA), step.eks.after.LA)
    return z3.Implies(rises, step.before.fplc.at(*UNKEYED))


def _one_wire_is_broken(step: Step) -> z3.BoolRef:
    """EKS-KS-6, EKS-SD-10: of LA, the outputs and their wires at most one is wrong in a scan, another one
    maybe in the next; or the pulse is missing. None are crossed (A-20).
    """
    seen, sent = step.fplc, step.before.eks
    equal = [left == other for left, other in zip(seen.outputs, sent.outputs, strict=True)]
    but_one = [z3.And(*equal[:left_out], *equal[left_out + 1 :]) for left_out in views.LEVELS]
    no_pulse = z3.And(sent.at("TestOnes"), views.none_of(seen.outputs))
    return z3.Or(z3.And(*equal), z3.And(seen.LA == sent.LA, z3.Or(*but_one, no_pulse)))


def _key_goes_in_when_cleared(step: Step) -> z3.BoolRef:
    """A-07: the EKS has seen the reader empty, and cleared its outputs, before the next key goes in."""
    return z3.And(z3.Not(step.before.eks.LA), views.none_of(step.before.eks.outputs))


def _removal_is_noticed_or_low(step: Step) -> z3.BoolRef:
    """A-07 where LA is not seen to be low: the F-PLC has scanned while LA and the outputs were off."""
    rises = z3.And(z3.Not(step.eks.before.LA), step.eks.after.LA)
    noticed = z3.Or(step.before.fplc.at(*UNKEYED), step.before.history.low)
    return z3.Implies(rises, noticed)


def _mode_is_held(step: Step) -> z3.BoolRef:
    """E-24: with ON_ERROR = hold."""
    return HOLDS


def _same_permissions(step: Step) -> z3.BoolRef:
    """E-47, EKS-T2-2: no level permits a mode above it, and each its own."""
    return permissions_fit(ROWS)


ASSUMPTIONS: Final = (
    Assumption("words are wired", ("A-01", "A-21", "A-25"), _words_are_wired, ("fplc", "plc", "hmi")),
    Assumption("the display is wired", ("A-33",), _display_is_wired, STEPS),
    Assumption("outputs are wired", ("A-20",), _outputs_are_wired, ("fplc",)),
    Assumption("words arrive within the dwell time", ("A-06",), _words_arrive, ("fplc",)),
    Assumption("a key goes in without LA", ("A-07",), _key_goes_in_without_la, ("insert",)),
    Assumption("a removal is noticed before LA comes again", ("A-07",), _removal_is_noticed, ("eks",)),
    Assumption("one wire is broken", ("A-20", "A-32"), _one_wire_is_broken, ("fplc",)),
    Assumption("a key goes in when all is cleared", ("A-07",), _key_goes_in_when_cleared, ("insert",)),
    Assumption("the F-PLC scanned while LA was low", ("A-07",), _removal_is_noticed_or_low, ("eks",)),
    Assumption("the error mode holds the mode", ("E-24",), _mode_is_held, ("fplc",)),
    Assumption("levels are ordered", ("A-03", "E-47"), _same_permissions, STEPS),
)

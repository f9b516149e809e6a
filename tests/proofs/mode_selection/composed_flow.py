"""The shipped devices in any order of scans, on a machine that keeps A-06 and A-07, for tests.

The wires are those of refimpl's key_flows. The history of the user is as in KeyFlows. Each moment
can be turned into the records of the composition argument, so that its formulas are judged on real states.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import z3

from proofs.mode_selection import composition_system as system
from proofs.mode_selection import composition_views as views
from proofs.mode_selection.composition_guarantees import ECHOING, OFFERING, UNKEYED
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from refimpl.mode_selection import eks, fplc, hmi, key_flows
from refimpl.mode_selection.code_tables import NONE, RE

CHECKSUM = 1
WHOLE: Final[Mapping[str, bool]] = MappingProxyType({})
"""No wire is broken."""
OFF = eks.Outputs(False, False, False, False, False, False)
DWELLING = ("Start", "Settle", "AwaitZeros", "Error")
ACTORS = ("eks", "fplc", "plc", "hmi", "insert", "remove", "touch")


def key(level: int) -> eks.KeyMemory:
    """A good key of the level; its number is the level."""
    return eks.written_key(6, RE[level], 1, level, lambda data: CHECKSUM)


@dataclass(frozen=True)
class Moment:
    """All devices, the user's history, and whether the last scan switched."""

    flow: key_flows.System
    touched: int = NONE
    seen: int = NONE
    confirmed: int = NONE
    unseen: bool = False
    low: bool = False
    switched: bool = False
    come: int = 2
    """How far the mode outputs have come; the display wire of a flow takes no time."""


def beginning(selections: str = "again", **times: int) -> Moment:
    """Power-up, in the profile cautious unless other selections or times are given."""
    dwell = times.pop("T_DWELL_ms", 500)
    params = fplc.Params(T_SEQ_FROM="LA", T_DWELL_ms=dwell, SELECTIONS=selections, **times)
    return Moment(key_flows.power_up(eks.Params(lambda data: CHECKSUM), params))


def in_selection(moment: Moment) -> bool:
    """The F-PLC is between the level and the switchover."""
    return moment.flow.fplc_state.state.value in (*OFFERING, *ECHOING)


# ---------------------------------------------------------------- steps


def insert(moment: Moment, level: int) -> Moment:
    """A key goes in; what was touched before counts no more."""
    flow = key_flows.insert_key(moment.flow, key(level))
    return Moment(flow, unseen=moment.unseen or in_selection(moment), low=moment.low, come=moment.come)


def remove(moment: Moment) -> Moment:
    """The key is taken out."""
    return replace(moment, flow=key_flows.remove_key(moment.flow), switched=False)


def touch(moment: Moment, field: str) -> Moment:
    """A field is touched; it counts in the panel's next scan."""
    return replace(moment, flow=key_flows.touch(moment.flow, field), switched=False)


def scan(moment: Moment, device: str, dt_ms: int = 0, wires: Mapping[str, bool] = WHOLE) -> Moment:
    """One scan of a device, and what the user sees of it. wires: what the F-PLC sees on broken ones."""
    before, after = moment.flow, key_flows.scan(moment.flow, device, dt_ms)
    if wires:
        read = replace(key_flows.fplc_inputs(before, dt_ms), **wires)  # type: ignore[arg-type]
        state, out = fplc.step(before.fplc_state, read)
        after = replace(before, fplc_state=state, fplc_out=out)
    made = replace(moment, flow=after, switched=False)
    if device == "fplc":
        here = before.fplc_state
        switched = (
            here.state == fplc.Step.SWITCH
            and after.fplc_state.state in (fplc.Step.SETTLE, fplc.Step.COMPLETE)
            and fplc.matches(before.plc_out.MW03, before.plc_out.MW07)
        )
        unseen = moment.unseen and in_selection(made)
        come = moment.come if after.fplc_state.mode == here.mode else 1
        return replace(made, switched=switched, unseen=unseen, low=before.eks_out == OFF, come=come)
    if device == "eks":
        return replace(made, low=moment.low and not after.eks_out.LA)
    if device != "hmi":
        return made
    made = replace(made, come=2)
    old, new = before.hmi_state.state, after.hmi_state.state
    if old == hmi.Step.SELECT and new == hmi.Step.AWAIT_ECHO:
        return replace(made, touched=int(before.touch[-1]), seen=NONE, confirmed=NONE)
    if new == hmi.Step.CONFIRM and after.hmi_out.shown == moment.touched:
        return replace(made, seen=moment.touched)
    if old == hmi.Step.CONFIRM and new == hmi.Step.AWAIT_SWITCH and before.touch == "confirm":
        return replace(made, confirmed=moment.seen)
    return made


def arrived(moment: Moment) -> bool:
    """A-06: what the F-PLC wrote has reached the panel, which has begun to react."""
    f, p = moment.flow.fplc_out, moment.flow.plc_out
    inhibited = moment.flow.hmi_state.state == hmi.Step.INHIBITED
    return p.ReadAuthorization == f.MW01 and p.CheckMSO == f.MW05 and (inhibited or f.MW01 != 0)


def allowed(moment: Moment, actor: str, dt_ms: int) -> bool:
    """A-06 and A-07 let this step happen now."""
    flow = moment.flow
    if actor == "insert":
        return flow.key is None and flow.eks_out == OFF
    if actor == "eks":
        rises = key_flows.scan_eks(flow, dt_ms).eks_out.LA and not flow.eks_out.LA
        return not rises or flow.fplc_state.state.value in UNKEYED or moment.low
    if actor == "fplc" and flow.fplc_state.state.value in DWELLING:
        dwelt = flow.fplc_state.elapsed_ms + dt_ms >= flow.fplc_state.params.T_DWELL_ms
        return not dwelt or arrived(moment)
    return True


def random_step(moment: Moment, rng: random.Random) -> tuple[str, int, Moment]:
    """Some step that A-06 and A-07 allow: the actor, the time, and the moment after it."""
    while True:
        actor = rng.choices(ACTORS, weights=(3, 5, 8, 5, 1, 0.1, 2))[0]
        dt_ms = rng.choice((0, 0, 100, 250, 500))
        if not allowed(moment, actor, dt_ms):
            continue
        if actor == "insert":
            return actor, 0, insert(moment, rng.choice((0, 1, 4)))
        if actor == "remove":
            return actor, 0, remove(moment)
        if actor == "touch":
            fields = (*hmi.TOUCHES, "confirm", "confirm", "select:0")
            return actor, 0, touch(moment, rng.choice(fields))
        return actor, dt_ms, scan(moment, actor, dt_ms)


# ---------------------------------------------------------------- as records of terms


def as_system(moment: Moment) -> system.System:
    """The moment in the records of the composition argument."""
    flow = moment.flow
    return system.System(
        views.view_of(FPLC, flow.fplc_state, flow.fplc_out),
        views.view_of(HMI, flow.hmi_state, flow.hmi_out),
        views.view_of(PLC, flow.plc_state, flow.plc_out),
        views.view_of(EKS, flow.eks_state, flow.eks_out),
        system.History(
            *[z3.IntVal(one) for one in (moment.touched, moment.seen, moment.confirmed)],
            z3.IntVal(key_flows.active_mode(flow)),
            z3.IntVal(moment.come),
            z3.BoolVal(moment.unseen),
            z3.BoolVal(moment.low),
        ),
    )


TOTAL_ORDER = [
    (system.ROWS[level][mode], z3.BoolVal(mode <= level)) for level in range(5) for mode in range(5)
]


def is_true(formula: z3.BoolRef) -> bool:
    """The value of a formula without free symbols but the permissions, which are the total order."""
    value = z3.simplify(z3.substitute(formula, *TOTAL_ORDER))
    assert z3.is_true(value) or z3.is_false(value), value
    return z3.is_true(value)

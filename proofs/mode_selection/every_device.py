"""What every device promises alike: nothing before its first step."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

import z3

from proofs.explorer.scanned import Scanned
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.mode_selection.vocabulary import NONE, none_set, vector
from proofs.sentences import Always, Judge
from proofs.theorem import Queries, theorem


def _fplc(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    modes = none_set((o.MSO_0, o.MSO_1, o.MSO_2, o.MSO_3, o.MSO_4))
    nothing = z3.And(scan.after.mode == NONE, modes, o.MW01 == 0, o.MW05 == 0, z3.Not(o.ERROR))
    return nothing if scan.becomes("Start") else z3.BoolVal(False)


def _panel(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    return z3.And(
        o.SelectMSO == 0, o.SwitchMSO == 0, none_set(o.enabled), z3.BoolVal(scan.becomes("Inhibited"))
    )


def _plc(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    return z3.And(o.ReadAuthorization == 0, o.MW03 == 0, o.CheckMSO == 0, o.MW07 == 0)


def _eks(scan: Scanned, seen: Any) -> z3.BoolRef:
    return z3.And(z3.Not(scan.sends.LA), none_set(vector(scan.sends)))


SAFE: Final[Mapping[Any, Always]] = MappingProxyType(
    {FPLC.name: _fplc, HMI.name: _panel, PLC.name: _plc, EKS.name: _eks}
)


@theorem(
    clauses=["EKS-GP-5", "EKS-8-8", "EKS-8-9", "EKS-SD-2"], findings=["E-25c"], properties=["PowerUpIsSafe"]
)
def every_device_is_safe_from_the_first_moment() -> Queries:
    """After power-up and before its first step, with any parameters, each device sends zeros: no mode, no
    level, no echo, no acknowledgment, no LA and no error; and the panel is inhibited.
    """
    for device in (FPLC, HMI, PLC, EKS):
        yield from Judge(device, ()).at_power_up(SAFE[device.name])
    plc = Judge(PLC, ())
    yield plc.too_strong("and after every scan", plc.after_a_scan(_plc), "CopyMW03")

"""The invariant of the F-PLC is true at power-up, and every scan keeps it.

Initiation and consecution as separate plain queries; the properties that follow from it are in
fplc_safety.py.
"""

from __future__ import annotations

import z3

from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.explore import explore
from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.invariants import FPLC_INVARIANT, conjuncts
from proofs.mode_selection.observer import NOTHING, sees
from proofs.mode_selection.scanned import Property, Scanned, Scans, control, scans_of
from proofs.theorem import Queries, claim, theorem


def premises(scans: Scans, without: str = "") -> dict[str, z3.BoolRef]:
    """All values in their ranges, and the invariant of the state before the scan, conjunct by conjunct."""
    known = conjuncts(FPLC_INVARIANT, scans.device, scans.scan.state)
    return {
        "memory, inputs and parameters in their ranges": scans.scan.premise,
        **{f"before: {name}": formula for name, formula in known.items() if name != without},
    }


def kept(end: str = "") -> Property:
    """The invariant after a scan, or after one that leads to the control state `end`."""

    def after(one: Scanned) -> z3.BoolRef:
        if end and not one.becomes(end):
            return TRUE
        return z3.And(*conjuncts(FPLC_INVARIANT, one.device, one.result, sees(one)).values())

    return after


@theorem(clauses=["EKS-GP-5", "EKS-8-8"], findings=["E-25c"])
def the_invariant_of_the_fplc_is_true_at_power_up() -> Queries:
    """After power-up, with any parameters that the code accepts, the F-PLC is in a state of its invariant."""
    params = FPLC.params()
    found = explore(FPLC.module.power_up, (params,), FPLC.parameters_fit(params))
    (path,) = found.paths
    for name, formula in conjuncts(FPLC_INVARIANT, FPLC, path.result, NOTHING).items():
        yield from claim(name, {"parameters in their ranges": found.premise}, formula, LOGIC)


@theorem(clauses=["EKS-GP-3", "EKS-GP-4", "EKS-3-0", "EKS-9-0"], findings=["E-16", "E-18"], slow=True)
def every_scan_of_the_fplc_keeps_its_invariant() -> Queries:
    """From every state of the invariant, with any inputs and any elapsed time, every path of a scan of the
    F-PLC leads to a state of the invariant.

    One query for each control state and each one that follows it.
    """
    for scans in scans_of(FPLC):
        for end in dict.fromkeys(control(FPLC, one.after) for one in scans.read.values()):
            given = {**premises(scans), f"it leads to {end}": scans.some(_leads_to(end))}
            yield from claim(f"{scans.control} to {end}", given, scans.always(kept(end)), LOGIC)


def _leads_to(end: str) -> Property:
    return lambda one: TRUE if one.becomes(end) else FALSE

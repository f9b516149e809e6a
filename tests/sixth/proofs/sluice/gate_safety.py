"""What gate and beacon promise, whatever they read."""

from __future__ import annotations

from typing import Final

from proofs.sluice.devices import BEACON, GATE

from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned
from proofs.sentences import Judge, Obligation, exactly_one_path
from proofs.theorem import Queries, theorem

JUDGE: Final = Judge(GATE, ())


def opens_over_a_lit_beacon(one: Scanned) -> Obligation:
    if one.was("Calling") and one.becomes("Open"):
        return TRUE, one.inputs.BeaconLit
    return None


@theorem(clauses=["SL-2-1", "SL-1-3"], findings=["SLF-01"], properties=["OpensOverBeacon"])
def the_gate_opens_only_over_a_lit_beacon() -> Queries:
    """The gate begins to open only in a scan in which it reads that the beacon is lit."""
    yield from JUDGE.in_every_scan(opens_over_a_lit_beacon)

    def never(one: Scanned) -> Obligation:
        return TRUE, one.sends.GateMotor == one.inputs.BeaconLit

    yield JUDGE.too_strong("the motor follows the beacon", never, "Open")


@theorem(clauses=["SL-1-1", "SL-1-4"], findings=[])
def every_scan_of_the_gate_takes_exactly_one_path() -> Queries:
    """In every state of the gate, with any memory, inputs and time, exactly one path applies."""
    yield from exactly_one_path(GATE)


@theorem(clauses=["SL-1-2"], findings=["SLF-02"])
def every_scan_of_the_beacon_takes_exactly_one_path() -> Queries:
    """In every state of the beacon, called or not, exactly one path applies."""
    yield from exactly_one_path(BEACON)

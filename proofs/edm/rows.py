"""The row of every state, whatever the memory; and that what is on has everything it needs."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.edm.devices import BLOCK, CODES
from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Judge, Obligation
from proofs.theorem import Queries, theorem

FROM_ANYWHERE: Final = Judge(BLOCK, ())
"""No invariant: from any memory."""
NAMES: Final = ("Ready", "S_EDM_Out", "SafetyDemand", "ResetRequest", "Error")
NUMBERS: Final = ("11", "12", "13", "21", "22", "23", "31", "32", "33")
TRUE_IN: Final = {
    "Idle": (),
    "Init": ("Ready", "ResetRequest"),
    "OutputDisable": ("Ready", "SafetyDemand"),
    "OutputEnable": ("Ready", "S_EDM_Out"),
    "ResetError1": ("Ready", "Error"),
    "InitError": ("Ready", "Error"),
    **{f"EDMError{of}": ("Ready", "ResetRequest", "Error") for of in NUMBERS},
    **{f"ResetError{of}": ("Ready", "Error") for of in NUMBERS},
}
"""Of each state which of its outputs are TRUE."""


def row_of_the_state(scan: Scanned, seen: Any) -> z3.BoolRef:
    state = control(BLOCK, scan.after)
    true = TRUE_IN[state]
    said = [
        getattr(scan.sends, name) if name in true else z3.Not(getattr(scan.sends, name)) for name in NAMES
    ]
    return z3.And(scan.sends.DiagCode == CODES[state], *said)


@theorem(
    clauses=[
        "EDM-OUT-READY-1",
        "EDM-OUT-READY-2",
        "EDM-OUT-EDM-1",
        "EDM-OUT-EDM-2",
        "EDM-OUT-DEMAND",
        "EDM-OUT-REQUEST",
        "EDM-OUT-ERROR",
        "EDM-OUT-DIAG",
    ],
    findings=["EDMF-01", "EDMF-02", "EDMF-03"],
    properties=["OutputNeedsAll", "IdleShowsNothing"],
)
def every_state_has_its_row() -> Queries:
    """At power-up and after every call, from any memory, the outputs are the row of the
    state: S_EDM_Out is TRUE in one state alone, which shows neither error, nor inhibit, nor demand.
    """
    yield from FROM_ANYWHERE.after_every_scan(row_of_the_state)

    def never_on(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.sends.S_EDM_Out)

    yield FROM_ANYWHERE.too_strong("the output is never on", never_on, "OutputDisable")


def nothing_is_on(scan: Scanned, seen: Any) -> z3.BoolRef:
    return z3.And(scan.sends.DiagCode == 0, *(z3.Not(getattr(scan.sends, name)) for name in NAMES))


@theorem(clauses=["EDM-OUT-READY-1", "EDM-SEQ-0"], findings=[], properties=["PowerUpIsSafe"])
def before_the_first_call_nothing_is_on() -> Queries:
    """Before the first call, with any parameters, the block is not ready and shows nothing."""
    yield from FROM_ANYWHERE.at_power_up(nothing_is_on)
    always = FROM_ANYWHERE.after_a_scan(nothing_is_on)
    yield FROM_ANYWHERE.too_strong("nothing is on after any call", always, "Idle")


def code_tells_the_row(scan: Scanned, seen: Any) -> z3.BoolRef:
    o, code = scan.sends, scan.sends.DiagCode
    active, error = code & 0x8000 != 0, code & 0xC000 == 0xC000
    same = [active == o.Ready, error == o.Error, (code & 0x0800 != 0) == o.SafetyDemand]
    asks = z3.If(o.Error, z3.And(code & 0x000F == 0, code != CODES["InitError"]), code & 0x0400 != 0)
    return z3.And(*same, o.S_EDM_Out == (code == 0x8000), o.ResetRequest == asks)


@theorem(
    clauses=["EDM-OUT-DIAG", "EDM-OUT-ERROR", "EDM-OUT-DEMAND", "EDM-OUT-REQUEST"],
    findings=["EDMF-01", "EDMF-02"],
    properties=["CodeTellsTheRow"],
)
def the_code_tells_the_row() -> Queries:
    """At power-up and after every call bits of DiagCode say what the outputs say, but for ResetRequest in
    errors, which their last digit says.
    """
    yield from FROM_ANYWHERE.after_every_scan(code_tells_the_row)

    def by_the_bit_everywhere(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.ResetRequest == (scan.sends.DiagCode & 0x0400 != 0)

    yield FROM_ANYWHERE.too_strong(
        "ResetRequest is its bit in errors too", by_the_bit_everywhere, "EDMError11"
    )

"""An inductive invariant: named sentences on the memory of a device, true after every scan."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import z3

from proofs.explorer.device import Device
from proofs.explorer.scanned import control, memory, parameters

Formula = Callable[[str, Any, Any, Any], z3.BoolRef]


@dataclass(frozen=True)
class Conjunct:
    """One sentence of an invariant; `formula` gets the control state, memory, parameters and the observer."""

    name: str
    sentence: str
    formula: Formula


def conjuncts(
    invariant: tuple[Conjunct, ...], device: Device, state: Any, seen: Any = None
) -> dict[str, z3.BoolRef]:
    """The conjuncts that say something of this state, by name. `state`: a State record of the device."""
    s, p, where = memory(device, state), parameters(device, state), control(device, state)
    found = {conjunct.name: conjunct.formula(where, s, p, seen) for conjunct in invariant}
    return {name: formula for name, formula in found.items() if not z3.is_true(formula)}

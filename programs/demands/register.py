"""The demands of a target, from the register of its document."""

from __future__ import annotations

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.demands import Demands, read_demands
from modeproof.kit.signals import read_signals
from modeproof.registers import load_interface
from modeproof.suites.demands import FILE, declare, declare_parameters, load_demands
from programs.semantics.reference import Reference


def demands_of(of: Reference) -> Demands:
    """What the document demands of a target. Raises Unjudged: the register has nothing on it."""
    place, device = root(), of.device.register
    table = load_demands(place, of.document, device)
    where = f"spec/{of.document}/{FILE}"
    if table is None:
        raise Unjudged(f"{where}: nothing is demanded of {device.id}; --same asks whether it is equal")
    modes = load_interface(place, of.document).constants.get("MODES", ())
    inputs, outputs = (read_signals(declare(one, modes), where) for one in (device.inputs, device.outputs))
    return read_demands(table, inputs, outputs, declare_parameters(device, modes), where)

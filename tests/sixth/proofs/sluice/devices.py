"""The two devices as the explorer runs them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from refimpl.sluice import beacon, gate

from modeproof.registers import load_interface
from proofs.explorer.device import Device

_REGISTERS: Final = load_interface(Path(__file__).parents[2], "sluice").devices

GATE: Final = Device(gate, _REGISTERS["gate"])
BEACON: Final = Device(beacon, _REGISTERS["beacon"])
DEVICES: Final = (GATE, BEACON)

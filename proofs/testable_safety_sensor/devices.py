"""The block as the explorer runs it: any inputs, any times, any TestTime that a TIME can hold."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from modeproof.registers import load_interface
from proofs.explorer.device import Device
from refimpl.testable_safety_sensor import sf_testable_safety_sensor

ROOT: Final = Path(__file__).parents[2]
_REGISTERS: Final = load_interface(ROOT, "testable_safety_sensor").devices

SENSOR: Final = Device(sf_testable_safety_sensor, _REGISTERS["sf_testable_safety_sensor"])
DEVICES: Final = (SENSOR,)

"""The block as the explorer runs it: every parameter that its register allows."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from modeproof.registers import load_interface
from proofs.explorer.device import Device
from refimpl.enable_switch import sf_enable_switch

ROOT: Final = Path(__file__).parents[2]

SWITCH: Final = Device(sf_enable_switch, load_interface(ROOT, "enable_switch").devices["sf_enable_switch"])
DEVICES: Final = (SWITCH,)

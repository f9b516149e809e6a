"""The block as the explorer runs it: any inputs, times and MonitoringTime, both values of AFTER_RESET."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import z3

from modeproof.registers import load_interface
from proofs.explorer.device import Device
from refimpl.edm import sf_edm

ROOT: Final = Path(__file__).parents[2]
_REGISTERS: Final = load_interface(ROOT, "edm").devices

BLOCK: Final = Device(sf_edm, _REGISTERS["sf_edm"])
DEVICES: Final = (BLOCK,)
CODES: Final = {state: int(code, 16) for state, code in BLOCK.register.codes.items()}
"""The DiagCode of each state, as the register has it. EDMF-01"""


def stop_first(params: Any) -> z3.BoolRef:
    """After a reset by hand S_OutControl must be FALSE before it counts. EDMF-04"""
    values = BLOCK.register.parameters["AFTER_RESET"].values
    chosen: z3.BoolRef = values.index("stop_first") == params.AFTER_RESET
    return chosen

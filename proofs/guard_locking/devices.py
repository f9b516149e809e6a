"""The block as the explorer runs it, and how its parameters are written in terms."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import z3

from modeproof.registers import load_interface
from proofs.explorer.device import Device
from refimpl.guard_locking import sf_guard_locking

ROOT: Final = Path(__file__).parents[2]
BLOCK: Final = Device(sf_guard_locking, load_interface(ROOT, "guard_locking").devices["sf_guard_locking"])
DEVICES: Final = (BLOCK,)


def chosen(params: Any, name: str, value: str) -> z3.BoolRef:
    """The parameter `name` has this value: in terms, its place in interface.toml."""
    found: z3.BoolRef = getattr(params, name) == BLOCK.register.parameters[name].values.index(value)
    return found

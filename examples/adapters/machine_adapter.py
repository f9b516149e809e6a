"""Serve a whole machine over adapter protocol 1: python machine_adapter.py [WIRING.toml]

It runs the composed reference, refimpl/machine_cell; without a file the shipped wiring. So vectors can be
tried on a wiring with a mistake before they are tried on a PLC.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from examples.adapters.refimpl_adapter import Target, from_wire, serve  # noqa: E402
from refimpl.errors import ParameterError  # noqa: E402
from refimpl.machine_cell import cell as reference  # noqa: E402


class Machine(Target):
    """A wiring behind the protocol."""

    def __init__(self, path: Path) -> None:
        self.name = "machine_cell"
        self.code = reference
        self.cell = reference.load(path)
        self.state = None

    def power_up(self, params: dict[str, Any]) -> reference.State:
        """The power-up state; a machine has no parameters."""
        if params:
            raise ParameterError(*next(iter(params.items())), "nothing (a machine has no parameters)")
        return reference.power_up(self.cell)

    def step(self, state: Any, dt_ms: Any, inputs: dict[str, Any]) -> tuple[Any, dict[str, object]]:
        """The state after a scan and the outputs; the machine refuses what is no input of it."""
        values = {
            name: from_wire(name, {"type": self.cell.inputs.get(name, "").lower()}, value)
            for name, value in inputs.items()
        }
        state, out = reference.step(self.cell, state, values, dt_ms)
        return state, {name: v if isinstance(v, bool) else f"{v:04X}" for name, v in out.items()}


if __name__ == "__main__":
    if len(sys.argv) > 2:
        raise SystemExit("usage: python machine_adapter.py [WIRING.toml]")
    serve(Machine(Path(sys.argv[1]) if sys.argv[1:] else ROOT / "spec/machine_cell/wiring.toml"))

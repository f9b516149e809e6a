"""The reference of a whole machine: blocks that are wired as the header of its vectors says.

The package has NAME.<document>.cell: `made_of(wiring)`, `power_up(cell)`,
`step(cell, state, inputs, dt_ms)`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from modeproof.kit.builtin import REFERENCE, Builtin, beside_kit
from modeproof.kit.by_name import module_named
from modeproof.kit.errors import Unjudged
from modeproof.kit.vectors import EXACT, WIRING, Scan, Suite

UNKNOWN = -1
"""The state after a scan that no file of vectors has."""


class Wired:
    """A `Program`. Raises Unjudged where the package cannot make a machine of the wiring."""

    def __init__(self, package: str, document: str, wiring: Mapping[str, Any]) -> None:
        try:
            self.code = module_named(f"{package}.{document}.cell")
            self.cell = self.code.made_of(wiring)
        except Exception as error:  # whatever the package does when it is imported
            said = f"{error.args[0]} is missing" if isinstance(error, KeyError) else error
            raise Unjudged(f"{package}.{document} makes no machine of the wiring: {said}") from None
        self._name = package
        self.state: Any = None

    def hello(self, target: str) -> Mapping[str, Any]:
        """As of an adapter."""
        return {"ok": True, "name": self._name, "version": "", "relations": [EXACT]}

    def reset(self, params: Mapping[str, Any]) -> None:
        """Power-up."""
        if params:
            raise Unjudged(f"reset was refused: no parameter {next(iter(params))}; the wiring has them")
        self.state = self.code.power_up(self.cell)

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """One scan."""
        try:
            self.state, out = self.code.step(self.cell, self.state, self._given(inputs), dt_ms)
        except (TypeError, ValueError, AttributeError, KeyError) as error:
            raise Unjudged(f"refused: {error}") from None
        return _shown(out)

    def _given(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
        words = self.cell.inputs
        return {name: int(of, 16) if words.get(name) == "WORD" else of for name, of in inputs.items()}

    def first(self) -> Mapping[str, Any]:
        """What the outputs show before the first scan, with every input FALSE or 0000."""
        inputs = {name: kind == "WORD" and 0 for name, kind in self.cell.inputs.items()}
        values = self.code.values_after(self.cell, self.code.power_up(self.cell), inputs)
        return _shown({name: values[name] for name in self.cell.outputs})

    def on(self, state: Any, inputs: Mapping[str, Any]) -> list[str]:
        """The signals and latches that are on after a scan with these inputs; words are numbers."""
        values = self.code.values_after(self.cell, state, inputs)
        others = {
            *inputs,
            *self.cell.outputs,
            *(pin for pin in state.pins if not pin.endswith((".Q1", ".Error"))),
        }
        return [name for name, value in values.items() if value is True and name not in others]

    def close(self) -> None:
        """Nothing is held."""


def _shown(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: of if isinstance(of, bool) else f"{of:04X}" for name, of in values.items()}


def expected(suite: Suite, scans: Iterable[Scan]) -> tuple[Scan, ...]:
    """These scans from power-up, with what the machine of the header gives. Raises Unjudged."""
    program = beside_kit(lambda: _of(REFERENCE, suite))
    program.reset({})
    return tuple(replace(scan, outputs=program.scan(scan.dt_ms, scan.inputs), to=UNKNOWN) for scan in scans)


def program_of(package: str, suite: Suite) -> Builtin | Wired:
    """The program of a package: of a machine, if the header has a wiring. Raises Unjudged."""
    return _of(package, suite) if WIRING in suite.header else Builtin(package, suite)


def _of(package: str, suite: Suite) -> Wired:
    return Wired(package, suite.document, suite.header[WIRING])

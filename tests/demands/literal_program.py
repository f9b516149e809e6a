"""A program in Structured Text as the kit runs one: by the interpreter, with the names of the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from modeproof.ground.places import root
from modeproof.kit.demands import Watch
from modeproof.kit.relation import LATENCY, Options
from modeproof.kit.suite_judge import run_suite
from modeproof.kit.vectors import MONITOR, Suite, open_suite
from modeproof.kit.verdict import Plan, Verdict
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device
from modeproof.suites.demands import load_demands
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine

PLACE = root() / "examples/literal"
DOCUMENT = {
    "fplc": "mode_selection",
    "plc": "mode_selection",
    "hmi": "mode_selection",
    "sf_guard_locking": "guard_locking",
    "sf_testable_safety_sensor": "testable_safety_sensor",
    "sf_enable_switch": "enable_switch",
    "sf_edm": "edm",
}
NONE = -1


class Literal:
    """A function block. What a target has and it has not is FALSE or 0; only project outputs are so."""

    keeps_answers = False

    def __init__(self, path: Path, device: Device) -> None:
        self.source = read_sources([path])
        (self.unit,) = self.source.units.values()
        self.device = device
        self.given: dict[str, Any] = {}
        self.machine = Machine(self.source, self.unit)

    @cached_property
    def names(self) -> dict[str, str]:
        """The names of the block's variables, by their names in upper case."""
        return {name.upper(): variable.name for name, variable in self.unit.variables.items()}

    def hello(self, target: str) -> Mapping[str, Any]:
        return {"ok": True, "name": f"{target}.st", "version": "1"}

    def reset(self, params: Mapping[str, Any]) -> None:
        self.machine = Machine(self.source, self.unit)
        defaults = {name: of.default for name, of in self.device.parameters.items()}
        own = {name.removesuffix("_ms"): value for name, value in {**defaults, **params}.items()}
        self.given = {name: value for name, value in own.items() if name.upper() in self.names}

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        own = {name: self._inward(name, value) for name, value in inputs.items()}
        if "DT_MS" in self.names:
            own["dt_ms"] = dt_ms
        row = {self.names[name.upper()]: value for name, value in {**own, **self.given}.items()}
        given = {name.upper(): value for name, value in self.machine.scan(row, dt_ms).items()}
        return {name: self._outward(name, given.get(name.upper())) for name in self.device.outputs}

    def close(self) -> None:
        pass

    def _inward(self, name: str, value: Any) -> Any:
        of = self.device.inputs[name]
        if of.type == "word":
            return int(value, 16)
        if of.type == "text":
            return of.values.index(value or "")
        return NONE if of.type == "mode" and value is None else value

    def _outward(self, name: str, value: Any) -> Any:
        of = self.device.outputs[name]
        if of.type == "word":
            return f"{value or 0:04X}"
        if of.type == "text":
            return of.values[value]
        if of.type == "modes":
            return [mode for mode in range(5) if value[mode]]
        if of.type == "mode":
            return None if value == NONE else value
        return bool(value)


def suites_of(target: str, names: tuple[str, ...]) -> list[Suite]:
    """Published suites, with what is demanded."""
    device = load_interface(root(), DOCUMENT[target]).devices[target]
    table = load_demands(root(), DOCUMENT[target], device)
    return [open_suite(root() / f"vectors/{target}/{name}.jsonl.gz").demanding(table) for name in names]


def verdicts(target: str, path: Path, names: tuple[str, ...]) -> list[Verdict]:
    """What the page says of the program in each suite."""
    device = load_interface(root(), DOCUMENT[target]).devices[target]
    plan = Plan(options=Options(MONITOR), effort=0)
    return [run_suite(suite, lambda: Literal(path, device), plan=plan) for suite in suites_of(target, names)]


def broken_by(target: str, path: Path, wires: Sequence[tuple[int, int, str]]) -> str:
    """The demand that the program breaks on these wires: so many scans, the ms of each, the inputs TRUE."""
    device = load_interface(root(), DOCUMENT[target]).devices[target]
    (suite,) = suites_of(target, ("sequences",))
    demands = suite.demands()
    assert demands is not None
    program, watch = Literal(path, device), Watch(demands, LATENCY)
    program.reset({})
    watch.reset({})
    for count, dt_ms, on in wires:
        words = {name: "0000" if of.type == "word" else False for name, of in device.inputs.items()}
        row = {**words, **dict.fromkeys(on.split(), True)}
        for _ in range(count):
            found = watch.scan(dt_ms, row, program.scan(dt_ms, row))
            if found is not None:
                return found.id
    return ""

"""Programs on trial before the demands on a block: many short runs from power-up, with inputs by chance."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from importlib import import_module
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.ground.places import root
from modeproof.kit.demands import Demands, Watch, read_demands
from modeproof.kit.signals import read_signals
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device
from modeproof.suites.demands import declare, declare_parameters, load_demands

Edit = tuple[str, str]
Scan = Callable[[int, Mapping[str, bool]], Mapping[str, Any]]
Program = Callable[[], Scan]
LATENCY, SCANS = 1, 50
_NUMBER = count()


@dataclass(frozen=True)
class Runs:
    """A block by its document and its target, and what each of its runs begins with."""

    document: str
    target: str
    begins: Callable[[random.Random], list[dict[str, bool]]]

    @cached_property
    def device(self) -> Device:
        """What interface.toml says of the target."""
        return load_interface(root(), self.document).devices[self.target]

    @cached_property
    def demands(self) -> Demands:
        """The demands as the kit reads them."""
        table = load_demands(root(), self.document, self.device)
        assert table is not None
        inputs, outputs = (
            read_signals(declare(signals, []), "") for signals in (self.device.inputs, self.device.outputs)
        )
        return read_demands(table, inputs, outputs, declare_parameters(self.device, []), "")

    def wires(self, number: int) -> Iterator[tuple[int, dict[str, bool]]]:
        """The scans of one run, the same in every test. How often an input changes is its own."""
        dice = random.Random(number)
        often = {name: dice.choice((0.05, 0.3, 0.5, 0.7, 0.95)) for name in self.device.inputs}
        often["Activate"], change = dice.choice((0.9, 0.98, 1)), dice.choice((0.05, 0.15, 0.3))
        times = dice.choice(((10,), (0, 5, 10), (0, 10, 40)))
        begins = self.begins(dice)
        inputs = dict.fromkeys(self.device.inputs, False)
        for scan in range(SCANS):
            if scan < len(begins):
                inputs |= begins[scan]
            else:
                inputs |= {name: dice.random() < often[name] for name in inputs if dice.random() < change}
            yield dice.choice(times), dict(inputs)

    def broken(
        self, program: Program, runs: int, until: str = "", late: int = 0, **params: Any
    ) -> tuple[set[str], set[str]]:
        """The demands that the program breaks first in a run, and those that were put to it.

        until: the demand after whose fall nothing more is asked. late: the program acts upon what it read so
        many calls before.
        """
        watch = Watch(self.demands, LATENCY)
        found: set[str] = set()
        for number in range(runs):
            watch.reset(params)
            scan, read = program(), [dict.fromkeys(self.device.inputs, False)] * late
            for dt_ms, inputs in self.wires(number):
                read.append(inputs)
                fall = watch.scan(dt_ms, inputs, scan(dt_ms, read.pop(0)))
                if fall is not None:
                    found.add(fall.id)
                    break
            if until in found:
                break
        return found, {name for name, number in watch.counts.items() if number}

    def reference(self, *edits: Edit, **params: Any) -> Program:
        """A copy of the reference implementation with the edits."""
        shipped = import_module(f"refimpl.{self.document}.{self.target}")
        source = Path(shipped.__file__ or "").read_text(encoding="utf-8")
        for old, new in edits:
            assert source.count(old) == 1, old
            source = source.replace(old, new)
        module = ModuleType(f"short_run_{self.target}_{next(_NUMBER)}")
        sys.modules[module.__name__] = module
        exec(compile(source, module.__name__, "exec"), vars(module))

        def program() -> Scan:
            state = module.power_up(module.Params(**params))

            def scan(dt_ms: int, inputs: Mapping[str, bool]) -> dict[str, Any]:
                nonlocal state
                state, outputs = module.step(state, module.Inputs(dt_ms=dt_ms, **inputs))
                return asdict(outputs)

            return scan

        return program

    def falls(self, demand: str, program: Program, **params: Any) -> bool:
        """The program breaks this demand."""
        return demand in self.broken(program, 1_500, demand, **params)[0]

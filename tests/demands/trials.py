"""A program on trial before the demands on a block: inputs that change at random, and what it breaks."""

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
Inputs = Mapping[str, bool]
Scan = Callable[[int, Inputs], dict[str, Any]]
LATENCY = 1
STRETCH = 200
_NUMBER = count()


@dataclass(frozen=True)
class Trial:
    """A block by its document and its target.

    times: the ms between two calls that are tried. kept: how often each input is TRUE, of those that are not
    every other time. rare: the inputs that hardly ever change. follows: an input that is FALSE after an
    output that is, and this output; so it is in every other stretch.
    """

    document: str
    target: str
    times: tuple[int, ...]
    kept: Mapping[str, float]
    rare: tuple[str, ...]
    follows: tuple[str, str] | None = None

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

    def wires(self, scans: int) -> Iterator[tuple[int, dict[str, bool]]]:
        """The inputs of the scans, the same in every test: calm stretches, and lively ones."""
        dice = random.Random(7)
        inputs = dict.fromkeys(self.device.inputs, False)
        change = 0.05
        for number in range(scans):
            if number % STRETCH == 0:
                change = (0.03, 0.1, 0.25)[number // STRETCH % 3]
            for name in inputs:
                if dice.random() < (0.01 if name in self.rare else change):
                    inputs[name] = dice.random() < self.kept.get(name, 0.5)
            yield dice.choice(self.times), dict(inputs)

    def broken(
        self, program: Scan, scans: int, until: str = "", late: int = 0, **params: Any
    ) -> tuple[set[str], set[str]]:
        """The demands that the program breaks, and those that were put to it.

        until: the demand after whose fall nothing more is asked. late: the program acts upon what it read so
        many calls before.
        """
        watch = Watch(self.demands, LATENCY)
        watch.reset(params)
        found: set[str] = set()
        read = [dict.fromkeys(self.device.inputs, False)] * late
        outputs: dict[str, Any] = {}
        for number, (dt_ms, inputs) in enumerate(self.wires(scans)):
            if self.follows and number // STRETCH % 2 and outputs:
                inputs[self.follows[0]] &= outputs[self.follows[1]]
            read.append(inputs)
            outputs = program(dt_ms, read.pop(0))
            fall = watch.scan(dt_ms, inputs, outputs)
            if fall is not None:
                found.add(fall.id)
                if fall.id == until:
                    break
        return found, {name for name, number in watch.counts.items() if number}

    def reference(self, *edits: Edit, **params: Any) -> Scan:
        """A copy of the reference implementation with the edits."""
        shipped = import_module(f"refimpl.{self.document}.{self.target}")
        source = Path(shipped.__file__ or "").read_text(encoding="utf-8")
        for old, new in edits:
            assert source.count(old) == 1, old
            source = source.replace(old, new)
        module = ModuleType(f"on_trial_{self.target}_{next(_NUMBER)}")
        sys.modules[module.__name__] = module
        exec(compile(source, module.__name__, "exec"), vars(module))
        state = module.power_up(module.Params(**params))

        def scan(dt_ms: int, inputs: Inputs) -> dict[str, Any]:
            nonlocal state
            state, outputs = module.step(state, module.Inputs(dt_ms=dt_ms, **inputs))
            return asdict(outputs)

        return scan

    def falls(self, demand: str, program: Scan, **params: Any) -> bool:
        """The program breaks this demand."""
        return demand in self.broken(program, 20_000, demand, **params)[0]

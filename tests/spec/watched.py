"""A demands on trial: the reference implementation, or a copy of it with one edit, under its eyes."""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from importlib import import_module
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.ground.places import root
from modeproof.kit.demands import Demand, Demands, Watch, read_demands
from modeproof.kit.relation import STABLE
from modeproof.kit.signals import read_signals
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device
from modeproof.suites.demands import declare, declare_parameters, load_demands

SCANS = 12_000
Edit = tuple[str, str]
_NUMBER = count()


@dataclass(frozen=True)
class Watched:
    """A block by its document and its target.

    times: the ms between two calls that are tried. kept: how often each input is TRUE, of those that are not
    TRUE every other time; an input changes in one call of five.
    """

    document: str
    target: str
    times: tuple[int, ...]
    kept: Mapping[str, float]

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

    @property
    def properties(self) -> list[str]:
        """The properties of the demands."""
        return [one.id for one in self.demands.rows]

    def unjudged_without_codes(self) -> tuple[str, ...]:
        """The properties that rest on an output whose values are the project's own."""
        project = [name for name, of in self.device.outputs.items() if of.project]
        return Watch(self.demands, unobserved=project).unjudged

    def wires(self, held: int) -> Iterator[tuple[int, dict[str, bool]]]:
        """The inputs of the scans, the same in every test; each stands for so many scans."""
        dice = random.Random(7)
        inputs = dict.fromkeys(self.device.inputs, False)
        for _ in range(SCANS // held):
            for name in inputs:
                if dice.random() < 0.2:
                    inputs[name] = dice.random() < self.kept.get(name, 0.5)
            for _ in range(held):
                yield dice.choice(self.times), dict(inputs)

    def watch(
        self, *edits: Edit, only: str = "", late: bool = False, **params: Any
    ) -> tuple[Demand | None, dict[str, int]]:
        """The first property that a copy with the edits breaks, and in how many scans each was put to it.

        only: the one property that is judged. late: the program acts upon what it read a call before.
        """
        chosen = tuple(one for one in self.demands.rows if only in ("", one.id))
        watch = Watch(replace(self.demands, rows=chosen), latency=int(late))
        watch.reset(params)
        with self._program(*edits) as program:
            state = program.power_up(program.Params(**params))
            before: dict[str, bool] = dict.fromkeys(self.device.inputs, False)
            for dt_ms, inputs in self.wires(2 + STABLE if late else 1):
                read = before if late else inputs
                state, outputs = program.step(state, program.Inputs(dt_ms=dt_ms, **read))
                before = inputs
                broken = watch.scan(dt_ms, inputs, asdict(outputs))
                if broken is not None:
                    return broken, watch.counts
        return None, watch.counts

    def falls(self, name: str, edits: Sequence[Edit], params: Mapping[str, Any]) -> bool:
        """A copy with the edits breaks this property, judged alone."""
        broken, _ = self.watch(*edits, only=name, **params)
        return broken is not None and broken.id == name

    def put_to_it(self, kept: Sequence[Mapping[str, Any]]) -> set[str]:
        """The properties put to the block, which keeps its demands with each of these parameters."""
        put: set[str] = set()
        for params in kept:
            broken, counts = self.watch(**params)
            assert broken is None, (params, broken)
            put |= {name for name, scans in counts.items() if scans}
        return put

    @contextmanager
    def _program(self, *edits: Edit) -> Iterator[ModuleType]:
        shipped = import_module(f"refimpl.{self.document}.{self.target}")
        source = Path(shipped.__file__ or "").read_text(encoding="utf-8")
        for old, new in edits:
            assert source.count(old) == 1, old
            source = source.replace(old, new)
        module = ModuleType(f"watched_{self.target}_{next(_NUMBER)}")
        sys.modules[module.__name__] = module
        try:
            exec(compile(source, module.__name__, "exec"), vars(module))
            yield module
        finally:
            del sys.modules[module.__name__]

"""What is assumed of a run: inputs that stay as they are, that are never on together, that change slowly.

Inputs that the page calls constant are so in every run. Others are the user's, in the table [assume] of the
file of the binding:

    [assume]
    constant = ["S_AutoReset"]              # as it is in the first scan; or { S_AutoReset = false }
    never_both = [["StartTest", "Reset"]]
    held_ms = { Reset = 50 }                # once it has changed it stays so for at least so long
    flips = true                            # what the page calls constant may change, too
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged, suggestion
from programs.equality.replay import Run
from programs.semantics.reference import Reference


@dataclass(frozen=True)
class Assumed:
    """What is assumed of the inputs of a target. own: what the user has asked for; printed: the inputs that
    the page calls constant.
    """

    reference: Reference
    own: Mapping[str, Any] = field(default_factory=dict)
    printed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        kinds = {"constant": (list, dict), "never_both": (list,), "held_ms": (dict,), "flips": (bool,)}
        for key, value in self.own.items():
            if key not in kinds:
                raise Unjudged(f"[assume]: unknown key {key!r}; {suggestion(key, kinds)}")
            if not isinstance(value, kinds[key]):
                raise Unjudged(f"[assume]: {key}: a {kinds[key][-1].__name__} is needed")
        for name in self.own.get("constant", ()):
            self._signal(name)
        for pair in self.never_both:
            if len(pair) < 2 or len({*pair}) < len(pair):
                raise Unjudged(f"[assume]: never_both holds lists of two inputs or more, not {pair!r}")
            for name in pair:
                self._bool(name, "never_both")
        for name, value in self.fixed.items():
            if type(value) is not bool or self._signal(name).type != "bool":
                raise Unjudged(f"[assume]: constant: {name} = true or false is for an input of type bool")
        for name, ms in self.held.items():
            self._bool(name, "held_ms")
            if type(ms) is not int or ms <= 0:
                raise Unjudged(f"[assume]: held_ms: {name} = {ms!r}: whole ms above 0 are needed")
        for pair in self.never_both:
            if sum(self.fixed.get(name, False) for name in pair) > 1:
                raise Unjudged(f"[assume]: no run fulfils it: {pair} are TRUE all the time")

    def _signal(self, name: object) -> Any:
        signals = self.reference.signals("inputs")
        if not isinstance(name, str) or name not in signals:
            target = self.reference.device.name
            raise Unjudged(f"[assume]: {target} has no input {name}; {suggestion(str(name), signals)}")
        return signals[name]

    def _bool(self, name: object, key: str) -> None:
        if self._signal(name).type != "bool":
            raise Unjudged(f"[assume]: {key}: {name} is of type {self._signal(name).type}, not bool")

    @cached_property
    def by_page(self) -> tuple[str, ...]:
        """The inputs that the page calls constant, unless the user lets them change."""
        signals = self.reference.signals("inputs").items()
        printed = () if self.own.get("flips") else self.printed
        return tuple(name for name, signal in signals if signal.name in printed)

    @cached_property
    def constant(self) -> tuple[str, ...]:
        """All inputs that stay as they are."""
        return tuple(dict.fromkeys((*self.by_page, *self.own.get("constant", ()))))

    @cached_property
    def fixed(self) -> Mapping[str, bool]:
        """Those that have one value."""
        given = self.own.get("constant", ())
        return dict(given) if isinstance(given, dict) else {}

    @property
    def never_both(self) -> Sequence[Sequence[str]]:
        """Lists of inputs of which no two are on."""
        rows = self.own.get("never_both", ())
        if not all(isinstance(row, list) for row in rows):
            raise Unjudged('[assume]: never_both = [["A", "B"]]: a list of lists is needed')
        return list(rows)

    @property
    def held(self) -> Mapping[str, int]:
        """The least time that each of these stays as it is, in ms."""
        return dict(self.own.get("held_ms", {}))

    def words(self) -> Iterator[str]:
        """What a verdict says of it."""
        if self.by_page:
            yield f"{', '.join(self.by_page)}: constant during a run, as the page has it"
        for name in self.own.get("constant", ()):
            value = f" {str(self.fixed[name]).upper()}" if name in self.fixed else ""
            yield f"{name}: constant{value} during a run (yours)"
        yield from (f"{' and '.join(pair)}: never TRUE together (yours)" for pair in self.never_both)
        yield from (
            f"{name}: stays {ms} ms or longer once it has changed (yours)" for name, ms in self.held.items()
        )

    # ------------------------------------------------------------ as terms

    @cached_property
    def memory(self) -> dict[str, tuple[Any, Any, Any]]:
        """What has to be remembered of slow inputs: symbol, value at power-up, and value after a scan."""
        found: dict[str, tuple[Any, Any, Any]] = {}
        dt_ms = self.reference.input_terms["dt_ms"]
        for name, ms in self.held.items():
            before, since, now = (
                z3.Bool(f"{name} then"),
                z3.Int(f"{name} since"),
                self.reference.input_terms[name],
            )
            first = z3.Bool(f"{name} was read")
            found[str(before)] = before, z3.BoolVal(False), now
            found[str(first)] = first, z3.BoolVal(False), z3.BoolVal(True)
            kept = z3.If(since >= ms, z3.IntVal(ms), since + dt_ms)
            changed = z3.And(first, before != now)
            start = z3.If(first, kept, z3.IntVal(ms))
            found[str(since)] = since, z3.IntVal(ms), z3.If(changed, z3.IntVal(0), start)
        return found

    @cached_property
    def formulas(self) -> list[z3.BoolRef]:
        """What holds of the inputs of a scan."""
        terms, found = self.reference.input_terms, []
        found += [terms[name] == z3.BoolVal(value) for name, value in self.fixed.items()]
        for pair in self.never_both:
            found += [
                z3.Not(z3.And(terms[one], terms[other]))
                for number, one in enumerate(pair)
                for other in pair[number + 1 :]
            ]
        for name, ms in self.held.items():
            before, since, first = (
                z3.Bool(f"{name} then"),
                z3.Int(f"{name} since"),
                z3.Bool(f"{name} was read"),
            )
            long = since + terms["dt_ms"] >= ms
            found.append(z3.Or(z3.Not(first), before == terms[name], long))
        return found

    # ------------------------------------------------------------ with plain values

    def steadied(self, run: Run) -> Run:
        """The run with what is constant as it is in the first scan, or as it is said to be."""
        if not run.scans:
            return run
        held = {name: run.scans[0][1][name] for name in self.constant} | dict(self.fixed)
        return Run(run.parameters, [(dt_ms, {**row, **held}) for dt_ms, row in run.scans], run.retained)

    def fulfilling(self, run: Run) -> Run:
        """The scans of a run up to the first one that does not fulfil it."""
        now, since = 0, dict.fromkeys(self.held, -max(self.held.values(), default=0))
        before: Mapping[str, Any] | None = None
        for number, (dt_ms, inputs) in enumerate(run.scans):
            now += dt_ms
            wrong = any(inputs[name] != value for name, value in self.fixed.items())
            wrong |= any(sum(bool(inputs[name]) for name in pair) > 1 for pair in self.never_both)
            if before is not None:
                wrong |= any(inputs[name] != before[name] for name in self.constant)
                for name, ms in self.held.items():
                    if inputs[name] != before[name]:
                        wrong |= now - since[name] < ms
                        since[name] = now
            if wrong:
                return run.upto(number)
            before = inputs
        return run

"""Runs a program with plain values, scan by scan: what a PLC would do. It knows nothing of solvers.

The clock does not move within a scan. TON, TOF and TP measure from the scan of the edge, in which ET is 0.
Integers and times that leave their range stop the run (`Overflow`), or wrap if the run says so.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from programs.language.calls import function_of, handed_to_block, handed_to_function, in_outs
from programs.language.tree import (
    MOST_TURNS,
    Assign,
    Body,
    Call,
    Case,
    Expression,
    For,
    If,
    Instance,
    Leave,
    Loop,
    Place,
    Return,
    Source,
    Unit,
)
from programs.semantics.interpreter_blocks import Standard
from programs.semantics.interpreter_expressions import Evaluator, Limit, Overflow
from programs.semantics.memory_of_units import Frame


class _Returned(Exception):
    pass


class _Exit(Exception):
    pass


class _Continue(Exception):
    pass


class Machine(Evaluator):
    """A program at power-up. wrap: integers and times wrap as two's complement; else they stop the run."""

    def __init__(self, source: Source, unit: Unit, wrap: bool = False) -> None:
        super().__init__(source, wrap)
        self.unit = unit
        self.memory = Frame(source, unit)
        self.now = 0

    def scan(self, inputs: Mapping[str, Any], dt_ms: int) -> dict[str, Any]:
        """One scan, `dt_ms` after the one before: the outputs by their names in the source.

        Raises Overflow with file and line.
        """
        self.now += dt_ms
        for name, value in inputs.items():
            self.memory.values[name.upper()] = deepcopy(value)
        self.call(self.memory)
        return {name: deepcopy(self.memory.values[name.upper()]) for name in self.unit.of("output")}

    def call(self, frame: Frame) -> None:
        """One call of a unit of the program's own."""
        if frame.unit.device is not None:
            frame.unit.device.call(frame, self.now)
            return
        for key, value in frame.temporary.items():
            frame.values[key] = value if isinstance(value, int) else deepcopy(value)
        with contextlib.suppress(_Returned):
            self.body(frame, frame.unit.body)

    def body(self, frame: Frame, body: Body) -> None:
        for statement in body:
            match statement:
                case Assign(target, value, place):
                    given = self.given(frame, value, frame.types.declared(target), place)
                    self.store(frame, target, given)
                case If(branches, otherwise, _):
                    chosen = next((inner for asked, inner in branches if self.value(frame, asked)), otherwise)
                    self.body(frame, chosen)
                case Case(subject, clauses, otherwise, _):
                    found = self.value(frame, subject)
                    self.body(frame, self.clause(frame, clauses, found, otherwise))
                case For(control, start, end, step, inner, place):
                    low, high = frame.types.constant(start), frame.types.constant(end)
                    by = 1 if step is None else frame.types.constant(step)
                    if by == 0:
                        raise Overflow(f"{place.file}:{place.line}: FOR by 0 does not end")
                    number = low
                    while number <= high if by > 0 else number >= high:
                        self.store(frame, control, number)
                        try:
                            with contextlib.suppress(_Continue):
                                self.body(frame, inner)
                        except _Exit:
                            break
                        number += by
                    else:
                        self.store(frame, control, number)
                case Loop(going, inner, first, place):
                    with contextlib.suppress(_Exit):
                        self.turns(frame, going, inner, first, place)
                case Call():
                    self.invoke(frame, statement)
                case Return():
                    raise _Returned
                case Leave(turn, _):
                    raise _Continue if turn else _Exit

    def turns(self, frame: Frame, going: Expression, inner: Body, first: bool, place: Place) -> None:
        """The turns of WHILE and REPEAT."""
        made = -1 if first else 0
        while made < 0 or self.value(frame, going):
            if made == MOST_TURNS:
                what = f"the loop ends after {MOST_TURNS} turns at most; what takes more is not judged"
                raise Limit(f"{place.file}:{place.line}: not so: {what}")
            with contextlib.suppress(_Continue):
                self.body(frame, inner)
            made += 1

    def clause(self, frame: Frame, clauses: Any, found: int, otherwise: Body) -> Body:
        for ranges, inner in clauses:
            for low, high in ranges:
                if frame.types.constant(low) <= found <= frame.types.constant(high):
                    return inner  # type: ignore[no-any-return]
        return otherwise

    def invoke(self, frame: Frame, call: Call) -> None:
        if (unit := function_of(self.source, frame.unit, call)) is not None:
            self.invoke_function(frame, call, unit)
            return
        below, of = self.read(frame, call.instance), frame.types.of(call.instance)
        assert isinstance(of, Instance)
        inputs, outputs = handed_to_block(self.source, of, call)
        pins = below.values
        for name, expression in inputs:
            kind = frame.types.member(of, name, call.instance.place, True)
            pins[name.upper()] = self.given(frame, expression, kind, call.instance.place)
        kept = in_outs(self.source, of)
        lent = [(key.upper(), self.spot(frame, target)) for key, target in inputs if key.upper() in kept]
        if isinstance(below, Standard):
            below.call(self.now)
        else:
            self.call(below)
        for key, (holder, at) in lent:
            holder[at] = deepcopy(pins[key])
        for name, target in outputs:
            self.store(frame, target, deepcopy(pins[name.upper()]))

    def invoke_function(self, frame: Frame, call: Call, unit: Unit) -> None:
        """A FUNCTION called as a statement: it begins anew, and its outputs go where the call says."""
        inputs, outputs = handed_to_function(unit, call)
        called = Frame(self.source, unit, frame.shared)
        for name, expression in inputs:
            kind = unit.variables[name.upper()].type
            called.values[name.upper()] = self.given(frame, expression, kind, call.place)
        back = unit.of_keys("in_out")
        lent = [(name.upper(), self.spot(frame, target)) for name, target in inputs if name.upper() in back]
        self.call(called)
        for key, (holder, at) in lent:
            holder[at] = deepcopy(called.values[key])
        for name, target in outputs:
            self.store(frame, target, called.values[name.upper()])

"""Values that a call begins without: VAR_TEMP in SCL, and what a FUNCTION there gives.

S7 sets neither at the beginning of a call (optimized blocks may, others hold what was on the stack), while
IEC 61131-3 gives them their first values. So in a unit that is not `fresh` each must be written before it is
read, and the result and the outputs of a FUNCTION on every way to its end, as in statement list. What cannot
be seen to be so is refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.language.calls import function_of, handed_to_block, handed_to_function
from programs.language.memory import leaves
from programs.language.tree import (
    Array,
    Assign,
    Binary,
    Bit,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Leave,
    Literal,
    Loop,
    Member,
    Name,
    Place,
    Return,
    Source,
    Unary,
    Unit,
    root_of,
)
from programs.language.types import Types

State = frozenset[str] | None
"""The single values that are set; None: no way leads here."""


def check_set(source: Source, unit: Unit) -> None:
    """Refuse a unit that may read what was not written, or give what it did not write."""
    calls = _Calls(source, unit)
    calls.ends(calls.body(unit.body, frozenset()), unit.place)


def _met(*states: State) -> State:
    """The state where ways meet."""
    known = [state for state in states if state is not None]
    return frozenset.intersection(*known) if known else None


class _Calls:
    """One call of a unit, on all ways."""

    def __init__(self, source: Source, unit: Unit) -> None:
        self.source, self.unit, self.types = source, unit, Types(source, unit)
        own = ("temp", "var", "output") if unit.kind == "function" else ("temp",)
        self.begins: dict[str, list[str]] = {
            key: [f"{key}{leaf}" for leaf in leaves(variable.type)]
            for key, variable in unit.variables.items()
            if variable.section in own
        }
        """What is not set at the beginning, by the variable."""
        self.numbers: dict[str, int] = {}
        """The control variables of FOR at this turn."""
        self.left: list[tuple[list[State], list[State]]] = []
        """Of the loops around: where EXIT and CONTINUE leave them."""

    def ends(self, state: State, place: Place) -> None:
        """Refuse the end of a FUNCTION to which a way leads without its result or an output."""
        for key in self.unit.of("output") if self.unit.kind == "function" and state is not None else ():
            if not set(self.begins[key.upper()]) <= (state or frozenset()):
                what = "result" if key.upper() == self.unit.name.upper() else f"output {key}"
                raise place.refuse(
                    f"{self.unit.name} may end here without its {what}, which is then undefined in SCL"
                )

    def body(self, body: Body, state: State) -> State:
        for statement in body:
            if state is None:
                break
            state = self.statement(statement, state)
        return state

    def statement(self, statement: Any, state: frozenset[str]) -> State:
        match statement:
            case Assign(target, value, _):
                self.read(value, state)
                return self.written(target, state)
            case If(branches, otherwise, _):
                after = []
                for asked, inner in branches:
                    self.read(asked, state)
                    after.append(self.body(inner, state))
                return _met(*after, self.body(otherwise, state))
            case Case(subject, clauses, otherwise, _):
                self.read(subject, state)
                return _met(*(self.body(inner, state) for _, inner in clauses), self.body(otherwise, state))
            case For():
                return self.counted(statement, state)
            case Loop(going, inner, first, _):
                if not first:
                    self.read(going, state)
                self.left.append(([], []))
                end = self.body(inner, state)
                exits, turns = self.left.pop()
                end = _met(end, *turns)
                if end is not None:
                    self.read(going, end)
                return _met(end if first else state, *exits)
            case Call():
                return self.call(statement, state)
            case Return(place):
                self.ends(state, place)
                return None
            case Leave(turn, _):
                self.left[-1][turn].append(state)
                return None
        raise AssertionError(statement)

    def counted(self, loop: For, state: frozenset[str]) -> State:
        """FOR, turn by turn where an array may be written so; else the first turn shows all."""
        low, high = self.types.constant(loop.start), self.types.constant(loop.end)
        by = 1 if loop.step is None else self.types.constant(loop.step)
        turns = range(low, high + (1 if by > 0 else -1), by)
        name = loop.control.name.upper()
        now: State = self.written(loop.control, state)
        exits: list[State] = []
        arrays = any(isinstance(self.unit.variables[key].type, Array) for key in self.begins)
        for number in turns if arrays else turns[:1]:
            if now is None:
                break
            before = self.numbers.get(name)
            self.numbers[name] = number
            self.left.append(([], []))
            end = self.body(loop.body, now)
            left, again = self.left.pop()
            exits += left
            now = _met(end, *again)
            self.numbers.pop(name)
            if before is not None:
                self.numbers[name] = before
        return _met(now, *exits)

    def call(self, call: Call, state: frozenset[str]) -> State:
        """What is lent to VAR_IN_OUT counts as read."""
        own = function_of(self.source, self.unit, call)
        if own is not None:
            inputs, outputs = handed_to_function(own, call)
        else:
            kind = self.types.of(call.instance)
            assert isinstance(kind, Instance)
            inputs, outputs = handed_to_block(self.source, kind, call)
            self.read(call.instance, state)
        for _, value in inputs:
            self.read(value, state)
        for _, target in outputs:
            state = self.written(target, state)
        return state

    # ------------------------------------------------------------ values

    def read(self, expression: Expression, state: frozenset[str]) -> None:
        """Refuse an expression that needs what is not set."""
        match expression:
            case Name() | Member() | Index() | Bit():
                for index in _indexes(expression):
                    self.read(index, state)
                key = root_of(expression)
                if any(spot not in state for spot in self.spots(expression, exact=False)):
                    text = (
                        "may be read before it is written in this call; SCL leaves it undefined: set it first"
                    )
                    raise expression.place.refuse(f"{self.unit.variables[key].name} {text}")
            case Unary(_, operand, _):
                self.read(operand, state)
            case Binary(_, left, right, _):
                self.read(left, state)
                self.read(right, state)
            case Function(_, arguments, _):
                for _, value in arguments:
                    self.read(value, state)

    def written(self, target: Expression, state: frozenset[str]) -> frozenset[str]:
        """The state after a target is written; a bit is written into what must be there."""
        for index in _indexes(target):
            self.read(index, state)
        if isinstance(target, Bit):
            self.read(target.of, state)
        return state.union(self.spots(target, exact=True))

    def spots(self, target: Expression, exact: bool) -> list[str]:
        """The values in a target that a call begins without; exact: none where an index is not known."""
        of = target.of if isinstance(target, Bit) else target
        path = self.path(of)
        if path is None:
            return [] if exact else self.begins.get(root_of(of), [])
        every = self.begins.get(root_of(of), [])
        return [spot for spot in every if spot == path or spot.startswith((f"{path}.", f"{path}["))]

    def path(self, target: Expression) -> str | None:
        """Where a target lies; None: an index in it is not known."""
        match target:
            case Name(name, _):
                return name.upper()
            case Member(of, name, _):
                above = self.path(of)
                return None if above is None else f"{above}.{name.upper()}"
            case Index(of, index, _):
                above, number = self.path(of), self.number(index)
                return None if above is None or number is None else f"{above}[{number}]"
        return None

    def number(self, index: Expression) -> int | None:
        """An index that is known at this turn."""
        match index:
            case Name(name, _) if name.upper() in self.numbers:
                return self.numbers[name.upper()]
            case Binary("+" | "-" as sign, left, right, _):
                one, other = self.number(left), self.number(right)
                return None if one is None or other is None else one + (other if sign == "+" else -other)
            case Literal(value, _, _):
                return int(value)
        try:
            return self.types.constant(index)
        except Unjudged:
            return None


def _indexes(target: Expression) -> Iterator[Expression]:
    """The indexes in a target."""
    while isinstance(target, Member | Index | Bit):
        if isinstance(target, Index):
            yield target.index
        target = target.of

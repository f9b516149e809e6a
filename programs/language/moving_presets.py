"""Timers whose preset time PT may change while they run: tools differ in when the new one counts.

A preset stays if every call of the timer gives the same expression, made of constants and of inputs that
stay: parameters of the program, or an input of a block that stays in each call of each of its instances.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from programs.language.calls import function_of, handed_to_block, inner_bodies
from programs.language.tree import (
    Assign,
    Binary,
    Bit,
    Body,
    Call,
    Expression,
    Function,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Source,
    Unary,
    Unit,
)
from programs.language.types import Types

TIMERS = ("TON", "TOF", "TP")


def moving(source: Source, unit: Unit, units: Sequence[Unit], steady: Collection[str]) -> list[str]:
    """These timers, each as `BLOCK.timer`. units: all reached ones; steady: inputs of `unit` that stay."""
    every = _Presets(source, unit, units, frozenset(steady))
    return [
        f"{where.name}.{path}"
        for kind in TIMERS
        for where, path, stays in every.given(kind, "PT")
        if not stays
    ]


@dataclass
class _Presets:
    """What calls give to the inputs of blocks."""

    source: Source
    unit: Unit
    units: Sequence[Unit]
    steady: frozenset[str]
    inputs: dict[tuple[str, str], bool] = field(default_factory=dict)
    """Of inputs of blocks: whether they stay; FALSE while that is being found out."""

    def given(self, block: str, pin: str) -> Iterator[tuple[Unit, str, bool]]:
        """For each instance of a block that is called, or whose pin is written: whether its pin stays."""
        for unit in self.units:
            types = Types(self.source, unit)
            found: dict[str, list[Expression | None]] = defaultdict(list)
            outer = set(map(id, unit.body))
            first: set[str] = set()  # those whose pin is given by a call before all others, in every scan
            for statement in _statements(unit.body):
                if isinstance(statement, Call) and function_of(self.source, unit, statement) is None:
                    kind = types.of(statement.instance)
                    assert isinstance(kind, Instance)
                    inputs, outputs = handed_to_block(self.source, kind, statement)
                    if kind.block.upper() == block:
                        values = {name.upper(): value for name, value in inputs}
                        path = _path(statement.instance)
                        always = id(statement) in outer and "[]" not in path
                        if always and pin in values and path not in found:
                            first.add(path)
                        if pin in values or not (path in first or _at_rest(block, values)):
                            found[path].append(values.get(pin))
                    written: list[Expression] = [target for _, target in outputs]
                elif isinstance(statement, Call):
                    written = [target for _, target in statement.outputs]
                else:
                    written = [statement.target] if isinstance(statement, Assign) else []
                for target in written:
                    pins = (pin, "IN") if block in TIMERS else (pin,)
                    if isinstance(target, Member) and target.name.upper() in pins:
                        kind = types.of(target.of)
                        if isinstance(kind, Instance) and kind.block.upper() == block:
                            found[_path(target.of)] += [target, None]  # written beside the calls
            for path, every in found.items():
                yield unit, path, self.same(unit, every)

    def same(self, unit: Unit, values: Sequence[Expression | None]) -> bool:
        """Whether all calls give one value that stays; nothing at all is 0 for ever."""
        if all(value is None for value in values):
            return True
        first = values[0]
        alike = all(_bare(value) == _bare(first) for value in values)
        return alike and first is not None and self.stays(unit, first)

    def stays(self, unit: Unit, expression: Expression) -> bool:
        """Whether an expression has the same value in every scan."""
        match expression:
            case Literal():
                return True
            case Name(name, _):
                variable = unit.variables.get(name.upper())
                if variable is None or variable.section == "constant":
                    return True  # a member of an enumeration
                if unit.name == self.unit.name:
                    return name.upper() in self.steady
                return variable.section == "input" and self.input_stays(unit.name.upper(), name.upper())
            case Member(of, _, _):
                own = unit.name == self.unit.name and _path(expression) in self.steady
                return own or self.stays(unit, of)
            case Index(of, index, _):
                return self.stays(unit, of) and self.stays(unit, index)
            case Bit(of, _, _) | Unary(_, of, _):
                return self.stays(unit, of)
            case Binary(_, left, right, _):
                return self.stays(unit, left) and self.stays(unit, right)
            case Function(_, arguments, _):
                return all(self.stays(unit, value) for _, value in arguments)
        return False

    def input_stays(self, block: str, pin: str) -> bool:
        """Whether an input of a block stays in each of its instances."""
        if (block, pin) not in self.inputs:
            self.inputs[block, pin] = False
            self.inputs[block, pin] = all(stays for _, _, stays in self.given(block, pin))
        return self.inputs[block, pin]


def _at_rest(block: str, values: Mapping[str, Expression]) -> bool:
    """Whether a call cannot start a timer: what runs was started by a call that gives PT."""
    signal = values.get("IN")
    return block in TIMERS and (signal is None or (isinstance(signal, Literal) and not signal.value))


def _statements(body: Body) -> Iterator[Any]:
    for statement in body:
        yield statement
        for inner in inner_bodies(statement):
            yield from _statements(inner)


def _path(expression: Expression) -> str:
    """A variable as text in upper case; all elements of an array are one."""
    match expression:
        case Name(name, _):
            return name.upper()
        case Member(of, name, _):
            return f"{_path(of)}.{name.upper()}"
        case Index(of, _, _):
            return f"{_path(of)}[]"
    return "?"


def _bare(node: Any) -> Any:
    """An expression without its places."""
    if isinstance(node, tuple):
        return tuple(map(_bare, node))
    if not hasattr(node, "place"):
        return node.upper() if isinstance(node, str) else node
    return type(node).__name__, tuple(_bare(part) for key, part in vars(node).items() if key != "place")

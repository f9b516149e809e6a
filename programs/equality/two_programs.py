"""Two programs on the same inputs as one program, whose outputs say whether both give the same.

It says which inputs and outputs belong together, or all that do not, with a binding to begin with.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.language.memory import leaves
from programs.language.shared_memory import completed
from programs.language.subset import check, reached
from programs.language.tree import (
    BOOL,
    Array,
    Assign,
    Binary,
    Call,
    Expression,
    Function,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Statement,
    Struct,
    Type,
    Unit,
    Variable,
    shown,
)
from programs.semantics.document_blocks import check_parameters, with_blocks
from programs.semantics.value_paths import steps as parts_of

NEW, OLD, CLOCK = "NEW", "OLD", "DT_MS"


@dataclass(frozen=True)
class Names:
    """What the file of a binding says. names: of the new program to those of the old one."""

    names: Mapping[str, str] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    constant: tuple[str, ...] = ()
    """Inputs that keep their first value."""
    unless: Expression | None = None
    unless_text: str = ""


@dataclass(frozen=True)
class Pair:
    """Both programs, and which inputs and outputs belong together (in upper case, new to old)."""

    source: Source
    new: Unit
    old: Unit
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    names: Names

    @staticmethod
    def of(new: tuple[Source, Unit], old: tuple[Source, Unit], names: Names) -> Pair:
        """Both, looked through. Raises Unjudged: with all names that do not fit, if it is that."""
        first, second = _looked_through(*new), _looked_through(*old)
        renamed = _Renamed(second[0], second[1]).source()
        for key in sorted(first[0].units.keys() & renamed.units.keys()):
            raise (
                first[0]
                .units[key]
                .place.refuse(f"{key}: give this unit another name beside {second[1].name}")
            )
        units = {**first[0].units, **renamed.units}
        units[first[1].name.upper()] = replace(first[1], kind="function block")
        before = renamed.units[f"{OLD}_{second[1].name}".upper()]
        units[before.name.upper()] = before = replace(before, kind="function block")
        files = {**second[0].files, **first[0].files}
        inputs, outputs = matched(first[1], second[1], names)
        source = Source(units, files)
        found = Pair(source, units[first[1].name.upper()], before, inputs, outputs, names)
        check(source, found.unit)
        return found

    @cached_property
    def unit(self) -> Unit:
        """Both as one program."""
        place = self.new.place
        variables: dict[str, Variable] = {}
        body: list[Statement] = []
        for key in self.inputs:
            found = self.new.variables[key]
            if key in (NEW, OLD):
                raise found.place.refuse(f"an input {key} is not supported here; give it another name")
            variables[key] = Variable(found.name, found.type, "input", None, place)
        if self.clock is not None:
            variables[CLOCK] = replace(self.clock, section="input", initial=None)
        for name, unit in ((NEW, self.new), (OLD, self.old)):
            variables[name] = Variable(name, Instance(unit.name), "var", None, place)
            given = [
                (key if name == NEW else other, Name(self.new.variables[key].name, place))
                for key, other in self.inputs.items()
            ]
            given += [(CLOCK, Name(CLOCK, place))] if CLOCK in unit.variables and self.clock else []
            body.append(Call(Name(name, place), tuple(given), (), place))
        for number, (_, left, right) in enumerate(self.compared):
            same: Expression = Binary("=", left, right, place)
            if self.names.unless is not None:
                same = Binary("OR", same, self.names.unless, place)
            name = f"SAME_{number}"
            variables[name] = Variable(name, BOOL, "output", None, place)
            body.append(Assign(Name(name, place), same, place))
        return Unit("both programs", "program", variables, tuple(body), place)

    @cached_property
    def clock(self) -> Variable | None:
        """The input for the time since the scan before; of two the one that holds less."""
        found = [clock for unit in (self.new, self.old) if (clock := clock_of(unit)) is not None]
        return min(found, key=lambda one: one.type.high if isinstance(one.type, Scalar) else 0, default=None)

    @cached_property
    def constant(self) -> frozenset[str]:
        """The inputs that keep their first value."""
        return frozenset(name.upper() for name in self.names.constant)

    @cached_property
    def compared(self) -> list[tuple[str, Expression, Expression]]:
        """Each single value that is compared: its path in the new program, and what both give."""
        place, found = self.new.place, []
        for key, other in self.outputs.items():
            kind = self.new.variables[key].type
            for leaf in leaves(kind):
                sides = [
                    _part(Member(Name(side, place), of, place), kind, leaf, place)
                    for side, of in ((NEW, key), (OLD, other))
                ]
                found.append((f"{self.new.variables[key].name}{leaf}", sides[0], sides[1]))
        return found


def _part(of: Expression, kind: Type, leaf: str, place: Place) -> Expression:
    """A single value within a variable."""
    for step in parts_of(leaf):
        if isinstance(kind, Array):
            of, kind = Index(of, Literal(int(step), None, place), place), kind.element
        else:
            assert isinstance(kind, Struct)
            member = kind.member(step)
            assert member is not None
            of, kind = Member(of, step, place), member
    return of


def _looked_through(source: Source, unit: Unit) -> tuple[Source, Unit]:
    """A program with its globals and the documents' blocks. Raises Unjudged."""
    every = with_blocks(source)
    found = completed(every, unit)
    check(every, found)
    for part in reached(every, found, ()):
        check_parameters(every, part)
    units = {**every.units, found.name.upper(): found}
    return replace(every, units=units), found


class _Renamed:
    """A program whose units have a prefix, so that those of another one can be beside them."""

    def __init__(self, source: Source, unit: Unit) -> None:
        self.source_of, self.top = source, unit

    def source(self) -> Source:
        units = {}
        for unit in self.source_of.units.values():
            made = self.unit(unit)
            units[made.name.upper()] = made
        return replace(self.source_of, units=units)

    def name(self, name: str) -> str:
        return f"{OLD}_{name}" if name.upper() in self.source_of.units else name

    def unit(self, unit: Unit) -> Unit:
        result = unit.name.upper() if unit.kind == "function" else ""
        variables = {}
        for key, variable in unit.variables.items():
            made = replace(variable, type=self.type(variable.type))
            if key == result:
                made = replace(made, name=self.name(variable.name))
            variables[made.name.upper()] = made
        body = tuple(self.inner(part, unit, result) for part in unit.body)
        return replace(unit, name=self.name(unit.name), variables=variables, body=body)

    def type(self, kind: Type) -> Type:
        match kind:
            case Instance(block):
                return Instance(self.name(block))
            case Array(low, high, element):
                return Array(low, high, self.type(element))
            case Struct(name, members):
                return Struct(name, tuple((own, self.type(of), value) for own, of, value in members))
        return kind

    def inner(self, part: Any, unit: Unit, result: str) -> Any:
        """A part of a body with the new names of functions."""
        if isinstance(part, tuple):
            return tuple(self.inner(one, unit, result) for one in part)
        if not hasattr(part, "place"):
            return part
        made = type(part)(**{name: self.inner(value, unit, result) for name, value in vars(part).items()})
        match made:
            case Name(name, place) if result and name.upper() == result:
                return Name(self.name(name), place)
            case Function(name, arguments, place):
                return Function(self.name(name).upper(), arguments, place)
            case Call(Name(name, at), inputs, outputs, place) if name.upper() not in unit.variables:
                outs = tuple(
                    (self.name(own) if own.upper() == name.upper() else own, to) for own, to in outputs
                )
                return Call(Name(self.name(name), at), inputs, outs, place)
        return made


# ---------------------------------------------------------------- names


def matched(new: Unit, old: Unit, names: Names) -> tuple[dict[str, str], dict[str, str]]:
    """Which inputs and outputs belong together, in upper case, new to old.

    Raises Unjudged with everything that does not fit, and a binding to paste.
    """
    found: list[dict[str, str]] = []
    wrong: list[str] = []
    paste: list[str] = []
    given = {ours.upper(): theirs.upper() for ours, theirs in names.names.items()}
    left = {name.upper() for name in names.left_out}
    for section in ("input", "output"):
        ours, theirs = (
            {key: one for key, one in unit.of_keys(section).items() if one is not clock_of(unit)}
            for unit in (new, old)
        )
        pairs = {key: given.get(key, key) for key in ours if given.get(key, key) in theirs}
        found.append({key: other for key, other in pairs.items() if section == "input" or key not in left})
        for key, other in pairs.items():
            if not _alike(ours[key].type, theirs[other].type):
                kinds = shown(ours[key].type), shown(theirs[other].type)
                wrong.append(f"{section} {ours[key].name} is {kinds[0]}, and {kinds[1]} in the old program")
        spare = [old.variables[key] for key in theirs if key not in pairs.values() and key not in left]
        lone = [new.variables[key] for key in ours if key not in pairs and key not in left]
        wrong += [f"the new program has no {section} {one.name}" for one in spare]
        if section == "input" or spare:
            wrong += [f"the old program has no {section} {one.name}" for one in lone]
        near = list(spare)
        for one in lone if section == "input" or spare else ():
            fits = [other for other in near if _alike(one.type, other.type)]
            same = [other for other in fits if _plain(other.name) == _plain(one.name)]
            if chosen := next(iter(same or fits), None):
                near.remove(chosen)
                paste.append(f'{one.name} = "{chosen.name}"')
    known = {*new.of_keys("input"), *new.of_keys("output")}
    before = {*old.of_keys("input"), *old.of_keys("output")}
    wrong += [
        f"the binding names {name}, which the new program has not" for name in given if name not in known
    ]
    wrong += [
        f"the binding names {one}, which the old program has not"
        for one in given.values()
        if one not in before
    ]
    unknown = [name for name in left if name not in known | before]
    wrong += [f"left_out names {name}, which no program has" for name in unknown]
    wrong += [f"{name} is no input" for name in names.constant if name.upper() not in found[0]]
    if wrong:
        advice = f"; a binding to begin with: names = {{ {', '.join(paste)} }}" if paste else ""
        raise Unjudged(f"{new.name} against {old.name}: {'; '.join(wrong)}{advice}")
    if not found[1]:
        raise Unjudged(f"{new.name} against {old.name}: no output is compared")
    return found[0], found[1]


def clock_of(unit: Unit) -> Variable | None:
    """The input of a program that has the time since the scan before."""
    found = unit.of_keys("input").get(CLOCK)
    fits = found is not None and isinstance(found.type, Scalar) and found.type.kind in ("int", "time")
    return found if fits else None


def _plain(name: str) -> str:
    return name.upper().replace("_", "").removesuffix("MS")


def _alike(one: Type, other: Type) -> bool:
    """Whether two variables hold the same values."""
    if isinstance(one, Scalar) and isinstance(other, Scalar):
        mine, theirs = (replace(kind, name="", base=None) for kind in (one, other))
        return mine == theirs
    if isinstance(one, Array) and isinstance(other, Array):
        return (one.low, one.high) == (other.low, other.high) and _alike(one.element, other.element)
    return one == other

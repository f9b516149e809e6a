"""Globals: one memory that all units of a program share.

`linked` gives each unit the globals that it names, as variables of the section `external` (a CONSTANT is one
of the unit's own). `completed` makes them variables of the unit that is judged: what no unit below it writes
is an input, which may have any value in each scan; what is written is an output, and remembered.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from programs.language.addresses import Addresses, area_of
from programs.language.calls import (
    Pairs,
    function_of,
    handed_to_block,
    handed_to_function,
    inner_bodies,
    names_in,
)
from programs.language.subset import reached
from programs.language.tree import (
    Body,
    Call,
    For,
    Function,
    Instance,
    Member,
    Name,
    Place,
    Source,
    Unit,
    Variable,
    blocks_in,
    root_of,
    shown,
)
from programs.language.types import Types

NOT_THERE = "?"
"""The list of a global that no file declares."""
NOWHERE = "{} is declared in no file that is given: any value at power-up, and nobody else writes it"


# ---------------------------------------------------------------- who means which


def linked(units: Mapping[str, Unit], declared: Sequence[Variable]) -> dict[str, Unit]:
    """The units with the globals that they name. Raises Unjudged: it is not clear which one is meant."""
    found = _Globals.of(units, declared)
    return {key: found.unit(unit) if found.known else unit for key, unit in units.items()}


def _own(unit: Unit) -> Iterator[str]:
    """The variables that a unit has for itself, in upper case."""
    for key, variable in unit.variables.items():
        if variable.section != "external" or variable.address:
            yield key


@dataclass
class _Globals:
    """The globals by their names in upper case, each with its list, and the names that they get."""

    known: dict[tuple[str, str], Variable] = field(default_factory=dict)
    by_name: dict[str, list[tuple[str, str]]] = field(default_factory=dict)

    @staticmethod
    def of(units: Mapping[str, Unit], declared: Sequence[Variable]) -> _Globals:
        """Those that are declared, and what VAR_EXTERNAL names besides."""
        every = list(declared)
        there = {one.name.upper() for one in every}
        for unit in units.values():
            for name, variable in unit.variables.items():
                if variable.section == "external" and not variable.address and name not in there:
                    every.append(replace(variable, section="global", retained=True, group=NOT_THERE))
                    there.add(name)
        names = Counter(one.name.upper() for one in every)
        taken = {key for unit in units.values() for key in _own(unit)}
        blocks = {key for unit in units.values() if unit.kind != "function" for key in _own(unit)}
        found = _Globals()
        for one in every:
            key = one.group.upper(), one.name.upper()
            if key in found.known:
                raise one.place.refuse(f"the global {one.name} is declared twice")
            clear = names[key[1]] == 1 and key[1] not in (taken if one.group else blocks)
            own = one.name if clear else f"{one.group.strip(NOT_THERE) or 'GLOBAL'}__{one.name}"
            section = one.section if one.section == "constant" else "external"
            if own.upper() in {other.name.upper() for other in found.known.values()}:
                raise one.place.refuse(f"the global {own} stands for two: rename one")
            found.known[key] = replace(one, name=own, section=section)
            found.by_name.setdefault(key[1], []).append(key)
        return found

    @property
    def lists(self) -> set[str]:
        """The lists of globals that have a name."""
        return {group for group, _ in self.known} - {"", NOT_THERE}

    def unit(self, unit: Unit) -> Unit:
        """The unit with the globals that it names."""
        of = _Linked(self, unit, {key: unit.variables[key] for key in _own(unit)})
        for key, variable in unit.variables.items():
            if key not in of.variables:
                of.external(variable)
        body = of.inner(unit.body)
        return replace(unit, variables=of.variables, body=body)


@dataclass
class _Linked:
    """One unit whose names of globals are looked up."""

    globals: _Globals
    unit: Unit
    variables: dict[str, Variable]

    def external(self, variable: Variable) -> None:
        """Look at a declaration in VAR_EXTERNAL."""
        found = self.globals.known[self.one(variable.name.upper(), variable.place)]
        same = found.type == variable.type
        if isinstance(found.type, Instance) and isinstance(variable.type, Instance):
            same = found.type.block.upper() == variable.type.block.upper()
        if not same:
            raise variable.place.refuse(
                f"{variable.name} is {shown(variable.type)} here, and the global is {shown(found.type)}"
            )
        kept = found.retained or variable.retained
        self.variables[found.name.upper()] = replace(found, retained=kept)

    def one(self, name: str, place: Place) -> tuple[str, str]:
        """The global of this name."""
        keys = self.globals.by_name[name]
        if len(keys) > 1:
            lists = " or ".join(f"{group}.{name}" if group else name for group, _ in keys)
            raise place.refuse(f"{name}: which global is meant? {lists}")
        return keys[0]

    def named(self, key: tuple[str, str], place: Place) -> Name:
        """A global as a variable of this unit."""
        found = self.globals.known[key]
        self.variables.setdefault(found.name.upper(), found)
        return Name(found.name, place)

    def inner(self, part: Any) -> Any:
        """A part of a body with the names that globals have here."""
        if isinstance(part, tuple):
            return tuple(self.inner(one) for one in part)
        if not hasattr(part, "place"):
            return part
        match part:
            case Name(name, place) if (
                name.upper() not in self.locals and name.upper() in self.globals.by_name
            ):
                for kind in self.unit.enumerations.values():
                    if kind.kind == "enum" and kind.member(name) is not None:
                        raise place.refuse(f"{name} is a global and a member of {kind.name}; rename one")
                return self.named(self.one(name.upper(), place), place)
            case Member(Name(group, _), name, place) if (
                group.upper() in self.globals.lists and group.upper() not in self.locals
            ):
                key = group.upper(), name.upper()
                if key not in self.globals.known:
                    there = [own.name for (of, _), own in self.globals.known.items() if of == key[0]]
                    raise place.refuse(f"{group} has no {name}; {suggestion(name, there)}")
                return self.named(key, place)
        return type(part)(**{name: self.inner(value) for name, value in vars(part).items()})

    @property
    def locals(self) -> set[str]:
        """What the unit declares for itself."""
        return set(_own(self.unit))


def asked(part: Any, unit: Unit) -> Any:
    """An expression about a completed unit, with the names that its globals have there."""
    if isinstance(part, tuple):
        return tuple(asked(one, unit) for one in part)
    if not hasattr(part, "place"):
        return part
    if isinstance(part, Name) and part.name.upper() not in unit.variables:
        found = unit.variables.get(f"GLOBAL__{part.name.upper()}")
        return part if found is None else Name(found.name, part.place)
    if isinstance(part, Member) and isinstance(part.of, Name) and part.of.name.upper() not in unit.variables:
        group, name = part.of.name.upper(), part.name.upper()
        for key, variable in unit.variables.items():
            if variable.group.upper() == group and key in (name, f"{group}__{name}"):
                return Name(variable.name, part.place)
    return type(part)(**{name: asked(value, unit) for name, value in vars(part).items()})


# ---------------------------------------------------------------- whose memory it is


def completed(source: Source, unit: Unit) -> Unit:
    """The unit that is judged, with all globals that it or a unit below it names as its own variables.

    Raises Unjudged: another program writes what this one writes; a unit writes an input; two ways lead to
    one variable in a call.
    """
    if unit.whole:
        return unit
    every = list(reached(source, unit, ()))
    shared = {key: variable for found in every for key, variable in found.of_keys("external").items()}
    placed = [variable for variable in unit.variables.values() if variable.address]
    if not shared and not placed:
        return unit
    uses = _Uses(source)
    for found in every:
        uses.check(found)
    written = uses.written(every)
    _check_others(source, unit, every, shared, uses)
    addresses = Addresses()
    variables = dict(unit.variables)
    notes = list(unit.notes)
    every_one = {**{one.name.upper(): one for one in placed}, **shared}
    for variable in sorted(every_one.values(), key=lambda one: one.name.upper() not in written):
        key, area = variable.name.upper(), ""
        if variable.address:
            area = area_of(variable.address, variable.type, variable.place)
            # what nobody writes may share bits: then it has fewer values than are looked at
            addresses.take(variable.address, variable.name, variable.place, key in written)
        if area == "I" and key in written:
            raise variable.place.refuse(f"{variable.name} is at {variable.address}, an input, and is written")
        section, kept = "output" if key in written else "input", variable.retained
        if any(blocks_in(variable.type)):
            if key not in written:
                raise variable.place.refuse(f"{variable.name}: no unit that belongs to {unit.name} calls it")
            section = "var"
        if area == "M" and variable.initial is None:
            kept = True  # memory of the controller may be kept without power
        if section == "output" and variable.group == NOT_THERE:
            notes.append(NOWHERE.format(variable.name))
        variables[key] = replace(variable, section=section, retained=kept and section != "input")
    return replace(unit, variables=variables, notes=tuple(notes), whole=True)


def _check_others(
    source: Source, unit: Unit, every: Sequence[Unit], shared: Mapping[str, Variable], uses: _Uses
) -> None:
    """Refuse what is written here, and by a unit that does not belong to the program that is judged."""
    own = {found.name.upper() for found in every}
    written = {key for key in uses.written(every) if key in shared or unit.variables[key].address}
    if not written:
        return
    names = {(unit.variables.get(key) or shared[key]).name.upper().rpartition("__")[2] for key in written}
    placed = any((unit.variables.get(key) or shared[key]).address for key in written)
    for name, refusal in source.refused.items():
        words = source.words.get(name)
        if words is None or names & words or (placed and any(word.startswith("%") for word in words)):
            there = {key for key in written if words is not None and key.rpartition("__")[2] in words}
            which = ", ".join(sorted(there or written)[:3])
            raise Unjudged(f"{refusal.message}; and {name} might write {which}, as {unit.name} does")
    spots = Addresses()
    for key in sorted(written):
        variable = unit.variables.get(key) or shared[key]
        if variable.address:
            spots.take(variable.address, variable.name, variable.place)
    for key, other in source.units.items():
        if key in own:
            continue
        theirs = uses.written([other])
        for name in sorted(theirs):
            variable = other.variables[name]
            if variable.section == "external" and not variable.address and name in written & set(shared):
                text = f"{variable.name} is written by {other.name} too, which {unit.name} does not call"
                raise unit.place.refuse(f"{text}; take a program that calls both")
            if variable.address:
                spots.take(variable.address, f"{variable.name} of {other.name}", variable.place)


@dataclass
class _Uses:
    """What units do with variables of the section `external`."""

    source: Source
    written_by: dict[str, set[str]] = field(default_factory=dict)
    touched_by: dict[str, set[str]] = field(default_factory=dict)

    def written(self, units: Iterable[Unit]) -> set[str]:
        """The globals, and variables at addresses, that the units themselves write."""
        found: set[str] = set()
        for unit in units:
            if unit.name not in self.written_by:
                marked = {k for k, v in unit.variables.items() if v.section == "external" or v.address}
                self.written_by[unit.name] = marked & set(self.targets(unit, unit.body))
            found |= self.written_by[unit.name]
        return found

    def touched(self, unit: Unit) -> set[str]:
        """The globals that a unit or one below it names."""
        if unit.name not in self.touched_by:
            below = reached(self.source, unit, ())
            self.touched_by[unit.name] = {key for found in below for key in found.of_keys("external")}
        return self.touched_by[unit.name]

    def targets(self, unit: Unit, body: Body) -> Iterator[str]:
        """The variables that a body changes, by their roots."""
        for statement in body:
            match statement:
                case Call(instance, _, _, _):
                    own = self.callee(unit, statement)
                    if function_of(self.source, unit, statement) is None:
                        yield root_of(instance)
                    inputs, outputs = self.handed(unit, statement)
                    lent = () if own is None else own.of_keys("in_out")
                    yield from (root_of(value) for name, value in inputs if name.upper() in lent)
                    yield from (root_of(target) for _, target in outputs)
                case For(control, _, _, _, _, _):
                    yield root_of(control)
                case _ if hasattr(statement, "target"):
                    yield root_of(statement.target)
            for inner in inner_bodies(statement):
                yield from self.targets(unit, inner)

    def handed(self, unit: Unit, call: Call) -> tuple[Pairs, Pairs]:
        """The inputs and the outputs of a call with their names."""
        if (own := function_of(self.source, unit, call)) is not None:
            return handed_to_function(own, call)
        kind = Types(self.source, unit).of(call.instance)
        if not isinstance(kind, Instance):
            raise call.place.refuse("only an instance of a block is called")
        return handed_to_block(self.source, kind, call)

    def callee(self, unit: Unit, call: Call) -> Unit | None:
        """The unit of the program's own that is called."""
        own = function_of(self.source, unit, call)
        if own is None:
            kind = Types(self.source, unit).of(call.instance)
            own = self.source.units.get(kind.block.upper()) if isinstance(kind, Instance) else None
        return own

    def check(self, unit: Unit) -> None:
        """Refuse two ways to one global in a call, and a FUNCTION in an expression that writes one."""
        for part in _parts(unit.body):
            if isinstance(part, Function | Call):
                self.check_references(unit, part)
            if isinstance(part, Function):
                called = self.source.units.get(part.name.upper())
                if called is not None and called.kind == "function":
                    written = self.written(reached(self.source, called, ()))
                    if written:
                        which = ", ".join(sorted(written))
                        raise part.place.refuse(f"{part.name} writes {which}: call it as a statement")
            if isinstance(part, Call) and (own := self.callee(unit, part)) is not None:
                lent = own.of_keys("in_out")
                shared = set(unit.of_keys("external")) & self.touched(own)
                for name, value in self.handed(unit, part)[0]:
                    if name.upper() in lent and root_of(value) in shared:
                        raise part.place.refuse(
                            f"{own.name} uses {root_of(value)}, and this call lends it: two ways to one"
                        )

    def check_references(self, unit: Unit, part: Function | Call) -> None:
        """Refuse a global that goes in or out of a FUNCTION of S7 which uses it too: it may be no copy."""
        given: Pairs = ()
        got: Pairs = ()
        if isinstance(part, Function):
            own, given = self.source.units.get(part.name.upper()), part.arguments
        else:
            own = function_of(self.source, unit, part)
            given, got = self.handed(unit, part) if own is not None else ((), ())
        if own is None or own.kind != "function" or own.fresh:
            return
        shared = set(unit.of_keys("external"))
        written, touched = self.written(reached(self.source, own, ())), self.touched(own)
        ins = {name for _, value in given for name in names_in(value)} & shared & written
        outs = {root_of(target) for _, target in got} & shared & touched
        for name in sorted(ins | outs):
            text = f"{own.name} uses {unit.variables[name].name}, and this call hands it over"
            raise part.place.refuse(f"{text}: S7 may take the variable itself, or a copy")


def _parts(node: Any) -> Iterator[Any]:
    if isinstance(node, tuple):
        for part in node:
            yield from _parts(part)
    elif hasattr(node, "place"):
        yield node
        for part in vars(node).values():
            yield from _parts(part)

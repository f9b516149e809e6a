"""A look at every statement of a program, and the refusal of what is not in the subset."""

from __future__ import annotations

from collections.abc import Iterator

from modeproof.ground.errors import suggestion
from programs.calls import called_functions, check_function, in_outs, inner_bodies, sides
from programs.length import check_length
from programs.standard import BLOCKS
from programs.tree import (
    Array,
    Assign,
    Body,
    Call,
    Case,
    Expression,
    For,
    If,
    Index,
    Instance,
    Member,
    Name,
    Place,
    Return,
    Scalar,
    Source,
    Stop,
    Unit,
)
from programs.types import Types

MOST_TURNS = 1000
DEEPEST = 20
"""Blocks within blocks."""


def check(source: Source, unit: Unit) -> None:
    """Look at every statement of a unit and of the units below it. Raises Unjudged with file and line."""
    if unit.kind == "function":
        raise unit.place.refuse(f"{unit.name} is a FUNCTION: it has no memory to be compared")
    for name, variable in unit.of("in_out").items():
        raise variable.place.refuse(f"{name} is VAR_IN_OUT: take a program that calls {unit.name}")
    if not unit.of("output"):
        raise unit.place.refuse(f"{unit.name} has no VAR_OUTPUT, so there is nothing to compare")
    check_below(source, unit)


def check_below(source: Source, unit: Unit) -> None:
    """The same for the statements alone, those of a FUNCTION too. Raises Unjudged with file and line."""
    every = list(reached(source, unit, ()))
    for found in every:
        if found.kind == "function":
            check_function(found)
    check_length(source, unit)
    for found in every:
        _Statements(source, found).body(found.body)


def reached(source: Source, unit: Unit, above: tuple[str, ...]) -> Iterator[Unit]:
    """The unit and every unit that it has an instance of, each once."""
    return _reached(source, unit, above, set())


def _reached(source: Source, unit: Unit, above: tuple[str, ...], seen: set[str]) -> Iterator[Unit]:
    if unit.name in above or len(above) > DEEPEST:
        raise unit.place.refuse(f"{' calls '.join((*above, unit.name))}: a block must not contain itself")
    if unit.name in seen:
        return
    seen.add(unit.name)
    yield unit
    named = (source.units.get(name) for name in called_functions(unit.body))
    below = [found for found in named if found is not None and found.kind == "function"]
    for variable in unit.variables.values():
        kind = variable.type
        if isinstance(kind, Array) and not isinstance(kind.element, Scalar):
            what = "blocks" if isinstance(kind.element, Instance) else "arrays"
            raise variable.place.refuse(f"{variable.name}: an array of {what} is not supported")
        if isinstance(kind, Instance) and kind.block.upper() not in BLOCKS:
            instance = source.find(kind.block)
            if instance is None:
                raise variable.place.refuse(
                    f"{variable.name}: no type or block {kind.block!r} is known; "
                    + suggestion(kind.block, [*BLOCKS, *(found.name for found in source.units.values())])
                )
            below.append(instance)
        if isinstance(kind, Instance) and variable.section != "var":
            raise variable.place.refuse(f"{variable.name}: an instance of a block stands in VAR here")
    for inner in below:
        yield from _reached(source, inner, (*above, unit.name), seen)


class _Statements(Types):
    """The statements of one unit."""

    def body(self, body: Body) -> None:
        """Look at every statement."""
        for statement in body:
            match statement:
                case Assign(target, value, place):
                    self.assigned(target, value, place)
                case If(branches, otherwise, place):
                    for asked, inner in branches:
                        self.scalar(asked, place, ("bool",))
                        self.body(inner)
                    self.body(otherwise)
                case Case(subject, clauses, otherwise, place):
                    kind = self.scalar(subject, place, ("int", "enum", "bits"))
                    for ranges, inner in clauses:
                        for end in (end for pair in ranges for end in pair):
                            label = self.scalar(end, place, (kind.kind,), kind)
                            if kind.kind == "enum" and label != kind:
                                raise place.refuse("a label of CASE is of another type")
                            self.constant(end)
                        self.body(inner)
                    self.body(otherwise)
                case For(control, start, end, step, inner, place):
                    kind = self.scalar(control, place, ("int",))
                    for bound in (start, end, *([] if step is None else [step])):
                        self.scalar(bound, place, ("int",), kind)
                    by = 1 if step is None else self.constant(step)
                    self.turns(control, self.constant(start), self.constant(end), by)
                    if any(self.writes(inner, control.name)):
                        raise place.refuse(f"the loop writes its control variable {control.name}")
                    self.body(inner)
                case Call(instance, inputs, outputs, place):
                    self.call(instance, inputs, outputs, place)
                case Return() | Stop():
                    pass

    def turns(self, control: Name, low: int, high: int, by: int) -> None:
        """Refuse a loop that is too long, or after which its control variable is outside its type."""
        kind = self.written(control, control.place)
        if by == 0 or abs(high - low) // abs(by) > MOST_TURNS:
            raise control.place.refuse(f"FOR: at most {MOST_TURNS:,} turns, and a step other than 0")
        for value in (low, high, high + by):
            self.fits(value, kind, control.place)

    def writes(self, body: Body, name: str) -> Iterator[bool]:
        for statement in body:
            if isinstance(statement, Assign) and isinstance(statement.target, Name):
                yield statement.target.name.upper() == name.upper()
            if isinstance(statement, Call):
                lent = in_outs(self.source, self.of(statement.instance))
                given = [(pin, target) for pin, target in statement.inputs if pin.upper() in lent]
                for _, target in (*given, *statement.outputs):
                    yield isinstance(target, Name) and target.name.upper() == name.upper()
            if isinstance(statement, For):
                yield statement.control.name.upper() == name.upper()
            for inner in inner_bodies(statement):
                yield from self.writes(inner, name)

    def assigned(self, target: Expression, value: Expression, place: Place) -> None:
        """Refuse an assignment to what must not be written, or of another kind."""
        kind = self.written(target, place)
        given = self.of(value, kind)
        alike = isinstance(given, Scalar) and given.kind == kind.kind
        if not isinstance(given, Scalar) or not alike or (kind.kind == "enum" and given != kind):
            shown = given.name if isinstance(given, Scalar) else "no single value"
            raise place.refuse(f"{kind.name} := {shown} needs a conversion")
        if kind.kind == "bits" and given.high > kind.high:
            raise place.refuse(f"{kind.name} := {given.name} needs a conversion")

    def written(self, target: Expression, place: Place) -> Scalar:
        """The type of what is written. Refuse what must not be."""
        kind = self.of(target)
        if not isinstance(kind, Scalar):
            raise place.refuse("whole arrays and instances are not assigned here")
        root = target
        while isinstance(root, Index | Member):
            kind_of = self.of(root.of)
            outs = sides(self.source, kind_of)[1] if isinstance(kind_of, Instance) else {}
            if isinstance(root, Member) and root.name.upper() in map(str.upper, outs):
                raise place.refuse(f"{root.name} is an output of a block and is written")
            root = root.of
        if isinstance(root, Name):
            section = self.unit.variables[root.name.upper()].section
            if section in ("constant", "input"):
                shown = "CONSTANT" if section == "constant" else "an input"
                raise place.refuse(f"{root.name} is {shown} and is written")
        return kind

    def in_outs(self, kind: Instance, inputs: tuple[tuple[str, Expression], ...], place: Place) -> None:
        """Refuse a call whose VAR_IN_OUT are not each a variable of their own, of the same type."""
        wanted = in_outs(self.source, kind)
        given = {name.upper(): value for name, value in inputs if name.upper() in wanted}
        for name, variable in wanted.items():
            value = given.get(name)
            if not isinstance(value, Name) or not isinstance(variable.type, Scalar):
                raise place.refuse(
                    f"{variable.name} of {kind.block} is VAR_IN_OUT: give it a single variable"
                )
            if self.written(value, place) != variable.type:
                raise place.refuse(f"{variable.name} of {kind.block} is of another type")
        names = [value.name.upper() for value in given.values() if isinstance(value, Name)]
        if len(set(names)) != len(names):
            raise place.refuse(f"two VAR_IN_OUT of {kind.block} are the same variable")

    def call(
        self,
        instance: Expression,
        inputs: tuple[tuple[str, Expression], ...],
        outputs: tuple[tuple[str, Expression], ...],
        place: Place,
    ) -> None:
        kind = self.of(instance)
        if not isinstance(kind, Instance):
            raise place.refuse("only an instance of a block is called")
        ins, outs = sides(self.source, kind)
        self.in_outs(kind, inputs, place)
        for pairs, known in ((inputs, ins), (outputs, outs)):
            names = [name.upper() for name, _ in pairs]
            for name, expression in pairs:
                if names.count(name.upper()) > 1:
                    raise place.refuse(f"{name} of {kind.block} stands twice in one call")
                key = next((key for key in known if key.upper() == name.upper()), None)
                if key is None:
                    raise place.refuse(f"{kind.block} has no {name}; {suggestion(name, known)}")
                wanted = known[key]
                if not isinstance(wanted, Scalar):
                    raise place.refuse(
                        f"{name} of {kind.block}: arrays and instances are not handed over here"
                    )
                given = self.of(expression, wanted)
                alike = isinstance(given, Scalar) and given.kind == wanted.kind
                if not alike or (wanted.kind == "enum" and given != wanted):
                    raise place.refuse(f"{name} of {kind.block} is of another type")
                assert isinstance(given, Scalar)
                if pairs is outputs:
                    self.written(expression, place)
                    if not given.low <= wanted.low <= wanted.high <= given.high or (
                        given.kind == "bits" and given != wanted
                    ):
                        raise place.refuse(f"{name} of {kind.block} is {wanted.name}, not {given.name}")
                elif wanted.kind == "bits" and given.high > wanted.high:
                    raise place.refuse(f"{name} := {given.name} needs a conversion")

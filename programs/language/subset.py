"""A look at every statement of a program, and the refusal of what is not in the subset."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from modeproof.ground.errors import suggestion
from programs.language.calls import (
    Pairs,
    called_functions,
    check_function,
    function_of,
    handed_to_block,
    handed_to_function,
    in_outs,
    inner_bodies,
    paths_in,
    sides,
)
from programs.language.scan_length import check_length
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    Assign,
    Bit,
    Body,
    Call,
    Case,
    Expression,
    For,
    If,
    Index,
    Instance,
    Leave,
    Loop,
    Member,
    Name,
    Place,
    Return,
    Scalar,
    Source,
    Type,
    Unit,
    Variable,
    blocks_in,
    root_of,
    shown,
)
from programs.language.types import Types
from programs.language.undefined_values import check_set

MOST_TURNS = 1000
DEEPEST = 20
"""Blocks within blocks."""


def check(source: Source, unit: Unit) -> None:
    """Look at every statement of a unit and of the units below it. Raises Unjudged with file and line."""
    if unit.kind == "function":
        raise unit.place.refuse(f"{unit.name} is a FUNCTION: it has no memory to be compared")
    if unit.others_call:
        raise unit.place.refuse(
            f"{unit.name} has methods or properties ({', '.join(unit.others_call)}), which others call: "
            "take the program that has it"
        )
    for name, variable in unit.of("in_out").items():
        raise variable.place.refuse(f"{name} is VAR_IN_OUT: take a program that calls {unit.name}")
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
        if not found.fresh:
            check_set(source, found)


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
        for block in blocks_in(variable.type):
            if block.upper() in BLOCKS:
                continue
            instance = source.find(block)
            if instance is None:
                raise variable.place.refuse(
                    f"{variable.name}: no type or block {block!r} is known; "
                    + suggestion(block, [*BLOCKS, *(found.name for found in source.units.values())])
                )
            if instance.kind == "program":
                raise variable.place.refuse(f"{variable.name}: {block} is a PROGRAM, which has no instances")
            if instance not in below:
                below.append(instance)
        if any(blocks_in(variable.type)) and variable.section not in ("var", "external"):
            raise variable.place.refuse(f"{variable.name}: an instance of a block belongs in VAR here")
    for inner in below:
        yield from _reached(source, inner, (*above, unit.name), seen)


class _Statements(Types):
    """The statements of one unit."""

    def body(self, body: Body, looped: bool = False) -> None:
        """Look at every statement; looped: there is a loop around it."""
        for statement in body:
            match statement:
                case Assign(target, value, place):
                    self.assigned(target, value, place)
                case If(branches, otherwise, place):
                    for asked, inner in branches:
                        self.scalar(asked, place, ("bool",))
                        self.body(inner, looped)
                    self.body(otherwise, looped)
                case Case(subject, clauses, otherwise, place):
                    kind = self.scalar(subject, place, ("int", "enum", "bits"))
                    for ranges, inner in clauses:
                        for end in (end for pair in ranges for end in pair):
                            label = self.scalar(end, end.place, (kind.kind,), kind)
                            if kind.kind == "enum" and label != kind:
                                raise end.place.refuse(
                                    f"a label of {label.name}, and the value is {kind.name}"
                                )
                            self.constant(end)
                        if kind.numbers and any(low != high for low, high in ranges):
                            raise place.refuse(f"a range of {kind.name}, which has numbers of its own")
                        self.body(inner, looped)
                    self.body(otherwise, looped)
                case For(control, start, end, step, inner, place):
                    kind = self.scalar(control, place, ("int",))
                    for bound in (start, end, *([] if step is None else [step])):
                        self.scalar(bound, place, ("int",), kind)
                    by = 1 if step is None else self.constant(step)
                    self.turns(control, self.constant(start), self.constant(end), by)
                    if any(self.writes(inner, control.name)):
                        raise place.refuse(f"the loop writes its control variable {control.name}")
                    self.body(inner, True)
                case Loop(going, inner, _, place):
                    self.scalar(going, place, ("bool",))
                    self.body(inner, True)
                case Leave(turn, place) if not looped:
                    raise place.refuse(f"{'CONTINUE' if turn else 'EXIT'} without a loop around it")
                case Call():
                    self.call(statement)
                case Return() | Leave():
                    pass

    def turns(self, control: Name, low: int, high: int, by: int) -> None:
        """Refuse a loop that is too long, or after which its control variable is outside its type."""
        kind = self.written(control, control.place)
        if by == 0 or abs(high - low) // abs(by) > MOST_TURNS:
            raise control.place.refuse(f"FOR: at most {MOST_TURNS:,} turns, and a step other than 0")
        assert isinstance(kind, Scalar)
        for value in (low, high, high + by):
            self.fits(value, kind, control.place)

    def writes(self, body: Body, name: str) -> Iterator[bool]:
        for statement in body:
            if isinstance(statement, Assign) and isinstance(statement.target, Name):
                yield statement.target.name.upper() == name.upper()
            if isinstance(statement, Call):
                for target in (*self.lent(statement), *(target for _, target in statement.outputs)):
                    yield isinstance(target, Name) and target.name.upper() == name.upper()
            if isinstance(statement, For):
                yield statement.control.name.upper() == name.upper()
            for inner in inner_bodies(statement):
                yield from self.writes(inner, name)

    def lent(self, call: Call) -> Iterator[Expression]:
        """What a call gives to VAR_IN_OUT."""
        unit = function_of(self.source, self.unit, call)
        if unit is None and isinstance(kind := self.of(call.instance), Instance):
            unit = self.source.units.get(kind.block.upper())
        names = {name.upper() for name in unit.of("in_out")} if unit is not None else set()
        return (value for name, value in call.inputs if name.upper() in names)

    def assigned(self, target: Expression, value: Expression, place: Place) -> None:
        """Refuse an assignment to what must not be written, or of another kind."""
        written = self.written(target, place)
        if not isinstance(written, Scalar):
            self.same(value, written, "the variable", place)
            return
        kind = written.base or written
        given = self.of(value, kind)
        alike = isinstance(given, Scalar) and given.kind == kind.kind
        if not isinstance(given, Scalar) or not alike or (kind.kind == "enum" and given != kind):
            raise place.refuse(f"{kind.name} := {shown(given)} needs a conversion")
        if kind.kind == "bits" and given.high > kind.high:
            raise place.refuse(f"{kind.name} := {given.name} needs a conversion")

    def same(self, value: Expression, kind: Type, what: str, place: Place) -> None:
        """Refuse anything but a structure or an array of exactly this type."""
        given = self.declared(value)
        if given != kind or not isinstance(value, Name | Member | Index):
            raise place.refuse(f"{what} is {shown(kind)}, and this is {shown(given)}")

    def written(self, target: Expression, place: Place) -> Type:
        """The type of what is written. Refuse what must not be."""
        kind = self.declared(target)
        if any(blocks_in(kind)):
            raise place.refuse("instances of blocks are not assigned")
        root = target
        while isinstance(root, Index | Member | Bit):
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

    def in_outs(self, of: str, wanted: Mapping[str, Variable], inputs: Pairs, place: Place) -> None:
        """Refuse a call whose VAR_IN_OUT are not each a variable of their own, of the same type."""
        given = {name.upper(): value for name, value in inputs if name.upper() in wanted}
        for name, variable in wanted.items():
            value = given.get(name)
            if not isinstance(value, Name | Member | Index):
                raise place.refuse(f"{variable.name} of {of} is VAR_IN_OUT: give it a single variable")
            if self.written(value, place) != variable.type:
                raise place.refuse(f"{variable.name} of {of} is of another type")
            part: Expression = value
            while isinstance(part, Member | Index):
                part = part.of
                if isinstance(self.of(part), Instance):
                    raise place.refuse(
                        f"{variable.name} of {of} is VAR_IN_OUT: not a pin of an instance here"
                    )
        names = [root_of(value) for value in given.values()]
        if len(set(names)) != len(names):
            raise place.refuse(f"two VAR_IN_OUT of {of} are the same variable")

    def call(self, call: Call) -> None:
        """Look at a call of an instance or of a FUNCTION."""
        place = call.place
        if (unit := function_of(self.source, self.unit, call)) is not None:
            inputs, outputs = handed_to_function(unit, call)
            ins, outs = (
                {name: variable.type for name, variable in unit.of(*sections).items()}
                for sections in (("input", "in_out"), ("output",))
            )
            lent = {name.upper(): variable for name, variable in unit.of("in_out").items()}
            self.in_outs(unit.name, lent, inputs, place)
            if not unit.fresh:
                self.apart(unit, inputs, outputs, place)
            self.pins(unit.name, ins, inputs, place, False)
            self.pins(unit.name, outs, outputs, place, True)
            return
        kind = self.of(call.instance)
        if not isinstance(kind, Instance):
            raise place.refuse("only an instance of a block is called")
        ins, outs = (dict(side) for side in sides(self.source, kind))
        inputs, outputs = handed_to_block(self.source, kind, call)
        self.in_outs(kind.block, in_outs(self.source, kind), inputs, place)
        self.pins(kind.block, ins, inputs, place, False)
        self.pins(kind.block, outs, outputs, place, True)

    def apart(self, unit: Unit, inputs: Pairs, outputs: Pairs, place: Place) -> None:
        """Refuse a variable that goes into a FUNCTION of S7 and comes out of it: it may be one, or a copy."""
        lent = unit.of_keys("in_out")
        out = [value for name, value in inputs if name.upper() in lent]
        out += [target for name, target in outputs if name.upper() != unit.name.upper()]
        given = [value for name, value in inputs if name.upper() not in lent]
        read = [path for value in given for path in paths_in(value)]
        for path in (next(paths_in(target)) for target in out):
            if any(path[: len(other)] == other or other[: len(path)] == path for other in read):
                text = f"{self.unit.variables[path[0]].name} goes into {unit.name} and comes out of it"
                raise place.refuse(f"{text}: S7 may take the variable itself, or a copy")

    def pins(self, of: str, known: Mapping[str, Type], given: Pairs, place: Place, out: bool) -> None:
        """Refuse an argument of a call that is unknown, given twice, or of another type."""
        names = [name.upper() for name, _ in given]
        for name, expression in given:
            key = next((key for key in known if key.upper() == name.upper()), None)
            if key is None:
                raise place.refuse(f"{of} has no {name}; {suggestion(name, known)}")
            if names.count(name.upper()) > 1:
                raise place.refuse(f"{name} of {of} is given twice")
            declared = known[key]
            if not isinstance(declared, Scalar):
                if any(blocks_in(declared)):
                    raise place.refuse(f"{name} of {of}: instances of blocks are not handed over")
                self.same(expression, declared, f"{name} of {of}", place)
                if out:
                    self.written(expression, place)
                continue
            wanted = declared.base or declared
            given_type = self.of(expression, wanted)
            alike = isinstance(given_type, Scalar) and given_type.kind == wanted.kind
            if not alike or (wanted.kind == "enum" and given_type != wanted):
                raise place.refuse(f"{name} of {of} is of another type")
            assert isinstance(given_type, Scalar)
            if out:
                target = self.written(expression, place)
                assert isinstance(target, Scalar)
                if not target.low <= wanted.low <= wanted.high <= target.high or (
                    target.kind == "bits" and target != wanted
                ):
                    raise place.refuse(f"{name} of {of} is {wanted.name}, not {target.name}")
            elif wanted.kind == "bits" and given_type.high > wanted.high:
                raise place.refuse(f"{name} := {given_type.name} needs a conversion")

"""Pieces of statement list between labels: how registers and memory go from one to the next.

Between two labels the accumulators and the RLO are expressions. Where ways meet, they are handed on in
temporary variables. All jumps go forward, so a piece between labels is one IF: it is carried out if a way
leads to it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from programs.language.tree import (
    BOOL,
    Assign,
    Binary,
    Expression,
    Function,
    If,
    Literal,
    Name,
    Place,
    Scalar,
    Statement,
    Unary,
    Variable,
)
from programs.readers.plcopen.evaluation_order import roots
from programs.readers.statement_list.instructions import (
    BYTE,
    DINT,
    DWORD,
    INT,
    WORD,
    Access,
    Cells,
    Fixed,
    Label,
    Operand,
    Step,
)


@dataclass(frozen=True)
class Word:
    """What is in an accumulator: a value of this type, and the upper bits are 0. No type: a constant."""

    type: Scalar | None
    value: Expression

    @property
    def wide(self) -> bool:
        """Whether the upper half may be something else than 0."""
        if self.type is None:
            return isinstance(self.value, Literal) and self.value.value > WORD.high
        return self.type in (DWORD, DINT)


@dataclass
class State:
    """Registers at one point of a piece. None: it is not known."""

    first: Word | None = None
    second: Word | None = None
    rlo: Expression | None = None
    begins: bool | None = True
    """The next logic operation begins anew (/FC is 0)."""
    before: Expression | None = None
    """What is before an O without an operand (OR)."""
    open: list[tuple[str, State]] = field(default_factory=list)
    assigned: frozenset[Access] = frozenset()


def _literal(value: int, kind: Scalar, place: Place) -> Expression:
    if value < 0:
        return Unary("-", Literal(-value, kind, place), place)
    return Literal(bool(value) if kind is BOOL else value, kind, place)


@dataclass
class Way:
    """Statements that hand registers on to a label, under a condition or always."""

    condition: Expression | None
    statements: list[Statement] = field(default_factory=list)


@dataclass
class Piece:
    """What is carried out if its guard is TRUE; the first has none."""

    guard: Expression | None
    place: Place
    parts: list[Statement | Way] = field(default_factory=list)

    def statements(self) -> Iterator[Statement]:
        """The statements of the piece."""
        found: list[Statement] = []
        for part in self.parts:
            if not isinstance(part, Way):
                found.append(part)
            elif part.condition is None:
                found += part.statements
            elif part.statements:
                found.append(If(((part.condition, tuple(part.statements)),), (), self.place))
        if self.guard is None:
            yield from found
        elif found:
            yield If(((self.guard, tuple(found)),), (), self.place)


class Pieces:
    """The pieces of a scan, and the registers at the point that is reached."""

    def __init__(self, steps: Sequence[Step], cells: Cells) -> None:
        self.steps, self.cells = steps, cells
        self.variables: dict[str, Variable] = {}
        self.ways: dict[Label, list[tuple[State, Way]]] = defaultdict(list)
        self.pieces = [Piece(None, Place("", 0))]
        self.state = State()
        self.alive = True
        self.counted = 0

    def emit(self, statement: Statement) -> None:
        self.pieces[-1].parts.append(statement)

    def temporary(self, kind: Scalar, place: Place) -> Name:
        self.counted += 1
        name = f"%{self.counted}"
        self.variables[name] = Variable(name, kind, "temp", None, place)
        return Name(name, place)

    def kept(self, value: Expression, kind: Scalar, place: Place) -> Name:
        """The value in a temporary variable."""
        name = self.temporary(kind, place)
        self.emit(Assign(name, value, place))
        return name

    # ------------------------------------------------------------ ways

    def way(self, step: Step, condition: Expression | None) -> None:
        """From here a way leads to the label of a step. After the end of a block only memory is known."""
        assert step.label is not None
        if self.state.open or self.state.before is not None:
            raise step.place.refuse("a way leads out of a bracket, or from behind an O")
        state = State(assigned=self.state.assigned) if step.leaves else replace(self.state, open=[])
        made = Way(condition)
        self.pieces[-1].parts.append(made)
        self.ways[step.label].append((state, made))

    def meet(self, step: Step) -> None:
        """A label: the registers where ways meet are handed on in variables."""
        assert step.label is not None
        if self.alive:
            self.way(step, None)
        ways = self.ways.pop(step.label, [])
        place = step.place
        guard = self.temporary(BOOL, place)
        self.pieces.append(Piece(guard, place))
        self.alive = bool(ways)
        for _, way in ways:
            way.statements.append(Assign(guard, Literal(True, BOOL, place), place))
        if not ways:
            return
        states = [state for state, _ in ways]
        begins = {state.begins for state in states}
        self.state = State(begins=begins.pop() if len(begins) == 1 else None)
        self.state.assigned = frozenset.intersection(*(state.assigned for state in states))
        self.state.first = self.handed([(state.first, way) for state, way in ways], place)
        self.state.second = self.handed([(state.second, way) for state, way in ways], place)
        if all(state.rlo is not None for state in states):
            variable = self.temporary(BOOL, place)
            for state, way in ways:
                assert state.rlo is not None
                way.statements.append(Assign(variable, state.rlo, place))
            self.state.rlo = variable

    def handed(self, ways: Sequence[tuple[Word | None, Way]], place: Place) -> Word | None:
        """An accumulator where ways meet."""
        words = [word for word, _ in ways]
        kind = _common(words)
        if kind is None:
            return None
        variable = self.temporary(kind, place)
        for word, way in ways:
            way.statements.append(Assign(variable, self.fitted(word, kind, place), place))
        return Word(kind, variable)

    def goes_on(self, condition: Expression, place: Place) -> None:
        """What follows is carried out only under this condition."""
        self.pieces.append(Piece(self.kept(condition, BOOL, place), place))

    def parts(self, access: Access) -> list[Access]:
        """The pieces of memory that an access covers, in their order."""
        found = [unit for unit in self.cells.names if unit.overlaps(access)]
        return sorted(found, key=lambda unit: unit.first)

    def name(self, unit: Access, place: Place) -> Name:
        if unit.area.startswith("L"):
            key = f"%{unit.name}".upper()
            if key not in self.variables:
                self.variables[key] = Variable(key, self.cells.types[unit], "temp", None, place)
            return Name(key, place)
        return Name(self.cells.names[unit], place)

    def read(self, operand: Operand, place: Place) -> Word:
        """The value of an operand."""
        if isinstance(operand, Fixed):
            kind = {1: BOOL, 8: BYTE, 16: WORD, 32: DWORD}[operand.width]
            return Word(None, Literal(operand.value & kind.high, kind, place))
        units = self.parts(operand)
        for unit in units:
            if unit.area.startswith("L") and unit not in self.state.assigned:
                raise place.refuse(f"temporary {operand} may be read before it is written")
        if units == [operand]:
            return Word(self.cells.types[operand], self.name(operand, place))
        kind = {8: BYTE, 16: WORD, 32: DWORD}[operand.width]
        found: Expression | None = None
        for unit in units:
            given = Function(
                f"{self.cells.types[unit].name}_TO_{kind.name}", (("", self.name(unit, place)),), place
            )
            shift = _shift(operand, unit)
            number = Literal(shift, None, place)
            part: Expression = Function("SHL", (("", given), ("", number)), place) if shift else given
            found = part if found is None else Binary("OR", found, part, place)
        assert found is not None
        return Word(kind, self.kept(found, kind, place))

    def bit(self, operand: Operand, place: Place) -> Expression:
        """The value of one bit."""
        word = self.read(operand, place)
        if isinstance(word.value, Literal):
            return Literal(bool(word.value.value), BOOL, place)
        return word.value

    def store(self, unit: Access, value: Expression, place: Place) -> None:
        """Write one piece of memory; what registers still need of it is kept before."""
        target = self.name(unit, place)
        self.keep_registers(target.name.upper(), place)
        self.emit(Assign(target, value, place))
        self.state.assigned |= {unit}

    def keep_registers(self, name: str, place: Place) -> None:
        for state in (self.state, *(saved for _, saved in self.state.open)):
            for register in ("first", "second"):
                word: Word | None = getattr(state, register)
                if word is not None and word.type is not None and name in roots(word.value):
                    setattr(state, register, Word(word.type, self.kept(word.value, word.type, place)))
            for register in ("rlo", "before"):
                value: Expression | None = getattr(state, register)
                if value is not None and name in roots(value):
                    setattr(state, register, self.kept(value, BOOL, place))

    def put(self, operand: Operand, word: Word | None, place: Place) -> None:
        """Write an operand of 8, 16 or 32 bits."""
        if not isinstance(operand, Access):
            raise place.refuse(f"{operand.text} is written")
        if self.parts(operand) == [operand]:
            self.store(operand, self.fitted(word, self.cells.types[operand], place), place)
            return
        kind = {8: BYTE, 16: WORD, 32: DWORD}[operand.width]
        value = self.kept(self.fitted(word, kind, place), kind, place)
        for unit in self.parts(operand):
            shift = _shift(operand, unit)
            if unit.width == 1:
                mask = Literal(1 << shift, kind, place)
                part: Expression = Binary(
                    "<>", Binary("AND", value, mask, place), Literal(0, kind, place), place
                )
            else:
                moved = (
                    Function("SHR", (("", value), ("", Literal(shift, None, place))), place)
                    if shift
                    else value
                )
                part = Function(f"{kind.name}_TO_BYTE", (("", moved),), place)
            self.store(unit, part, place)

    def fitted(self, word: Word | None, kind: Scalar, place: Place) -> Expression:
        """The lower bits of an accumulator as a value of this type."""
        if word is None:
            raise place.refuse("what is in the accumulator here is not known: load it in this block")
        if word.type is None:
            assert isinstance(word.value, Literal)
            width = kind.high.bit_length() + (kind.low < 0)
            value = int(word.value.value) & ((1 << width) - 1)
            return _literal(value - (1 << width) if value > kind.high else value, kind, place)
        if word.type == kind:
            return word.value
        bits = {"INT": WORD, "DINT": DWORD}
        given, value_of = word.type, word.value
        for to in (bits.get(given.name, given), bits.get(kind.name, kind), kind):
            if to != given:
                value_of = Function(f"{given.name}_TO_{to.name}", (("", value_of),), place)
                given = to
        return value_of


def _shifted(name: str, value: Expression, by: int, place: Place) -> Expression:
    number = Literal(by, None, place)
    return Function(name, (("", value), ("", number)), place) if by else value


def _shift(access: Access, unit: Access) -> int:
    """By how many bits a piece lies above the lowest bit of an access; the first byte is the highest."""
    bytes_after = access.byte + access.width // 8 - 1 - unit.byte
    return 8 * bytes_after + unit.bit


def _common(words: Sequence[Word | None]) -> Scalar | None:
    """A type that holds what several accumulators hold; None: one of them is not known."""
    if any(word is None for word in words):
        return None
    kinds = {word.type for word in words if word is not None and word.type is not None}
    if len(kinds) == 1:
        return kinds.pop()
    if not kinds:
        fixed = [
            int(word.value.value) for word in words if word is not None and isinstance(word.value, Literal)
        ]
        return INT if all(value <= INT.high for value in fixed) else DWORD
    return WORD if all(kind in (BYTE, WORD, INT) for kind in kinds) else DWORD

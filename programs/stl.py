"""Instructions of statement list as statements of `tree`: accumulators, result of logic operation, jumps.

Between two labels the accumulators and the RLO are expressions. Where ways meet, they are handed on in
temporary variables. All jumps go forward, so a piece between labels is one IF: it is carried out if a way
leads to it. What S7 leaves open or awlsim does otherwise is refused, with the line.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from programs.networks import roots
from programs.tree import (
    BOOL,
    SCALARS,
    Assign,
    Binary,
    Body,
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

BYTE, WORD, DWORD = SCALARS["BYTE"], SCALARS["WORD"], SCALARS["DWORD"]
INT, DINT = SCALARS["INT"], SCALARS["DINT"]
LOGIC = {"A": "AND", "AN": "AND", "O": "OR", "ON": "OR", "X": "XOR", "XN": "XOR"}
WORDS = {"AW": "AND", "OW": "OR", "XOW": "XOR", "AD": "AND", "OD": "OR", "XOD": "XOR"}
COMPARE = {"==": "=", "<>": "<>", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
SUMS = {"+I": ("+", INT), "-I": ("-", INT), "+D": ("+", DINT), "-D": ("-", DINT)}
SHIFTS = {"SLW": ("SHL", WORD), "SRW": ("SHR", WORD), "SLD": ("SHL", DWORD), "SRD": ("SHR", DWORD)}
WRITES = ("T", "=", "S", "R", "FP", "FN")
Label = tuple[int, int]
"""A call and the number of an instruction in it; -1: its end."""


@dataclass(frozen=True)
class Access:
    """A piece of memory: area (I, Q, M, DBn, Ln), byte, bit, width 1, 8, 16 or 32."""

    area: str
    byte: int
    bit: int
    width: int

    @property
    def first(self) -> int:
        """Its first bit, counted from that of the area."""
        return 8 * self.byte + self.bit

    @property
    def last(self) -> int:
        return self.first + self.width - 1

    def overlaps(self, other: Access) -> bool:
        """Whether they share memory."""
        return self.area == other.area and self.first <= other.last and other.first <= self.last

    @property
    def name(self) -> str:
        """As a name of a variable."""
        letter = {1: "X", 8: "B", 16: "W", 32: "D"}[self.width]
        return f"{self.area}_{letter}{self.byte}" + (f"_{self.bit}" if self.width == 1 else "")

    def __str__(self) -> str:
        return self.name.replace("_", " ")


@dataclass(frozen=True)
class Fixed:
    """A constant of 1 to 32 bits, and how it is written."""

    value: int
    width: int
    text: str


Operand = Access | Fixed


@dataclass(frozen=True)
class Step:
    """An instruction with resolved operands; `label`: where it jumps to, or what it marks."""

    op: str
    place: Place
    operands: tuple[Operand, ...] = ()
    label: Label | None = None
    leaves: bool = False
    """It ends a block: the status is that after BE."""

    def accesses(self) -> Iterator[Access]:
        """The memory that it uses."""
        return (one for one in self.operands if isinstance(one, Access))

    def writes(self) -> Iterator[Access]:
        """The memory that it changes."""
        changed = self.operands[-1:] if self.op == "copy" else self.operands if self.op in WRITES else ()
        return (one for one in changed if isinstance(one, Access))


@dataclass(frozen=True)
class Cells:
    """The pieces of memory as variables."""

    names: Mapping[Access, str]
    types: Mapping[Access, Scalar]


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
    """What stands before an O without an operand (OR)."""
    open: list[tuple[str, State]] = field(default_factory=list)
    assigned: frozenset[Access] = frozenset()


def statements(steps: Sequence[Step], cells: Cells) -> tuple[Body, dict[str, Variable]]:
    """The statements of a scan, and the temporary variables that they use. Raises Unjudged with the line."""
    return _Pieces(steps, cells).all()


def _literal(value: int, kind: Scalar, place: Place) -> Expression:
    if value < 0:
        return Unary("-", Literal(-value, kind, place), place)
    return Literal(bool(value) if kind is BOOL else value, kind, place)


@dataclass
class _Way:
    """Statements that hand registers on to a label, under a condition or always."""

    condition: Expression | None
    statements: list[Statement] = field(default_factory=list)


@dataclass
class _Piece:
    """What is carried out if its guard is TRUE; the first has none."""

    guard: Expression | None
    place: Place
    parts: list[Statement | _Way] = field(default_factory=list)

    def statements(self) -> Iterator[Statement]:
        """The statements of the piece."""
        found: list[Statement] = []
        for part in self.parts:
            if not isinstance(part, _Way):
                found.append(part)
            elif part.condition is None:
                found += part.statements
            elif part.statements:
                found.append(If(((part.condition, tuple(part.statements)),), (), self.place))
        if self.guard is None:
            yield from found
        elif found:
            yield If(((self.guard, tuple(found)),), (), self.place)


class _Pieces:
    """Translates the pieces between labels one after the other."""

    def __init__(self, steps: Sequence[Step], cells: Cells) -> None:
        self.steps, self.cells = steps, cells
        self.variables: dict[str, Variable] = {}
        self.ways: dict[Label, list[tuple[State, _Way]]] = defaultdict(list)
        self.pieces = [_Piece(None, Place("", 0))]
        self.state = State()
        self.alive = True
        self.counted = 0

    def all(self) -> tuple[Body, dict[str, Variable]]:
        index = 0
        while index < len(self.steps):
            step = self.steps[index]
            if step.op == "label":
                self.meet(step)
            elif step.op == "JL":
                index = self.jump_list(index)
            elif self.alive:
                self.step(step)
            index += 1
        return tuple(made for piece in self.pieces for made in piece.statements()), self.variables

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
        made = _Way(condition)
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
        self.pieces.append(_Piece(guard, place))
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

    def handed(self, ways: Sequence[tuple[Word | None, _Way]], place: Place) -> Word | None:
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
        self.pieces.append(_Piece(self.kept(condition, BOOL, place), place))

    def jump(self, step: Step) -> None:
        """JU, JC, JCN and the ends of blocks."""
        if step.op == "JU":
            self.way(step, None)
            self.alive = False
            return
        rlo = self.known(step.place)
        taken = self.kept(rlo if step.op == "JC" else Unary("NOT", rlo, step.place), BOOL, step.place)
        self.state.rlo, self.state.begins, self.state.before = Literal(True, BOOL, step.place), True, None
        self.way(step, taken)
        self.goes_on(Unary("NOT", taken, step.place), step.place)

    def jump_list(self, index: int) -> int:
        """JL and the jumps after it; returns the index of the last of them."""
        step = self.steps[index]
        targets = []
        while index + 1 < len(self.steps) and self.steps[index + 1].op == "JU":
            index += 1
            targets.append(self.steps[index])
        after = self.steps[index + 1 :][:1]
        if not after or after[0].op != "label" or after[0].label != step.label:
            raise step.place.refuse("JL: its label must stand right after its list of jumps (JU)")
        if self.alive:
            number = self.kept(self.fitted(self.state.first, BYTE, step.place), BYTE, step.place)
            other: Expression = Literal(True, BOOL, step.place)
            for n, target in enumerate(targets):
                hit = Binary("=", number, Literal(n, BYTE, target.place), target.place)
                self.way(target, self.kept(hit, BOOL, target.place))
                other = Binary("AND", other, Unary("NOT", hit, target.place), target.place)
            self.goes_on(other, step.place)
        return index

    # ------------------------------------------------------------ memory

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

    # ------------------------------------------------------------ instructions

    def known(self, place: Place) -> Expression:
        """The RLO."""
        if self.state.rlo is None:
            raise place.refuse("the result of logic operation is not known here")
        return self.state.rlo

    def clear_begin(self, place: Place) -> None:
        if self.state.begins is None:
            raise place.refuse("whether a logic operation begins here depends on the way")

    def logic(self, op: str, value: Expression, place: Place) -> None:
        """A, O, X and their negations with a value."""
        state = self.state
        if op.endswith("N"):
            value = Unary("NOT", value, place)
        self.clear_begin(place)
        if op[0] == "A":
            found = value if state.begins else Binary("AND", self.known(place), value, place)
            state.rlo = found if state.before is None else Binary("OR", state.before, found, place)
        else:
            alone = state.begins and state.before is None
            state.rlo = value if alone else Binary(LOGIC[op], self.known(place), value, place)
            state.before = None
        state.begins = False

    def step(self, step: Step) -> None:
        """One instruction."""
        op, place, state = step.op, step.place, self.state
        operands = step.operands
        match op:
            case "A" | "AN" | "O" | "ON" | "X" | "XN" if operands:
                self.logic(op, self.bit(operands[0], place), place)
            case "O":
                self.clear_begin(place)
                began = state.begins and state.before is None
                state.before, state.begins = None if began else self.known(place), True
            case "A(" | "AN(" | "O(" | "ON(" | "X(" | "XN(":
                saved = State(rlo=state.rlo, begins=state.begins, before=state.before)
                state.open = [*state.open, (op[:-1], saved)]
                state.begins, state.before = True, None
            case ")":
                inner, (outer, saved) = self.known(place), state.open[-1]
                state.open = state.open[:-1]
                state.rlo, state.begins, state.before = saved.rlo, saved.begins, saved.before
                self.logic(outer, inner, place)
            case "=":
                self.assign(operands[0], place)
            case "S" | "R":
                self.latch(operands[0], op == "S", place)
            case "FP" | "FN":
                self.edge(operands[0], op == "FP", place)
            case "SET" | "CLR":
                state.rlo, state.begins, state.before = Literal(op == "SET", BOOL, place), True, None
            case "NOT":
                if state.begins and state.before is not None:
                    raise place.refuse("NOT right behind O is not supported")
                state.rlo = Unary("NOT", self.known(place), place)
            case "L":
                state.second, state.first = state.first, self.read(operands[0], place)
            case "T":
                self.put(operands[0], state.first, place)
            case "TAK":
                state.first, state.second = state.second, state.first
            case "JU" | "JC" | "JCN":
                self.jump(step)
            case "enter":
                self.state = State(assigned=state.assigned)
            case "copy":
                self.copy(operands[0], operands[1], place)
            case "NOP" | "BLD":
                pass
            case _:
                self.calculate(op, operands, place)

    def calculate(self, op: str, operands: Sequence[Operand], place: Place) -> None:
        """Comparisons and arithmetic."""
        state = self.state
        if op[:-1] in COMPARE and op[-1] in "ID":
            kind = INT if op[-1] == "I" else DINT
            if op[:-1] in ("==", "<>") and not {INT, DINT} & {
                word.type for word in (state.first, state.second) if word
            }:
                kind = WORD if op[-1] == "I" else DWORD
            left, right = (self.fitted(word, kind, place) for word in (state.second, state.first))
            state.rlo = Binary(COMPARE[op[:-1]], left, right, place)
            state.begins, state.before = False, None
            return
        if op in SUMS:
            sign, kind = SUMS[op]
            kind, found = self.sum(sign, kind, state.second, state.first, place)
        elif op == "+" and isinstance(operands[0], Fixed):
            kind = INT if operands[0].width == 16 else DINT
            kind, found = self.sum("+", kind, state.first, self.read(operands[0], place), place)
        elif op in WORDS:
            kind = WORD if op[-1] == "W" else DWORD
            other = self.read(operands[0], place) if operands else state.second
            left, right = (self.fitted(word, kind, place) for word in (state.first, other))
            found = Binary(WORDS[op], left, right, place)
        elif op in SHIFTS and operands and isinstance(operands[0], Fixed):
            name, kind = SHIFTS[op]
            count = Literal(min(operands[0].value, kind.width), None, place)
            found = Function(name, (("", self.fitted(state.first, kind, place)), ("", count)), place)
        elif op in ("INVI", "INVD"):
            kind = WORD if op == "INVI" else DWORD
            found = Unary("NOT", self.fitted(state.first, kind, place), place)
        elif op == "ITD":
            state.first = Word(
                DINT, Function("INT_TO_DINT", (("", self.fitted(state.first, INT, place)),), place)
            )
            return
        else:
            raise place.refuse(f"instruction {op} is not supported")
        if kind in (INT, WORD) and (state.first is None or state.first.wide):  # the upper half stays as it is
            low = self.fitted(Word(kind, self.kept(found, kind, place)), DWORD, place)
            upper = Literal(0xFFFF0000, DWORD, place)
            high = Binary("AND", self.fitted(state.first, DWORD, place), upper, place)
            kind, found = DWORD, Binary("OR", high, low, place)
        state.first = Word(kind, self.kept(found, kind, place))

    def sum(
        self, sign: str, kind: Scalar, one: Word | None, other: Word | None, place: Place
    ) -> tuple[Scalar, Expression]:
        """A sum: of numbers, or of bit strings where no operand is a number."""
        if not {INT, DINT} & {word.type for word in (one, other) if word is not None}:
            kind, sign = WORD if kind == INT else DWORD, f"{sign}W"
        left, right = (self.fitted(word, kind, place) for word in (one, other))
        return kind, Binary(sign, left, right, place)

    def assign(self, operand: Operand, place: Place) -> None:
        if not isinstance(operand, Access):
            raise place.refuse(f"{operand.text} is written")
        value = self.known(place)
        self.store(operand, value, place)
        self.state.begins, self.state.before = True, None

    def latch(self, operand: Operand, value: bool, place: Place) -> None:
        if not isinstance(operand, Access):
            raise place.refuse(f"{operand.text} is written")
        self.bit(operand, place)
        self.known(place)
        target = self.name(operand, place)
        self.keep_registers(target.name.upper(), place)
        new = Literal(value, BOOL, place)
        self.emit(If(((self.known(place), (Assign(target, new, place),)),), (), place))
        self.state.begins, self.state.before = True, None

    def edge(self, operand: Operand, rising: bool, place: Place) -> None:
        """FP, FN: the memory of the edge takes the RLO."""
        if not isinstance(operand, Access):
            raise place.refuse(f"{operand.text} is written")
        old = self.kept(self.bit(operand, place), BOOL, place)
        now = self.kept(self.known(place), BOOL, place)
        self.store(operand, now, place)
        one, other = (now, old) if rising else (old, now)
        self.state.rlo = Binary("AND", one, Unary("NOT", other, place), place)
        self.state.begins, self.state.before = False, None

    def copy(self, source: Operand, target: Operand, place: Place) -> None:
        """What a call hands over or back."""
        if source.width != target.width or not isinstance(target, Access):
            raise place.refuse("a parameter of a call has another width")
        if target.width == 1:
            self.store(target, self.bit(source, place), place)
        else:
            self.put(target, self.read(source, place), place)


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

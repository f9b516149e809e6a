"""Instructions of statement list as statements of `tree`: accumulators, result of logic operation, jumps.

What S7 leaves open or awlsim does otherwise is refused, with the line.
"""

from __future__ import annotations

from collections.abc import Sequence

from programs.language.tree import (
    BOOL,
    Assign,
    Binary,
    Body,
    Expression,
    Function,
    If,
    Literal,
    Place,
    Scalar,
    Unary,
    Variable,
)
from programs.readers.statement_list.basic_blocks import Pieces, State, Word
from programs.readers.statement_list.instructions import (
    BYTE,
    DINT,
    DWORD,
    INT,
    WORD,
    Access,
    Cells,
    Fixed,
    Operand,
    Step,
)

LOGIC = {"A": "AND", "AN": "AND", "O": "OR", "ON": "OR", "X": "XOR", "XN": "XOR"}
WORDS = {"AW": "AND", "OW": "OR", "XOW": "XOR", "AD": "AND", "OD": "OR", "XOD": "XOR"}
COMPARE = {"==": "=", "<>": "<>", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
SUMS = {"+I": ("+", INT), "-I": ("-", INT), "+D": ("+", DINT), "-D": ("-", DINT)}
SHIFTS = {"SLW": ("SHL", WORD), "SRW": ("SHR", WORD), "SLD": ("SHL", DWORD), "SRD": ("SHR", DWORD)}


def statements(steps: Sequence[Step], cells: Cells) -> tuple[Body, dict[str, Variable]]:
    """The statements of a scan, and the temporary variables that they use. Raises Unjudged with the line."""
    return Instructions(steps, cells).all()


class Instructions(Pieces):
    """Translates one instruction after the other."""

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
            raise step.place.refuse("JL: its label must come right after its list of jumps (JU)")
        if self.alive:
            number = self.kept(self.fitted(self.state.first, BYTE, step.place), BYTE, step.place)
            other: Expression = Literal(True, BOOL, step.place)
            for n, target in enumerate(targets):
                hit = Binary("=", number, Literal(n, BYTE, target.place), target.place)
                self.way(target, self.kept(hit, BOOL, target.place))
                other = Binary("AND", other, Unary("NOT", hit, target.place), target.place)
            self.goes_on(other, step.place)
        return index

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
            value, count = self.fitted(state.first, kind, place), Literal(operands[0].value, None, place)
            found = Function(name, (("", value), ("", count)), place)
            if operands[0].value >= kind.width:  # nothing of it is left
                found = Literal(0, kind, place)
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

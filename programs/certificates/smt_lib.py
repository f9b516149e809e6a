"""Formulas as SMT-LIB 2 text that depends on the formulas alone.

z3's own printer names shared terms and orders arguments by internal numbers, which differ from run to run.
Here the arguments of commutative operators are sorted by what they say, and every term that occurs more than
once has a name, counted in the order of printing.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import z3

LOGIC_LINE: Final = "(set-logic ALL)"
"""Words and unbounded integers in one query; SMT-LIB has no smaller name for it."""
OPERATORS: Final = {
    z3.Z3_OP_TRUE: "true", z3.Z3_OP_FALSE: "false", z3.Z3_OP_EQ: "=", z3.Z3_OP_DISTINCT: "distinct",
    z3.Z3_OP_ITE: "ite", z3.Z3_OP_AND: "and", z3.Z3_OP_OR: "or", z3.Z3_OP_XOR: "xor", z3.Z3_OP_NOT: "not",
    z3.Z3_OP_IMPLIES: "=>", z3.Z3_OP_LE: "<=", z3.Z3_OP_GE: ">=", z3.Z3_OP_LT: "<", z3.Z3_OP_GT: ">",
    z3.Z3_OP_ADD: "+", z3.Z3_OP_SUB: "-", z3.Z3_OP_UMINUS: "-", z3.Z3_OP_MUL: "*", z3.Z3_OP_IDIV: "div",
    z3.Z3_OP_MOD: "mod", z3.Z3_OP_REM: "rem", z3.Z3_OP_BNEG: "bvneg", z3.Z3_OP_BADD: "bvadd",
    z3.Z3_OP_BSUB: "bvsub", z3.Z3_OP_BMUL: "bvmul", z3.Z3_OP_ULEQ: "bvule", z3.Z3_OP_UGEQ: "bvuge",
    z3.Z3_OP_ULT: "bvult", z3.Z3_OP_UGT: "bvugt", z3.Z3_OP_SLEQ: "bvsle", z3.Z3_OP_SGEQ: "bvsge",
    z3.Z3_OP_SLT: "bvslt", z3.Z3_OP_SGT: "bvsgt", z3.Z3_OP_BAND: "bvand", z3.Z3_OP_BOR: "bvor",
    z3.Z3_OP_BNOT: "bvnot", z3.Z3_OP_BXOR: "bvxor", z3.Z3_OP_CONCAT: "concat", z3.Z3_OP_BSHL: "bvshl",
    z3.Z3_OP_BLSHR: "bvlshr", z3.Z3_OP_BASHR: "bvashr", z3.Z3_OP_BV2INT: "bv2nat",
}  # fmt: skip
INDEXED: Final = {
    z3.Z3_OP_EXTRACT: "extract", z3.Z3_OP_ZERO_EXT: "zero_extend", z3.Z3_OP_SIGN_EXT: "sign_extend",
    z3.Z3_OP_ROTATE_LEFT: "rotate_left", z3.Z3_OP_ROTATE_RIGHT: "rotate_right", z3.Z3_OP_INT2BV: "int2bv",
}  # fmt: skip
COMMUTATIVE: Final = {
    "=",
    "distinct",
    "and",
    "or",
    "xor",
    "+",
    "*",
    "bvadd",
    "bvmul",
    "bvand",
    "bvor",
    "bvxor",
}


@dataclass(frozen=True, eq=False)
class Term:
    """A term as it is printed: how it begins, its parts in the order of printing, and its sort."""

    operator: str
    parts: tuple[Term, ...]
    sort: str
    symbol: str
    """The name of a free symbol; else empty."""
    digest: str
    """A hash of what it says."""


@dataclass
class Printer:
    """Prints queries; terms that several of them share are read once."""

    read: dict[int, Term] = field(default_factory=dict)
    """By z3's number of the term, which stays valid as long as the term is kept."""
    known: dict[str, Term] = field(default_factory=dict)
    kept: list[Any] = field(default_factory=list)

    def questions(
        self,
        comments: Sequence[str],
        known: Mapping[str, z3.BoolRef],
        asked: Mapping[str, z3.BoolRef],
    ) -> str:
        """The text: comments, declarations, what is known, and one question for each formula that is asked.

        Terms that occur more than once are defined before they are used.
        """
        roots = {name: self.term(formula) for name, formula in {**known, **asked}.items()}
        uses: Counter[str] = Counter()
        for root in roots.values():
            _count(root, uses)
        names: dict[str, str] = {}
        symbols: dict[str, str] = {}
        body: list[str] = []
        for name, root in roots.items():
            lines: list[str] = []
            text = _print(root, uses, names, symbols, lines)
            body += [*lines, f"; {name}"]
            if name in known:
                body.append(f"(assert {text})")
            else:
                body += ["(push 1)", f"(assert {text})", "(check-sat)", "(pop 1)"]
        return "\n".join(
            [
                *(f"; {comment}" for comment in comments),
                LOGIC_LINE,
                *(f"(declare-fun {name} () {sort})" for name, sort in sorted(symbols.items())),
                *body,
                "",
            ]
        )

    def term(self, root: Any) -> Term:
        """What is printed for a term. Raises NotImplementedError for an operator that is not known here."""
        stack = [root]
        while stack:
            node = stack[-1]
            if node.get_id() in self.read:
                stack.pop()
                continue
            below = node.children()
            missing = [child for child in below if child.get_id() not in self.read]
            if missing:
                stack += missing
                continue
            stack.pop()
            operator = _operator(node)
            parts = [self.read[child.get_id()] for child in below]
            self.kept.append(node)
            if operator in ("and", "or") and len(parts) == 1:  # SMT-LIB wants two at least
                self.read[node.get_id()] = parts[0]
                continue
            if operator in ("and", "or") and not parts:
                operator = "true" if operator == "and" else "false"
            if operator in COMMUTATIVE:
                parts.sort(key=lambda part: part.digest)
            free = not parts and node.decl().kind() == z3.Z3_OP_UNINTERPRETED
            text = " ".join([operator, *(part.digest for part in parts)])
            digest = hashlib.sha256(text.encode("utf-8")).hexdigest()
            term = Term(operator, tuple(parts), _sort(node), operator if free else "", digest)
            self.read[node.get_id()] = self.known.setdefault(digest, term)
        return self.read[root.get_id()]


def _count(root: Term, uses: Counter[str]) -> None:
    stack = [root]
    while stack:
        term = stack.pop()
        uses[term.digest] += 1
        if uses[term.digest] == 1:
            stack += term.parts


def _print(
    root: Term, uses: Counter[str], names: dict[str, str], symbols: dict[str, str], lines: list[str]
) -> str:
    """The text of a term. names: those of shared terms; new ones are added, their definitions to lines."""
    done: dict[str, str] = {}
    stack: list[tuple[Term, bool]] = [(root, False)]
    while stack:
        term, ready = stack.pop()
        if term.digest in done or term.digest in names:
            continue
        if not ready:
            stack.append((term, True))
            stack += [(part, False) for part in reversed(term.parts)]
            continue
        if term.symbol:
            symbols[term.symbol] = term.sort
        parts = [names.get(part.digest) or done[part.digest] for part in term.parts]
        text = f"({' '.join([term.operator, *parts])})" if parts else term.operator
        if parts and uses[term.digest] > 1:
            names[term.digest] = f"t{len(names) + 1}"
            lines.append(f"(define-fun {names[term.digest]} () {term.sort} {text})")
        else:
            done[term.digest] = text
    return names.get(root.digest) or done[root.digest]


def _operator(node: Any) -> str:
    """How a term begins. Raises NotImplementedError for an operator that is not known here."""
    if z3.is_int_value(node):
        number = node.as_long()
        return str(number) if number >= 0 else f"(- {-number})"
    if z3.is_bv_value(node):
        return f"(_ bv{node.as_long()} {node.size()})"
    declared = node.decl()
    kind = declared.kind()
    if kind == z3.Z3_OP_UNINTERPRETED and node.num_args() == 0:
        return _quoted(declared.name())
    if kind in OPERATORS:
        return OPERATORS[kind]
    if kind in INDEXED:
        return f"(_ {INDEXED[kind]} {' '.join(map(str, declared.params()))})"
    raise NotImplementedError(f"no SMT-LIB text for {declared.name()}")


def _sort(node: Any) -> str:
    return f"(_ BitVec {node.size()})" if z3.is_bv(node) else str(node.sort())


def _quoted(name: str) -> str:
    return name if all(letter.isalnum() or letter in "._@" for letter in name) else f"|{name}|"

"""What is true after every scan from one control state: all its paths in one formula.

The paths of a scan are the leaves of a tree of questions. Paths with the same result are one end, and a
question whose both answers lead to the same end is left out. A formula that follows the tree is as exact as
one line a path, and far smaller.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from typing import Any, Final

import z3

from modeproof.registers import Signal
from proofs.explorer.device import is_word
from proofs.explorer.explore import Exploration, Path
from proofs.explorer.records import terms, unvalidated
from proofs.explorer.values import WORD_BITS, Flag, Number, Opaque, Proxy, Text, Word

TRUE: Final = z3.BoolVal(True)
FALSE: Final = z3.BoolVal(False)


@dataclass(frozen=True, eq=False)
class End:
    """What one or more paths return; two ends of a tree never have the same result."""

    result: Any


@dataclass(frozen=True, eq=False)
class Fork:
    """A question and where its answers lead; None: no feasible path gives this answer."""

    question: z3.BoolRef
    yes: Tree | None
    no: Tree | None


Tree = Fork | End
Leaf = Callable[[End], z3.BoolRef]


def tree(paths: Sequence[Path]) -> Tree:
    """The tree of all paths of one exploration, none of which raises."""
    ends: dict[object, End] = {}
    forks: dict[object, Fork] = {}

    def below(found: Sequence[Path], depth: int) -> Tree | None:
        if not found:
            return None
        if len(found[0].decisions) == depth:
            leaves = tuple(_identity(leaf) for _, leaf in terms(found[0].result))
            return ends.setdefault(leaves, End(found[0].result))
        question = found[0].decisions[depth].question
        yes = below([path for path in found if path.decisions[depth].answer], depth + 1)
        no = below([path for path in found if not path.decisions[depth].answer], depth + 1)
        if yes is no and yes is not None:
            return yes
        return forks.setdefault((question.get_id(), id(yes), id(no)), Fork(question, yes, no))

    made = below(paths, 0)
    assert made is not None
    return made


def _identity(leaf: object) -> object:
    """The same for two equal leaves: z3 keeps one term only of those that are written alike."""
    return leaf.get_id() if isinstance(leaf, z3.ExprRef) else (type(leaf), repr(leaf))


def ends(root: Tree) -> tuple[End, ...]:
    """Every end of a tree, in the order of the paths."""
    found: dict[int, End] = {}
    _visit(root, lambda end: found.setdefault(id(end), end))
    return tuple(found.values())


def _visit(root: Tree, of_end: Callable[[End], object]) -> None:
    seen: set[int] = set()
    stack: list[Tree] = [root]
    while stack:
        node = stack.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, End):
            of_end(node)
        else:
            stack += [branch for branch in (node.no, node.yes) if branch is not None]


def always(root: Tree, then: Leaf) -> z3.BoolRef:
    """To whichever end a scan comes, `then` is true of it.

    The same as: for each path, its condition implies `then` of its end.
    """
    return _formula(root, then, False)


def some(root: Tree, then: Leaf) -> z3.BoolRef:
    """The scan goes on one of the paths to an end of which `then` is true."""
    return _formula(root, then, True)


def _formula(root: Tree, then: Leaf, any_path: bool) -> z3.BoolRef:
    """any_path: some path (conditions and `then` as conjunctions), not all (as implications)."""
    neutral = FALSE if any_path else TRUE
    known: dict[int, z3.BoolRef] = {}

    def of(node: Tree | None) -> z3.BoolRef:
        if node is None:
            return neutral
        if id(node) not in known:
            known[id(node)] = then(node) if isinstance(node, End) else fork(node)
        return known[id(node)]

    def fork(node: Fork) -> z3.BoolRef:
        yes, no = of(node.yes), of(node.no)
        if yes.eq(no):
            return yes
        parts = [
            guarded(question, rest)
            for question, rest in ((node.question, yes), (z3.Not(node.question), no))
            if not rest.eq(neutral)
        ]
        if len(parts) == 1:
            return parts[0]
        return z3.Or(*parts) if any_path else z3.And(*parts)

    def guarded(question: z3.BoolRef, rest: z3.BoolRef) -> z3.BoolRef:
        if not any_path:
            return z3.Implies(question, rest)
        return question if rest.eq(TRUE) else z3.And(question, rest)

    return of(root)


def value(exploration: Exploration, of: Callable[[Any], z3.ExprRef]) -> z3.ExprRef:
    """What `of` takes from the result, as one term over all paths; on the last one where none applies."""
    term: z3.ExprRef | None = None
    for path in reversed(exploration.paths):
        found = of(path.result)
        term = found if term is None or term.eq(found) else z3.If(path.condition, found, term)
    assert term is not None
    return term


def in_terms(record: Any, signals: Mapping[str, Signal]) -> Any:
    """The record with solver terms in it: for symbols and proxies, and for plain values of signals.

    Other plain values, such as the control state, stay as they are; a record in a field that is a signal is
    taken by the names of its own fields.
    """
    by_name = {signal.python: signal for signal in signals.values()}
    values = {
        name: _term(getattr(record, name), by_name.get(name), signals) for name in record.__dataclass_fields__
    }
    return unvalidated(type(record), values)


def _term(found: Any, signal: Signal | None, signals: Mapping[str, Signal]) -> Any:
    if isinstance(found, (Flag, Word, Number, Text, Proxy)):
        return found.term
    if signal is None or isinstance(found, Opaque):
        return found
    if isinstance(found, tuple):
        return tuple(_term(part, signal, signals) for part in found)
    if type(found) is bool:
        return z3.BoolVal(found)
    if type(found) is int:
        return z3.BitVecVal(found, WORD_BITS) if is_word(signal) else z3.IntVal(found)
    return in_terms(found, signals) if is_dataclass(found) else found

"""Takes the guards of a step apart: the conjuncts on the way from the scan to the step, then the step's own.

Each becomes an expression that a module which extends a copy of the specification (without LOCAL) can
evaluate. Definitions that are only names for conditions are opened, so that the innermost conjunct is found.
The order is the one in which TLC evaluates them, so none is evaluated where the specification would not.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from modeproof.tlc.parse_tree import AND, OR, Definition, Node, ParseTree, Place, conjuncts, disjuncts

CALL = re.compile(r"(\w+)\((.*)\)", re.DOTALL)
_COMPARED = frozenset({"=", "/=", "#", "<", ">", "\\leq", "\\geq", "=<", "<=", ">="})
_DEEPEST = 12


@dataclass(frozen=True)
class Conjunct:
    """One condition: its text and place, the calls that lead to it, and how to evaluate it.

    `meaning` is the definition behind a negated name. `expression` is TLA+ for the module that was made;
    `sides` are expressions whose values tell more, in pairs.
    """

    text: str
    place: Place
    chain: tuple[str, ...]
    meaning: str
    expression: str
    sides: tuple[str, ...]


@dataclass(frozen=True)
class Effect:
    """A conjunct that says what changes, and the variables that it sets."""

    text: str
    place: Place
    sets: frozenset[str]


class _Scope:
    """The parameters of the definition in which a text is, and what they are further out."""

    def __init__(
        self, made: list[str], params: Sequence[str], args: Sequence[str], outer: _Scope | None
    ) -> None:
        self.made = made
        self.params = params
        self.args = args
        self.outer = outer

    def lift(self, text: str) -> str:
        """The expression for a text of this scope, where all parameters are bound."""
        name = f"Made_{len(self.made) + 1}"
        head = f"{name}({', '.join(self.params)})" if self.params else name
        self.made.append(f"{head} ==\n{text}")
        call = f"{name}({', '.join(self.args)})" if self.params else name
        return call if self.outer is None else self.outer.lift(call)


@dataclass(frozen=True)
class _Condition:
    """What must hold on the way to a step; `denied`: what must not, as beyond an ELSE."""

    node: Node
    scope: _Scope
    denied: bool = False


class Guards:
    """The guards and effects of the steps of one scan action, such as `Scan(Read(w))`.

    `made` collects the definitions that the expressions need.
    """

    def __init__(self, tree: ParseTree, scan: str, steps: Sequence[str]) -> None:
        self.tree = tree
        self.made: list[str] = []
        self._steps = frozenset(steps)
        match = CALL.fullmatch(scan)
        self._root = None if match is None else tree.find(match.group(1))
        self._argument = "" if match is None else match.group(2)

    def paths(self, step: str) -> list[tuple[Conjunct, ...]]:
        """For each place where the scan can take the step, all conditions of it, in order."""
        if self._root is None or self.tree.find(step) is None:
            return []
        scope = _Scope(self.made, self._root.params, [self._argument], None)
        return [
            tuple(conjunct for known in found for conjunct in self._conjuncts(known))
            for found in self._walk(self._root.body, scope, step, ())
        ]

    def effects(self, step: str) -> tuple[Effect, ...]:
        """What a step changes, conjunct by conjunct."""
        definition = self.tree.find(step)
        if definition is None:
            return ()
        return tuple(
            Effect(self.tree.text(node.place), node.place, frozenset(self._sets(node, 0)))
            for node in conjuncts(definition.body)
            if node.level >= 2
        )

    def row(self, row: str) -> Mapping[str, tuple[str, Place, frozenset[str]]]:
        """For each output of a row its definition (text and place) and the variables that it depends on."""
        definition = self.tree.find(row)
        found = {}
        for pair in () if definition is None else definition.body.operands:
            if pair.operator == "$Pair" and len(pair.operands) == 2 and pair.operands[0].kind == "string":
                name, value = pair.operands
                named = self.tree.find(value.operator) if value.kind == "defined" else None
                place = value.place if named is None else named.place
                depends = frozenset(self._variables(value, 0))
                found[name.operator] = (self.tree.text(place), place, depends)
        return found

    def view(self, name: str) -> tuple[str, ...]:
        """The variables of a tuple."""
        definition = self.tree.find(name)
        return () if definition is None else tuple(operand.operator for operand in definition.body.operands)

    # -------------------------------------------------------------------------------------- from scan to step

    def _walk(
        self, node: Node, scope: _Scope, step: str, context: tuple[_Condition, ...]
    ) -> Iterator[tuple[_Condition, ...]]:
        if not self._leads_to(node, step):
            return
        if node.kind == "builtin" and node.operator in OR:
            for disjunct in disjuncts(node):
                yield from self._walk(disjunct, scope, step, context)
        elif node.kind == "builtin" and node.operator in AND:
            for conjunct in conjuncts(node):
                if self._leads_to(conjunct, step):
                    yield from self._walk(conjunct, scope, step, context)
                elif conjunct.level <= 1:
                    context = (*context, _Condition(conjunct, scope))
        elif node.operator == "$IfThenElse":
            condition, then, other = node.operands
            yield from self._walk(then, scope, step, (*context, _Condition(condition, scope)))
            yield from self._walk(other, scope, step, (*context, _Condition(condition, scope, denied=True)))
        elif node.operator == "$Case":
            guards = [arm.operands[0] for arm in node.operands]
            named = tuple(_Condition(guard, scope, denied=True) for guard in guards if guard.place.module)
            for guard, arm in zip(guards, node.operands, strict=True):
                own = (_Condition(guard, scope),) if guard.place.module else named
                yield from self._walk(arm.operands[1], scope, step, (*context, *own))
        elif node.kind == "defined":
            definition = self.tree.find(node.operator)
            assert definition is not None
            inner = self._inside(node, definition, scope)
            if node.operator == step:
                last = [
                    _Condition(conjunct, inner)
                    for conjunct in conjuncts(definition.body)
                    if conjunct.level <= 1
                ]
                yield (*context, *last)
            else:
                yield from self._walk(definition.body, inner, step, context)

    def _inside(self, node: Node, definition: Definition, scope: _Scope) -> _Scope:
        args = [self.tree.text(operand.place) for operand in node.operands]
        return _Scope(self.made, definition.params, args, scope)

    def _leads_to(self, node: Node, step: str) -> bool:
        for child in node.walk():
            if child.kind == "defined":
                if child.operator == step:
                    return True
                if child.operator in self._steps:
                    continue
                definition = self.tree.find(child.operator)
                if definition is not None and definition.level >= 2 and self._leads_to(definition.body, step):
                    return True
        return False

    # --------------------------------------------------------------------------------------------- conditions

    def _conjuncts(self, condition: _Condition) -> Iterator[Conjunct]:
        if not condition.denied:
            yield from self._open(condition.node, condition.scope, (), 0)
            return
        definition = self.tree.find(condition.node.operator) if condition.node.kind == "defined" else None
        text = f"~({self.tree.text(condition.node.place)})"
        meaning = "" if definition is None else self.tree.text(definition.place)
        expression = condition.scope.lift(f"~(\n{self._laid_out(condition.node)}\n)")
        yield Conjunct(text, condition.node.place, (), meaning, expression, ())

    def _open(self, node: Node, scope: _Scope, chain: tuple[str, ...], depth: int) -> Iterator[Conjunct]:
        for conjunct in conjuncts(node):
            definition = self.tree.find(conjunct.operator) if conjunct.kind == "defined" else None
            text = self.tree.text(conjunct.place)
            if definition is not None and depth < _DEEPEST and definition.body.kind != "let":
                inner = self._inside(conjunct, definition, scope)
                yield from self._open(definition.body, inner, (*chain, text), depth + 1)
            else:
                sides = [own.lift(self._laid_out(side)) for side, own in self._sides(conjunct, scope)]
                yield Conjunct(
                    text,
                    conjunct.place,
                    chain,
                    self._meaning(conjunct),
                    scope.lift(self._laid_out(conjunct)),
                    tuple(sides),
                )

    def _laid_out(self, node: Node) -> str:
        """The text of a node in the columns where it is, for columns can matter."""
        return " " * (node.place.first_column - 1) + self.tree.text(node.place, joined=False)

    def _denied(self, node: Node) -> tuple[Node, Definition] | None:
        """The call and the definition behind a negation, if it is one of ours."""
        if node.operator != "\\lnot" or node.operands[0].kind != "defined":
            return None
        definition = self.tree.find(node.operands[0].operator)
        return None if definition is None else (node.operands[0], definition)

    def _meaning(self, node: Node) -> str:
        denied = self._denied(node)
        return "" if denied is None else self.tree.text(denied[1].place)

    def _sides(self, node: Node, scope: _Scope) -> Iterator[tuple[Node, _Scope]]:
        """The two sides of a comparison, of each one of a disjunction, or of those behind a negated name.

        All these are evaluated when the node is false.
        """
        denied = self._denied(node)
        if denied is None:
            yield from ((side, scope) for disjunct in disjuncts(node) for side in _compared(disjunct))
        else:
            inner = self._inside(*denied, scope)
            yield from (
                (side, inner) for conjunct in conjuncts(denied[1].body) for side in _compared(conjunct)
            )

    # --------------------------------------------------------------------------------------------- variables

    def _sets(self, node: Node, depth: int) -> Iterator[str]:
        for child in node.walk():
            if child.operator in ("'", "UNCHANGED"):
                yield from self._variables(child.operands[0], 0)
            elif child.kind == "defined" and depth < _DEEPEST:
                definition = self.tree.find(child.operator)
                if definition is not None and definition.level >= 2:
                    yield from self._sets(definition.body, depth + 1)

    def _variables(self, node: Node, depth: int) -> Iterator[str]:
        variables = {name for names in self.tree.variables.values() for name in names}
        for child in node.walk():
            if child.kind == "declared" and child.operator in variables:
                yield child.operator
            elif child.kind == "defined" and depth < _DEEPEST:
                definition = self.tree.find(child.operator)
                if definition is not None:
                    yield from self._variables(definition.body, depth + 1)


def _compared(node: Node) -> tuple[Node, ...]:
    """The two sides of a comparison, else nothing."""
    return node.operands if node.operator in _COMPARED and len(node.operands) == 2 else ()

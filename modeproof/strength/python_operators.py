"""The mutation operators for Python: every one-edit mutant of given functions, from their syntax tree.

operator               edit
comparison swapped     == and != exchanged; < and <= exchanged, > and >= too
condition negated      a condition, or an operand of `and` or `or`, is negated (== and !=: see above)
negation dropped       not A becomes A
conjunct dropped       an operand of `and` becomes True
disjunct dropped       an operand of `or` becomes False
and, or exchanged      `and` becomes `or`, or the other way round
branch removed         the condition of an `if` or `elif` becomes False: an early return is never taken
order exchanged        two `if` next to one another change places, conditions and blocks
field unchanged        a field of the state that is built keeps its value
reset missing          the same, where the field gets its value of power-up
wrong reset            a field that shall stay gets its value of power-up
constant swapped       a control state, a text or a declared name becomes the next of its kind; a number
                       becomes n + 1, an index the next one that is used; True and False exchanged
operator swapped       + and -, & and | exchanged
term dropped           A + B becomes A
entries exchanged      two entries of a table next to one another change places

Edited are the given functions and the constants of the module that they read, not what only builds an error.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutant import Edit, Mutant, applied, identity
from modeproof.strength.python_module import Module

COMPARISONS: Mapping[type[ast.cmpop], tuple[str, str]] = {
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
}
REPLACE = "replace"
"""The function of the standard library that changes fields of a record."""
OPERATORS: Mapping[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
}


@dataclass(frozen=True)
class PythonRule:
    """What else is replaced beside the operators, and by what."""

    cycles: tuple[tuple[str, ...], ...] = ()
    """Names; each becomes the next one of its list that can be named in its place."""
    turns: tuple[tuple[str, str], ...] = ()
    """Names of which the first becomes the second, and not the other way round."""
    texts: tuple[tuple[str, ...], ...] = ()
    """Texts; each becomes the next one of its list."""
    record: str = "State"
    """The class of what a scan hands on to the next one."""
    start: str = "power_up"
    """The function that builds the first one."""


@dataclass(frozen=True)
class PythonMutant:
    """A mutant of a Python module, with the lines of the shipped text whose passing it can change.

    lines: None when any function may read what differs.
    """

    mutant: Mutant
    lines: tuple[int, int] | None


Found = tuple[str, ast.AST | tuple[ast.AST, ast.AST], str]
"""Operator, what is replaced (a node, or all from the first to the second), the new text."""


def python_mutants(
    module: Module, functions: Iterable[str], read: frozenset[str], rule: PythonRule
) -> tuple[PythonMutant, ...]:
    """All mutants of the functions, in the order of the text, and of the module's constants that are `read`.

    Two edits that give the same program are one mutant. Raises Unjudged when a function is not there.
    """
    chosen = list(functions)
    missing = sorted(set(chosen) - set(module.functions))
    if missing:
        raise Unjudged(f"{module.name}: no function {missing[0]} in the module")
    seen: set[str] = set()
    found: list[PythonMutant] = []
    counted: Counter[tuple[str, ...]] = Counter()
    for name, scope, edits in _all_edits(module, chosen, read, rule):
        seen.add(_program(module, scope, None))
        for operator, (first, last), new, lines in edits:
            edit = Edit(module.at(first, last), new)
            program = _program(module, scope, edit)
            if program in seen:
                continue
            seen.add(program)
            old = " ".join(module.source(first, last).split())
            parts = (name, operator, old, " ".join(new.split()))
            counted[parts] += 1
            id = identity(module.name, (*parts, str(counted[parts])))
            shown = Mutant(id, module.name, name, operator, edit.place.first_line, old, parts[3], edit)
            found.append(PythonMutant(shown, lines))
    return tuple(found)


_Edit = tuple[str, tuple[ast.AST, ast.AST], str, tuple[int, int] | None]


def _program(module: Module, scope: tuple[int, int], edit: Edit | None) -> str:
    """The program of these lines, with the edit made: two edits that give the same one are the same."""
    lines = module.lines[scope[0] - 1 : scope[1]]
    if edit is None:
        return _dumped("\n".join(lines))
    place, moved = edit.place, scope[0] - 1
    own = replace(place, first_line=place.first_line - moved, last_line=place.last_line - moved)
    return _dumped(applied(lines, Edit(own, edit.new)))


def _dumped(text: str) -> str:
    """The syntax of lines that may be those of a method."""
    return ast.dump(ast.parse(f"if True:\n{text}" if text.startswith(" ") else text))


def _all_edits(
    module: Module, functions: Sequence[str], read: frozenset[str], rule: PythonRule
) -> Iterator[tuple[str, tuple[int, int], list[_Edit]]]:
    """The name of each constant and function, its lines, and its edits."""
    kinds = _Kinds.of(module, rule)
    for name, value in module.constants.items():
        if name in read and not _is_member(value, module):
            found = _of_table(module, value, kinds)
            edits: list[_Edit] = [(operator, _pair(what), new, None) for operator, what, new in found]
            yield name, (value.lineno, value.end_lineno or value.lineno), edits
    for name, function in module.functions.items():
        if name in functions:
            lines = (function.lineno, function.end_lineno or function.lineno)
            yield name, lines, list(_Function(module, function, kinds, rule).edits())


def _pair(what: ast.AST | tuple[ast.AST, ast.AST]) -> tuple[ast.AST, ast.AST]:
    return what if isinstance(what, tuple) else (what, what)


def _is_member(value: ast.expr, module: Module) -> bool:
    """Another name for a member of a class of the module."""
    return (
        isinstance(value, ast.Attribute)
        and isinstance(value.value, ast.Name)
        and value.value.id in module.classes
    )


def _of_table(module: Module, value: ast.expr, kinds: _Kinds) -> Iterator[Found]:
    if isinstance(value, ast.Tuple):
        for entry, other in zip(value.elts, value.elts[1:], strict=False):
            between = _between(module, entry, other)
            yield "entries exchanged", (entry, other), module.source(other) + between + module.source(entry)
    for node in ast.walk(value):
        if isinstance(node, ast.Constant):
            for new in kinds.constant(node):
                yield "constant swapped", node, new


def _between(module: Module, node: ast.AST, other: ast.AST) -> str:
    """The text from the end of one node to the beginning of the next one."""
    whole = module.source(node, other)
    return whole[len(module.source(node)) : len(whole) - len(module.source(other))]


@dataclass(frozen=True)
class _Kinds:
    """What a name or a constant becomes."""

    module: Module
    cycles: tuple[tuple[str, ...], ...]
    turns: tuple[tuple[str, str], ...]
    texts: tuple[tuple[str, ...], ...]
    members: tuple[str, ...]
    """Names of the module that stand for members of a class."""

    @staticmethod
    def of(module: Module, rule: PythonRule) -> _Kinds:
        members = tuple(name for name, value in module.constants.items() if _is_member(value, module))
        return _Kinds(module, rule.cycles, rule.turns, rule.texts, members)

    def constant(self, node: ast.Constant) -> Iterator[str]:
        value = node.value
        if isinstance(value, bool):
            yield str(not value)
        elif isinstance(value, int):
            text = self.module.source(node)
            yield f"0x{value + 1:04X}" if text.startswith("0x") else str(value + 1)
        elif isinstance(value, str):
            for texts in self.texts:
                if value in texts and len(texts) > 1:
                    yield repr(texts[(texts.index(value) + 1) % len(texts)]).replace("'", '"')
                    return

    def name(self, name: str, there: frozenset[str]) -> Iterator[str]:
        """The next names of its lists; `there` are those that can be named."""
        for cycle in (*self.cycles, self.members):
            after = _next(name, cycle, there)
            if after:
                yield after
        yield from (after for before, after in self.turns if before == name and after in there)

    def attribute(self, node: ast.Attribute) -> Iterator[str]:
        """The next field, or member, of the same class: of every class that has such a field."""
        classes = self.module.classes
        if isinstance(node.value, ast.Name) and node.value.id in classes:
            members = classes[node.value.id]
            after = _next(node.attr, members, frozenset(members))
            if after:
                yield f"{node.value.id}.{after}"
            return
        declared = [frozenset(names) for names in classes.values() if node.attr in names]
        for cycle in self.cycles if declared else ():
            after = _next(node.attr, cycle, frozenset.intersection(*declared))
            if after:
                yield f"{self.module.source(node.value)}.{after}"


def _next(name: str, cycle: Sequence[str], there: frozenset[str]) -> str:
    """The next name of a list that is there; empty when the name is not in it, or alone."""
    if name not in cycle:
        return ""
    at = list(cycle).index(name)
    others = [*cycle[at + 1 :], *cycle[:at]]
    return next((other for other in others if other in there), "")


@dataclass
class _Function:
    """One function being edited."""

    module: Module
    function: ast.FunctionDef
    kinds: _Kinds
    rule: PythonRule

    def edits(self) -> Iterator[_Edit]:
        body = self.function.body
        yield from self._block(body[1:] if _is_docstring(body[0]) else body)

    def _block(self, statements: Sequence[ast.stmt]) -> Iterator[_Edit]:
        for number, statement in enumerate(statements):
            if isinstance(statement, ast.Raise):
                continue
            if isinstance(statement, ast.If):
                lines = (statement.lineno, statement.test.end_lineno or statement.lineno)
                for found in self._condition(statement.test):
                    yield self._edit(found, lines)
                yield "branch removed", (statement.test, statement.test), "False", lines
                other = statements[number + 1] if number + 1 < len(statements) else None
                if isinstance(other, ast.If) and not statement.orelse and not other.orelse:
                    yield self._exchanged(statement, other)
                if len(statement.orelse) == 1 and isinstance(statement.orelse[0], ast.If):
                    yield self._exchanged(statement, statement.orelse[0])
                yield from self._block(statement.body)
                yield from self._block(statement.orelse)
            else:
                lines = (statement.lineno, statement.end_lineno or statement.lineno)
                for found in self._everything(statement):
                    yield self._edit(found, lines)

    def _edit(self, found: Found, lines: tuple[int, int]) -> _Edit:
        operator, what, new = found
        return operator, _pair(what), new, lines

    def _exchanged(self, branch: ast.If, other: ast.If) -> _Edit:
        first, second = branch.test, other.test
        between = self._text(branch.body[-1], second)[len(self.module.source(branch.body[-1])) :]
        between = between[: len(between) - len(self.module.source(second))]
        new = self._text(second, other.body[-1]) + between + self._text(first, branch.body[-1])
        return (
            "order exchanged",
            (first, other.body[-1]),
            new,
            (branch.lineno, other.end_lineno or other.lineno),
        )

    def _text(self, first: ast.AST, last: ast.AST) -> str:
        return self.module.source(first, last)

    # ---- expressions

    def _condition(self, test: ast.expr) -> Iterator[Found]:
        yield from self._negated(test)
        yield from self._everything(test)

    def _negated(self, test: ast.expr) -> Iterator[Found]:
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            return
        if isinstance(test, ast.Compare) and isinstance(test.ops[0], (ast.Eq, ast.NotEq)):
            return
        yield "condition negated", test, f"(not ({self.module.source(test)}))"

    def _everything(self, root: ast.AST) -> Iterator[Found]:
        """Every edit of an expression, or of what is in a statement, in the order of the text."""
        for node in self._walk(root):
            yield from self._of_node(node)

    def _walk(self, node: ast.AST) -> Iterator[ast.AST]:
        yield node
        for child in ast.iter_child_nodes(node):
            if not isinstance(child, (ast.expr_context, ast.operator, ast.cmpop, ast.boolop, ast.unaryop)):
                yield from self._walk(child)

    def _of_node(self, node: ast.AST) -> Iterator[Found]:
        source = self.module.source
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            old, new = COMPARISONS.get(type(node.ops[0]), ("", ""))
            if old:
                left, right = source(node.left), source(node.comparators[0])
                yield "comparison swapped", node, f"{left} {new} {right}"
        elif isinstance(node, ast.BoolOp):
            yield from self._of_operands(node)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            yield "negation dropped", node, source(node.operand)
        elif isinstance(node, ast.BinOp):
            old, new = OPERATORS.get(type(node.op), ("", ""))
            if old:
                yield "operator swapped", node, f"({source(node.left)} {new} {source(node.right)})"
                if isinstance(node.op, ast.Add):
                    yield "term dropped", node, source(node.left)
        elif isinstance(node, ast.Call):
            yield from self._of_call(node)
        elif isinstance(node, ast.Subscript):
            yield from self._of_index(node)
        elif isinstance(node, ast.Constant):
            if not self._is_index(node):
                for new in self.kinds.constant(node):
                    yield "constant swapped", node, new
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            own = frozenset(argument.arg for argument in self.function.args.args)
            stored = {
                inner.id
                for inner in ast.walk(self.function)
                if isinstance(inner, ast.Name) and _stored(inner)
            }
            for new in self.kinds.name(node.id, self.module.names | own | stored):
                if new != self.function.name:  # it would never end
                    yield "constant swapped", node, new
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
            for new in self.kinds.attribute(node):
                yield "constant swapped", node, new

    def _of_operands(self, node: ast.BoolOp) -> Iterator[Found]:
        both = isinstance(node.op, ast.And)
        for operand in node.values:
            yield "conjunct dropped" if both else "disjunct dropped", operand, "True" if both else "False"
            yield from self._negated(operand)
        joined = (" or " if both else " and ").join(
            f"({self.module.source(operand)})" for operand in node.values
        )
        yield "and, or exchanged", node, f"({joined})"

    def _of_index(self, node: ast.Subscript) -> Iterator[Found]:
        if isinstance(node.slice, ast.Constant) and type(node.slice.value) is int:
            base = ast.dump(node.value)
            used = sorted(
                {
                    inner.slice.value
                    for inner in ast.walk(self.function)
                    if isinstance(inner, ast.Subscript)
                    and isinstance(inner.slice, ast.Constant)
                    and isinstance(inner.slice.value, int)
                    and ast.dump(inner.value) == base
                }
            )
            if len(used) > 1:
                after = used[(used.index(node.slice.value) + 1) % len(used)]
                yield "constant swapped", node.slice, str(after)

    def _is_index(self, node: ast.Constant) -> bool:
        return any(
            isinstance(inner, ast.Subscript) and inner.slice is node for inner in ast.walk(self.function)
        )

    def _of_call(self, node: ast.Call) -> Iterator[Found]:
        """The fields of the state that a step builds, or changes by `replace`."""
        before = next(
            (argument.arg for argument in self.function.args.args if _named(argument, self.rule.record)), ""
        )
        if not before or not isinstance(node.func, ast.Name):
            return
        first = self._first_values()
        given = self._given(node, before)
        for name, value in given.items():
            text, kept = self.module.source(value), f"{before}.{name}"
            if text != kept:
                yield "reset missing" if text == first.get(name) else "field unchanged", value, kept
            elif name in first:
                yield "wrong reset", value, first[name]
        if given and node.func.id == REPLACE:
            whole = self.module.source(node)
            for name in first.keys() - given.keys():
                yield "wrong reset", node, f"{whole.rstrip(')').rstrip(', ')}, {name}={first[name]})"

    def _given(self, node: ast.Call, before: str) -> dict[str, ast.expr]:
        """The fields that a call gives to the state, without its parameters."""
        assert isinstance(node.func, ast.Name)
        named = {keyword.arg: keyword.value for keyword in node.keywords if keyword.arg}
        if node.func.id == REPLACE:
            changed = node.args[0] if node.args else None
            found = named if isinstance(changed, ast.Name) and changed.id == before else {}
        elif node.func.id == self.rule.record:
            fields = self.module.classes.get(self.rule.record, ())
            found = {**dict(zip(fields, node.args, strict=False)), **named}
        else:
            found = {}
        return {name: value for name, value in found.items() if name != "params"}

    def _first_values(self) -> dict[str, str]:
        """The text of each field at power-up."""
        start = self.module.functions.get(self.rule.start)
        if start is None:
            return {}
        for node in ast.walk(start):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == self.rule.record
            ):
                return {name: self.module.source(value) for name, value in self._given(node, "").items()}
        return {}


def _is_docstring(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(getattr(statement.value, "value", None), str)


def _stored(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)


def _named(argument: ast.arg, name: str) -> bool:
    return isinstance(argument.annotation, ast.Name) and argument.annotation.id == name

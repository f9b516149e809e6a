"""The mutation operators: every one-edit mutant of a device module, from its parse tree.

Edited is what the declared behaviour of the module reaches inside the module. Properties, type invariants,
comments, and the names that a step records are not edited.

operator               edit
guard negated          a conjunct that is a guard is negated (a comparison: see below)
conjunct dropped       a conjunct that is a guard becomes TRUE
disjunct dropped       a disjunct of a guard becomes FALSE
action removed         a disjunct that is an action becomes FALSE (a timeout branch is one)
comparison swapped     = and #, \\in and \notin exchanged; < and <= exchanged, > and >= too
negation dropped       ~A becomes A
branches exchanged     the branches of an IF change places
case removed           the guard of one arm of a CASE with OTHER becomes FALSE
reset missing          an assignment of a constant, x' = None, becomes UNCHANGED x
assignment missing     any other assignment x' = e becomes UNCHANGED x
wrong UNCHANGED        a variable that shall stay gets its value of the initial predicate
constant swapped       a string becomes the next one of its kind, n becomes n + 1, a name the next of its
                       cycle; not where = or # compares with it, for there the comparison is swapped
operator swapped       + and -, \\cup and \\cap exchanged; A \\ B becomes A \\cap B
quantifier swapped     \\A and \\E of a guard exchanged
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutant import Edit, Mutant, applied, cut, identity, moved, one_line, wrapped
from modeproof.tlc.parse_tree import AND, OR, Definition, Node, ParseTree, Place

COMPARISONS = {
    "=": (r"=", "#"),
    "/=": (r"#|/=", "="),
    "\\in": (r"\\in\b", "\\notin"),
    "\\notin": (r"\\notin\b", "\\in"),
    "<": (r"<", "<="),
    "\\leq": (r"<=|=<|\\leq\b", "<"),
    ">": (r">", ">="),
    "\\geq": (r">=|\\geq\b", ">"),
}
EXCHANGED = {
    "+": (r"\+", "-"),
    "-": (r"-", "+"),
    "\\union": (r"\\cup\b|\\union\b", "\\cap"),
    "\\intersect": (r"\\cap\b|\\intersect\b", "\\cup"),
    "\\": (r"\\(?![a-z*/])", "\\cap"),
}
QUANTIFIERS = {"$BoundedExists": (r"\\E\b", "\\A"), "$BoundedForall": (r"\\A\b", "\\E")}


@dataclass(frozen=True)
class Rule:
    """What else is edited beside the operators, and what replaces it.

    `behaviour`: the names of the module that make up its behaviour; all that they reach in it is edited.
    `leave`: operators whose use is never edited. `kinds`: lists of strings; a string
    becomes the next one of its list. `cycles`: the same for names (the last entry may be any text). `groups`:
    definitions that only sort actions by the states in which they can fire; of these nothing but whole
    actions is removed.
    """

    behaviour: tuple[str, ...]
    leave: frozenset[str] = frozenset()
    kinds: tuple[tuple[str, ...], ...] = ()
    cycles: tuple[tuple[str, ...], ...] = ()
    groups: frozenset[str] = frozenset()


def mutants(tree: ParseTree, module: str, rule: Rule, untouched: frozenset[str]) -> tuple[Mutant, ...]:
    """All mutants of a module, in the order of the text; equal texts are one mutant.

    `untouched` are the names of properties and type invariants. Raises Unjudged when a name of the behaviour
    is not defined in the module.
    """
    return _Editor(tree, module, rule, untouched).all()


@dataclass(frozen=True)
class _Where:
    """Where an expression is: in the initial predicate; as a part of a conjunction or disjunction; as a
    conjunct of an action.
    """

    initial: bool
    part_of: str = ""
    of_action: bool = False


@dataclass(frozen=True)
class _Found:
    operator: str
    place: Place
    new: str


class _Editor:
    def __init__(self, tree: ParseTree, module: str, rule: Rule, untouched: frozenset[str]) -> None:
        if module not in tree.definitions:
            raise Unjudged(f"module {module} is not among those that {tree.root} uses")
        self._tree = tree
        self._module = module
        self._rule = rule
        self._untouched = untouched
        self._own: Mapping[str, Definition] = tree.definitions[module]
        self._variables = frozenset(tree.variables.get(module, ()))
        self._lines: Sequence[str] = tree.texts[module]
        self._next_string = _successors(rule.kinds)
        self._next_name = _successors(rule.cycles)
        self._initial = self._initial_values()

    def all(self) -> tuple[Mutant, ...]:
        seen: set[str] = set()
        counted: Counter[tuple[str, ...]] = Counter()
        made: list[Mutant] = []
        for definition in sorted(self._reached(), key=lambda reached: reached.place):
            found = self._visit(definition.body, _Where(initial=definition.name in self._initial_names))
            if definition.name in self._rule.groups:
                found = (mutant for mutant in found if mutant.operator == "action removed")
            for mutant in sorted(found, key=lambda mutant: (mutant.place, mutant.operator)):
                text = applied(self._lines, Edit(mutant.place, mutant.new))
                if text in seen:
                    continue
                seen.add(text)
                old, new = one_line(cut(self._lines, mutant.place)), one_line(mutant.new)
                key = (definition.name, mutant.operator, old, new)
                counted[key] += 1
                made.append(
                    Mutant(
                        id=identity(self._module, (*key, str(counted[key]))),
                        module=self._module,
                        definition=definition.name,
                        operator=mutant.operator,
                        line=mutant.place.first_line,
                        old=old,
                        new=new,
                        edit=Edit(mutant.place, mutant.new),
                    )
                )
        return tuple(made)

    # -------------------------------------------------------------------------------- what is edited

    def _reached(self) -> list[Definition]:
        """The definitions of the module that its behaviour reaches."""
        missing = [name for name in self._rule.behaviour if name not in self._own]
        if missing:
            raise Unjudged(f"module {self._module} does not define {missing[0]}, a name of its behaviour")
        waiting = [self._own[name] for name in self._rule.behaviour]
        reached: dict[str, Definition] = {}
        while waiting:
            definition = waiting.pop()
            if (
                definition.name in reached
                or definition.name in self._untouched
                or self._left_alone(definition.name)
            ):
                continue
            reached[definition.name] = definition
            for node in self._parts(definition.body):
                if node.kind == "defined" and node.operator in self._own:
                    waiting.append(self._own[node.operator])
        return list(reached.values())

    def _left_alone(self, name: str) -> bool:
        return name in self._rule.leave

    def _parts(self, node: Node) -> Iterator[Node]:
        """The node and all nodes below it, without those that are left alone."""
        yield node
        for part in self._parts_of(node):
            yield from self._parts(part)

    def _parts_of(self, node: Node) -> tuple[Node, ...]:
        if node.kind == "defined" and self._left_alone(node.operator):
            return ()
        inner = tuple(domain for _, domain in node.bound if domain is not None)
        return inner + tuple(definition.body for definition in node.definitions) + node.operands

    # -------------------------------------------------------------------------------- initial values

    @property
    def _initial_names(self) -> frozenset[str]:
        return frozenset(name for name, _ in self._initial_found)

    def _initial_values(self) -> dict[str, str]:
        """Each variable's value as the initial predicate writes it: the definition that sets them all."""
        self._initial_found: list[tuple[str, dict[str, str]]] = []
        for definition in self._own.values():
            values: dict[str, str] = {}
            for node in definition.body.walk():
                if node.operator == "=" and node.kind == "builtin" and node.operands[0].kind == "declared":
                    values[node.operands[0].operator] = one_line(cut(self._lines, node.operands[1].place))
            if self._variables and set(values) >= self._variables and not definition.params:
                self._initial_found.append((definition.name, values))
        return self._initial_found[0][1] if self._initial_found else {}

    # -------------------------------------------------------------------------------- the edits

    def _visit(self, node: Node, where: _Where) -> Iterator[_Found]:
        if node.kind == "defined" and self._left_alone(node.operator):
            return
        if where.of_action and self._is_place_guard(node):
            return
        yield from self._edits(node, where)
        if node.kind == "builtin" and node.operator == "UNCHANGED":
            return
        parts = self._parts_of(node)
        if self._assigned(node) is not None or (where.initial and node.operator == "="):
            parts = node.operands[1:]
        elif node.kind == "builtin" and node.operator in ("=", "/="):
            parts = tuple(part for part in parts if not self._is_constant(part))
        inner = where
        if node.operator not in AND | OR:
            inner = _Where(where.initial)
        elif len(parts) > 1:
            of_action = node.operator in AND and (where.of_action or node.level >= 2)
            inner = _Where(where.initial, "and" if node.operator in AND else "or", of_action)
        for part in parts:
            yield from self._visit(part, inner)

    def _is_place_guard(self, node: Node) -> bool:
        """`state = "Name"` or `At("Name", i)` as a conjunct of a step: it says where the step belongs.

        To negate it is to remove the step, which is done anyhow; to drop it changes nothing where a group
        repeats it.
        """
        if node.level > 1:
            return False
        if node.kind == "builtin" and node.operator == "=":
            return node.operands[0].kind == "declared" and node.operands[1].kind == "string"
        return node.kind == "defined" and any(operand.kind == "string" for operand in node.operands)

    def _edits(self, node: Node, where: _Where) -> Iterator[_Found]:
        if not node.place.module:
            return
        if node.kind == "string":
            yield from self._string(node)
        elif node.kind == "number":
            yield self._replaced("constant swapped", node, str(int(node.operator) + 1))
        elif node.operator in COMPARISONS or node.operator in EXCHANGED:  # those of Naturals are "defined"
            yield from self._builtin(node, where.initial)
        elif node.kind in ("defined", "declared", "parameter"):
            yield from self._name(node)
        elif node.kind == "builtin":
            yield from self._builtin(node, where.initial)
        if where.part_of and not where.initial and node.operator not in AND | OR:
            yield from self._part(node, where.part_of)

    def _part(self, node: Node, part_of: str) -> Iterator[_Found]:
        """A conjunct or disjunct, which is none of both itself."""
        if part_of == "or":
            operator = "action removed" if node.level >= 2 else "disjunct dropped"
            yield self._replaced(operator, node, "FALSE")
        elif node.level <= 1 and node.kind != "let":
            yield self._replaced("conjunct dropped", node, "TRUE")
            if node.operator not in COMPARISONS and node.operator != "\\lnot":
                text = cut(self._lines, node.place)
                yield self._replaced("guard negated", node, wrapped(text, "~(", ")"))

    def _builtin(self, node: Node, initial: bool) -> Iterator[_Found]:
        operator, operands = node.operator, node.operands
        assigned = self._assigned(node)
        if assigned is not None:
            if operands[1].kind == "declared" and operands[1].operator == assigned:
                return
            constant = operands[1].level == 0 and operands[1].kind in (
                "string",
                "number",
                "defined",
                "builtin",
            )
            kind = "reset missing" if constant and not operands[1].operands else "assignment missing"
            yield self._replaced(kind, node, f"UNCHANGED {assigned}")
        elif operator in COMPARISONS and node.level <= 1 and not (initial and operator == "="):
            yield from self._token(node, "comparison swapped", *COMPARISONS[operator])
        elif operator in EXCHANGED and len(operands) == 2:
            yield from self._token(node, "operator swapped", *EXCHANGED[operator])
        elif operator in QUANTIFIERS and node.level <= 1:
            yield from self._quantifier(node, *QUANTIFIERS[operator])
        elif operator == "\\lnot":
            text = cut(self._lines, operands[0].place)
            back = node.place.first_column - operands[0].place.first_column
            inner = "(" + moved(text, back + 1) + ")" if "\n" in text else f"({text})"
            yield self._replaced("negation dropped", node, inner)
        elif operator == "$IfThenElse":
            yield from self._branches(node)
        elif operator == "$Case" and any(not arm.operands[0].place.module for arm in operands):
            for arm in operands:
                if arm.operands[0].place.module:
                    yield self._replaced("case removed", arm.operands[0], "FALSE")
        elif operator == "UNCHANGED":
            yield from self._unchanged(node)

    def _string(self, node: Node) -> Iterator[_Found]:
        quoted = cut(self._lines, node.place).startswith('"')
        if quoted:
            for new in self._next_string.get(node.operator, ()):
                yield self._replaced("constant swapped", node, f'"{new}"')
        else:  # the field of a record
            for new in self._next_name.get(node.operator, ()):
                yield self._replaced("constant swapped", node, new)

    def _name(self, node: Node) -> Iterator[_Found]:
        text = cut(self._lines, node.place)
        for new in self._next_name.get(node.operator, ()):
            if text.startswith(node.operator):
                end = node.place.first_column + len(node.operator) - 1
                place = Place(node.place.module, node.place.first_line, node.place.first_column,
                              node.place.first_line, end)  # fmt: skip
                yield _Found("constant swapped", place, new)

    def _token(self, node: Node, operator: str, pattern: str, new: str) -> Iterator[_Found]:
        """The operator sign between two operands."""
        left, right = node.operands[0].place, node.operands[1].place
        if left.last_line != right.first_line:
            return
        gap = self._lines[left.last_line - 1][left.last_column : right.first_column - 1]
        match = re.search(pattern, gap)
        if match is None:
            return
        first = left.last_column + match.start() + 1
        place = Place(node.place.module, left.last_line, first, left.last_line, first + len(match[0]) - 1)
        yield _Found(operator, place, new)

    def _quantifier(self, node: Node, pattern: str, new: str) -> Iterator[_Found]:
        match = re.match(pattern, cut(self._lines, node.place))
        if match is not None:
            place = node.place
            end = place.first_column + len(match[0]) - 1
            yield _Found(
                "quantifier swapped",
                Place(place.module, place.first_line, place.first_column, place.first_line, end),
                new,
            )

    def _branches(self, node: Node) -> Iterator[_Found]:
        condition, then, other = (cut(self._lines, operand.place) for operand in node.operands)
        if "\n" in then or "\n" in other or "\n" in condition:
            columns = node.place.first_column - 1
            lines = [f"IF {one_line(condition)}", f"THEN {one_line(other)}", f"ELSE {one_line(then)}"]
            if any(re.search(r"^\s*(/\\|\\/)", branch) for branch in (then, other)):
                return  # bullets cannot be joined to one line
            yield self._replaced("branches exchanged", node, ("\n" + " " * columns).join(lines))
            return
        yield self._replaced("branches exchanged", node, f"IF {condition} THEN {other} ELSE {then}")

    def _unchanged(self, node: Node) -> Iterator[_Found]:
        names = self._tuple_names(node.operands[0])
        for name in names:
            if name not in self._initial:
                continue
            rest = [other for other in names if other != name]
            kept = f" /\\ UNCHANGED <<{', '.join(rest)}>>" if rest else ""
            yield self._replaced("wrong UNCHANGED", node, f"({name}' = {self._initial[name]}{kept})")

    def _tuple_names(self, node: Node) -> list[str]:
        if node.kind == "declared" and node.operator in self._variables:
            return [node.operator]
        if node.kind == "builtin" and node.operator == "$Tuple":
            return [name for operand in node.operands for name in self._tuple_names(operand)]
        if node.kind == "defined" and node.operator in self._own and not node.operands:
            return self._tuple_names(self._own[node.operator].body)
        return []

    def _is_constant(self, node: Node) -> bool:
        """A string, a number, or a name of a constant without parts."""
        return node.level == 0 and not node.operands and node.kind in ("string", "number", "defined")

    def _assigned(self, node: Node) -> str | None:
        """The variable x of x' = e."""
        if node.kind != "builtin" or node.operator != "=" or node.level < 2:
            return None
        left = node.operands[0]
        if left.kind == "builtin" and left.operator == "'" and left.operands[0].kind == "declared":
            return left.operands[0].operator
        return None

    def _replaced(self, operator: str, node: Node, new: str) -> _Found:
        return _Found(operator, node.place, new)


def _successors(lists: Sequence[Sequence[str]]) -> dict[str, list[str]]:
    """For each entry those that come after it, cyclically, in the lists where it is."""
    after: dict[str, list[str]] = {}
    for names in lists:
        for name, new in zip(names, (*names[1:], names[0]), strict=True):
            if new not in after.setdefault(name, []) and new != name:
                after[name].append(new)
    return after

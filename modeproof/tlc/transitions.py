"""A module whose next-state relation itself checks the action properties, on every transition.

TLC's distributed mode checks what is in PROPERTIES on a transition to a *new* state only, reports success for
a property that breaks on any other, and leaves fairness and ASSUME out. So the action properties are asserted
in the next-state relation of a generated module, where no transition escapes them, and what has another form
than `[][A]_v`, or `Init /\\ [][Next]_vars` (of an instance as well), is refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import COMMENT, Cfg
from modeproof.tlc.parse_tree import Definition, Node, ParseTree, Place, conjuncts

PREFIX = "Every_"
EXTENDS = re.compile(r"^EXTENDS\s+((?:\w+\s*,\s*)*\w+)", re.MULTILINE)
_STATE, _ACTION = 1, 2
"""Levels of an expression: up to 1 it speaks of one state, up to 2 of one transition."""


@dataclass(frozen=True)
class Rewritten:
    """A module that extends the run's own, and the cfg for it; `asserted` are the properties it asserts."""

    module: str
    text: str
    cfg: str
    asserted: tuple[str, ...]


def rewrite(tree: ParseTree, cfg: Cfg, cfg_text: str, name: str) -> Rewritten:
    """The module that asserts the action properties of `cfg` on every transition of `tree`'s specification.

    Raises Unjudged, naming the property or the specification, when it has a form that is not understood.
    `name` is used in errors only.
    """
    lines: list[str] = []
    asserted: list[str] = []
    for prop in cfg.properties:
        actions = [_action(tree, node, f"{name}: property {prop}") for node in _parts(tree, prop, name)]
        texts = [text for text in actions if text]
        for number, text in enumerate(texts):
            lines.append(f"{PREFIX}{prop}_{number} ==\n{text}")
        if texts:
            asserted.append(prop)
            checks = " /\\ ".join(f"{PREFIX}{prop}_{number}" for number in range(len(texts)))
            lines.append(f'{PREFIX}{prop} == Assert({checks}, "{prop}")')
    clean = COMMENT.sub(" ", cfg_text)
    initial, step = _specification(tree, clean, name)
    lines.append(f"{PREFIX}Init ==\n{initial}")
    lines.append(f"{PREFIX}Step ==\n{step}")
    calls = [f"{PREFIX}{prop}" for prop in asserted]
    lines.append(f"{PREFIX}Next == " + " /\\ ".join([f"{PREFIX}Step", *calls]))
    variable = next(names[0] for visible in _visible(tree) if (names := tree.variables.get(visible)))
    lines.append(f"{PREFIX}Nothing == {variable} # {variable}")  # a plain FALSE is an error for TLC
    module = f"{PREFIX}{tree.root}"
    head = f"---- MODULE {module} ----\nEXTENDS {tree.root}\nLOCAL INSTANCE TLC\n"
    text = head + "\n".join(lines) + "\n====\n"
    start = f"INIT {PREFIX}Init\nNEXT {PREFIX}Next\n"
    kept = re.sub(r"\b(SPECIFICATION|INIT|NEXT)\s+\w+", " ", clean)
    return Rewritten(module, text, kept + "\n" + start, tuple(asserted))


def _visible(tree: ParseTree) -> Iterator[str]:
    """The root module and all that it extends, not what it instantiates."""
    waiting, seen = [tree.root], set()
    while waiting:
        module = waiting.pop(0)
        if module in seen or module not in tree.texts:
            continue
        seen.add(module)
        yield module
        found = EXTENDS.search("\n".join(tree.texts[module]))
        waiting += re.split(r"\s*,\s*", found.group(1)) if found else []


def _definition(tree: ParseTree, name: str) -> Definition | None:
    for module in _visible(tree):
        if name in tree.definitions.get(module, {}):
            return tree.definitions[module][name]
    return None


def _parts(tree: ParseTree, prop: str, name: str) -> tuple[Node, ...]:
    found = _definition(tree, prop)
    if found is None or found.params:
        raise Unjudged(f"{name}: property {prop}: no definition in the modules of {tree.root}")
    return conjuncts(found.body)


def _action(tree: ParseTree, node: Node, where: str) -> str:
    """The part of a property that speaks of a transition, as text; "" if it speaks of a first state."""
    if node.level <= _STATE:
        return ""  # TLC checks it where the initial states are made
    if _is_box(node):
        return _padded(tree, node.operands[0].place)
    if node.kind == "defined" and "!" in node.operator and not node.operands:
        return _instance(tree, node.operator, where)
    said = tree.text(node.place)[:60]
    raise Unjudged(f"{where}: `{said}` cannot be judged in distributed mode; check it without --distributed")


def _is_box(node: Node) -> bool:
    """Whether it is `[][A]_v` with a transition A."""
    return (
        node.kind == "builtin"
        and node.operator == "[]"
        and node.operands[0].kind == "builtin"
        and node.operands[0].operator == "$SquareAct"
        and node.operands[0].level <= _ACTION
    )


def _instance(tree: ParseTree, operator: str, where: str) -> str:
    """`[I!Next]_(I!vars)` for `I!Spec` with Spec == Init /\\ [][Next]_vars in the module of instance I."""
    instance, _, inner = operator.partition("!")
    pattern = re.compile(rf"^\s*{re.escape(instance)}\s*==\s*INSTANCE\s+(\w+)", re.MULTILINE)
    modules = [m.group(1) for lines in tree.texts.values() for m in pattern.finditer("\n".join(lines))]
    found = tree.definitions.get(modules[0], {}).get(inner) if len(modules) == 1 else None
    parts = () if found is None else conjuncts(found.body)
    boxes = [part.operands[0] for part in parts if _is_box(part)]
    first = [part for part in parts if part.level <= _STATE]
    if len(boxes) != 1 or len(boxes) + len(first) != len(parts):
        raise Unjudged(
            f"{where}: {operator} is not of the form Init /\\ [][Next]_vars; check it without --distributed"
        )
    step, variables = boxes[0].operands
    if any(operand.kind != "defined" or operand.operands for operand in (step, variables)):
        raise Unjudged(f"{where}: {operator}: Next and vars must be names; check it without --distributed")
    return f"    [{instance}!{step.operator}]_({instance}!{variables.operator})"


def _specification(tree: ParseTree, clean_cfg: str, name: str) -> tuple[str, str]:
    """The texts of the initial condition and of the next-state relation that a cfg names."""
    names = dict(re.findall(r"\b(SPECIFICATION|INIT|NEXT)\s+(\w+)", clean_cfg))
    if "INIT" in names and "NEXT" in names:
        return f"    {names['INIT']}", f"    {names['NEXT']}"
    found = _definition(tree, names.get("SPECIFICATION", ""))
    parts = () if found is None else conjuncts(found.body)
    boxes = [part.operands[0].operands[0] for part in parts if _is_box(part)]
    first = [part for part in parts if part.level <= _STATE]
    if len(boxes) != 1 or not first or len(first) + 1 != len(parts):
        raise Unjudged(
            f"{name}: the specification is not of the form Init /\\ [][Next]_vars (fairness is not judged in "
            "distributed mode); check it without --distributed"
        )
    initial = "\n".join(f"    /\\ (\n{_padded(tree, part.place)}\n       )" for part in first)
    return initial, _padded(tree, boxes[0].place)


def _padded(tree: ParseTree, place: Place) -> str:
    """The text at a place in the columns in which it stands: a list of bullets lives by them."""
    return " " * (place.first_column - 1) + tree.text(place, joined=False)

"""The module and the cfg that put a tier's question to TLC.

TLC stops at the first violation. To learn all that a mutant breaks, a generated module evaluates every
property of the run itself: invariants in each state, the formula P of `[][P]_v` in each step, and prints the
name of a property once when it is false. Exploration goes on, except beyond states that break a type.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import Cfg, parse_cfg
from modeproof.strength.register import Tier
from modeproof.tlc.parse_tree import AND, Definition, Node, ParseTree

MODULE = "StrengthTrial"
REGISTER = 911
"""The number of TLC's own register that holds the names printed so far."""
BROKEN = re.compile(rb'<<"BROKEN", "(\w+)">>')
_CHECKED = re.compile(
    r"^[ \t]*(?:INVARIANTS?|PROPERTY|PROPERTIES|ACTION[_-]CONSTRAINTS?|CONSTRAINTS?)\b[^\n]*\n"
    r"(?:(?![ \t]*[A-Z_]{4,}\b)[^\n]+\n)*",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Trial:
    """What TLC gets: the texts of the generated module and of its cfg, and the names that are asked for."""

    module: str
    cfg: str
    asked: tuple[str, ...]


def make_trial(tree: ParseTree, tier: Tier, given: str) -> Trial:
    """The trial of a tier on the specification in `tree`, whose root is the module of the tier's run.

    Raises Unjudged when the cfg or a property cannot be taken apart.
    """
    name = tier.run.config
    text = with_constants(given, tier.constants, name)
    cfg = parse_cfg(given, name)
    head = [f"---- MODULE {MODULE} ----", f"EXTENDS {tier.run.module}, TLC", tier.definitions]
    if tier.asks == "graph":
        body, checks, asked = _graph(tree, text)
    elif tier.asks == "liveness":
        body, checks, asked = [], f"PROPERTY {cfg.properties[0]}\n", cfg.properties
    else:
        body, checks, asked = _properties(tree, tier, cfg)
    module = "\n".join([*head, *body, "====", ""])
    return Trial(module, _CHECKED.sub("", text) + checks, asked)


def with_constants(text: str, constants: Mapping[str, str], name: str) -> str:
    """The text of a cfg with constants replaced; one that it does not set is added."""
    added: list[str] = []
    for constant, value in constants.items():
        pattern = rf"(?<![\w]){constant}\s*(?:=|<-)\s*(?:\"[^\"]*\"|\{{[^}}]*\}}|[\w-]+)"
        entry = f"{constant} {value}" if value.startswith("<-") else f"{constant} = {value}"
        found = re.findall(pattern, text)
        if len(found) > 1:
            raise Unjudged(f"{name}: constant {constant} is set {len(found)} times")
        if found:
            text = text.replace(found[0], entry)
        else:
            added.append(f"    {entry}\n")
    return text.rstrip("\n") + "\n" + (f"CONSTANTS\n{''.join(added)}" if added else "")


def _graph(tree: ParseTree, given: str) -> tuple[list[str], str, tuple[str, ...]]:
    """Keep what prints: the checked names of the cfg whose definitions mention PrintT."""
    kept: list[str] = []
    for line in _CHECKED.findall(given):
        keyword, *names = line.split()
        for name in names:
            definition = tree.find(name)
            if definition is not None and _prints(definition):
                kept.append(f"{keyword} {name}\n")
    if not kept:
        raise Unjudged("nothing that the cfg of a graph checks prints anything")
    return [], "".join(kept), ()


def _properties(tree: ParseTree, tier: Tier, cfg: Cfg) -> tuple[list[str], str, tuple[str, ...]]:
    asked: list[str] = []
    states: list[str] = []
    steps: list[tuple[str, str, str]] = []
    for name in cfg.checked:
        definition = tree.find(name)
        if definition is None:
            raise Unjudged(f"{tier.run.config}: {name} is not defined in our modules")
        if _prints(definition):
            continue
        asked.append(name)
        if definition.body.level <= 1:
            states.append(name)
        else:
            steps += [(name, act, view) for act, view in _taken_apart(tree, definition)]
    body = [
        f"ASSUME TLCSet({REGISTER}, {{}})",
        "StrengthReport(name, holds) ==",
        f"    IF holds THEN TRUE ELSE IF name \\in TLCGet({REGISTER}) THEN TRUE",
        f"    ELSE TLCSet({REGISTER}, TLCGet({REGISTER}) \\cup {{name}})",
        '         /\\ PrintT(ToString(<<"BROKEN", name>>))',
    ]
    for number, (_, act, view) in enumerate(steps):
        unchanged = f" \\/ UNCHANGED StrengthView{number}" if view else ""
        body += [f"StrengthAct{number} ==", act, *([f"StrengthView{number} ==", view] if view else [])]
        body += [f"StrengthStep{number} == StrengthAct{number}{unchanged}"]
    body += ["StrengthStates ==", "    /\\ TRUE"]
    body += [f'    /\\ StrengthReport("{name}", {name})' for name in states]
    body += ["StrengthSteps ==", "    /\\ TRUE"]
    body += [f'    /\\ StrengthReport("{name}", StrengthStep{n})' for n, (name, _, _) in enumerate(steps)]
    body += [f"    /\\ {name}" for name in tier.types]
    checks = "INVARIANT StrengthStates\nACTION_CONSTRAINT StrengthSteps\n"
    return body, checks, tuple(asked)


def _prints(definition: Definition) -> bool:
    return any(node.operator == "PrintT" for node in definition.body.walk())


def _taken_apart(tree: ParseTree, definition: Definition) -> list[tuple[str, str]]:
    """A property about steps as pairs of texts, P and v of [][P]_v; v is empty where P is judged always."""
    body = definition.body
    if body.kind == "defined" and "!" in body.operator:
        return _of_instance(tree, definition, body.operator)
    if body.operator == "[]" and body.operands[0].operator == "$SquareAct":
        act, view = body.operands[0].operands
        return [(_in_place(tree, act), _in_place(tree, view))]
    raise Unjudged(f"{definition.name} is neither an invariant nor [][P]_v; ask for it in a tier on liveness")


def _of_instance(tree: ParseTree, definition: Definition, name: str) -> list[tuple[str, str]]:
    """`Instance!Spec`, where Spec is a conjunction of names and of [][Name]_name; a name is about the first
    state.
    """
    instance, inner = name.split("!", 1)
    source = "\n".join(tree.texts[definition.place.module])
    declared = re.search(rf"^\s*{instance}\s*==\s*INSTANCE\s+(\w+)", source, re.MULTILINE)
    target = tree.definitions.get(declared[1], {}).get(inner) if declared else None
    if target is None:
        raise Unjudged(f"{definition.name}: {name} is not found")
    found: list[tuple[str, str]] = []
    for part in _conjuncts(target.body):
        if part.kind == "defined" and part.level <= 1:
            found.append((f'    TLCGet("level") > 1 \\/ {instance}!{part.operator}', ""))
            continue
        act = part.operands[0] if part.operator == "[]" else None
        if (
            act is None
            or act.operator != "$SquareAct"
            or any(operand.kind != "defined" for operand in act.operands)
        ):
            raise Unjudged(f"{definition.name}: a part of {name} is neither a name nor [][Name]_name")
        action, view = (f"    {instance}!{operand.operator}" for operand in act.operands)
        found.append((action, view))
    return found


def _conjuncts(node: Node) -> list[Node]:
    return (
        [part for operand in node.operands for part in _conjuncts(operand)]
        if node.operator in AND
        else [node]
    )


def _in_place(tree: ParseTree, node: Node) -> str:
    """The text of an expression, its first line as far to the right as in its file, so that bullets align."""
    return " " * (node.place.first_column - 1) + tree.text(node.place, joined=False)

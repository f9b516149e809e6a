"""A view contains every variable whose value before a step a checked property reads.

TLC keeps one state of those that look alike in a view. What the view hides is then that of one way there, and
a property that reads it is judged on that way alone. With a prime it is what the step just made, in each one.
Where that does no harm, `[hidden]` in runs.toml says why.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import Cfg
from modeproof.registers.made import Replacement, read_cfg, replaced_by
from modeproof.registers.rows import Document, Problem
from modeproof.registers.runs import ASKING, hidden_of
from modeproof.registers.tla import Module, closure

_SUBSCRIPT = re.compile(r"\]_(?:\w+|<<.*?>>)", re.DOTALL)
_NAME = re.compile(r"(?<![\\\w!])([A-Za-z_]\w*)(\s*')?")
_FIRST = re.compile(r'\bstep\s*(?:=|#)\s*""')
"""Whether there was a step at all: so every state of the beginning is told from all others."""


def check_views(document: Document, modules: Mapping[str, Module]) -> Iterator[Problem]:
    """Runs in whose view a checked property reads what is hidden, and reasons that are not needed."""
    file = document.source("runs")
    excused = hidden_of(document.root, document.name)
    found: dict[str, str] = {}
    for run in (run for run in document.runs if run.kind in ASKING):
        try:
            cfg, replaced = read_cfg(document.root, run), replaced_by(modules, run)
        except Unjudged:
            continue  # said where runs are looked at
        for variable in sorted(hidden_reads(modules, run.module, cfg, replaced)):
            if found.setdefault(variable, run.id) == run.id and variable not in excused:
                text = f"its view {cfg.view} hides {variable}, which a checked property reads"
                yield Problem(file, run.id, text)
    for variable in excused:
        if variable not in found:
            yield Problem(file, f"hidden.{variable}", "no view hides it from a property that reads it")


def hidden_reads(
    modules: Mapping[str, Module], module: str, cfg: Cfg, replaced: Sequence[Replacement] = ()
) -> set[str]:
    """The variables that a checked name reads and the view hides, with these operators replaced."""
    if not cfg.view:
        return set()
    there = {
        one.name: one
        for name in (module, *(replacement.module for replacement in replaced))
        for one in closure(modules, name, instances=False)
    }
    instead = {replacement.replaced: replacement.operator for replacement in replaced}
    shown = _reads(there.values(), (cfg.view,), instead)
    checked = tuple(name for name in cfg.checked if not name.startswith("Print"))
    return _reads(there.values(), checked, instead) - shown


def _reads(modules: Iterable[Module], names: Iterable[str], instead: Mapping[str, str]) -> set[str]:
    """The variables that these definitions read without a prime, directly or through others."""
    bodies = {one.name: one for module in modules for one in module.definitions}
    variables = {name for module in modules for name in module.variables}
    found: set[str] = set()
    waiting, done = list(names), set[str]()
    while waiting:
        name = waiting.pop()
        name = instead.get(name, name)
        if name in done or name not in bodies:
            continue
        done.add(name)
        body = bodies[name].body.partition("==")[2]
        body = re.sub(r'"[^"\n]*"', " ", _SUBSCRIPT.sub("]", _FIRST.sub(" ", body)))
        for word, prime in _NAME.findall(body):
            if prime:
                continue
            if word in variables:
                found.add(word)
            elif word in bodies:
                waiting.append(word)
    return found

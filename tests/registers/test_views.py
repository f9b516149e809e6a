"""A view contains every variable whose value before a step a checked property reads.

TLC keeps one state of those that look alike in a view. What the view hides is then that of one way there, and
a property that reads it is judged on that way alone. With a prime it is what the step just made, in each one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from modeproof.ground.places import documents, machines
from modeproof.registers.cfg import Cfg
from modeproof.registers.made import read_cfg
from modeproof.registers.runs import load_runs
from modeproof.registers.tla import Module, closure, read_modules, scan

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [name for name in documents(ROOT) if name not in machines(ROOT)]
_SUBSCRIPT = re.compile(r"\]_(?:\w+|<<.*?>>)", re.DOTALL)
_NAME = re.compile(r"(?<![\\\w!])([A-Za-z_]\w*)(\s*')?")
_FIRST = re.compile(r'\bstep\s*(?:=|#)\s*""')
"""Whether there was a step at all: so every state of the beginning is told from all others."""

BY_VIEW = "A-17: no step reads the mode; MC_KeyFlows_smoke judges the same with it in the view"
WITHOUT_HISTORY = "A-17: of these runs only the check of types reads what the user did"
SEEN_IN_EDGES = "EdgesAreRemembered shows that the edges in the view are what these inputs were"
OWN_TIMER = "the timer of the device is in the view and counts the same; no run shows that"
ALLOWED: Mapping[tuple[str, str], str] = {
    ("mode_selection", "mode"): BY_VIEW,
    ("mode_selection", "touched"): WITHOUT_HISTORY,
    ("mode_selection", "seen"): WITHOUT_HISTORY,
    ("mode_selection", "confirmed"): WITHOUT_HISTORY,
    ("mode_selection", "lasted"): OWN_TIMER,
    ("testable_safety_sensor", "in"): SEEN_IN_EDGES,
}
"""Variables that a view may hide though a property reads them, each with its reason."""


def reads(modules: tuple[Module, ...], names: tuple[str, ...]) -> set[str]:
    """The variables that these definitions read without a prime, directly or through others."""
    bodies = {one.name: one for module in modules for one in module.definitions}
    variables = {name for module in modules for name in module.variables}
    found: set[str] = set()
    waiting, done = list(names), set[str]()
    while waiting:
        name = waiting.pop()
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


def hidden_reads(modules: Mapping[str, Module], module: str, cfg: Cfg) -> set[str]:
    """The variables that a checked name reads and the view hides."""
    if not cfg.view:
        return set()
    there = closure(modules, module, instances=False)
    shown = reads(there, (cfg.view,))
    checked = tuple(name for name in cfg.checked if not name.startswith("Print"))
    return reads(there, checked) - shown


def of_document(name: str) -> set[tuple[str, str]]:
    """The document and each variable that one of its runs hides though a property reads it."""
    modules = read_modules(ROOT, name)
    runs = [run for run in load_runs(ROOT, name) if run.kind in ("MC", "OPEN") and not run.readings]
    assert runs
    found = [hidden_reads(modules, run.module, read_cfg(ROOT, run)) for run in runs]
    return {(name, variable) for variables in found for variable in variables}


def test_no_view_hides_what_a_property_reads() -> None:
    found = set().union(*(of_document(name) for name in DOCUMENTS))
    assert found == set(ALLOWED)


TOY = """---- MODULE Toy ----
VARIABLES state, step, in, beat
View == state
Seen == [n |-> in]
Safe == [][step' = "Go" => state' = Other(in')]_beat
First == step = "" => state = 0 /\\ beat \\in BOOLEAN
Turns == [][step' = "Go" => step = "Stop"]_beat
Through == Seen.n = 1
====
"""


@pytest.mark.parametrize(
    ("checked", "hidden"),
    [("Safe", set()), ("First", {"beat"}), ("Turns", {"step"}), ("Through", {"in"}), ("PrintAll", set())],
)
def test_a_hidden_variable_is_found_unless_primed(checked: str, hidden: set[str]) -> None:
    module = scan(TOY, "Toy", "Toy.tla")
    assert hidden_reads({"Toy": module}, "Toy", Cfg(properties=(checked,), view="View")) == hidden
    assert hidden_reads({"Toy": module}, "Toy", Cfg(properties=(checked,))) == set()

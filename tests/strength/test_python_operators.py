"""The operators on Python: which edits are made is a rule, and their ids do not depend on lines."""

from __future__ import annotations

import ast

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutant import applied
from modeproof.strength.python_module import Module
from modeproof.strength.python_operators import PythonMutant, PythonRule, python_mutants

DOOR = '''
from dataclasses import dataclass
from enum import Enum

TABLE = (3, 5)
LIMIT = 9


class Step(Enum):
    SHUT = "Shut"
    OPEN = "Open"
    STUCK = "Stuck"


@dataclass(frozen=True)
class State:
    params: int
    state: Step
    count: int
    key: int


@dataclass(frozen=True)
class Inputs:
    push: bool
    pull: bool
    word: int


def power_up(params: int) -> State:
    return State(params, Step.SHUT, 0, 1)


def step(s: State, i: Inputs) -> State:
    """Not edited: LIMIT, s.count == 0."""
    if i.push and not i.pull:
        return State(s.params, Step.OPEN, 0, s.key)
    if s.count >= LIMIT or i.word == TABLE[0]:
        return State(s.params, Step.STUCK, s.count + 1, TABLE[1])
    if s.state == Step.STUCK:
        raise ValueError("LIMIT")
    return s


def unused(i: Inputs) -> bool:
    return i.push
'''
RULE = PythonRule(cycles=(("push", "pull"),), turns=(("LIMIT", "TABLE"),), texts=(("Shut", "Open"),))


def mutants_of(text: str) -> tuple[PythonMutant, ...]:
    return python_mutants(Module("door", text), ["power_up", "step"], frozenset({"TABLE", "LIMIT"}), RULE)


@pytest.fixture(scope="module")
def found() -> dict[tuple[str, str, str], PythonMutant]:
    return {(one.mutant.operator, one.mutant.old, one.mutant.new): one for one in mutants_of(DOOR)}


@pytest.mark.parametrize(
    ("operator", "old", "new"),
    [
        ("comparison swapped", "s.count >= LIMIT", "s.count > LIMIT"),
        ("comparison swapped", "i.word == TABLE[0]", "i.word != TABLE[0]"),
        ("condition negated", "i.push and not i.pull", "(not (i.push and not i.pull))"),
        ("condition negated", "s.count >= LIMIT", "(not (s.count >= LIMIT))"),
        ("negation dropped", "not i.pull", "i.pull"),
        ("conjunct dropped", "i.push", "True"),
        ("disjunct dropped", "i.word == TABLE[0]", "False"),
        ("and, or exchanged", "i.push and not i.pull", "((i.push) or (not i.pull))"),
        ("branch removed", "i.push and not i.pull", "False"),
        ("field unchanged", "Step.OPEN", "s.state"),
        ("field unchanged", "s.count + 1", "s.count"),
        ("reset missing", "0", "s.count"),
        ("wrong reset", "s.key", "1"),
        ("constant swapped", "Step.OPEN", "Step.STUCK"),
        ("constant swapped", "Step.STUCK", "Step.SHUT"),
        ("constant swapped", "i.push", "i.pull"),
        ("constant swapped", "LIMIT", "TABLE"),
        ("constant swapped", "9", "10"),
        ("constant swapped", "0", "1"),
        ("operator swapped", "s.count + 1", "(s.count - 1)"),
        ("entries exchanged", "3, 5", "5, 3"),
    ],
)
def test_each_operator_makes_its_edit(
    found: dict[tuple[str, str, str], PythonMutant], operator: str, old: str, new: str
) -> None:
    assert (operator, old, new) in found


def test_two_neighbouring_ifs_change_places_with_their_blocks() -> None:
    (one,) = [
        one
        for one in mutants_of(DOOR)
        if one.mutant.operator == "order exchanged" and one.mutant.old.startswith("i.push")
    ]
    text = applied(DOOR.splitlines(), one.mutant.edit)
    assert text.index("s.count >= LIMIT") < text.index("i.push and not i.pull")
    assert text.index("Step.STUCK, s.count") < text.index("Step.OPEN, 0")


def test_every_mutant_is_a_distinct_program_unlike_the_original() -> None:
    programs = [ast.dump(ast.parse(applied(DOOR.splitlines(), one.mutant.edit))) for one in mutants_of(DOOR)]
    assert len(programs) > 30
    assert len(set(programs) | {ast.dump(ast.parse(DOOR))}) == len(programs) + 1


def test_errors_docstrings_and_other_functions_are_not_edited() -> None:
    lines = DOOR.splitlines()
    edited = {lines[one.mutant.line - 1].strip() for one in mutants_of(DOOR)}
    assert not {line for line in edited if line.startswith(("raise", '"""', "return i.push"))}
    assert "if s.state == Step.STUCK:" in edited


def test_an_edit_says_lines_to_pass_unless_it_changes_constants() -> None:
    lines = DOOR.splitlines()
    for one in mutants_of(DOOR):
        if one.mutant.definition in ("TABLE", "LIMIT"):
            assert one.lines is None
        else:
            assert one.lines is not None
            assert one.lines[0] <= one.mutant.line <= one.lines[1]
    (negated,) = [one for one in mutants_of(DOOR) if one.mutant.new == "(not (i.push and not i.pull))"]
    assert negated.lines is not None
    assert lines[negated.lines[0] - 1].strip() == "if i.push and not i.pull:"


def test_ids_stay_when_other_code_moves_or_is_added() -> None:
    moved = DOOR.replace("def unused", "def more(x: int) -> int:\n    return x + 1\n\n\ndef unused")
    moved = "# a line more\n\n" + moved
    assert [one.mutant.id for one in mutants_of(moved)] == [one.mutant.id for one in mutants_of(DOOR)]
    ids = [one.mutant.id for one in mutants_of(DOOR)]
    assert len(set(ids)) == len(ids)


def test_a_function_that_is_not_there_is_refused() -> None:
    with pytest.raises(Unjudged, match="no function gone in the module"):
        python_mutants(Module("door", DOOR), ["gone"], frozenset(), RULE)


def test_no_function_is_made_to_call_itself() -> None:
    text = "def stay(x: int) -> int:\n    return x\n\n\ndef hold(x: int) -> int:\n    return stay(x)\n"
    module, rule = Module("door", text), PythonRule(cycles=(("stay", "hold"),))
    assert [one.mutant.new for one in python_mutants(module, ["hold"], frozenset(), rule)] == []
    more = text + "\n\ndef step(x: int) -> int:\n    return hold(x)\n"
    (one,) = python_mutants(Module("door", more), ["step"], frozenset(), rule)
    assert (one.mutant.old, one.mutant.new) == ("hold", "stay")

"""Every mutation operator makes its edits, at the right place, and leaves alone what is not to be edited."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutant import Mutant, applied, diff
from modeproof.strength.operators import Rule, mutants
from modeproof.tlc.parse_tree import ParseTree, read_tree
from modeproof.tlc.toolchain import find_toolchain
from tests.strength.toy import EVERY_OPERATOR

RULE = Rule(
    behaviour=("Init", "Group"),
    kinds=(("red", "green"),),
    cycles=(("LONG", "SHORT"),),
    groups=frozenset({"Group"}),
)

EXPECTED = {
    "guard negated": {("Wait", "i.d", "~(i.d)"), ("Set", "Guard(i)", "~(Guard(i))")},
    "conjunct dropped": {
        ("Guard", "~i.b", "TRUE"),
        ("Guard", "i.c >= LONG", "TRUE"),
        ("Set", "Guard(i)", "TRUE"),
        ("Wait", "y = Colour", "TRUE"),
        ("Wait", "i.d", "TRUE"),
    },
    "disjunct dropped": {("Guard", "i.a", "FALSE")},
    "action removed": {("Group", "Set(i)", "FALSE"), ("Group", "Wait(i)", "FALSE")},
    "comparison swapped": {
        ("Guard", ">=", ">"),
        ("Colour", "=", "#"),
        ("All", "<", "<="),
        ("Wait", "=", "#"),
    },
    "negation dropped": {("Guard", "~i.b", "(i.b)")},
    "branches exchanged": {("Pick", "IF i.a THEN 1 ELSE 2", "IF i.a THEN 2 ELSE 1")},
    "case removed": {("Colour", 'y = "red"', "FALSE")},
    "reset missing": {("Set", 'y\' = "green"', "UNCHANGED y")},
    "assignment missing": {("Set", "x' = Pick(i) - 1", "UNCHANGED x")},
    "wrong UNCHANGED": {
        ("Stay", "UNCHANGED both", "(x' = 0 /\\ UNCHANGED <<y>>)"),
        ("Stay", "UNCHANGED both", '(y\' = "red" /\\ UNCHANGED <<x>>)'),
        ("Wait", "UNCHANGED x", "(x' = 0)"),
        ("Wait", "UNCHANGED y", '(y\' = "red")'),
    },
    "constant swapped": {
        ("Init", "0", "1"),
        ("Init", '"red"', '"green"'),
        ("Guard", "LONG", "SHORT"),
        ("Pick", "1", "2"),
        ("Pick", "2", "3"),
        ("Colour", '"green"', '"red"'),
        ("Colour", '"red"', '"green"'),
        ("Table", "1", "2"),
        ("Other", "2", "3"),
        ("All", "5", "6"),
        ("Set", "1", "2"),
        ("Set", '"green"', '"red"'),
    },
    "operator swapped": {("Sets", "\\cup", "\\cap"), ("Set", "-", "+")},
    "quantifier swapped": {("All", "\\A", "\\E")},
}


def tree_of(folder: Path, text: str) -> ParseTree:
    (folder / "Every.tla").write_text(text.lstrip())
    return read_tree(folder, "Every", find_toolchain())


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> ParseTree:
    return tree_of(tmp_path_factory.mktemp("every"), EVERY_OPERATOR)


@pytest.fixture(scope="module")
def made(tree: ParseTree) -> tuple[Mutant, ...]:
    return mutants(tree, "Every", RULE, frozenset())


@pytest.mark.parametrize("operator", EXPECTED)
def test_an_operator_makes_its_edits_and_no_other(operator: str, made: tuple[Mutant, ...]) -> None:
    found = {(one.definition, one.old, one.new) for one in made if one.operator == operator}
    assert found == EXPECTED[operator]


def test_no_operator_is_without_expectation(made: tuple[Mutant, ...]) -> None:
    assert {one.operator for one in made} == set(EXPECTED)


def test_what_the_behaviour_does_not_reach_is_not_edited(made: tuple[Mutant, ...]) -> None:
    assert "Unused" not in {one.definition for one in made}


def test_an_operator_that_is_left_alone_is_not_edited(tree: ParseTree) -> None:
    rule = Rule(behaviour=RULE.behaviour, kinds=RULE.kinds, groups=RULE.groups, leave=frozenset({"Guard"}))
    found = mutants(tree, "Every", rule, frozenset())
    assert "Guard" not in {one.definition for one in found} and not any("Guard" in one.old for one in found)


def test_a_property_is_not_edited(tree: ParseTree, made: tuple[Mutant, ...]) -> None:
    assert any(one.definition == "All" for one in made)
    assert not any(one.definition == "All" for one in mutants(tree, "Every", RULE, frozenset({"All"})))


def test_ids_and_texts_are_unique(tree: ParseTree, made: tuple[Mutant, ...]) -> None:
    assert len({one.id for one in made}) == len(made)
    assert len({applied(tree.texts["Every"], one.edit) for one in made}) == len(made)


def test_ids_survive_edits_elsewhere(tmp_path: Path, made: tuple[Mutant, ...]) -> None:
    """A comment and a new definition move every line and change no id."""
    text = EVERY_OPERATOR.replace("Pick(i) ==", "\\* E-1\nNew == 1\nPick(i) ==")
    moved = mutants(tree_of(tmp_path, text), "Every", RULE, frozenset())
    assert {one.id for one in made} == {one.id for one in moved}
    assert {one.line for one in made} != {one.line for one in moved}


def test_a_multi_line_guard_is_negated_with_its_bullets_aligned(tmp_path: Path) -> None:
    text = EVERY_OPERATOR.replace(
        "/\\ i.d\n", "/\\ (\\A n \\in {1} :\n            \\/ n = 1\n            \\/ i.d)\n"
    )
    tree = tree_of(tmp_path, text)
    (one,) = (m for m in mutants(tree, "Every", RULE, frozenset()) if "~(\\A" in m.new)
    (tmp_path / "Every.tla").write_text(applied(tree.texts["Every"], one.edit))
    read_tree(tmp_path, "Every", find_toolchain())  # raises when the bullets are out of line


def test_the_diff_shows_the_edit(tree: ParseTree, made: tuple[Mutant, ...]) -> None:
    (one,) = (m for m in made if m.operator == "branches exchanged")
    text = diff(tree.texts["Every"], one)
    assert "-Pick(i) == IF i.a THEN 1 ELSE 2" in text and "+Pick(i) == IF i.a THEN 2 ELSE 1" in text


def test_a_behaviour_that_is_not_defined_is_refused(tree: ParseTree) -> None:
    with pytest.raises(Unjudged, match="does not define Gone"):
        mutants(tree, "Every", Rule(behaviour=("Gone",)), frozenset())

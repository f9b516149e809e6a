"""What properties and theorems say is pinned: a text that is weakened is noticed, a comment is not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from modeproof.registers import check_document
from modeproof.registers.files import read_toml
from tests.registers.conftest import Tree

SPEC, PROOF, PINS = "spec/door/Latch.tla", "proofs/door/bolt.py", "spec/door/pins.toml"
OPEN = 'OpenIsUnlocked == latchState = "Open" => ~LOCK_1'
HELPER = """
from proofs.door import sayings
from proofs.theorem import theorem

LIMIT = 3


@theorem(clauses=["DR-1-2"], findings=["E-01"])
def the_bolt_moves():
    \"\"\"The bolt moves.\"\"\"
    yield sayings.moves(LIMIT)
"""
SAYINGS = """
def moves(limit):
    return between(0, limit)


def between(low, high):
    return low < high


def another():
    return True
"""


def said(tree: Tree) -> list[str]:
    return [str(problem) for problem in check_document(tree.root, "door")]


@pytest.mark.parametrize(
    ("name", "old", "new", "moved"),
    [
        (SPEC, OPEN, "OpenIsUnlocked == TRUE", "checked.OpenIsUnlocked"),
        (SPEC, OPEN, OPEN.replace('Open" =', 'Shut" ='), "checked.OpenIsUnlocked"),
        (SPEC, OPEN, f"{OPEN} \\/ TRUE", "checked.OpenIsUnlocked"),
        (SPEC, 'LOCK_1 == latchState = "Shut"', "LOCK_1 == FALSE", "checked.OpenIsUnlocked"),
        (SPEC, "PrintState == TRUE", "PrintState == FALSE", "checked.PrintState"),
        (SPEC, 'TypeOK == latchState \\in {"Open", "Shut"}', "TypeOK == TRUE", "checked.TypeOK"),
        (PROOF, "LIMIT = 3", "LIMIT = 2", "theorems.the_bolt_moves"),
        (PROOF, "yield sayings.moves(LIMIT)", "yield True", "theorems.the_bolt_moves"),
        ("proofs/door/sayings.py", "low < high", "True", "theorems.the_bolt_moves"),
        (PROOF, "The bolt moves.", "The bolt may move.", "theorems.the_bolt_moves"),
    ],
)
def test_a_text_that_says_something_else_is_noticed(
    tree: Tree, name: str, old: str, new: str, moved: str
) -> None:
    tree.write(PROOF, HELPER)
    tree.write("proofs/door/sayings.py", SAYINGS)
    tree.pin()
    assert said(tree) == []
    tree.edit(name, old, new)
    assert any(moved in line and "is not the text that was pinned" in line for line in said(tree))


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        (SPEC, "(* DR-1-2 *)\n", "(* DR-1-2, in other words *)\n"),
        (SPEC, "~LOCK_1\n", "~LOCK_1   \\* the bolt is in\n"),
        (PROOF, "LIMIT = 3", "LIMIT = 3  # the third"),
        ("proofs/door/sayings.py", "return True", "return False"),
        (SPEC, 'CloseLatch(i) == latchState = "Open"', 'CloseLatch(i) == latchState \\in {"Open"}'),
    ],
)
def test_what_they_do_not_refer_to_moves_no_pin(tree: Tree, name: str, old: str, new: str) -> None:
    tree.write(PROOF, HELPER)
    tree.write("proofs/door/sayings.py", SAYINGS)
    tree.pin()
    tree.edit(name, old, new)
    assert said(tree) == []


def test_a_missing_or_emptied_file_of_pins_is_noticed(tree: Tree) -> None:
    text = (tree.root / PINS).read_text()
    (tree.root / PINS).unlink()
    assert any("checked.OpenIsUnlocked: is not pinned" in line for line in said(tree))
    tree.write(PINS, text.replace("the_bolt_moves", "the_bolt_stays"))
    problems = said(tree)
    assert any("theorems.the_bolt_moves: is not pinned" in line for line in problems)
    assert any("theorems.the_bolt_stays: nothing of this name is left" in line for line in problems)


def test_an_instance_belongs_to_the_property_as_a_whole(tree: Tree) -> None:
    tree.write("spec/door/Contract.tla", "---- MODULE Contract ----\nVARIABLE x\nShut == x = 1\n====\n")
    instance = f"C == INSTANCE Contract WITH x <- latchState\n{OPEN} \\/ C!Shut"
    tree.edit(SPEC, OPEN, instance)
    tree.pin()
    assert not any("pins.toml" in line for line in said(tree))
    tree.edit("spec/door/Contract.tla", "x = 1", "TRUE")
    assert any("checked.OpenIsUnlocked" in line for line in said(tree))


def test_pins_move_with_a_reason_and_say_what_moved(
    tree: Tree,
    registers_command: Callable[..., int],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("CI", raising=False)
    before = read_toml(tree.root, tree.root / PINS)
    tree.edit(SPEC, OPEN, f'{OPEN} /\\ (LOCK_1 => latchState = "Shut")')
    assert registers_command(tree.root) == 1
    assert registers_command(tree.root, "--repin", "--reason", "it says both ways") == 0
    assert "checked.OpenIsUnlocked: " in capsys.readouterr().out
    text = (tree.root / PINS).read_text()
    (row,) = (line for line in text.splitlines() if line.startswith("OpenIsUnlocked"))
    assert row.endswith(": it says both ways")
    now = read_toml(tree.root, tree.root / PINS)
    assert {key for key in now["checked"] if now["checked"][key] != before["checked"][key]} == {
        "OpenIsUnlocked"
    }


@pytest.mark.parametrize("nothing", ["TRUE", "[][TRUE]_<<latchState>>", "1 \\in 0..2"])
def test_a_property_that_speaks_of_no_variable_cannot_be_pinned(
    tree: Tree, registers_command: Callable[..., int], nothing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from modeproof.ground.errors import Unjudged

    monkeypatch.delenv("CI", raising=False)
    tree.edit(SPEC, OPEN, f"OpenIsUnlocked == {nothing}")
    assert any("speaks of no variable" in line for line in said(tree))
    with pytest.raises(Unjudged, match=r"OpenIsUnlocked: speaks of no variable.*nothing was pinned"):
        registers_command(tree.root, "--repin", "--reason", "a slip")


def test_pins_of_this_repository_cover_every_property_and_theorem(real_root: Path) -> None:
    from modeproof.ground.places import documents
    from modeproof.registers.citations import read_sources
    from modeproof.registers.load import load_document

    for name in documents(real_root):
        document = load_document(real_root, name)
        pins = read_toml(real_root, real_root / document.source("pins"))
        assert {prop.tla for prop in document.properties} <= set(pins["checked"])
        proofs = read_sources(document).proofs
        assert {theorem.name for module in proofs for theorem in module.theorems} == set(pins["theorems"])

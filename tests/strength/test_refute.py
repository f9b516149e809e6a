"""Each theorem is refuted by an edit of the code, and one that says nothing any more is noticed."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from modeproof.ground.places import documents, root
from modeproof.registers.citations import read_sources
from modeproof.registers.load import load_document
from modeproof.registers.pins import repin
from modeproof.registers.refuting import Edit, check_refuting, load_refuting
from modeproof.strength.refute import judge_refuting, refutations

REFUTING = {name: load_refuting(root(), name) for name in documents(root())}
EDITS = [(name, edit) for name, refuting in REFUTING.items() for edit in refuting.edits]
STOP = "a_stop_request_switches_off_in_its_own_call"
PATHS = "every_call_takes_exactly_one_path"
CODE = "refimpl/edm/sf_edm.py"


def quietly(_: str) -> None:
    """Says nothing."""


@pytest.mark.parametrize("document", REFUTING)
def test_no_theorem_is_without_an_edit_or_reason(document: str) -> None:
    loaded = load_document(root(), document)
    assert check_refuting(loaded, read_sources(loaded)) == []


def test_few_theorems_are_true_by_construction() -> None:
    refuted = {name for one in REFUTING.values() for edit in one.edits.values() for name in edit.theorems}
    assert len(refuted) > 300
    assert sum(len(one.by_construction) for one in REFUTING.values()) * 20 < len(refuted)


@pytest.mark.deep
@pytest.mark.parametrize(("document", "name"), EDITS[::24])
def test_an_edit_refutes_its_theorems_again(document: str, name: str) -> None:
    edit = REFUTING[document].edits[name]
    (answers,) = refutations(root(), document, {name: edit}, quietly).values()
    assert answers == dict.fromkeys(edit.theorems, "refuted")


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of the code, its proofs, and the registers."""
    for folder in ("proofs", "refimpl", "spec"):
        shutil.copytree(root() / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def change(tree: Path, file: str, old: str, new: str) -> None:
    text = (tree / file).read_text("utf-8")
    assert text.count(old) == 1, old
    (tree / file).write_text(text.replace(old, new), "utf-8")


def problems(tree: Path) -> list[str]:
    document = load_document(tree, "edm")
    return [str(problem) for problem in check_refuting(document, read_sources(document))]


def test_a_theorem_that_became_true_is_refused(tree: Path) -> None:
    assert problems(tree) == []
    change(
        tree,
        "proofs/edm/block_safety.py",
        "return stopped, z3.Not(scan.sends.S_EDM_Out)",
        "return stopped, TRUE",
    )
    document = load_document(tree, "edm")
    assert any(STOP in line for line in repin(document, read_sources(document), "planted"))
    told = problems(tree)
    assert told and all("was judged on another text; if that was not meant, undo it" in line for line in told)
    lost = judge_refuting(tree, "edm", False, quietly)
    assert [line.partition(" (")[0] for line in lost] == [STOP] and lost[0].endswith(": holds")
    (left,) = problems(tree)
    assert "has not been judged" in left


def test_an_edit_answers_for_the_text_it_is_given() -> None:
    stay = "return _stay(s, i)  # AwaitReset"
    good = Edit(file=CODE, old=stay, new="return _stay(i=i, s=s)", theorems=(STOP, "no_such"))
    broken = Edit(file=CODE, old="def _init(", new="def _init((", theorems=(STOP,))
    raising = Edit(
        file=CODE, old="if s.state == Step.IDLE:", new="if s.state != Step.IDLE:", theorems=(STOP, PATHS)
    )
    told = refutations(root(), "edm", {"good": good, "broken": broken, "raising": raising}, quietly)
    assert told["good"] == {STOP: "holds", "no_such": "no theorem has this name"}
    assert told["broken"][STOP].startswith("SyntaxError")
    assert told["raising"][PATHS] == "refuted" and "step raises" in told["raising"][STOP]


REGISTER = "proofs/edm/strength.toml"
ROW = '[refuted.mine]\nin = "{file}"\nold = {old!r}\nnew = {new!r}\ntheorems = ["{theorem}"]\n'
WRONG = {
    "is no module of refimpl/edm": {"file": "modeproof/cli.py"},
    "times, not once": {"old": "return"},
    "edits nothing": {"new": "def _init("},
    "unknown theorem": {"theorem": "no_such_theorem"},
    "edits the theorem": {
        "file": "proofs/edm/block_safety.py",
        "old": "yield from JUDGE.in_every_scan(stop_at_once)",
        "new": "yield from ()",
    },
    "not found": {"file": "refimpl/edm/nothing.py"},
}


@pytest.mark.parametrize("said", WRONG)
def test_a_row_that_cannot_be_judged_is_named(said: str, tree: Path) -> None:
    row = {"file": CODE, "old": "def _init(", "new": "def _begin(", "theorem": STOP} | WRONG[said]
    path = tree / REGISTER
    text = path.read_text("utf-8")
    path.write_text(text.replace("[refuted.", f"{ROW.format(**row)}\n[refuted.", 1), "utf-8")
    assert any(said in line for line in problems(tree)), problems(tree)


def test_a_theorem_without_an_edit_is_named(tree: Path) -> None:
    path = tree / REGISTER
    text = path.read_text("utf-8")
    path.write_text(re.sub(rf'"{STOP}",? ?', "", text), "utf-8")
    assert any(f"{STOP}: is refuted by nothing" in line for line in problems(tree))
    path.write_text(f'{text}\n[by_construction]\n{STOP} = "so it is"\n', "utf-8")
    assert any("is no theorem by construction" in line for line in problems(tree))

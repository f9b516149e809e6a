"""Evidence edited by hand, and evidence of another tool, are not believed; each cheat is one edit."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.ground.evidence import record as made_by
from modeproof.report.build import make
from modeproof.report.recheck import recheck
from modeproof.report.sources import DIFFERS, HOLE
from tests.report.box_graph import add_graph
from tests.report.paper import make_whole, put

THEOREM = "it_shuts_over_the_door_only"
Edit = Callable[[dict[str, Any]], None]


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box with evidence of every kind, all of it as expected."""
    made = make_whole(tmp_path)
    add_graph(made)
    put(made, "adapter_box_brief", kind="conformance")
    row = {"id": "ShutsOverDoor", "environment": "arbitrary", "tlc": "HOLDS", "theorem": THEOREM}
    told = {"proved": "PROVED", "reason": "", "runs": [], "rests_on": [], "note": ""}
    put(made, "agreement", kind="agreement", result={"rows": [{**row, **told}]})
    monkeypatch.setenv("MODEPROOF_ROOT", str(made))
    return made


def contradictions(root: Path) -> list[str]:
    return [t.what for t in make(root).troubles if t.status == DIFFERS and "contradicts itself" in t.what]


def edit(root: Path, id: str, change: Edit) -> None:
    path = evidence.evidence_path(root, "box", id)
    record = json.loads(path.read_text())
    change(record)
    path.write_text(json.dumps(record))


def result(**changes: Any) -> Edit:
    return lambda record: record["result"].update(changes)


def head(**changes: Any) -> Edit:
    return lambda record: record.update(changes)


def answer(**changes: Any) -> Edit:
    return lambda record: record["result"]["queries"][0].update(changes)


CHEATS: list[tuple[str, Edit, str]] = [
    ("MC_Box", result(distinct=6), "distinct states: 6, pinned 5"),
    ("MC_Box", result(generated=None), "UNJUDGED"),
    ("MC_Box", result(queue=3), "left 3 states unexplored"),
    ("MC_Box", result(exit_status=12), "ended with exit status 12"),
    ("MC_Box", result(timed_out=True), "time limit"),
    ("MC_Box", result(properties=["TypeOK"]), "properties = ['TypeOK']"),
    ("MC_Box", result(pins={"distinct": 9, "generated": 11, "trace_length": None}), "pins = "),
    ("MC_Box", head(strength="every door there is"), "strength = 'every door there is'"),
    ("MC_Box", head(environment="honest"), "environment = 'honest'"),
    ("MC_Box", head(verdict="VIOLATED"), "its figures give UNJUDGED"),
    ("NEG_Box_eager", result(trace_length=3), "incomplete"),
    ("NEG_Box_eager", result(violated="TypeOK"), "TypeOK is violated, not ShutsOverDoor"),
    ("NEG_Box_eager", head(verdict="HOLDS"), "its figures give UNJUDGED"),
    ("WIT_Box", result(reached=[]), "UNREACHED"),
    ("OPEN_Box", result(printed={"STATE": 3, "EDGE": 8}), "3 states were printed, but TLC found 2"),
    (THEOREM, result(queries=[]), "no query was asked"),
    (THEOREM, answer(z3="sat"), "the solvers disagree"),
    (THEOREM, answer(z3="unknown"), "INCONCLUSIVE"),
    (THEOREM, head(expected="VIOLATED", verdict="VIOLATED"), "should be PROVED"),
    ("refimpl_OPEN_Box", result(difference_count=1), "DIFFERS: 1 differences"),
    ("refimpl_OPEN_Box", result(differences=[{}]), "DIFFERS"),
    ("refimpl_OPEN_Box", result(replayed=7), "DIFFERS"),
    ("refimpl_OPEN_Box", result(transitions=4, replayed=4), "4 transitions, not those pinned"),
    ("refimpl_OPEN_Box", head(expected="DIFFERS", verdict="DIFFERS"), "should be EQUAL"),
    ("adapter_box_brief", result(cases=0, cases_total=0), "0 of 0 cases"),
    ("adapter_box_brief", result(cases_total=2), "1 of 2 cases"),
    ("adapter_box_brief", result(difference={"case": "x"}), "its figures give"),
    ("agreement", result(rows=[]), "no property was compared"),
    ("agreement", result(problems=["one"]), "one"),
    ("registers", result(problems=["one"]), "it lists what is wrong: one"),
]


def test_evidence_as_it_was_written_agrees_with_its_figures(root: Path) -> None:
    assert contradictions(root) == []


@pytest.mark.parametrize(("id", "cheat", "words"), CHEATS)
def test_evidence_edited_by_hand_is_not_believed(root: Path, id: str, cheat: Edit, words: str) -> None:
    edit(root, id, cheat)
    (found, *_) = contradictions(root)
    assert found.startswith(f"box/{id}: ") and words in found
    assert main(["report"]) == 1


@pytest.mark.parametrize("tool", ["modeproof", "z3", "cvc5"])
def test_evidence_of_another_tool_is_no_evidence(
    root: Path, tool: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    put(root, THEOREM, tools=evidence.solvers())
    assert main(["report"]) in (0, 2)
    page = root / "build/report/report.html"
    assert recheck(root, page).status == 0
    there = made_by.own_tools() | made_by.solvers()
    other = {**there[tool], "sha256": "0" * 64}
    monkeypatch.setattr(made_by, "own_tools", lambda *_: there | {tool: other})
    monkeypatch.setattr(made_by, "solvers", dict)
    assert main(["report", "--verify"]) == 1
    assert f"{tool} (the tool): was changed since it made the evidence of box/" in capsys.readouterr().out
    assert main(["report"]) == 2
    capsys.readouterr()
    assert main(["report", "--verify"]) == 0, "the report says so itself"
    (trouble,) = [t for t in make(root).troubles if "another text" in t.what]
    assert trouble.status == HOLE and f"{tool} (the tool)" in trouble.what


def test_the_hash_of_a_package_covers_each_of_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in (("lib/solve.so", "all"), ("solve.py", "pass"), ("solve-1.dist-info/RECORD", "")):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    names = ["lib/solve.so,,", "solve.py,,", "solve-1.dist-info/RECORD,,", "solve-1.dist-info/METADATA,,"]
    (tmp_path / "solve-1.dist-info/RECORD").write_text("\n".join(names))
    (tmp_path / "solve-1.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: solve\nVersion: 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    hashed = made_by.package.__wrapped__
    before = hashed("solve")
    assert before["version"] == "1"
    (tmp_path / "lib/solve.so").write_text("al1")
    assert hashed("solve")["sha256"] != before["sha256"]

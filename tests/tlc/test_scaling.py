"""Series of runs of which one constant is varied: measured, judged, refused when not understood."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof import evidence
from modeproof.cli import main
from modeproof.errors import Unjudged
from modeproof.places import documents
from modeproof.registers.pages import SCALING as PAGE
from modeproof.registers.pages import page_of
from modeproof.tlc.scaling import cfg_text, has_scaling, load_scaling
from tests.toy_tree import toy_tree

SCALING = """
limit_s = 600
heap_mb = 256
[[series]]
id = "floors"
run = "MC_toy"
x = "floors"
title = "a lift"
set = { SPECIFICATION = "FairSpec" }
points = [{ x = 2, N = "2" }, { x = 3, N = "3" }]
"""


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    root = toy_tree(tmp_path, "MC_toy")
    (root / "spec/toy/scaling.toml").write_text(SCALING)
    (root / "docs").mkdir()
    return root


def test_a_series_is_measured_and_rendered(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scale", "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "floors 2: HOLDS; 8 distinct" in said and "floors 3: HOLDS; 12 distinct" in said
    record = evidence.read(evidence.evidence_path(root, "toy", "SCALE_floors_3"))
    assert record["kind"] == "scaling" and record["result"]["given"] == {
        "SPECIFICATION": "FairSpec",
        "N": "3",
    }
    assert record["result"]["cpu_seconds"] > 0
    assert main(["scale", "--render"]) == 0
    assert "| 3 | 12 |" in (root / "docs/toy/scaling.md").read_text()
    assert (root / "docs/toy/scaling.svg").read_text().count("<circle") == 4


def test_one_point_alone_is_measured_again(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scale", "--quiet", "floors", "--point", "3"]) == 0
    said = capsys.readouterr().out
    assert "floors 3: HOLDS; 12 distinct" in said and "floors 2" not in said
    assert main(["scale", "--quiet", "--point", "9"]) == 2
    assert "series floors has no point 9" in capsys.readouterr().err


def test_after_a_point_beyond_its_limit_the_larger_ones_are_not_tried(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = SCALING.replace("limit_s = 600", "limit_s = 0.01")
    (root / "spec/toy/scaling.toml").write_text(text)
    assert main(["scale", "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "floors 2: INCONCLUSIVE" in said and "time limit of 0.01 s reached" in said
    assert "floors 3: INCONCLUSIVE" in said and "not tried" in said
    assert main(["scale", "--render"]) == 0
    assert "left out: not tried" in (root / "docs/toy/scaling.md").read_text()


def test_a_series_that_does_not_hold_is_not_judged_a_success(root: Path) -> None:
    path = root / "spec/toy/Toy.tla"
    path.write_text(path.read_text().replace("TypeOK == count", "TypeOK == count < 3 /\\ count"))
    assert main(["scale", "--quiet"]) == 2
    record = evidence.read(evidence.evidence_path(root, "toy", "SCALE_floors_3"))
    assert record["verdict"] == "VIOLATED" and not record["as_expected"]
    assert record["reason"] == "TypeOK is violated"
    other = SCALING.replace("set = {", 'properties = ["Reaches2"]\nset = {')
    path.write_text(path.read_text().replace("Small ==", "Reaches2 == count < 9\nSmall =="))
    (root / "spec/toy/scaling.toml").write_text(other)
    assert main(["scale", "--quiet"]) == 0, "with what breaks left out"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('run = "MC_toy"', 'run = "MC_tyo"', "no run 'MC_tyo' in runs.toml"),
        ('x = "floors"', 'y = "floors"', "unknown field 'y'"),
        ('title = "a lift"', "", "title is missing"),
        ("x = 3,", "x = 2,", "with rising x"),
        ('N = "3"', "N = 3", "must be text"),
        ("x = 3,", 'x = "3",', "must be a whole number"),
    ],
)
def test_a_register_that_is_not_understood_is_refused(root: Path, old: str, new: str, words: str) -> None:
    assert old in SCALING
    (root / "spec/toy/scaling.toml").write_text(SCALING.replace(old, new, 1))
    with pytest.raises(Unjudged, match=words):
        load_scaling(root, "toy")


PLACE = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("document", [name for name in documents(PLACE) if has_scaling(PLACE, name)])
def test_the_page_of_each_document_has_every_point_that_its_register_declares(document: str) -> None:
    place = PLACE
    text = (place / page_of(document, PAGE)).read_text(encoding="utf-8")
    sections = {part.splitlines()[0]: part for part in text.split("\n## ")[1:]}
    declared = load_scaling(place, document)
    assert len(sections) == len(declared)
    for series in declared:
        section = sections[f"{series.title} (`{series.run.id}`)"]
        rows = [line for line in section.splitlines() if line.startswith("| ") and line[2].isdigit()]
        assert [int(row.split("|")[1]) for row in rows] == [point.x for point in series.points]


def test_a_cfg_is_changed_where_it_is_told_and_nowhere_else() -> None:
    text = 'CONSTANTS N = {1, 2}  M <- Name \\* N = 7\n  T = "a"\nVIEW View\nSPECIFICATION Spec\n'
    made = cfg_text(text, {"N": "{1}", "M": "5", "VIEW": "Other", "NEW": "0"}, "x")
    assert "N = {1}  M = 5" in made and "VIEW Other" in made and "SPECIFICATION Spec" in made
    assert made.startswith("CONSTANT NEW = 0\n") and "N = 7" not in made
    with pytest.raises(Unjudged, match="INIT stands 0 times"):
        cfg_text(text, {"INIT": "Start"}, "x")

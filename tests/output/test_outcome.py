"""The record of what a user's command found: what it says, how it is read, how a function gives it."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from modeproof.lane.user_commands import outcome_of
from modeproof.output import outcome
from modeproof.output.outcome import Outcome, as_json, path_of, read, shown_path

EDM = TREE / "examples/st/sf_edm.st"
SCHEMA = TREE / "modeproof/output" / outcome.SCHEMA


@pytest.fixture(scope="module")
def wrong(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Outcome]:
    """A project with a block that shows a wrong code in its state Off, and what is found of it."""
    place = tmp_path_factory.mktemp("project")
    (place / "modeproof.toml").write_text("", "utf-8")
    (place / "plc").mkdir()
    (place / "plc/edm.st").write_text(EDM.read_text("utf-8").replace("16#8810", "16#8811"), "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place / "plc")
        found = outcome_of(
            ["prove-program", "edm.st", "--target", "sf_edm", "--codes", "--record", "../edm.json"]
        )
    return place, found


def test_a_difference_names_file_line_clause_and_scans(wrong: tuple[Path, Outcome]) -> None:
    place, found = wrong
    assert (found.word, found.status, found.subject, found.target) == ("REFUTED", 1, "SF_EDM", "sf_edm")
    [(demand, problem)] = found.problems
    assert demand.word == "REFUTED"
    lines = (place / "plc/edm.st").read_text("utf-8").splitlines()
    assert problem.spot is not None and problem.counterexample is not None
    assert problem.spot.file == "plc/edm.st"
    assert "Off: DiagCode := 16#8811;" in lines[problem.spot.line - 1]
    assert [rule.id for rule in problem.others] == ["EDM-OUT-DIAG"]
    last = problem.counterexample.scans[-1]
    assert problem.counterexample.wrong == ["DiagCode"]
    assert (last.given["DiagCode"], last.expected["DiagCode"]) == ("8811", "8810")
    assert all(scan.given == scan.expected for scan in problem.counterexample.scans[:-1])


def test_a_record_is_read_as_it_was_written(wrong: tuple[Path, Outcome]) -> None:
    place, found = wrong
    kept = read(place / "edm.json")
    assert json.loads(as_json(kept)) == json.loads(as_json(found))
    assert str(place) not in as_json(found)


def test_a_record_fits_the_published_schema(wrong: tuple[Path, Outcome]) -> None:
    assert json.loads(SCHEMA.read_text("utf-8")) == outcome.schema()
    checker = jsonschema.Draft202012Validator(outcome.schema())
    record = json.loads((wrong[0] / "edm.json").read_text("utf-8"))
    checker.validate(record)
    assert not checker.is_valid(record | {"status": 3})
    assert not checker.is_valid(record | {"unknown": 1})


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"word": "REFUTED"', '"word": "PROVED"', "it was changed since it was written"),
        ('"schema_version": 1', '"schema_version": 9', "a record of version 9"),
        ('"status": 1', '"status": "1"', "no record"),
        ("{", "", "no record"),
    ],
)
def test_another_record_is_refused(
    wrong: tuple[Path, Outcome], tmp_path: Path, old: str, new: str, said: str
) -> None:
    text = (wrong[0] / "edm.json").read_text("utf-8")
    assert old in text
    (tmp_path / "r.json").write_text(text.replace(old, new, 1), "utf-8")
    with pytest.raises(Unjudged, match=said):
        read(tmp_path / "r.json")


def test_what_cannot_be_judged_is_an_outcome(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = outcome_of(["prove-program", "gone.st", "--target", "sf_edm", "--record", "r.json"])
    assert (found.word, found.status, found.subject) == ("UNJUDGED", 2, "gone.st")
    assert "gone.st" in found.reason
    assert read(tmp_path / "r.json").reason == found.reason
    assert outcome_of(["prove-program", "gone.st", "--targat", "sf_edm"]).status == 2


def test_a_record_of_a_run_that_is_refused_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["prove-program", "my.st", "--target", "sf_edm"]
    outcome_of(words)
    records = tmp_path / ".modeproof/records"
    assert not records.exists()  # a slip of the pen is no entry
    records.mkdir(parents=True)
    (records / "prove-program-my.st-sf-edm.json").write_text("{}", "utf-8")
    outcome_of(words)
    assert read(records / "prove-program-my.st-sf-edm.json").word == "UNJUDGED"


def test_paths_are_of_the_project_or_of_the_tool(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "modeproof.toml").write_text("", "utf-8")
    (tmp_path / "a").mkdir()
    monkeypatch.chdir(tmp_path / "a")
    assert shown_path("b.st") == "a/b.st"
    assert path_of("a/b.st").resolve() == (tmp_path / "a/b.st").resolve()
    assert shown_path(EDM) == "modeproof:examples/st/sf_edm.st"
    assert path_of("modeproof:examples/st/sf_edm.st") == EDM

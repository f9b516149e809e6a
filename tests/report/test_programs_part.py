"""Verdicts on programs of users in the report: read, and judged again by their own figures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.report.build import make
from modeproof.report.parts import programs
from modeproof.report.sources import DIFFERS, NOTE, gather
from tests.report.paper import make_whole

PROVED: dict[str, Any] = {
    "command": "prove-program",
    "verdict": "PROVED",
    "status": 0,
    "unit": "Box",
    "sources": {},
    "target": "box",
    "compared": ["open"],
    "left_out": [],
    "pairs": 3,
    "queries": 40,
    "missing": "",
}
REFUTED: dict[str, Any] = {
    **PROVED,
    "verdict": "REFUTED",
    "status": 1,
    "difference": {
        "scans": [{"dt_ms": 0, "in": {}}],
        "reference": [{"open": True}],
        "program": [{"open": False}],
        "differing": ["open"],
        "stopped": "",
    },
}


PROPERTIES: dict[str, Any] = {
    "command": "prove-program",
    "status": 1,
    "unit": "Box",
    "sources": {},
    "properties": {"spec/box/clauses.toml": ""},
    "trusted": ["the reader"],
    "not_shown": ["the PLC"],
    "verdicts": [
        {"id": "types", "sentence": "It fits.", "verdict": "PROVED", "how": "induction"},
        {
            "id": "shut",
            "sentence": "It shuts.",
            "verdict": "REFUTED",
            "how": "",
            "trace": {"scans": [{}, {}]},
        },
    ],
}


def kept(root: Path, record: Any) -> programs.Part:
    """The part, with this record of a program in its place."""
    path = root / "build" / "programs" / "box-Box.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record), "utf-8")
    return programs.part(gather(root))


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all that a report needs."""
    return make_whole(tmp_path)


@pytest.mark.parametrize("record", [PROVED, REFUTED], ids=["proved", "refuted"])
def test_a_verdict_on_a_program_is_a_row(record: dict[str, Any], root: Path) -> None:
    found = kept(root, record)
    assert found.troubles == ()
    assert [(row["unit"], row["verdict"]) for row in found.data["rows"]] == [("Box", record["verdict"])]
    assert "Programs of users" in make(root).html


def test_a_tree_without_programs_has_an_empty_part(root: Path) -> None:
    found = programs.part(gather(root))
    assert found.data["rows"] == [] and found.troubles == ()


@pytest.mark.parametrize(
    ("record", "said"),
    [
        ({**PROVED, "status": 1}, "PROVED with status 1"),
        ({**PROVED, "pairs": 0}, "0 pairs"),
        ({**PROVED, "missing": "a pair"}, "its figures say: a pair"),
        ({**PROVED, "compared": []}, "no output was compared"),
        ({**REFUTED, "verdict": "PROVED", "status": 0}, "holds a difference"),
        ({**PROVED, "verdict": "REFUTED", "status": 1}, "REFUTED without scans"),
        ({**PROVED, "verdict": "UNKNOWN", "status": 2}, "nothing is missing"),
        ({**REFUTED, "difference": {**REFUTED["difference"], "program": [{"open": True}]}}, "differ: none"),
        ({"verdict": "PROVED"}, "cannot be judged"),
    ],
)
def test_a_record_that_contradicts_itself_is_told(record: dict[str, Any], said: str, root: Path) -> None:
    troubles = kept(root, record).troubles
    assert [trouble.status for trouble in troubles] == [DIFFERS] and said in troubles[0].what


def test_a_program_that_changed_since_is_noted(root: Path) -> None:
    troubles = kept(root, {**PROVED, "sources": {"box.st": "0" * 64}}).troubles
    assert [(trouble.status, trouble.items) for trouble in troubles] == [(NOTE, ("box.st",))]


def test_a_binding_that_changed_since_is_noted(root: Path) -> None:
    found = kept(root, {**PROVED, "binding_file": {"box.toml": "0" * 64}})
    assert [trouble.items for trouble in found.troubles] == [("box.toml",)]
    assert found.data["rows"][0]["how"] == "3 pairs; of files that have changed since"


def test_each_property_is_a_row_with_what_is_not_shown(root: Path) -> None:
    found = kept(root, PROPERTIES)
    assert [(row["about"], row["verdict"], row["how"]) for row in found.data["rows"]] == [
        ("types: It fits.", "PROVED", "induction; of files that have changed since"),
        ("shut: It shuts.", "REFUTED", "false after 2 scans; of files that have changed since"),
    ]
    assert [trouble.items for trouble in found.troubles] == [("spec/box/clauses.toml",)]
    html = make(root).html
    assert "the PLC" in html and 'id="program-box-Box"' in html


def test_pairs_show_the_scans_that_lead_to_them(root: Path) -> None:
    states = [
        {"pair": "Off / 1", "relations": 2, "reached_after": 3},
        {"pair": "On / 2", "relations": 1, "reached_after": None},
    ]
    kept(root, {**PROVED, "states": states})
    html = make(root).html
    assert "2 pairs of states of reference and program; scans are known to 1 of them" in html
    assert "none known; a certificate looks for them" in html


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"status": 0}, "PROVED, REFUTED with status 0"),
        ({"verdicts": []}, "no verdicts on properties: none"),
        (
            {"verdicts": [PROPERTIES["verdicts"][0], {**PROPERTIES["verdicts"][0], "verdict": "FINE"}]},
            "no verdicts on properties",
        ),
        (
            {"verdicts": [PROPERTIES["verdicts"][0], {**PROPERTIES["verdicts"][1], "trace": {}}]},
            "shut: REFUTED without scans",
        ),
    ],
)
def test_properties_that_contradict_themselves_are_told(change: Any, said: str, root: Path) -> None:
    troubles = kept(root, {**PROPERTIES, **change}).troubles
    assert any(trouble.status == DIFFERS and said in trouble.what for trouble in troubles)

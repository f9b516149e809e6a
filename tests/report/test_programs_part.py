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
    "verdict": "PROVED",
    "compared": ["open"],
    "left_out": [],
    "pairs": 3,
    "queries": 40,
    "missing": "",
}
REFUTED: dict[str, Any] = {
    **PROVED,
    "verdict": "REFUTED",
    "difference": {
        "scans": [{"dt_ms": 0, "in": {}}],
        "reference": [{"open": True}],
        "program": [{"open": False}],
        "differing": ["open"],
        "stopped": "",
    },
}


SHUT: dict[str, Any] = {
    "id": "Shut",
    "says": "It shuts.",
    "clauses": ["BOX-1"],
    "verdict": "PROVED",
    "how": "",
}
FOLLOWS: dict[str, Any] = {"verdict": "FOLLOWS", "latency": 1, "demands": [SHUT], "unjudged": []}
BROKEN: dict[str, Any] = {**SHUT, "verdict": "BROKEN", "broken": {"scans": [{}]}}


def target(same: Any, **changes: Any) -> dict[str, Any]:
    """The record of a program beside a target, of which equality was asked too."""
    status = {"PROVED": 0, "REFUTED": 1}.get(same["verdict"], 2) if same else 0
    word = same["verdict"] if same else "FOLLOWS"
    rest = {"verdict": word, "status": status, "follows": FOLLOWS, "same": same, "same_asked": bool(same)}
    head = {"command": "prove-program", "unit": "Box", "sources": {}, "target": "box"}
    return {**head, **rest, **changes}


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


@pytest.mark.parametrize("same", [PROVED, REFUTED], ids=["proved", "refuted"])
def test_a_verdict_on_a_program_is_two_rows(same: dict[str, Any], root: Path) -> None:
    found = kept(root, target(same))
    assert found.troubles == ()
    assert [row["verdict"] for row in found.data["rows"]] == ["FOLLOWS", same["verdict"]]
    assert "Programs of users" in make(root).html


def test_a_broken_demand_is_named(root: Path) -> None:
    follows = {**FOLLOWS, "verdict": "BREAKS", "demands": [BROKEN]}
    found = kept(root, target(None, verdict="BREAKS", status=1, follows=follows))
    assert found.troubles == () and [row["how"] for row in found.data["rows"]] == ["breaks Shut"]


def test_a_tree_without_programs_has_an_empty_part(root: Path) -> None:
    found = programs.part(gather(root))
    assert found.data["rows"] == [] and found.troubles == ()


@pytest.mark.parametrize(
    ("record", "said"),
    [
        (target(PROVED, status=1), "PROVED with status 1"),
        (target({**PROVED, "pairs": 0}), "0 pairs"),
        (target({**PROVED, "missing": "a pair"}), "its figures say: a pair"),
        (target({**PROVED, "compared": []}), "no output was compared"),
        (target({**REFUTED, "verdict": "PROVED"}), "holds a difference"),
        (target({**PROVED, "verdict": "REFUTED"}), "REFUTED without scans"),
        (target({**PROVED, "verdict": "UNKNOWN"}), "nothing is missing"),
        (
            target({**REFUTED, "difference": {**REFUTED["difference"], "program": [{"open": True}]}}),
            "differ: none",
        ),
        (target(None, follows={**FOLLOWS, "demands": []}), "no verdicts on demands: none"),
        (target(None, follows={**FOLLOWS, "unjudged": ["Opens"]}), "FOLLOWS, and its demands say UNKNOWN"),
        (target(None, follows={**FOLLOWS, "demands": [BROKEN]}), "FOLLOWS, and its demands say BREAKS"),
        (
            target(None, follows={**FOLLOWS, "verdict": "BREAKS", "demands": [{**BROKEN, "broken": {}}]}),
            "BROKEN without scans",
        ),
        ({"verdict": "PROVED"}, "cannot be judged"),
    ],
)
def test_a_record_that_contradicts_itself_is_told(record: dict[str, Any], said: str, root: Path) -> None:
    troubles = kept(root, record).troubles
    assert [trouble.status for trouble in troubles] == [DIFFERS] and said in troubles[0].what


def test_a_program_that_changed_since_is_noted(root: Path) -> None:
    troubles = kept(root, target(PROVED, sources={"box.st": "0" * 64})).troubles
    assert [(trouble.status, trouble.items) for trouble in troubles] == [(NOTE, ("box.st",))]


def test_a_binding_that_changed_since_is_noted(root: Path) -> None:
    found = kept(root, target(PROVED, binding_file={"box.toml": "0" * 64}))
    assert [trouble.items for trouble in found.troubles] == [("box.toml",)]
    assert found.data["rows"][1]["how"] == "3 pairs; of files that have changed since"


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
    kept(root, target(PROVED, states=states))
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

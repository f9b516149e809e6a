"""The matrix: orphans first, every result from evidence, and the same as CSV and JUnit XML."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from modeproof.report.build import make
from modeproof.report.parts.matrix import part
from modeproof.report.sources import DIFFERS, gather
from tests.report.paper import change, declare_graph, make_paper, put, without

THEOREM = "it_shuts_over_the_door_only"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all its evidence."""
    return make_paper(tmp_path)


def rows(root: Path) -> dict[str, dict[str, Any]]:
    """The rows of the only document, by clause."""
    found: list[dict[str, Any]] = part(gather(root)).data["documents"][0]["rows"]
    return {row["clause"]: row for row in found}


def test_a_clause_leads_to_action_step_property_theorem_and_result(root: Path) -> None:
    first, second = rows(root)["BX-1-1"], rows(root)["BX-1-2"]
    assert first["action"] == ["Box!Close", "Box!Wait", "Box!Stay"] and first["step"] == ["box.step"]
    assert [(one["id"], one["text"]) for one in second["property"]] == [("ShutsOverDoor", "HOLDS")]
    assert [(one["id"], one["text"]) for one in second["theorem"]] == [(THEOREM, "PROVED")]
    assert second["property"][0]["word"].source == "build/evidence/box/MC_Box.json"
    assert (second["word"], second["good"], first["finding"]) == ("as expected", True, ["E-01"])


def test_an_orphan_stands_first_and_is_not_as_expected(root: Path) -> None:
    assert list(rows(root)) == ["BX-1-1", "BX-1-2"]
    change(
        root / "spec" / "box" / "properties.toml", 'clauses = ["BX-1-2", "BX-1-1"]', 'clauses = ["BX-1-1"]'
    )
    path = root / "proofs" / "box" / "box_safety.py"
    change(path, 'clauses=["BX-1-2"]', 'clauses=["BX-1-1"]')
    found = rows(root)
    assert list(found) == ["BX-1-2", "BX-1-1"]
    assert found["BX-1-2"]["word"] == "orphan" and found["BX-1-2"]["good"] is False
    troubles = part(gather(root)).troubles
    assert [one.status for one in troubles] == [DIFFERS]
    assert "BX-1-2: no property and no theorem cites this property" in troubles[0].what


def test_work_that_no_clause_asks_for_is_named(root: Path) -> None:
    change(root / "refimpl" / "box" / "box.py", '"""One scan (BX-1-1)."""', '"""One scan."""')
    astray = part(gather(root)).data["documents"][0]["astray"]
    assert [(one["file"], one["place"]) for one in astray] == [("refimpl/box/box.py", "step")]


def test_the_row_of_a_clause_shows_missing_or_wrong_results(root: Path) -> None:
    without(root, THEOREM)
    assert (rows(root)["BX-1-2"]["word"], rows(root)["BX-1-2"]["good"]) == ("not there", None)
    put(root, THEOREM, verdict="VIOLATED", as_expected=False, reason="counterexample")
    assert (rows(root)["BX-1-2"]["word"], rows(root)["BX-1-2"]["good"]) == ("not as expected", False)


def test_a_vector_says_how_programs_that_took_its_step_fared(root: Path) -> None:
    change(root / "spec" / "box" / "interface.toml", "published = false", "published = true")
    declare_graph(root, "states = 2\nedges = 4\n")
    assert rows(root)["BX-1-1"]["vector"][0]["text"] == "not there"
    taken = {"Close": [2, 2], "Wait": [1, 2]}
    result = {"target": "box", "suite": "brief", "covered": taken}
    fields = {"kind": "conformance", "verdict": "CONFORMS", "expected": "CONFORMS"}
    put(root, "adapter_box_brief", result=result, **fields)
    found = {one["id"]: (one["text"], one["good"]) for one in rows(root)["BX-1-1"]["vector"]}
    assert found == {
        "box/tour:Close": ("CONFORMS (brief)", True),
        "box/tour:Wait": ("not in full (brief)", None),
        "box/tour:Stay": ("not there", None),
    }
    put(root, "adapter_box_tour", result={**result, "suite": "tour", "covered": {"Wait": [2, 2]}}, **fields)
    assert rows(root)["BX-1-1"]["vector"][1]["text"] == "CONFORMS (tour)"
    wrong = {**fields, "verdict": "DIFFERS", "as_expected": False, "reason": "scan 3"}
    put(root, "adapter_box_wp", result={**result, "suite": "wp", "covered": {"Close": [1, 2]}}, **wrong)
    assert rows(root)["BX-1-1"]["vector"][0]["text"] == "DIFFERS (wp)"
    change(root / "spec" / "box" / "Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    assert rows(root)["BX-1-1"]["vector"][0]["text"] == "of another text (brief)"


def test_the_csv_has_a_row_per_clause_and_no_formula(root: Path) -> None:
    change(root / "spec" / "box" / "clauses.toml", 'title = "the box shuts"', 'title = "=1+1"')
    content = part(gather(root)).attachments["matrix.csv"].decode()
    found = list(csv.DictReader(io.StringIO(content)))
    assert [row["clause"] for row in found] == ["BX-1-1", "BX-1-2"]
    assert found[0]["title"] == "'=1+1"
    assert found[1]["theorem"] == f"{THEOREM}: PROVED"


def test_the_same_evidence_gives_the_same_files_to_the_byte(root: Path) -> None:
    assert part(gather(root)).attachments == part(gather(root)).attachments


def suite_of(root: Path) -> ElementTree.Element:
    """The test suite of the box."""
    return ElementTree.fromstring(part(gather(root)).attachments["junit.xml"])[0]


def test_a_test_case_names_clauses_evidence_and_the_evidence_hash(root: Path) -> None:
    suite = suite_of(root)
    case = next(one for one in suite if one.attrib["name"] == "MC_Box")
    told = [(one.attrib["name"], one.attrib["value"]) for one in case.iter("property")]
    assert ("clause", "BX-1-2") in told and ("verdict", "HOLDS") in told
    digest = gather(root).evidence["box"]["MC_Box"].sha256
    assert ("evidence", "build/evidence/box/MC_Box.json") in told and ("sha256", digest) in told
    assert (suite.attrib["failures"], suite.attrib["errors"]) == ("0", "0")


def test_unexpected_results_fail_and_missing_ones_are_errors(root: Path) -> None:
    reason = "bad \x00 <b>text</b>"
    put(root, "MC_Box", verdict="VIOLATED", as_expected=False, reason=reason)
    without(root, THEOREM)
    without(root, "MC_Box_lazy")
    suite = suite_of(root)
    assert (suite.attrib["failures"], suite.attrib["errors"]) == ("1", "2")
    cases = {one.attrib["name"]: one for one in suite}
    assert cases["MC_Box"][1].tag == "failure" and "<b>text</b>" in cases["MC_Box"][1].attrib["message"]
    assert cases[THEOREM][1].tag == cases["MC_Box_lazy"][1].tag == "error"


def test_a_run_of_another_lane_is_skipped(root: Path) -> None:
    without(root, "MC_Box_lazy")
    path = root / "spec" / "box" / "runs.toml"
    text = path.read_text()
    head, tail = text.split('id = "MC_Box_lazy"')
    path.write_text(f'{head}id = "MC_Box_lazy"{tail.replace("full", "exhaustive", 1)}')
    case = next(one for one in suite_of(root) if one.attrib["name"] == "MC_Box_lazy")
    assert case[1].tag == "skipped"


def test_the_page_offers_the_files_and_places_each_clause(root: Path) -> None:
    report = make(root)
    assert {"matrix.csv", "junit.xml"} <= set(report.attachments)
    assert 'id="clause-BX-1-1"' in report.html and 'data-file="matrix.csv"' in report.html

"""The machine in the report: from evidence alone, beside the documents, and judged again by its own rows."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.report.build import make
from modeproof.report.filing import Filing
from modeproof.report.junit import junit
from modeproof.report.parts import machine
from modeproof.report.sources import DIFFERS, HOLE, gather
from tests.report.box_machine import RESULT, ROW, add_machine, put_machine
from tests.report.paper import make_whole


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box, and a machine of its own with evidence."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    make_whole(tmp_path)
    add_machine(tmp_path)
    return tmp_path


def page(root: Path, filing: Filing | None = None) -> str:
    html = make(root, filing=filing).html
    return html[html.index('<section id="machine"') : html.index('<section id="limits"')]


def test_the_part_shows_all_that_the_evidence_has(root: Path) -> None:
    found = machine.part(gather(root))
    assert found.troubles == ()
    html = page(root)
    for text in (
        "Our own design after the five papers",
        "It is shut before it moves.",
        "A &lt;b&gt;hand&lt;/b&gt; is caught.",
        "by hand",
        "SF_Box",
        "Start, Stop",
        "block.box.inputs.Lid = TRUE",
        "after 5 ms: Start=1",
        "gives move=1",
        "order = box last",
        "judged it again from its text alone",
        "No person is in the model.",
        'href="#clause-BX-1-2"',
        'href="#finding-E-01"',
    ):
        assert text in html, text
    assert "XX-9</a>" not in html and "XX-9" in html
    assert "other words" not in html


def test_the_machine_is_counted_with_no_document(root: Path) -> None:
    with_machine = json.loads(make(root).json)["parts"]
    names = ("summary", "scope", "verdict", "functions")
    for part in names:
        assert '"cell"' not in json.dumps(with_machine[part]), part
    assert [one["id"] for one in with_machine["scope"]["documents"]] == ["box"]


def test_without_evidence_the_part_says_so(root: Path) -> None:
    evidence.discard(root, "cell", "machine")
    (trouble,) = machine.part(gather(root)).troubles
    assert (trouble.status, trouble.remedy) == (HOLE, "modeproof machine --evidence")
    assert "No evidence was found, so nothing is said here" in page(root)


def test_a_damaged_file_is_no_evidence(root: Path) -> None:
    evidence.evidence_path(root, "cell", "machine").write_text("{")
    assert [trouble.status for trouble in machine.part(gather(root)).troubles] == [HOLE]


def test_evidence_of_another_wiring_counts_for_nothing(root: Path) -> None:
    (root / "spec/cell/wiring.toml").write_text("title = 'another'\n")
    (trouble,) = machine.part(gather(root)).troubles
    assert (trouble.status, trouble.items) == (HOLE, ("spec/cell/wiring.toml",))
    html = page(root)
    assert "✓" not in html and "UNJUDGED" in html


@pytest.mark.parametrize("row", [{"verdict": "REFUTED", "how": "3 scans"}, {"reached_in_scans": [None]}])
def test_evidence_that_contradicts_itself_is_found(root: Path, row: dict[str, Any]) -> None:
    put_machine(root, RESULT | {"verdicts": [ROW | row]})
    found = make(root)
    assert any(
        trouble.status == DIFFERS and "contradicts itself" in trouble.what for trouble in found.troubles
    )
    assert found.status == 1


def test_a_refuted_property_is_a_trouble_and_a_failure(root: Path) -> None:
    row = ROW | {"verdict": "REFUTED", "how": "3 scans"}
    why = "shut-first: REFUTED: 3 scans"
    put_machine(root, RESULT | {"verdicts": [row]}, verdict="REFUTED", as_expected=False, reason=why)
    sources = gather(root)
    assert any(trouble.status == DIFFERS and why in trouble.what for trouble in make(root).troubles)
    suite = ElementTree.fromstring(junit(sources)).find("testsuite[@name='cell']")
    assert suite is not None
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("1", "1", "0")
    assert suite.find("testcase[@name='shut-first']/failure") is not None


def test_a_refused_wiring_has_its_reason_in_the_part(root: Path) -> None:
    put_machine(root, {}, verdict="UNJUDGED", as_expected=False, reason="wiring.toml:3: no signal 'Strat'")
    assert "Strat" in page(root)


def test_a_report_on_chosen_documents_leaves_it_out(root: Path) -> None:
    assert "the machine of the project is not part of it" in page(root, Filing(documents=("box",)))
    evidence.discard(root, "cell", "machine")
    assert machine.part(gather(root, Filing(documents=("box",)))).troubles == ()


def test_the_report_notices_a_changed_wiring(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["report", "--quiet"])
    assert main(["report", "--verify"]) == 0
    (root / "spec/cell/wiring.toml").write_text("title = 'another'\n")
    (root / "spec/cell/more.toml").write_text("")
    capsys.readouterr()
    assert main(["report", "--verify"]) == 1
    said = capsys.readouterr().out
    assert "differs  spec/cell/wiring.toml" in said
    assert "new      spec/cell/more.toml" in said

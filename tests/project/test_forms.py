"""What `judge` found is written in the forms that others read."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.project.conftest import Judge
from tests.project.foreign import TOML, WRONG, write

pytestmark = pytest.mark.usefixtures("asked")


@pytest.fixture
def three(place: Path) -> Path:
    """An entry that is right, one that is wrong, and one that is refused."""
    more = "".join(TOML.partition("\n\n")[2].replace("contactors", name) for name in "bc")
    return write(place, modeproof_toml=TOML + more, plc__b_st=WRONG, plc__c_st="refused")


def test_every_form_has_every_entry(three: Path, judge: Judge) -> None:
    words = [word for form in ("json", "junit", "sarif", "markdown") for word in (f"--{form}", f"out.{form}")]
    status, _, err = judge(*words)
    assert (status, err) == (1, "")
    table = json.loads((three / "out.json").read_text("utf-8"))
    assert (table["status"], table["schema_version"]) == (1, 1)
    assert [(row["name"], row["outcome"]["word"], row["kept"]) for row in table["entries"]] == [
        *[("contactors", "PROVED", False), ("b", "REFUTED", False), ("c", "UNJUDGED", False)],
    ]
    suites = ElementTree.parse(three / "out.junit").getroot()
    counts = [(suite.get("name"), suite.get("failures"), suite.get("errors")) for suite in suites]
    assert counts == [("contactors", "0", "0"), ("b", "1", "0"), ("c", "0", "1")]
    runs = json.loads((three / "out.sarif").read_text("utf-8"))["runs"]
    assert [len(run["results"]) for run in runs] == [0, 1, 1]
    assert [run["automationDetails"]["id"].split("/")[2] for run in runs] == ["contactors", "b", "c"]
    summary = (three / "out.markdown").read_text("utf-8")
    assert "| `b` | **REFUTED** | breaks EDMA-01 | judged |" in summary and "syntax error" in summary
    assert "| `contactors` | **PROVED** |" in summary


def test_a_form_that_cannot_be_written_is_no_verdict(three: Path, judge: Judge) -> None:
    status, _, err = judge("--json", "no/such/folder/out.json")
    assert status == 2 and "no/such/folder/out.json: cannot be written" in err


def test_results_are_kept_out_of_git(three: Path, judge: Judge) -> None:
    judge()
    assert (three / ".modeproof/.gitignore").read_text() == "*\n"

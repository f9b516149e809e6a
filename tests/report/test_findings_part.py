"""Findings, assumptions and faults in the report: each with what shows it, and a hole where nothing does."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.report.build import make
from modeproof.report.parts import assumptions, faults, findings, readings
from modeproof.report.sources import DIFFERS, HOLE, gather
from tests.report.paper import RESULT, change, entry, make_paper, put, second, without

FAULTS = """
[faults.matrix]
run = "WIT_Box"
title = "door"
[[fault]]
id = "gone"
class = "loss"
title = "the door is gone"
model = "It is not there."
detected_by = ["the eye"]
runs = ["MC_Box"]
holds = ["ShutsOverDoor"]
falls = [{ property = "ShutsOverDoor", run = "NEG_Box_hasty", needs = "one hand" }]
not_detected = "A door of glass."
[[fault]]
id = "late"
class = "delay"
title = "the door is late"
model = "It comes later."
detected_by = []
not_detected = "Everything."
not_modelled = "nothing here has a clock"
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all its evidence."""
    return make_paper(tmp_path)


def test_a_finding_shows_readings_decision_and_evidence_with_verdicts(root: Path) -> None:
    one = entry(findings, root)["findings"][0]
    assert (one["says"], one["class"], one["drawing"]) == ("It shuts.", "safety", True)
    assert one["tries"] == ["Eager", "Lazy"]
    shown = {row["id"]: row for row in one["evidence"]}
    assert (shown["NEG_Box_eager"]["word"], shown["NEG_Box_eager"]["good"]) == ("VIOLATED", True)
    assert shown["NEG_Box_eager"]["steps"].value == 1
    assert shown["MC_Box_lazy"]["steps"] is None
    html = make(root).html
    assert 'href="#trace-box-NEG_Box_eager"' in html and 'id="finding-E-01"' in html
    assert "Nothing is in the door, and the box shuts." in html


def test_each_restored_reading_has_what_falls_in_how_many_steps(root: Path) -> None:
    rows = {row["id"]: row for row in entry(readings, root)["alone"]}
    assert list(rows) == ["MC_Box_lazy", "NEG_Box_eager"]
    assert (rows["NEG_Box_eager"]["readings"], rows["NEG_Box_eager"]["property"]) == (
        ["Eager"],
        "ShutsOverDoor",
    )
    assert rows["NEG_Box_eager"]["steps"].value == 1 and not rows["NEG_Box_eager"]["harmless"]
    assert rows["MC_Box_lazy"]["harmless"]


def test_a_reading_is_never_called_harmless_without_the_evidence(root: Path) -> None:
    without(root, "MC_Box_lazy")
    rows = {row["id"]: row for row in entry(readings, root)["alone"]}
    assert not rows["MC_Box_lazy"]["harmless"] and rows["MC_Box_lazy"]["word"] == "not there"
    assert make(root).status == HOLE


def test_harmless_means_that_each_of_its_runs_holds(root: Path) -> None:
    runs = root / "spec" / "box" / "runs.toml"
    second(root)
    change(runs, 'reading = "Lazy"\n', 'reading = "Lazy"\nalso = { MC_Box_second = [5, 11] }\n')
    other = "MC_Box_second_with_Lazy"
    for name in ("MC_Box_lazy", other):
        put(root, name, result=RESULT["MC_Box_lazy" if name == "MC_Box_lazy" else "MC_Box"])
    (row,) = (row for row in entry(readings, root)["alone"] if row["id"] == "MC_Box_lazy")
    assert row["harmless"] and [one["id"] for one in row["also"]] == [other]
    assert "harmless within the bounds of 2 runs" in make(root).html
    put(root, other, verdict="VIOLATED", as_expected=False, reason="ShutsOverDoor is violated")
    (row,) = (row for row in entry(readings, root)["alone"] if row["id"] == "MC_Box_lazy")
    assert not row["harmless"] and row["holding"] == 1
    assert "every property holds in 1 of 2 runs, so it is not called harmless here" in make(root).html


def test_a_negative_that_holds_is_not_as_expected(root: Path) -> None:
    put(root, "NEG_Box_eager", verdict="HOLDS", as_expected=False, reason="it does not fall")
    one = {row["id"]: row for row in entry(findings, root)["findings"][0]["evidence"]}["NEG_Box_eager"]
    assert (one["word"], one["good"], one["why"]) == ("HOLDS", False, "it does not fall")
    assert make(root).status == DIFFERS


def test_a_finding_without_evidence_or_reason_is_a_hole(root: Path) -> None:
    change(root / "spec" / "box" / "findings.toml", "no model can show a slip of the pen", "")
    troubles = findings.part(gather(root)).troubles
    assert [one.what for one in troubles] == ["box: E-02 names no evidence and does not say why"]


def test_assumptions_say_who_ensures_them_their_check_and_what_falls(root: Path) -> None:
    one = entry(assumptions, root)["assumptions"][0]
    assert (one["who"], one["check"]) == ("the builder", "count")
    assert (one["breaks"][0]["property"], one["breaks"][0]["steps"].value) == ("ShutsOverDoor", 1)
    assert 'id="assumption-A-01"' in make(root).html
    without(root, "NEG_Box_hasty")
    one = entry(assumptions, root)["assumptions"][0]
    assert (one["breaks"][0]["word"], one["breaks"][0]["good"]) == ("not there", None)


def test_a_document_without_a_fault_table_says_so(root: Path) -> None:
    assert entry(faults, root)["faults"] == []
    assert "declares no table of faults" in make(root).html


def test_the_fault_table_says_what_holds_falls_or_is_unmodelled(root: Path) -> None:
    with (root / "spec" / "box" / "assumptions.toml").open("a") as file:
        file.write(FAULTS)
    gone, late = entry(faults, root)["faults"]
    assert (gone["holds"], gone["runs"][0]["word"]) == (["ShutsOverDoor"], "HOLDS")
    assert (gone["falls"][0]["needs"], gone["falls"][0]["steps"].value) == ("one hand", 1)
    assert late["not_modelled"] == "nothing here has a clock"
    without(root, "MC_Box")
    gone = entry(faults, root)["faults"][0]
    assert (gone["runs"][0]["word"], gone["runs"][0]["good"]) == ("not there", None)


def test_an_unreached_cell_of_the_fault_matrix_says_so(root: Path) -> None:
    with (root / "spec" / "box" / "assumptions.toml").open("a") as file:
        file.write(FAULTS)
    runs = root / "spec" / "box" / "runs.toml"
    change(runs, 'witnesses = ["Close"]', 'witnesses = ["Close", "door at noon: shut", "door at dusk: open"]')
    put(root, "WIT_Box", result={"reached": ["Close", "door at noon: shut"]})
    matrix = entry(faults, root)["matrix"]
    assert matrix["columns"] == ["noon", "dusk"]
    assert [[one["reached"] for one in cell] for cell in matrix["rows"][0]["cells"]] == [[True], [False]]
    assert "not reached" in make(root).html

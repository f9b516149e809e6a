"""The conformance stage of verify: nothing to compare, no graph and a difference are each noticed."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from modeproof.graph.export import export_file
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.lane import conformance, verify
from modeproof.suites import builtin_comparison as command
from tests.toy_tree import toy_tree


@dataclass
class Found:
    """What a comparison gives, as far as the stage reads it."""

    verdict: str
    equal: bool
    states: int = 9
    transitions: int = 18
    replayed: int = 18
    covered: dict[str, tuple[int, int]] = field(default_factory=lambda: {"Up": (9, 9), "Down": (8, 9)})
    differences: tuple[str, ...] = ()

    def summary(self) -> str:
        return "9 states, 18 transitions, DIFFERS: 1 differences"


@dataclass
class Drawn:
    """A state chart."""

    initial: str


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(conformance, "_targets", lambda place, document, lane: [])
    root = toy_tree(tmp_path, "OPEN_toy")
    (root / "spec/toy/interface.toml").write_text("")
    return root


def compare(root: Path, lane: str = "smoke") -> dict[str, Any]:
    records, troubles = conformance.compare_reference(root, ["toy"], lane, Progress(quiet=True))
    if troubles:
        raise Unjudged(troubles["toy"])
    (record,) = records
    written = evidence.read(evidence.evidence_path(root, "toy", record["id"]))
    assert written["verdict"] == record["verdict"] and written["reason"] == record["reason"]
    return record


def export(root: Path) -> Path:
    """A file as the export of the graph."""
    path = export_file(root, "toy", "OPEN_toy")
    path.parent.mkdir(parents=True)
    path.write_bytes(b"a graph")
    return path


def test_a_lane_without_a_graph_is_no_pass(toy: Path) -> None:
    runs = toy / "spec/toy/runs.toml"
    runs.write_text(runs.read_text().replace('lanes = ["smoke", "full"]', 'lanes = ["smoke"]'))
    for lane in ("full", "exhaustive"):
        with pytest.raises(Unjudged, match=f"the lane {lane} has no OPEN run, so nothing is compared"):
            compare(toy, lane)


def test_graphs_of_the_full_lane_are_compared_there_alone(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(verify, "property_rows", lambda place, document: [])
    stage = ("conformance", conformance.compare_reference)
    assert verify.verify(toy, ["toy"], "exhaustive", [stage], Progress(quiet=True)) == (0, [])
    assert f"toy: {conformance.ELSEWHERE}" in capsys.readouterr().out
    assert verify.verify(toy, ["toy"], "full", [stage], Progress(quiet=True))[0] == 2


def test_a_missing_graph_is_unjudged(toy: Path) -> None:
    record = compare(toy)
    assert (record["verdict"], record["as_expected"]) == ("UNJUDGED", False)
    assert "no graph of the present text: no evidence; run modeproof check" in record["reason"]


def test_a_difference_is_named(toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = Found("DIFFERS", False, differences=("outputs in Up after 3 scans: expected MW01='0000'",))
    monkeypatch.setattr(command, "compared", lambda *_: (found, {}))
    record = compare(toy)
    assert (record["verdict"], record["as_expected"]) == ("DIFFERS", False)
    assert "first: outputs in Up after 3 scans" in record["reason"]


def test_equal_says_how_much_was_covered(toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "compared", lambda *_: (Found("EQUAL", True), {}))
    record = compare(toy)
    assert record["as_expected"] and "18 of 18 transitions, 1 of 2 steps in full" in record["strength"]


def test_the_export_of_the_graph_is_named_with_its_hash(toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("load_device_graph", "load_implementation"):
        monkeypatch.setattr(command, name, Mock())
    monkeypatch.setattr(command, "chart", lambda graph: Drawn("Off"))
    monkeypatch.setattr(command, "write_export", lambda *_: export(toy))
    monkeypatch.setattr(command, "compare", lambda *_, codes: Found("EQUAL", codes))
    digest = hashlib.sha256(b"a graph").hexdigest()
    result = compare(toy)["result"]
    assert result["artefacts"] == {"build/export/toy/OPEN_toy.json.gz": digest}
    assert result["chart"] == {"initial": "Off"} and result["equal"], "of our own code every output"


def test_an_export_of_an_earlier_run_does_not_stay(toy: Path) -> None:
    old = export(toy)
    assert compare(toy)["verdict"] == "UNJUDGED" and not old.exists()

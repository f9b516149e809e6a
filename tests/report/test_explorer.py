"""The explorer carries the graphs that were compared, and only those; what it says of a device is cited."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.report.part import Part
from modeproof.report.parts.explorer import ABOUT, part
from modeproof.report.sources import DIFFERS, HOLE, gather
from tests.report.box_graph import EXPORT, add_graph, compared
from tests.report.paper import change, make_paper, put, without

PAYLOAD = "graph-box-OPEN_Box"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with its evidence and its graph."""
    add_graph(make_paper(tmp_path))
    return tmp_path


def row(found: Part) -> dict[str, Any]:
    (one,) = found.data["graphs"]
    return dict(one)


def test_the_page_carries_the_graph_as_it_was_exported(root: Path) -> None:
    found = part(gather(root))
    assert found.troubles == () and row(found)["shown"] is True
    assert found.payload[PAYLOAD] == gzip.decompress((root / EXPORT).read_bytes())
    graph = json.loads(found.payload[PAYLOAD])
    assert graph["steps"] == ["Wait", "Close", "Stay"] and len(graph["states"]) == 2


def test_counts_and_verdict_come_from_evidence_of_the_comparison(root: Path) -> None:
    one = row(part(gather(root)))
    assert [one[key].value for key in ("states", "inputs", "transitions", "verdict")] == [2, 4, 8, "EQUAL"]
    assert {one[key].source for key in ("states", "verdict")} == {"build/evidence/box/refimpl_OPEN_Box.json"}
    assert one["good"] is True


def test_the_export_is_one_of_the_hashed_files(root: Path) -> None:
    sources = gather(root)
    part(sources)
    assert len(sources.files[EXPORT]) == 64 and "spec/box/sequences.toml" in sources.files


def test_a_changed_export_is_hidden_and_not_as_expected(root: Path) -> None:
    (root / EXPORT).write_bytes(gzip.compress(b'{"format":1}'))
    found = part(gather(root))
    assert PAYLOAD not in found.payload and row(found)["shown"] is False
    assert [one.status for one in found.troubles] == [DIFFERS]
    assert f"{EXPORT} is not what the comparison wrote" in found.troubles[0].what


def test_a_missing_export_is_a_hole_with_its_command(root: Path) -> None:
    (root / EXPORT).unlink()
    found = part(gather(root))
    assert [(one.status, one.remedy) for one in found.troubles] == [(HOLE, "modeproof verify --document box")]
    assert f"{EXPORT} is not there" in found.troubles[0].what


PACKED = [b"no gzip", gzip.compress(b"{"), gzip.compress(b'{"format": 99}')]


@pytest.mark.parametrize(
    "text", PACKED, ids=["no gzip", "no JSON", "another format"]
)  # the bytes name the time
def test_an_export_that_is_not_understood_is_a_hole(root: Path, text: bytes) -> None:
    (root / EXPORT).write_bytes(text)
    compared(root)
    found = part(gather(root))
    assert [one.status for one in found.troubles] == [HOLE] and "no graph of format 1" in found.troubles[
        0
    ].what


def test_the_graph_of_another_run_is_not_shown(root: Path) -> None:
    graph = json.loads(gzip.decompress((root / EXPORT).read_bytes()))
    (root / EXPORT).write_bytes(gzip.compress(json.dumps({**graph, "run": "OPEN_Other"}).encode()))
    compared(root)
    found = part(gather(root))
    assert PAYLOAD not in found.payload and "is the graph of another run" in found.troubles[0].what


def test_a_run_that_was_not_compared_is_a_hole(root: Path) -> None:
    without(root, "refimpl_OPEN_Box")
    found = part(gather(root))
    assert "no comparison of its graph is recorded" in found.troubles[0].what
    assert row(found)["states"] is None and row(found)["verdict"] is None


def test_evidence_without_an_export_says_so(root: Path) -> None:
    compared(root, artefacts={})
    assert "its graph was not exported" in part(gather(root)).troubles[0].what


def test_actions_cite_the_clauses_and_findings_of_the_specification(root: Path) -> None:
    device = part(gather(root)).data["devices"]["box/box"]
    assert device["actions"]["Close"] == {"clauses": ["BX-1-1"], "findings": ["E-01"]}
    assert device["actions"]["Stay"] == {"clauses": ["BX-1-1"], "findings": []}


def test_words_are_decoded_by_the_tables_of_the_registers(root: Path) -> None:
    device = part(gather(root)).data["devices"]["box/box"]
    assert device["codes"] == {"WORD": {"says": "code", "words": {"0F0F": 0, "0F10": 1}}}
    (root / "spec/box/sequences.toml").unlink()
    assert part(gather(root)).data["devices"]["box/box"]["codes"] == {}


def test_properties_say_their_subject_and_whether_this_graph_was_asked(root: Path) -> None:
    found = part(gather(root))
    (one,) = found.data["devices"]["box/box"]["properties"]
    assert (one["id"], one["of"], one["clauses"]) == (
        "ShutsOverDoor",
        "each transition",
        ["BX-1-2", "BX-1-1"],
    )
    assert json.loads(found.payload[ABOUT])["graphs"] == {"box-OPEN_Box": ["ShutsOverDoor"]}


def test_an_unexpected_run_makes_no_property_hold(root: Path) -> None:
    put(root, "OPEN_Box", verdict="VIOLATED", expected="HOLDS", as_expected=False, reason="it falls")
    assert row(part(gather(root)))["checked"] == []


def test_nothing_holds_on_a_graph_of_another_text(root: Path) -> None:
    change(root / "spec/box/Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    one = row(part(gather(root)))
    assert one["checked"] == [] and one["good"] is None

"""A verdict on a vector file that somebody handed over says whether it is a published one."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.places import TREE
from modeproof.kit.ids import case_id

BRIEF = TREE / "vectors" / "sf_edm" / "brief.jsonl.gz"


def verdict_on(path: Path, capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["conform", "sf_edm", "--builtin", "refimpl", "--vectors", str(path)]) == 0
    return next(line for line in capsys.readouterr().out.splitlines() if line.startswith("CONFORMS("))


def test_a_published_file_is_named_by_its_suite_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    unpacked = tmp_path / "mine.jsonl"
    unpacked.write_bytes(gzip.decompress(BRIEF.read_bytes()))
    for path in (BRIEF, unpacked):
        assert verdict_on(path, capsys).startswith("CONFORMS(exact, brief; profile letter")


def test_cases_cut_to_their_first_scan_are_not_the_suite(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header, *cases = map(json.loads, gzip.decompress(BRIEF.read_bytes()).decode().splitlines())
    cut = [{**case, "scans": case["scans"][:1]} for case in cases]
    for case in cut:
        case["id"] = case_id("sf_edm", case["params"], [(row["dt_ms"], row["in"]) for row in case["scans"]])
    path = tmp_path / "brief.jsonl"
    path.write_text("".join(json.dumps(row) + "\n" for row in [{**header, "scans": len(cut)}, *cut]))
    assert verdict_on(path, capsys).startswith("CONFORMS(exact, brief, not as published; profile letter")


def test_a_suite_of_ones_own_is_not_published(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    header, *cases = gzip.decompress(BRIEF.read_bytes()).decode().splitlines()
    path = tmp_path / "own.jsonl"
    path.write_text("\n".join([json.dumps({**json.loads(header), "suite": "own"}), *cases]) + "\n")
    assert verdict_on(path, capsys).startswith("CONFORMS(exact, own, not published; profile letter")

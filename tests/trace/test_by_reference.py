"""Logs of one device without TLC: the reference has one answer, and what is open is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.places import TREE

LOGS = TREE / "examples" / "logs"


@pytest.fixture(autouse=True)
def without_tlc(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("MODEPROOF_JAVA", str(tmp_path / "no java"))
    monkeypatch.setenv("MODEPROOF_STATE", str(tmp_path / "state"))


@pytest.mark.parametrize("name", ["fplc_good.jsonl", "fplc_good.csv"])
def test_a_log_that_fits_fits(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trace", "fplc", str(LOGS / name)]) == 0
    out = capsys.readouterr().out
    assert "by reference:" in out and "CONFORMS(exact" in out and "TLC, which makes the graph, is not" in out


@pytest.mark.parametrize(
    ("name", "line", "output"),
    [("fplc_wrong_echo", 29, "MW05    33CC       0FF0"), ("fplc_short_dwell", 40, "MW01    0000       3333")],
)
def test_the_first_wrong_scan_is_that_of_tlc(
    name: str, line: int, output: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    log, record = LOGS / f"{name}.jsonl", tmp_path / "out.json"
    told = tmp_path / "told.md"
    assert main(["trace", "fplc", str(log), "--json", str(record), "--markdown", str(told)]) == 1
    [name, expected, logged] = output.split()
    assert f"Wrong: {name} is {logged}, expected {expected} |" in told.read_text()
    out = capsys.readouterr().out
    assert f"line {line} of the log" in out and output in out
    found = json.loads(record.read_text())["trace"]
    assert found["verdict"] == "DIFFERS" and "tlc" not in found["tools"] and "tlc" not in found["result"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["fplc", "fplc_partial.csv"], "line 8 leaves MW07 open, so only TLC can judge it"),
        (["fplc", "fplc_from_the_middle.jsonl", "--from", "anywhere"], "a log of one device from power-up"),
        (["fplc", "fplc_sampled.csv", "--samples", "20"], "a log of one device from power-up"),
        (["key_flows", "key_flows_good.jsonl"], "a log of one device from power-up"),
    ],
)
def test_what_is_open_is_refused(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    target, name, *options = arguments
    assert main(["trace", target, str(LOGS / name), *options]) == 2
    assert words in capsys.readouterr().err


def test_an_open_time_that_decides_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = (LOGS / "fplc_short_dwell.jsonl").read_text().splitlines()
    row = json.loads(lines[38])
    del row["dt_ms"]
    log = tmp_path / "open.jsonl"
    log.write_text("\n".join([*lines[:38], json.dumps(row), *lines[39:]]) + "\n")
    assert main(["trace", "fplc", str(log)]) == 2
    assert "line 39 leaves the time open" in capsys.readouterr().err


def test_too_many_ways_of_an_open_time_are_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("modeproof.trace.by_reference.MOST_STATES", 0)
    assert main(["trace", "fplc", str(LOGS / "fplc_good.csv")]) == 2
    assert "leaves the time open" in capsys.readouterr().err

"""Logs of a whole machine: the composed reference judges them and shows the first impossible scan."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.kit.vectors import open_suite

ROOT = Path(__file__).parents[2]
SUITE = open_suite(ROOT / "vectors/machine_cell/sequences.jsonl.gz")
Line = dict[str, Any]


@pytest.fixture(scope="module")
def lines() -> list[Line]:
    """The first case as a log."""
    case = next(SUITE.cases())
    return [{"dt_ms": scan.dt_ms, "in": dict(scan.inputs), "out": dict(scan.outputs)} for scan in case.scans]


def copied(lines: list[Line]) -> list[Line]:
    found: list[Line] = json.loads(json.dumps(lines))
    return found


def as_lines(path: Path, lines: list[Line]) -> Path:
    rows = [{"target": "machine_cell"}, *lines]
    path.write_text("".join(json.dumps(row) + "\n" for row in rows), "utf-8")
    return path


def as_table(path: Path, lines: list[Line]) -> Path:
    """As a trace tool exports it: the time since the start, words with 16#, 0 and 1."""
    with path.open("w", newline="") as file:
        table = csv.writer(file, delimiter=";")
        names = [*lines[0]["in"], *lines[0]["out"]]
        table.writerow(["t_ms", *names])
        now = 0
        for line in lines:
            now += line["dt_ms"]
            values = {**line["in"], **line["out"]}
            cells = [int(one) if isinstance(one, bool) else f"16#{one}" for one in map(values.get, names)]
            table.writerow([now, *cells])
    return path


def trace(path: Path, *more: str) -> int:
    return main(["trace", "machine_cell", str(path), *more])


@pytest.mark.parametrize("form", [as_lines, as_table])
def test_a_log_of_the_machine_conforms(
    form: Any, lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = form(tmp_path / ("log.csv" if form is as_table else "log.jsonl"), lines)
    assert trace(path) == 0
    assert f"CONFORMS(exact, {path}; 7 of 7 outputs compared)" in capsys.readouterr().out


def test_the_first_wrong_scan_is_shown_with_its_outputs(
    lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = copied(lines)
    at = next(n for n, line in enumerate(wrong) if line["out"]["S_DriveEnable"])
    wrong[at - 1]["out"]["S_DriveEnable"] = True
    assert trace(as_lines(tmp_path / "log.jsonl", wrong), "--json", str(tmp_path / "found.json")) == 1
    said = capsys.readouterr().out
    assert f"first impossible scan: {at}, line {at + 1} of the log" in said
    assert "S_DriveEnable    false      true" in said
    found = json.loads((tmp_path / "found.json").read_text("utf-8"))
    assert (found["verdict"], found["accepted"], found["first"]["line"]) == ("DIFFERS", at - 1, at + 1)


def test_a_log_is_judged_by_the_wiring_that_is_named(
    lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my.toml"
    text = (ROOT / "spec/machine_cell/wiring.toml").read_text("utf-8")
    mine.write_text(text.replace('S_OutControl = "running.Q1 OR held.Q1"', 'S_OutControl = "Reset"'), "utf-8")
    assert trace(as_lines(tmp_path / "log.jsonl", lines), "--wiring", str(mine)) == 1
    assert "DIFFERS" in capsys.readouterr().out


def lost_input(lines: list[Line]) -> None:
    del lines[7]["in"]["S_GuardBolt"]


def no_time(lines: list[Line]) -> None:
    del lines[7]["dt_ms"]


def no_outputs(lines: list[Line]) -> None:
    for line in lines:
        line["out"] = {}


@pytest.mark.parametrize(
    "change,said",
    [
        (lost_input, "line 9: S_GuardBolt is not there"),
        (no_time, "line 9: no time"),
        (no_outputs, "no line shows an output"),
    ],
)
def test_a_log_that_leaves_something_open_is_not_judged(
    change: Any, said: str, lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    less = copied(lines)
    change(less)
    assert trace(as_lines(tmp_path / "log.jsonl", less)) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


def test_samples_of_a_machine_are_refused(
    lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert trace(as_lines(tmp_path / "log.jsonl", lines), "--samples", "10") == 2
    assert "every scan from power-up" in capsys.readouterr().err


def test_a_wiring_that_is_none_is_refused(
    lines: list[Line], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text("title = 'nothing'\nscan_ms = [1, 2]\n", "utf-8")
    assert trace(as_lines(tmp_path / "log.jsonl", lines), "--wiring", str(mine)) == 2
    err = capsys.readouterr().err
    assert "is missing; `modeproof machine" in err
    assert "Traceback" not in err

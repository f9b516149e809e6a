"""`modeproof trace`: exit status, verdict, evidence, and one line for what cannot be judged."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.ground.places import root
from modeproof.trace import trace_command as command
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.log_judge import Graphs
from tests.trace.judging import log_of
from tests.trace.test_devices import walk


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, alphabets: dict[str, Alphabet]) -> Path:
    """A root of its own with the repository's specification, and graphs that are there already."""
    shutil.copytree(root() / "spec", tmp_path / "spec")
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    monkeypatch.setattr(command, "Graphs", lambda at, make: Graphs(at, make, alphabets))
    return tmp_path


@pytest.mark.deep
def test_a_log_that_fits_and_one_that_does_not(
    place: Path, alphabets: dict[str, Alphabet], capsys: pytest.CaptureFixture[str]
) -> None:
    lines = walk(alphabets["OPEN_Hmi"].graph, 3)
    good, bad = place / "good", place / "bad"
    good.mkdir()
    bad.mkdir()
    log_of(good, "hmi", lines)
    assert main(["trace", "hmi", str(good / "hmi.jsonl"), "--quiet"]) == 0
    assert capsys.readouterr().out.endswith(
        f"CONFORMS(exact, {good / 'hmi.jsonl'}; 6 of 6 outputs compared, in 50 of 50 scans)\n"
    )

    at = next(n for n, line in enumerate(lines) if line["out"]["screen"] == "confirm")
    lines[at] = {**lines[at], "out": {**lines[at]["out"], "SwitchMSO": "1234"}}
    log_of(bad, "hmi", lines)
    assert main(["trace", "hmi", str(bad / "hmi.jsonl"), "--quiet", "--json", str(place / "out.json")]) == 1
    out = capsys.readouterr().out
    assert f"first impossible scan: {at + 1:,}, line {at + 1} of the log" in out
    assert "SwitchMSO  0000       1234\n" in out and "the specification takes ShowEcho (Hmi.tla:" in out
    record = evidence.read(evidence.evidence_path(place, "mode_selection", "trace_hmi_hmi", evidence.YOURS))
    assert (record["kind"], record["verdict"], record["as_expected"]) == ("trace", "DIFFERS", False)
    assert record["result"]["accepted"] == at and record["result"]["why"]["taken"][0]["wrong"] == [
        "SwitchMSO"
    ]
    assert "spec/mode_selection/HmiTrace.tla" in record["inputs"]
    assert json.loads((place / "out.json").read_text())["trace"] == record


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (["hmj", "log.jsonl"], "no log can be of 'hmj'; did you mean 'hmi'? "),
        (["hmi", "nothing.jsonl"], "nothing.jsonl: No such file or directory"),
        (["hmi", "empty.jsonl"], "empty.jsonl: no scan in it"),
        (["hmi", "cut.jsonl"], "cut.jsonl: line 2, column 16: the last line is cut off"),
        (["hmi", "one.jsonl", "--param", "T_ms=5"], "--param T_ms: hmi has no parameter 'T_ms'"),
        (["hmi", "one.jsonl", "--param", "T_ms"], "--param T_ms: NAME=VALUE was expected"),
        (["key_flows", "shown.jsonl", "--from", "anywhere"], "a log of key_flows must begin at power-up"),
        (["key_flows", "shown.jsonl", "--samples", "20"], "--samples is for one device"),
        (["hmi", "one.jsonl"], "one.jsonl: nothing to compare: no line shows an output of hmi"),
        (["hmi", "repeats.jsonl"], "nothing to compare: no line shows an output of hmi"),
        (["hmi", "timeless.jsonl", "--samples", "20"], "line 2: a sample needs its time"),
        (["hmi", "slow.jsonl", "--samples", "1"], "line 1: up to 40,000 scans since the sample before are"),
    ],
)
def test_what_cannot_be_judged_is_one_line_and_status_2(
    arguments: list[str],
    wanted: str,
    place: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(place)
    scan = '{"dt_ms":1,"in":{"touch":null},"out":{}}\n'
    (place / "empty.jsonl").write_text("\n")
    (place / "cut.jsonl").write_text(scan + '{"dt_ms":1,"in"')
    (place / "one.jsonl").write_text(scan)
    (place / "repeats.jsonl").write_text('{"out":{"active":1}}\n')
    (place / "timeless.jsonl").write_text('{"out":{"screen":"select"}}\n' * 2)
    (place / "slow.jsonl").write_text('{"dt_ms":40000,"out":{"screen":"select"}}\n' * 2)
    header = '{"params":{"eks":{"checksum":"1234"}}}\n'
    of_panel = scan.replace("{", '{"device":"hmi",', 1)
    (place / "shown.jsonl").write_text(header + of_panel.replace('"out":{}', '"out":{"shown":0}'))
    assert main(["trace", *arguments, "--quiet"]) == 2
    error = capsys.readouterr().err
    assert wanted in error and error.count("\n") == 1

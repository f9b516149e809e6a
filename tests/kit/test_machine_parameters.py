"""With the parameters of a machine every suite expects what they demand, and the verdict names them."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.builtin import Builtin
from modeproof.kit.errors import Unjudged
from modeproof.kit.machine_parameters import with_parameters
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from refimpl.edm import sf_edm
from tests.graph.printed import lamp_graph
from tests.kit.programs import program

ROOT = Path(__file__).resolve().parents[2]


def suite_of(name: str) -> Suite:
    return open_suite(ROOT / f"vectors/sf_edm/{name}.jsonl.gz")


def conform(name: str, package: str, *more: str) -> list[str]:
    path = str(ROOT / f"vectors/sf_edm/{name}.jsonl.gz")
    return ["conform", "sf_edm", "--builtin", package, "--vectors", path, "--quiet", *more]


@pytest.fixture
def deaf(monkeypatch: pytest.MonkeyPatch) -> str:
    """A package whose block takes no MonitoringTime but those of the suites: it takes 200 for 170
    and 300."""

    def power_up(params: Any) -> Any:
        time_ms = 200 if params.MonitoringTime_ms in (170, 300) else params.MonitoringTime_ms
        return sf_edm.power_up(sf_edm.Params(time_ms, params.AFTER_RESET))

    names = ("Params", "Inputs", "Outputs", "step")
    module = SimpleNamespace(power_up=power_up, **{name: getattr(sf_edm, name) for name in names})
    monkeypatch.setitem(sys.modules, "deaf.edm.sf_edm", module)  # type: ignore[arg-type]
    return "deaf"


@pytest.mark.parametrize(("name", "relation"), [("brief", "exact"), ("sic", "settled")])
def test_a_machines_own_parameters_are_judged_in_every_relation(
    name: str, relation: str, deaf: str, capsys: pytest.CaptureFixture[str]
) -> None:
    own = f"MonitoringTime_ms={170 if relation == 'exact' else 300}"
    more = ["--relation", relation, "--param", own]
    assert kit_main(conform(name, "refimpl", *more)) == 0
    told = capsys.readouterr().out
    hidden = "not compared: SafetyDemand, ResetRequest, DiagCode"
    word = f"CONFORMS({relation}, {name}; profile letter; {hidden}; with {own})"
    assert told.endswith(f"{word}\n") and "transitions" not in told and "covered" not in told
    assert ("a limit may lie between two scans" in told) == (relation != "exact")
    assert kit_main(conform(name, deaf, "--relation", relation)) == 0, "the suite's own time is right"
    capsys.readouterr()
    assert kit_main(conform(name, deaf, *more)) == 1
    again = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("again:"))
    words = shlex.split(again)
    assert "--param" in words and own in words
    tail = words[words.index("--case") :]
    assert kit_main([*conform(name, deaf, *more), *tail]) == 1
    assert kit_main([*conform(name, "refimpl", *more), *tail]) == 0


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("NONE=1", "a parameter of sf_edm: MonitoringTime_ms, AFTER_RESET"),
        ("MonitoringTime_ms", "NAME=VALUE expected"),
        ("MonitoringTime_ms=-1", "an integer"),
        ("MonitoringTime_ms=soon", "an integer"),
        ("AFTER_RESET=never", "one of"),
        ("=1", "NAME=VALUE expected"),
    ],
)
def test_a_parameter_that_is_none_is_refused(
    word: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert kit_main(conform("brief", "refimpl", "--param", word)) == 2
    assert said in capsys.readouterr().err


def test_parameters_that_do_not_go_together_are_unjudged(capsys: pytest.CaptureFixture[str]) -> None:
    path = str(ROOT / "vectors/fplc/sequences.jsonl.gz")
    args = ["conform", "fplc", "--builtin", "refimpl", "--vectors", path, "--quiet"]
    assert kit_main([*args, "--param", "T_SEQ_FROM=LA", "--param", "T_SEQ_ms=3"]) == 2
    assert "reset was refused: T_SEQ_ms: expected at least T_ON_ms" in capsys.readouterr().out


def test_without_a_reference_implementation_nothing_is_expected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_suite(tmp_path / "tour.jsonl", "tour", [lamp_graph(tmp_path)])
    command = shlex.join(program(tmp_path))
    args = ["conform", "lamp", "--adapter", command, "--vectors", str(tmp_path / "tour.jsonl"), "--quiet"]
    assert kit_main([*args, "--param", "T_ms=400"]) == 2
    assert "--builtin refimpl: No module named" in capsys.readouterr().err


def test_outputs_that_have_not_settled_are_not_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    own = with_parameters(suite_of("sic"), ["MonitoringTime_ms=170"], "settled")
    assert sum(1 for _ in own.cases()) == own.case_count
    monkeypatch.setattr(Builtin, "at_rest", lambda self, inputs: False)
    with pytest.raises(Unjudged, match="the outputs have not settled here"):
        list(own.cases())


def test_a_time_ends_where_something_happens() -> None:
    block = Builtin("refimpl", suite_of("sic"))
    block.reset({"MonitoringTime_ms": 170})
    asked = dict.fromkeys(suite_of("sic").inputs, False) | {"Activate": True, "S_StartReset": True}
    block.scan(0, {**asked, "S_StartReset": False})
    block.scan(0, asked)
    assert block.pieces(100, asked) == (100,), "nothing happens in it"
    before = block._state
    assert sum(block.pieces(500, asked)) == 500 and len(block.pieces(500, asked)) == 3
    assert block._state is before
    late = sum(block.pieces(500, asked)[:2])
    errors = [block.scan(ms, asked)["Error"] for ms in block.pieces(500, asked)]
    assert errors == [False, True, True] and late in (170, 171)


def test_at_rest_looks_and_changes_nothing() -> None:
    block = Builtin("refimpl", suite_of("sic"))
    block.reset({})
    case = next(iter(suite_of("sic").cases()))
    resting: list[bool] = []
    for scan in case.scans:
        state: Mapping[str, Any] = block.scan(scan.dt_ms, scan.inputs)
        before = block._state
        resting.append(block.at_rest(scan.inputs))
        assert block._state is before and state == block._rows.get(None, state)
    assert True in resting and False in resting

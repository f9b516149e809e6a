"""Programs that are right at the parameters of the graphs, and wrong at others."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.graph.device import load_device_graph, open_runs
from modeproof.graph.equal import compare
from modeproof.graph.implementation import load_implementation
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import open_suite
from modeproof.suites.at import every_pair, graph_at, scaled, tick_of
from modeproof.suites.build import make_graphs
from modeproof.suites.parameters import variants
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp
from tests.suites.test_conform_command import toy as toy  # the fixture


class Words(Lamp):
    """The time is kept in 16 bits."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset({"T_ms": params.get("T_ms", 500) & 0xFFFF})


class Units(Lamp):
    """The time is kept in units of 10 ms."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset({"T_ms": params.get("T_ms", 500) // 10 * 10})


class Keeps(Lamp):
    """What is not given stays as it was."""

    kept = 500

    def reset(self, params: Mapping[str, Any]) -> None:
        self.kept = params.get("T_ms", self.kept)
        super().reset({"T_ms": self.kept})


class Default(Lamp):
    """Another default."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset({"T_ms": params.get("T_ms", 250)})


class Clamps(Lamp):
    """No scan is longer than a second."""

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        return super().scan(min(dt_ms, 1000), inputs)


@pytest.mark.parametrize("fault", [Words, Units, Keeps, Default, Clamps])
def test_a_fault_of_parameters_is_found(tmp_path: Path, fault: type[Lamp]) -> None:
    long = scaled(lamp_graph(tmp_path), 2)
    write_suite(tmp_path / "p", "parameters", [long, lamp_graph(tmp_path)])
    write_suite(tmp_path / "wp", "wp", [lamp_graph(tmp_path)])
    assert run_suite(open_suite(tmp_path / "wp"), fault).word == CONFORMS
    assert run_suite(open_suite(tmp_path / "p"), fault).word == DIFFERS
    assert run_suite(open_suite(tmp_path / "p"), Lamp).word == CONFORMS


def test_all_times_are_longer_together(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    longer = scaled(graph, Fraction(7, 250))
    assert longer.params == {"T_ms": 14} and {letter["dt_ms"] for letter in longer.alphabet} == {0, 7, 14}
    assert (tick_of(graph), tick_of(longer)) == (250, 7) and longer.graph is graph.graph


def test_a_time_that_a_graph_leaves_out_has_its_default(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    assert variants([replace(graph, params={})]) == variants([graph])


def test_parameters_of_the_same_proportion_need_no_tlc(toy: Path) -> None:
    assert graph_at(toy, "toy", "lamp", {"T_ms": 1234}).params == {"T_ms": 1234}
    for params, said in (
        ({"T": 1}, "has no parameter 'T'"),
        ({"T_ms": 0}, "T_ms"),
        ({"T_ms": 501}, "replay.toml: no constant of the model is set by lamp.T_ms"),
    ):
        with pytest.raises(Unjudged, match=said):
            graph_at(toy, "toy", "lamp", params)


@pytest.fixture
def edm(tmp_path: Path) -> Path:
    for name in ("edm", "common"):
        shutil.copytree(root() / "spec" / name, tmp_path / "spec" / name)
    make_graphs(tmp_path, open_runs(tmp_path, "edm", "sf_edm"), quiet=True)
    return tmp_path


@pytest.mark.deep
def test_graphs_at_other_parameters_are_those_of_the_reference(edm: Path) -> None:
    """Tells a graph made from the reference with one millisecond more."""
    code = load_implementation("refimpl", "edm", "sf_edm")
    graphs = [load_device_graph(edm, run) for run in open_runs(edm, "edm", "sf_edm")]
    left: list[str] = []
    more = every_pair(edm, "edm", graphs, left.append)
    rows = [json.dumps(dict(graph.params)) for graph in more]
    assert len(set(rows)) == len(rows) >= 3 and left == []
    for graph in (*more, graph_at(edm, "edm", "sf_edm", {"MonitoringTime_ms": 1401}), scaled(graphs[0], 331)):
        assert compare(graph, code, lambda done, total: None, codes=True).equal
        if graph.params["MonitoringTime_ms"]:
            wrong = replace(
                graph, params={**graph.params, "MonitoringTime_ms": graph.params["MonitoringTime_ms"] + 1}
            )
            assert not compare(wrong, code, lambda done, total: None, codes=True).equal
    with pytest.raises(Unjudged, match="no parameter"):
        graph_at(edm, "edm", "sf_edm", {"T": 1})


def test_a_model_that_counts_in_milliseconds_keeps_its_ticks(tmp_path: Path) -> None:
    """Its limits may be absolute: with a limit of 150 ms, 151 ms in other ticks are no 7 ms."""
    absolute = replace(lamp_graph(tmp_path), tick_ms=1)
    assert variants([absolute]) == [replace(absolute, params={})]
    assert len(variants([lamp_graph(tmp_path)])) > 3


PUBLISHED = sorted((root() / "vectors").glob("*/*.jsonl.gz"))
NEW = [path for path in PUBLISHED if path.name.split(".")[0] in ("parameters", "soak", "times", "sic")]


@pytest.mark.deep
@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=[pytest.mark.long] * (place % 3 > 0 or path.name.startswith("soak")))
        for place, path in enumerate(NEW)
    ],
    ids=[f"{path.parent.name}_{path.name.split('.')[0]}" for path in NEW],
)
def test_the_reference_conforms_to_every_published_walk(path: Path) -> None:
    """Expected values come from the specification's graphs; a wrong scale would indict a right program."""
    assert main(["conform", path.parent.name, "--vectors", str(path), "--builtin", "refimpl", "--quiet"]) == 0

"""Graphs for judging logs: those of the last run where they are current, a small one of the F-PLC."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from msgspec.structs import replace as with_values

from modeproof.graph.device import DeviceGraph, load_device_graph, read_device_graph
from modeproof.ground.places import root
from modeproof.registers.runs import load_runs
from modeproof.tlc.rests import why_stale
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.log_judge import Graphs
from tests.spec.mode_selection.planted import DOCUMENT, Base, Trial

NEEDED = {
    "OPEN_Fplc": Base(
        "OPEN_Fplc", (('VECTORS = "classes"', 'VECTORS = "few"  Vectors <- TinyVectors'),), "FplcTiny"
    ),
    "OPEN_Plc": Base("OPEN_Plc"),
    "OPEN_Hmi": Base("OPEN_Hmi"),
    "OPEN_Eks6": Base("OPEN_Eks6"),
}
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}


@pytest.fixture(scope="session", autouse=True)
def quick_java() -> Iterator[None]:
    """The first compiler of Java only: half the time for a run of a few seconds."""
    with pytest.MonkeyPatch.context() as patch:
        options = os.environ.get("JAVA_TOOL_OPTIONS", "")
        patch.setenv("JAVA_TOOL_OPTIONS", f"{options} -XX:TieredStopAtLevel=1".strip())
        yield


@pytest.fixture(scope="session")
def alphabets(tmp_path_factory: pytest.TempPathFactory, quick_java: None) -> dict[str, Alphabet]:
    """The graph of each device, by its run."""

    def load(id: str) -> DeviceGraph:
        run = RUNS[id]
        if not NEEDED[id].module and not why_stale(root(), run):
            return load_device_graph(root(), run)
        place = tmp_path_factory.mktemp("graph")
        Trial(NEEDED[id]).run(place)
        assert run.graph is not None
        return read_device_graph(
            place, with_values(run, graph=with_values(run.graph, states=None, edges=None))
        )

    return {id: Alphabet(load(id)) for id in NEEDED}


@pytest.fixture(scope="session")
def graphs(alphabets: dict[str, Alphabet]) -> Graphs:
    """The same as a command has them; none is ever made again."""

    def refuse(runs: object) -> None:
        raise AssertionError(f"{runs} was to be made")

    return Graphs(root(), refuse, alphabets)

"""Graphs for judging logs: those of the last run where they are current, else smaller ones of their own."""

from __future__ import annotations

from dataclasses import replace

import pytest

from modeproof.graph.device import DeviceGraph, load_device_graph
from modeproof.places import root
from modeproof.tlc.runs import load_runs
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.judge import Graphs, is_current
from tests.spec.mode_selection.planted import DOCUMENT, Base, Trial

NEEDED = {
    "OPEN_Fplc": (('VECTORS = "classes"', 'VECTORS = "few"'),),  # levels 2 to 4 only: a third of the time
    "OPEN_Plc": (),
    "OPEN_Hmi": (),
    "OPEN_Eks6": (),
}
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}


@pytest.fixture(scope="session")
def graphs(tmp_path_factory: pytest.TempPathFactory) -> Graphs:
    """A graph for each device; none is ever made again."""

    def load(id: str) -> DeviceGraph:
        run = RUNS[id]
        if is_current(root(), run):
            return load_device_graph(root(), run)
        place = tmp_path_factory.mktemp("graph")
        Trial(Base(id, NEEDED[id])).run(place)
        assert run.graph is not None
        return load_device_graph(place, replace(run, graph=replace(run.graph, states=None, edges=None)))

    def refuse(runs: object) -> None:
        raise AssertionError(f"{runs} was to be made")

    return Graphs(root(), refuse, {id: Alphabet(load(id)) for id in NEEDED})

"""The graphs that implementations are compared with show every step of the interface, and no other."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from modeproof.graph.read import read_graph
from modeproof.ground.places import root
from modeproof.registers.load import load_interface
from tests.spec.mode_selection.planted import DOCUMENT, Base, Finding, Trial

DEVICES = load_interface(root(), DOCUMENT).devices
WHOLE = {
    "plc": (Trial(Base("OPEN_Plc")),),
    "hmi": (Trial(Base("OPEN_Hmi")),),
    "eks": (Trial(Base("OPEN_Eks6")), Trial(Base("OPEN_Eks7"))),
}
# The timers of OPEN_Fplc and a part of its inputs: what occurs here occurs there.
SMALL = ("PRINT_GRAPH = TRUE", "PRINT_GRAPH = TRUE  InputsToTry <- SmallInputs")
PART = [
    Trial(Base("OPEN_Fplc", (SMALL, ('SELECTIONS = "again"', selections)), module="FplcSmall"))
    for selections in ('SELECTIONS = "again"', 'SELECTIONS = "once"')
]
Run = Callable[[Trial], Finding]


@pytest.mark.parametrize("trial", [trial for trials in WHOLE.values() for trial in trials], ids=str)
def test_the_graph_is_whole(trial: Trial, trials: Run) -> None:
    found = trials(trial)
    assert found.outcome.graph_file is not None
    graph, counts = read_graph(found.outcome.graph_file), found.outcome.log.counts
    assert counts is not None
    assert (len(graph.views), graph.edges) == (counts.distinct, counts.generated - 1)


@pytest.mark.parametrize("device", WHOLE)
def test_the_graphs_of_a_device_show_its_steps(device: str, trials: Run) -> None:
    steps: set[str] = set()
    for trial in WHOLE[device]:
        file = trials(trial).outcome.graph_file
        assert file is not None
        steps |= set(read_graph(file).steps)
    assert steps == set(DEVICES[device].steps)


def test_the_graphs_of_the_fplc_show_its_steps(trials: Run) -> None:
    steps: set[str] = set()
    for trial in PART:
        file = trials(trial).outcome.graph_file
        assert file is not None
        steps |= set(re.findall(r'^<<"EDGE", <<.*>>, "(\w+)", \d+, <<', file.read_text(), re.M))
    assert steps == set(DEVICES["fplc"].steps)


def test_every_published_device_is_looked_at() -> None:
    assert {*WHOLE, "fplc"} == set(DEVICES)

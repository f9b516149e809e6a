"""Logs of the function blocks: a random walk is accepted, a wrong output is found in its scan."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from modeproof.graph.device import DeviceGraph, load_device_graph, read_device_graph
from modeproof.ground.places import root
from modeproof.registers.runs import load_runs
from modeproof.tlc.process import run_tlc
from modeproof.tlc.rests import why_stale
from modeproof.tlc.toolchain import find_toolchain
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.follow import Followed
from modeproof.trace.log_judge import Graphs, Judgement
from tests.trace.judging import judge, log_of
from tests.trace.test_devices import SCANS, corrupted, walk

BLOCKS = {
    "sf_edm": ("edm", "OPEN_SF_EDM"),
    "sf_enable_switch": ("enable_switch", "OPEN_SF_EnableSwitch"),
    "sf_guard_locking": ("guard_locking", "OPEN_SF_GuardLocking"),
    "sf_testable_safety_sensor": ("testable_safety_sensor", "OPEN_SF_TestableSafetySensor"),
}
CUT = 20


@dataclass(frozen=True)
class Judged:
    """A walk of a block, the same with one wrong output in scan `at`, and the rest of both from CUT on."""

    good: Judgement
    bad: Judgement
    at: int
    rest: Judgement
    wrong_rest: Judgement


def graph_of(document: str, id: str, place: Path) -> DeviceGraph:
    """The graph as the last run left it where it is current, else made below `place`."""
    run = next(one for one in load_runs(root(), document) if one.id == id)
    if not why_stale(root(), run):
        return load_device_graph(root(), run)
    for name in (document, "common"):
        shutil.copytree(root() / "spec" / name, place / "spec" / name)
    assert run_tlc(place, run, find_toolchain()).log.success
    return read_device_graph(place, run)


@pytest.fixture(scope="module", params=BLOCKS)
def judged(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Judged:
    block: str = request.param
    document, id = BLOCKS[block]
    folder = tmp_path_factory.mktemp(block)
    graph = graph_of(document, id, folder)

    def refuse(runs: object) -> None:
        raise AssertionError(f"{runs} was to be made")

    graphs = Graphs(root(), refuse, {id: Alphabet(graph)})
    lines = walk(graph, 5)
    wrong, at = corrupted(graph, lines, 5)
    assert at >= CUT
    good, bad = judge(block, [log_of(folder, block, one, graph.params) for one in (lines, wrong)], graphs)
    rest, wrong_rest = judge(
        block,
        [log_of(folder, block, one[CUT:], graph.params) for one in (lines, wrong)],
        graphs,
        anywhere=True,
    )
    return Judged(good, bad, at, rest, wrong_rest)


def test_a_walk_is_accepted_by_graph_and_tlc(judged: Judged) -> None:
    assert (judged.good.verdict, judged.good.accepted) == ("CONFORMS", SCANS)
    assert isinstance(judged.good.followed, Followed) and judged.good.followed.accepted == SCANS


def test_a_wrong_output_is_found_in_its_scan(judged: Judged) -> None:
    assert (judged.bad.verdict, judged.bad.accepted) == ("DIFFERS", judged.at)
    assert isinstance(judged.bad.followed, Followed) and judged.bad.followed.accepted == judged.at


def test_wrong_outputs_are_found_though_a_log_starts_midway(judged: Judged) -> None:
    assert (judged.rest.verdict, judged.rest.accepted) == ("CONFORMS", SCANS - CUT)
    assert (judged.wrong_rest.verdict, judged.wrong_rest.accepted) == ("DIFFERS", judged.at - CUT)

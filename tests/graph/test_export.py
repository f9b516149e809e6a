"""The export says what the graph says: every transition, every output, and nothing of the day it was made."""

from __future__ import annotations

import gzip
import json
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from modeproof.graph.device import DeviceGraph
from modeproof.graph.export import as_export, export_file, view_names, write_export
from modeproof.ground.errors import Unjudged
from modeproof.registers.runs import Graph, Run
from tests.graph.printed import LETTERS, TICK_MS, lamp_graph, signal, successor
from tests.toy_tree import TOY_TLA, toy_tree

NAMES = ("state", "nothing", "elapsed")


def lamp(folder: Path) -> DeviceGraph:
    """The lamp, with a declared memory."""
    graph = lamp_graph(folder)
    memory = {"state": signal("state", "text"), "elapsed": signal("elapsed", "ms", minimum=0)}
    return replace(graph, device=structs.replace(graph.device, memory=memory))


def run_of() -> Run:
    """The run of the toy that prints a graph."""
    return Run(
        document="toy",
        id="OPEN_toy",
        module="Toy",
        cfg="models/OPEN_toy.cfg",
        kind="OPEN",
        lanes=("full",),
        environment="honest",
        graph=Graph(device="toy", tick_ms=TICK_MS),
    )


def test_every_transition_of_the_graph_is_in_the_export(tmp_path: Path) -> None:
    device = lamp(tmp_path)
    found = as_export(device, NAMES, TICK_MS)
    names, values = found["inputs"]["names"], found["inputs"]["values"]
    count = len(found["states"])
    seen = 0
    for at, (state, _, elapsed) in enumerate(found["states"]):
        for n, letter in enumerate(found["inputs"]["letters"]):
            given = {
                name: values[k][place] for k, (name, place) in enumerate(zip(names, letter, strict=True))
            }
            word = int(given["word"], 16)
            step, after = successor(
                (state, elapsed // TICK_MS), (given["press"], word, given["dt_ms"] // TICK_MS)
            )
            move = found["moves"][at][found["columns"][n]]
            assert found["steps"][move // count] == step
            assert found["states"][move % count] == [after[0], [], after[1] * TICK_MS]
            seen += 1
    assert seen == device.graph.edges == count * len(LETTERS)


def test_a_state_has_its_row_of_outputs(tmp_path: Path) -> None:
    found = as_export(lamp(tmp_path), NAMES, TICK_MS)["outputs"]
    assert found["names"] == ["LAMP", "MW"]
    assert [found["rows"][n] for n in found["row_of"]] == [[False, "0000"], [True, "0FF0"], [True, "0FF0"]]


def test_inputs_that_no_state_tells_apart_share_a_column(tmp_path: Path) -> None:
    found = as_export(lamp(tmp_path), NAMES, TICK_MS)
    rows = list(zip(*found["moves"], strict=True))
    assert sorted(set(found["columns"])) == list(range(len(rows)))
    assert len(set(rows)) == len(rows) < len(LETTERS)


def test_times_are_in_ms_and_the_first_memory_names_states(tmp_path: Path) -> None:
    found = as_export(lamp(tmp_path), ("lampState", "nothing", "elapsed"), TICK_MS)
    assert found["control"] == 0 and found["states"][found["initial"]] == ["Off", [], 0]
    assert ["On", [], TICK_MS] in found["states"]
    assert [one["type"] for one in found["memory"]] == ["text", "", "ms"]


def test_memory_that_the_specification_does_not_name_is_numbered(tmp_path: Path) -> None:
    found = as_export(lamp(tmp_path), (), TICK_MS)
    assert [one["name"] for one in found["memory"]] == ["part 1", "part 2", "part 3"]
    assert ["On", [], 1] in found["states"]


def test_the_same_graph_gives_the_same_bytes(tmp_path: Path) -> None:
    run = run_of()
    first = write_export(tmp_path, run, lamp(tmp_path)).read_bytes()
    again = write_export(tmp_path, run, lamp(tmp_path))
    assert again == export_file(tmp_path, "toy", "OPEN_toy") and again.read_bytes() == first
    assert first[4:8] == bytes(4), "no time in the header of gzip"
    assert json.loads(gzip.decompress(first))["device"] == "lamp"


def test_views_of_different_lengths_are_refused(tmp_path: Path) -> None:
    device = lamp(tmp_path)
    shorter = replace(device.graph, views=(*device.graph.views[:-1], '<<"On", 1>>'))
    with pytest.raises(Unjudged, match="views of different lengths"):
        as_export(replace(device, graph=shorter), NAMES, TICK_MS)


def test_the_names_of_a_view_come_from_the_specification(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "OPEN_toy")
    assert view_names(root, run_of()) == ("count", "top")
    module = root / "spec/toy/Toy.tla"
    module.write_text(TOY_TLA.replace("View == <<count, top>>", "both == <<count, top>>\nView == both"))
    assert view_names(root, run_of()) == ("count", "top")
    module.write_text(TOY_TLA.replace("View == <<count, top>>", "View == <<count, top /\\ TRUE>>"))
    assert view_names(root, run_of()) == ()
    module.unlink()
    assert view_names(root, run_of()) == ()

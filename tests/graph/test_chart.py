"""A state chart says of a graph which steps lead from which control state to which."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from msgspec import structs

from modeproof.graph.chart import Chart, Move, chart
from tests.graph.printed import lamp_graph, lines


def drawn(folder: Path, printed: list[str] | None = None) -> Chart:
    found = chart(lamp_graph(folder, printed))
    assert found is not None
    return found


def test_a_control_state_merges_its_states_and_counts_every_transition(tmp_path: Path) -> None:
    # off: 18 inputs, of which the button with the code, at each of three times, switches on
    found = drawn(tmp_path)
    assert found.initial == "Off" and found.states == {"Off": 1, "On": 2}
    assert found.moves == (
        Move("Off", "StayOff", "Off", 15),
        Move("Off", "SwitchOn", "On", 3),
        Move("On", "Expire", "Off", 6 + 12),
        Move("On", "StayOn", "On", 12 + 6),
    )
    assert found.outputs == {"Off": {"LAMP": False, "MW": "0000"}, "On": {"LAMP": True, "MW": "0FF0"}}
    assert sum(one.transitions for one in found.moves) == lamp_graph(tmp_path).graph.edges


def test_a_transition_that_goes_elsewhere_changes_the_chart(tmp_path: Path) -> None:
    printed = lines()
    at = next(n for n, line in enumerate(printed) if '"SwitchOn"' in line)
    printed[at] = printed[at].replace('<<"On", {}, 0>>>>', '<<"Off", {}, 0>>>>')
    assert Move("Off", "SwitchOn", "Off", 1) in drawn(tmp_path, printed).moves


def test_a_control_state_claims_no_output_that_differs_within_it(tmp_path: Path) -> None:
    printed = [
        line.replace("LAMP |-> TRUE", "LAMP |-> FALSE") if '"STATE", <<"On", {}, 1>>' in line else line
        for line in lines()
    ]
    assert drawn(tmp_path, printed).outputs["On"] == {"MW": "0FF0"}


def test_a_declared_state_that_is_never_entered_counts_none(tmp_path: Path) -> None:
    device = lamp_graph(tmp_path)
    more = replace(device, device=structs.replace(device.device, states=("Off", "On", "Broken")))
    found = chart(more)
    assert found is not None and found.states["Broken"] == 0


def test_without_a_control_state_there_is_no_chart(tmp_path: Path) -> None:
    device = lamp_graph(tmp_path)
    assert chart(replace(device, device=structs.replace(device.device, states=("Dark", "Bright")))) is None
    assert chart(replace(device, device=structs.replace(device.device, states=("Off",)))) is None

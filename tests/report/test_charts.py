"""State charts in the report are those of the evidence: every transition stands in picture and table."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from modeproof.report.build import make
from modeproof.report.drawing.state_chart import Box, Entry, Step, entries, state_chart
from modeproof.report.part import plain
from modeproof.report.parts.charts import part
from modeproof.report.sources import HOLE, gather
from tests.report.box_graph import add_graph, compared
from tests.report.paper import make_paper, without

CHART: dict[str, Any] = {
    "initial": "Open",
    "states": {"Open": 1, "Shut": 1},
    "outputs": {"Open": {"WORD": "0000", "LAMP": False}, "Shut": {"WORD": "0F10", "LAMP": True}},
    "moves": [
        {"source": "Open", "step": "Wait", "target": "Open", "transitions": 2},
        {"source": "Open", "step": "Close", "target": "Shut", "transitions": 2},
        {"source": "Shut", "step": "Stay", "target": "Shut", "transitions": 4},
    ],
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with the evidence of its graph."""
    make_paper(tmp_path)
    add_graph(tmp_path)
    compared(tmp_path, chart=CHART)
    return tmp_path


def device(root: Path) -> dict[str, Any]:
    """The data of the only device."""
    found: dict[str, Any] = part(gather(root)).data["documents"][0]["devices"][0]
    return found


def test_the_table_has_every_transition_with_its_actions_citations(root: Path) -> None:
    chart = device(root)["chart"]
    rows = [(row["from"], row["step"], row["to"], row["transitions"].value) for row in chart["moves"]]
    assert rows == [("Open", "Wait", "Open", 2), ("Open", "Close", "Shut", 2), ("Shut", "Stay", "Shut", 4)]
    close = chart["moves"][1]
    assert (close["clauses"], close["findings"]) == (("BX-1-1",), ("E-01",))
    assert close["transitions"].source == "build/evidence/box/refimpl_OPEN_Box.json"
    assert chart["states"][1]["outputs"] == {"WORD": "0F10", "LAMP": "1"}
    assert part(gather(root)).troubles == ()


def test_the_picture_has_state_boxes_and_lines_with_step_ids(root: Path) -> None:
    svg = device(root)["chart"]["picture"].svg
    assert svg.count('class="state"') == 2 and 'data-state="Open" tabindex="0" role="button"' in svg
    assert svg.count('class="move"') == 1 and 'data-from="Open" data-to="Shut"' in svg
    assert ">Close</text>" in svg and ">BX-1-1 E-01</text>" in svg
    assert ">↻ Wait</text>" in svg and ">● Open</text>" in svg and ">LAMP</text>" in svg


def test_the_json_has_rows_and_words_but_no_drawing(root: Path) -> None:
    data = plain(part(gather(root)).data)["documents"][0]["devices"][0]
    assert data["chart"]["picture"] == {"picture": "State chart of box, a box: it shuts"}
    assert data["chart"]["moves"][1]["transitions"]["value"] == 2


def test_without_evidence_the_page_says_so_in_its_place(root: Path) -> None:
    without(root, "refimpl_OPEN_Box")
    found = part(gather(root))
    assert found.data["documents"][0]["devices"][0]["chart"] is None
    (trouble,) = found.troubles
    assert trouble.status == HOLE and "no state chart of box in the evidence of OPEN_Box" in trouble.what
    assert "There is no chart of this device in the evidence." in make(root).html


@pytest.mark.parametrize("chart", [{}, {**CHART, "moves": []}, {**CHART, "moves": [{"source": "Open"}]}, 5])
def test_a_chart_that_is_cut_is_a_hole(root: Path, chart: Any) -> None:
    compared(root, chart=chart)
    assert [one.status for one in part(gather(root)).troubles] == [HOLE]


def test_states_that_show_no_control_state_have_nothing_to_draw(root: Path) -> None:
    compared(root, chart=None)
    found = part(gather(root))
    assert found.troubles == () and found.data["documents"][0]["devices"][0]["chart"] is None


def test_a_state_of_error_has_cut_corners_and_says_so() -> None:
    boxes = [Box("Well", initial=True), Box("Broken", error=True)]
    svg = state_chart(boxes, [Step("Well", "Break", "Broken")], {}, id="x", title="x")
    assert re.search(
        r'class="state error"[^>]*aria-label="control state Broken, an error"><path d="M[^"]*z"', svg
    )
    assert re.search(r'class="state"[^>]*aria-label="control state Well, after power-up"><rect', svg)


def test_a_step_from_many_states_is_listed_others_are_drawn() -> None:
    steps = [Step(one, "Stop", "Off") for one in ("A", "B", "C")] + [
        Step("A", "Go", "B"),
        Step("B", "Go", "C"),
    ]
    assert entries(steps) == (Entry("Off", ("Stop",), ("A", "B", "C")),)
    svg = state_chart([Box(one) for one in ("Off", "A", "B", "C")], steps, {}, id="x", title="x")
    assert svg.count('class="move"') == 2
    assert 'class="entry" data-to="Off" data-from="A B C"' in svg and ">from every other state</text>" in svg
    assert entries(steps[1:]) == ()


def test_a_state_never_entered_is_listed_but_not_drawn(root: Path) -> None:
    compared(root, chart={**CHART, "states": {**CHART["states"], "Broken": 0}})
    chart = device(root)["chart"]
    assert [row["id"] for row in chart["states"]] == ["Open", "Shut", "Broken"]
    assert "Broken" not in chart["picture"].svg


def test_hostile_text_of_the_evidence_is_escaped(root: Path) -> None:
    evil = '<script>alert("x")</script>'
    states = {"Open": 1, evil: 1}
    moves = [{"source": "Open", "step": evil, "target": evil, "transitions": 1}]
    compared(
        root, chart={"initial": "Open", "states": states, "outputs": {evil: {evil: True}}, "moves": moves}
    )
    assert evil in str(device(root)["chart"]["moves"])
    assert "<script>alert(" not in make(root).html


def test_a_chart_begins_at_power_up_whatever_comes_first() -> None:
    boxes = [Box("Middle"), Box("End"), Box("Start", initial=True)]
    steps = [Step("Start", "Go", "Middle"), Step("Middle", "Back", "Start"), Step("Middle", "Leave", "End")]
    svg = state_chart(boxes, steps, {}, id="x", title="x")
    tops = dict(re.findall(r'data-state="(\w+)"[^>]*><rect x="[\d.]+" y="([\d.]+)"', svg))
    assert float(tops["Start"]) < float(tops["Middle"]) < float(tops["End"])

"""A play in an address: its actions, counted, and the same cell again when they are played."""

from __future__ import annotations

from typing import Any
from urllib.parse import quote, unquote

import pytest

from modeproof.simulate.program.block import Block
from modeproof.simulate.program.links import LONGEST, MOST_ROUNDS, NoPlay, added, read, written
from scenes.mode_selection.scene import Scene
from tests.simulate.conftest import SCENE
from tests.simulate.test_program import CHANGE


def done(*actions: str) -> list[str]:
    found: list[str] = []
    for action in actions:
        found = added(found, action)
    return found


@pytest.mark.parametrize(
    ("actions", "kept"),
    [
        (("round 1", "round 1", "insert 2", "round 3"), ["round 2", "insert 2", "round 3"]),
        (("scan fplc", "scan fplc", "scan eks fplc 2"), ["scan fplc 2", "scan eks fplc 2"]),
        (("call 20", "call 20 50", "call 5"), ["call 20 51", "call 5 1"]),
        (("round 4", "insert 1", "reset", "round 1"), ["reset", "round 1"]),
        (("param A 1", "call 20", "param B 2", "flip C"), ["param A 1", "param B 2", "flip C"]),
        (("flip C", "flip C"), ["flip C", "flip C"]),
    ],
)
def test_what_is_done_again_is_counted(actions: tuple[str, ...], kept: list[str]) -> None:
    assert done(*actions) == kept


def test_a_link_plays_to_the_same_state(known: dict[str, Any]) -> None:
    first, again = Scene(known[SCENE], {}), Scene(known[SCENE], {})
    actions = [one for text in CHANGE for one in (["round 1"] * 7 if text.startswith("round") else [text])]
    for text in actions:
        first.do(text)
    carried = unquote(written(SCENE, "letter", done(*actions), quote))
    for text in read(carried.partition("&do=")[2]):
        again.do(text)
    assert again.log() == first.log() and len(first.lines) > 100
    again.do("round 1")
    assert again.log() != first.log()


def test_a_block_and_its_parameters_fit_into_a_link(known: dict[str, Any]) -> None:
    first, again = Block("sf_edm", known["edm"], {}), Block("sf_edm", known["edm"], {})
    actions = ("flip Reset", "param MonitoringTime_ms 40", "flip Activate", "call 20", "call 20")
    for text in actions:
        first.do(text)
    for text in read("; ".join(done(*actions))):
        again.do(text)
    assert again.log() == first.log() and '"MonitoringTime_ms": 40' in str(again.params).replace("'", '"')


def test_what_is_too_long_is_no_link() -> None:
    assert written(SCENE, "letter", [f"round {MOST_ROUNDS}"], quote)
    for actions, said in (
        ([], "nothing has been played"),
        ([f"round {MOST_ROUNDS + 1}"], "too long"),
        (["insert 1"] * LONGEST, "too long"),
        (["round 9999999999"], "too long"),
    ):
        with pytest.raises(NoPlay, match=said):
            written(SCENE, "letter", actions, quote)
        with pytest.raises(NoPlay):
            read("; ".join(actions))


@pytest.mark.parametrize(
    "text", ["insert 7", "insert -1", "touch robot", "mode 9", "scan fplc 1 1", "fault x"]
)
def test_an_action_out_of_range_is_refused(text: str, known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    with pytest.raises(ValueError, match="is no action of this cell"):
        scene.do(text)

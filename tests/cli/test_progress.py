"""What a long command says while it works: how far it is, and how long the rest takes."""

from __future__ import annotations

import io

import pytest

from modeproof.ground import progress as room
from modeproof.ground.progress import Progress
from modeproof.kit.text import left


@pytest.mark.parametrize(
    ("seconds", "share", "words"),
    [
        (30.0, 0.5, ", about 30 s left"),
        (60.0, 0.1, ", about 9 min left"),
        (1.0, 0.5, ""),
        (60.0, 0.01, ""),
        (60.0, 1.0, ""),
        (60.0, 1.2, ""),
    ],
)
def test_the_rest_is_told_once_it_can_be_known(seconds: float, share: float, words: str) -> None:
    assert left(seconds, share) == words


def test_the_time_of_starting_up_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr(room.time, "monotonic", lambda: clock[-1])
    said = io.StringIO()
    progress = Progress(said)
    progress.expect(1)
    progress.begin("graph")
    for moment, share in ((100.0, 0.1), (110.0, 0.2), (130.0, 1.0)):
        clock.append(moment)
        progress.update("graph", f"{share:.0%}", share)
    assert said.getvalue().splitlines() == [
        "[0/1] graph 100 s, 10%",
        "[0/1] graph 110 s, 20%, about 80 s left",
        "[0/1] graph 130 s, 100%",
    ]


def test_items_are_counted_and_a_task_that_fails_is_over(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr(room.time, "monotonic", lambda: clock[-1])
    said = io.StringIO()
    progress = Progress(said)
    with pytest.raises(ZeroDivisionError):
        for item in progress.over("registers", [20.0, 40.0, 60.0]):
            clock.append(item)
            assert item < 60 or 1 / 0
    assert said.getvalue().splitlines() == [
        "[0/1] registers 20 s, 1 of 3",
        "[0/1] registers 40 s, 2 of 3, about 20 s left",
    ]
    progress.tick()
    assert len(said.getvalue().splitlines()) == 2

"""A program with another reading of one finding than the reference is told which one it has."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.places import root
from programs.equality import readings
from programs.equality.comparison import make
from programs.equality.readings import reading_of
from programs.equality.replay import Run, published_runs, replay

ST = root() / "examples/st"
GUARD = "sf_guard_locking"


def said(program: Path, target: str, fixed: dict[str, Any]) -> str:
    """What is said of the program beside the reference with these parameters, by the first case of the letter
    in which they differ.
    """
    vectors = root() / "vectors" / target
    letter = make([program], target, codes=False).binding
    product = make([program], target, binding={"fixed": fixed}, codes=False)
    for _, run in published_runs(letter, vectors):
        other = Run({**run.parameters, **fixed}, run.scans)
        if found := replay(product.binding, product.wrap, other, "a case of the letter"):
            return reading_of(product, found, vectors)
    raise AssertionError("no difference")


@pytest.mark.parametrize(
    ("target", "parameter", "other", "own", "finding"),
    [
        pytest.param("sf_edm", "AFTER_RESET", "stop_first", "at_once", "EDMF-04", marks=pytest.mark.deep),
        pytest.param(GUARD, "UNLOCK_ON", "edge", "latched", "GLF-02", marks=pytest.mark.deep),
        pytest.param(GUARD, "UNLOCK_ENDS", "when_closed", "with_request", "GLF-03", marks=pytest.mark.deep),
        (GUARD, "ZONE_LOST", "tolerated", "error", "GLF-04"),
        pytest.param(
            GUARD, "START_UP_INHIBIT", "until_opened", "until_reset", "GLF-08", marks=pytest.mark.deep
        ),
        pytest.param(GUARD, "CAUSE_OF_LOSS", "zone", "what_was_lost", "GLF-14", marks=pytest.mark.deep),
        pytest.param(GUARD, "MESSAGE_OF_LOSS", "until_safe", "until_reset", "GLF-06", marks=pytest.mark.deep),
    ],
)
def test_the_reading_of_the_program_is_recognized(
    target: str, parameter: str, other: str, own: str, finding: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(readings, "LOOKING_S", 1.0)
    words = said(ST / f"{target}.st", target, {parameter: other})
    assert words.startswith(f"the program has the reading {parameter} = {own} ({finding}): so the reference ")


def test_a_fault_is_no_reading(tmp_path: Path) -> None:
    wrong = tmp_path / "sf_edm.st"
    text = (ST / "sf_edm.st").read_text("utf-8")
    wrong.write_text(text.replace("IF S_EDM1 AND S_EDM2 THEN", "IF S_EDM1 THEN"), "utf-8")
    words = said(wrong, "sf_edm", {})
    assert words == "none that the reference can have: no other value of AFTER_RESET (EDMF-04) explains it"

"""What must be true of the machine is pinned: a text that is weakened is noticed, other words are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.registers.machine_pins import check_machine_pins, repin_machines

SAFETY = """[observer]
pressed = { of = "R_TRIG", inputs.CLK = "Start" }
late = { of = "SR", inputs.S1 = "pressed.Q", inputs.R = "Stop" }
other = { of = "R_TRIG", inputs.CLK = "Stop" }
[[property]]
id = "closed"
sentence = "The drive moves only with the door closed."
hazard = "A hand is caught."
cites = ["A-02"]
holds = "S_Drive AND late.Q1"
only_if = "Door"
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """The file of properties of a machine, pinned."""
    folder = tmp_path / "spec/latch"
    folder.mkdir(parents=True)
    (folder / "wiring.toml").write_text("")
    (folder / "safety.toml").write_text(SAFETY)
    assert [line.partition(": none -> ")[0] for line in repin_machines(tmp_path, "first")] == [
        "latch: checked.closed"
    ]
    assert check_machine_pins(tmp_path) == []
    return folder / "safety.toml"


def said(file: Path) -> list[str]:
    return [str(problem) for problem in check_machine_pins(file.parents[2])]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('only_if = "Door"', 'only_if = "Door OR TRUE"'),
        ('holds = "S_Drive AND', 'holds = "FALSE AND'),
        ('inputs.S1 = "pressed.Q"', 'inputs.S1 = "FALSE"'),
        ('inputs.CLK = "Start"', 'inputs.CLK = "FALSE"'),
    ],
)
def test_a_weakened_property_is_named_until_it_is_pinned(file: Path, old: str, new: str) -> None:
    file.write_text(SAFETY.replace(old, new))
    (problem,) = said(file)
    assert problem.startswith("spec/latch/pins.toml: checked.closed: it, or an observer")
    (line,) = repin_machines(file.parents[2], "it was meant")
    assert line.startswith("latch: checked.closed: ")
    assert "it was meant" in (file.parent / "pins.toml").read_text()
    assert said(file) == []


@pytest.mark.parametrize(("old", "new"), [("The drive moves", "It moves"), ('CLK = "Stop"', 'CLK = "Door"')])
def test_other_words_and_other_observers_move_no_pin(file: Path, old: str, new: str) -> None:
    file.write_text(SAFETY.replace(old, new))
    assert said(file) == []
    assert repin_machines(file.parents[2], "nothing") == ["latch: no pin moved"]


def test_missing_pins_and_pins_of_nothing_are_named(file: Path) -> None:
    file.write_text(SAFETY.replace('id = "closed"', 'id = "shut"'))
    first, second = said(file)
    assert "checked.shut: is not pinned" in first
    assert "checked.closed: nothing of this name is left" in second

"""Runs of the machine cell: they tell every story, and lead back to every mode."""

from __future__ import annotations

import itertools
import random
from functools import cache
from pathlib import Path

import pytest

from machines.concrete_runs import Runner
from machines.verdicts import Machine
from refimpl.machine_cell import cell as reference

FOLDER = Path(__file__).parents[2] / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
MODES = ("manual", "automatic", "setup", "intervention", "service")


def plain(text: str = TEXT) -> Machine:
    machine = Machine(text, "my.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=100)
    machine.triggers = [[] for _ in machine.questions.rows]
    return machine


def test_the_tours_tell_every_story() -> None:
    runner = plain().runner
    rows = [told for _, told in runner.tours]
    for name, story in runner.stories().items():
        wanted = len(story)
        assert any(
            told[at : at + wanted] == story for told in rows for at in range(len(told) - wanted + 1)
        ), name


def driven(runner: Runner, state: reference.State, mode: str) -> bool:
    """Whether the mode is chosen and the drive enabled in it, from a state without a lasting fault."""
    stories = runner.stories()
    begin = next(story["then"][0] for story in runner.use.story if story["id"] == f"choose {mode}")
    rest = {
        name: runner.use.rest.get(name, kind == "WORD" and 0) for name, kind in runner.cell.inputs.items()
    }
    inputs, values, reached = rest, reference.values_after(runner.cell, state, rest), False
    for row in [*[rest] * 30, *stories[f"choose {mode}"], *stories[begin], *stories[begin]]:
        inputs = inputs | {name: source(values) for name, source in runner.follows.items()} | row
        state, _ = reference.step(runner.cell, state, inputs, 10)
        values = reference.values_after(runner.cell, state, inputs)
        reached = reached or bool(values[mode] and values["S_DriveEnable"])
    return reached


@cache
def states_seen() -> tuple[reference.State, ...]:
    """One state of the cell for each set of control states of its blocks that runs take."""
    runner, found = plain().runner, dict[object, reference.State]()
    for seed in (*range(0, len(runner.tours), 3), *range(len(runner.tours), len(runner.tours) + 12)):
        for _, state, values in runner.runs(seed):
            blocks = tuple(getattr(kept, "state", None) for kept in state.memory.values())
            found.setdefault((blocks, *(values[name] for name in MODES)), state)
    return tuple(found.values())


@pytest.mark.sampled
@pytest.mark.parametrize("mode", MODES)
def test_from_states_seen_the_user_gets_back_to_each_mode(mode: str) -> None:
    runner = plain().runner
    assert len(states_seen()) > 150
    for state in random.Random(7).sample(states_seen(), 40):
        assert driven(runner, state, mode), state


def test_a_machine_that_cannot_get_back_is_seen() -> None:
    runner = plain(TEXT.replace('Reset = "ResetBeam"', 'Reset = "FALSE"')).runner
    state = next(iter(itertools.islice(runner.runs(0), 1)))[1]
    assert not driven(runner, state, "automatic")


def test_a_door_that_resets_itself_meets_a_person_inside() -> None:
    guard = TEXT.replace(
        'S_AutoReset = "FALSE"\nReset = "ResetGuard"', 'S_AutoReset = "TRUE"\nReset = "ResetGuard"'
    )
    machine = plain(guard)
    assert "person-inside" in machine.look(lambda seen: "person-inside" in seen.broken).broken

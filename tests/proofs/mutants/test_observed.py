"""The observer: memory that nothing reads again may differ, anything that can be told must not."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from proofs.mode_selection.devices import HMI
from proofs.mode_selection.subjects import SUBJECTS
from proofs.mutants.copies import Change
from proofs.mutants.observed import Bench, Sight, explored, observe, sight_of
from refimpl.mode_selection import hmi

FILE = Path(hmi.__file__)
TEXT = FILE.read_text(encoding="utf-8")
SEEN = {
    "Inhibited": set(),
    "Select": {"offered"},
    "AwaitEcho": {"offered", "selection"},
    "Confirm": {"offered", "selection"},
    "AwaitSwitch": {"offered", "selection"},
    "Withdrawn": {"offered"},
}


@pytest.fixture(scope="module")
def bench() -> Bench:
    (subject,) = [one for one in SUBJECTS if one.device is HMI]
    return Bench("refimpl.mode_selection", {HMI.name: explored(subject)})


def change(definition: str, old: str, new: str) -> Change:
    (function,) = [
        one for one in ast.parse(TEXT).body if isinstance(one, ast.FunctionDef) and one.name == definition
    ]
    lines = TEXT.splitlines()
    first, last = function.lineno, function.end_lineno or 0
    own = "\n".join(lines[first - 1 : last])
    assert own.count(old) == 1
    return Change(hmi.__name__, definition, TEXT.replace(own, own.replace(old, new)), (first, last))


def test_what_is_seen_is_read_off_the_paths(bench: Bench) -> None:
    sight, _ = bench.devices[HMI.name]
    assert {control: set(names) - {"params"} for control, names in sight.seen.items()} == SEEN


@pytest.mark.parametrize(
    ("definition", "old", "new", "verdict"),
    [
        ("_inhibit", "NONE, NONE", "NONE, s.selection", "EQUIVALENT"),
        ("_inhibit", "NONE, NONE", "s.offered, NONE", "EQUIVALENT"),
        ("_withdraw", "s.offered, NONE", "s.offered, 3", "EQUIVALENT"),
        ("power_up", "NONE, NONE", "4, 4", "EQUIVALENT"),
        ("_withdraw", "s.offered, NONE", "3, NONE", "DIFFERS"),
        ("_inhibited", "level, NONE", "s.offered, NONE", "DIFFERS"),
        ("_await_echo", "s.offered, s.selection", "s.offered, NONE", "DIFFERS"),
        ("_await_switch", "return s  #", "return _inhibit(s)  #", "DIFFERS"),
        ("power_up", "Step.INHIBITED", "Step.SELECT", "DIFFERS"),
        ("outputs", '"confirm", NO_MODES, s.selection', '"confirm", NO_MODES, s.offered', "DIFFERS"),
        ("_withdrawn", "if i.CheckMSO == ZERO:", "if i.CheckMSO < ZERO:", "DIFFERS"),
        ("_confirm", "return s  #", "raise ValueError  #", "DIFFERS"),
    ],
)
def test_each_copy_meets_its_fate(bench: Bench, definition: str, old: str, new: str, verdict: str) -> None:
    found = observe(bench, change(definition, old, new), str(FILE))
    assert found.verdict == verdict, found
    assert bool(found.witness) == (verdict == "DIFFERS")


def test_memory_that_leaves_its_range_is_not_passed_over(bench: Bench) -> None:
    assert observe(bench, change("_inhibit", "NONE, NONE", "NONE, 9"), str(FILE)).verdict == "DIFFERS"


def test_memory_of_another_type_is_not_passed_over(bench: Bench) -> None:
    assert observe(bench, change("_inhibit", "NONE, NONE", "NONE, True"), str(FILE)).verdict != "EQUIVALENT"


def test_what_does_not_compile_is_unmeasured(bench: Bench) -> None:
    found = observe(bench, change("_inhibit", "return", "retur n"), str(FILE))
    assert found.verdict == "UNMEASURED" and found.reason


def test_a_sight_that_sees_nothing_would_pass_a_wrong_copy(bench: Bench) -> None:
    """So the verdicts above rest on what is seen, and not on something else."""
    sight, ways = bench.devices[HMI.name]
    blind = Sight(sight.device, {control: frozenset({"params"}) for control in sight.seen})
    wrong = change("_withdraw", "s.offered, NONE", "3, NONE")
    assert (
        observe(replace(bench, devices={HMI.name: (blind, ways)}), wrong, str(FILE)).verdict == "EQUIVALENT"
    )


# ---------------------------------------------------------------- against the interpreter


def random_inputs(dice: random.Random) -> Iterator[Any]:
    words = [0, 1, 0xFFFF, *hmi.RE, *hmi.CH]
    touches = ["", "confirm", "reject", *(f"select:{mode}" for mode in range(5))]
    while True:
        yield hmi.Inputs(
            10, dice.choice(words), dice.choice(words), dice.choice([-1, 0, 4]), dice.choice(touches)
        )


def told_apart(sight: Sight, seed: int) -> bool:
    """Whether memory that differs only in what is not seen gives other outputs within some scans."""
    dice = random.Random(seed)
    start = {
        one.name: dice.randint(-1, 4) for one in fields(hmi.State) if one.name not in ("params", "state")
    }
    control = dice.choice(list(hmi.Step))
    one = hmi.State(hmi.Params(), control, **start)
    other = replace(one, **{name: dice.randint(-1, 4) for name in sight.hidden(control.value)})
    for inputs, _ in zip(random_inputs(dice), range(12), strict=False):
        (one, first), (other, second) = hmi.step(one, inputs), hmi.step(other, inputs)
        if first != second:
            return True
    return False


def test_what_is_not_seen_changes_no_output() -> None:
    sight = sight_of(HMI)
    assert not any(told_apart(sight, seed) for seed in range(3000))
    blind = Sight(HMI, {control: frozenset({"params"}) for control in sight.seen})
    assert any(told_apart(blind, seed) for seed in range(3000))

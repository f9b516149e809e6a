"""Switches: each reading is tried alone once and named by a finding, and each changes something."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.registers import judge, load_document
from modeproof.registers.cfg import parse_cfg
from modeproof.registers.switches import restored

SPEC = "spec/door/"
REPLAY = """
literal = "LITERAL"
readings = "Readings"
step = "step"
recorded = "RECORD"
[devices.latch]
init = "Init"
scan = "CloseLatch"
outputs = "Out"
short = "latch"
[tops.Latch]
next = "Init"
wires = "LOCK_1"
columns = ["latch"]
[tops.Latch.inputs]
latch = "CloseLatch(x)"
"""
CFG = '\\* a comment with LITERAL = {"NOT_THIS"}\nCONSTANTS T_HOLD = 2  LITERAL = %s\nSPECIFICATION Spec\n'
RUN = """
[[run]]
id = "MC_Latch_slow"
module = "Latch"
cfg = "models/MC_Latch_slow.cfg"
kind = "MC"
lanes = ["full"]
environment = "honest"
properties = ["OpenIsUnlocked"]
distinct = 10
generated = 20
"""


@pytest.fixture
def switched(tree: Any) -> Any:
    """The door with two readings: SLAM breaks the property, SLOW breaks nothing."""
    tree.write(SPEC + "replay.toml", REPLAY.lstrip())
    tree.edit(
        SPEC + "Latch.tla",
        "Init ==",
        'Readings == {\n    "SLAM",  \\* at once\n    "SLOW"\n}\n'
        'Asked == "SLAM" \\in LITERAL \\/ "SLOW" \\in LITERAL\nInit ==',
    )
    tree.write(SPEC + "models/MC_Latch.cfg", CFG % "{}" + "INVARIANT TypeOK\n")
    tree.write(SPEC + "models/NEG_Latch.cfg", CFG % '{"SLAM"}' + "INVARIANT OpenIsUnlocked\n")
    tree.write(SPEC + "models/MC_Latch_slow.cfg", CFG % '{"SLOW"}' + "INVARIANT OpenIsUnlocked\n")
    tree.edit(
        SPEC + "runs.toml",
        'properties = ["TypeOK", "Open',
        'distinct = 9\ngenerated = 20\nproperties = ["TypeOK", "Open',
    )
    tree.write(SPEC + "runs.toml", (tree.root / SPEC / "runs.toml").read_text(encoding="utf-8") + RUN)
    tree.edit(SPEC + "findings.toml", 'switch = "LITERAL"', 'switches = ["SLAM", "SLOW"]')
    tree.edit(SPEC + "findings.toml", '"NEG_Latch"', '"NEG_Latch", "MC_Latch_slow"')
    return tree


def problems(tree: Any) -> list[str]:
    return [str(one) for one in judge(load_document(tree.root, "door")).problems]


def test_sound_switches_are_no_problem(switched: Any) -> None:
    assert problems(switched) == []


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "Latch.tla",
            ' \\/ "SLOW" \\in LITERAL',
            "",
            "SLOW: the switch changes nothing: it is in Readings, and no",
        ),
        ("models/NEG_Latch.cfg", '{"SLAM"}', "{}", "SLAM: no run restores this reading alone"),
        ("models/NEG_Latch.cfg", '{"SLAM"}', '{"SLAM", "SLOW"}', "SLAM: no run restores this reading alone"),
        (
            "models/MC_Latch.cfg",
            "{}",
            '{"SLAM"}',
            "SLAM: more than one run restores this reading alone: MC_Latch, NEG",
        ),
        (
            "models/NEG_Latch.cfg",
            '{"SLAM"}',
            '{"SLMA"}',
            "NEG_Latch: models/NEG_Latch.cfg restores 'SLMA', which",
        ),
        ("findings.toml", '["SLAM", "SLOW"]', '["SLAM"]', "SLOW: no finding names this switch"),
        (
            "findings.toml",
            '"SLOW"]',
            '"SLOW", "SLOPPY"]',
            "E-01: switch 'SLOPPY' is not in the specification; did",
        ),
        (
            "findings.toml",
            '"NEG_Latch", ',
            "",
            "E-01: has the switch 'SLAM', but no run in its evidence restores it",
        ),
        (
            "runs.toml",
            "distinct = 10",
            "distinct = 9",
            "the switch SLOW changes nothing: its counts are those of MC_Latch",
        ),
        (
            "runs.toml",
            'kind = "NEG"',
            'kind = "NEG"\nswitch = "SLOW"',
            "NEG_Latch: switch 'SLOW', but models/NEG_Latch",
        ),
        ("replay.toml", 'next = "Init"', 'next = "Nxt"', "Latch.tla and what it extends do not define Nxt"),
        ("Latch.tla", "Readings == {", "Other == {", "lists no reading: no module defines it"),
    ],
)
def test_each_planted_fault_is_found(switched: Any, file: str, old: str, new: str, expected: str) -> None:
    switched.edit(SPEC + file, old, new)
    found = problems(switched)
    assert any(expected in one for one in found), found


def test_a_counterexample_of_a_module_that_nothing_can_walk_is_found(switched: Any) -> None:
    text = (switched.root / SPEC / "replay.toml").read_text(encoding="utf-8")
    switched.write(SPEC + "replay.toml", text.replace("tops.Latch", "tops.Lock"))
    expected = "tops.Latch: missing; NEG_Latch checks that module"
    assert any(expected in one for one in problems(switched))


def test_the_same_counts_at_other_bounds_say_nothing(switched: Any) -> None:
    switched.edit(SPEC + "runs.toml", "distinct = 10", "distinct = 9")
    switched.edit(SPEC + "models/MC_Latch_slow.cfg", "T_HOLD = 2", "T_HOLD = 3")
    assert problems(switched) == []


def test_a_document_without_the_register_has_no_switches_to_check(switched: Any) -> None:
    (switched.root / SPEC / "replay.toml").unlink()
    switched.edit(SPEC + "runs.toml", "distinct = 10", "distinct = 9")
    assert problems(switched) == []


def test_constants_are_read_with_their_kind_and_without_comments() -> None:
    first = 'CONSTANT A <- Table  B = {"x", "y"}\n\\* C = 3\nINVARIANT I\n(* D = 4 *)\n'
    text = first + "CONSTANTS E = 5\n F = [a |-> 1]\nVIEW V\n"
    found = parse_cfg(text, "x.cfg").constants
    assert {name: (one.text, one.named) for name, one in found.items()} == {
        "A": ("Table", True),
        "B": ('{"x", "y"}', False),
        "E": ("5", False),
        "F": ("[a |-> 1]", False),
    }
    assert restored(found, "B") == {"x", "y"} and restored(found, "G") == frozenset()


def test_readings_that_a_shared_list_holds_count_as_listed_and_are_tried_too(switched: Any) -> None:
    switched.edit(
        SPEC + "Latch.tla",
        'Readings == {\n    "SLAM",  \\* at once\n    "SLOW"\n}\n',
        'SharedReadings == {"SLOW"}\nReadings == SharedReadings \\cup {"SLAM"}\n',
    )
    assert problems(switched) == []
    switched.edit(SPEC + "Latch.tla", ' \\/ "SLOW" \\in LITERAL', "")
    switched.edit(SPEC + "models/MC_Latch_slow.cfg", '{"SLOW"}', "{}")
    found = problems(switched)
    assert any("SLOW: the switch changes nothing: it is in Readings" in one for one in found), found
    assert any("SLOW: no run restores this reading alone" in one for one in found), found


BY_NAME = 'SLAM == "SLAM" \\in LITERAL\nSLOW == "SLOW" \\in LITERAL\nAsked == SLAM \\/ SLOW\nInit =='


@pytest.fixture
def by_name(switched: Any) -> Any:
    """The readings are asked for by definitions that are called as they are."""
    switched.edit(
        SPEC + "Latch.tla", 'Asked == "SLAM" \\in LITERAL \\/ "SLOW" \\in LITERAL\nInit ==', BY_NAME
    )
    return switched


def test_readings_may_be_asked_for_by_name(by_name: Any) -> None:
    assert problems(by_name) == []


def test_a_step_that_records_its_name_asks_as_well(by_name: Any) -> None:
    by_name.edit(SPEC + "Latch.tla", "Asked == SLAM \\/ SLOW", 'Asked == SLAM \\/ SLOW /\\ Did("Asked")')
    assert problems(by_name) == []


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("SLAM \\/ SLOW", "SLAM", "SLOW: the switch changes nothing: it is in Readings, and no definition"),
        ('SLOW == "SLOW"', 'SLOW == "SLAM"', "SLOW: the definition of SLOW asks for SLAM; it is to ask for"),
        ('SLOW == "SLOW" \\in LITERAL', "SLOW == FALSE", "SLOW: the definition of SLOW asks for no reading"),
    ],
)
def test_a_name_that_asks_for_nothing_or_for_another_is_found(
    by_name: Any, old: str, new: str, expected: str
) -> None:
    by_name.edit(SPEC + "Latch.tla", old, new)
    found = problems(by_name)
    assert any(expected in one for one in found), found

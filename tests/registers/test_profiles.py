"""The profiles of a document: each difference has a finding, a reason and a counterexample; each property
says in which profiles it holds.
"""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.ground.places import root
from modeproof.registers import load_document
from modeproof.registers.profiles import NEITHER, profile_of, profiles_of, profiles_with, strength_of

SPEC = "spec/door/"
PARAMETER = (
    'HOLD = { type = "text", values = ["long", "short"], default = "long", cautious = "short", '
    'clauses = ["DR-1-1"], why = "how long it holds", because = "a hand is faster" }\n'
)
CFG = 'CONSTANTS T_HOLD = 2  LITERAL = {{}}  HOLD = "{}"\nSPECIFICATION Spec\n'
SLOW = "---- MODULE LatchAsPrinted ----\nEXTENDS Latch\nCODE_Slow == 1\n====\n"
RUN = """
[[run]]
id = "MC_Latch_cautious"
module = "Latch"
cfg = "models/MC_Latch_cautious.cfg"
lanes = ["full"]
environment = "honest"
properties = ["TypeOK", "OpenIsUnlocked"]
"""


@pytest.fixture
def two(tree: Any) -> Any:
    """The door with a choice: long by the letter, short in the cautious profile."""
    for name in ("MC_Latch", "NEG_Latch", "WIT_Latch", "OPEN_Latch"):
        tree.write(f"{SPEC}models/{name}.cfg", CFG.format("long"))
    tree.write(f"{SPEC}models/MC_Latch_cautious.cfg", CFG.format("short"))
    for name, more in (("interface", PARAMETER), ("runs", RUN)):
        text = (tree.root / f"{SPEC}{name}.toml").read_text(encoding="utf-8")
        tree.write(f"{SPEC}{name}.toml", text + more)
    tree.edit(SPEC + "findings.toml", "tries = []", 'tries = []\nparameter = "HOLD"')
    tree.edit(SPEC + "Latch.tla", "    LITERAL\n", "    LITERAL, HOLD\n")
    tree.edit("refimpl/door/latch.py", "T_HOLD_ms: int = 100", 'T_HOLD_ms: int = 100\n    HOLD: str = "long"')
    tree.pin()
    return tree


def test_sound_profiles_are_no_problem(two: Any) -> None:
    assert two.problems() == []


def test_the_profile_of_a_run_follows_from_its_constants(two: Any) -> None:
    document = load_document(two.root, "door")
    of = {run.id: profile_of(two.root, run, document.interface) for run in document.runs}
    assert (of["MC_Latch"], of["MC_Latch_cautious"]) == ("letter", "cautious")
    assert profiles_of(document.interface.devices["latch"]) == {
        "letter": {"HOLD": "long"},
        "cautious": {"HOLD": "short"},
    }
    assert strength_of(two.root, document.runs[0]).startswith("profile letter; ")
    two.write(f"{SPEC}models/MC_Latch_cautious.cfg", CFG.format("for ever"))
    assert profile_of(two.root, document.runs[-1], document.interface) == NEITHER


def test_a_document_without_a_choice_has_no_profile(tree: Any) -> None:
    document = load_document(tree.root, "door")
    assert profile_of(tree.root, document.runs[0], document.interface) == ""
    assert profiles_of(document.interface.devices["latch"]) == {}


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "interface",
            'cautious = "short"',
            'cautious = "shrt"',
            "cautious 'shrt' is not one of 'long', 'short'",
        ),
        ("interface", 'cautious = "short"', 'cautious = "long"', "cautious is the default; leave it out"),
        ("interface", "default = 100", "default = 100, cautious = 50", "no finding has parameter"),
        (
            "interface",
            ', because = "a hand is faster"',
            "",
            "cautious differs, and `because` does not say why",
        ),
        ("findings", '\nparameter = "HOLD"', "", "no finding has parameter = 'HOLD'"),
        ("findings", '"NEG_Latch", ', "", "cautious differs, and no counterexample is evidence of E-01"),
        (
            "properties",
            'antecedent = "open_seen"',
            'antecedent = "open_seen"\nprofiles = ["letter"]',
            "OpenIsUnlocked: holds in the profile cautious too, by a run; leave `profiles` out",
        ),
        (
            "runs",
            'cfg = "models/MC_Latch_cautious.cfg"',
            'cfg = "models/MC_Latch.cfg"',
            "OpenIsUnlocked: no run checks it in the profile cautious",
        ),
    ],
)
def test_each_planted_fault_is_found(two: Any, file: str, old: str, new: str, expected: str) -> None:
    two.edit(f"{SPEC}{file}.toml", old, new)
    found = two.problems()
    assert any(expected in line for line in found), found


def test_what_the_letter_breaks_has_a_counterexample(two: Any) -> None:
    old = 'antecedent = "open_seen"'
    two.edit(SPEC + "properties.toml", old, f'{old}\nprofiles = ["cautious"]')
    unshown = "OpenIsUnlocked: is of the profile cautious alone, and no counterexample shows"
    assert not any(unshown in line for line in two.problems())
    two.write(f"{SPEC}models/NEG_Latch.cfg", CFG.format("short"))
    assert any(unshown in line for line in two.problems()), two.problems()


def test_a_run_with_a_reading_speaks_for_no_profile(two: Any) -> None:
    two.write(SPEC + "LatchAsPrinted.tla", SLOW)
    row = 'id = "MC_Latch_cautious"\nmodule = "Latch"\ncfg = "models/MC_Latch_cautious.cfg"'
    new = 'id = "MC_Latch_slow"\nbase = "MC_Latch"\nreading = "Slow"\nconstants = { HOLD = \'"short"\' }'
    two.edit(SPEC + "runs.toml", row, new)
    found = two.problems()
    assert any("OpenIsUnlocked: no run checks it in the profile cautious" in line for line in found), found


def test_a_harmless_reading_is_asked_in_both_profiles(two: Any) -> None:
    two.write(SPEC + "LatchAsPrinted.tla", SLOW)
    row = '\n[[run]]\nid = "MC_Latch_slow"\nbase = "MC_Latch"\nreading = "Slow"\n'
    runs = (two.root / f"{SPEC}runs.toml").read_text(encoding="utf-8") + row
    two.write(SPEC + "runs.toml", runs)
    expected = "without asking OpenIsUnlocked; name MC_Latch_cautious in its `also`"
    assert any(expected in line for line in two.problems()), two.problems()
    two.write(SPEC + "runs.toml", f"{runs}[run.also]\nMC_Latch_cautious = []\n")
    assert not any("harmless" in line for line in two.problems()), two.problems()


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({"T_DWELL_ms": 0}, ["letter"]),
        ({"T_DWELL_ms": 1}, ["cautious"]),
        ({"T_DWELL_ms": 0, "SELECTIONS": "again"}, []),
        ({"T_DWELL_ms": 70, "SELECTIONS": "again", "T_SEQ_FROM": "LA", "T_ON_ms": 5}, ["cautious"]),
        ({"PERMITS_3": [3]}, []),
        ({}, ["letter", "cautious"]),
    ],
)
def test_a_time_that_chooses_has_one_value_in_the_letter(values: dict[str, Any], expected: list[str]) -> None:
    device = load_document(root(), "mode_selection").interface.devices["fplc"]
    assert profiles_with(device, values) == expected

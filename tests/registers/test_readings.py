"""Readings: each is tried alone once and named by a finding, and each changes something."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers import load_document
from modeproof.registers.readings import idle_reading

SPEC = "spec/door/"
AS_PRINTED = """---- MODULE LatchAsPrinted ----
EXTENDS Latch
\\* DR-1-1, E-01
LOCK_1_Slam == TRUE
\\* DR-1-1, E-01
CODE_Slow == 1
====
"""
RUNS = """
[[run]]
id = "NEG_Latch_slam"
base = "MC_Latch"
reading = "Slam"
property = "OpenIsUnlocked"

[[run]]
id = "MC_Latch_slow"
base = "MC_Latch"
reading = "Slow"
distinct = 10
generated = 20
"""


@pytest.fixture
def tried(tree: Any) -> Any:
    """The door with two readings: Slam breaks the property, Slow breaks nothing."""
    tree.write(SPEC + "LatchAsPrinted.tla", AS_PRINTED)
    tree.write(SPEC + "models/MC_Latch.cfg", "CONSTANTS T_HOLD = 2  LITERAL = {}\nSPECIFICATION Spec\n")
    tree.edit(SPEC + "runs.toml", '["TypeOK", "Open', '["Open')
    tree.edit(SPEC + "runs.toml", 'properties = ["Open', 'distinct = 9\ngenerated = 20\nproperties = ["Open')
    tree.write(SPEC + "runs.toml", (tree.root / SPEC / "runs.toml").read_text(encoding="utf-8") + RUNS)
    tree.write(SPEC + "killers.toml", 'document = "door"\n')  # NEG_Latch_slam breaks the property
    tree.edit(SPEC + "findings.toml", "tries = []", 'tries = ["Slam", "Slow"]')
    tree.edit(SPEC + "findings.toml", '"NEG_Latch"', '"NEG_Latch", "NEG_Latch_slam", "MC_Latch_slow"')
    return tree


def test_sound_readings_are_no_problem(tried: Any) -> None:
    assert tried.problems() == []


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "runs.toml",
            'reading = "Slow"',
            'reading = ["Slow", "Slam"]',
            "Slow: no run tries this reading alone",
        ),
        (
            "runs.toml",
            'reading = "Slow"',
            'reading = "Slam"',
            "Slam: more than one run tries this reading alone",
        ),
        (
            "runs.toml",
            'reading = "Slow"',
            'reading = "Slw"',
            "MC_Latch_slow: unknown reading 'Slw'; did you mean",
        ),
        (
            "runs.toml",
            "distinct = 10",
            "distinct = 9",
            "the reading Slow changes nothing: its counts are those of",
        ),
        ("findings.toml", '["Slam", "Slow"]', '["Slam"]', "Slow: no finding names this reading in `tries`"),
        (
            "findings.toml",
            '["Slam", "Slow"]',
            '["Slam", "Slwo"]',
            "E-01: tries 'Slwo', which no module of readings",
        ),
        ("findings.toml", ', "MC_Latch_slow"', "", "E-01: tries 'Slow', but no run in its evidence has this"),
        ("LatchAsPrinted.tla", "CODE_Slow", "COD_Slow", "COD_Slow: replaces nothing: no module that"),
        ("LatchAsPrinted.tla", "CODE_Slow", "CODE_slow", "CODE_slow: is no Op_Reading"),
        ("Latch.tla", "CODE == 0", "LOCAL CODE == 0", "CODE_Slow: cannot replace CODE, which is LOCAL"),
    ],
)
def test_each_planted_fault_is_found(tried: Any, file: str, old: str, new: str, expected: str) -> None:
    tried.edit(SPEC + file, old, new)
    found = tried.problems()
    assert any(expected in one for one in found), found


def test_a_finding_that_says_harmless_shows_the_run(tried: Any) -> None:
    tried.edit(SPEC + "findings.toml", 'consequence = "', 'consequence = "Slow is harmless. ')
    assert tried.problems() == []
    tried.edit(SPEC + "findings.toml", ', "MC_Latch_slow"', "")
    expected = "E-01: says harmless, and no MC run with a reading is its evidence"
    assert any(expected in line for line in tried.problems()), tried.problems()


def test_a_reading_is_asked_in_the_view_of_its_base(tried: Any) -> None:
    tried.edit(SPEC + "runs.toml", 'reading = "Slow"', 'reading = "Slow"\nview = "hides"')
    expected = "MC_Latch_slow: tries a reading in a view that is not its base's"
    assert any(expected in line for line in tried.problems()), tried.problems()


def test_a_harmless_reading_is_asked_every_property(tried: Any) -> None:
    old = 'generated = 20\nproperties = ["'
    tried.edit(SPEC + "runs.toml", f"{old}Open", f'{old}TypeOK", "Open')
    text = (tried.root / SPEC / "runs.toml").read_text(encoding="utf-8")
    tried.write(SPEC + "runs.toml", f'{text}properties = ["TypeOK"]\n')
    expected = "MC_Latch_slow: calls Slow harmless without asking OpenIsUnlocked; name MC_Latch in its `also`"
    assert any(expected in one for one in tried.problems()), tried.problems()
    tried.write(SPEC + "runs.toml", f'{text}properties = ["TypeOK"]\n[run.also]\nMC_Latch = [8, 20]\n')
    assert tried.problems() == []
    run = next(run for run in load_document(tried.root, "door").runs if run.of)
    assert (run.id, run.readings, run.base) == ("MC_Latch_with_Slow", ("Slow",), "MC_Latch")
    assert (run.distinct, run.generated, run.lanes) == (8, 20, ("full",))


def test_where_demands_are_judged_each_reading_is(tried: Any) -> None:
    tried.write(SPEC + "LatchDemands.tla", "---- MODULE LatchDemands ----\nEXTENDS Latch\n====\n")
    row = (
        RUNS.split("[[run]]")[2].replace("_slow", "_demands").replace("base", 'module = "LatchDemands"\nbase')
    )
    text = (tried.root / SPEC / "runs.toml").read_text(encoding="utf-8")
    tried.write(SPEC + "runs.toml", f"{text}\n[[run]]{row}")
    for unasked, expected in (
        ("", ["Slam is not asked"]),
        ('Slam = "it is so"', []),
        ('Slam = "it is so", Slow = "no"', ["Slow is asked and has a reason why not"]),
        ('Slam = "it is so", Slm = "no"', ["unasked: 'Slm' is none of its readings"]),
    ):
        tried.edit(SPEC + "findings.toml", '["Slam", "Slow"]', f'["Slam", "Slow"]\nunasked = {{ {unasked} }}')
        found = [one for one in tried.problems() if "asked" in one]
        assert len(found) == len(expected) and all(map(str.__contains__, found, expected)), found
        tried.edit(SPEC + "findings.toml", f"\nunasked = {{ {unasked} }}", "")


def test_a_reading_tried_in_a_live_run_alone_is_told(tried: Any) -> None:
    for file in ("runs", "findings"):
        tried.edit(f"{SPEC}{file}.toml", "MC_Latch_slow", "LIVE_Latch_slow")
    expected = "Slow: LIVE_Latch_slow tries it alone, which is neither a counterexample nor an MC run"
    assert any(expected in line for line in tried.problems()), tried.problems()


@pytest.mark.parametrize(
    ("also", "expected"),
    [
        ("MC_Lach = []", "MC_Latch_slow: also: unknown run 'MC_Lach'; did you mean 'MC_Latch'"),
        ("NEG_Latch = []", "also: NEG_Latch is no run of kind MC, LIVE, OPEN of what was decided"),
        ("MC_Latch_slow = []", "also: MC_Latch_slow is no run of kind MC, LIVE, OPEN of what was decided"),
        ("MC_Latch = [3]", "also: MC_Latch must be [distinct, generated], or [] until --repin writes them"),
        ('MC_Latch = "3"', "also.MC_Latch"),
    ],
)
def test_a_further_run_that_cannot_be_made_is_refused(tried: Any, also: str, expected: str) -> None:
    text = (tried.root / SPEC / "runs.toml").read_text(encoding="utf-8")
    tried.write(SPEC + "runs.toml", f"{text}[run.also]\n{also}\n")
    with pytest.raises(Unjudged) as caught:
        load_document(tried.root, "door")
    assert expected in caught.value.message


def test_only_a_harmless_reading_has_further_runs(tried: Any) -> None:
    tried.edit(SPEC + "runs.toml", 'reading = "Slam"\n', 'reading = "Slam"\nalso = { MC_Latch = [] }\n')
    with pytest.raises(Unjudged, match="NEG_Latch_slam: also belongs to an MC run with one reading"):
        load_document(tried.root, "door")


def test_the_same_counts_with_other_constants_say_nothing(tried: Any) -> None:
    tried.edit(SPEC + "runs.toml", "distinct = 10", 'distinct = 9\nconstants = { T_HOLD = "3" }')
    assert tried.problems() == []


def test_a_shared_reading_counts_where_a_run_could_use_it(tried: Any) -> None:
    shared = AS_PRINTED.replace("Latch", "Shared").replace("_Slam", "_Wide").replace("_Slow", "_Narrow")
    tried.write("spec/common/Shared.tla", "---- MODULE Shared ----\nLOCK_1 == TRUE\nCODE == 0\n====\n")
    tried.write("spec/common/SharedAsPrinted.tla", shared)
    assert tried.problems() == []
    tried.edit(SPEC + "Latch.tla", "EXTENDS Naturals", "EXTENDS Naturals, Shared")
    found = tried.problems()
    assert any("Wide: no run tries this reading alone" in one for one in found), found


def test_a_negative_run_that_holds_says_which_reading_changed_nothing(tried: Any) -> None:
    document = load_document(tried.root, "door")
    run = next(run for run in document.runs if run.id == "NEG_Latch_slam")
    assert "Slam changes nothing: its counts are those of MC_Latch" in idle_reading(document, run, (9, 20))
    assert idle_reading(document, run, (8, 20)) == "the reading Slam breaks nothing that this run checks"
    assert idle_reading(document, document.runs[0], (9, 20)) == ""


def test_a_reading_that_joins_others_need_not_be_tried_alone(tried: Any) -> None:
    tried.edit(SPEC + "LatchAsPrinted.tla", "CODE_Slow == 1\n", "CODE_Slow == 1\nCODE_AllAsPrinted == 1\n")
    tried.edit(SPEC + "findings.toml", '["Slam", "Slow"]', '["Slam", "Slow", "AllAsPrinted"]')
    found = tried.problems()
    assert any("AllAsPrinted: no run tries this reading" in one for one in found), found
    both = RUNS.split("[[run]]")[1].replace("_slam", "_all").replace('"Slam"', '["Slam", "AllAsPrinted"]')
    text = (tried.root / SPEC / "runs.toml").read_text(encoding="utf-8")
    tried.write(SPEC + "runs.toml", f"{text}\n[[run]]{both}")
    tried.edit(SPEC + "findings.toml", '"NEG_Latch_slam"', '"NEG_Latch_slam", "NEG_Latch_all"')
    assert tried.problems() == []


REPLAY = """
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


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('next = "Init"', 'next = "Nxt"', "tops.Latch: Latch.tla and what it extends do not define Nxt"),
        ("tops.Latch", "tops.Lock", "tops.Latch: missing; NEG_Latch"),
    ],
)
def test_a_counterexample_that_cannot_be_walked_is_found(
    tried: Any, old: str, new: str, expected: str
) -> None:
    tried.write(SPEC + "replay.toml", REPLAY.lstrip())
    assert tried.problems() == []
    tried.write(SPEC + "replay.toml", REPLAY.lstrip().replace(old, new))
    found = tried.problems()
    assert any(expected in one for one in found), found

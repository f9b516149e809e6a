"""The wiring on trial: the record is one of the present files."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import z3

from machines import trial as machine_trial
from machines.trial import Outcome, Trial, edits
from machines.trial_record import as_toml, basis_of, read_record
from machines.verdicts import Machine
from programs.invariants.induction import System

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
RECORD = (FOLDER / "trial.toml").read_text("utf-8")


def plain(text: str = TEXT, runs: int = 240) -> Machine:
    machine = Machine(text, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs)
    machine.triggers = [[] for _ in machine.questions.rows]
    return machine


def test_the_record_is_of_the_present_files() -> None:
    basis = basis_of(plain())
    assert tomllib.loads(RECORD)["basis"] == basis, "modeproof machine --trial --record"
    assert read_record(RECORD, basis)
    for name in {*basis} - {"use"}:
        assert not read_record(RECORD, {**basis, name: "other"})


def test_only_what_runs_did_not_reach_rests_on_their_guide() -> None:
    first, *_ = edits(TEXT, plain().wiring)
    for scans, kept in ((7, True), (0, False)):
        text = as_toml([Outcome(first, "KILLED", ["one-mode"], scans)], 9, {"code": "x", "use": "y"})
        assert (first.id in read_record(text, {"code": "x", "use": "z"})) == kept


def test_words_about_the_wiring_leave_the_record_as_it_is() -> None:
    basis = basis_of(plain())
    assert basis_of(plain(TEXT.replace('why = "the door of the zone"', 'why = "the door"'))) == basis
    assert basis_of(plain(TEXT.replace("TestTime = 100", "TestTime = 90")))["wiring"] != basis["wiring"]


def test_the_page_counts_the_outcomes_of_the_record() -> None:
    page = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
    words = Counter(row["verdict"] for row in read_record(RECORD).values())
    told = re.search(r"edits \d+ were judged: (.*?)[;.]", page)
    assert told
    assert told[1] == ", ".join(f"{words[word]} {word}" for word in sorted(words))


def test_an_outcome_is_read_back_as_it_was_written() -> None:
    edit = next(edits(TEXT, plain().wiring))
    text = as_toml([Outcome(edit, "KILLED", ["one-mode"], 7)], 9, {"code": "x"})
    row = read_record(text, {"code": "x"})[edit.id]
    assert (row["verdict"], row["by"], row["scans"]) == ("KILLED", ["one-mode"], 7)


def test_blocks_that_do_not_read_each_other_change_over_freely() -> None:
    trial = Trial(plain(runs=1))
    found = {edit.id: edit for edit in edits(TEXT, trial.machine.wiring) if edit.kind == "order"}
    harmless = trial.run(found["order = manual_begins and automatic_begins changed over"])
    assert harmless is not None
    assert harmless.word == "HARMLESS"
    killed = trial.run(found["order = fplc last"])
    assert killed is not None
    assert killed.word == "KILLED"


@pytest.mark.deep
def test_an_edit_that_a_property_reads_is_not_the_same() -> None:
    trial = Trial(plain(runs=1))
    for id, same in (
        ("outputs.S_SlowSpeed = guard.S_GuardLocked", False),
        ("order = manual_begins and automatic_begins changed over", True),
    ):
        edit = next(edit for edit in edits(TEXT, trial.machine.wiring) if edit.id == id)
        assert trial._same(trial.edited(edit)) == same


def test_a_lost_fact_may_hold_where_a_flag_is_off() -> None:
    """x follows y by a scan: once it was never true; now it is true only where y is, or not for long."""
    x, y, asked = z3.Bools("x y asked")
    yes, no = z3.BoolVal(True), z3.BoolVal(False)
    after = {"x": y, "y": z3.Or(y, asked)}
    edited: Any = SimpleNamespace(
        system=System({"x": x, "y": y}, {"asked": asked}, {"x": no, "y": no}, after, yes, yes, yes)
    )
    never = z3.Not(x)
    assert machine_trial._kept(edited, [never]) == []
    found = machine_trial._weakened(edited, [never])
    assert {z3.simplify(lemma).sexpr() for lemma in found} == {"(or y (not x))", "true"}

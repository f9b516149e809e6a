"""The wiring on trial: each property falls to an edit, and the record is one of the present files."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from pathlib import Path

import pytest

from programs.machine import Machine
from programs.machine_trial import Outcome, Trial, as_toml, basis_of, edits, read_record

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
RECORD = (FOLDER / "trial.toml").read_text("utf-8")
FALLS = {
    "no-mode-no-motion": "block.edm.inputs.S_OutControl = guard.S_GuardLocked",
    "beam-stops-manual": 'matrix.manual = [["guard"], ["enable"]]',
    "squeezing-stops-open": 'matrix.setup = [["enable"], ["beam"]]',
    "locked-in-motion": 'matrix.automatic = [["beam"]]',
    "missed-pick-up-is-found": "block.edm.parameters.MonitoringTime = 2000",
    "contactor-fault-stops": "block.edm.parameters.MonitoringTime = 2000",
    "contactor-error-stops": "outputs.S_DriveEnable = running.Q1",
}
"""An edit for each property that no recorded kill names: the trial stops at what falls first."""


def plain(text: str = TEXT, runs: int = 240) -> Machine:
    machine = Machine(text, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs)
    machine.triggers = [[] for _ in machine.questions.rows]
    return machine


def test_every_property_falls_to_an_edit_of_the_wiring() -> None:
    known = {id for row in read_record(RECORD).values() for id in row["by"]} | set(FALLS)
    assert {row["id"] for row in plain().questions.rows} <= known


@pytest.mark.sampled
@pytest.mark.parametrize("id", ["missed-pick-up-is-found", *(id for id in FALLS if "missed" not in id)])
def test_the_property_falls_to_its_edit(id: str) -> None:
    edit = next(edit for edit in edits(TEXT, plain().wiring) if edit.id == FALLS[id])
    assert id in plain(edit.after).look(lambda seen: id in seen.broken).broken


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

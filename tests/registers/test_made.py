"""Runs that are another run with a reading: what is made of them, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import parse_cfg
from modeproof.registers.made import cfg_text, make, module_text, reading_problems
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.tla import read_modules
from modeproof.tlc.check import register_problems
from tests.toy_tree import declaration, toy_tree

AS_PRINTED = """---- MODULE ToyAsPrinted ----
EXTENDS Toy
\\* the count never stops
Up_Overflows == in' = 1 /\\ count' = count + 1 /\\ step' = "Up" /\\ UNCHANGED top
Stay_Sinks == in' = 1 /\\ Fallen /\\ step' = "Stay" /\\ UNCHANGED top
LOCAL Fallen == count' = -1
Up_Stops == FALSE
====
"""


CHANGES = 'constants = { N = "7", TOP = "<- Small" }\nview = "View"'


def tree(root: Path, rows: str, as_printed: str = AS_PRINTED) -> Path:
    toy_tree(root)
    folder = root / "spec/toy"
    (folder / "runs.toml").write_text(declaration("MC_toy") + rows)
    (folder / "ToyAsPrinted.tla").write_text(as_printed)
    return root


def row(reading: str, more: str = "") -> str:
    return f'[[run]]\nid = "NEG_x"\nbase = "MC_toy"\nreading = {reading}\nproperty = "TypeOK"\n{more}'


def the_run(root: Path) -> Run:
    return load_runs(root, "toy")[1]


def test_the_made_files_replace_the_operators_of_the_reading(tmp_path: Path) -> None:
    root = tree(
        tmp_path, row('["Overflows", "Sinks"]', 'constants = { N = "7", TOP = "<- Small" }\nview = "View"')
    )
    run = the_run(root)
    assert module_text(root, run) == "---- MODULE NEG_x ----\nEXTENDS Toy, ToyAsPrinted\n====\n"
    cfg = parse_cfg(cfg_text(root, run), "x.cfg")
    assert {name: f"{one.sign} {one.text}" for name, one in cfg.constants.items()} == {
        "N": "= 7",
        "SLEEP": "= FALSE",
        "PRINT": "= FALSE",
        "TOP": "<- Small",
        "Up": "<- Up_Overflows",
        "Stay": "<- Stay_Sinks",
    }
    assert (cfg.specification, cfg.view, cfg.checked) == ("Spec", "View", ("TypeOK",))
    folder, made = make(root, run)
    assert folder == root / "build/tlc/toy/made/NEG_x" and (made.module, made.base) == ("NEG_x", "")
    assert (root / run.config).read_text() == cfg_text(root, run)
    assert sorted(path.name for path in folder.iterdir()) == ["NEG_x.cfg", "NEG_x.tla"]


def test_a_run_by_hand_has_the_cfg_of_its_file(tmp_path: Path) -> None:
    root = tree(tmp_path, "")
    (run,) = load_runs(root, "toy")
    assert cfg_text(root, run) == (root / run.config).read_text()


@pytest.mark.parametrize(
    ("reading", "old", "new", "words"),
    [
        ('"Sink"', "", "", "unknown reading 'Sink'; did you mean 'Sinks'?"),
        ('["Overflows", "Stops"]', "", "", "Up is replaced by Overflows and Stops"),
        ('"Sinks"', "Stay_Sinks", "Stray_Sinks", "Stray_Sinks replaces nothing: no module"),
        ('"Sinks"', "Stay_Sinks", "LOCAL Stay_Sinks", "Stay_Sinks is LOCAL"),
        ('"Sinks"', "count' = -1", "Stay", "Stay_Sinks uses Stay, which it replaces"),
        ('"Sinks"', "EXTENDS Toy", "EXTENDS Other", "is in ToyAsPrinted, which Toy cannot use"),
    ],
)
def test_a_reading_that_cannot_be_used_is_refused(
    tmp_path: Path, reading: str, old: str, new: str, words: str
) -> None:
    root = tree(tmp_path, row(reading), AS_PRINTED.replace(old, new, 1) if old else AS_PRINTED)
    (root / "spec/toy/Other.tla").write_text("---- MODULE Other ----\nEXTENDS Toy\n====\n")
    with pytest.raises(Unjudged) as caught:
        cfg_text(root, the_run(root))
    assert caught.value.message.startswith("spec/toy/runs.toml: run NEG_x: ")
    assert words in caught.value.message
    assert register_problems(root, "toy") == (caught.value.message,)


def test_a_reading_of_a_local_operator_is_refused(tmp_path: Path) -> None:
    root = tree(tmp_path, row('"Sinks"'))
    toy = root / "spec/toy/Toy.tla"
    toy.write_text(toy.read_text().replace("\nStay ==", "\nLOCAL Stay =="))
    with pytest.raises(Unjudged, match="cannot replace Stay, which is LOCAL"):
        cfg_text(root, the_run(root))


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("Up_Stops ==", "Up_stops ==", ("Up_stops", "is no Op_Reading")),
        ("Up_Stops ==", "Away_Stops ==", ("Away_Stops", "replaces nothing")),
        ("Up_Stops ==", "Top ==", None),
    ],
)
def test_a_definition_that_replaces_nothing_is_a_problem(
    tmp_path: Path, old: str, new: str, found: tuple[str, str] | None
) -> None:
    root = tree(tmp_path, "", AS_PRINTED.replace(old, new))
    problems = list(reading_problems(read_modules(root, "toy")))
    assert len(problems) == (found is not None)
    for file, name, text in problems:
        assert file == "spec/toy/ToyAsPrinted.tla" and found is not None
        assert name == found[0] and text.startswith(found[1])


ROWS = """
[default.run]
lanes = ["full"]
environment = "honest"
specification = "Spec"

[constants]
N = "4"
SLEEP = "FALSE"
PRINT = "FALSE"
ELSEWHERE = "1"

[run.MC_toy]
module = "Toy"
properties = ["TypeOK", "Small", "NeverDown", "Reaches"]
counts = [16, 33]

[run.MC_less]
module = "Toy"
constants = { N = "2" }
view = "View"
properties = ["MC_toy", "PrintState"]
without = ["Reaches"]

[based.MC_less]
NEG_less = { reading = "Stops", property = "Small", trace_length = 3 }
"""


def made_tree(root: Path, rows: str = ROWS) -> Path:
    tree(root, "")
    (root / "spec/toy/runs.toml").write_text(rows)
    return root


def test_a_cfg_is_made_of_row_constants_and_default(tmp_path: Path) -> None:
    root = made_tree(tmp_path)
    toy, less, negative = load_runs(root, "toy")
    cfg = parse_cfg(cfg_text(root, less), "x.cfg")
    assert {name: one.text for name, one in cfg.constants.items()} == {
        "N": "2",
        "SLEEP": "FALSE",
        "PRINT": "FALSE",
    }, "a constant that the modules do not declare is not given"
    assert (cfg.specification, cfg.view) == ("Spec", "View")
    assert (cfg.invariants, cfg.properties) == (("TypeOK", "Small", "PrintState"), ("NeverDown",))
    assert (toy.distinct, toy.generated, less.properties[-1]) == (16, 33, "PrintState")
    assert (negative.base, negative.module, negative.lanes) == ("MC_less", "Toy", ("full",))
    changed = parse_cfg(cfg_text(root, negative), "x.cfg")
    assert (changed.checked, changed.constants["N"].text) == (("Small",), "2")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('without = ["Reaches"]', 'without = ["Risen"]', "without: Risen is none of its properties"),
        ("NEG_less = {", 'NEG_less = { base = "MC_toy",', "declared twice, or has another base"),
        ("NEG_less = {", "MC_less = {", "declared twice, or has another base"),
        ("counts = [16, 33]", "counts = [16]", "counts"),
        ("[based.MC_less]", "[based.MC_more]", "unknown base 'MC_more'"),
        ("[constants]", "[constant]", "unknown key 'constant'"),
        ('specification = "Spec"', 'specfication = "Spec"', "unknown key 'specfication'"),
    ],
)
def test_a_row_that_is_short_for_nothing_is_refused(old: str, new: str, said: str, tmp_path: Path) -> None:
    assert old in ROWS
    with pytest.raises(Unjudged, match=said):
        load_runs(made_tree(tmp_path, ROWS.replace(old, new)), "toy")


def test_a_changed_row_is_not_what_was_pinned(tmp_path: Path) -> None:
    less = ROWS.replace('"NeverDown", ', "")
    before, after = (
        {run.id: cfg_text(root, run) for run in load_runs(root, "toy")}
        for root in (made_tree(tmp_path / "a"), made_tree(tmp_path / "b", less))
    )
    assert before["MC_toy"] != after["MC_toy"] and before["MC_less"] != after["MC_less"]

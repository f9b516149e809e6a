"""Mutants whose fate is known are judged so: each verdict once, and the whole matrix of what is broken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.strength.by_properties import ByProperties
from modeproof.strength.mutant import Mutant
from modeproof.strength.mutant_judge import Bench, judge
from tests.strength.toy import STRENGTH, lamp


def the(every: Sequence[Mutant], definition: str, operator: str, old: str) -> Mutant:
    (one,) = (m for m in every if (m.definition, m.operator, m.old) == (definition, operator, old))
    return one


FATES = [
    ("a light at any count", "Light", "comparison swapped", "=", "KILLED", ("LitOnlyWhenFull", "StartsDark")),
    ("the lamp stays on", "Down", "reset missing", "lamp' = \"off\"", "KILLED", ("OffAtOnce", "StartsDark")),
    ("a guard that another one repeats", "Up", "conjunct dropped", "count < 3", "EQUIVALENT", ()),
    ("the count stays, which no property minds", "Down", "reset missing", "count' = 0", "SURVIVED", ()),
    ("there is no name for such a count", "Name", "operator swapped", "+", "INVALID", ()),
]  # fmt: skip


@pytest.mark.parametrize(
    ("why", "definition", "operator", "old", "word", "killers"), FATES, ids=[f[0] for f in FATES]
)
def test_a_mutant_meets_its_fate(
    why: str, definition: str, operator: str, old: str, word: str, killers: tuple[str, ...],
    bench: Bench, every: tuple[Mutant, ...],
) -> None:  # fmt: skip
    verdict = judge(bench, the(every, definition, operator, old))
    assert (verdict.word, tuple(sorted(verdict.killers))) == (word, killers)
    assert word == "INVALID" or all(one.complete for one in verdict.answers)


def test_what_never_ends_is_unmeasured(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Two guards stop the count; in this text only one, and without it TLC counts for ever."""
    endless = lamp(tmp_path_factory.mktemp("endless"))
    path = endless.folder / "Lamp.tla"
    path.write_text(path.read_text().replace(" /\\ count # 3", ""))
    for tier in endless.strength.tiers:  # the original has the time that it needs
        endless.control(tier)
    hurried = tuple(replace(tier, timeout_s=3.0) for tier in endless.strength.tiers)
    endless.strength = replace(endless.strength, tiers=hurried)
    verdict = judge(endless, the(ByProperties(endless).mutants, "Up", "conjunct dropped", "count < 3"))
    assert verdict.word == "UNMEASURED"
    assert verdict.reason == "tier alone: the limit of 3 s came first"


def test_beyond_a_broken_type_nothing_is_explored(tmp_path_factory: pytest.TempPathFactory) -> None:
    typed = STRENGTH.replace("timeout_s = 500", 'timeout_s = 500\ntypes = ["TypeOK"]')
    bounded = lamp(tmp_path_factory.mktemp("bounded"), typed)
    path = bounded.folder / "Lamp.tla"
    path.write_text(path.read_text().replace(" /\\ count # 3", ""))
    answer = bounded.ask(
        bounded.strength.tiers[0], the(ByProperties(bounded).mutants, "Up", "conjunct dropped", "count < 3")
    )
    assert answer.complete and answer.distinct < 20


def test_an_original_that_breaks_a_property_judges_nobody(tmp_path_factory: pytest.TempPathFactory) -> None:
    broken = lamp(tmp_path_factory.mktemp("broken"))
    path = broken.folder / "Lamp.tla"
    path.write_text(path.read_text().replace("count = 3\n", "count = 2\n"))
    with pytest.raises(Unjudged, match="tier alone does not pass on the original: broken: LitOnlyWhenFull"):
        broken.control(broken.strength.tiers[0])


def test_the_edit_is_never_made_in_the_tree(bench: Bench, every: tuple[Mutant, ...]) -> None:
    before = (bench.folder / "Lamp.tla").read_bytes()
    bench.ask(bench.strength.tiers[0], every[0])
    assert (bench.folder / "Lamp.tla").read_bytes() == before
    assert not list(bench.place.rglob("StrengthTrial*"))


def test_the_first_broken_property_is_enough_when_asked(tmp_path: Path, every: tuple[Mutant, ...]) -> None:
    whole = lamp(tmp_path / "whole")
    quick = replace(lamp(tmp_path / "quick"), first=True)
    mutant = the(every, "Down", "reset missing", 'lamp\' = "off"')
    all_of_them, first = judge(whole, mutant), judge(quick, mutant)
    assert len(all_of_them.killers) > 1 and first.killers == all_of_them.killers[:1]
    assert (first.word, first.reason) == ("KILLED", "not explored to the end in alone")
    stamps = ByProperties(whole).stamps["Lamp"], ByProperties(quick).stamps["Lamp"]
    assert stamps[0] == stamps[1], "such an answer holds for the same texts"

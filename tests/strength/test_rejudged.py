"""A few mutants of the real specification, named in strength.toml, are judged again each time."""

from __future__ import annotations

import pytest

from modeproof.places import root
from modeproof.strength.campaign import all_mutants
from modeproof.strength.judge import Bench, judge
from modeproof.strength.mutant import Mutant
from modeproof.strength.register import Rejudged, load_strength
from modeproof.tlc.toolchain import find_toolchain

STRENGTH = load_strength(root(), "mode_selection")


@pytest.fixture(scope="module")
def judged() -> tuple[Bench, dict[str, Mutant]]:
    bench = Bench(root(), STRENGTH, find_toolchain())
    return bench, {one.id: one for one in all_mutants(bench)}


@pytest.mark.parametrize("one", STRENGTH.rejudged, ids=lambda one: one.id)
def test_a_mutant_meets_the_same_fate_again(one: Rejudged, judged: tuple[Bench, dict[str, Mutant]]) -> None:
    bench, mutants = judged
    verdict = judge(bench, mutants[one.id])
    assert (verdict.word, verdict.killers[:1]) == (one.verdict, (one.killer,) if one.killer else ())


def test_some_are_named() -> None:
    assert STRENGTH.rejudged

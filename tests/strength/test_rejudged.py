"""A few mutants of the real specification, named in strength.toml, are judged again each time."""

from __future__ import annotations

import pytest

from modeproof.ground.places import documents, root
from modeproof.registers.scores import load_scores
from modeproof.strength.mutant_judge import judge
from modeproof.strength.register import Rejudged
from tests.strength.shipped import bench_of, mutants_of

DOCUMENT = "mode_selection"
STRENGTH = bench_of(DOCUMENT).strength


@pytest.mark.sampled(8)
@pytest.mark.parametrize("one", STRENGTH.rejudged, ids=lambda one: one.id)
def test_a_mutant_meets_the_same_fate_again(one: Rejudged) -> None:
    (mutant,) = [mutant for mutant in mutants_of(DOCUMENT) if mutant.id == one.id]
    verdict = judge(bench_of(DOCUMENT), mutant)
    assert (verdict.word, verdict.killers[:1]) == (one.verdict, (one.killer,) if one.killer else ())


def test_some_are_named() -> None:
    assert STRENGTH.rejudged


@pytest.mark.parametrize("document", documents(root()))
def test_every_explained_survivor_is_a_mutant(document: str) -> None:
    (row,) = [row for row in load_scores(root(), document) if row.what == "spec"]
    if row.earlier_text:
        pytest.skip("the specification has changed since the campaign")
    ids = {mutant.id for mutant in mutants_of(document)}
    named = {id for explained in bench_of(document).strength.explained for id in explained.ids}
    assert {id for id in named if "*" not in id} <= ids

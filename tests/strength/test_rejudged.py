"""A few mutants of the real specification, named in strength.toml, are judged again each time."""

from __future__ import annotations

import fnmatch

import pytest

from modeproof.ground.places import documents, root
from modeproof.strength.code import Code
from modeproof.strength.mutant_judge import judge
from modeproof.strength.register import Rejudged
from proofs.mutants import bench
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
def test_every_explained_survivor_is_a_mutant_of_this_text(document: str) -> None:
    code = Code(root(), document, bench)
    for every, explained in (
        (mutants_of(document), bench_of(document).strength.explained),
        (code.mutants, code.register.survivors),
    ):
        ids = {mutant.id for mutant in every}
        assert {id for row in explained for id in row.ids if not fnmatch.filter(ids, id)} == set()

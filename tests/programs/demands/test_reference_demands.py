"""The demands of each document hold of its reference implementation: proved, and checked again by cvc5."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import CodeType

import pytest

from programs.certificates import inductive
from programs.certificates.inductive import Claim
from programs.certificates.recheck import asked
from programs.commands.reference_demands import judgement_of, lines_of, shown
from programs.demands.verdicts import Judgement
from programs.demands.watched import Beside
from programs.invariants.induction import Proof

BLOCKS = ("sf_edm", "sf_enable_switch", "sf_guard_locking", "sf_testable_safety_sensor")
EVERY = [(target, profile) for target in BLOCKS for profile in ("letter", "cautious")]


@pytest.mark.parametrize(
    ("target", "profile"),
    [pytest.param(*one, marks=pytest.mark.deep) for one in EVERY],
)
def test_the_reference_does_what_its_page_demands(target: str, profile: str) -> None:
    judgement = judgement_of(target, profile, 60)
    found = shown(judgement)
    assert found.status == 0, "\n".join(lines_of(target, profile, found))
    assert len(found.found) == len(judgement.beside.demands.rows) > 10
    assert found.answers.files == len(found.found) and set(found.answers.answers) == {"z3", "cvc5"}


def turned(judgement: Judgement, id: str) -> Judgement:
    """The same with one demand turned into its opposite."""
    beside = judgement.beside
    rows = tuple(
        replace(row, holds=replace(row.holds, text=f"not ({row.holds.text})", code=compiled(row.holds.text)))
        if row.id == id
        else row
        for row in beside.demands.rows
    )
    demands = replace(beside.demands, rows=rows)
    return Judgement(Beside(beside.subject, demands, beside.assumed), None, 20, lambda text: None)


def compiled(text: str) -> CodeType:
    return compile(f"not ({text})", "turned", "eval")


@pytest.mark.deep
def test_a_demand_that_it_does_not_keep_is_broken() -> None:
    judgement = turned(judgement_of("sf_enable_switch", "letter", 20), "NoEnableInError")
    found = {one.asked.id: one for one in judgement.all()}
    broken = found["NoEnableInError"].broken
    assert broken is not None and [one.asked.id for one in found.values() if one.word == "BROKEN"] == [
        "NoEnableInError"
    ]
    assert broken.steps[-1].outputs["Ready"] is True


def test_a_false_proof_is_refused_by_both_solvers() -> None:
    judgement = judgement_of("sf_enable_switch", "letter", 20)
    one = judgement.every[1]
    wrong = Claim(one.id, "", turned(judgement, one.id).plainly_bad(one), Proof(1, (), "nothing"))
    answers = asked(Path(), list(inductive.obligations(judgement.beside.system, [wrong])))
    assert answers.status == 1 and all("sat" in said.values() for said in answers.answers.values())

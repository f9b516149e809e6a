"""The demands of each document hold of its reference implementation: proved, and checked again by cvc5."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import CodeType

import pytest
import z3

from modeproof.ground.places import documents, root
from modeproof.registers.demands import load_demand_rows
from modeproof.report.demanded import subjects
from programs.certificates import inductive, kept_proofs
from programs.certificates.inductive import Claim
from programs.certificates.recheck import asked
from programs.commands.reference_demands import judgement_of, lines_of, shown
from programs.demands import verdicts
from programs.demands.verdicts import Judgement
from programs.demands.watched import Beside
from programs.invariants.induction import Proof, System
from programs.semantics.reference import targets

EVERY = [one for document in documents(root()) for one in subjects(root(), document)]


@pytest.mark.deep
@pytest.mark.parametrize(
    ("target", "profile"),
    [
        pytest.param(*one, marks=[pytest.mark.long] * (one[1] == "cautious" or one[0] == "fplc"))
        for one in EVERY
    ],
)
def test_the_reference_does_what_its_page_demands(target: str, profile: str) -> None:
    """`verify` proves them all."""
    left_out = load_demand_rows(root(), targets()[target]).unproved.get(target, {})
    judgement = judgement_of(target, profile, 60, left_out=[*left_out])
    found = shown(judgement)
    assert found.status == 0, "\n".join(lines_of(target, profile, found))
    assert len(found.found) == len(judgement.beside.demands.rows) - len(left_out) >= 9
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


def no_search(*given: object) -> None:
    raise AssertionError("a proof was searched for")


def test_what_was_kept_is_asked_again_without_a_search(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("induction", "shortest", "spacer", "spacer_over_numbers", "Houdini", "Located"):
        monkeypatch.setattr(verdicts, name, no_search)
    found = shown(judgement_of("sf_enable_switch", "letter", 20))
    assert found.status == 0 and len(found.found) == 13


def false_invariant(system: System) -> z3.BoolRef:
    """Nothing is enabled: true at power-up, and not for ever."""
    return z3.Not(system.state["was_S_EnableSwitchOut"])


@pytest.mark.parametrize("lemma", [false_invariant, lambda system: z3.BoolVal(False)], ids=["lost", "never"])
def test_a_kept_proof_that_is_none_is_not_believed(lemma: Callable[[System], z3.BoolRef]) -> None:
    judgement = judgement_of("sf_enable_switch", "letter", 20)
    proof = Proof(1, [lemma(judgement.beside.system)], "a file")
    judgement.kept = dict.fromkeys((one.id for one in judgement.every), proof)
    hard = next(one for one in judgement.every if one.id == "EnableComesFromStage0")
    assert judgement._still(hard) is None
    assert judgement.one(hard.id).how != "a file"


def test_kept_formulas_of_other_memory_are_left_out(tmp_path: Path) -> None:
    system, path = judgement_of("sf_enable_switch", "letter", 20).beside.system, tmp_path / "kept.json"
    proofs = {"One": Proof(1, [false_invariant(system)], ""), "Two": Proof(1, [z3.Bool("gone")], "")}
    kept_proofs.write(path, kept_proofs.Kept(proofs, ("course",)))
    again = kept_proofs.read(path, system)
    assert [*again.proofs] == ["One"] and again.proofs["One"].lemmas[0].eq(false_invariant(system))
    assert again.places == ["course"]
    for text in ("", "[]", '{"places": [], "proofs": [{"id": "One", "scans": 99, "invariants": []}]}'):
        path.write_text(text)
        assert not kept_proofs.read(path, system).proofs


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

"""The demands of a document, proved of its own reference implementation and checked again by both solvers."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.places import root
from programs.certificates import inductive, kept_proofs
from programs.certificates.inductive import Claim
from programs.certificates.recheck import Answers, asked
from programs.demands.assumptions import Assumed
from programs.demands.observer import LATENCY
from programs.demands.reference_subject import Implementation
from programs.demands.register import demands_of
from programs.demands.verdicts import Found, Judgement
from programs.demands.watched import Beside
from programs.invariants.induction import Proof
from programs.semantics.reference import reference


@dataclass(frozen=True)
class Shown:
    """The verdict on each demand, and what both solvers say of the proofs."""

    found: Sequence[Found]
    answers: Answers

    @property
    def status(self) -> int:
        """0: all are proved, and checked again. 1: one is broken, or a proof is none. 2: neither."""
        words = {one.word for one in self.found}
        if "BROKEN" in words:
            return 1
        return self.answers.status if words == {"PROVED"} else 2


def judgement_of(
    target: str,
    profile: str,
    seconds: float,
    tell: Callable[[str], None] = lambda text: None,
    latency: int = LATENCY,
    left_out: Collection[str] = (),
) -> Judgement:
    """The reference implementation in a profile, with what is demanded of it, and the proofs that were kept.

    left_out: demands that are not asked. Raises Unjudged.
    """
    of = reference(target)
    demands = demands_of(of)
    beside = Beside(
        Implementation.in_profile(of, profile), demands, Assumed(of, {}, demands.constant), latency
    )
    beside.check()
    kept = kept_proofs.read(kept_proofs.place_of(root(), of.document, target, profile), beside.system)
    vectors = root() / "vectors" / target
    return Judgement(beside, vectors, seconds, tell, kept=kept.proofs, left_out=left_out, places=kept.places)


def shown(judgement: Judgement) -> Shown:
    """Judges all demands, and has z3 and cvc5 check each proof anew. Raises TimeoutError: one cannot be."""
    found = judgement.all()
    claims = [
        Claim(one.asked.id, one.asked.text, judgement.plainly_bad(one.asked), proof)
        for one, proof in proofs_of(judgement, found)
    ]
    return Shown(found, asked(Path(), list(inductive.obligations(judgement.beside.system, claims))))


def proofs_of(judgement: Judgement, found: Sequence[Found]) -> Iterator[tuple[Found, Proof]]:
    """Each demand that is proved, with its proof as it is kept. Raises TimeoutError: one cannot be."""
    for one in found:
        if one.proof is not None and one.proof is judgement.kept.get(one.asked.id):
            yield one, one.proof
        elif one.proof is not None:
            bad = judgement.plainly_bad(one.asked)
            yield one, inductive.kept(judgement.beside.system, bad, one.proof)


def lines_of(target: str, profile: str, found: Shown) -> Sequence[str]:
    """What came out, in lines."""
    counts: Mapping[str, int] = {
        word: sum(one.word == word for one in found.found) for word in ("PROVED", "BROKEN", "UNKNOWN")
    }
    said = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    open_ = [f"  {one.word}: {one.asked.id}: {one.how}" for one in found.found if one.word != "PROVED"]
    return [f"{target}, {profile}: {said} of {len(found.found)} demands", *open_, *found.answers.lines()]

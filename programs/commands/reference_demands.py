"""The demands of a document, proved of its own reference implementation and checked again by both solvers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.places import root
from programs.certificates import inductive
from programs.certificates.inductive import Claim
from programs.certificates.recheck import Answers, asked
from programs.demands.assumptions import Assumed
from programs.demands.observer import LATENCY
from programs.demands.reference_subject import Implementation
from programs.demands.register import demands_of
from programs.demands.verdicts import Found, Judgement
from programs.demands.watched import Beside
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
) -> Judgement:
    """The reference implementation in a profile, with what is demanded of it. Raises Unjudged."""
    of = reference(target)
    demands = demands_of(of)
    beside = Beside(
        Implementation.in_profile(of, profile), demands, Assumed(of, {}, demands.constant), latency
    )
    beside.check()
    return Judgement(beside, root() / "vectors" / target, seconds, tell)


def shown(judgement: Judgement) -> Shown:
    """Judges all demands, and has z3 and cvc5 check each proof anew. Raises TimeoutError: one cannot be."""
    found, system = judgement.all(), judgement.beside.system
    claims = []
    for one in found:
        if one.proof is not None:
            bad = judgement.plainly_bad(one.asked)
            claims.append(Claim(one.asked.id, one.asked.text, bad, inductive.kept(system, bad, one.proof)))
    return Shown(found, asked(Path(), list(inductive.obligations(system, claims))))


def lines_of(target: str, profile: str, found: Shown) -> Sequence[str]:
    """What came out, in lines."""
    counts: Mapping[str, int] = {
        word: sum(one.word == word for one in found.found) for word in ("PROVED", "BROKEN", "UNKNOWN")
    }
    said = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    open_ = [f"  {one.word}: {one.asked.id}: {one.how}" for one in found.found if one.word != "PROVED"]
    return [f"{target}, {profile}: {said} of {len(found.found)} demands", *open_, *found.answers.lines()]

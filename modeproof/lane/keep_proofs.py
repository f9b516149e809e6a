"""Searches for proofs of the demands on a reference, and keeps them.

    python -m modeproof.lane.keep_proofs [--seconds S] [--places NAME,NAME] TARGET ...

In each profile of the target; what was kept and still is a proof stays. Where a demand is about the course
of a procedure, --places names the memory that says where the procedure is (before.control,course), so that
an invariant is looked for place by place. Exit status: 0 all demands that the register asks to be proved are;
2 some are not.
"""

from __future__ import annotations

import argparse
import sys

from modeproof.ground.places import root
from modeproof.ground.solvers import needing_solvers
from modeproof.registers.demands import load_demand_rows
from modeproof.report.demanded import subjects

SECONDS = 120.0
"""CPU seconds for one demand."""


def main(arguments: list[str] | None = None) -> int:
    """Carry out the command."""
    parser = argparse.ArgumentParser(prog="python -m modeproof.lane.keep_proofs", description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="all if none is named")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of CPU time for one demand")
    parser.add_argument("--places", default="", metavar="NAMES", help="of memory, by which to split")
    args = parser.parse_args(arguments)
    with needing_solvers():
        from programs.semantics.reference import targets
    places = [name for name in args.places.split(",") if name]
    missing = 0
    for target in args.targets or sorted(targets()):
        document = targets()[target]
        left_out = load_demand_rows(root(), document).unproved.get(target, {})
        for name, profile in subjects(root(), document):
            if name == target:
                missing += keep(document, target, profile, args.seconds, [*left_out], places)
    return 2 if missing else 0


def keep(
    document: str, target: str, profile: str, seconds: float, left_out: list[str], places: list[str]
) -> int:
    """Search, and keep what was found; how many demands are not proved."""
    with needing_solvers():
        from programs.certificates import kept_proofs
        from programs.commands.reference_demands import judgement_of, proofs_of

    def tell(text: str) -> None:
        print(f"{target} {profile}: {text}", file=sys.stderr, flush=True)

    judgement = judgement_of(target, profile, seconds, tell, left_out=left_out)
    judgement.places = places or judgement.places
    found = judgement.all()
    proofs = {one.asked.id: proof for one, proof in proofs_of(judgement, found)}
    path = kept_proofs.place_of(root(), document, target, profile)
    kept_proofs.write(path, kept_proofs.Kept(proofs, judgement.places))
    for one in found:
        print(f"{target} {profile}: {one.asked.id}: {one.word}, {one.how}", flush=True)
    return sum(one.word != "PROVED" for one in found)


if __name__ == "__main__":
    sys.exit(main())

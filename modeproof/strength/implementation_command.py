"""The command `modeproof mutate impl`: mutants of the shipped code, judged by theorems."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.places import documents
from modeproof.strength.campaign import Judged
from modeproof.strength.command import chosen_of, report
from modeproof.strength.implementation import (
    Implementation,
    judge_implementation,
    register_path,
)
from modeproof.strength.mutant import Mutant, diff
from modeproof.strength.recorded import Record, record
from modeproof.strength.results import Results, read_results, results_path


def mutate_implementation(place: Path, args: argparse.Namespace) -> int:
    """List, show or judge. Raises Unjudged; exit status as of the command."""
    from modeproof.ground.proofs import code_under_proof
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.tlc.schedule import cores

    if str(place) not in sys.path:
        sys.path.insert(0, str(place))
    code = Implementation(place, document_of(place, args.document), code_under_proof())
    strange = sorted(set(args.modules) - {one.module for one in code.every})
    if strange:
        names = ", ".join(sorted({one.module for one in code.every}))
        raise Unjudged(f"{strange[0]} is none of the modules that a step reaches: {names}")
    chosen = chosen_of(code.every, args)
    results = read_results(results_path(place, code.document, args.what))
    if args.list:
        print("\n".join(str(one) for one in chosen))
        print(f"{len(chosen)} mutants")
        return 0
    if args.show is not None:
        return _show(code, chosen[0], results)
    with only_one(place):
        progress = Progress(quiet=args.quiet)
        judged = judge_implementation(code, chosen, results, progress, args.jobs or cores(), args.complete)
    if len(chosen) == len(code.every):
        keep(code, judged)
    register = str(register_path(place, code.document).relative_to(place))
    return report(code.register.explained, register, judged, len(chosen) == len(code.every), args)


def keep(code: Implementation, judged: Sequence[Judged]) -> None:
    """Write the evidence of the whole campaign."""
    campaign = Record(
        document=code.document,
        what="impl",
        command=f"modeproof mutate impl --document {code.document}",
        judges=tuple(code.code.theorems(code.document)),
        asked=lambda found: (answer["theorem"] for answer in found["answers"]),
        rests_on=[
            register_path(code.place, code.document),
            *(file for file, _ in code.reached.values()),
            *sorted((code.place / "proofs" / code.document).glob("*.py")),
        ],
        tools={"z3": evidence.tool(version("z3-solver"))},
    )
    record(code.place, campaign, code.every, judged, code.register.explained)


def document_of(place: Path, named: str | None) -> str:
    """The document whose code is judged. Raises Unjudged when it is not clear which one."""
    known = [name for name in documents(place) if register_path(place, name).is_file()]
    if named is not None and named not in known:
        raise Unjudged(f"document {named} has no proofs/{named}/strength.toml")
    if named is None and len(known) != 1:
        raise Unjudged(f"--document must name one of: {', '.join(known) or 'none has proofs'}")
    return named or known[0]


def _show(code: Implementation, mutant: Mutant, results: Results) -> int:
    print(mutant)
    print(diff(code.lines_of(mutant), mutant, "py"))
    found = code.find(results, mutant)
    if found is None:
        stale = bool(results.of(mutant.id))
        print("not judged" + (" since the code or the theorems changed" if stale else " yet"))
        return 0
    print(f"{found['verdict']}  {', '.join(found['killers'])}")
    for text in (found["reason"], found["witness"]):
        if text:
            print(f"    {text}")
    for answer in found["answers"]:
        where = f": {answer['where']}" if answer["where"] else ""
        print(f"    {answer['theorem']}: {answer['result']}{where}, {answer['seconds']} s")
    return 0

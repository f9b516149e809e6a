"""The command `modeproof mutate`: one campaign a document, or all documents one after the other."""

from __future__ import annotations

import argparse
import contextlib
import fnmatch
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_NOT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.lock import only_one
from modeproof.ground.places import chosen_documents, documents, root
from modeproof.ground.processes import cores
from modeproof.ground.progress import Progress
from modeproof.ground.solvers import needing_solvers
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.strength.campaign import (
    Campaign,
    Judged,
    explanation_problems,
    results_path,
    summary,
    unexplained,
)
from modeproof.strength.mutant import Mutant, diff
from modeproof.strength.refute import judge_refuting
from modeproof.strength.register import code_path, edited, load_strength, path_of
from modeproof.strength.results import read_results
from modeproof.tlc.killers import judge_killers
from modeproof.tlc.schedule import memory_mb
from modeproof.tlc.toolchain import find_toolchain

TLC_MB = 768
"""Memory that a run of TLC on a mutant needs."""


def add_parser(commands: Any) -> None:
    """Add `mutate` to the commands of modeproof."""
    parser = commands.add_parser("mutate")
    parser.add_argument(
        "what",
        choices=("spec", "impl"),
        help="the specification, judged by TLC; the code, by theorems or vectors",
    )
    parser.add_argument("modules", nargs="*", metavar="DEVICE", help="only these modules (default: all)")
    parser.add_argument("--document", metavar="NAME", help="only this document (default: all)")
    parser.add_argument("--list", action="store_true", help="list the mutants, judge none")
    parser.add_argument("--only", action="append", metavar="ID", help="only this mutant (or a pattern)")
    parser.add_argument("--show", metavar="ID", help="show the edit as a diff, and the judgement so far")
    parser.add_argument(
        "--complete", action="store_true", help="ask the costlier judges about killed mutants too"
    )
    parser.add_argument(
        "--first",
        action="store_true",
        help="explore a mutant of the specification to the first broken property: quicker, names no other",
    )
    parser.add_argument(
        "--killers",
        action="store_true",
        help="judge instead the edits that are to break each property (spec: killers.toml) or to refute each "
        "theorem (impl: strength.toml), where their stamps are of another text (--complete: all)",
    )
    parser.add_argument(
        "--judge",
        choices=("theorems", "vectors"),
        help="what judges mutants of the code: theorems (the default), or the published vectors alone",
    )
    parser.add_argument("--jobs", type=int, metavar="N", help="so many at once (default: one a core)")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=_mutate)


def _mutate(args: argparse.Namespace) -> int:
    place = root()
    if args.what == "spec" and args.judge is not None:
        raise Unjudged(
            "--judge speaks of the code; mutants of the specification are judged by its properties"
        )
    if str(place) not in sys.path:
        sys.path.insert(0, str(place))
    kind = "vectors" if args.judge == "vectors" else args.what
    if args.killers:
        return _killers(place, kind, args)
    named = _documents(place, kind, args.document)
    one_only = args.list or args.show or args.only or args.modules or args.json
    if one_only and len(named) > 1:
        raise Unjudged(f"--document must name one of: {', '.join(named)}")
    status = 0
    for document in named:
        try:
            status = max(status, _of_document(place, document, kind, args))
        except Unjudged as error:  # the other documents are judged all the same
            if len(named) == 1:
                raise
            print(f"{document}: {error.message}", file=sys.stderr)
            status = EXIT_UNJUDGED
    return status


def _killers(place: Path, kind: str, args: argparse.Namespace) -> int:
    """Judge the edits that are to break each property, or to refute each theorem."""
    if kind == "vectors":
        raise Unjudged("--killers asks properties (spec) or theorems (impl), and no vectors")
    chosen = chosen_documents(place, [args.document] if args.document else None)
    status = 0
    with only_one(place):
        tools = find_toolchain() if kind == "spec" else None
        for document in chosen:
            try:
                if tools is not None:
                    lost = [*judge_killers(place, document, tools, args.complete, print)]
                else:
                    with needing_solvers():
                        lost = judge_refuting(place, document, args.complete, print)
                    print("".join(f"{line}\n" for line in lost), end="")
                status = max(status, EXIT_NOT_AS_EXPECTED if lost else 0)
            except Unjudged as error:  # the other documents are judged all the same
                print(error.message, file=sys.stderr)
                status = EXIT_UNJUDGED
    return status


def _documents(place: Path, kind: str, named: str | None) -> list[str]:
    """The documents that have the register of a campaign. Raises Unjudged when there is none."""
    register = path_of if kind == "spec" else code_path
    known = [name for name in documents(place) if edited(place, register(place, name))]
    if named is not None and named not in known:
        raise Unjudged(f"{named!r} has no mutants; there are those of: {', '.join(known) or 'no document'}")
    if not known:
        raise Unjudged("no document has a strength.toml that says what is edited")
    return known if named is None else [named]


def _of_document(place: Path, document: str, kind: str, args: argparse.Namespace) -> int:
    reads = kind != "vectors" and (args.list or args.show is not None)  # vectors may have to be built
    with contextlib.nullcontext() if reads else only_one(place):
        campaign = campaign_of(place, document, kind, args.quiet, args.first)
        chosen = chosen_of(campaign, args)
        if args.list:
            print("\n".join(str(mutant) for mutant in chosen))
            more = campaign.judges.out_of_scope
            print(f"{len(chosen)} mutants" + (f", {more} more reach no published target" if more else ""))
            return 0
        if args.show is not None:
            return _show(campaign, chosen[0])
        jobs = args.jobs or (cores() if kind != "spec" else max(1, min(cores(), memory_mb() // TLC_MB)))
        judged = campaign.run(chosen, Progress(quiet=args.quiet), jobs, args.complete)
        whole = len(chosen) == len(campaign.mutants)
        if whole:
            campaign.record(judged)
    return _report(campaign, judged, whole, args)


def campaign_of(place: Path, document: str, kind: str, quiet: bool = True, first: bool = False) -> Campaign:
    """The campaign of a document: `kind` is spec, impl or vectors; `first` as Bench has it."""
    results = read_results(results_path(place, document, kind))
    if kind == "spec":
        from modeproof.strength.by_properties import ByProperties
        from modeproof.strength.mutant_judge import Bench

        bench = Bench(place, load_strength(place, document), find_toolchain(), first)
        return Campaign(ByProperties(bench), results)
    from modeproof.strength.by_theorems import ByTheorems
    from modeproof.strength.code import Code

    with needing_solvers():
        from proofs.mutants import bench as code_under_proof
    theorems = ByTheorems(Code(place, document, code_under_proof))
    if kind == "impl":
        return Campaign(theorems, results)
    from modeproof.strength.by_vectors import ByVectors
    from modeproof.strength.published import published
    from modeproof.suites.build import ready_suites

    names = theorems.code.register.suites
    try:
        suites = published(ready_suites(place, document, names, quiet))
    except KitUnjudged as error:
        raise Unjudged(str(error)) from None
    proved = read_results(results_path(place, document, "impl"))
    with needing_solvers():
        from proofs.mutants import copies, observed
    return Campaign(ByVectors(theorems, copies, observed, suites, proved), results)


def chosen_of(campaign: Campaign, args: argparse.Namespace) -> list[Mutant]:
    """The mutants that the arguments name. Raises Unjudged when one of them names none."""
    known = dict.fromkeys(mutant.module for mutant in campaign.mutants)
    strange = [name for name in args.modules if name not in known]
    if strange:
        raise Unjudged(f"{strange[0]} is not mutated; the mutated modules are {', '.join(known)}")
    chosen = [mutant for mutant in campaign.mutants if not args.modules or mutant.module in args.modules]
    patterns = [args.show] if args.show is not None else args.only
    for pattern in patterns or ():
        if not fnmatch.filter([mutant.id for mutant in chosen], pattern):
            raise Unjudged(
                f"no mutant has the id {pattern}; `modeproof mutate {args.what} --list` lists them"
            )
    if patterns:
        chosen = [mutant for mutant in chosen if any(fnmatch.fnmatchcase(mutant.id, p) for p in patterns)]
    left = {mutant.module for mutant in chosen}
    for name in args.modules:
        if name not in left:
            raise Unjudged(f"no mutant of {name} has the id {' or '.join(patterns or ())}")
    return chosen


def _show(campaign: Campaign, mutant: Mutant) -> int:
    print(mutant)
    print(diff(campaign.judges.lines_of(mutant), mutant, campaign.judges.suffix))
    found = campaign.find(mutant)
    if found is None:
        changed = bool(campaign.results.of(mutant.id))
        print("not judged" + (" since what the judgement rests on changed" if changed else " yet"))
        return 0
    print(f"{found['verdict']}  {', '.join(found['killers'])}")
    if found["reason"]:
        print(f"    {found['reason']}")
    print("\n".join(campaign.judges.shown(mutant, found)))
    return 0


def _report(campaign: Campaign, judged: Sequence[Judged], whole: bool, args: argparse.Namespace) -> int:
    """Print what is to be looked at and the counts, write the JSON, and give the exit status.

    whole: these are all mutants, so that an explanation of none of them is a problem of the register.
    """
    judges = campaign.judges
    problems = explanation_problems(judges.explained, judged, complete=whole)
    open_ones = unexplained(judges.explained, judged)
    for note in judges.notes:
        print(note)
    for judgement in judged:
        if judgement.word == "UNMEASURED" or judgement in open_ones or len(judged) <= 10:
            told = [text for text in (", ".join(judgement.killers), judgement.record["reason"]) if text]
            print("; ".join([f"{judgement.word}  {judgement.mutant}", *told]))
    for problem in problems:
        print(f"{judges.register.relative_to(judges.place).as_posix()}: {problem}")
    print(f"{judges.document}: {summary(judged, len(open_ones))}")
    unmeasured = any(judgement.word == "UNMEASURED" for judgement in judged)
    status = EXIT_NOT_AS_EXPECTED if open_ones or problems else EXIT_UNJUDGED if unmeasured else 0
    if args.json is not None:
        content = {
            "command": "mutate",
            "status": status,
            "mutants": [{**judgement.record, "edit": str(judgement.mutant)} for judgement in judged],
            "problems": problems,
        }
        write_whole(args.json, (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode("utf-8"))
    return status

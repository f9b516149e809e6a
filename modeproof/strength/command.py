"""The command `modeproof mutate`."""

from __future__ import annotations

import argparse
import fnmatch
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.errors import EXIT_NOT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.places import documents, root
from modeproof.strength.campaign import WORDS, Judged, Known, all_mutants, default_jobs, judge_all
from modeproof.strength.explain import explanation_problems, unexplained
from modeproof.strength.judge import Bench
from modeproof.strength.mutant import Mutant, diff
from modeproof.strength.recorded import Record, record
from modeproof.strength.register import Explained, load_strength, path_of
from modeproof.strength.results import Results, read_results, results_path


def add_parser(commands: Any) -> None:
    """Add `mutate` to the commands of modeproof."""
    text = "one-edit mutants of the specification or of the code, and what each of them breaks"
    parser = commands.add_parser("mutate", help=text, description=text[0].upper() + text[1:] + ".")
    parser.add_argument(
        "what",
        choices=("spec", "impl"),
        help="the specification, judged by TLC; the code, by theorems or vectors",
    )
    parser.add_argument("modules", nargs="*", metavar="DEVICE", help="only these modules (default: all)")
    parser.add_argument("--document", metavar="NAME", help="only this document")
    parser.add_argument("--list", action="store_true", help="list the mutants, judge none")
    parser.add_argument("--only", action="append", metavar="ID", help="only this mutant (or a pattern)")
    parser.add_argument("--show", metavar="ID", help="show the edit as a diff, and the judgement so far")
    parser.add_argument(
        "--complete", action="store_true", help="ask the costlier judges about killed mutants too"
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
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.tlc.toolchain import find_toolchain

    place = root()
    if args.what == "impl":
        from modeproof.strength.adequacy_command import mutate_by_vectors
        from modeproof.strength.implementation_command import mutate_implementation

        if args.judge == "vectors":
            return mutate_by_vectors(place, args)
        return mutate_implementation(place, args)
    if args.judge is not None:
        raise Unjudged(
            "--judge speaks of the code; mutants of the specification are judged by its properties"
        )
    document = _document(place, args.document)
    bench = Bench(place, load_strength(place, document), find_toolchain())
    strange = sorted(set(args.modules) - set(bench.strength.rules))
    if strange:
        raise Unjudged(
            f"{strange[0]} is none of the modules of strength.toml: {', '.join(bench.strength.rules)}"
        )
    every = all_mutants(bench)
    chosen = chosen_of(every, args)
    results = read_results(results_path(place, document, args.what))
    if args.list:
        print("\n".join(str(one) for one in chosen))
        print(f"{len(chosen)} mutants")
        return 0
    if args.show is not None:
        return _show(bench, chosen[0], results)
    with only_one(place):
        judged = judge_all(
            bench,
            chosen,
            results,
            Progress(quiet=args.quiet),
            args.jobs or default_jobs(place),
            args.complete,
        )
    whole = len(chosen) == len(every)
    if whole:
        keep(bench, every, judged)
    return _report(bench, judged, every if whole else (), args)


def keep(bench: Bench, every: Sequence[Mutant], judged: Sequence[Judged]) -> None:
    """Write the evidence of the whole campaign."""
    document, tools = bench.strength.document, bench.tools
    folder = bench.folder
    campaign = Record(
        document=document,
        what="spec",
        command=f"modeproof mutate spec --document {document}",
        judges=tuple(dict.fromkeys(name for tier in bench.strength.tiers for name in tier.run.properties)),
        asked=lambda found: (name for answer in found["answers"] for name in answer.get("asked", ())),
        rests_on=[
            path_of(bench.place, document),
            *(folder / f"{module}.tla" for module in bench.strength.rules),
            *(folder / tier.run.cfg for tier in bench.strength.tiers),
        ],
        tools={
            "tla2tools": {"version": "pinned" if tools.pinned else "not pinned", "sha256": tools.jar_sha256},
            "java": evidence.tool(tools.java_version, tools.java),
        },
    )
    record(bench.place, campaign, every, judged, bench.strength.explained)


def _document(place: Path, named: str | None) -> str:
    known = [name for name in documents(place) if path_of(place, name).is_file()]
    if named is not None:
        if named not in documents(place):
            raise Unjudged(f"no document {named!r} in spec/")
        return named
    if len(known) != 1:
        raise Unjudged(f"--document must name one of: {', '.join(known) or 'none has a strength.toml'}")
    return known[0]


def chosen_of(every: Sequence[Mutant], args: argparse.Namespace) -> list[Mutant]:
    """The mutants that the arguments name. Raises Unjudged when one of them names none."""
    patterns = [args.show] if args.show is not None else args.only
    chosen = [one for one in every if not args.modules or one.module in args.modules]
    if patterns:
        for pattern in patterns:
            if not fnmatch.filter([one.id for one in chosen], pattern):
                raise Unjudged(
                    f"no mutant has the id {pattern}; `modeproof mutate {args.what} --list` lists them"
                )
        chosen = [one for one in chosen if any(fnmatch.fnmatchcase(one.id, p) for p in patterns)]
    return chosen


def _show(bench: Bench, mutant: Mutant, results: Results) -> int:
    print(mutant)
    print(diff(bench.tree_of(mutant.module).texts[mutant.module], mutant))
    found = Known(bench, results).find(mutant)
    if found is None:
        stale = bool(results.of(mutant.id))
        print("not judged" + (" since the specification or the tiers changed" if stale else " yet"))
        return 0
    print(f"{found['verdict']}  {', '.join(found['killers'])}")
    if found["reason"]:
        print(f"    {found['reason']}")
    for answer in found["answers"]:
        broken = ", ".join(answer["broken"])
        print(
            f"    {answer['tier']}: {answer['result']}{': ' if broken else ''}{broken}, {answer['seconds']} s"
        )
    return 0


def _report(bench: Bench, judged: Sequence[Judged], every: Sequence[Mutant], args: argparse.Namespace) -> int:
    return report(bench.strength.explained, "strength.toml", judged, bool(every), args)


def report(
    explained: Sequence[Explained],
    register: str,
    judged: Sequence[Judged],
    complete: bool,
    args: argparse.Namespace,
) -> int:
    """Print what is to be looked at and the counts, write the JSON, and give the exit status.

    complete: these are all mutants, so that an explanation of none of them is a problem of the register.
    """
    problems = explanation_problems(explained, judged, complete=complete)
    open_ones = unexplained(explained, judged)
    for one in judged:
        if one.word == "UNMEASURED" or one in open_ones or len(judged) <= 10:
            killers = ", ".join(one.killers)
            why = one.record["reason"]
            print(f"{one.word}  {one.mutant}{f'; {killers}' if killers else ''}{f'; {why}' if why else ''}")
    for problem in problems:
        print(f"{register}: {problem}")
    print(summary(judged, len(open_ones)))
    unmeasured = [one for one in judged if one.word == "UNMEASURED"]
    status = EXIT_NOT_AS_EXPECTED if open_ones or problems else EXIT_UNJUDGED if unmeasured else 0
    if args.json is not None:
        from modeproof.evidence.files import write_whole

        content = {
            "command": "mutate",
            "status": status,
            "mutants": [{**one.record, "edit": str(one.mutant)} for one in judged],
            "problems": problems,
        }
        write_whole(args.json, (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode("utf-8"))
    return status


def summary(judged: Sequence[Judged], unexplained_count: int) -> str:
    """Counts and score in one line: killed of those that are neither invalid nor equivalent."""
    counts = Counter(one.word for one in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    score = f"{100 * counts['KILLED'] / real:.1f} %" if real else "none"
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS)
    return (
        f"{len(judged)} mutants: {words}; score {counts['KILLED']} of {real} ({score}); "
        f"{unexplained_count} unexplained"
    )

"""The command `modeproof mutate impl --judge vectors`: mutants of the code, judged by vectors alone."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from modeproof.errors import Unjudged
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import Suite
from modeproof.registers.load import load_interface
from modeproof.strength.adequacy import Adequacy, judge_by_vectors
from modeproof.strength.adequacy_register import read_register, register_path
from modeproof.strength.campaign import Judged
from modeproof.strength.command import chosen_of, report
from modeproof.strength.implementation import Implementation
from modeproof.strength.implementation_command import document_of
from modeproof.strength.mutant import Mutant, diff
from modeproof.strength.published import published
from modeproof.strength.recorded import Record, record
from modeproof.strength.register import Explained
from modeproof.strength.results import Results, read_results, results_path

RESULTS = "vectors"


def mutate_by_vectors(place: Path, args: argparse.Namespace) -> int:
    """List, show or judge. Raises Unjudged; exit status as of the command."""
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.tlc.schedule import cores

    if str(place) not in sys.path:
        sys.path.insert(0, str(place))
    document = document_of(place, args.document)
    with only_one(place):
        adequacy = adequacy_of(place, document, args.quiet)
        chosen = chosen_of(adequacy.every, args)
        results = read_results(results_path(place, document, RESULTS))
        if args.list:
            print("\n".join(str(one) for one in chosen))
            print(f"{len(chosen)} mutants, {len(adequacy.out_of_scope)} more reach no published target")
            return 0
        if args.show is not None:
            return _show(adequacy, chosen[0], results)
        progress = Progress(quiet=args.quiet)
        judged = judge_by_vectors(adequacy, chosen, results, progress, args.jobs or cores(), args.complete)
    print(f"suites: {', '.join(adequacy.names)}; targets: {', '.join(adequacy.targets)}")
    print(f"{len(adequacy.out_of_scope)} mutants more reach no published target and are out of scope")
    register = register_path(place, document).relative_to(place).as_posix()
    whole = len(judged) == len(adequacy.every)
    if whole:
        keep(adequacy, judged, read_register(place, document).explained)
    return report(read_register(place, document).explained, register, judged, whole, args)


def keep(adequacy: Adequacy, judged: Sequence[Judged], explained: Sequence[Explained]) -> None:
    """Write the evidence of the whole campaign."""
    document = adequacy.code.document
    register = register_path(adequacy.place, document)
    campaign = Record(
        document=document,
        what="vectors",
        command=f"modeproof mutate impl --judge vectors --document {document}",
        judges=adequacy.names,
        asked=lambda found: (answer["suite"] for answer in found["answers"]),
        rests_on=[
            *([register] if register.is_file() else []),
            *(file for file, _ in adequacy.code.reached.values()),
            *(one.suite.path for one in adequacy.suites),
        ],
        tools={},
        out_of_scope=len(adequacy.out_of_scope),
    )
    record(adequacy.place, campaign, adequacy.every, judged, explained)


def adequacy_of(place: Path, document: str, quiet: bool = True) -> Adequacy:
    """The mutants, and every suite of every published target; suites are built when missing."""
    from modeproof.ground.proofs import code_under_proof, copies_of_code, observer_of_code

    code = Implementation(place, document, code_under_proof())
    try:
        suites = published(_suites(place, document, quiet))
    except KitUnjudged as error:
        raise Unjudged(str(error)) from None
    proved = read_results(results_path(place, document, "impl"))
    return Adequacy(code, copies_of_code(), observer_of_code(), suites, proved)


def _suites(place: Path, document: str, quiet: bool) -> Sequence[Suite]:
    from modeproof.graph.device import open_runs
    from modeproof.suites.command import make_graphs
    from modeproof.suites.write import SUITES

    chosen = read_register(place, document).suites or tuple(SUITES)
    strange = [name for name in chosen if name not in SUITES]
    if strange:
        raise Unjudged(f"{register_path(place, document).name}: no suite {strange[0]!r}")
    found = []
    for target, device in load_interface(place, document).devices.items():
        runs = open_runs(place, document, target)
        if device.published and runs:
            make_graphs(place, runs, quiet)
            every = (_suite(place, document, target, name) for name in chosen)
            found += [one for one in every if one is not None]
    if not found:
        raise Unjudged(f"{document}: no published target has vectors")
    return found


def _suite(place: Path, document: str, target: str, name: str) -> Suite | None:
    """The suite; None where the target has no cases of its kind, such as times or declared sequences."""
    from modeproof.suites.build import ready_suite
    from modeproof.suites.write import NoCases

    try:
        return ready_suite(place, document, target, name, _say)
    except NoCases:
        return None


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _show(adequacy: Adequacy, mutant: Mutant, results: Results) -> int:
    print(mutant)
    print(diff(adequacy.code.lines_of(mutant), mutant, "py"))
    answers = adequacy.answers(results, mutant)
    for one in answers:
        where = f"{one['case']}, scan {one['scan']}: {one['detail']}" if one["case"] else one["detail"]
        print(
            f"    {one['suite']} {one['target']}: {one['result']} after {one['scans']:,} scans"
            f"{'; ' + where if where else ''}"
        )
    said = adequacy.observed(results, mutant)
    if said is not None:
        print(f"    observer: {said['verdict']}  {said['witness'] or said['reason']}")
    judged = adequacy.judged(results, mutant)
    print(f"{judged.word}  {', '.join(judged.killers)}" if judged else "not judged yet for this code")
    proved = adequacy.theorems_say(mutant)
    if proved is not None:
        print(f"by theorems: {proved['verdict']}  {', '.join(proved['killers'])}")
        if proved["witness"]:
            print(f"    {proved['witness']}")
    return 0

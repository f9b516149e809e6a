"""The command `conform` with everything at hand: graphs, suites built when missing, built-in programs."""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from modeproof.graph.device import compared_files, load_device_graph, open_runs
from modeproof.graph.equal import Comparison, Difference, compare
from modeproof.graph.implementation import REFERENCE, load_implementation
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.lock import only_one
from modeproof.ground.places import root
from modeproof.ground.progress import Progress
from modeproof.kit import command as kit_command
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.judge import EXIT
from modeproof.kit.text import as_record, joint_word, write_json
from modeproof.kit.vectors import EXACT, SETTLED, Suite, open_suite
from modeproof.registers.runs import Run
from modeproof.registers.vector_files import published
from modeproof.suites.build import find_target, make_graphs, ready_suite, say
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import NoCases


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `conform` to the commands."""
    return kit_command.add_parser(commands, run=run)


def run(args: argparse.Namespace) -> int:
    """Run `conform`; the exit status is that of the verdict."""
    try:
        if args.builtin is not None and args.suite is None and args.vectors is None:
            return _builtin(args)
        return _program(args)
    except KitUnjudged as error:
        raise Unjudged(str(error)) from None


# ----------------------------------------------------------------------------------------------- adapter


def _program(args: argparse.Namespace) -> int:
    place = root()
    document, device = find_target(place, args.target, args.document)
    if not device.published and args.builtin is None:
        raise Unjudged(f"{args.target} is not a published target; --builtin compares our own code")
    if args.vectors is not None:
        if args.suite:
            raise Unjudged("--vectors names one file, and --suite others: give one of them")
        suites = [kit_command.open_vectors(args)]
    else:
        with only_one(place):
            suites = _suites(place, document, args)
    started = time.time()
    verdicts = kit_command.judge(args, suites)
    for suite, verdict in zip(suites, verdicts, strict=False):  # an interrupted run has fewer
        if args.case is not None or args.vectors is not None or args.adapter is None or args.param:
            continue
        manner = [] if args.relation == EXACT else [args.relation]
        record = evidence.make(
            kind="conformance",
            id="_".join(["adapter", args.target, suite.name, *manner]),
            document=document,
            verdict=verdict.word,
            expected="CONFORMS",
            as_expected=verdict.status == 0,
            strength=f"relation {verdict.relation}, suite {verdict.suite}: {verdict.scans:,} scans",
            command=f"modeproof conform {args.target} --adapter {kit_command.quoted(args.adapter)}",
            started=started,
            seconds=verdict.seconds,
            inputs=evidence.hashes(place, [suite.path]),
            result={**as_record(verdict), "says": suite.says},
            reason="" if verdict.status == 0 else verdict.reason or "the program differs",
        )
        evidence.write(place, record)
    return EXIT[joint_word(verdicts)]


def _suites(place: Path, document: str, args: argparse.Namespace) -> list[Suite]:
    """The suites asked for, made where none is published or it is of another text. Raises Unjudged.

    One that was not named itself is left out where the target has no cases of its kind.
    """
    found = []
    for name in chosen_suites(args.suite, args.relation):
        if path := published(place, args.target, name):
            found.append(open_suite(path))
            continue
        try:
            make_graphs(place, open_runs(place, document, args.target), args.quiet)
            found.append(ready_suite(place, document, args.target, name, say))
        except NoCases:
            if name in (args.suite or ()):
                raise
    if not found:
        raise Unjudged(f"no suite of {args.target} is for relation {args.relation}")
    return found


def chosen_suites(names: list[str] | None, relation: str) -> list[str]:
    """The suites asked for; by default `tour`, or those that are made for the relation."""
    if names is None:
        if relation == EXACT:
            return ["tour"]
        return [name for name, kind in SUITES.items() if SETTLED in kind.relations]
    chosen: list[str] = []
    for name in names:
        every = [suite for suite, kind in SUITES.items() if kind.fast and relation in kind.relations]
        chosen += every if name == kit_command.FAST else [name]
    return list(dict.fromkeys(chosen))


# ----------------------------------------------------------------------------------------------- builtin


def _builtin(args: argparse.Namespace) -> int:
    place = root()
    document, device = find_target(place, args.target, args.document)
    runs = open_runs(place, document, args.target)
    if not runs:
        raise Unjudged(f"{document}: no OPEN run prints a graph of {args.target}")
    if args.case is not None or args.param or args.relation != EXACT:
        raise Unjudged(
            "--case, --param and --relation need --suite or --vectors; --builtin alone is exact, and whole"
        )
    code = load_implementation(args.builtin, document, device.id)
    progress = Progress(quiet=args.quiet)
    found: list[tuple[Run, Comparison]] = []
    with only_one(place):
        make_graphs(place, runs, args.quiet)
        for kit_run in runs:
            codes = args.codes or args.builtin == REFERENCE  # of our own code every output
            found.append((kit_run, _compare(place, kit_run, code, args.builtin, progress, codes)))
    for kit_run, result in found:
        print(_text(kit_run, result))
    status = max(0 if result.equal else 1 for _, result in found)
    if args.json is not None:
        rows = [{"run": kit_run.id, "verdict": result.verdict, **asdict(result)} for kit_run, result in found]
        write_json(args.json, {"command": "conform", "status": status, "builtin": args.builtin, "runs": rows})
    return status


def _compare(place: Path, run: Run, code: Any, builtin: str, progress: Progress, codes: bool) -> Comparison:
    name = f"{builtin}_{run.id}"
    evidence.discard(place, run.document, name)
    started = time.time()
    progress.begin(name)
    try:
        graph = load_device_graph(place, run)
        found = compare(
            graph,
            code,
            lambda done, total: progress.update(name, f"{done:,} of {total:,} transitions"),
            codes=codes,
        )
    finally:
        progress.end(name)
    record = evidence.make(
        kind="conformance",
        id=name,
        document=run.document,
        verdict=found.verdict,
        expected="EQUAL",
        as_expected=found.equal,
        environment=run.environment,
        strength=f"{found.states:,} states, {found.transitions:,} transitions, both ways, in process",
        command=f"modeproof conform {graph.device.id} --builtin {builtin} --document {run.document}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, compared_files(place, run, builtin)),
        result={"run": run.id, "device": graph.device.id, "implementation": builtin, **asdict(found)},
        reason="" if found.equal else found.summary(),
    )
    evidence.write(place, record)
    return found


def _text(run: Run, found: Comparison) -> str:
    lines = [f"{run.name} and {found.implementation}"]
    width = max(len(step) for step in found.covered)
    for step, (have, total) in found.covered.items():
        lines.append(f"  {step:<{width}} {have:>10,} / {total:,}")
    for name, members in found.classes.items():
        lines.append(f"  class {name}: {members} other members tried at every step of every state")
    lines.append(
        f"  {found.scans:,} scans, {found.class_scans:,} more with other members of classes; "
        f"{found.implementation_states:,} states of the implementation"
    )
    for difference in found.differences[:1]:
        lines += _shown(difference)
    lines.append(found.summary())
    return "\n".join(lines)


def _shown(difference: Difference) -> list[str]:
    lines = [f"  first difference: {difference}", "  shortest inputs from power-up:"]
    before: Mapping[str, Any] = {}
    for n, scan in enumerate(difference.scans, 1):
        changed = {name: value for name, value in scan.items() if n == 1 or before[name] != value}
        lines.append(f"    scan {n}: " + ", ".join(f"{name}={value}" for name, value in changed.items()))
        before = scan
    return lines

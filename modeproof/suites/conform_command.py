"""The command `conform` with everything at hand: graphs, suites built when missing, built-in programs."""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.graph.device import COMPARED_BY, open_runs
from modeproof.graph.implementation import REFERENCE
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.lock import only_one
from modeproof.ground.meaning import reached
from modeproof.ground.places import build, root
from modeproof.kit import again, kit_command
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.profile import ALL, LETTER
from modeproof.kit.text import as_record
from modeproof.kit.vectors import EXACT, SETTLED, WIRING, Suite, open_suite
from modeproof.kit.verdict import Verdict
from modeproof.output.options import Clock, add_options, carried_out
from modeproof.output.outcome import Outcome
from modeproof.registers.rows import Device
from modeproof.registers.stale import stale
from modeproof.registers.vector_files import of_machine, published, published_files, suite_name, why_stale
from modeproof.suites.build import (
    current_suite,
    document_readings,
    document_texts,
    find_target,
    make_graphs,
    ready_suite,
    say,
)
from modeproof.suites.builtin_comparison import run_builtin
from modeproof.suites.conform_outcome import about, outcome_of
from modeproof.suites.demands import load_demands
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import NoCases
from modeproof.tlc.toolchain import find_toolchain


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `conform` to the commands."""
    parser = kit_command.add_parser(commands, run=run)
    add_options(parser, judge, about)
    return parser


def run(args: argparse.Namespace) -> int:
    """Run `conform`; the exit status is that of the verdict."""
    alone = args.builtin is not None and args.suite is None and args.vectors is None
    if alone and not of_machines(root(), args.target):
        if args.record is not None:
            raise Unjudged("--record has no effect with --builtin alone, which compares our own code")
        return run_builtin(args)
    return carried_out(args).status


def judge(args: argparse.Namespace) -> Outcome:
    """Judge a program by suites, print the verdicts, and return what was found. Raises Unjudged."""
    clock = Clock()
    try:
        if suites := machine_suites(root(), args):
            suites = kit_command.in_profile(args, suites)
            return outcome_of(args, suites, kit_command.judge(args, suites), clock)
        return outcome_of(args, *_program(args), clock)
    except KitUnjudged as error:
        raise Unjudged(str(error)) from None


# ----------------------------------------------------------------------------------------------- adapter


def _program(args: argparse.Namespace) -> tuple[list[Suite], list[Verdict]]:
    place = root()
    document, device = find_target(place, args.target, args.document)
    if not device.published and args.builtin is None:
        raise Unjudged(f"{args.target} is not a published target; --builtin compares our own code")
    if args.vectors is not None:
        if args.suite:
            raise Unjudged("--vectors names one file, and --suite others: give one of them")
        suites = kit_command.open_vectors(args)
    else:
        suites = _suites(place, document, device, args)
    table = load_demands(place, document, device)
    texts = document_texts(place, document) if table is not None else {}
    readings = document_readings(place, document)
    suites = [suite.demanding(table, texts, readings) for suite in kit_command.in_profile(args, suites)]
    ours = _is_ours(args)
    if ours:  # by this Python, whatever `python` is here
        args.adapter = " ".join(map(again.quoted, [sys.executable, str(place / OWN), args.target]))
    started = time.time()
    verdicts = kit_command.judge(args, suites)
    for suite, verdict in zip(suites, verdicts, strict=False):  # an interrupted run has fewer
        whole = args.case is None and args.vectors is None and not args.param and not verdict.interrupted
        if args.adapter is None or not whole or not verdict.adapter:
            continue
        if ours and suite.name in OWN_SUITES.values():
            record = own_record(place, document, suite, verdict, started)
            evidence.write(place, record)
        else:
            _write_yours(place, document, args, suite, verdict, started)
    return suites, verdicts


OWN = "examples/adapters/refimpl_adapter.py"
"""The adapter of the reference implementation."""
OWN_SUITES = {"smoke": "brief", "full": "brief", "exhaustive": "tour"}
"""The suite that it runs through in each lane."""


def _is_ours(args: argparse.Namespace) -> bool:
    """Whether the arguments are those of a run that `verify` makes, so that it is made again."""
    usual = (args.relation, args.latency, args.hold, args.slow) == (EXACT, None, 0, 1)
    usual = usual and bool(args.codes) and bool(args.same) and args.profile == ALL
    return usual and args.adapter == f"python {OWN} {args.target}"


def own_id(target: str, suite: str) -> str:
    """The name of the evidence of the reference implementation behind the adapter protocol."""
    return f"adapter_{target}_{suite}"


def own_rests(place: Path, document: str, target: str, suite: str) -> evidence.Rests:
    """What that rests on. Raises Unjudged when the suite has to be made before."""
    path = published(place, target, suite) or current_suite(place, document, target, suite)
    if path is None:
        raise Unjudged(f"the suite {suite} of {target} has to be made")
    return evidence.Rests(_own_inputs(place, document, target, path), COMPARED_BY)


def _own_inputs(place: Path, document: str, target: str, suite: Path) -> dict[str, str]:
    code = reached(place, OWN, f"{REFERENCE}/{document}/{target}.py")
    registers = [place / "spec" / document / name for name in ("interface.toml", "demands.toml")]
    return evidence.hashes(place, [*code, *(path for path in registers if path.is_file()), suite])


def own_record(place: Path, document: str, suite: Suite, verdict: Verdict, started: float) -> dict[str, Any]:
    """The evidence of the reference implementation behind the adapter protocol."""
    about = {"device": suite.target, "implementation": REFERENCE}
    adapter = again.quoted(f"python {OWN} {suite.target}")
    asked = f"--suite {suite.name} --codes --same --profile {ALL}"
    command = f"modeproof conform {suite.target} --adapter {adapter} {asked}"
    id = own_id(suite.target, suite.name)
    inputs = _own_inputs(place, document, suite.target, suite.path)
    return _record(place, document, suite, verdict, id, command, started, inputs, about)


def _write_yours(
    place: Path, document: str, args: argparse.Namespace, suite: Suite, verdict: Verdict, started: float
) -> None:
    """The evidence of a user's program: in a place of its own, under its own name."""
    name = re.sub(r"[^A-Za-z0-9.-]+", "-", args.name or verdict.adapter).strip("-.") or "program"
    manner = [] if args.relation == EXACT else [args.relation]
    profile = [] if args.profile in (None, LETTER) else [args.profile]
    command = " ".join(
        [
            f"modeproof conform {args.target} --adapter {again.quoted(args.adapter)}",
            f"--suite {suite.name}",
            *([f"--relation {args.relation}"] if manner else []),
            *([f"--latency {args.latency}"] if args.latency is not None else []),
            *([f"--hold {args.hold}"] if args.hold else []),
            *([f"--slow {args.slow}"] if args.slow != 1 else []),
            *(["--codes"] if args.codes else []),
            *(["--same"] if args.same else []),
            *(["--flips"] if args.flips else []),
            *(f"--profile {name}" for name in profile),
        ]
    )
    id = "_".join([name[:60], args.target, suite.name, *manner, *profile])
    inputs = evidence.hashes(place, [suite.path])
    record = _record(place, document, suite, verdict, id, command, started, inputs, {"name": name})
    evidence.write(place, record, evidence.YOURS)
    say(f"kept as {build(place).name}/{evidence.YOURS}/{document}/{id}.json; `modeproof report` shows it")


def _record(
    place: Path,
    document: str,
    suite: Suite,
    verdict: Verdict,
    id: str,
    command: str,
    started: float,
    inputs: Mapping[str, str],
    about: Mapping[str, Any],
) -> dict[str, Any]:
    done, total = verdict.transitions
    of_profile = f", profile {verdict.profile}" if verdict.profile else ""
    return evidence.make(
        kind="conformance",
        id=id,
        document=document,
        verdict=verdict.word,
        expected="CONFORMS",
        as_expected=verdict.status == 0,
        strength=f"relation {verdict.relation}, suite {verdict.suite}{of_profile} over the adapter protocol: "
        f"{verdict.scans:,} scans, {done:,} of {total:,} merged transitions",
        command=command,
        started=started,
        seconds=verdict.seconds,
        inputs=inputs,
        code=COMPARED_BY,
        place=place,
        result={**about, **as_record(verdict), "says": suite.says},
        reason="" if verdict.status == 0 else verdict.reason,
    )


def of_machines(place: Path, target: str) -> list[Path]:
    """The published suites of a whole machine; none: the target is none."""
    return [path for path in published_files(place, target) if of_machine(path)]


def machine_suites(place: Path, args: argparse.Namespace) -> list[Suite]:
    """The suites asked for, if the target is a whole machine: it has vectors and no register.

    Raises Unjudged where they are of another text.
    """
    if args.vectors is not None:
        suites = kit_command.open_vectors(args)
        return suites if all(WIRING in suite.header for suite in suites) else []
    files = of_machines(place, args.target)
    names = [suite_name(path) for path in files]
    asked = [name for name in args.suite or () if name != kit_command.FAST]
    if files and (strange := [name for name in asked if name not in names]):
        raise Unjudged(f"no suite {strange[0]!r}; {suggestion(strange[0], [kit_command.FAST, *names])}")
    chosen = [path for path, name in zip(files, names, strict=True) if not asked or name in asked]
    for path in chosen:
        if published(place, args.target, suite_name(path)) is None:
            what = why_stale(place, args.target) or f"{path.relative_to(place)} is not as it was published"
            raise Unjudged(stale(what, args.target))
    found = [open_suite(path) for path in chosen]
    if chosen and not (found := [suite for suite in found if args.relation in suite.relations]):
        raise Unjudged(f"no suite of {args.target} is for relation {args.relation}")
    return found


def _suites(place: Path, document: str, device: Device, args: argparse.Namespace) -> list[Suite]:
    """The suites asked for, made where none is published or it is of another text. Raises Unjudged.

    One that was not named itself is left out where the target has no cases of its kind, or where TLC, which
    would have to make it, is not installed and others are there. The program is greeted before one is made:
    that takes long.
    """
    names = chosen_suites(args.suite, args.relation)
    if strange := [name for name in names if name not in SUITES]:
        raise Unjudged(f"no suite {strange[0]!r}; {suggestion(strange[0], [kit_command.FAST, *SUITES])}")
    found: list[Suite] = []
    greeted = False
    there = {name: path for name in names if (path := published(place, args.target, name)) is not None}
    missing = [name for name in names if name not in there]
    if missing and (why := _no_tlc()):
        if not there or set(missing) & set(args.suite or ()):
            ready = ", ".join(name for name in SUITES if published(place, args.target, name))
            raise Unjudged(
                f"the suite {missing[0]} has to be made, and {why}; --suite NAME of {ready} needs none"
            )
        say(f"left out, for TLC would have to make what there is of them: {', '.join(missing)}")
        names = list(there)
    for name in names:
        if name in there:
            found.append(open_suite(there[name]))
            continue
        if not greeted:
            kit_command.greet(args, device.outputs)
            greeted = True
        try:
            with only_one(place, wait_for="this run"):
                make_graphs(place, open_runs(place, document, args.target), args.quiet)
                found.append(ready_suite(place, document, args.target, name, say))
        except NoCases:
            if name in (args.suite or ()):
                raise
    if not found:
        raise Unjudged(f"no suite of {args.target} is for relation {args.relation}")
    return found


def _no_tlc() -> str:
    """Why TLC cannot be run, if so."""
    try:
        find_toolchain()
    except Unjudged as error:
        return error.message
    return ""


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

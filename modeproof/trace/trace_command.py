"""The command `trace`: is a recorded log a run of the specification?"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.lock import only_one
from modeproof.ground.places import root
from modeproof.kit.errors import plain
from modeproof.output.options import Clock, add_options, carried_out
from modeproof.output.outcome import Outcome
from modeproof.registers.runs import Run
from modeproof.suites.build import make_graphs
from modeproof.tlc.process import Outcome as Ended
from modeproof.tlc.rests import why_stale
from modeproof.tlc.start_up import entries
from modeproof.tlc.toolchain import Toolchain, find_toolchain
from modeproof.trace import machine_log as machine
from modeproof.trace.by_reference import judge_by_reference
from modeproof.trace.exact import Scans
from modeproof.trace.lines import read_lines
from modeproof.trace.log import Log, without_codes
from modeproof.trace.log_judge import Graphs, Judgement, judge_logs, why_not
from modeproof.trace.outcomes import about, outcome_of
from modeproof.trace.table import TableForm, read_table, wire_param
from modeproof.trace.targets import Target, find_target, rather_of
from modeproof.trace.text import as_json, as_record, as_text
from modeproof.trace.why import Why

_SCANS = re.compile(r"(\d{1,6})(?:-(\d{1,6}))?")
_DESCRIPTION = """Is a recorded log a run of the specification? CONFORMS: every line is a scan (or a sample)
that the specification allows; DIFFERS: a line is impossible, and it is shown with the conjunct that failed.
The log is followed through the graph of the device and judged again by TLC with the log's own parameters,
times in ms and words; TLC's judgement is the exact one. A log shows one run: nothing is said about what the
machine would do otherwise."""


def add_parser(commands: Any) -> None:
    """Add `trace` to the commands."""
    parser = commands.add_parser(
        "trace",
        description=_DESCRIPTION,
        epilog="exit status: 0 CONFORMS, 1 DIFFERS, 2 could not be judged",
    )
    parser.add_argument("target", metavar="TARGET", help="a device, or the system; see spec/*/replay.toml")
    parser.add_argument("log", metavar="LOG", type=Path, help="JSON Lines, or a table that ends in .csv")
    parser.add_argument("--document", metavar="NAME", help="the document, where two have this target")
    parser.add_argument(
        "--from",
        dest="begins",
        choices=("power-up", "anywhere"),
        default="power-up",
        help="the state before the first line (default: power-up)",
    )
    parser.add_argument(
        "--samples",
        type=scan_times,
        metavar="MS[-MS]",
        help="a line is a sample of a program that scans so often: every 10 ms, or every 8-12 ms",
    )
    parser.add_argument(
        "--param", action="append", default=[], metavar="NAME=VALUE", help="a parameter of the machine"
    )
    parser.add_argument(
        "--format", choices=("lines", "table"), help="JSON Lines or table (default: by the name of the file)"
    )
    parser.add_argument("--separator", default="", metavar="CHAR", help="of a table (default: guessed)")
    parser.add_argument("--decimal-words", action="store_true", help="words of a table are decimal")
    parser.add_argument("--time", default="", metavar="COLUMN", help="of a table: ms since any moment")
    parser.add_argument("--ignore", action="append", default=[], metavar="COLUMN", help="of a table")
    parser.add_argument(
        "--codes", action="store_true", help="compare outputs too whose values the document does not give"
    )
    parser.add_argument(
        "--wiring", metavar="FILE", type=Path, help="of a whole machine: yours, not the shipped one"
    )
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    add_options(parser, judge, about)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run `trace`; the exit status is that of the verdict."""
    return carried_out(args).status


def judge(args: argparse.Namespace) -> Outcome:
    """Judge a log, print the verdict, and return what was found. Raises Unjudged."""
    place, clock = root(), Clock()
    if machine.is_machine(place, args.target):
        return machine.judge(args, place, read_log, clock)
    if args.wiring is not None:
        raise Unjudged(f"--wiring is for a whole machine, and {args.target} is none")
    target = find_target(place, args.target, args.document)
    try:
        log = read_log(args, target)
    except Unjudged as error:
        raise Unjudged(error.message + rather_of(place, target, args.log)) from None
    if not args.codes:
        log = without_codes(log, target)
    try:
        tools = find_toolchain()
    except Unjudged as missing:
        return _by_reference(place, args, target, log, clock, missing)
    id = _id(args, target)
    evidence.discard(place, target.document, id, evidence.YOURS)
    started = time.time()
    graphs = Graphs(place, partial(_make_graphs, place, args.quiet))
    if not args.quiet:
        print(f"TLC reads {len(log.rows):,} lines", file=sys.stderr, flush=True)
    try:
        (found,), outcome = judge_logs(
            place,
            target,
            [log],
            graphs,
            tools,
            anywhere=args.begins == "anywhere",
            samples=args.samples,
            say=lambda line: None if args.quiet else print(plain(line), file=sys.stderr, flush=True),
        )
    except Unjudged as error:
        _write(place, args, target, log, id, started, tools, graphs.used, error.message)
        raise
    why: Why | None = None
    unsaid = ""
    if args.samples is None:
        try:
            why = why_not(place, target, found, graphs, tools, anywhere=args.begins == "anywhere")
        except Unjudged as error:  # the verdict stands all the same
            unsaid = error.message
    text = as_text(target, found, why, args.samples)
    print(text)
    if unsaid:
        print(f"modeproof: no explanation: {unsaid}", file=sys.stderr)
    record = _write(place, args, target, log, id, started, tools, graphs.used, found, outcome, why)
    if args.json is not None:
        write_whole(args.json, as_json("trace", found.status, record))
    return outcome_of(args, target, found, why, record, text, clock)


def _id(args: argparse.Namespace, target: Target) -> str:
    return f"trace_{target.id}_{re.sub(r'[^A-Za-z0-9_.-]', '_', args.log.stem)}"


def _by_reference(
    place: Path, args: argparse.Namespace, target: Target, log: Log, clock: Clock, missing: Unjudged
) -> Outcome:
    """The same without TLC, as far as that goes. Raises Unjudged."""
    if target.system or args.samples is not None or args.begins == "anywhere":
        raise Unjudged(f"{missing.message}; without it a log of one device from power-up can be judged")
    id, started = _id(args, target), time.time()
    evidence.discard(place, target.document, id, evidence.YOURS)
    found, why = judge_by_reference(target, log)
    text = as_text(target, found, why)
    print(text)
    record = _write(place, args, target, log, id, started, None, [], found, why=why)
    if args.json is not None:
        write_whole(args.json, as_json("trace", found.status, record))
    return outcome_of(args, target, found, why, record, text, clock)


def _make_graphs(place: Path, quiet: bool, runs: Sequence[Run]) -> None:
    """Have what is missing made; a run that makes it already is waited for."""
    if any(why_stale(place, run) for run in runs):
        with only_one(place, wait_for="this log"):
            make_graphs(place, runs, quiet)


def scan_times(text: str) -> Scans:
    """The times of a scan, MS or MS-MS. Raises argparse's error for anything else."""
    match = _SCANS.fullmatch(text)
    shortest = int(match.group(1)) if match else 0
    longest = int(match.group(2) or shortest) if match else 0
    if not 1 <= shortest <= longest:
        raise argparse.ArgumentTypeError("ms from 1 expected, such as 10 or 8-12")
    return Scans(shortest, longest)


def read_log(args: argparse.Namespace, target: Target) -> Log:
    """The log that the arguments name. Raises Unjudged for whatever in it cannot be right."""
    params: dict[str, Any] = {}
    for given in args.param:
        name, equals, text = given.partition("=")
        if not equals:
            raise Unjudged(f"--param {given}: NAME=VALUE was expected")
        inner = name.rpartition(".")[2]
        signals = [
            part.device.parameters[inner] for part in target.parts.values() if inner in part.device.parameters
        ]
        value = wire_param(signals[0], text) if signals else text
        if params.setdefault(name, value) != value:
            raise Unjudged(f"--param {name} is given twice, with different values")
    table = args.format == "table" or (args.format is None and args.log.suffix.lower() == ".csv")
    if not table:
        return read_lines(args.log, target, params)
    if len(args.separator) > 1:
        raise Unjudged(f"--separator {args.separator}: one character was expected")
    form = TableForm(args.decimal_words, args.separator, args.time, frozenset(args.ignore))
    return read_table(args.log, target, params, form)


def _write(
    place: Path,
    args: argparse.Namespace,
    target: Target,
    log: Log,
    id: str,
    started: float,
    tools: Toolchain | None,
    graphs: Sequence[Path],
    found: Judgement | str,
    outcome: Ended | None = None,
    why: Why | None = None,
) -> dict[str, Any]:
    folder = place / "spec" / target.document
    registers = [folder / f"{name}.toml" for name in ("interface", "replay", "runs")]
    inputs = [*registers, *sorted(folder.glob("*.tla")), *graphs]
    record = evidence.make(
        kind="trace",
        id=id,
        document=target.document,
        verdict="UNJUDGED" if isinstance(found, str) else found.verdict,
        expected="CONFORMS",
        as_expected=not isinstance(found, str) and found.status == 0,
        environment="as the log",
        strength=f"one log of {len(log.rows):,} lines",
        command=about(args).again,
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, [path for path in inputs if path.is_file()]),
        tools={} if tools is None else entries(tools, outcome.log.version if outcome is not None else ""),
        result={
            "target": target.id,
            "log": {"name": args.log.name, "sha256": evidence.sha256(args.log), "lines": len(log.rows)},
            "from": args.begins,
            "samples": None if args.samples is None else str(args.samples),
            **({} if isinstance(found, str) else as_record(target, found, why)),
        },
        reason=found if isinstance(found, str) else _reason(found),
    )
    evidence.write(place, record, evidence.YOURS)
    return record


def _reason(found: Judgement) -> str:
    if found.status == 0:
        return ""
    row = found.log.rows[found.accepted]
    return f"line {row.line}: no such scan after {found.accepted:,} that fit"

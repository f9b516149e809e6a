"""The command `modeproof check`: TLC on declared runs, judged; pins moved; traces shown."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.ground.lock import only_one
from modeproof.ground.options import add_command, write_json
from modeproof.ground.places import root
from modeproof.ground.progress import Progress
from modeproof.ground.reason import ask_reason, refuse_in_ci
from modeproof.registers.load import load_interface
from modeproof.registers.replay import has_replay, load_replay, meanings
from modeproof.registers.runs import LANES
from modeproof.tlc.check import Checked, check_all, register_problems, select
from modeproof.tlc.messages import essence, format_trace
from modeproof.tlc.repin import Move, apply, cfg_diff, moves
from modeproof.tlc.toolchain import Toolchain, find_toolchain
from modeproof.tlc.walk import read_walk, recorded, walk_all


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns the worst status of the runs and raises Unjudged."""
    check = add_command(commands, "check", run)
    check.add_argument(
        "runs", nargs="*", metavar="RUN", help="id or pattern, such as MC_* (default: the full lane)"
    )
    check.add_argument("--lane", choices=LANES, help="only runs of this lane")
    check.add_argument("--document", metavar="NAME", help="only runs of this document")
    check.add_argument("--trace", action="store_true", help="show expected counterexamples too")
    check.add_argument("--all-variables", action="store_true", help="show every variable in every state")
    check.add_argument("--list", action="store_true", help="list the runs, run nothing")
    check.add_argument(
        "--repin", action="store_true", help="move the pins of these runs to what they give now"
    )
    check.add_argument("--reason", metavar="TEXT", help="why the pins move (with --repin)")


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    if args.repin:
        refuse_in_ci()
        if not args.runs:
            raise Unjudged("--repin needs the runs by name")
    elif args.reason is not None:
        raise Unjudged("--reason belongs to --repin")
    lane = args.lane or (None if args.runs else "full")
    runs = select(place, args.runs, lane, args.document)
    if args.list:
        for run in runs:
            print(f"{run.name}  {run.expect}  {','.join(run.lanes)}  {run.environment}")
        return 0
    tools = find_toolchain()
    progress = Progress(quiet=args.quiet)
    with only_one(place):
        done = check_all(place, runs, tools, progress, lambda checked: progress.say(line_of(checked)))
        for checked in done if not args.repin or args.trace else ():
            _show_trace(place, checked, args, tools)
        status: int = max(checked.status for checked in done)
        problems: list[str] = []
        for document in sorted({run.document for run in runs}):
            problems += [f"{document}: {problem}" for problem in register_problems(place, document)]
        for problem in problems:
            print(f"modeproof: {problem}", file=sys.stderr, flush=True)
        if problems and not args.runs:
            status = max(status, EXIT_NOT_AS_EXPECTED)
        if args.repin:
            status = _repin(place, done, args.reason)
    if len(done) > 1 and not args.repin:
        good = sum(1 for checked in done if checked.status == 0)
        print(f"{good} of {len(done)} runs as expected")
    write_json(args, status, runs=[checked.record for checked in done], problems=problems)
    return status


def _show_trace(place: Path, checked: Checked, args: argparse.Namespace, tools: Toolchain) -> None:
    if checked.outcome is not None and not checked.judgement.judged:
        for _, text in checked.outcome.log.errors[:4]:
            print("\n".join(f"    {line}" for line in essence(text)[:12]))
    if checked.outcome is None or not checked.outcome.log.trace:
        return
    if checked.judgement.as_expected and not args.trace:
        return
    print(
        f"counterexample of {checked.run.name}"
        + (f" ({checked.judgement.violated})" if checked.judgement.violated else "")
    )
    trace = checked.outcome.log.trace
    wires: list[dict[str, str]] = []
    if args.trace and has_replay(place, checked.run.document):
        try:
            wires = on_the_wires(place, checked, tools)
        except Unjudged as error:
            print(f"words are not decoded: {error.message}")
    whole = wires if len(wires) == len(trace) else []
    print(format_trace(trace, checked.outcome.log.loop, args.all_variables, whole))


def on_the_wires(place: Path, checked: Checked, tools: Toolchain) -> list[dict[str, str]]:
    """What is on the wires in each state of a counterexample: words in hex, with what they mean there.

    Raises Unjudged when TLC cannot follow the counterexample once more.
    """
    document, trace = checked.run.document, recorded(checked.record)
    walk = read_walk(place, document, trace) or walk_all(place, document, [trace], tools)[trace.run]
    means = meanings(load_replay(place, document), walk["tables"])
    words = {
        name
        for device in load_interface(place, document).devices.values()
        for table in (device.inputs, device.outputs)
        for name, signal in table.items()
        if signal.type == "word"
    }

    def shown(name: str, value: Any) -> str:
        if name not in words or isinstance(value, bool) or not isinstance(value, int):
            return str(value).upper() if isinstance(value, bool) else str(value)
        says, numbers = means.get(name, ("", {}))
        meaning = f"{says} {numbers[value]}" if value in numbers else "no code" if value and numbers else ""
        return f"{value:04X}" + (f" ({meaning})" if meaning else "")

    return [{name: shown(name, value) for name, value in row["wires"].items()} for row in walk["rows"]]


def _repin(place: Path, done: list[Any], given: str | None) -> int:
    changes: dict[str, dict[str, tuple[Move, ...]]] = {}
    for checked in done:
        moved = moves(place, checked)
        print(f"{checked.run.name}:" + ("" if moved else " pins stay as they are"))
        for move in moved:
            print(f"  {move}")
        if moved:
            print("  " + cfg_diff(place, checked).replace("\n", "\n  "))
            of_document = changes.setdefault(checked.run.document, {})
            row = checked.run.of[0] if checked.run.of else checked.run.id
            of_document[row] = (*of_document.get(row, ()), *moved)
    if not changes:
        return 0
    reason = ask_reason(given)
    apply(place, changes, reason)
    count = sum(len(of_run) for of_run in changes.values())
    print(f"pins of {count} run{'s' if count != 1 else ''} moved; reason: {reason}")
    return 0


def line_of(checked: Checked) -> str:
    """One line that says how a run went."""
    counts = checked.outcome.log.counts if checked.outcome is not None else None
    seconds = checked.outcome.seconds if checked.outcome is not None else 0.0
    parts = [f"{'ok ' if checked.status == 0 else 'NOT'} {checked.run.name}: {checked.judgement.words}"]
    if checked.judgement.violated:
        parts[0] += f" ({checked.judgement.violated})"
    if counts is not None:
        parts.append(f"{counts.distinct:,} distinct, {counts.generated:,} generated")
    if checked.outcome is not None and checked.outcome.log.trace:
        parts.append(f"{len(checked.outcome.log.trace)} states in the counterexample")
    parts.append(f"{seconds:.1f} s")
    if checked.judgement.reason:
        parts.append(checked.judgement.reason)
    return "; ".join(parts)

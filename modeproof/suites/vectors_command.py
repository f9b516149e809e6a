"""The command `modeproof vectors`: build, lint, stats, show, pack."""

from __future__ import annotations

import argparse
import csv
import hashlib
import io
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.graph.device import open_runs
from modeproof.ground.errors import EXIT_AS_EXPECTED, EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.ground.lock import only_one
from modeproof.ground.places import build, root
from modeproof.kit.text import write_json
from modeproof.kit.vectors import FILE_NAME, Case, Suite, open_suite, read_lines
from modeproof.registers.vector_files import of_machine, published_files
from modeproof.suites.build import find_target, make_graphs, published, ready_suite, suite_file
from modeproof.suites.kinds import SUITES
from modeproof.suites.lint import lint
from modeproof.suites.pack import NAME, pack
from modeproof.suites.write import NoCases

WITHIN = 1.05
"""How much a tour may cost, as a multiple of its lower bound."""
SPARE = 20_000
"""So many scans more than that are some seconds, and no reason to look for a shorter tour."""


def add_parser(commands: Any) -> None:
    """Add `vectors`; its exit status is 0 as expected, 1 not as expected."""
    parser = commands.add_parser(
        "vectors",
        description="Builds the test suites from the graphs, checks the files, and shows what is in them.",
    )
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    for name, text in (
        ("build", "build what is missing or older than its sources"),
        ("lint", "check files against the schema, and what they say of themselves"),
        ("stats", "cases, scans and transitions of each file; of tours also the lower bound"),
    ):
        action = actions.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        action.add_argument("targets", nargs="*", metavar="TARGET", help="only these targets (default: all)")
        action.add_argument(
            "--suite", action="append", choices=list(SUITES), help="only this suite (may be repeated)"
        )
        if name == "build":
            action.add_argument("--anew", action="store_true", help="also what is up to date")
        if name == "stats":
            action.add_argument("--json", type=Path, metavar="FILE", help="write the figures as JSON as well")
        action.set_defaults(run=run)
    packer = actions.add_parser(
        "pack",
        help="write build/modeproof-kit.pyz: the kit with its vectors, for any Python",
        description="Builds the fast suites of all published targets and packs them with the kit.",
    )
    packer.add_argument("--to", type=Path, metavar="FILE", help=f"another file than build/{NAME}")
    packer.add_argument("--all", action="store_true", help="the slow suites too: building them takes long")
    packer.set_defaults(run=run, targets=[], suite=None, anew=False)
    show = actions.add_parser("show", help="show one case", description="Show one case.")
    show.add_argument("id", metavar="ID", help="id of the case, as a verdict names it")
    show.add_argument("--csv", action="store_true", help="as a table for a trace tool")
    show.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    actions = {
        "build": _build,
        "lint": _lint,
        "stats": _stats,
        "show": _show,
        "pack": _pack,
    }
    return actions[args.action](place, args)


def _build(place: Path, args: argparse.Namespace) -> int:
    targets = args.targets or list(published(place))
    _make(place, targets, args.suite or SUITES, leave_out=not args.suite, anew=args.anew)
    return EXIT_AS_EXPECTED


def _make(
    place: Path, targets: Iterable[str], suites: Iterable[str], *, leave_out: bool, anew: bool = False
) -> None:
    """Build suites of targets. With `leave_out` one that would have no cases is left out."""
    with only_one(place):
        for target in targets:
            document, _ = find_target(place, target)
            make_graphs(place, open_runs(place, document, target), quiet=True)
            for suite in suites:
                path = suite_file(place, document, target, suite)
                if anew:
                    path.unlink(missing_ok=True)
                try:
                    ready_suite(place, document, target, suite, lambda line: print(line, flush=True))
                except NoCases as error:
                    if not leave_out:
                        raise
                    path.unlink(missing_ok=True)
                    print(f"{error}; left out", flush=True)
                    continue
                digest = _digest(path)
                print(f"{target} {suite}: {path.stat().st_size:,} bytes, sha256 {digest[:16]}", flush=True)


def _pack(place: Path, args: argparse.Namespace) -> int:
    targets = published(place)
    if not targets:
        raise Unjudged("no published target has graphs, so there is nothing to pack")
    _make(place, targets, [name for name, kind in SUITES.items() if kind.fast or args.all], leave_out=True)
    path = args.to or build(place) / NAME
    contents = pack(place, targets, path, args.all)
    for target, suites in contents["targets"].items():
        sizes = [f"{name} {row['bytes']:,}" for name, row in suites.items()]
        print(f"{target}: {', '.join(sizes)} bytes")
        for name, why in contents["left_out"].get(target, {}).items():
            print(f"    without {name}: {why}")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    print(f"{path}: {path.stat().st_size:,} bytes, sha256 {digest[:16]}")
    return EXIT_AS_EXPECTED


def _digest(path: Path) -> str:
    """The hash of the unpacked file, because another machine may compress it differently."""
    content = hashlib.sha256()
    for line in read_lines(path):
        content.update(line)
    return content.hexdigest()


def _files(place: Path, args: argparse.Namespace) -> list[Path]:
    """The vector files of the targets and suites asked for. Raises Unjudged when one of them has none."""
    files = _known(place)
    suites = [FILE_NAME.format(suite=name) for name in args.suite or ()]
    found = [
        path
        for path in files
        if (not args.targets or path.parent.name in args.targets) and (not suites or path.name in suites)
    ]
    there = {part for path in found for part in (path.parent.name, path.name)}
    missing = [name for name in (*args.targets, *suites) if name not in there]
    if missing or not found:
        raise Unjudged(
            f"no vector file of {', '.join(missing) or 'any target'}; modeproof vectors build makes them"
        )
    return found


def _known(place: Path) -> list[Path]:
    """All vector files: those that were built, and those of machines, which are published alone."""
    built = sorted((build(place) / "vectors").glob(f"*/*/{FILE_NAME.format(suite='*')}"))
    return [*built, *(path for path in published_files(place) if of_machine(path))]


def _lint(place: Path, args: argparse.Namespace) -> int:
    status = EXIT_AS_EXPECTED
    for path in _files(place, args):
        name = path.relative_to(build(place) if path.is_relative_to(build(place)) else place).as_posix()
        problems = lint(path)
        print(f"{'NOT' if problems else 'ok '} {name}", flush=True)
        for problem in problems[:20]:
            print(f"    {problem}")
        if problems:
            status = EXIT_NOT_AS_EXPECTED
    return status


def _stats(place: Path, args: argparse.Namespace) -> int:
    status = EXIT_AS_EXPECTED
    rows = []
    for path in _files(place, args):
        suite = open_suite(path)
        header = suite.header
        row = {name: header[name] for name in ("target", "suite", "cases", "scans", "transitions")}
        row["bytes"] = path.stat().st_size
        line = (
            f"{suite.target} {suite.name}: {suite.case_count:,} cases, {suite.scan_count:,} scans, "
            f"{header['transitions']:,} transitions (by {header['counted_by']}), {row['bytes']:,} bytes"
        )
        bound = header.get("lower_bound")
        if bound is not None:
            cost = suite.scan_count + suite.case_count
            row |= {"lower_bound": bound, "cost": cost}
            line += f"; scans and resets {cost:,}, at least {bound:,}: {100 * (cost / bound - 1):.1f} % above"
            if cost > WITHIN * bound + SPARE:
                status = EXIT_NOT_AS_EXPECTED
                line += f", more than {100 * (WITHIN - 1):.0f} % and {SPARE:,}"
        print(line)
        for graph in header["graphs"]:
            if "not_so" in graph:
                print(f"    {graph['run']}: {_not_so(graph['not_so'])}")
        rows.append(row)
    if args.json is not None:
        write_json(args.json, {"command": "vectors stats", "status": status, "files": rows})
    return status


def _not_so(steps: Mapping[str, str]) -> str:
    """What single changes do not reach, in one line; the header of the file has it step by step."""
    if not steps:
        return "every transition by single changes of inputs"
    counts = [[int(part) for part in text.split(" of ")] for text in steps.values()]
    missed, of_all = (sum(count[n] for count in counts) for n in (0, 1))
    return (
        f"{missed:,} of {of_all:,} transitions of {len(counts)} steps not reached by single changes of inputs"
    )


def _show(place: Path, args: argparse.Namespace) -> int:
    suite, case = _find(place, args.id)
    if args.csv:
        sys.stdout.write(_as_csv(suite, case))
    else:
        print("\n".join(_lines(suite, case)))
    return EXIT_AS_EXPECTED


def _find(place: Path, id: str) -> tuple[Suite, Case]:
    for path in _known(place):
        if not any(line.startswith(f'{{"id":"{id}"'.encode()) for line in read_lines(path)):
            continue
        suite = open_suite(path)
        for case in suite.cases():
            if case.id == id:
                return suite, case
    raise Unjudged(f"no case {id} in build/vectors; `modeproof vectors build` makes the files")


def _lines(suite: Suite, case: Case) -> Iterator[str]:
    yield f"{case.id}: {suite.target}, suite {suite.name}, {len(case.scans)} scans"
    yield f"why:     {case.why}"
    yield f"clauses: {', '.join(case.clauses) or 'none'}; basis: {case.basis}"
    yield f"reset    {json.dumps(dict(case.params))}" if case.reset else "before any reset"
    inputs: dict[str, Any] = {}
    outputs: dict[str, Any] = {}
    for number, scan in enumerate(case.scans, 1):
        if scan.request is not None:
            yield f"{number:>4}  to be refused: {scan.request}"
            continue
        ins = _changed(inputs, scan.inputs)
        outs = _changed(outputs, scan.outputs)
        settling = "" if scan.compared else " (settling)"
        step = suite.steps[scan.step].name
        yield f"{number:>4}  +{scan.dt_ms} ms  {ins or '-'}  ->  {outs or '-'}  [{step}]{settling}"
        inputs, outputs = dict(scan.inputs), dict(scan.outputs)


def _changed(before: dict[str, Any], now: Any) -> str:
    new = object()
    return ", ".join(f"{name}={json.dumps(now[name])}" for name in now if before.get(name, new) != now[name])


def _as_csv(suite: Suite, case: Case) -> str:
    """A row for each scan: time in ms since the reset, inputs, expected outputs; words in hex, bits 0 and 1.

    Raises Unjudged for a case with requests to be refused: they are messages, not scans.
    """
    if case.requests:
        raise Unjudged(f"{case.id}: holds a request that must be refused; a trace cannot show it")
    stream = io.StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(["time_ms", *suite.inputs, *suite.outputs])
    time_ms = 0
    for scan in case.scans:
        time_ms += scan.dt_ms
        ins = [_cell(scan.inputs[name]) for name in suite.inputs]
        table.writerow([time_ms, *ins, *[_cell(scan.outputs[name]) for name in suite.outputs]])
    return stream.getvalue()


def _cell(value: Any) -> str:
    if type(value) is bool:
        return str(int(value))
    if isinstance(value, list):
        return " ".join(map(str, value))
    return "" if value is None else str(value)

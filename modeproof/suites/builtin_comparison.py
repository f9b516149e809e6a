"""Our own code, or any Python package, beside the graph of the specification: every transition, both ways."""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from modeproof.graph.chart import chart
from modeproof.graph.device import COMPARED_BY, compared_rests, load_device_graph, open_runs
from modeproof.graph.equal import Comparison, Difference, compare
from modeproof.graph.export import write_export
from modeproof.graph.implementation import REFERENCE, load_implementation
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.lock import only_one
from modeproof.ground.places import root
from modeproof.ground.progress import Progress
from modeproof.kit.text import write_json
from modeproof.kit.vectors import EXACT
from modeproof.registers.runs import Run
from modeproof.suites.build import find_target, make_graphs
from modeproof.tlc.rests import row_of


def run_builtin(args: argparse.Namespace) -> int:
    place = root()
    document, device = find_target(place, args.target, args.document)
    runs = open_runs(place, document, args.target)
    if not runs:
        raise Unjudged(f"{document}: no OPEN run prints a graph of {args.target}")
    if args.case is not None or args.param or args.relation != EXACT:
        raise Unjudged(
            "--case, --param and --relation need --suite or --vectors; --builtin alone is exact, and whole"
        )
    load_implementation(args.builtin, document, device.id)  # what cannot be loaded is said before TLC begins
    progress = Progress(quiet=args.quiet)
    found: list[tuple[Run, Comparison]] = []
    with only_one(place):
        make_graphs(place, runs, args.quiet)
        for kit_run in runs:
            found.append((kit_run, compare_run(place, kit_run, args.builtin, progress, args.codes)))
    for kit_run, result in found:
        print(_text(kit_run, result))
    status = max(0 if result.equal else 1 for _, result in found)
    if args.json is not None:
        rows = [{"run": kit_run.id, "verdict": result.verdict, **asdict(result)} for kit_run, result in found]
        write_json(args.json, {"command": "conform", "status": status, "builtin": args.builtin, "runs": rows})
    return status


def compare_run(place: Path, run: Run, builtin: str, progress: Progress, codes: bool = False) -> Comparison:
    """Compare the graph of a run with a program, and write the evidence. Raises Unjudged like `compared`."""
    folder = evidence.OURS if builtin == REFERENCE else evidence.YOURS
    name = f"{builtin}_{run.id}"
    evidence.discard(place, run.document, name, folder)
    started = time.time()
    inputs: Mapping[str, str] = {}
    with contextlib.suppress(Unjudged):  # a program of another place
        inputs = compared_rests(place, run, builtin).inputs
    progress.begin(name)
    try:
        found, result = compared(
            place,
            run,
            builtin,
            codes,
            lambda done, total: progress.update(name, f"{done:,} of {total:,} transitions", done / total),
        )
    finally:
        progress.end(name)
    evidence.write(place, comparison_record(place, run, builtin, inputs, started, found, result), folder)
    return found


def compared(
    place: Path,
    run: Run,
    builtin: str,
    codes: bool = False,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[Comparison, dict[str, Any]]:
    """A graph beside a program, and what evidence says of it: with our own code the graph is exported and
    its chart drawn, and every output is compared. Raises Unjudged for a graph that cannot be used.
    """
    graph = load_device_graph(place, run)
    code = load_implementation(builtin, run.document, graph.device.id)
    ours = builtin == REFERENCE
    result: dict[str, Any] = {}
    if ours:
        drawn = chart(graph)
        exported = evidence.hashes(place, [write_export(place, run, graph)])
        result = {"chart": None if drawn is None else asdict(drawn), "artefacts": exported}
    found = compare(graph, code, on_progress, codes=codes or ours)
    return found, {**result, **asdict(found)}


def comparison_record(
    place: Path,
    run: Run,
    builtin: str,
    inputs: Mapping[str, str],
    started: float,
    found: Comparison | None,
    result: Mapping[str, Any],
    why: str = "",
) -> dict[str, Any]:
    """The evidence of a comparison; without one UNJUDGED, and `why`."""
    assert run.graph is not None
    device = run.graph.device
    strength, reason = "", why
    if found is not None:
        strength = (
            f"{found.states:,} states, {found.replayed:,} of {found.transitions:,} transitions, "
            f"{sum(done == total for done, total in found.covered.values())} of {len(found.covered)} steps "
            "in full, both ways, in process"
        )
        first = f"; first: {found.differences[0]}" if found.differences else ""
        reason = "" if found.equal else f"{found.summary()}{first}"
    return evidence.make(
        kind="conformance",
        id=f"{builtin}_{run.id}",
        document=run.document,
        verdict="UNJUDGED" if found is None else found.verdict,
        expected="EQUAL",
        as_expected=found is not None and found.equal,
        environment=run.environment,
        strength=strength,
        command=f"modeproof conform {device} --builtin {builtin} --document {run.document}",
        started=started,
        seconds=time.time() - started,
        inputs=inputs,
        code=COMPARED_BY,
        place=place,
        result={**row_of(run), "run": run.id, "device": device, "implementation": builtin, **result},
        reason=reason,
    )


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
    return "\n".join([*lines, *_first(found)])


def difference_text(run: Run, found: Comparison) -> str:
    """The shortest way to the first difference."""
    return "\n".join([f"{run.name} and {found.implementation}", *_first(found)])


def _first(found: Comparison) -> list[str]:
    shown = [line for difference in found.differences[:1] for line in _shown(difference)]
    return [*shown, found.summary()]


def _shown(difference: Difference) -> list[str]:
    lines = [f"  first difference: {difference}", "  shortest inputs from power-up:"]
    before: Mapping[str, Any] = {}
    for n, scan in enumerate(difference.scans, 1):
        changed = {name: value for name, value in scan.items() if n == 1 or before[name] != value}
        lines.append(f"    scan {n}: " + ", ".join(f"{name}={value}" for name, value in changed.items()))
        before = scan
    return lines

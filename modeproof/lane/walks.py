"""The command `modeproof walks`: what was on the wires in every recorded counterexample.

The evidence of a counterexample holds the variables of the specification. A walk (modeproof.tlc.walk) adds
the words on the wires, who executed each step, and what the decided device does in its place; the report and
the pages of the findings show it. A walk that is there and of this very trace and specification is kept.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import EXIT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.ground.places import add_document_option, chosen_documents
from modeproof.ground.places import root as repository_root
from modeproof.ground.processes import Task, in_processes
from modeproof.ground.progress import Progress
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.runs import load_runs
from modeproof.tlc.toolchain import find_toolchain
from modeproof.tlc.walk import read_walk, recorded, walk_all
from modeproof.tlc.walk_module import Recorded


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0, or 2 where a trace could not be followed."""
    parser = commands.add_parser(
        "walks",
        description="Follows the counterexamples in build/evidence/ with TLC, one start for each module, and "
        "writes build/walks/. Exit status: 0 all followed, 2 some could not be; the report then shows their "
        "variables alone.",
    )
    add_document_option(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    names = chosen_documents(place, args.document)
    found = walk_evidence(place, names, Progress(quiet=args.quiet))
    for walk in found:
        print(line_of(walk))
    return EXIT_UNJUDGED if any(walk["reason"] for walk in found) else EXIT_AS_EXPECTED


def line_of(walked: dict[str, Any]) -> str:
    """One line about the traces of one module."""
    head = f"{walked['document']}/{walked['module']}: {walked['traces']} traces"
    return f"{head}: UNJUDGED: {walked['reason']}" if walked["reason"] else f"{head} followed"


def walk_evidence(place: Path, names: Sequence[str], progress: Progress) -> list[dict[str, Any]]:
    """Walk every counterexample in the evidence of these documents, each module by itself.

    One entry for each module that has a counterexample: `document`, `module`, `traces`, and `reason`, which
    is empty unless they could not be followed.
    """
    tasks: list[Task[dict[str, Any]]] = []
    for document in names:
        if not has_replay(place, document):
            continue
        groups: dict[str, list[Recorded]] = {}
        for declared in load_runs(place, document):
            try:
                record = evidence.read(evidence.evidence_path(place, document, declared.id))
                if record["result"].get("trace"):
                    trace = recorded(record)
                    groups.setdefault(trace.module, []).append(trace)
            except Unjudged:
                continue  # without evidence there is nothing to follow; the report says that it is missing
        tasks += [(_walk, (place, document, module, traces)) for module, traces in groups.items()]
    return sorted(
        in_processes("walks", tasks, progress, lambda one: progress.say(line_of(one))),
        key=lambda one: (names.index(one["document"]), one["module"]),
    )


def _walk(place: Path, document: str, module: str, traces: Sequence[Recorded]) -> dict[str, Any]:
    reason = ""
    try:
        missing = [trace for trace in traces if read_walk(place, document, trace) is None]
        if missing and module not in load_replay(place, document).tops:
            raise Unjudged(f"spec/{document}/replay.toml declares no top {module}")
        if missing:
            walk_all(place, document, missing, find_toolchain())
    except Unjudged as error:
        reason = error.message
    return {"document": document, "module": module, "traces": len(traces), "reason": reason}

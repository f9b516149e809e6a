"""The stage of `verify` for conformance: each device graph against the reference implementation.

In process every transition is compared, both ways. Over the adapter protocol each published target runs
through a suite of the lane, as a foreign program would.
"""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.graph.device import compared_rests
from modeproof.graph.implementation import REFERENCE
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import Rests
from modeproof.ground.processes import Task, in_processes
from modeproof.ground.progress import Progress
from modeproof.lane.keep import NOTHING, Keep
from modeproof.registers.runs import Run, load_runs

Record = dict[str, Any]
ANSWER_SECONDS = 30.0
ELSEWHERE = "every graph is compared in the lane full, and none is made in this one"
"""Said of a document that has nothing to compare in the lane exhaustive; that is no trouble."""


def compare_reference(
    place: Path, names: Sequence[str], lane: str, progress: Progress, keep: Keep = NOTHING
) -> tuple[list[Record], dict[str, str]]:
    """Evidence for each OPEN run of the lane, and for each published target all of whose graphs are in the
    lane; by document, why there is none.

    A graph that is missing or incomplete, or an implementation that cannot be loaded, is UNJUDGED, and so is
    a document that has no graph in the lane, unless that is the lane exhaustive and its graphs are in full.
    """
    work, troubles, kept = comparisons(place, names, lane, keep)
    keep.say(progress)
    return kept + in_processes("conformance", work, progress, lambda record: say(record, progress)), troubles


def comparisons(
    place: Path, names: Sequence[str], lane: str, keep: Keep
) -> tuple[list[Task[Record]], dict[str, str], list[Record]]:
    """What `compare_reference` has to do, each task by itself, what takes longest first; by document, why
    there is nothing to do; and what is kept.
    """
    from modeproof.suites.conform_command import OWN_SUITES, own_id, own_rests

    troubles: dict[str, str] = {}
    tasks: list[tuple[int, Task[Record]]] = []
    found: list[Record] = []
    for document in names:
        try:
            every = [run for run in load_runs(place, document) if run.graph is not None]
            runs = [run for run in every if lane in run.lanes]
            if not runs and lane == "exhaustive" and every and all("full" in run.lanes for run in every):
                troubles[document] = ELSEWHERE
                continue
            if not runs:
                raise Unjudged(f"the lane {lane} has no OPEN run, so nothing is compared")
            targets = _targets(place, document, lane)
        except Unjudged as error:
            troubles[document] = error.message
            continue
        for target in targets:
            given = place, document, target, OWN_SUITES[lane]
            if kept := keep.record(
                place, document, own_id(target, OWN_SUITES[lane]), partial(own_rests, *given)
            ):
                found.append(kept)
                continue
            task: Task[Record] = (_over_protocol, given)
            tasks.append((max(_edges(run) for run in runs if _is_of(run, target)), task))
        for run in runs:
            id = f"{REFERENCE}_{run.id}"
            rests = Rests({})
            with contextlib.suppress(Unjudged):  # what is missing is said by the comparison
                rests = compared_rests(place, run, REFERENCE)
            if rests.code and (kept := keep.record(place, document, id, rests)):
                found.append(kept)
            else:
                tasks.append((_edges(run), (_one, (place, run, rests.inputs))))
    tasks.sort(key=lambda task: -task[0])
    return [task for _, task in tasks], troubles, found


def _edges(run: Run) -> int:
    return (run.graph.edges or 0) if run.graph is not None else 0


def _is_of(run: Run, device: str) -> bool:
    return run.graph is not None and run.graph.device == device


def say(record: Record, progress: Progress) -> None:
    """One line on a comparison."""
    line = f"{record['document']}/{record['id']}: {record['verdict']}; {record['strength']}"
    reason = f"; {record['reason']}" if record["reason"] else ""
    progress.say(f"{'ok ' if record['as_expected'] else 'NOT'} {line}; {record['seconds']:.1f} s{reason}")


def _one(place: Path, run: Run, inputs: Mapping[str, str]) -> dict[str, Any]:
    from modeproof.graph.export import export_file
    from modeproof.suites.builtin_comparison import compared, comparison_record

    evidence.discard(place, run.document, f"{REFERENCE}_{run.id}")
    export_file(place, run.document, run.id).unlink(missing_ok=True)
    started = time.time()
    try:
        found, result = compared(place, run, REFERENCE)
        record = comparison_record(place, run, REFERENCE, inputs, started, found, result)
    except Unjudged as error:
        record = comparison_record(place, run, REFERENCE, inputs, started, None, {}, error.message)
    evidence.write(place, record)
    return record


def _targets(place: Path, document: str, lane: str) -> list[str]:
    """Published devices whose graphs are all made in this lane."""
    from modeproof.registers import load_interface

    runs = [run for run in load_runs(place, document) if run.graph is not None]
    return [
        name
        for name, device in load_interface(place, document).devices.items()
        if device.published
        and (own := [run for run in runs if run.graph is not None and run.graph.device == name])
        and all(lane in run.lanes for run in own)
    ]


def _over_protocol(place: Path, document: str, target: str, suite_name: str) -> dict[str, Any]:
    from modeproof.kit.adapter import Adapter
    from modeproof.kit.errors import Unjudged as KitUnjudged
    from modeproof.kit.suite_judge import Options, Plan
    from modeproof.kit.two_answers import judge_both
    from modeproof.kit.vectors import open_suite
    from modeproof.registers.load import load_interface
    from modeproof.registers.vector_files import published
    from modeproof.suites.build import ready_suite
    from modeproof.suites.conform_command import OWN, own_id, own_record
    from modeproof.suites.demands import load_demands

    name = own_id(target, suite_name)
    evidence.discard(place, document, name)
    started = time.time()
    try:
        path = published(place, target, suite_name)
        suite = ready_suite(place, document, target, suite_name) if path is None else open_suite(path)
        table = load_demands(place, document, load_interface(place, document).devices[target])
        found = judge_both(
            suite.demanding(table),
            lambda: Adapter([sys.executable, str(place / OWN), target], ANSWER_SECONDS),
            Plan(Options(codes=True)),  # of our own code every output
            same=True,
        )
        record = own_record(place, document, suite, found, started)
    except (Unjudged, KitUnjudged) as error:
        record = evidence.make(
            kind="conformance",
            id=name,
            document=document,
            verdict="UNJUDGED",
            expected="CONFORMS",
            as_expected=False,
            strength=f"suite {suite_name} over the adapter protocol",
            command=f"modeproof verify --document {document}",
            started=started,
            seconds=time.time() - started,
            result={"device": target, "implementation": REFERENCE},
            reason=str(error) or "the program could not be judged",
        )
    evidence.write(place, record)
    return record

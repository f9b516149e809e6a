"""The stage of `verify` for conformance: each device graph against the reference implementation.

In process every transition is compared, both ways. Over the adapter protocol each published target runs
through a suite of the lane, as a foreign program would.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from modeproof.graph.implementation import REFERENCE
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.processes import Task, in_processes
from modeproof.ground.progress import Progress
from modeproof.registers.runs import Run, load_runs

Record = dict[str, Any]
ADAPTER = "examples/adapters/refimpl_adapter.py"
SUITES = {"smoke": "brief", "full": "brief", "exhaustive": "tour"}
"""The suite that runs over the adapter protocol, by lane."""
ANSWER_SECONDS = 30.0


def compare_reference(
    place: Path, names: Sequence[str], lane: str, progress: Progress
) -> tuple[list[Record], dict[str, str]]:
    """Evidence for each OPEN run of the lane, and for each published target all of whose graphs are in the
    lane; by document, why there is none.

    A graph that is missing or incomplete, or an implementation that cannot be loaded, is UNJUDGED, and so is
    a document that has no graph in the lane.
    """
    work, troubles = comparisons(place, names, lane)
    return in_processes("conformance", work, progress, lambda record: say(record, progress)), troubles


def comparisons(place: Path, names: Sequence[str], lane: str) -> tuple[list[Task[Record]], dict[str, str]]:
    """What `compare_reference` has to do, each task by itself, what takes longest first; by document, why
    there is nothing to do.
    """
    troubles: dict[str, str] = {}
    tasks: list[tuple[int, Task[Record]]] = []
    for document in names:
        try:
            runs = [run for run in load_runs(place, document) if run.graph is not None and lane in run.lanes]
            if not runs:
                raise Unjudged(f"the lane {lane} has no OPEN run, so nothing is compared")
            targets = _targets(place, document, lane)
        except Unjudged as error:
            troubles[document] = error.message
            continue
        for target in targets:
            task: Task[Record] = (_over_protocol, (place, document, target, SUITES[lane]))
            tasks.append((max(_edges(run) for run in runs if _is_of(run, target)), task))
        tasks += [(_edges(run), (_one, (place, run, lane))) for run in runs]
    tasks.sort(key=lambda task: -task[0])
    return [task for _, task in tasks], troubles


def _edges(run: Run) -> int:
    return (run.graph.edges or 0) if run.graph is not None else 0


def _is_of(run: Run, device: str) -> bool:
    return run.graph is not None and run.graph.device == device


def say(record: Record, progress: Progress) -> None:
    """One line on a comparison."""
    line = f"{record['document']}/{record['id']}: {record['verdict']}; {record['strength']}"
    reason = f"; {record['reason']}" if record["reason"] else ""
    progress.say(f"{'ok ' if record['as_expected'] else 'NOT'} {line}; {record['seconds']:.1f} s{reason}")


def _one(place: Path, run: Run, lane: str) -> dict[str, Any]:
    from modeproof.graph.device import compared_files
    from modeproof.graph.export import export_file

    assert run.graph is not None
    name = f"{REFERENCE}_{run.id}"
    evidence.discard(place, run.document, name)
    export_file(place, run.document, run.id).unlink(missing_ok=True)
    started = time.time()
    verdict, reason, strength = "UNJUDGED", "", ""
    result: dict[str, Any] = {"run": run.id, "device": run.graph.device, "implementation": REFERENCE}
    try:
        found, drawn, exported = _compare(place, run)
        result["chart"] = drawn
        verdict = found.verdict
        strength = (
            f"{found.states:,} states, {found.replayed:,} of {found.transitions:,} transitions, "
            f"{sum(done == total for done, total in found.covered.values())} of {len(found.covered)} steps "
            "in full, both ways, in process"
        )
        result |= asdict(found) | {"artefacts": evidence.hashes(place, [exported])}
        reason = "" if found.equal else found.summary()
        if found.differences:
            reason = f"{reason}; first: {found.differences[0]}"
    except Unjudged as error:
        reason = error.message
    good = verdict == "EQUAL"
    record = evidence.make(
        kind="conformance",
        id=name,
        document=run.document,
        verdict=verdict,
        expected="EQUAL",
        as_expected=good,
        environment=run.environment,
        strength=strength,
        command=f"modeproof verify --document {run.document} --lane {lane}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, compared_files(place, run, REFERENCE)),
        result=result,
        reason=reason,
    )
    evidence.write(place, record)
    return record


def _compare(place: Path, run: Run) -> tuple[Any, Record | None, Path]:
    """The comparison, the state chart of the graph that was compared, and the export of that graph."""
    from modeproof.graph.chart import chart
    from modeproof.graph.device import load_device_graph
    from modeproof.graph.equal import compare
    from modeproof.graph.export import write_export
    from modeproof.graph.implementation import load_implementation

    assert run.graph is not None
    graph = load_device_graph(place, run)
    exported = write_export(place, run, graph)
    code = load_implementation(REFERENCE, run.document, run.graph.device)
    drawn = chart(graph)
    return compare(graph, code), None if drawn is None else asdict(drawn), exported


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
    from modeproof.kit.command import quoted
    from modeproof.kit.errors import Unjudged as KitUnjudged
    from modeproof.kit.judge import Options, Plan, run_suite
    from modeproof.kit.text import as_record
    from modeproof.suites.build import ready_suite

    name = f"adapter_{target}_{suite_name}"
    evidence.discard(place, document, name)
    started = time.time()
    script = place / ADAPTER
    adapter = quoted(f"python {ADAPTER} {target}")
    verdict, reason, strength = "UNJUDGED", "", f"suite {suite_name} over the adapter protocol"
    inputs: dict[str, str] = {}
    result: dict[str, Any] = {"device": target, "implementation": REFERENCE}
    try:
        inputs = evidence.hashes(place, [script, *sorted((place / REFERENCE / document).glob("*.py"))])
        suite = ready_suite(place, document, target, suite_name)
        inputs |= evidence.hashes(place, [suite.path])
        found = run_suite(
            suite,
            lambda: Adapter([sys.executable, str(script), target], ANSWER_SECONDS),
            plan=Plan(Options(codes=True)),  # of our own code every output
        )
        verdict, reason = found.word, found.reason
        done, total = (sum(counts) for counts in zip(*found.covered.values(), strict=True))
        strength = (
            f"relation {found.relation}, suite {found.suite} over the adapter protocol: "
            f"{found.scans:,} scans, {done:,} of {total:,} merged transitions"
        )
        result |= {**as_record(found), "says": suite.says}
        if found.word == "DIFFERS" and not reason:
            reason = f"the program differs: {found.difference}"
    except (Unjudged, KitUnjudged) as error:
        reason = str(error)
    good = verdict == "CONFORMS"
    record = evidence.make(
        kind="conformance",
        id=name,
        document=document,
        verdict=verdict,
        expected="CONFORMS",
        as_expected=good,
        strength=strength,
        command=f"modeproof conform {target} --adapter {adapter} --suite {suite_name}",
        started=started,
        seconds=time.time() - started,
        inputs=inputs,
        result=result,
        reason="" if good else reason or "the program could not be judged",
    )
    evidence.write(place, record)
    return record

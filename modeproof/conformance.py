"""The stage of `verify` that compares each device graph with the reference implementation, both ways."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.progress import Progress
from modeproof.tlc.runs import Run, load_runs

REFERENCE = "refimpl"


def compare_reference(place: Path, document: str, lane: str, progress: Progress) -> list[dict[str, Any]]:
    """One piece of evidence for each OPEN run of the lane: EQUAL or DIFFERS, with what was covered.

    A graph that is missing or incomplete, or an implementation that cannot be loaded, is UNJUDGED. Raises
    Unjudged when the lane has no graph at all.
    """
    runs = [run for run in load_runs(place, document) if run.graph is not None and lane in run.lanes]
    if not runs:
        raise Unjudged(f"{document}: the lane {lane} has no OPEN run, so nothing is compared")
    progress.expect(len(runs))
    return [_one(place, run, lane, progress) for run in runs]


def _one(place: Path, run: Run, lane: str, progress: Progress) -> dict[str, Any]:
    assert run.graph is not None
    name = f"{REFERENCE}_{run.id}"
    evidence.discard(place, run.document, name)
    started = time.time()
    verdict, reason, strength = "UNJUDGED", "", ""
    result: dict[str, Any] = {"run": run.id, "device": run.graph.device, "implementation": REFERENCE}
    progress.begin(name)
    try:
        found = _compare(place, run, name, progress)
        verdict = found.verdict
        strength = (
            f"{found.states:,} states, {found.replayed:,} of {found.transitions:,} transitions, "
            f"{sum(done == total for done, total in found.covered.values())} of {len(found.covered)} steps "
            "in full, both ways, in process"
        )
        result |= asdict(found)
        reason = "" if found.equal else found.summary()
        if found.differences:
            reason = f"{reason}; first: {found.differences[0]}"
    except Unjudged as error:
        reason = error.message
    finally:
        progress.end(name)
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
        inputs=_inputs(place, run),
        result=result,
        reason=reason,
    )
    evidence.write(place, record)
    progress.say(
        f"{'ok ' if good else 'NOT'} {run.document}/{name}: {verdict}; {strength}; {record['seconds']:.1f} s"
        + (f"; {reason}" if reason else "")
    )
    return record


def _compare(place: Path, run: Run, name: str, progress: Progress) -> Any:
    from modeproof.graph.device import load_device_graph
    from modeproof.graph.equal import compare
    from modeproof.graph.implementation import load_implementation

    assert run.graph is not None
    graph = load_device_graph(place, run)
    code = load_implementation(REFERENCE, run.document, run.graph.device)
    return compare(
        graph, code, lambda done, total: progress.update(name, f"{done:,} of {total:,} transitions")
    )


def _inputs(place: Path, run: Run) -> dict[str, str]:
    from modeproof.graph.device import graph_file

    folders = [place / REFERENCE, place / REFERENCE / run.document]
    paths = [path for folder in folders for path in sorted(folder.glob("*.py"))]
    paths.append(place / "spec" / run.document / "interface.toml")
    graph = graph_file(place, run)
    return evidence.hashes(place, [path for path in [*paths, graph] if path.is_file()])

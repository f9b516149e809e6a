"""The stage of `verify` for conformance: each device graph against the reference implementation.

In process every transition is compared, both ways. Over the adapter protocol each published target runs
through a suite of the lane, as a foreign program would.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict
from multiprocessing import active_children, get_context
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.progress import Progress
from modeproof.tlc.runs import Run, load_runs
from modeproof.tlc.schedule import cores

Record = dict[str, Any]
REFERENCE = "refimpl"
ADAPTER = "examples/adapters/refimpl_adapter.py"
SUITES = {"smoke": "brief", "full": "tour", "exhaustive": "tour"}
"""The suite that runs over the adapter protocol, by lane."""
ANSWER_SECONDS = 30.0


def compare_reference(place: Path, document: str, lane: str, progress: Progress) -> list[dict[str, Any]]:
    """Evidence for each OPEN run of the lane, and for each published target all of whose graphs are in the
    lane.

    A graph that is missing or incomplete, or an implementation that cannot be loaded, is UNJUDGED. Raises
    Unjudged when the lane has no graph at all.
    """
    runs = [run for run in load_runs(place, document) if run.graph is not None and lane in run.lanes]
    if not runs:
        raise Unjudged(f"{document}: the lane {lane} has no OPEN run, so nothing is compared")
    targets = _targets(place, document, lane)
    comparisons = [(_one, (place, run, lane)) for run in runs]
    return _all(
        [*comparisons, *((_over_protocol, (place, document, one, SUITES[lane])) for one in targets)], progress
    )


def _all(tasks: Sequence[tuple[Callable[..., Record], tuple[Any, ...]]], progress: Progress) -> list[Record]:
    """Do the tasks, each in a process of its own, as many at once as there are cores; say how each went.

    Raises Unjudged when a process dies. However this ends, no process is left behind.
    """
    if len(tasks) < 2 or cores() < 2:
        progress.expect(len(tasks))
        return [_said(work(*given, progress), progress) for work, given in tasks]
    executor = ProcessPoolExecutor(min(cores(), len(tasks)), mp_context=get_context("spawn"))
    progress.expect(1)
    progress.begin("conformance")
    try:
        # The last ones first: a suite over the protocol takes longer than a comparison in process.
        futures = [executor.submit(_quietly, work, given) for work, given in reversed(tasks)]
        waiting = set(futures)
        while waiting:
            done, waiting = wait(waiting, timeout=0.5, return_when=FIRST_COMPLETED)
            for future in done:
                _said(future.result(), progress)
            progress.update("conformance", f"{len(tasks) - len(waiting)} of {len(tasks)}")
        return [future.result() for future in reversed(futures)]
    except BrokenProcessPool as error:
        raise Unjudged(f"a process that compares an implementation died: {error}") from None
    finally:
        progress.end("conformance")
        executor.shutdown(wait=False, cancel_futures=True)
        for child in active_children():
            child.terminate()


def _quietly(work: Callable[..., Record], given: tuple[Any, ...]) -> Record:
    return work(*given, Progress(quiet=True))


def _said(record: Record, progress: Progress) -> Record:
    line = f"{record['document']}/{record['id']}: {record['verdict']}; {record['strength']}"
    reason = f"; {record['reason']}" if record["reason"] else ""
    progress.say(f"{'ok ' if record['as_expected'] else 'NOT'} {line}; {record['seconds']:.1f} s{reason}")
    return record


def _one(place: Path, run: Run, lane: str, progress: Progress) -> dict[str, Any]:
    from modeproof.graph.device import compared_files

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
        inputs=evidence.hashes(place, compared_files(place, run, REFERENCE)),
        result=result,
        reason=reason,
    )
    evidence.write(place, record)
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


def _over_protocol(
    place: Path, document: str, target: str, suite_name: str, progress: Progress
) -> dict[str, Any]:
    from modeproof.kit.adapter import Adapter
    from modeproof.kit.command import quoted
    from modeproof.kit.errors import Unjudged as KitUnjudged
    from modeproof.kit.judge import run_suite
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
    progress.begin(name)
    try:
        inputs = evidence.hashes(place, [script, *sorted((place / REFERENCE / document).glob("*.py"))])
        suite = ready_suite(place, document, target, suite_name)
        inputs |= evidence.hashes(place, [suite.path])
        found = run_suite(
            suite,
            lambda: Adapter([sys.executable, str(script), target], ANSWER_SECONDS),
            on_progress=lambda done, total: progress.update(name, f"{done:,} of {total:,} scans"),
        )
        verdict, reason = found.word, found.reason
        done, total = (sum(counts) for counts in zip(*found.covered.values(), strict=True))
        strength = (
            f"relation {found.relation}, suite {found.suite} over the adapter protocol: "
            f"{found.scans:,} scans, {done:,} of {total:,} merged transitions"
        )
        result |= as_record(found)
        if found.word == "DIFFERS" and not reason:
            reason = f"the program differs: {found.difference}"
    except (Unjudged, KitUnjudged) as error:
        reason = str(error)
    finally:
        progress.end(name)
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

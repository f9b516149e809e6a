"""Runs declared TLC runs, judges them and writes their evidence."""

from __future__ import annotations

import fnmatch
import hashlib
import shlex
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import build, documents, within
from modeproof.ground.processes import cores
from modeproof.ground.progress import Progress
from modeproof.registers.cfg import Cfg, parse_cfg
from modeproof.registers.load import load_document
from modeproof.registers.made import cfg_text, module_text
from modeproof.registers.profiles import strength_of
from modeproof.registers.readings import idle_reading
from modeproof.registers.runs import Run, load_runs
from modeproof.tlc import children
from modeproof.tlc.messages import Counts
from modeproof.tlc.process import SMALL_HEAP_MB, Outcome, run_tlc
from modeproof.tlc.rests import CODE, inputs_of
from modeproof.tlc.run_judge import HOLDS, UNJUDGED, Judgement, judge
from modeproof.tlc.run_judge_again import declared
from modeproof.tlc.schedule import Job, machine_mb, memory_mb, run_all
from modeproof.tlc.start_up import entries
from modeproof.tlc.toolchain import JAR_VERSION, Toolchain

_STATES_A_SECOND = {"LIVE": 8_000, "OPEN": 50_000}
"""Generated states a second where it is far from the usual 200,000; only the order depends on it."""


@dataclass(frozen=True)
class Checked:
    """One run, its judgement, what TLC did (None when it could not even be started), and its evidence."""

    run: Run
    judgement: Judgement
    outcome: Outcome | None
    cfg_sha256: str
    record: dict[str, Any]

    @property
    def status(self) -> int:
        """Exit status: 0 as expected, 1 not as expected, 2 not judged."""
        return 0 if self.judgement.as_expected else 1 if self.judgement.judged else 2


def select(
    place: Path, names: Sequence[str] = (), lane: str | None = None, document: str | None = None
) -> tuple[Run, ...]:
    """The runs to check: by id or pattern (`MC_*`, `DOCUMENT/MC_*`), else all of a lane, else of all
    lanes.

    Raises Unjudged when a name, in the lane if there is one, or the whole selection matches nothing.
    """
    known = documents(place)
    if document is not None and document not in known:
        raise Unjudged(f"no document {document!r} in spec/; {suggestion(document, known)}")
    chosen = [name for name in known if document in (None, name)]
    runs = [run for name in chosen if _has_runs(place, name) for run in load_runs(place, name)]
    for pattern in names:
        named = [run for run in runs if _named(run, pattern)]
        if not named:
            ids = [run.name if "/" in pattern else run.id for run in runs]
            where = ", ".join(chosen) or "any document"
            raise Unjudged(f"no run {pattern!r} in runs.toml of {where}; {suggestion(pattern, ids)}")
        if lane is not None and not any(lane in run.lanes for run in named):
            raise Unjudged(f"{pattern} is not in the lane {lane}, but in {', '.join(named[0].lanes)}")
    picked = tuple(
        run
        for run in runs
        if (not names or any(_named(run, pattern) for pattern in names))
        and (lane is None or lane in run.lanes)
    )
    if not picked:
        raise Unjudged(f"no run to check{f' in the lane {lane}' if lane else ''}")
    return picked


def _has_runs(place: Path, document: str) -> bool:
    return (place / "spec" / document / "runs.toml").is_file()


def _named(run: Run, pattern: str) -> bool:
    return fnmatch.fnmatchcase(run.id, pattern) or fnmatch.fnmatchcase(run.name, pattern)


def register_problems(place: Path, document: str) -> tuple[str, ...]:
    """What is wrong between runs.toml and the specification: a missing or unlisted cfg, an empty property
    list, a run whose cfg cannot be made, a main run that `make verify` leaves out.
    """
    folder = place / "spec" / document
    runs = load_runs(place, document)
    problems = [
        f"run {run.id}: {run.cfg} is missing" for run in runs if run.cfg and not (folder / run.cfg).is_file()
    ]
    problems += [
        f"run {run.id}: {run.module}.tla is missing"
        for run in runs
        if not (folder / f"{run.module}.tla").is_file()
    ]
    problems += [
        f"run {run.id}: the property list is empty"
        for run in runs
        if not run.properties and run.kind != "WIT"
    ]
    for run in (made for made in runs if made.base or not made.cfg):
        try:
            module_text(place, run)
        except Unjudged as error:
            problems.append(error.message)
    main: dict[tuple[str, str], Run] = {}
    for run in runs:
        main.setdefault((run.kind, run.environment), run)  # the strongest stands first
    problems += [
        f"run {run.id}: the main run of the environment {run.environment} is not in the lane full"
        for (kind, _), run in main.items()
        if kind in ("MC", "OPEN") and "full" not in run.lanes
    ]
    listed = {run.cfg for run in runs}
    problems += [
        f"{cfg.relative_to(folder).as_posix()} is in no run"
        for cfg in sorted((folder / "models").glob("*.cfg"))
        if cfg.relative_to(folder).as_posix() not in listed
    ]
    return tuple(problems)


def read_cfg(place: Path, run: Run) -> tuple[Cfg, str]:
    """The parsed cfg of a run and its SHA-256. Raises Unjudged when it is missing or not understood."""
    text = cfg_text(place, run)
    return parse_cfg(text, f"{run.name}: {run.config}"), hashlib.sha256(text.encode("utf-8")).hexdigest()


def check_one(place: Path, run: Run, tools: Toolchain, progress: Progress) -> Checked:
    """Run TLC once, judge the outcome and write the evidence.

    A run whose files are missing or that TLC cannot start is UNJUDGED, with evidence that says so. Raises
    Unjudged only when the evidence itself cannot be written.
    """
    evidence.discard(place, run.document, run.id)
    started = time.time()
    digest = ""
    outcome: Outcome | None = None
    inputs: dict[str, str] = {}
    progress.begin(run.id)
    try:
        cfg, digest = read_cfg(place, run)
        inputs = inputs_of(place, run)
        if 0 < (there := machine_mb()) < run.heap_mb:
            raise Unjudged(f"{run.name}: heap_mb = {run.heap_mb}, but this machine has {there} MiB of memory")

        def on_progress(counts: Counts) -> None:
            text = f"{counts.distinct:,} distinct, {counts.generated:,} generated"
            progress.update(run.id, text, counts.generated / run.generated if run.generated else 0.0)

        def on_lines(lines: int) -> None:
            whole = (run.graph.states or 0) + (run.graph.edges or 0) if run.graph is not None else 0
            progress.update(run.id, f"{lines:,} lines of the graph", lines / whole if whole else 0.0)

        outcome = run_tlc(place, run, tools, on_progress, on_lines)
        judgement = _about_reading(place, run, judge(run, cfg, digest, outcome), outcome)
        now = inputs_of(place, run)
        if changed := [name for name in (*inputs, *now) if inputs.get(name) != now.get(name)]:
            judgement = Judgement(UNJUDGED, False, f"{changed[0]} was changed while TLC ran")
    except Unjudged as error:
        judgement = Judgement(UNJUDGED, False, error.message)
    finally:
        progress.end(run.id)
    record = _record(place, run, tools, inputs, judgement, outcome, started)
    evidence.write(place, record)
    return Checked(run, judgement, outcome, digest, record)


def pinned_anew(place: Path, checked: Checked, tools: Toolchain) -> Checked:
    """The same outcome, judged by the pins as they are now, with evidence that says so. Raises Unjudged."""
    assert checked.outcome is not None
    run = next(one for one in load_runs(place, checked.run.document) if one.id == checked.run.id)
    cfg, digest = read_cfg(place, run)
    judgement = judge(run, cfg, digest, checked.outcome)
    record = _record(place, run, tools, inputs_of(place, run), judgement, checked.outcome, time.time())
    evidence.write(place, record)
    return Checked(run, judgement, checked.outcome, digest, record)


def _about_reading(place: Path, run: Run, judgement: Judgement, outcome: Outcome) -> Judgement:
    """Of a run that was to be violated and is not: which reading changed nothing."""
    counts = outcome.log.counts
    if run.kind != "NEG" or judgement.verdict != HOLDS or counts is None:
        return judgement
    try:
        document = load_document(place, run.document)
        found = (counts.distinct, counts.generated)
        words = idle_reading(document, run, found)
    except Unjudged:
        return judgement  # the registers are judged elsewhere
    return replace(judgement, reason=f"{judgement.reason}: {words}") if words else judgement


def check_all(
    place: Path,
    runs: Sequence[Run],
    tools: Toolchain,
    progress: Progress,
    on_checked: Callable[[Checked], None] = lambda checked: None,
) -> list[Checked]:
    """Check the runs, as many at once as the machine allows, longest first; results in the order given."""
    core_limit = cores()
    exhaustive = any(set(run.lanes) == {"exhaustive"} for run in runs)
    jobs = [Job(run.id, _share(run), run.heap_mb, _estimate(place, run)) for run in runs]
    progress.expect(len(runs))

    def work(index: int) -> Checked:
        checked = check_one(place, runs[index], tools, progress)
        on_checked(checked)
        return checked

    try:
        return run_all(jobs, work, core_limit, memory_mb(exhaustive=exhaustive), progress.tick)
    except BaseException:
        children.stop_all()
        raise


SMALL_SHARE = 0.65
"""Of a core, what a small run takes (SMALL_HEAP_MB): much of its time goes into starting, and into reading
and writing what it found, while another can compute. With three beside one another the four blocks took
177 s, with two 198 s (two virtual cores, Xeon 2.8 GHz).
"""


def _share(run: Run) -> float:
    return SMALL_SHARE if run.workers == 1 and run.heap_mb <= SMALL_HEAP_MB else run.workers


def _estimate(place: Path, run: Run) -> float:
    """Seconds that the run will take: as last time, else by its pinned counts, else its time limit."""
    try:
        path = evidence.evidence_path(place, run.document, run.id)
        return float(evidence.read(path)["seconds"])
    except Unjudged:
        pass
    if run.generated is not None:
        return 1.0 + run.generated / _STATES_A_SECOND.get(run.kind, 200_000)
    return 10.0 if run.kind == "NEG" else run.timeout_s


def _record(
    place: Path,
    run: Run,
    tools: Toolchain,
    inputs: Mapping[str, str],
    judgement: Judgement,
    outcome: Outcome | None,
    started: float,
) -> dict[str, Any]:
    folder = place / "spec" / run.document
    paths: set[Path] = set()
    if outcome is not None:  # should TLC have read more than was foreseen, the run is never kept
        spec = (place / "spec").resolve()
        parsed = (Path(name) if Path(name).is_absolute() else folder / name for name in outcome.log.files)
        paths = {path for path in parsed if path.resolve().is_relative_to(spec) and path.is_file()}
    return evidence.make(
        kind="tlc",
        id=run.id,
        document=run.document,
        verdict=judgement.verdict,
        expected=run.expect,
        as_expected=judgement.as_expected,
        environment=run.environment,
        strength=strength_of(place, run),
        command=f"modeproof check {run.name}",
        started=started,
        seconds=outcome.seconds if outcome is not None else time.time() - started,
        inputs={**evidence.hashes(place, paths), **inputs},
        code=CODE,
        place=place,
        tools=entries(tools, outcome.log.version if outcome is not None else ""),
        result=_result(place, run, tools, judgement, outcome),
        reason=judgement.reason,
    )


def _result(
    place: Path, run: Run, tools: Toolchain, judgement: Judgement, outcome: Outcome | None
) -> dict[str, Any]:
    result: dict[str, Any] = {**declared(run), "jar_pinned": tools.pinned}
    if not tools.pinned:
        result["jar_note"] = f"pinned counts were taken with {JAR_VERSION}, not with this jar"
    if outcome is None:
        return result
    log = outcome.log
    root = str(place)
    result |= {
        "exit_status": outcome.status,
        "timed_out": outcome.timed_out,
        "tlc_command": shlex.join(outcome.command).replace(root, "."),
        "log": within(place, build(place) / "tlc" / run.document / f"{run.id}.log"),
        "distinct": log.counts.distinct if log.counts else None,
        "generated": log.counts.generated if log.counts else None,
        "queue": log.counts.queue if log.counts else None,
        "initial": log.initial,
        "depth": log.depth,
        "collision": log.collision,
        "printed": dict(sorted(log.tags.items())),
    }
    if judgement.violated:
        result["violated"] = judgement.violated
    if log.trace:
        result["trace_length"] = len(log.trace)
        result["loop"] = log.loop
        result["trace"] = [
            {"number": state.number, "action": state.action, "variables": dict(state.variables)}
            for state in log.trace
        ]
    if run.kind == "WIT":
        result["reached"] = list(judgement.reached)
    if run.graph is not None:
        result["graph"] = {
            "device": run.graph.device,
            "tick_ms": run.graph.tick_ms,
            "params": dict(run.graph.params),
            "pass": dict(run.graph.passed),
            "states": log.tags.get("STATE", 0),
            "edges": log.tags.get("EDGE", 0),
        }
        if outcome.graph_file is not None:
            result["graph"]["file"] = within(place, outcome.graph_file)
            result["graph"] |= {"sha256": next(iter(evidence.hashes(place, [outcome.graph_file]).values()))}
    return result

"""The command `machine --tlc`: TLC judges the contracts of the blocks and the cell over them."""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build, root
from modeproof.ground.solvers import needing_solvers
from modeproof.registers.cfg import parse_cfg
from modeproof.registers.runs import Run
from modeproof.tlc.process import FEW_STATES, SMALL_HEAP_MB, Outcome, run_tlc
from modeproof.tlc.run_judge import HOLDS, VIOLATED, Judgement, judge
from modeproof.tlc.toolchain import find_toolchain

FOLDER = "machine_cell"
HEAP_MB, TIMEOUT_S = 2048, 900


def run(args: argparse.Namespace) -> int:
    """Run them one after the other; 1 if one is not as expected, else 2 if one was not judged, else 0.

    Raises Unjudged.
    """
    place = root()
    spec = place / "spec" / FOLDER
    with needing_solvers():
        from machines import tlc_runs
    made = list(tlc_runs.tasks(args.file, spec, args.properties, args.use))
    chosen = [task for task in made if args.tlc in task.id]
    if not chosen:
        raise Unjudged(f"machine: no run of TLC has {args.tlc!r} in its name")
    own = {"file": "wiring.toml", "properties": "safety.toml", "use": "use.toml"}
    given = {spec / name: getattr(args, option) or spec / name for option, name in own.items()}
    shipped = all(path.resolve() == there.resolve() for there, path in given.items())
    found = []
    for task in chosen:
        before = _cpu()
        verdict, outcome = judged(place, task, shipped)
        print("\n".join(_lines(task, verdict, outcome, _cpu() - before)), flush=True)
        found.append(2 if not verdict.judged else 0 if verdict.as_expected else 1)
    return 1 if 1 in found else max(found)


def judged(place: Path, task: Any, shipped: bool) -> tuple[Judgement, Outcome]:
    """The judgement of a run; the counts are compared only for the shipped files. Raises Unjudged."""
    folder = build(place) / "tlc" / FOLDER / "made" / task.id
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, text in task.files.items():
        (folder / name).write_text(text, "utf-8")
    [cfg_name] = [name for name in task.files if name.endswith(".cfg")]
    text = task.files[cfg_name]
    digest = hashlib.sha256(text.encode()).hexdigest()
    row = Run(
        document=FOLDER,
        id=task.id,
        module=cfg_name.removesuffix(".cfg"),
        cfg=cfg_name,
        kind="NEG" if task.breaks else "MC",
        lanes=("full",),
        environment="arbitrary",
        heap_mb=SMALL_HEAP_MB if task.generated and task.generated < FEW_STATES else HEAP_MB,
        timeout_s=TIMEOUT_S,
        properties=task.checks,
        property=task.checks[0] if task.breaks else "",
        distinct=task.distinct,
        generated=task.generated,
        cfg_sha256=digest,
    )
    others = [path for path in sorted((place / "spec").glob("*/")) if path.name not in (FOLDER, "common")]
    outcome = run_tlc(place, row, find_toolchain(), made_in=folder, also=others)
    found = judge(row, parse_cfg(text, task.id), digest, outcome)
    if found.judged and (task.breaks or not shipped):
        expected = VIOLATED if task.breaks else HOLDS
        return Judgement(found.verdict, found.verdict == expected, violated=found.violated), outcome
    return found, outcome


def _lines(task: Any, verdict: Judgement, outcome: Outcome, seconds: float) -> Iterator[str]:
    counts = outcome.log.counts
    states = f"{counts.distinct:,} states of {counts.generated:,}" if counts else "no counts"
    about = verdict.violated or f"{len(task.checks)} checked"
    reason = f"; {verdict.reason}" if verdict.reason else ""
    yield f"{verdict.words}: {task.id}: {about}; {states}, {seconds:.1f} s CPU{reason}"
    before: dict[str, str] = {}
    for state in outcome.log.trace if verdict.verdict == VIOLATED and not verdict.as_expected else ():
        now = dict(state.variables)
        changed = [f"{name} = {value}" for name, value in now.items() if before.get(name) != value]
        yield f"  {state.number:>3} {state.action:<8} {'; '.join(changed) if before else 'power-up'}"
        before = now


def _cpu() -> float:
    used = os.times()
    return used.children_user + used.children_system

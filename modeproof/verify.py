"""`modeproof verify`: registers, TLC, proofs and conformance of every document, then one screen."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.processes import Task, in_processes
from modeproof.progress import Progress
from modeproof.registers.runs import Run, load_runs
from modeproof.report.verdicts import POSITIVE, Line, PropertyRow, property_lines, status_of
from modeproof.summary import failures, render, total
from modeproof.tlc.check import Checked, check_all, register_problems, select
from modeproof.tlc.toolchain import find_toolchain

Records = list[dict[str, Any]]
Troubles = dict[str, str]
"""By document, why a stage could not be judged."""
Stage = Callable[[Path, Sequence[str], str, Progress], tuple[Records, Troubles]]
"""(root, documents, lane, progress) -> evidence of all documents, and what could not be judged."""

REGISTERS = "registers"


def check_registers(
    place: Path, names: Sequence[str], lane: str, progress: Progress
) -> tuple[Records, Troubles]:
    """Load all registers of each document and compare them with one another and with the tree.

    The verdict is EQUAL or DIFFERS; a register that cannot be read is UNJUDGED. What concerns no single
    document is judged once, with the first.
    """
    tasks: list[Task[dict[str, Any]]] = [
        (_registers_of, (place, name, lane, number == 0)) for number, name in enumerate(names)
    ]
    return in_processes(REGISTERS, tasks, progress, lambda record: None, knowing=True), {}


def _registers_of(place: Path, document: str, lane: str, with_tree: bool) -> dict[str, Any]:
    from modeproof import registers

    evidence.discard(place, document, REGISTERS)
    started = time.time()
    problems: list[str] = []
    result: dict[str, Any] = {}
    verdict, reason = "EQUAL", ""
    try:
        problems += register_problems(place, document)
        judgement = registers.judge(registers.load_document(place, document))
        tree = registers.judge_tree(place) if with_tree else []
        problems += [str(problem) for problem in (*judgement.problems, *tree)]
        if not judgement.rows:
            problems.append("the matrix has no row")
        result = {
            "clauses": len(judgement.rows),
            "citations": judgement.citations,
            "unresolved": judgement.unresolved,
        }
        if problems:
            verdict = "DIFFERS"
            reason = problems[0] + (f" (and {len(problems) - 1} more)" if len(problems) > 1 else "")
    except Unjudged as error:
        verdict, reason = "UNJUDGED", error.message
    paths = sorted((place / "spec" / document).glob("*.toml"))
    record = evidence.make(
        kind="registers",
        id=REGISTERS,
        document=document,
        verdict=verdict,
        expected="EQUAL",
        as_expected=verdict == "EQUAL",
        strength="registers, specification, implementation and proofs cite and name the same things",
        command=f"modeproof verify --lane {lane}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, paths),
        result={"problems": problems, **result},
        reason=reason,
    )
    evidence.write(place, record)
    return record


def check_lane(place: Path, names: Sequence[str], lane: str, progress: Progress) -> tuple[Records, Troubles]:
    """Every TLC run of the lane, those of all documents in one queue, the longest first.

    A document without a run in the lane is not judged. Raises Unjudged when Java or the jar is missing.
    """
    troubles: Troubles = {}
    runs: list[Run] = []
    for document in names:
        try:
            runs += select(place, lane=lane, document=document)
            declared = {run.id for run in load_runs(place, document)}
            evidence.discard_undeclared(place, document, "tlc", declared)
        except Unjudged as error:
            troubles[document] = error.message
    if not runs:
        return [], troubles
    done = check_all(place, runs, find_toolchain(), progress, lambda checked: progress.say(line_of(checked)))
    for name in sorted({run.name for run in runs} - {one.run.name for one in done}):
        document, _, id = name.partition("/")
        troubles[document] = f"runs were not executed: {id}"
    return [one.record for one in done], troubles


def line_of(checked: Checked) -> str:
    """One line that says how a run went."""
    if checked.kept:
        words, record = checked.judgement.words, checked.record
        return (
            f"ok  {checked.run.name}: {words}; kept, of {record['started']}, {record['seconds']:.1f} s then"
        )
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


def property_rows(place: Path, document: str) -> list[PropertyRow]:
    """The declared properties. Raises Unjudged when the register cannot be read."""
    from modeproof import registers

    loaded = registers.load_document(place, document)
    return [PropertyRow(row.id, row.tla, row.environments) for row in loaded.properties]


def declared_pairs(place: Path, document: str) -> dict[str, set[tuple[str, str]]]:
    """For each run that must hold: the pairs (property, environment) that it checks."""
    return {
        run.id: {(name, run.environment) for name in run.properties}
        for run in load_runs(place, document)
        if run.kind in POSITIVE
    }


def verify(
    place: Path, names: Sequence[str], lane: str, stages: Sequence[tuple[str, Stage]], progress: Progress
) -> tuple[int, Records]:
    """Run all stages, each for all documents, and print the summary; the status is the worst of all.

    A stage that cannot be judged is reported and does not keep the others from running.
    """
    status = 0
    everything: Records = []
    bad: list[str] = []
    if not names:
        raise Unjudged("spec/ holds no document; there is nothing to verify")
    began = time.monotonic()
    for title, stage in stages:
        progress.say(f"-- {title}")
        try:
            made, troubles = stage(place, names, lane, progress)
        except Unjudged as error:
            made, troubles = [], dict.fromkeys(names, error.message)
        done = {str(record["document"]) for record in made}
        for document in names:
            if document not in done:
                troubles.setdefault(document, "nothing was done")
        for document, why in troubles.items():
            bad.append(f"{document}, {title}: UNJUDGED: {why}")
            status = 2
        everything += made
    progress.say("")
    every_line: list[Line] = []
    for document in names:
        records = [record for record in everything if record["document"] == document]
        try:
            lines = property_lines(property_rows(place, document), records, declared_pairs(place, document))
        except Unjudged as error:
            lines = []
            bad.append(f"{document}, summary of properties: UNJUDGED: {error.message}")
            status = 2
        status = max([status, *map(status_of, records), *(line.status for line in lines)])
        progress.say(render(document, lines, records))
        bad += failures(records, lines)
        every_line += lines
    if len(names) > 1:
        progress.say(total(len(names), every_line, everything, time.monotonic() - began))
    for line in dict.fromkeys(bad):
        progress.say(f"NOT AS EXPECTED  {line}")
    progress.say(f"{'evidence':<12} build/evidence/ ({len(everything)} files)")
    word = {0: "as expected", 1: "NOT as expected", 2: "NOT judged completely"}[status]
    progress.say(f"{'result':<12} {word} (exit status {status})")
    return status, everything

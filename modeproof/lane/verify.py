"""`modeproof verify`: registers, TLC, proofs and conformance of every document, then one screen."""

from __future__ import annotations

import argparse
import hashlib
import os
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, first_of
from modeproof.ground.lock import only_one
from modeproof.ground.options import add_command, write_json
from modeproof.ground.places import add_document_option, chosen_documents, documents, machines, root
from modeproof.ground.processes import Task, in_processes
from modeproof.ground.progress import Progress
from modeproof.lane.conformance import ELSEWHERE, compare_reference, comparisons, say
from modeproof.lane.demands import proofs_of_demands
from modeproof.lane.keep import NOTHING, Keep, kept_line
from modeproof.lane.machine_command import ID as MACHINE
from modeproof.lane.machine_command import judge_machine, machine_rests, troubles_of_machine
from modeproof.lane.prove_command import prove_documents
from modeproof.lane.summary import failures, machine_line, render, total
from modeproof.registers.runs import LANES, Run, load_runs
from modeproof.report.demanded import KIND
from modeproof.report.evidence_judge import doubt_on_machine
from modeproof.report.verdicts import POSITIVE, Line, PropertyRow, property_lines, status_of
from modeproof.tlc.check import check_all, register_problems, select
from modeproof.tlc.check_command import line_of
from modeproof.tlc.rests import rests_of
from modeproof.tlc.run_judge_again import doubt
from modeproof.tlc.toolchain import find_toolchain

Records = list[dict[str, Any]]
Troubles = dict[str, str]
"""By document, why a stage could not be judged."""
Stage = Callable[[Path, Sequence[str], str, Progress], tuple[Records, Troubles]]
"""(root, documents, lane, progress) -> evidence of all documents, and what could not be judged."""

REGISTERS = "registers"
REGISTERS_CODE = ("modeproof.registers", "modeproof.tlc.check")
_MADE = frozenset({"build", "__pycache__", "node_modules"})
"""Folders that hold nothing that somebody wrote; nor do those whose names begin with a dot."""


def check_registers(
    place: Path, names: Sequence[str], lane: str, progress: Progress, keep: Keep = NOTHING
) -> tuple[Records, Troubles]:
    """Load all registers of each document and compare them with one another and with the tree.

    The verdict is EQUAL or DIFFERS; a register that cannot be read is UNJUDGED. What concerns no single
    document is judged once, with the first. The comparison reads comments as well, so that any byte counts.
    """
    tree = "" if keep.anew else tree_sha256(place)
    tasks: list[Task[dict[str, Any]]] = []
    found: Records = []
    for number, name in enumerate(names):
        said = {"tree": tree, "with_tree": str(number == 0)}
        rests = partial(evidence.Rests, _registers(place, name), REGISTERS_CODE, said=said)
        if kept := keep.record(place, name, REGISTERS, rests):
            found.append(kept)
        else:
            tasks.append((_registers_of, (place, name, lane, number == 0)))
    return found + in_processes(REGISTERS, tasks, progress, lambda record: None, fork=True), {}


def tree_sha256(place: Path) -> str:
    """One hash of every file below the root that somebody wrote."""
    digest = hashlib.sha256()
    for folder, inner, files in os.walk(place):
        inner[:] = sorted(name for name in inner if name not in _MADE and not name.startswith("."))
        for path in (Path(folder) / name for name in sorted(files)):
            digest.update(f"{path.relative_to(place)} {evidence.sha256(path)}\n".encode())
    return digest.hexdigest()


def _registers(place: Path, document: str) -> dict[str, str]:
    return evidence.hashes(place, (place / "spec" / document).glob("*.toml"))


def _registers_of(place: Path, document: str, lane: str, with_tree: bool) -> dict[str, Any]:
    from modeproof import registers

    evidence.discard(place, document, REGISTERS)
    started = time.time()
    problems: list[str] = []
    result: dict[str, Any] = {"tree": tree_sha256(place), "with_tree": str(with_tree)}
    inputs = _registers(place, document)
    verdict, reason = "EQUAL", ""
    try:
        problems += register_problems(place, document)
        judgement = registers.judge(registers.load_document(place, document))
        tree = registers.judge_tree(place) if with_tree else []
        problems += [str(problem) for problem in (*judgement.problems, *tree)]
        if not judgement.rows:
            problems.append("the matrix has no row")
        result |= {
            "clauses": len(judgement.rows),
            "citations": judgement.citations,
            "unresolved": judgement.unresolved,
            "properties_fall_with": dict(judgement.falls),
        }
        if problems:
            verdict = "DIFFERS"
            reason = first_of(problems)
    except Unjudged as error:
        verdict, reason = "UNJUDGED", error.message
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
        inputs=inputs,
        code=REGISTERS_CODE,
        place=place,
        result={"problems": problems, **result},
        reason=reason,
    )
    evidence.write(place, record)
    return record


def check_lane(
    place: Path, names: Sequence[str], lane: str, progress: Progress, keep: Keep = NOTHING
) -> tuple[Records, Troubles]:
    """Every TLC run of the lane that is not kept, those of all documents in one queue, the longest first.

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
    tools = find_toolchain()
    found: Records = []
    again = []
    for run in runs:
        rests = partial(rests_of, place, run, tools)
        kept = keep.record(place, run.document, run.id, rests, partial(doubt, place, run))
        if kept is None:
            again.append(run)
        else:
            found.append(kept)
    keep.say(progress)
    done = check_all(place, again, tools, progress, lambda checked: progress.say(line_of(checked)))
    for name in sorted({run.name for run in again} - {one.run.name for one in done}):
        document, _, id = name.partition("/")
        troubles[document] = f"runs were not executed: {id}"
    return found + [one.record for one in done], troubles


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
        if run.kind in POSITIVE and not run.readings
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
            if why == ELSEWHERE:
                progress.say(f"{document}: {why}")
                continue
            bad.append(f"{document}, {title}: UNJUDGED: {why}")
            status = 2
        everything += made
    machine_records = [record for record in everything if record["kind"] == "machine"]
    if lane == "full" and set(names) == set(documents(place)):
        for name in {*machines(place)} - {record["document"] for record in machine_records}:
            bad.append(f"{name}: UNJUDGED: nothing was done")
            status = 2
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
    for record in machine_records:
        progress.say(machine_line(record))
        status = max(status, status_of(record))
    bad += failures(machine_records, [])
    for line in dict.fromkeys(bad):
        progress.say(f"NOT AS EXPECTED  {line}")
    progress.say(kept_line(everything))
    progress.say(f"{'evidence':<12} build/evidence/ ({len(everything)} files)")
    word = {0: "as expected", 1: "NOT as expected", 2: "NOT judged completely"}[status]
    progress.say(f"{'result':<12} {word} (exit status {status})")
    return status, everything


def stages_of_verify(keep: Keep = NOTHING) -> list[tuple[str, Stage]]:
    """The stages of `verify`, each with its title, in their order; none judges what `keep` keeps.

    The comparisons with the implementation go first in the queue of the theorems: the longest of them keeps
    one core for half a minute. Their stage tells what came of them; where the theorems could not be asked it
    makes them itself.
    """
    compared: list[tuple[list[dict[str, Any]], dict[str, str]]] = []

    def prove(
        place: Path, names: Sequence[str], lane: str, progress: Progress
    ) -> tuple[list[dict[str, Any]], dict[str, str]]:
        tasks, missing, found = comparisons(place, names, lane, keep)
        own = machines(place) if set(names) == set(documents(place)) else ()
        judged: list[dict[str, Any]] = []
        asked, demanded = proofs_of_demands(place, names, keep) if lane == "full" else ([], [])
        tasks = [*asked, *tasks]  # the longest of them take longer than the longest comparison

        def take(record: dict[str, Any]) -> None:
            if record["kind"] == "machine":
                judged.append(record)
                progress.say(machine_line(record))
            elif record["kind"] == KIND:
                demanded.append(record)
                say(record, progress)
            else:
                found.append(record)
                say(record, progress)

        for name in own if lane == "full" else ():
            if kept := keep.record(
                place, name, MACHINE, partial(machine_rests, place, name), doubt_on_machine
            ):
                judged.append(kept)
            else:  # it takes longest
                tasks.insert(0, (judge_machine, (place, name, keep.anew)))
        records, troubles = prove_documents(
            place, names, progress, lane=lane, beside=tasks, on_beside=take, keep=keep
        )
        compared.append((found, missing))
        if lane != "full":
            troubles |= {name: why for name in own if (why := troubles_of_machine(place, name))}
        return [*records, *demanded, *judged], troubles

    def compare(
        place: Path, names: Sequence[str], lane: str, progress: Progress
    ) -> tuple[list[dict[str, Any]], dict[str, str]]:
        return compared.pop() if compared else compare_reference(place, names, lane, progress, keep)

    return [
        ("registers", partial(check_registers, keep=keep)),
        ("TLC", partial(check_lane, keep=keep)),
        ("proofs", prove),
        ("conformance", compare),
    ]


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns the worst status of all and raises Unjudged."""
    parser = add_command(commands, "verify", run)
    parser.add_argument(
        "--lane", choices=LANES, default="full", help="smoke: under a minute; full: the default"
    )
    parser.add_argument(
        "--anew", action="store_true", help="judge everything again, whatever has not changed since"
    )
    add_document_option(parser)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    progress = Progress(quiet=args.quiet)
    names = chosen_documents(place, args.document)
    with only_one(place):
        status, records = verify(place, names, args.lane, stages_of_verify(Keep(args.anew)), progress)
        for name in names:  # everything that was written can be read back
            evidence.read_document(place, name)
        if args.lane == "full" and args.document is None:
            from modeproof.lane.walks import walk_evidence
            from modeproof.report.report_command import made_by_verify

            progress.say("-- walks of the counterexamples")
            try:
                walk_evidence(place, names, progress)
            except Unjudged as error:  # the report then shows variables, and says so
                progress.say(f"walks: UNJUDGED: {error.message}")
            for line in made_by_verify(place):
                progress.say(line)
    write_json(args, status, records=records)
    return status

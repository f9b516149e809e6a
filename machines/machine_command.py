"""The command `machine`: the verdicts on a wiring, as text and as JSON."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import itertools
import threading
import time
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from machines import flowchart as machine_picture
from machines import tlc_runs as machine_tlc
from machines import vectors as machine_vectors
from machines.composed_program import text_of, with_own_wires
from machines.concrete_runs import Scan
from machines.equality import Equality
from machines.killers import Killers, changed, read_killers
from machines.killers import as_toml as as_rows
from machines.outcomes import outcome_of
from machines.own_machine import OwnMachine, refuse_own
from machines.trial import Outcome as Tried
from machines.trial import Trial, edits
from machines.trial_record import as_json, basis_of, outcomes_path, read_outcomes
from machines.user_program import ProgramMachine, ProgramRunner
from machines.verdicts import Machine, Verdict
from machines.wiring import read_wiring
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.ground.progress import Progress
from modeproof.kit.files import write_json, write_text
from modeproof.output.junit import Case, junit_of
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from programs.certificates.certificate_folder import tools
from programs.commands.prove_properties import TRUSTED
from programs.language.tool_differences import assumed

FOLDER = Path("spec/machine_cell")
DESIGN, CLAIM = "the project's own design after the five papers", "nothing here is a claim about a paper"
OWN = f"{DESIGN}; {CLAIM}"
TRUST = ("the reader of wirings", *TRUSTED)
WORDS = ("PROVED", "REFUTED", "UNKNOWN", "NOT JUDGED", "EMPTY", "NOT ASKED")
NAME = "machine"


def run(args: argparse.Namespace) -> int:
    """Do what is asked for in the place of a judgement; the exit status. Raises Unjudged."""
    folder, progress = root() / FOLDER, Progress(quiet=args.quiet)
    file = _file(args)
    wiring = read_wiring(file)
    if args.program is not None:
        write_text(args.program, text_of(with_own_wires(wiring), f"made by modeproof from {file}"))
    if args.picture is not None:
        write_text(args.picture, machine_picture.picture(wiring))
    machine = _machine(args, progress)
    if args.model is not None:
        write_text(args.model, machine_tlc.model_of(machine, folder))
    if args.vectors is not None:
        refuse_own(machine, "the reference, which test vectors are made of,")
        return _vectors(args, file, machine.use, progress)
    with _at_work(progress):
        if args.killers:
            return _killers(machine, folder)
        if args.trial is not None:
            refuse_own(machine, "the reference, on which edits are tried,")
            ours = args.file is args.properties is args.use is None and not args.source
            kept = outcomes_path(root(), folder.name) if ours else None
            return _trial(machine, args.trial, progress, kept)
    return 0


def judge(args: argparse.Namespace) -> Outcome:
    """Judge a wiring, print the verdicts, and return what was found. Raises Unjudged.

    The status is 1 if a property is REFUTED, else 2 if one is not PROVED, else 0.
    """
    clock, progress = Clock(), Progress(quiet=args.quiet)
    machine = _machine(args, progress)
    read = _read(machine)
    with _at_work(progress):
        started = time.process_time()
        shipped = root() / FOLDER / "wiring.toml"
        own = tomllib.loads(shipped.read_text("utf-8")) if shipped.exists() and not args.source else None
        found = machine.all(args.seconds, own, args.recheck)
    seconds = time.process_time() - started
    again = args.about(args).again
    text = "\n".join([*lines_of(machine, found, seconds), f"  again       {again}"])
    print(text)
    record = record_of(machine, found, seconds, read)
    if args.json is not None:
        write_json(args.json, record)
    if args.junit is not None:
        cases = [_case(machine, verdict) for verdict in found]
        write_text(args.junit, junit_of(machine.file, cases, round(seconds, 1), "modeproof machine"))
    shown = {verdict.asked.id: list(_values(machine, verdict.scans)) for verdict in found}
    return outcome_of(machine, found, record, shown, text=text, again=again, clock=clock)


def _file(args: argparse.Namespace) -> Path:
    """The wiring."""
    file: Path = args.file or root() / FOLDER / "wiring.toml"
    return file


def _machine(args: argparse.Namespace, progress: Progress) -> Machine:
    """The wiring with its properties and its use. Raises Unjudged."""
    folder, file = root() / FOLDER, _file(args)
    wiring = read_wiring(file)  # a refusal comes before any work
    kind: Callable[..., Machine] = OwnMachine if wiring.only_by_source else Machine
    if args.source:
        kind = partial(Equality if args.equal else ProgramMachine, sources=args.source, unit=args.unit)
    names = str(file), args.properties or folder / "safety.toml", args.use or folder / "use.toml"
    tell = partial(progress.update, NAME)
    return kind(file.read_text("utf-8"), *names, tell, leave_out=args.properties is None)


def _vectors(args: argparse.Namespace, file: Path, use: Path, progress: Progress) -> int:
    """Write the vectors of a wiring."""
    folder = args.vectors
    with _at_work(progress):
        written = machine_vectors.write(folder, file, use, lambda text: progress.update(NAME, text))
        said = [f"{path}: {text}" for path, text in written]
    print("\n".join(said))
    return 0


def _read(machine: Machine) -> dict[str, str]:
    """The hashes of the files besides the wiring, which are read now: of what is judged. Raises Unjudged."""
    paths = [*(() if isinstance(machine, Equality) else (machine.properties,)), machine.use]
    before = {str(path): _sha256(path) for path in paths}
    assert machine.every.rows is not None
    assert machine.runner.use is not None
    for name, known in before.items():
        if _sha256(Path(name)) != known:
            raise Unjudged(f"{name}: it was written to while it was read; run it again")
    return before


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None


def basis_said(machine: Machine) -> str:
    """Whose design a machine is, and whose properties these are."""
    whose = [_whose(Path(machine.file)), "" if isinstance(machine, Equality) else _whose(machine.properties)]
    if {*whose} <= {DESIGN, ""}:
        return OWN
    said = zip(("the wiring is", "the properties are"), whose, strict=True)
    return "; ".join([*(f"{what} {name}" for what, name in said if name), CLAIM])


def _whose(path: Path) -> str:
    """Whether it is a file that is shipped."""
    shipped = [(root() / FOLDER / name).resolve() for name in ("wiring.toml", "safety.toml")]
    return DESIGN if path.resolve() in shipped else "yours"


@contextlib.contextmanager
def _at_work(progress: Progress) -> Iterator[None]:
    """Say on standard error that the work goes on, also during a long question."""
    over = threading.Event()

    def tick() -> None:
        while not over.wait(1):
            progress.tick()

    clock = threading.Thread(target=tick, daemon=True)
    progress.expect(1)
    progress.begin(NAME)
    clock.start()
    try:
        yield
    finally:
        over.set()
        clock.join()
        progress.end(NAME)


def _case(machine: Machine, verdict: Verdict) -> Case:
    """A property as a test case of JUnit."""
    said = {"property": verdict.asked.text, "hazard": verdict.row["hazard"], "how": verdict.how}
    said |= {"wiring": machine.file, "sha256": hashlib.sha256(machine.text.encode()).hexdigest()}
    return Case(verdict.asked.id, verdict.word, "\n".join(_verdict(machine, verdict)), said)


def status(found: Sequence[Verdict]) -> int:
    """The exit status."""
    words = {verdict.word for verdict in found}
    return 1 if "REFUTED" in words else 0 if words == {"PROVED"} else 2


def lines_of(machine: Machine, found: Sequence[Verdict], seconds: float) -> Iterator[str]:
    """What is printed: a line for each property that is PROVED, more for the others."""
    table = machine.wiring.table
    yield f"machine {table.title}"
    yield from (f"  program     {file}" for file in machine.files)
    equal = isinstance(machine, Equality)
    yield f"  wiring      {machine.file}{' (what the names mean)' * bool(machine.files and not equal)}"
    asked = "each output is as the wiring gives it" if equal else str(machine.properties)
    whose = _whose(Path(machine.file) if equal else machine.properties)
    yield f"  properties  {asked} ({whose}; {CLAIM})"
    low, high = table.scan_ms
    yield f"  scans       of {low} to {high} ms, set to {table.cycle_ms}; any inputs, from power-up, for ever"
    if choices := taken(machine):
        yield f"  assumed     {'; '.join(choices)}"
    for verdict in found:
        yield from _verdict(machine, verdict)
    for why in dict.fromkeys(machine.not_asked.values()):
        yield f"  not asked   {', '.join(id for id, own in machine.not_asked.items() if own == why)}: {why}"
    words = [verdict.word for verdict in found]
    seen = (*WORDS[:3], *(word for word in WORDS[3:] if word in words))
    counts = [f"{words.count(word)} {word}" for word in seen]
    yield f"  verdicts    {', '.join(counts)}"
    if proved := [one.how for one in found if one.word == "PROVED"]:
        yield f"  by          {proved[0]}"
    yield f"  trusted     {', '.join(TRUST)}"
    yield f"  effort      {seconds:.1f} s CPU"


def _verdict(machine: Machine, verdict: Verdict) -> Iterator[str]:
    yield f"{verdict.word}: {verdict.asked.id}: {verdict.asked.sentence}"
    if verdict.word == "PROVED":
        return
    yield f"  property    {verdict.asked.text}"
    yield f"  hazard      {verdict.row['hazard']}"
    yield f"  {'trace' if verdict.scans else 'missing':<11} {verdict.how}"
    yield from trace_lines(list(rows_of_trace(machine, verdict.scans)))
    for row in verdict.mended:
        yield f"  wire        {row}"


def trace_lines(rows: Sequence[tuple[int, str, str]]) -> Iterator[str]:
    """The rows of a trace; scans in which nothing changes are in one line."""

    def alike(numbered: tuple[int, tuple[int, str, str]]) -> tuple[int, ...]:
        number, (dt_ms, given, gives) = numbered
        return (number, dt_ms) if given or gives or number == len(rows) else (dt_ms,)

    for _, group in itertools.groupby(enumerate(rows, 1), alike):
        (first, (dt_ms, given, gives)), *more = group
        number = more[-1][0] if more else first
        where = f"scans {first}-{number}" if more else f"{'wrong ' * (number == len(rows))}scan {number}"
        yield f"  {where:<13} after {dt_ms} ms{' each' if more else ''}: {given or 'the same inputs'}"
        if gives:
            yield f"                gives {gives}"


def rows_of_trace(machine: Machine, scans: Sequence[Scan]) -> Iterator[tuple[int, str, str]]:
    """The time of each scan, and what changes at the inputs, then at outputs and signals."""
    before: Mapping[str, Any] = {}
    shown: Mapping[str, Any] = {}
    for dt_ms, given, values in _values(machine, scans):
        yield dt_ms, changed(before, given), changed(shown, values)
        before, shown = given, values


def _values(
    machine: Machine, scans: Sequence[Scan]
) -> Iterator[tuple[int, Mapping[str, Any], Mapping[str, Any]]]:
    table, runner = machine.wiring.table, machine.runner
    names = [*table.outputs, *table.modes, *table.signals, *(f"{name}.Q1" for name in table.block)]
    names += runner.shown if isinstance(runner, ProgramRunner) else []
    blocks = [f"{name}.{pin}" for name in table.block for pin in ("S_GuardLocked", "Error", "Q1")]
    for (dt_ms, inputs), values in zip(scans, runner.replayed(scans), strict=True):
        chosen = dict.fromkeys(name for name in (*names, *blocks) if name in values)
        yield dt_ms, inputs, {name: values[name] for name in chosen}


def taken(machine: Machine) -> list[str]:
    """What a verdict on a source takes as given."""
    return (
        list(assumed(machine.cell.source, machine.cell.unit)) if isinstance(machine, ProgramMachine) else []
    )


def record_of(
    machine: Machine, found: Sequence[Verdict], seconds: float, read: Mapping[str, str]
) -> dict[str, Any]:
    """The verdicts as JSON. read: the hashes of the files besides the wiring."""
    return {
        "command": "machine",
        "basis": basis_said(machine),
        "program": dict(machine.files),
        "wiring": {machine.file: hashlib.sha256(machine.text.encode()).hexdigest()},
        "files": dict(read),
        "tools": tools(),
        "trusted": list(TRUST),
        "assumed": taken(machine),
        "scan_time_ms": list(machine.wiring.table.scan_ms),
        "status": status(found),
        "verdicts": verdict_rows(found),
        "not_asked": dict(machine.not_asked),
        "cpu_seconds": round(seconds, 1),
    }


def verdict_rows(found: Sequence[Verdict]) -> list[dict[str, Any]]:
    """Each verdict as data."""
    return [
        {
            "id": verdict.asked.id,
            "sentence": verdict.asked.sentence,
            "property": verdict.asked.text,
            "hazard": verdict.row["hazard"],
            "cites": verdict.row["cites"],
            "verdict": verdict.word,
            "how": verdict.how,
            "reached_in_scans": list(verdict.reached),
            "wires": list(verdict.mended),
            "trace": [{"dt_ms": dt_ms, "in": dict(given)} for dt_ms, given in verdict.scans],
        }
        for verdict in found
    ]


# ---------------------------------------------------------------- the wiring on trial


def _killers(machine: Machine, folder: Path) -> int:
    """Renew the rows of killers.toml; 1 if a property has none."""
    path, judge = folder / "killers.toml", Killers(machine)
    found = judge.renewed(read_killers(path), outcomes_path(root(), folder.name))
    write_text(path, as_rows(found))
    left = judge.problems(found)
    said = [f"{id}: {why}" for id, why in left.items()]
    print("\n".join([*said, f"{path}: {len(found)} of {len(judge.rows)} properties are broken by an edit"]))
    return 1 if left else 0


def _trial(machine: Machine, part: str, progress: Progress, kept: Path | None) -> int:
    """Judge the edits; with a file of outcomes, those that it does not have, and write it after each."""
    trial, every = Trial(machine), list(edits(machine.text, machine.wiring))
    chosen = [edit for edit in every if part in f"{edit.kind}: {edit.id}"]
    if not chosen:
        raise Unjudged(f"machine: no edit has {part!r} in its name")
    basis = basis_of(machine) if kept is not None else {}
    known = read_outcomes(kept, basis) if kept is not None else {}
    found = {
        edit.id: Tried(edit, row["verdict"], row["by"], row["scans"])
        for edit in every
        if (row := known.get(edit.id)) is not None
    }
    for judge in (trial.run, trial.prove, trial.of):  # what takes long comes last
        for edit in chosen:
            machine.tell(edit.id)
            if edit.id in found or (outcome := judge(edit)) is None:
                continue
            found[edit.id] = outcome
            scans = f" in {outcome.scans} scans" if outcome.scans else ""
            progress.say(f"{outcome.word}{scans}: {edit.kind}: {edit.id}: {', '.join(outcome.by)}")
            if kept is not None:
                kept.parent.mkdir(parents=True, exist_ok=True)
                write_text(kept, as_json([found[edit.id] for edit in every if edit.id in found], basis))
    words = [found[edit.id].word for edit in chosen]
    print(", ".join(f"{words.count(word)} {word}" for word in sorted({*words})))
    return 1 if "SURVIVED" in words else 0

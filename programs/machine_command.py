"""The command `machine`: the verdicts on a wiring, as text and as JSON."""

from __future__ import annotations

import argparse
import hashlib
import sys
import time
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.files import write_json, write_text
from programs import certificate, machine_picture
from programs.machine import Machine, Verdict
from programs.machine_trial import Outcome, Trial, as_toml, basis_of, edits, read_record
from programs.property_command import TRUSTED
from programs.wired import text_of, unit
from programs.wiring import read_wiring

FOLDER = Path("spec/machine_cell")
OWN = "the project's own design after the five papers; nothing here is a claim about a paper"


def run(args: argparse.Namespace) -> int:
    """Judge a wiring; 1 if a property is REFUTED, else 2 if one is not PROVED, else 0. Raises Unjudged."""
    folder = root() / FOLDER
    file = args.file or folder / "wiring.toml"
    wiring = read_wiring(file)
    if args.program is not None:
        write_text(args.program, text_of(unit(wiring), f"made by modeproof from {file}"))
    if args.picture is not None:
        write_text(args.picture, machine_picture.picture(wiring))
    if args.program is not None or args.picture is not None:
        return 0
    machine = Machine(
        file.read_text("utf-8"),
        str(file),
        args.properties or folder / "safety.toml",
        args.use or folder / "use.toml",
        _tell,
    )
    if args.trial is not None:
        return _trial(machine, args.trial, folder / "trial.toml" if args.record else None)
    started = time.process_time()
    shipped = folder / "wiring.toml"
    own = tomllib.loads(shipped.read_text("utf-8")) if shipped.exists() else None
    found = machine.all(args.seconds, own, args.recheck)
    _tell("")
    seconds = time.process_time() - started
    print("\n".join(lines_of(machine, found, seconds)))
    if args.json is not None:
        write_json(args.json, record_of(machine, found, seconds))
    return status(found)


def _tell(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)


def status(found: Sequence[Verdict]) -> int:
    """The exit status."""
    words = {verdict.word for verdict in found}
    return 1 if "REFUTED" in words else 0 if words == {"PROVED"} else 2


def lines_of(machine: Machine, found: Sequence[Verdict], seconds: float) -> Iterator[str]:
    """What is printed: a line for each property that is PROVED, more for the others."""
    table = machine.wiring.table
    yield f"machine {table.title}"
    yield f"  wiring      {machine.file}"
    yield f"  properties  {machine.properties} ({OWN})"
    low, high = table.scan_ms
    yield f"  scans       of {low} to {high} ms, set to {table.cycle_ms}; any inputs, from power-up, for ever"
    for verdict in found:
        yield f"{verdict.word}: {verdict.asked.id}: {verdict.asked.sentence}"
        if verdict.word == "PROVED":
            continue
        yield f"  property    {verdict.asked.text}"
        yield f"  hazard      {verdict.row['hazard']}"
        yield f"  {'trace' if verdict.scans else 'missing':<11} {verdict.how}"
        yield from trace_of(machine, verdict)
        for row in verdict.mended:
            yield f"  wire        {row}"
    counts = [f"{sum(one.word == word for one in found)} {word}" for word in ("PROVED", "REFUTED", "UNKNOWN")]
    yield f"  verdicts    {', '.join(counts)}"
    if proved := [one.how for one in found if one.word == "PROVED"]:
        yield f"  by          {proved[0]}"
    yield f"  trusted     the reader of wirings, {', '.join(TRUSTED)}"
    yield f"  effort      {seconds:.1f} s CPU"


def trace_of(machine: Machine, verdict: Verdict) -> Iterator[str]:
    """The scans of a counterexample: what changes at the inputs, then at outputs and signals."""
    before: Mapping[str, Any] = {}
    shown: Mapping[str, Any] = {}
    for number, (dt_ms, given, values) in enumerate(_values(machine, verdict), 1):
        word = "wrong scan" if number == len(verdict.scans) else "scan"
        yield f"  {f'{word} {number}':<13} after {dt_ms} ms: {_changed(before, given) or 'the same inputs'}"
        if changes := _changed(shown, values):
            yield f"                gives {changes}"
        before, shown = given, values


def _values(machine: Machine, verdict: Verdict) -> Iterator[tuple[int, Mapping[str, Any], Mapping[str, Any]]]:
    table, runner = machine.wiring.table, machine.runner
    names = [*table.outputs, *table.modes, *table.signals, *(f"{name}.Q1" for name in table.block)]
    blocks = [f"{name}.{pin}" for name in table.block for pin in ("S_GuardLocked", "Error", "Q1")]
    for (dt_ms, inputs), values in zip(verdict.scans, runner.replayed(verdict.scans), strict=True):
        chosen = dict.fromkeys(name for name in (*names, *blocks) if name in values)
        yield dt_ms, inputs, {name: values[name] for name in chosen}


def _changed(before: Mapping[str, Any], values: Mapping[str, Any]) -> str:
    """What is not as before; at first, what is not FALSE or 0. Words are hexadecimal."""
    return ", ".join(
        f"{name}={int(value)}" if isinstance(value, bool) else f"{name}={value:04X}"
        for name, value in values.items()
        if int(before.get(name, 0)) != int(value)
    )


def record_of(machine: Machine, found: Sequence[Verdict], seconds: float) -> dict[str, Any]:
    """The verdicts as JSON."""
    files = {str(path): path for path in (machine.properties, machine.use)}
    return {
        "command": "machine",
        "basis": OWN,
        "wiring": {machine.file: hashlib.sha256(machine.text.encode()).hexdigest()},
        "files": {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items()},
        "tools": certificate.tools(),
        "trusted": ["the reader of wirings", *TRUSTED],
        "scan_time_ms": list(machine.wiring.table.scan_ms),
        "status": status(found),
        "verdicts": [
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
        ],
        "cpu_seconds": round(seconds, 1),
    }


# ---------------------------------------------------------------- the wiring on trial


def _trial(machine: Machine, part: str, record: Path | None) -> int:
    """Judge the edits; with a record, those that it does not have, and write it after each."""
    trial, every = Trial(machine), list(edits(machine.text, machine.wiring))
    chosen = [edit for edit in every if part in f"{edit.kind}: {edit.id}"]
    if not chosen:
        raise Unjudged(f"machine: no edit has {part!r} in its name")
    basis = basis_of(machine) if record is not None else {}
    known = read_record(record.read_text("utf-8"), basis) if record is not None and record.exists() else {}
    found = {
        edit.id: Outcome(edit, row["verdict"], row["by"], row.get("scans", 0))
        for edit in chosen
        if (row := known.get(edit.id)) is not None
    }
    for judge in (trial.run, trial.prove, trial.of):  # what takes long comes last
        for edit in chosen:
            _tell(edit.id)
            if edit.id in found or (outcome := judge(edit)) is None:
                continue
            _tell("")
            found[edit.id] = outcome
            scans = f" in {outcome.scans} scans" if outcome.scans else ""
            print(f"{outcome.word}{scans}: {edit.kind}: {edit.id}: {', '.join(outcome.by)}", flush=True)
            if record is not None:
                done = [found[edit.id] for edit in chosen if edit.id in found]
                write_text(record, as_toml(done, len(every), basis))
    words = [outcome.word for outcome in found.values()]
    print(", ".join(f"{words.count(word)} {word}" for word in sorted({*words})))
    return 1 if "SURVIVED" in words else 0

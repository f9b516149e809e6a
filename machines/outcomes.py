"""What `machine` found about a wiring as an `Outcome`, of which all other forms are made."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from machines.verdicts import Machine, Verdict
from modeproof.output.options import Clock
from modeproof.output.outcome import (
    Counterexample,
    Demand,
    File,
    Outcome,
    Problem,
    Rule,
    Scan,
    Spot,
    files,
    shown_path,
    tools,
)
from modeproof.output.rules import rules_of
from programs.language.tree import Place

Values = Sequence[tuple[int, Mapping[str, Any], Mapping[str, Any]]]
"""Of each scan its time, the inputs, and the signals after it."""
ORDER = ("REFUTED", "UNKNOWN", "NOT JUDGED", "EMPTY", "NOT ASKED", "PROVED")
_WIRE = re.compile(r"(.+):(\d+): ([\w.]+); ")
_NAME = re.compile(r"[A-Za-z_]\w*(?:\.\w+)*")


def outcome_of(
    machine: Machine,
    found: Sequence[Verdict],
    record: Mapping[str, Any],
    shown: Mapping[str, Values],
    *,
    text: str,
    again: str,
    clock: Clock,
) -> Outcome:
    """A run of the command. record: the same as it writes it as JSON; shown: the scans of each property."""
    words = [verdict.word for verdict in found]
    low, high = machine.wiring.table.scan_ms
    word = next(word for word in ORDER if word in words)
    whole = all(path in record["files"] for path in (str(machine.properties),))
    return Outcome(
        command="machine",
        subject=shown_path(next(iter(machine.files), machine.file)),
        target=shown_path(machine.properties) if whole else shown_path(machine.file),
        word=word,
        status=record["status"],
        sentence=f"{word}: {', '.join(f'{words.count(one)} {one}' for one in ORDER if one in words)}",
        strength=f"every input, scans of {low} to {high} ms, from power-up, for ever",
        demands=[_demand(machine, verdict, shown[verdict.asked.id]) for verdict in found],
        files=_files(machine, record),
        tools=tools(record["tools"]),
        assumptions=[*record["assumed"], record["basis"]],
        trusted=record["trusted"],
        not_shown=[
            f"scans outside {low} to {high} ms",
            "what no property names",
            "what the compiler, the PLC and the devices make of the wiring",
            *(f"{one.asked.id}: {one.how}" for one in found if one.word in ("NOT JUDGED", "NOT ASKED")),
            *(f"{id}: not asked, {why}" for id, why in machine.not_asked.items()),
        ],
        text=text,
        again=again,
        started=clock.started,
        seconds=clock.seconds,
    )


def _files(machine: Machine, record: Mapping[str, Any]) -> list[File]:
    roles = {str(machine.properties): "properties", str(machine.use): "use"}
    return [
        *files("program", record["program"]),
        *files("wiring", record["wiring"]),
        *(row for path, digest in record["files"].items() for row in files(roles[path], {path: digest})),
    ]


def _demand(machine: Machine, verdict: Verdict, shown: Values) -> Demand:
    asked = verdict.asked
    known = [row for row in machine.every.rows if row["id"] == asked.id]
    source = _said(machine.every.place(known[0])) if known else shown_path(machine.file)
    rule = Rule(id=asked.id, kind="property", sentence=asked.sentence, source=source)
    problems = []
    if verdict.word != "PROVED":
        problems.append(
            Problem(
                rule=rule,
                others=rules_of(verdict.row["cites"]),
                message=_message(verdict),
                spot=_spot(machine, verdict),
                counterexample=_counterexample(verdict, shown) if verdict.scans else None,
            )
        )
    return Demand(
        id=asked.id,
        word=verdict.word,
        sentence=asked.sentence,
        text=asked.text,
        strength=verdict.how,
        problems=problems,
    )


def _message(verdict: Verdict) -> str:
    if not verdict.scans:
        return f"{verdict.how}: {verdict.asked.sentence}"
    number = len(verdict.scans)
    said = f"false after {number} scan{'s' * (number > 1)} from power-up: {verdict.asked.sentence}"
    said += f" Hazard: {verdict.row['hazard']}"
    wires = "".join(f" Wire {row.partition(': ')[2]}." for row in verdict.mended)
    return f"{said}{wires}"


def _counterexample(verdict: Verdict, shown: Values) -> Counterexample:
    scans = [Scan(dt_ms=dt_ms, inputs=_words(given), given=_words(values)) for dt_ms, given, values in shown]
    named = {*_NAME.findall(verdict.asked.text)}
    return Counterexample(
        scans=scans,
        wrong=[name for name in scans[-1].given if name in named],
        found_by=verdict.how,
    )


def _words(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values as on the wire: what is no BOOL is a WORD, in hexadecimal."""
    return {
        name: value if isinstance(value, bool) else f"{value:04X}" if isinstance(value, int) else value
        for name, value in values.items()
    }


def _spot(machine: Machine, verdict: Verdict) -> Spot:
    """The wire with which the scans break nothing if it is as in the project's own machine; else the wire of
    an output that the property names; else the file.
    """
    for row in verdict.mended:
        if at := _WIRE.match(row):
            return Spot(file=shown_path(at[1]), line=int(at[2]))
    if machine.files:
        return _program_spot(machine)
    for name in _NAME.findall(verdict.asked.text):
        if f"outputs.{name}" in machine.wiring.lines:
            return _at(machine.wiring.place(f"outputs.{name}"))
    return Spot(file=shown_path(machine.file))


def _program_spot(machine: Machine) -> Spot:
    cell = machine.cell
    return _at(cell.unit.place)


def _at(place: Place) -> Spot:
    return Spot(file=shown_path(Path(place.file)), line=place.line)


def _said(place: Place) -> str:
    return f"{shown_path(place.file)}:{place.line}"

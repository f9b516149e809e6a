"""The command `prove-program --property`: properties of a program that calls the documents' blocks."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.files import write_text
from modeproof.output.junit import Case, junit_of
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from programs.certificates import property_certificate
from programs.certificates.certificate_folder import digest, tools
from programs.commands.outcomes import outcome_of_properties
from programs.commands.results import write_record
from programs.language.tool_differences import assumed
from programs.properties.property_file import interval_of, read_questions
from programs.properties.property_verdicts import Found, Judgement
from programs.properties.transition_system import Cell
from programs.readers.sources import read_sources

TRUSTED = (*property_certificate.TRUSTED, "z3")

WRAP = "wrap where they leave their types; that they never do was not asked"


def judge_properties(args: argparse.Namespace) -> Outcome:
    """Judge each property, print it, and return what was found. Raises Unjudged.

    The status is 1 if one is REFUTED, else 2 if one is not PROVED, else 0.
    """
    if args.binding is not None:
        raise Unjudged("--binding belongs to --target; properties use the names of the program")
    started, clock = time.process_time(), Clock()

    def tell(text: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)

    judgement, found = judged(args.files, args.property, args.unit, args.wrap, args.seconds, tell)
    cell, lines = judgement.cell, []
    if args.certificate is not None and status(found) == 0:
        tell("writing the certificate")
        property_certificate.write(judgement, found, args.property, args.certificate)
        lines.append(f"  certificate {args.certificate}; check it with --recheck {args.certificate}")
    elif args.certificate is not None:
        lines.append("  certificate none: not every property is PROVED")
    tell("")
    seconds = time.process_time() - started
    text = "\n".join([*text_of(cell, found, seconds), *lines])
    print(text)
    record = record_of(cell, found, args.property, seconds)
    write_record(root(), record, args.json)
    if args.junit is not None:
        cases = [_case(cell, verdict) for verdict in found]
        write_text(args.junit, junit_of(cell.unit.name, cases, record["cpu_seconds"]))
    questions = read_questions(args.property)
    return outcome_of_properties(args, cell, found, questions, record, text, clock)


def _case(cell: Cell, found: Found) -> Case:
    """A property as a test case of JUnit."""
    said = {"property": found.asked.text, "how": found.how}
    return Case(found.asked.id, found.word, "\n".join(_verdict(cell, found)), {**said, **cell.source.files})


def judged(
    files: Sequence[Path], properties: Path, unit: str | None, wrap: bool, seconds: float, tell: Any
) -> tuple[Judgement, list[Found]]:
    """The program with its properties, and the verdict on each. Raises Unjudged with file, line and cause."""
    questions = read_questions(properties)
    source = read_sources(list(files))
    chosen = source.chosen(unit)
    cell = Cell.of(source, chosen, questions.times(source, chosen), wrap)
    judgement = Judgement(cell, questions.asked(cell), seconds, tell)
    return judgement, judgement.all()


def status(found: Sequence[Found]) -> int:
    """The exit status."""
    words = {verdict.word for verdict in found}
    return 1 if "REFUTED" in words else 0 if words == {"PROVED"} else 2


# ---------------------------------------------------------------- what is printed


def text_of(cell: Cell, found: Sequence[Found], seconds: float) -> Iterator[str]:
    """The verdicts in lines."""
    yield f"{cell.unit.kind} {cell.unit.name} of {', '.join(cell.source.files)}"
    blocks = [f"{name} ({block.reference.document})" for name, block in cell.blocks.items()]
    yield f"  blocks      {', '.join(blocks) or 'none of the documents'}"
    yield f"  scans       of {_times(cell)}; every input, from power-up, for ever"
    if choices := list(assumed(cell.source, cell.unit)):
        yield f"  assumed     {'; '.join(choices)}"
    if cell.clock:
        yield "  dt_ms       is the time since the scan before"
    if cell.wrap:
        yield f"  numbers     {WRAP}"
    for verdict in found:
        yield from _verdict(cell, verdict)
    yield f"  trusted     {', '.join(TRUSTED)}"
    yield f"  effort      {seconds:.1f} s CPU"


def _verdict(cell: Cell, found: Found) -> Iterator[str]:
    asked = found.asked
    word = f"HOLDS up to {found.scans} scans" if found.word == "HOLDS" else found.word
    yield f"{word}: {asked.id}: {asked.sentence}"
    yield f"  property    {asked.text}"
    how = {"PROVED": "by", "REFUTED": "shortest", "EMPTY": "empty"}.get(found.word, "missing")
    yield f"  {how:<11} {found.how}"
    if found.reached:
        texts = ", ".join(f"`{text}`" for text, _ in asked.trigger)
        longest = max(len(trace.scans) for trace in found.reached)
        yield f"  not empty   {texts}: true within {longest} scans"
    if found.trace is None:
        return
    names = {key: variable.name for key, variable in cell.unit.variables.items()}
    if found.trace.retained:
        yield "  retained    " + _row(found.trace.retained)
    before: Mapping[str, Any] = {}
    shown: Mapping[str, Any] = {}
    for number, (dt_ms, inputs) in enumerate(found.trace.scans, 1):
        given = {
            names.get(path.partition("[")[0], path) + "".join(path.partition("[")[1:]): value
            for path, value in inputs.items()
        }
        yield f"  scan {number:<6} after {dt_ms} ms: {_row(_changed(before, given)) or 'the same inputs'}"
        before = given
        if number <= len(found.trace.rows):
            row = found.trace.rows[number - 1]
            yield f"              gives {_row(_changed(shown, row)) or 'the same outputs'}"
            shown = row
    if found.trace.stopped:
        yield f"              stops: {found.trace.stopped}"


def _changed(before: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name not in before or before[name] != value}


def _row(values: Mapping[str, Any]) -> str:
    return ", ".join(
        f"{name}={int(value) if isinstance(value, bool) else value}" for name, value in values.items()
    )


def _not_shown(cell: Cell) -> Iterator[str]:
    """What the verdicts say nothing about, in words."""
    yield f"scans outside {_times(cell)}"
    yield "outputs, variables and pins that no property names"
    if cell.wrap:
        yield f"numbers: {WRAP}"
    yield from (f"a tool for which this is not so: {text}" for text in assumed(cell.source, cell.unit))
    yield "what the compiler and the PLC make of the source"


def _times(cell: Cell) -> str:
    low, high = cell.scan_time
    if low == high and low == interval_of(cell.source, cell.unit):
        return f"{low:,} ms, the interval of its task"
    return f"{low} to {high:,} ms" if high is not None else f"{low} ms or more"


def record_of(cell: Cell, found: Sequence[Found], properties: Path, seconds: float) -> dict[str, Any]:
    """The verdicts as JSON."""
    return {
        "command": "prove-program",
        "unit": cell.unit.name,
        "sources": dict(cell.source.files),
        "properties": {str(properties): digest(properties)},
        "reference": property_certificate.reference_of(cell),
        "tools": tools(),
        "trusted": list(TRUSTED),
        "not_shown": list(_not_shown(cell)),
        "blocks": {name: block.reference.device.name for name, block in cell.blocks.items()},
        "scan_time_ms": list(cell.scan_time),
        "wrap": cell.wrap,
        "status": status(found),
        "verdicts": [_as_record(verdict) for verdict in found],
        "cpu_seconds": round(seconds, 1),
    }


def _as_record(found: Found) -> dict[str, Any]:
    record: dict[str, Any] = {
        "id": found.asked.id,
        "sentence": found.asked.sentence,
        "property": found.asked.text,
        "verdict": found.word,
        "how": found.how,
        "bound_in_scans": found.scans or None,
    }
    if found.trace is not None:
        record["trace"] = {
            "retained": dict(found.trace.retained),
            "scans": [{"dt_ms": dt_ms, "in": dict(inputs)} for dt_ms, inputs in found.trace.scans],
            "after": [dict(row) for row in found.trace.rows],
            "stopped": found.trace.stopped,
        }
    return record

"""A log of a whole machine, beside the composed reference: blocks that are wired as a file says.

Nothing is left open here, so no model checker is needed: the log has every input and time of every scan from
power-up, and the reference has one answer. A machine is a folder of spec/ with a wiring.toml.
"""

from __future__ import annotations

import argparse
import json
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.graph.values import ValueForms
from modeproof.ground import evidence
from modeproof.ground.errors import LONGEST, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.kit.builtin import REFERENCE
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.errors import plain
from modeproof.kit.machine_reference import Wired
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from modeproof.registers.rows import Device, Signal
from modeproof.trace.log import Log, Row
from modeproof.trace.outcomes import outcome_of_machine
from modeproof.trace.targets import Part, Target

FILE = "wiring.toml"
TYPES = {"BOOL": "bool", "WORD": "word"}
NOT_SHOWN = "a log shows one run; the wiring itself is judged by `modeproof machine`"


@dataclass(frozen=True)
class Found:
    """How many lines fit, and of the first that does not what was expected, and what was on before it."""

    accepted: int
    compared: Mapping[str, int]
    """For each output the lines that show it."""
    expected: Mapping[str, Any]
    before: Sequence[str]


def is_machine(place: Path, name: str) -> bool:
    """Whether the project has a machine of this name."""
    return (place / "spec" / name / FILE).is_file()


def judge(
    args: argparse.Namespace, place: Path, read: Callable[[argparse.Namespace, Target], Log], clock: Clock
) -> Outcome:
    """Judge a log, print the verdict, and return what was found. Raises Unjudged."""
    file = args.wiring or place / "spec" / args.target / FILE
    if args.samples is not None or args.begins != "power-up":
        raise Unjudged("a log of a machine has every scan from power-up: no --samples, no --from anywhere")
    table = _table(file)
    program = _program(args.target, table, file)
    target = target_of(args.target, table, program.first())
    log = read(args, target)
    found = judged(log, target, program, (0, *table["scan_ms"], table["cycle_ms"]))
    word = "CONFORMS" if found.accepted == len(log.rows) else "DIFFERS"
    text = "\n".join(plain(line, LONGEST) for line in lines_of(log, target, found, word, file))
    print(text)
    if args.json is not None:
        status = int(word == "DIFFERS")
        row = None if word == "CONFORMS" else log.rows[found.accepted]
        record = {
            "command": "trace",
            "status": status,
            "verdict": word,
            "target": target.id,
            "wiring": {str(file): evidence.sha256(file)},
            "log": {"name": args.log.name, "sha256": evidence.sha256(args.log), "lines": len(log.rows)},
            "accepted": found.accepted,
            "compared": dict(found.compared),
            "first": None if row is None else {"line": row.line, "in": row.inputs, "out": row.outputs},
            "expected": dict(found.expected),
        }
        write_whole(args.json, (json.dumps(record, indent=1) + "\n").encode())
    unseen = [name for name, count in found.compared.items() if not count]
    return outcome_of_machine(
        args, log, found.accepted, found.expected, file, [*map(_unseen, unseen), NOT_SHOWN], text, clock
    )


def _unseen(name: str) -> str:
    return f"output {name}: no line that fits shows it"


def _table(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(file.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{file}: no wiring: {getattr(error, 'strerror', None) or error}") from None


def _program(name: str, table: Mapping[str, Any], file: Path) -> Wired:
    try:
        return Wired(REFERENCE, name, table)
    except KitUnjudged as error:
        raise Unjudged(f"{file}: {error}; `modeproof machine {file}` says what is wrong") from None


def target_of(name: str, table: Mapping[str, Any], first: Mapping[str, Any]) -> Target:
    """What the readers of logs know of the machine: its signals. first: the outputs at power-up."""
    kinds = {signal: TYPES[row["type"]] for signal, row in table["inputs"].items()}
    shown = {signal: "bool" if isinstance(value, bool) else "word" for signal, value in first.items()}
    device = Device(
        id=name,
        title=table["title"],
        module="",
        published=True,
        states=(),
        steps=(),
        memory={},
        inputs=_signals(kinds),
        outputs=_signals(shown),
        parameters={},
    )
    part = Part(device, "", "", "")
    return Target(name, name, "", "", "", {}, {name: part}, ValueForms(()))


def _signals(kinds: Mapping[str, str]) -> dict[str, Signal]:
    return {
        name: Signal(name=name, type=kind, clauses=(), why=name, python=name, tla="")  # type: ignore[arg-type]
        for name, kind in kinds.items()
    }


def judged(log: Log, target: Target, program: Wired, times: Sequence[int]) -> Found:
    """Follow the log. times: what the first scan may have taken in ms, where the log does not say."""
    compared = dict.fromkeys(target.only.device.outputs, 0)
    states = [program.code.power_up(program.cell)]
    for number, row in enumerate(log.rows):
        _complete(log, target, number, row)
        after = []
        expected: Mapping[str, Any] = {}
        for before in states:
            for dt_ms in [row.dt_ms] if row.dt_ms is not None else dict.fromkeys(times):
                state, gives = program.code.step(program.cell, before, row.inputs, dt_ms)
                if all(value == gives[name] for name, value in row.outputs.items()):
                    after.append(state)
                else:
                    expected = expected or gives
        if not after:
            on = program.on(states[0], log.rows[number - 1].inputs) if number else []
            return Found(number, compared, expected, on)
        states = after
        for name in row.outputs:
            compared[name] += 1
    if not any(compared.values()):
        raise Unjudged(f"{log.name}: no line shows an output, so nothing was compared")
    return Found(len(log.rows), compared, {}, ())


def _complete(log: Log, target: Target, number: int, row: Row) -> None:
    """Refuse a line that leaves something open. Raises Unjudged."""
    if missing := [name for name in target.only.device.inputs if name not in row.inputs]:
        raise Unjudged(
            f"{log.name}: line {row.line}: {', '.join(missing)} is not there; the reference of a whole "
            "machine needs every input in every scan"
        )
    if row.dt_ms is None and number:
        raise Unjudged(f"{log.name}: line {row.line}: no time; give dt_ms or a column with the time")


def lines_of(log: Log, target: Target, found: Found, word: str, file: Path) -> list[str]:
    """What to print; the last line is the verdict."""
    total = len(log.rows)
    lines = [f"{log.name}: {found.accepted:,} of {total:,} scans of {target.id} fit the wiring {file}"]
    lines.append(
        "  by:       the composed reference, exactly; no model checker is needed, for it has one answer"
    )
    lines.append(f"  not shown: {NOT_SHOWN}")
    if unseen := [name for name, count in found.compared.items() if not count]:
        lines.append(f"  UNJUDGED, for no line that fits shows it: {', '.join(unseen)}")
    if word == "DIFFERS":
        row = log.rows[found.accepted]
        lines.append(f"first impossible scan: {found.accepted + 1:,}, line {row.line} of the log")
        lines.append(f"  inputs   dt_ms={row.dt_ms} {_words(row.inputs)}")
        lines.append(f"  before   {', '.join(found.before) or 'nothing'} on")
        lines.append(f"  {'output':<16} {'expected':<10} logged")
        for name, value in row.outputs.items():
            if value != found.expected[name]:
                lines.append(f"  {name:<16} {_word(found.expected[name]):<10} {_word(value)}")
    share = f"; {sum(map(bool, found.compared.values()))} of {len(found.compared)} outputs compared"
    lines.append(f"{word}(exact, {log.name}{share if word == 'CONFORMS' else ''})")
    return lines


def _words(values: Mapping[str, Any]) -> str:
    return " ".join(f"{name}={_word(value)}" for name, value in values.items())


def _word(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:04X}"

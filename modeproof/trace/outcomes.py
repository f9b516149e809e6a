"""What `trace` found about a log as an `Outcome`, of which all other forms are made."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.kit.again import quoted
from modeproof.output.options import About, Clock
from modeproof.output.outcome import (
    Counterexample,
    Demand,
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
from modeproof.output.words import shown
from modeproof.trace.log import Log, Row
from modeproof.trace.log_judge import Judgement
from modeproof.trace.targets import Target
from modeproof.trace.why import Why

TRUSTED = ["what wrote the log", "the reader of logs"]
ONE_RUN = "what the program does in any other run"
MOST_SCANS = 40
"""Lines of a log that are shown before the one that does not fit."""


def about(args: argparse.Namespace) -> About:
    """What the arguments ask for."""
    words = ["modeproof trace", args.target, quoted(str(args.log))]
    words += [f"--param {quoted(given)}" for given in args.param]
    words += ["--from anywhere"] if args.begins == "anywhere" else []
    words += [f"--samples {str(args.samples).replace(' to ', '-')}"] if args.samples else []
    words += ["--codes"] if args.codes else []
    words += [f"--wiring {quoted(str(args.wiring))}"] if args.wiring is not None else []
    return About(
        command="trace",
        subject=shown_path(args.log),
        target=args.target,
        again=" ".join(words),
        files={"log": [args.log], "wiring": [args.wiring]},
    )


def outcome_of(
    args: argparse.Namespace,
    target: Target,
    found: Judgement,
    why: Why | None,
    record: Mapping[str, Any],
    text: str,
    clock: Clock,
) -> Outcome:
    """A log of a device or of the whole system. record: the evidence of it."""
    log, differs = found.log, found.status != 0
    expected: dict[str, Any] = {}
    rules: list[Rule] = []
    if differs and why is not None:
        row = log.rows[found.accepted]
        outputs = target.parts[row.device].device.outputs
        cites = [*(one.cites for one in why.taken), *(one.cites for one in why.missed)]
        cited = [id for ids in cites for id in ids]
        rules = rules_of(cited, target.document)
        for taken in why.taken[:1]:
            above = f"{row.device}." if target.system else ""  # as `_wire` names them
            expected = {
                f"{above}{name}": target.forms.to_wire(outputs[name], value)
                for name, value in taken.expected.items()
            }
    unseen = [
        f"{name}: {signal} was not observed"
        for name, signals in record["result"]["unobserved"].items()
        for signal in signals
    ]
    unseen += [f"output {name}: the document does not give its values" for name in log.not_compared]
    line = _impossible(log, found.accepted) if differs else ""
    return Outcome(
        target=target.id,
        document=target.document,
        strength=record["strength"],
        demands=[_demand(args, target, log, found.accepted, expected, rules, line)],
        assumptions=[] if args.samples is None else [f"the program scans every {args.samples} ms"],
        not_shown=[*unseen, ONE_RUN],
        **_common(args, found.verdict, found.status, line, text, clock),
    )


def outcome_of_machine(
    args: argparse.Namespace,
    log: Log,
    accepted: int,
    expected: Mapping[str, Any],
    wiring: Path,
    not_shown: Sequence[str],
    text: str,
    clock: Clock,
) -> Outcome:
    """A log of a whole machine."""
    differs = accepted < len(log.rows)
    line = _impossible(log, accepted) if differs else ""
    common = _common(args, "DIFFERS" if differs else "CONFORMS", int(differs), line, text, clock)
    common["files"] += files("wiring", [wiring])
    return Outcome(
        target=args.target,
        strength=f"one log of {len(log.rows):,} lines, beside the reference as {shown_path(wiring)} wires it",
        demands=[_demand(args, None, log, accepted, expected, [], line)],
        not_shown=[*not_shown, ONE_RUN],
        **common,
    )


def _impossible(log: Log, accepted: int) -> str:
    return f"line {log.rows[accepted].line} is impossible after {accepted:,} scans that fit"


def _common(
    args: argparse.Namespace, word: str, status: int, line: str, text: str, clock: Clock
) -> dict[str, Any]:
    said = f"{word}: {shown_path(args.log)} {f': {line}' if line else 'is a run of the specification'}"
    return {
        "command": "trace",
        "subject": shown_path(args.log),
        "word": word,
        "status": status,
        "sentence": said.replace(" :", ":"),
        "files": files("log", [args.log]),
        "tools": tools(),
        "trusted": TRUSTED,
        "text": text,
        "again": about(args).again,
        "started": clock.started,
        "seconds": clock.seconds,
    }


def _demand(
    args: argparse.Namespace,
    target: Target | None,
    log: Log,
    accepted: int,
    expected: Mapping[str, Any],
    rules: Sequence[Rule],
    line: str,
) -> Demand:
    sentence = f"Each line of the log is a scan that {args.target} allows after those before it."
    problems = []
    if line:
        row = log.rows[accepted]
        _, outputs = _wire(target, row)
        wrong = [name for name, value in expected.items() if name in outputs and outputs[name] != value]
        said = [f"{name} is {shown(outputs[name])}, expected {shown(expected[name])}" for name in wrong]
        problems.append(
            Problem(
                rule=Rule(id=args.target, kind="log", sentence=sentence),
                others=list(rules),
                message=": ".join([line, *(["; ".join(said)] if said else [])]),
                spot=Spot(file=shown_path(args.log), line=row.line),
                counterexample=_counterexample(args, target, log, accepted, expected, wrong),
            )
        )
    return Demand(
        id=args.target,
        word="DIFFERS" if line else "CONFORMS",
        sentence=sentence,
        strength=f"{accepted:,} of {len(log.rows):,} lines fit",
        problems=problems,
    )


def _counterexample(
    args: argparse.Namespace,
    target: Target | None,
    log: Log,
    accepted: int,
    expected: Mapping[str, Any],
    wrong: Sequence[str],
) -> Counterexample:
    first = max(0, accepted - MOST_SCANS)
    rows = [log.rows[at] for at in range(first, accepted + 1)]
    scans = []
    for row in rows:
        inputs, outputs = _wire(target, row)
        own = dict(expected) if row is rows[-1] else {}
        spot = Spot(file=shown_path(args.log), line=row.line)
        scans.append(Scan(dt_ms=row.dt_ms, inputs=inputs, given=outputs, expected=own, spot=spot))
    return Counterexample(scans=scans, wrong=list(wrong), first=first + 1, found_by=f"log {log.name}")


def _wire(target: Target | None, row: Row) -> tuple[dict[str, Any], dict[str, Any]]:
    """The values of a line as on the wire; of a whole system with the name of the device."""
    if target is None:
        return dict(row.inputs), dict(row.outputs)
    device = target.parts[row.device].device
    above = f"{row.device}." if target.system else ""
    inputs, outputs = (
        {f"{above}{name}": target.forms.to_wire(signals[name], value) for name, value in values.items()}
        for signals, values in ((device.inputs, row.inputs), (device.outputs, row.outputs))
    )
    return inputs, outputs

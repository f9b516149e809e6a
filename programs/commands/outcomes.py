"""What `prove-program` found as an `Outcome`, of which all other forms are made."""

from __future__ import annotations

import argparse
import hashlib
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from modeproof.output.options import Clock
from modeproof.output.outcome import (
    Counterexample,
    Demand,
    Outcome,
    Problem,
    Rule,
    Scan,
    Spot,
    Tool,
    files,
    shown_path,
    tools,
)
from modeproof.output.rules import rules_of
from programs.commands.following import Followed
from programs.demands.verdicts import Found as FoundDemand
from programs.demands.watched import Broken
from programs.equality.binding import Binding
from programs.equality.comparison import about, profile_of
from programs.equality.replay import Difference
from programs.equality.verdict import Verdict
from programs.language.tool_differences import assumed
from programs.language.tree import Name, Place, Source, Unit
from programs.properties.property_file import Questions
from programs.properties.property_verdicts import Found
from programs.properties.transition_system import Cell, Trace
from programs.semantics.interpreter_expressions import Overflow
from programs.semantics.value_paths import put, steps
from programs.semantics.written_lines import Noting

_AT = re.compile(r"(.+?):(\d+): ")
"""How a message about a line of a source begins."""


def spot_of(place: Place) -> Spot:
    """A line of a source."""
    return Spot(file=shown_path(place.file), line=place.line)


def spots(
    source: Source,
    unit: Unit,
    wrap: bool,
    retained: Mapping[str, Any],
    scans: Iterable[tuple[int, Mapping[str, Any]]],
    names: Iterable[str],
) -> Iterator[Spot | None]:
    """After each scan the line that set the first of these variables last; None: nothing set one as yet.

    scans: elapsed ms, and inputs as the interpreter takes them.
    """
    machine, wanted = Noting(source, unit, wrap), [steps(name)[0].upper() for name in names]
    for path, value in retained.items():
        put(machine.memory, path, value)
    for dt_ms, given in scans:
        try:
            machine.scan(given, dt_ms)
        except Overflow as error:
            at = _AT.match(error.message)
            yield Spot(file=shown_path(at[1]), line=int(at[2])) if at else None
            return
        yield next((spot_of(machine.lines[name]) for name in wanted if name in machine.lines), None)


# ---------------------------------------------------------------- equality


def demand_of_equality(found: Verdict, required: bool) -> Demand:
    """Equality with the target, and what speaks against it. required: it was asked for."""
    binding = found.product.binding
    target = binding.reference.device.name
    sentence = f"{binding.unit.name} has the outputs of {target} in every scan from power-up."
    rule = Rule(id=target, kind="target", sentence=sentence, source=_paper(binding))
    problems = []
    if found.difference is not None:
        problems.append(_difference(found, found.difference, binding, rule))
    elif found.missing:
        problems.append(Problem(rule=rule, message=found.missing, spot=spot_of(binding.unit.place)))
    strength = "induction over pairs of states: every input, parameter and time, for ever"
    how = {"PROVED": strength, "REFUTED": "scans, replayed on both", "UNKNOWN": "no proof and no difference"}
    return Demand(
        id=target,
        word=found.word,
        sentence=sentence,
        strength=how[found.word],
        problems=problems,
        required=required,
    )


def _paper(binding: Binding) -> str:
    return binding.reference.document


def _difference(verdict: Verdict, found: Difference, binding: Binding, about: Rule) -> Problem:
    """The scans, the line that set the wrong output, and the clauses that speak of that output."""
    wrap = verdict.product.wrap
    reference = binding.reference
    outputs = reference.signals("outputs")
    wrong = found.differing
    plain = [(dt_ms, binding.plain_inputs(inputs, found.parameters, dt_ms)) for dt_ms, inputs in found.scans]
    variables = [binding.variable_of(name) for name in wrong or binding.compared]
    where = list(spots(binding.source, binding.unit, wrap, found.run.retained, plain, variables))
    scans = [
        Scan(
            dt_ms=dt_ms,
            inputs=reference.to_wire("inputs", inputs),
            given=reference.to_wire("outputs", found.given[at]) if at < len(found.given) else {},
            expected=reference.to_wire("outputs", found.expected[at]),
            spot=where[at],
        )
        for at, (dt_ms, inputs) in enumerate(found.scans)
    ]
    cited = [clause for name in wrong for clause in outputs[name].clauses]
    rules = rules_of(cited, reference.document)
    last = scans[-1]
    if found.stopped:
        message = f"in scan {len(scans)} the program stops: {found.stopped}"
    else:
        texts = [
            f"{name} is {_word(last.given[name])}, expected {_word(last.expected[name])}" for name in wrong
        ]
        message = f"after {_scans(len(scans))} from power-up {'; '.join(texts)}"
    message += f"; reading: {verdict.reading}" if verdict.reading else ""
    return Problem(
        rule=about,
        others=rules,
        message=message,
        spot=last.spot or spot_of(binding.unit.place),
        counterexample=Counterexample(
            scans=scans,
            parameters=reference.to_wire("parameters", found.parameters),
            retained=dict(found.run.retained),
            wrong=wrong,
            stopped=found.stopped,
            found_by=found.found_by,
        ),
    )


def _scans(number: int) -> str:
    return f"{number} scan{'s' * (number > 1)}"


def _word(value: Any) -> str:
    return str(value).upper() if isinstance(value, bool) else str(value)


# ---------------------------------------------------------------- properties


def demand_of_property(cell: Cell, found: Found, questions: Questions) -> Demand:
    """A property, and what speaks against it."""
    asked = found.asked
    rows = [row for row in questions.rows if row["id"] == asked.id]
    at = questions.place(rows[0]) if rows else None
    source = f"{shown_path(at.file)}:{at.line}" if at is not None else "asked of every program"
    about = Rule(id=asked.id, kind="property", sentence=asked.sentence, source=source)
    problems = []
    if found.trace is not None:
        problems.append(_broken(cell, found, found.trace, about))
    elif found.word not in ("PROVED", "HOLDS"):
        problems.append(Problem(rule=about, message=found.how, spot=spot_of(cell.unit.place)))
    elif found.word == "HOLDS":
        text = f"no proof; it holds in the first {found.scans} scans"
        problems.append(Problem(rule=about, message=text, spot=spot_of(cell.unit.place)))
    return Demand(
        id=asked.id,
        word=found.word,
        sentence=asked.sentence,
        text=asked.text,
        strength=f"{found.how}, in the first {found.scans} scans" if found.word == "HOLDS" else found.how,
        problems=problems,
    )


def _broken(cell: Cell, found: Found, trace: Trace, about: Rule) -> Problem:
    named = list(dict.fromkeys(_names(found.asked.holds)))
    plain = [(dt_ms, cell.plain_inputs(inputs)) for dt_ms, inputs in trace.scans]
    where = list(spots(cell.source, cell.unit, cell.wrap, trace.retained, plain, reversed(named)))
    scans = [
        Scan(
            dt_ms=dt_ms,
            inputs=dict(inputs),
            given=dict(trace.rows[at]) if at < len(trace.rows) else {},
            spot=where[at] if at < len(where) else None,
        )
        for at, (dt_ms, inputs) in enumerate(trace.scans)
    ]
    last = scans[-1]
    after = f"after {_scans(len(scans))} from power-up"
    what = f"the program stops {after}: {trace.stopped}" if trace.stopped else f"false {after}"
    shown = {name.upper() for name in last.given}
    return Problem(
        rule=about,
        message=f"{what}: {about.sentence}",
        spot=last.spot or spot_of(cell.unit.place),
        counterexample=Counterexample(
            scans=scans,
            retained=dict(trace.retained),
            wrong=[name for name in last.given if name.upper() in {*named} & shown],
            stopped=trace.stopped,
            found_by="search for the fewest scans",
        ),
    )


def _names(node: Any) -> Iterator[str]:
    """The variables in an expression, in upper case."""
    if isinstance(node, Name):
        yield node.name.upper()
    elif isinstance(node, tuple):
        for part in node:
            yield from _names(part)
    elif hasattr(node, "place"):
        for part in vars(node).values():
            yield from _names(part)


# ---------------------------------------------------------------- the whole


def outcome_of_target(
    args: argparse.Namespace,
    followed: Followed,
    same: Verdict | None,
    record: Mapping[str, Any],
    text: str,
    clock: Clock,
) -> Outcome:
    """A run with --target. record: the same as the command writes it as JSON; text: what it printed."""
    product = followed.product
    binding = product.binding
    demands = [demand_of_page(followed, one) for one in followed.found]
    for row in followed.judgement.beside.unjudged:
        rule = _rule_of_page(followed, row.id, row.says)
        problem = Problem(rule=rule, message="an output that it needs is left out")
        demands.append(Demand(id=row.id, word="UNJUDGED", sentence=row.says, problems=[problem]))
    if same is not None:
        demands.append(demand_of_equality(same, args.same))
    lines = dict(about(product))
    bounds = [f"{label}: {lines[label]}" for label in ("compared", "parameters", "inputs", "numbers")]
    beside = followed.judgement.beside
    known = common(args, record, text, clock)
    if args.same and same is not None and followed.word != "BREAKS":
        known["sentence"] = f"{record['verdict']}: {followed.sentence}; same as the reference: {same.word}"
    else:
        known["sentence"] = followed.sentence
    return Outcome(
        target=binding.reference.device.name,
        document=binding.reference.document,
        word=record["verdict"],
        strength=f"from power-up, for ever; latency: {beside.latency}; {'; '.join(bounds)}",
        demands=demands,
        profile=profile_of(binding) if args.same else "",
        assumptions=[*beside.assumed.words(), *assumed(binding.source, binding.unit, binding.steady)],
        reason=_open(followed, same) if record["status"] == 2 else "",
        **known,
    )


def _open(followed: Followed, same: Verdict | None) -> str:
    """What is missing, where there is no verdict."""
    parts = [f"{one.asked.id}: {one.how}" for one in followed.found if one.word == "UNKNOWN"]
    parts += [f"{row.id}: an output that it needs is left out" for row in followed.judgement.beside.unjudged]
    return "; ".join(parts) or (same.missing if same is not None else "")


def demand_of_page(followed: Followed, found: FoundDemand) -> Demand:
    """A demand of the page, and what speaks against it."""
    asked, problems = found.asked, []
    rule = _rule_of_page(followed, asked.id, asked.says)
    if found.broken is not None:
        problems.append(_breaking(followed, found, found.broken, rule))
    elif found.word != "PROVED":
        place = spot_of(followed.product.binding.unit.place)
        problems.append(Problem(rule=rule, message=found.how, spot=place))
    words = {"PROVED": "PROVED", "BROKEN": "BREAKS", "UNKNOWN": "UNKNOWN"}
    return Demand(
        id=asked.id,
        word=words[found.word],
        sentence=asked.says,
        text=asked.text,
        strength=found.how,
        problems=problems,
    )


def _rule_of_page(followed: Followed, id: str, says: str) -> Rule:
    document = followed.reference.document
    return Rule(id=id, kind="demand", sentence=says, source=f"spec/{document}/demands.toml")


def _breaking(followed: Followed, found: FoundDemand, broken: Broken, rule: Rule) -> Problem:
    """The scans, the line that set an output last, and the clauses of the demand."""
    product, binding, reference = followed.product, followed.product.binding, followed.reference
    named = next((row.outputs for row in followed.judgement.beside.rows if row.id == rule.id), frozenset())
    wrong = [name for name in binding.compared if name in named] or list(binding.compared)
    run = broken.run
    plain = [(dt_ms, binding.plain_inputs(inputs, run.parameters, dt_ms)) for dt_ms, inputs in run.scans]
    variables = [binding.variable_of(name) for name in wrong]
    where = list(spots(binding.source, binding.unit, product.wrap, run.retained, plain, variables))
    scans = [
        Scan(
            dt_ms=step.dt_ms,
            inputs=dict(step.inputs),
            given=dict(step.outputs),
            spot=where[at] if at < len(where) else None,
        )
        for at, step in enumerate(broken.steps)
    ]
    after = f"in scan {len(scans)} from power-up"
    what = f"the program stops {after}: {broken.stopped}" if broken.stopped else f"broken {after}"
    return Problem(
        rule=rule,
        others=rules_of(found.asked.clauses, reference.document),
        message=f"{what}: {found.asked.says}",
        spot=scans[-1].spot or spot_of(binding.unit.place),
        counterexample=Counterexample(
            scans=scans,
            parameters=reference.to_wire("parameters", run.parameters),
            retained=dict(run.retained),
            wrong=[] if broken.stopped else [name for name in wrong if name in broken.steps[-1].outputs],
            stopped=broken.stopped,
            found_by=broken.found_by,
        ),
    )


def outcome_of_properties(
    args: argparse.Namespace,
    cell: Cell,
    found: Sequence[Found],
    questions: Questions,
    record: Mapping[str, Any],
    text: str,
    clock: Clock,
) -> Outcome:
    """A run with --property."""
    words = [one.word for one in found]
    order = ("REFUTED", "UNKNOWN", "EMPTY", "HOLDS", "PROVED")
    word = next(word for word in order if word in words)
    counts = ", ".join(f"{words.count(one)} {one}" for one in order if one in words)
    known = common(args, record, text, clock)
    known["sentence"] = f"{word}: {counts}: {known['sentence']}"
    low, high = cell.scan_time
    times = f"{low} to {high:,} ms" if high is not None else f"{low} ms or more"
    return Outcome(
        target=shown_path(args.property),
        word=word,
        strength=f"every input, scans of {times}, from power-up, for ever",
        demands=[demand_of_property(cell, one, questions) for one in found],
        assumptions=list(assumed(cell.source, cell.unit)),
        **known,
    )


def common(args: argparse.Namespace, record: Mapping[str, Any], text: str, clock: Clock) -> dict[str, Any]:
    """What the record of each run has."""
    first, *_ = text.partition("\n")
    reference = hashlib.sha256(json.dumps(record["reference"], sort_keys=True).encode()).hexdigest()
    return {
        "command": "prove-program",
        "subject": record["unit"],
        "status": record["status"],
        "sentence": first,
        "files": [
            *files("program", record["sources"]),
            *files("binding", record.get("binding_file", {})),
            *files("properties", record.get("properties", {})),
        ],
        "tools": [*tools(record["tools"]), Tool(name="reference", version="", sha256=reference)],
        "trusted": record["trusted"],
        "not_shown": record["not_shown"],
        "text": text,
        "again": args.about(args).again,
        "started": clock.started,
        "seconds": clock.seconds,
    }

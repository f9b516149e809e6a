"""An outcome as Markdown: a short summary for the page of a job. Every foreign text is escaped."""

from __future__ import annotations

import re
from collections.abc import Iterator

from modeproof.kit.errors import plain
from modeproof.output.outcome import Counterexample, Outcome, Problem
from modeproof.output.words import changed, row, shown, wrong_of

MOST_DEMANDS, MOST_PROBLEMS, MOST_SCANS = 60, 8, 16
_MARKS = re.compile(r"[\\`*{}\[\]<>#|~&@!+$]|\b_|_\b|(?<=www)\.|:(?=//)|^[-=]|(?<!.)\d+(?=[.)])")
"""What Markdown, or a forge that shows it, could read as more than text."""


def escaped(text: str) -> str:
    """Foreign text: every mark of Markdown and HTML stands for itself."""
    line = _MARKS.sub(lambda found: f"\\{found[0]}", plain(" ".join(text.split())))
    return re.sub(r"^\\(\d+)(?=[.)])", r"\1\\", line)


def code(text: str) -> str:
    """Foreign text as code; where it has a back tick or a bar, as plain text."""
    line = plain(" ".join(text.split()))
    return escaped(line) if "`" in line or "|" in line or not line else f"`{line}`"


def as_markdown(outcome: Outcome) -> str:
    """The text of a Markdown file."""
    return "\n".join([*_lines(outcome), ""])


def _lines(outcome: Outcome) -> Iterator[str]:
    yield f"### {escaped(outcome.word)}: {code(outcome.subject)}"
    yield ""
    what = f" against {code(outcome.target)}" if outcome.target else ""
    yield f"`modeproof {outcome.command}`{what}, exit status {outcome.status}, {outcome.seconds:.1f} s"
    yield ""
    if outcome.reason and not outcome.problems:
        yield from (f"Not judged: {escaped(outcome.reason)}", "")
    if outcome.demands:
        yield from ("| demand | verdict | how |", "|---|---|---|")
        order = sorted(outcome.demands, key=lambda demand: not demand.problems)
        for demand in order[:MOST_DEMANDS]:
            yield f"| {escaped(demand.sentence)} | **{escaped(demand.word)}** | {escaped(demand.strength)} |"
        if len(order) > MOST_DEMANDS:
            yield f"| and {len(order) - MOST_DEMANDS} more | | |"
        yield ""
    for _, problem in outcome.problems[:MOST_PROBLEMS]:
        yield from _problem(problem)
    if len(outcome.problems) > MOST_PROBLEMS:
        yield from (f"And {len(outcome.problems) - MOST_PROBLEMS} more problems.", "")
    if outcome.not_shown:
        yield f"Not shown: {escaped('; '.join(outcome.not_shown))}"
        yield ""
    if outcome.assumptions:
        yield f"Assumed: {escaped('; '.join(outcome.assumptions))}"
        yield ""
    yield f"Again: {code(outcome.again)}"


def _problem(problem: Problem) -> Iterator[str]:
    at = problem.spot
    where = "" if at is None else f", {code(f'{at.file}:{at.line}' if at.line else at.file)}"
    yield f"#### {code(problem.rule.id)}{where}"
    yield ""
    yield escaped(problem.message)
    yield ""
    for rule in problem.others:
        source = f" ({escaped(rule.source)})" if rule.source else ""
        yield f"- {rule.kind} {code(rule.id)}{source}: {escaped(rule.sentence)}"
    if problem.others:
        yield ""
    if problem.counterexample is not None:
        yield from _scans(problem.counterexample)


def _scans(example: Counterexample) -> Iterator[str]:
    if example.parameters:
        yield from (f"With {escaped(row(example.parameters))}.", "")
    yield from ("| scan | ms | inputs | outputs |", "|---:|---:|---|---|")
    left_out = max(0, len(example.scans) - MOST_SCANS)
    if left_out:
        yield f"| {left_out} scans | | left out | |"
    for at, scan in enumerate(example.scans):
        if at < left_out:
            continue
        before = example.scans[at - 1] if at > left_out else None
        inputs = row(changed(before.inputs if before else {}, scan.inputs)) or "the same"
        outputs = row(changed(before.given if before else {}, scan.given)) or "the same"
        if scan is example.scans[-1]:
            outputs = wrong_of(scan, example)
        time = "" if scan.dt_ms is None else shown(scan.dt_ms)
        yield f"| {example.first + at} | {time} | {escaped(inputs)} | {escaped(outputs)} |"
    yield ""

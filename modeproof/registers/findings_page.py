"""The page of a document's findings, docs/<document>-findings.md, made from its registers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from modeproof.ground.fitted import fitted
from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.registers.standing import CLASSES as CLASSES
from modeproof.registers.standing import FORBIDDEN, OPEN, UNASKED, standings

LARGEST = 40_000
"""Bytes of a page that a person still reads."""
_BY_NUMBER = re.compile(r"\b[Tt]he (first|second|third|fourth|fifth|last|other two)\b")
"""A decision or a consequence that names readings by their number."""
_MANY = 3
"""Of a finding with more counterexamples than this, the line names only the first ones."""


def findings_name(document: str) -> str:
    """The path of the page."""
    return f"docs/{document}-findings.md"


def findings_pages(document: Document) -> dict[str, str]:
    """The pages by their paths: one, or two where one would be too large; what weighs most comes first."""
    name = findings_name(document.name)
    ranked = sorted(document.findings, key=lambda finding: list(CLASSES).index(finding.severity))
    whole = _page(document, ranked, "")
    if len(whole.encode("utf-8")) <= LARGEST:
        return {name: whole}
    rest = name.replace("-findings.md", "-other-findings.md")
    many = f" Those that weigh most are here, [the others apart]({PurePosixPath(rest).name})."
    few = f" Those that weigh most have [their own page]({PurePosixPath(name).name})."
    count = len(ranked)
    while count > 1 and len(_page(document, ranked[:count], many).encode("utf-8")) > LARGEST:
        count -= 1
    return {name: _page(document, ranked[:count], many), rest: _page(document, ranked[count:], few)}


def counted(document: Document) -> str:
    """How many findings there are, in all and by class."""
    count = {name: sum(finding.severity == name for finding in document.findings) for name in CLASSES}
    numbers = ", ".join(f"{number} {name}" for name, number in count.items())
    return f"{len(document.findings)} findings, {numbers}"


def _page(document: Document, findings: Sequence[Finding], more: str) -> str:
    name = document.name
    lines = [
        f"# Findings in: {document.about.title}",
        "",
        f"<!-- made by modeproof render from spec/{name}: edit the registers there, not this page -->",
        f"This page belongs to [what was shown]({name}.md). Where the text contradicts itself, is silent, "
        f"or can be read in more than one way: {counted(document)}.{more}",
        "",
        "Each says what the text says, what we decided, what happens otherwise, and the command that shows "
        "it. We did not have the drawings; where one could settle the matter (†), the finding is no error of "
        f"the document. All readings: [findings.toml](../{document.source('findings')}). Below, `modeproof` "
        "is `.venv/bin/modeproof`.",
    ]
    for severity in CLASSES:
        rows = [finding for finding in findings if finding.severity == severity]
        if rows:
            lines += ["", f"## {CLASSES[severity]}"]
        for finding in rows:
            lines += ["", *_finding(document, finding)]
    return fitted("\n".join(lines))


def _finding(document: Document, finding: Finding) -> list[str]:
    mark = " †" if finding.drawing_could_settle else ""
    lines = [f"**{finding.id}{mark}: {finding.title}.** {sentence(finding.says)}"]
    if _BY_NUMBER.search(f"{finding.decision} {finding.consequence}"):
        readings = "; ".join(f"({number}) {text}" for number, text in enumerate(finding.readings, 1))
        lines.append(f"- *Readings:* {readings}.")
    lines.append(f"- *Decided:* {sentence(finding.decision)}")
    if said := _said_of(document, finding):
        lines.append(f"- *Of the page:* {said}.")
    if finding.severity != "untried":
        lines.append(f"- *Otherwise:* {sentence(finding.consequence)} {evidence_of(document, finding)}")
    return lines


def _said_of(document: Document, finding: Finding) -> str:
    """What the demands say of each reading that was tried alone."""
    words = []
    for one in standings(finding, document.runs):
        if one.word == UNASKED:
            if why := finding.unasked.get(one.reading):
                words.append(f"`{one.reading}` was not asked, {why}")
            continue
        shown = f"`{one.reading}` is {one.word}"
        if one.word == OPEN:
            shown += f" (every demand holds: `{one.run}`)"
        else:
            shown += f" ({'demand ' if one.word == FORBIDDEN else ''}`{one.broken}` falls: `{one.run}`)"
        words.append(shown)
    return "; ".join(words)


def evidence_of(document: Document, finding: Finding) -> str:
    """What shows a finding, with the command."""
    runs = [run for name in finding.evidence if (run := run_of(document, name)) is not None]
    negatives = [run for run in runs if run.kind == "NEG"]
    clauses = {clause.id for clause in document.clauses}
    theorems = [name for name in finding.evidence if run_of(document, name) is None and name not in clauses]
    if negatives:
        lengths: dict[str, set[int]] = {}
        for run in negatives[:_MANY]:
            lengths.setdefault(run.property, set()).add((run.trace_length or 1) - 1)
        said = [f"`{name}` fails {_after(found)}" for name, found in lengths.items()]
        names = " ".join(run.id for run in negatives[:_MANY])
        more = f" ({len(negatives) - _MANY} more in the report)" if len(negatives) > _MANY else ""
        return f"{', '.join(said)}: `modeproof check {names} --trace`{more}."
    if runs:
        return f"Checked: `modeproof check {' '.join(run.id for run in runs)}`."
    if theorems:
        return f"Proved: `modeproof prove --document {document.name} {' '.join(theorems)}`."
    return f"Not shown by a run: {sentence(finding.evidence_open)}"


def _after(lengths: set[int]) -> str:
    """After how many steps a property fails, in one run or in several."""
    *others, last = sorted(lengths)
    if last == 0:
        return "in the first state"
    several = f"{', '.join(map(str, others))} and {last}" if others else str(last)
    return f"after {several} step" + ("" if several == "1" else "s")


def run_of(document: Document, name: str) -> Run | None:
    """The run of this name; None where there is none."""
    return next((run for run in document.runs if run.id == name), None)


def sentence(text: str) -> str:
    """The text with a capital and a stop."""
    text = " ".join(text.split())
    first = text.split(" ", 1)[0]
    name = any(mark in first for mark in "_0123456789")  # a name keeps its spelling
    begin = text if name else text[:1].upper() + text[1:]
    return begin + ("" if text.endswith((".", "?", "!")) else ".")

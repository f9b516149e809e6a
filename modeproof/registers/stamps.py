"""The stamps under rendered pages of findings: what a page was made from, so that drift shows without any
run.

A stamp is the last line of a page, an HTML comment with four values: the SHA-256 (12 digits) of the register
rows that the page is made from, of the pins of its runs (hash of the cfg, length of the trace), and of the
page's own text. The first two are calculated anew from the registers, the third from the page.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from modeproof.registers.files import read_text, read_toml
from modeproof.registers.pages import DEVIATIONS, FINDINGS, page_of
from modeproof.registers.replay import has_replay
from modeproof.registers.rows import Document, Finding, Problem

REMEDY = "run modeproof findings --render"
_STAMP = re.compile(
    r"<!-- rendered by modeproof findings: registers (\w{12}), runs (\w{12}), text (\w{12}) -->\n\Z"
)


def folder_of(document: str) -> str:
    """The folder with the page of each finding of a document."""
    return page_of(document, FINDINGS).removesuffix(".md")


def page_name(document: str, finding: Finding) -> str:
    """The path of a finding's page."""
    return f"{folder_of(document)}/{finding.id}.md"


def index_name(document: str) -> str:
    """The path of the index of a document's findings."""
    return page_of(document, FINDINGS)


def table_name(document: str) -> str:
    """The path of the table of a document's deviations."""
    return page_of(document, DEVIATIONS)


def _digest(value: Any) -> str:
    text = value if isinstance(value, str) else json.dumps(value, sort_keys=True, ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:12]


Pins = dict[str, list[Any]]


def pins(document: Document) -> Pins:
    """Of every run the hash of its cfg and the length of its counterexample, as runs.toml pins them."""
    rows = read_toml(document.root, document.folder / "runs.toml")["run"]
    return {row["id"]: [row.get("cfg_sha256"), row.get("trace_length")] for row in rows}


def sources_of(document: Document, finding: Finding | None, known: Pins | None = None) -> tuple[str, str]:
    """The digests of the register rows and of the pins behind a page; None stands for the index and the
    table. `known`: the pins, where they were read before.
    """
    chosen = document.findings if finding is None else (finding,)
    known = pins(document) if known is None else known
    names = [name for one in chosen for name in one.evidence if name in known]
    if finding is None:
        names = sorted(known)
    clauses = [clause.title for clause in document.clauses if finding and clause.id in finding.clauses]
    falls = {run.property for run in document.runs if run.id in names and run.property}
    properties = [asdict(one) for one in document.properties if finding and falls & {one.id, one.tla}]
    rows = [[asdict(one) for one in chosen], clauses, properties]
    return _digest(rows), _digest([[name, *known[name]] for name in names])


def stamped(document: Document, finding: Finding | None, text: str, known: Pins | None = None) -> str:
    """The page with its stamp; `known` as of `sources_of`."""
    registers, runs = sources_of(document, finding, known)
    line = (
        f"<!-- rendered by modeproof findings: registers {registers}, runs {runs}, text {_digest(text)} -->"
    )
    return f"{text}\n{line}\n"


def has_page(finding: Finding) -> bool:
    """Whether a finding has a page of its own: not for wording, and only where there is evidence to show."""
    return finding.severity != "wording" and bool(finding.evidence)


def check_findings_pages(document: Document) -> list[Problem]:
    """What has drifted between a document's registers and its pages; nothing where it has none yet."""
    if (
        not has_replay(document.root, document.name)
        or not (document.root / index_name(document.name)).is_file()
    ):
        return []
    return check_stamps(document, filter(has_page, document.findings))


def check_stamps(document: Document, expected: Iterable[Finding]) -> list[Problem]:
    """Pages that are missing, that no finding has, or whose stamp is not that of registers and text."""
    problems = []
    root, known = document.root, pins(document)
    wanted: dict[str, Finding | None] = {page_name(document.name, one): one for one in expected}
    wanted |= {index_name(document.name): None, table_name(document.name): None}
    for name, finding in wanted.items():
        path = root / name
        if not path.is_file():
            problems.append(Problem(name, "", f"the page is missing; {REMEDY}"))
            continue
        for text in _faults(document, finding, read_text(root, path), known):
            problems.append(Problem(name, "", text))
    folder = folder_of(document.name)
    for path in sorted((root / folder).glob("*.md")):
        name = f"{folder}/{path.name}"
        if name not in wanted:
            problems.append(Problem(name, "", f"no finding with evidence has this page; {REMEDY}"))
    return problems


def _faults(document: Document, finding: Finding | None, text: str, known: Pins) -> Iterable[str]:
    match = _STAMP.search(text)
    if match is None:
        yield f"the page has no stamp; {REMEDY}"
        return
    registers, runs = sources_of(document, finding, known)
    if match.group(1) != registers:
        yield f"the registers have changed since the page was rendered; {REMEDY}"
    if match.group(2) != runs:
        yield f"the pins of its runs (cfg or length of the trace) have changed; {REMEDY}"
    if match.group(3) != _digest(text[: match.start() - 1]):
        yield f"the page was changed by hand; {REMEDY}"

"""Every result as JUnit XML, for CI systems and requirement tools: a test case is one piece of evidence.

What is declared and has no evidence is an error, never a pass; what only another lane runs is skipped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from modeproof.registers.rows import Document
from modeproof.report.claims import LANE, theorem_rows
from modeproof.report.demanded import KIND
from modeproof.report.snapshot import as_it_counts, machine_rows
from modeproof.report.sources import DIFFERS, Evidence, Sources
from modeproof.report.verdicts import status_of

KINDS = ("tlc", "proof", "conformance", "agreement", "coverage", "registers", "strength", KIND)


@dataclass(frozen=True)
class _Case:
    """One test case: `status` as of evidence, or SKIPPED; `clauses` are those that it speaks of."""

    kind: str
    id: str
    clauses: Sequence[str]
    evidence: Evidence | None
    status: int
    message: str


SKIPPED = 3
_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def _for_xml(text: str) -> str:
    """A text without characters that XML 1.0 has no way to write."""
    return _FORBIDDEN.sub("\ufffd", text)


def junit(sources: Sources) -> bytes:
    """The XML; the same sources give the same bytes."""
    root = ElementTree.Element("testsuites", name="modeproof")
    for document in sources.documents.values():
        cases = sorted(_cases(sources, document), key=lambda one: (one.kind, one.id))
        counts = [sum(1 for case in cases if case.status == status) for status in (DIFFERS, 2, SKIPPED)]
        seconds = sum(float(case.evidence.record["seconds"]) for case in cases if case.evidence is not None)
        suite = ElementTree.SubElement(
            root,
            "testsuite",
            name=document.name,
            tests=str(len(cases)),
            failures=str(counts[0]),
            errors=str(counts[1]),
            skipped=str(counts[2]),
            time=f"{seconds:.3f}",
        )
        for case in cases:
            suite.append(_element(document, case))
    for name, piece in sources.machines.items():
        if piece is not None:
            root.append(_machine(name, piece))
    ElementTree.indent(root)
    content: bytes = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
    return content + b"\n"


def _element(document: Document, one: _Case) -> ElementTree.Element:
    seconds = 0.0 if one.evidence is None else float(one.evidence.record["seconds"])
    case = ElementTree.Element(
        "testcase", classname=f"{document.name}.{one.kind}", name=one.id, time=f"{seconds:.3f}"
    )
    properties = ElementTree.SubElement(case, "properties")

    def say(name: str, value: str) -> None:
        ElementTree.SubElement(properties, "property", name=name, value=_for_xml(value))

    for clause in one.clauses:
        say("clause", clause)
    if one.evidence is not None:
        say("verdict", str(one.evidence.record["verdict"]))
        say("expected", str(one.evidence.record["expected"]))
        for key in ("environment", "strength"):
            if one.evidence.record[key]:
                say(key, str(one.evidence.record[key]))
        say("evidence", one.evidence.path)
        say("sha256", one.evidence.sha256)
    if one.status == SKIPPED:
        ElementTree.SubElement(case, "skipped", message=_for_xml(one.message))
    elif one.status:
        tag = "failure" if one.status == DIFFERS else "error"
        ElementTree.SubElement(case, tag, message=_for_xml(one.message), type=tag)
    return case


def _machine(name: str, piece: Evidence) -> ElementTree.Element:
    """The properties of a machine of the project's own."""
    rows = machine_rows(piece)
    kinds = ["" if row["verdict"] == "PROVED" else _tag(row["verdict"]) for row in rows]
    suite = ElementTree.Element(
        "testsuite",
        name=name,
        tests=str(len(rows)),
        failures=str(kinds.count("failure")),
        errors=str(kinds.count("error")),
        skipped="0",
        time=f"{float(piece.record['seconds']):.3f}",
    )
    for row, kind in zip(rows, kinds, strict=True):
        case = ElementTree.SubElement(
            suite, "testcase", classname=f"{name}.machine", name=_for_xml(row["id"])
        )
        properties = ElementTree.SubElement(case, "properties")
        said = {"verdict": row["verdict"], "sentence": row["sentence"], "evidence": piece.path}
        for key, value in {**said, "sha256": piece.sha256}.items():
            ElementTree.SubElement(properties, "property", name=key, value=_for_xml(value))
        if kind:
            ElementTree.SubElement(case, kind, message=_for_xml(row["how"]), type=kind)
    return suite


def _tag(verdict: str) -> str:
    return "failure" if verdict == "REFUTED" else "error"


def _cases(sources: Sources, document: Document) -> Iterator[_Case]:
    """What there is, and what is declared and is not there."""
    known = sources.evidence[document.name]
    runs = {declared.id: declared for declared in document.runs}
    clauses_of = {prop.tla: prop.clauses for prop in document.properties}
    theorems = {one.name: one for _, one in theorem_rows(sources, document)}
    for piece in known.values():
        kind = str(piece.record["kind"])
        if kind not in KINDS:
            continue
        record = as_it_counts(piece)
        told = piece.result.get("clauses")
        cited = [str(name) for name in told] if isinstance(told, (list, dict)) else []
        if piece.id in runs:
            cited = [*runs[piece.id].clauses]
            for name in runs[piece.id].properties:
                cited += clauses_of.get(name, ())
        yield _Case(kind, piece.id, tuple(dict.fromkeys(cited)), piece, status_of(record), record["reason"])
    for run in document.runs:
        if run.id not in known:
            here = LANE in run.lanes
            what = "no evidence" if here else f"a run of lane {' and '.join(run.lanes)}"
            yield _Case("tlc", run.id, run.clauses, None, 2 if here else SKIPPED, what)
    for name, theorem in theorems.items():
        if name not in known:
            yield _Case("proof", name, theorem.clauses, None, 2, "no evidence")

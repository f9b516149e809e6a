"""Computes who cites which clause, from comments, docstrings, decorators and registers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from modeproof.registers.python_source import PythonModule, read_python
from modeproof.registers.rows import Document, Problem
from modeproof.registers.tla import Module, read_modules

RANGE = re.compile(r"\.\.\s*\d|/\d")


@dataclass(frozen=True)
class Citation:
    """One place that cites.

    `kind` is one of definition, module (text of TLA+ and Python outside definitions), property, theorem,
    finding, assumption, run, response, signal. `room` is spec, refimpl, proofs or registers. `device` is set
    for text in a device's own module.
    """

    kind: str
    room: str
    file: str
    name: str
    device: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True)
class Sources:
    """Everything that can cite, read once."""

    modules: dict[str, Module]
    refimpl: tuple[PythonModule, ...]
    proofs: tuple[PythonModule, ...]


def read_sources(document: Document) -> Sources:
    """Read the specification, the reference implementation and the proofs of a document."""
    root, name = document.root, document.name
    return Sources(
        modules=read_modules(root, name),
        refimpl=read_python(root, root / "refimpl" / name),
        proofs=read_python(root, root / "proofs" / name),
    )


class Ids:
    """Declared ids, and how to find them in a text. `prefix` is that of the clause ids."""

    def __init__(
        self, prefix: str, clauses: Iterable[str], findings: Iterable[str], assumptions: Iterable[str]
    ) -> None:
        self.clauses, self.findings, self.assumptions = set(clauses), set(findings), set(assumptions)
        self.clause_form = re.compile(rf"\b{re.escape(prefix)}(?:-[A-Z0-9]+)+\b")
        letters = {name.rsplit("-", 1)[0] for name in self.findings | self.assumptions}
        names = "|".join(sorted(map(re.escape, letters))) or r"(?!)"
        self.other_form = re.compile(rf"(?<![\w-])(?:{names})-\d+[a-z]?\b")

    def read(self, text: str) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
        """The clauses and findings that a text cites, each once in its order, and what it cites wrongly."""
        clauses: list[str] = []
        findings: list[str] = []
        unknown: list[str] = []
        for match in self.clause_form.finditer(text):
            clause = match.group()
            (clauses if clause in self.clauses else findings if clause in self.findings else unknown).append(
                clause
            )
            tail = RANGE.match(text, match.end())
            if tail:
                unknown.append(f"{clause}{tail.group()}")
        for name in self.other_form.findall(self.clause_form.sub(" ", text)):
            if name in self.findings:
                findings.append(name)
            elif name not in self.assumptions:
                unknown.append(name)
        return _once(clauses), _once(findings), _once(unknown)


def ids_of(document: Document) -> Ids:
    """The ids of a document."""
    return Ids(
        document.about.prefix,
        (clause.id for clause in document.clauses),
        (finding.id for finding in document.findings),
        (assumption.id for assumption in document.assumptions),
    )


def _once(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))


def citations(document: Document, sources: Sources) -> tuple[Citation, ...]:
    """Every citation of the document's clauses and findings."""
    ids = ids_of(document)
    return (
        *_in_tla(document, sources, ids),
        *_in_python(document, sources, ids),
        *_in_theorems(sources, ids),
        *_in_registers(document, ids),
    )


def _in_tla(document: Document, sources: Sources, ids: Ids) -> Iterator[Citation]:
    device_of = {device.module: device.id for device in document.interface.devices.values()}
    for module in sources.modules.values():
        device = device_of.get(module.name, "")
        shared = not module.file.startswith(f"spec/{document.name}/")
        for definition in module.definitions:
            clauses, findings, unknown = ids.read(definition.comment)
            name = f"{module.name}!{definition.name}"
            if shared:
                findings, unknown = (), tuple(unread for unread in unknown if ids.clause_form.match(unread))
            yield Citation("definition", "spec", module.file, name, device, clauses, findings, unknown)
        clauses, findings, unknown = ids.read(module.stray)
        yield Citation(
            "module", "spec", module.file, module.name, device, clauses, findings, () if shared else unknown
        )


def _in_python(document: Document, sources: Sources, ids: Ids) -> Iterator[Citation]:
    for module in sources.refimpl:
        device = module.name if module.name in document.interface.devices else ""
        for definition in module.definitions:
            name = f"{module.name}.{definition.name}"
            yield Citation("definition", "refimpl", module.file, name, device, *ids.read(definition.comment))
        yield Citation("module", "refimpl", module.file, module.name, device, *ids.read(module.stray))


def _in_theorems(sources: Sources, ids: Ids) -> Iterator[Citation]:
    for module in sources.proofs:
        for theorem in module.theorems:
            yield _listed(
                "theorem", "proofs", module.file, theorem.name, theorem.clauses, theorem.findings, ids
            )
        said = "\n".join([module.stray, *(definition.comment for definition in module.definitions)])
        yield Citation("module", "proofs", module.file, module.name, "", *ids.read(said))


def _in_registers(document: Document, ids: Ids) -> Iterator[Citation]:
    for prop in document.properties:
        yield _listed(
            "property", "registers", document.source("properties"), prop.id, prop.clauses, prop.findings, ids
        )
    for finding in document.findings:
        yield _listed(
            "finding", "registers", document.source("findings"), finding.id, finding.clauses, (), ids
        )
    for row in document.assumptions:
        yield _listed("assumption", "registers", document.source("assumptions"), row.id, row.clauses, (), ids)
    for run in document.runs:
        yield _listed("run", "registers", document.source("runs"), run.id, run.clauses, run.findings, ids)
    for response in document.responses.rows:
        source = document.source("properties")
        yield _listed("response", "registers", source, response.id, response.clauses, (), ids)
    source = document.source("interface")
    for device in document.interface.devices.values():
        groups = {
            "memory": device.memory,
            "inputs": device.inputs,
            "outputs": device.outputs,
            "parameters": device.parameters,
        }
        for group, signals in groups.items():
            for signal in signals.values():
                name = f"devices.{device.id}.{group}.{signal.name}"
                yield _listed("signal", "registers", source, name, signal.clauses, (), ids)


def _listed(
    kind: str, room: str, file: str, name: str, clauses: tuple[str, ...], findings: tuple[str, ...], ids: Ids
) -> Citation:
    unknown = [clause for clause in clauses if clause not in ids.clauses] + [
        finding for finding in findings if finding not in ids.findings
    ]
    known = tuple(clause for clause in clauses if clause in ids.clauses)
    return Citation(
        kind,
        room,
        file,
        name,
        "",
        known,
        tuple(finding for finding in findings if finding in ids.findings),
        tuple(unknown),
    )


def unresolved(document: Document, cited: Iterable[Citation]) -> list[Problem]:
    """A problem for each cited id that no register declares, and for each range of ids."""
    problems = []
    for citation in cited:
        for name in citation.unknown:
            if RANGE.search(name):
                text = f"{name!r} reads like a range; write each id out"
            else:
                text = f"cites {name}, which no register of {document.name} declares"
            problems.append(Problem(citation.file, citation.name, text))
    return problems

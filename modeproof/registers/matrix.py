"""The matrix clause -> action -> step -> property -> theorem -> vector, and what it leaves orphaned."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from modeproof.registers.citations import Citation, Sources
from modeproof.registers.rows import Clause, Document, Problem


@dataclass(frozen=True)
class Row:
    """One clause and everything that cites it.

    `action` are step actions of the specification, `definition` its other definitions, `step` functions and
    classes of the reference implementation, `vector` the tour cases of published targets.
    """

    clause: str
    kind: str
    title: str
    device: tuple[str, ...]
    action: tuple[str, ...]
    definition: tuple[str, ...]
    step: tuple[str, ...]
    property: tuple[str, ...]
    theorem: tuple[str, ...]
    vector: tuple[str, ...]
    finding: tuple[str, ...]
    assumption: tuple[str, ...]


def matrix_of(document: Document, cited: Sequence[Citation]) -> tuple[Row, ...]:
    """One row a clause, in the order of the register."""
    actions = step_actions(document)
    targets = vector_targets(document)
    return tuple(_row(clause, cited, actions, targets) for clause in document.clauses)


def step_actions(document: Document) -> dict[str, tuple[str, str]]:
    """The step actions by `Module!Step`, each with its device and step name."""
    return {
        f"{device.module}!{step}": (device.id, step)
        for device in document.interface.devices.values()
        for step in device.steps
    }


def vector_targets(document: Document) -> frozenset[str]:
    """The published devices whose graph a run prints, so that tours over their steps exist."""
    printed = {run.graph.device for run in document.runs if run.graph is not None}
    return frozenset(
        device.id
        for device in document.interface.devices.values()
        if device.published and device.id in printed
    )


def _row(
    clause: Clause, cited: Sequence[Citation], actions: dict[str, tuple[str, str]], targets: frozenset[str]
) -> Row:
    citing = [citation for citation in cited if clause.id in citation.clauses]

    def names(kind: str, room: str) -> list[str]:
        return [citation.name for citation in citing if citation.kind == kind and citation.room == room]

    spec = names("definition", "spec")
    taken = [name for name in spec if name in actions]
    return Row(
        clause=clause.id,
        kind=clause.kind,
        title=clause.title,
        device=clause.device,
        action=tuple(taken),
        definition=tuple(name for name in spec if name not in actions),
        step=tuple(names("definition", "refimpl")),
        property=tuple(names("property", "registers")),
        theorem=tuple(names("theorem", "proofs")),
        vector=tuple(
            f"{device}/tour:{step}" for device, step in map(actions.__getitem__, taken) if device in targets
        ),
        finding=tuple(names("finding", "registers")),
        assumption=tuple(names("assumption", "registers")),
    )


def orphans(
    document: Document, rows: Sequence[Row], cited: Sequence[Citation], sources: Sources
) -> list[Problem]:
    """Everything that is alone: clauses that nobody carries out, and work that no clause asks for."""
    problems = [] if rows else [Problem(document.source("clauses"), "", "the matrix has no row")]
    for clause, row in zip(document.clauses, rows, strict=True):
        problems += _clause_orphans(document, clause, row, cited)
    problems += _step_orphans(document, cited)
    problems += _function_orphans(document, cited, sources)
    for citation in cited:
        if citation.kind in ("property", "theorem") and not citation.clauses:
            problems.append(Problem(citation.file, citation.name, f"the {citation.kind} cites no clause"))
    return problems


def _clause_orphans(
    document: Document, clause: Clause, row: Row, cited: Sequence[Citation]
) -> Iterable[Problem]:
    file = document.source("clauses")
    if clause.kind == "behaviour":
        for room, noun in (("spec", "TLA+ definition"), ("refimpl", "Python function")):
            for device in _unserved(document, clause, room, cited):
                of = f" of {device}" if device else ""
                yield Problem(file, clause.id, f"no {noun}{of} cites this behaviour")
        if not (row.property or row.theorem):
            yield Problem(file, clause.id, "no property and no theorem cites this behaviour")
    elif clause.kind == "property" and not (row.property or row.theorem):
        yield Problem(file, clause.id, "no property and no theorem cites this property")
    elif clause.kind == "assumption" and not (row.assumption or row.property):
        yield Problem(file, clause.id, "no assumption and no property cites this assumption")
    elif clause.kind == "not modelled" and not clause.because.strip():
        yield Problem(file, clause.id, "not modelled, and `because` does not say why")


def _unserved(document: Document, clause: Clause, room: str, cited: Sequence[Citation]) -> list[str]:
    """The devices of the clause for which the room does not cite it; [""] when the room never cites it.

    A module that belongs to no device (code tables, the composition) speaks for every device.
    """
    citing = [
        citation
        for citation in cited
        if citation.room == room and citation.kind == "definition" and clause.id in citation.clauses
    ]
    if not citing:
        return [""]
    if any(not citation.device for citation in citing):
        return []
    served = {citation.device for citation in citing}
    return [
        device for device in clause.device if device in document.interface.devices and device not in served
    ]


def _step_orphans(document: Document, cited: Sequence[Citation]) -> Iterable[Problem]:
    actions = step_actions(document)
    for citation in cited:
        if (
            citation.kind == "definition"
            and citation.name in actions
            and not (citation.clauses or citation.findings)
        ):
            yield Problem(citation.file, citation.name, "the step cites no clause and no finding")


def _function_orphans(document: Document, cited: Sequence[Citation], sources: Sources) -> Iterable[Problem]:
    by_name = {
        function.name: function
        for function in cited
        if function.room == "refimpl" and function.kind == "definition"
    }
    for module in sources.refimpl:
        device = document.interface.devices.get(module.name)
        if device is None:
            continue
        states = {snake(state) for state in device.states}
        for node in module.tree.body:
            if not isinstance(node, ast.FunctionDef):
                continue
            if node.name.startswith("_") and node.name.strip("_") not in states:
                continue
            citation = by_name[f"{module.name}.{node.name}"]
            if not (citation.clauses or citation.findings):
                what = "implements a state" if node.name.startswith("_") else "is public"
                yield Problem(
                    module.file, node.name, f"the function {what} and cites no clause and no finding"
                )


def snake(name: str) -> str:
    """The name of a state as functions spell it: `TwoWords3` -> `two_words3`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()

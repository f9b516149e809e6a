"""The parts of the report, in the order of the page. Each is a module with `part(sources) -> Part`, and a
template of the same name in `page/`.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

from modeproof.report.part import Maker
from modeproof.report.parts import (
    assumptions,
    changes,
    charts,
    confidence,
    conformance,
    explorer,
    faults,
    findings,
    functions,
    glossary,
    limits,
    machine,
    matrix,
    programs,
    proofs,
    properties,
    readings,
    reproduce,
    responses,
    review,
    scope,
    strength,
    summary,
    system,
    traces,
    verdict,
)

_FILED = (summary, functions, findings, machine, limits, reproduce)
_ANNEX = (
    review,
    verdict,
    scope,
    system,
    charts,
    properties,
    responses,
    assumptions,
    readings,
    faults,
    conformance,
    programs,
    strength,
    proofs,
    matrix,
    traces,
    explorer,
    confidence,
    changes,
    glossary,
)


def _id(module: ModuleType) -> str:
    return module.__name__.rpartition(".")[2]


FILED = tuple(map(_id, _FILED))
"""What is printed and filed; the first has the troubles of all."""
ORDER = tuple(map(_id, (*_FILED, *_ANNEX)))
"""All parts. What is not filed is the annex: it closes on the screen and is printed on request."""


def makers() -> Iterator[tuple[str, Maker]]:
    """Each part's id and how it is made."""
    for module in (*_FILED, *_ANNEX):
        yield _id(module), module.part

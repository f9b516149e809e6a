"""The parts of the report, in the order of the page. Each is a module with `part(sources) -> Part`, and a
template of the same name in `page/`.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator

from modeproof.report.part import Maker

ORDER = (
    "verdict",
    "review",
    "scope",
    "system",
    "charts",
    "properties",
    "assumptions",
    "findings",
    "faults",
    "conformance",
    "programs",
    "strength",
    "proofs",
    "matrix",
    "traces",
    "explorer",
    "confidence",
    "limits",
    "changes",
    "reproduce",
    "glossary",
)


def makers() -> Iterator[tuple[str, Maker]]:
    """Each part's id and how it is made."""
    for name in ORDER:
        yield name, importlib.import_module(f"{__name__}.{name}").part

"""The parts of the report, in the order of the page. Each is a module with `part(sources) -> Part`, and a
template of the same name in `page/`.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator

from modeproof.report.part import Maker

FILED = ("summary", "functions", "findings", "machine", "limits", "reproduce")
"""What is printed and filed; the first has the troubles of all."""
ORDER = (
    *FILED,
    "review",
    "verdict",
    "scope",
    "system",
    "charts",
    "properties",
    "responses",
    "assumptions",
    "readings",
    "faults",
    "conformance",
    "programs",
    "strength",
    "proofs",
    "matrix",
    "traces",
    "explorer",
    "confidence",
    "changes",
    "glossary",
)
"""All parts. What is not filed is the annex: it closes on the screen and is printed on request."""


def makers() -> Iterator[tuple[str, Maker]]:
    """Each part's id and how it is made."""
    for name in ORDER:
        yield name, importlib.import_module(f"{__name__}.{name}").part

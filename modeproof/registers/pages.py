"""Where the pages of a document are: the folder docs/<document>, with the same names for every document."""

from __future__ import annotations

from pathlib import Path

FINDINGS = "findings.md"
"""The index of the findings; the page of each finding is in the folder `findings` beside it."""
DEVIATIONS = "deviations.md"
PROOFS = "proofs.md"
STRENGTH, KILL_TABLE = "strength.md", "strength.csv"
STRENGTH_OF_CODE = "strength-impl.md"
ADEQUACY = "adequacy.md"
SCALING, SCALING_PICTURE = "scaling.md", "scaling.svg"

ROWS = (
    (FINDINGS, "findings"),
    (DEVIATIONS, "deviations"),
    (PROOFS, "proofs"),
    (STRENGTH, "strength of the properties"),
    (STRENGTH_OF_CODE, "of the theorems"),
    (ADEQUACY, "of the vectors"),
    ("faults.md", "faults from outside"),
    (SCALING, "how it grows"),
)
"""What a reader may find there, in this order, with its name in an index."""


def page_of(document: str, name: str) -> str:
    """The path of a page of a document from the root, with forward slashes."""
    return f"docs/{document}/{name}"


def pages_there(root: Path, document: str) -> list[tuple[str, str]]:
    """Path and name of those pages of `ROWS` that exist."""
    found = [(page_of(document, name), words) for name, words in ROWS]
    return [(path, words) for path, words in found if (root / path).is_file()]

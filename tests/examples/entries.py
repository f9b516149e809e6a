"""The entries of a page of faults: a row of its table is a list there, for no line is longer than 160."""

from __future__ import annotations

import re
from pathlib import Path


def entries(page: Path) -> list[str]:
    """Each entry of the lists of a page, on one line."""
    parts = re.split(r"\n\n|\n(?=- \*\*)", page.read_text(encoding="utf-8"))
    return [" ".join(part.split()) for part in parts if part.startswith("- **")]


def entry(head: str, row: str) -> str:
    """The entry that a row under these headings becomes."""
    names, (first, *cells) = _cells(head)[1:], _cells(row)
    return " ".join([f"- **{first}**", *(f"- {name}: {cell}" for name, cell in zip(names, cells) if cell)])  # noqa: B905


def _cells(row: str) -> list[str]:
    return [cell.strip() for cell in row.strip("| ").split(" | ")]

"""The matrix as a table, and the marked blocks in pages: pictures of documents, the index of documents."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path, PurePosixPath

from modeproof.ground.fitted import fitted
from modeproof.registers.document_page import page_name
from modeproof.registers.files import read_text, shown
from modeproof.registers.matrix import Row
from modeproof.registers.rows import Document, Problem
from modeproof.registers.stale import stale

COLUMNS = ("clause", "kind", "action", "step", "property", "theorem", "vector")
"""The columns of the text table; JSON and CSV have all fields."""

BLOCK = re.compile(
    r"(<!-- begin (picture|documents)(?: ([a-z][a-z0-9_]*))? -->\n)"
    r"(.*?)(<!-- end(?: (?:picture|documents))? -->)",
    re.DOTALL,
)
BEGIN = re.compile(r"<!-- begin (?:picture|documents)")


def matrix_text(rows: Sequence[Row]) -> str:
    """The matrix as a table for a terminal; a cell shows its first entry and the number of the others."""
    cells = [[_cell(getattr(row, column)) for column in COLUMNS] for row in rows]
    widths = [max(len(line[n]) for line in [list(COLUMNS), *cells]) for n in range(len(COLUMNS))]
    lines = [list(COLUMNS), ["-" * width for width in widths], *cells]
    return "\n".join(
        "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    )


def _cell(value: str | tuple[str, ...]) -> str:
    if isinstance(value, str):
        return value
    if not value:
        return "-"
    return value[0] if len(value) == 1 else f"{value[0]} +{len(value) - 1}"


def matrix_records(rows: Sequence[Row]) -> list[dict[str, object]]:
    """The matrix as plain records, one a clause, lists in full."""
    return [
        {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(row).items()}
        for row in rows
    ]


def matrix_csv(rows: Sequence[Row]) -> str:
    """The matrix as CSV with all fields; entries of a cell are separated by a blank."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    records = matrix_records(rows)
    writer.writerow(records[0] if records else COLUMNS)
    for record in records:
        writer.writerow([" ".join(value) if isinstance(value, list) else value for value in record.values()])
    return stream.getvalue()


def render_picture(document: Document) -> str:
    """Devices and the signals between them as a Mermaid chart; a signal flows to where an input has its name.

    What no device sends comes from the user and the machine, and what no device reads goes there.
    """
    devices = document.interface.devices
    flows: dict[tuple[str, str], list[str]] = {}
    for device in devices.values():
        for name in device.outputs:
            readers = [other.id for other in devices.values() if name in other.inputs]
            for reader in readers or ["sink"]:
                flows.setdefault((device.id, reader), []).append(name)
        sent = {name for other in devices.values() for name in other.outputs}
        for name in (name for name in device.inputs if name not in sent):
            flows.setdefault(("source", device.id), []).append(name)
    lines = [
        "```mermaid",
        "flowchart TB",
        '    source(["from the user and the machine"])',
        '    sink(["to the user and the machine"])',
    ]
    lines += [f'    {device.id}["{device.title.replace(": ", "<br>", 1)}"]' for device in devices.values()]
    for (a, b), names in flows.items():
        back = flows.get((b, a))
        if back is None:
            lines.append(f'    {a} -- "{_rows(names)}" --> {b}')
        elif (b, a) > (a, b):
            lines.append(f'    {a} <-- "to {b}: {_rows(names)}<br>to {a}: {_rows(back)}" --> {b}')
    return "\n".join([*lines, "```"]) + "\n"


def _rows(names: Sequence[str]) -> str:
    """Three names a row, so that labels stay small."""
    return "<br>".join(", ".join(names[n : n + 3]) for n in range(0, len(names), 3))


def render_index(document: Document, here: PurePosixPath) -> str:
    """A document in an index: its title, its targets and where to read on; `here` is the page's folder."""
    name = document.name
    devices = document.interface.devices.values()
    targets = ", ".join(f"`{device.id}`" for device in devices if device.published) or "none"
    places = [(page_name(name), "what was shown and found"), (f"spec/{name}", "registers and TLA+")]
    links = [
        f"[{words}]({_relative(path, here)})" for path, words in places if (document.root / path).exists()
    ]
    return fitted(f"- **`{name}`** {document.about.title}. Targets: {targets}. {', '.join(links)}.")


def _relative(path: str, here: PurePosixPath) -> str:
    return PurePosixPath(os.path.relpath(path, here)).as_posix()


def render_blocks(text: str, documents: Sequence[Document], page: str = "README.md") -> str:
    """The page with each block `<!-- begin WHAT [DOCUMENT] --> .. <!-- end -->` rendered anew.

    WHAT is `picture`, or `documents` for an index. Without a name the block holds those of all documents.
    `page` is the path of the page from the root, for its links.
    """
    here = PurePosixPath(page).parent

    def block(match: re.Match[str]) -> str:
        chosen = [document for document in documents if match.group(3) in (None, document.name)]
        if match.group(2) == "documents":
            return (
                match.group(1) + "".join(render_index(document, here) for document in chosen) + match.group(5)
            )
        return match.group(1) + "\n".join(map(render_picture, chosen)) + match.group(5)

    return BLOCK.sub(block, text)


def pages(root: Path) -> list[Path]:
    """The pages that may hold rendered blocks: README.md and docs/*.md."""
    return [path for path in [root / "README.md", *sorted((root / "docs").glob("*.md"))] if path.is_file()]


def check_pages(root: Path, documents: Sequence[Document]) -> list[Problem]:
    """Pages whose blocks differ from the registers."""
    problems = []
    for path in pages(root):
        text = read_text(root, path)
        if len(BEGIN.findall(text)) != len(BLOCK.findall(text)):
            problems.append(Problem(shown(root, path), "", "a rendered block has no end, or is malformed"))
        elif render_blocks(text, documents, shown(root, path)) != text:
            problems.append(Problem(shown(root, path), "", stale("a rendered block has drifted")))
    return problems

"""A counterexample as a timing diagram in SVG: a line for each signal, the scans on the time axis.

Scans in a row in which nothing changes share a column. Where there are many, the diagram goes on below
itself. The wrong scan has a frame, a mark above it and, for an output of which more is known, the value that
was expected.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import msgspec
from markupsafe import Markup

from modeproof.kit.errors import plain
from modeproof.output.outcome import Counterexample, Scan
from modeproof.output.svg import CHARACTER, element
from modeproof.output.words import shown

SIZE = 12.0
ROW, WAVE = 26.0, 15.0
"""Height of a row, and of the line in it."""
NARROW, WIDE, WHOLE = 46.0, 150.0, 940.0
"""Width of a column at least and at most, and of the picture."""
HEAD, GAP = 52.0, 22.0
MARGIN = 6.0
LONGEST_NAME = 30
MOST_ROWS = 18
"""Signals that are all shown; of more, those that change, and those that are wrong."""

STYLE = """
.td text{font:12px ui-monospace,"Liberation Mono",Consolas,monospace;fill:#1f2328}
.td .s{fill:#57606a;font-size:11px}.td .b{font-weight:700}
.td .bg{fill:#fff}.td .grid{stroke:#d0d7de;stroke-width:1;fill:none}
.td .w{stroke:#1f2328;stroke-width:1.6;fill:none}.td .bus{stroke:#1f2328;stroke-width:1.2;fill:none}
.td .x{stroke:#b42318;stroke-width:2.4;fill:none}.td .xt{fill:#b42318;font-weight:700}
.td .e{stroke:#1f2328;stroke-width:1.6;fill:none;stroke-dasharray:5 3}
.td .frame{stroke:#b42318;stroke-width:1.6;fill:#b42318;fill-opacity:.07}
@media print{.td text{fill:#000}.td .s{fill:#333}.td .bg{fill:#fff}.td .grid{stroke:#bbb}
.td .w,.td .bus,.td .e,.td .x,.td .frame{stroke:#000}.td .xt{fill:#000}.td .frame{fill:#000}}
"""
DARK = """
@media screen and (prefers-color-scheme:dark){.td text{fill:#e6edf3}.td .s{fill:#9da7b3}.td .bg{fill:#0d1117}
.td .grid{stroke:#3d444d}.td .w,.td .bus,.td .e{stroke:#e6edf3}.td .x,.td .frame{stroke:#ff7b72}
.td .xt{fill:#ff7b72}.td .frame{fill:#ff7b72}}
"""
"""Of a picture alone; a page has its own colours."""


@dataclass(frozen=True)
class Column:
    """Scans in a row in which nothing changes. number: of the first; last: the wrong one is in it."""

    number: int
    count: int
    scan: Scan
    last: bool

    @property
    def labels(self) -> tuple[str, str]:
        """Which scans, and the time of each."""
        which = f"{self.number}" if self.count == 1 else f"{self.number}-{self.number + self.count - 1}"
        time = "" if self.scan.dt_ms is None else f"+{self.scan.dt_ms:,} ms"
        return which, time


@dataclass(frozen=True)
class Row:
    """A signal: its value in each column. kind: `input`, `output`, or `expected`, of a wrong output."""

    name: str
    kind: str
    values: Sequence[Any]
    wrong: bool = False

    @property
    def level(self) -> bool:
        """Whether it is drawn as a line that is high or low."""
        return all(value is None or isinstance(value, bool) for value in self.values)


def as_svg(example: Counterexample, title: str, about: str) -> str:
    """The picture as a file. title, about: what screen readers say of it."""
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{drawn(example, title, about, alone=True)}\n'


def drawn(example: Counterexample, title: str, about: str, alone: bool = False) -> Markup:
    """The picture as an element, for a page. alone: with its own style and background."""
    columns, rows = list(columns_of(example)), list(rows_of(example))
    left = max(len(_name(row)) for row in rows) * SIZE * CHARACTER + 18
    width = _width(columns, rows)
    many = max(1, int((WHOLE - left) / width))
    most = math.ceil(len(columns) / math.ceil(len(columns) / many))  # bands of about the same width
    bands = [range(first, min(first + most, len(columns))) for first in range(0, len(columns), most)]
    parts: list[Markup] = []
    y = 8.0
    for band in bands:
        parts += _band(columns, rows, band, left, width, y)
        y += HEAD + ROW * len(rows) + GAP
    whole = left + width * max(map(len, bands)) + 12
    ground = [element("style", Markup(STYLE + DARK))] if alone else []
    ground += [element("rect", class_="bg", width=whole, height=y)]
    return element(
        "svg",
        element("title", plain(title)),
        element("desc", plain(about)),
        *ground,
        *parts,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {whole:.0f} {y:.0f}",
        width=f"{whole:.0f}",
        height=f"{y:.0f}",
        class_="td",
        role="img",
    )


def columns_of(example: Counterexample) -> Iterator[Column]:
    """The scans, those in which nothing changes together; the wrong one alone."""
    scans = example.scans

    def key(at: int) -> Any:
        scan = scans[at]
        same = at and (scan.inputs, scan.given) == (scans[at - 1].inputs, scans[at - 1].given)
        # A scan that repeats the one before joins those that repeat it after the same time
        return (scan.dt_ms, "still") if same and at < len(scans) - 1 else at

    for _, group in groupby(range(len(scans)), key):
        found = list(group)
        last = found[-1] == len(scans) - 1
        yield Column(example.first + found[0], len(found), scans[found[0]], last)


def rows_of(example: Counterexample) -> Iterator[Row]:
    """The signals that are drawn: inputs, outputs, and below a wrong one what was expected."""
    columns = [column.scan for column in columns_of(example)]
    inputs = list(dict.fromkeys(name for scan in columns for name in scan.inputs))
    outputs = list(dict.fromkeys(name for scan in columns for name in (*scan.given, *scan.expected)))
    if len(inputs) + len(outputs) > MOST_ROWS:
        inputs = [name for name in inputs if _changes([scan.inputs for scan in columns], name)]
        given = [scan.given for scan in columns]
        outputs = [name for name in outputs if name in example.wrong or _changes(given, name)]
    for name in inputs:
        yield Row(name, "input", [scan.inputs.get(name) for scan in columns])
    for name in outputs:
        wrong = name in example.wrong
        yield Row(name, "output", [scan.given.get(name) for scan in columns], wrong)
        if wrong and name in columns[-1].expected:
            yield Row(name, "expected", [scan.expected.get(name) for scan in columns])


def latest(example: Counterexample, most: int) -> Counterexample:
    """The last columns of a counterexample, for a small picture; all of it where it has no more."""
    columns = list(columns_of(example))
    if len(columns) <= most:
        return example
    first = columns[-most].number
    scans = example.scans[first - example.first :]
    return msgspec.structs.replace(example, scans=scans, first=first)


def _changes(rows: Sequence[Mapping[str, Any]], name: str) -> bool:
    values = [row.get(name) for row in rows]
    return any(value != values[0] for value in values)


def _name(row: Row) -> str:
    name = plain(row.name)
    name = name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 2]}.."
    return f"expected {name}"[: LONGEST_NAME + 9] if row.kind == "expected" else name


def _width(columns: Sequence[Column], rows: Sequence[Row]) -> float:
    texts = [text for column in columns for text in column.labels]
    texts += [shown(value) for row in rows if not row.level for value in row.values if value is not None]
    return min(WIDE, max(NARROW, max(map(len, texts)) * SIZE * CHARACTER + 16))


def _band(
    columns: Sequence[Column], rows: Sequence[Row], band: range, left: float, width: float, top: float
) -> list[Markup]:
    """The columns of one band, with the names of the signals."""
    parts: list[Markup] = []
    bottom = top + HEAD + ROW * len(rows)
    right = left + width * len(band)
    parts.append(_text(MARGIN, top + 16, "scan", kind="s"))
    parts.append(_text(MARGIN, top + 31, "after", kind="s"))
    for n, at in enumerate(band):
        x = left + n * width
        column = columns[at]
        if column.last:
            parts.append(element("rect", class_="frame", x=x, y=top, width=width, height=bottom - top + 4))
            parts.append(_text(x + width / 2, top + 45, "wrong", "middle", "xt"))
        which, time = column.labels
        parts.append(_text(x + width / 2, top + 16, which, "middle", "b"))
        parts.append(_text(x + width / 2, top + 31, time, "middle", "s"))
        parts.append(element("path", class_="grid", d=f"M{x:.1f} {top + HEAD:.1f}V{bottom:.1f}"))
    for number, row in enumerate(rows):
        base = top + HEAD + ROW * (number + 1) - 6
        kind = "xt" if row.wrong else "s" if row.kind == "expected" else "b" if row.kind == "output" else ""
        parts.append(_text(MARGIN, base - 2, _name(row), kind=kind))
        parts.append(element("path", class_="grid", d=f"M{left:.1f} {base + 4:.1f}H{right:.1f}"))
        values = [row.values[at] for at in band]
        wrong = row.wrong and columns[band[-1]].last
        parts += (_wave if row.level else _bus)(values, left, width, base, row, wrong)
    return parts


def _wave(
    values: Sequence[bool | None], left: float, width: float, base: float, row: Row, wrong: bool
) -> Iterator[Markup]:
    """A line that is high or low; nothing where the value is not known."""
    kind = "e" if row.kind == "expected" else "w"
    path, before = "", None
    for n, value in enumerate(values):
        x = left + n * width
        if value is None:
            before = None
            continue
        y = base - WAVE * value
        path += f"M{x:.1f} {y:.1f}" if before is None else "" if before == value else f"V{y:.1f}"
        path += f"H{x + width:.1f}"
        before = value
    yield element("path", class_=kind, d=path or "M0 0")
    if wrong and values[-1] is not None:
        x, y = left + (len(values) - 1) * width, base - WAVE * values[-1]
        yield element("path", class_="x", d=f"M{x:.1f} {y:.1f}H{x + width:.1f}")


def _bus(
    values: Sequence[Any], left: float, width: float, base: float, row: Row, wrong: bool
) -> Iterator[Markup]:
    """A box with the value for as long as it stays."""
    at = 0
    for (value, _), group in groupby(
        (value, wrong and n == len(values) - 1) for n, value in enumerate(values)
    ):
        count = len(list(group))
        x, end = left + at * width, left + (at + count) * width
        at += count
        if value is None:
            continue
        high, low, middle = base - WAVE - 1, base + 1, base - WAVE / 2
        last = wrong and at == len(values)
        kind = "x" if last else "e" if row.kind == "expected" else "bus"
        box = f"M{x:.1f} {middle:.1f}L{x + 4:.1f} {high:.1f}H{end - 4:.1f}L{end:.1f} {middle:.1f}"
        yield element("path", class_=kind, d=f"{box}L{end - 4:.1f} {low:.1f}H{x + 4:.1f}Z")
        most = int((end - x - 10) / (SIZE * CHARACTER))
        text = shown(value)
        text = text if len(text) <= most else f"{text[: most - 2]}.."
        yield _text((x + end) / 2, base - 4, text, "middle", "xt" if last else "")


def _text(x: float, y: float, text: str, anchor: str | None = None, kind: str = "") -> Markup:
    return element("text", text, x=x, y=y, text_anchor=anchor, class_=kind or None)

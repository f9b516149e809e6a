"""A counterexample as a table, one row a scan, changed cells in bold; and the decided device beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from modeproof.registers.replay import Traces
from modeproof.report.cells import Cells, Column

PART = "▶"


def markdown(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table that ends with a line end."""
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def bold(text: str, is_bold: bool) -> str:
    """The text in bold if there is one; each line of a cell on its own, as Markdown wants it."""
    return f"**{text}**" if is_bold and text else text


@dataclass(frozen=True)
class ScanTable:
    """A rendered table, the columns that never change as a sentence, and the number of the last step."""

    text: str
    constant: str
    steps: int


def who(traces: Traces, row: Mapping[str, Any]) -> str:
    """Who executed a step, as a table says it."""
    device = str(row["who"])
    if device:
        return traces.devices[device].short if device in traces.devices else device
    return traces.nobody.get(str(row["step"]), "environment")


def scan_table(walk: Mapping[str, Any], names: Sequence[str], traces: Traces, cells: Cells) -> ScanTable:
    """The table of a walk with the columns of these names; row 0 is the state after power-up.

    A column whose cell is the same in every row is left out and named in `constant`.
    """
    rows = walk["rows"]
    columns = cells.columns(names, list(rows[0]["variables"]))
    # What a scan read is a wire of that scan: in row 0 there has been none.
    shown = [[cells.show(one, row["wires"], row["variables"]) for one in columns] for row in rows]
    first = [1 if _is_input(one, walk) and len(rows) > 1 else 0 for one in columns]
    moving = [n for n in range(len(columns)) if len({row[n] for row in shown[first[n] :]}) > 1]
    still = [n for n in range(len(columns)) if n not in moving and columns[n].id != "dt"]
    several = len({who(traces, row) for row in rows[1:]}) > 1
    heads = [
        "step" if several else "scan",
        *(["who"] if several else []),
        "executes",
        *(columns[n].heading for n in moving),
    ]
    lines = []
    for at, row in enumerate(rows):
        begin = [str(at)] + ([who(traces, row) if at else ""] if several else [])
        name = f"`{row['step']}`" if row["step"] else ("power-up" if at == 0 else "")
        inputs = at == 0
        line = []
        for n in moving:
            changed = at > 0 and shown[at][n] != shown[at - 1][n]
            text = "" if inputs and _is_input(columns[n], walk) else shown[at][n]
            # In a long table of several devices a word is spelled out where it changes.
            line.append(bold(text if changed or not several else text.split(" =<br>")[0], changed))
        lines.append([*begin, name, *line])
    constant = ", ".join(f"{columns[n].heading} {shown[-1][n]}".replace("<br>", " ") for n in still)
    return ScanTable(markdown(heads, lines), constant, len(rows) - 1)


def _is_input(column: Column, walk: Mapping[str, Any]) -> bool:
    """Whether a column holds what the one device of the walk read: nothing has been read before the first
    scan.
    """
    outputs = set(walk.get("outputs", ()))
    return column.of in ("wire", "vector") and bool(outputs) and not outputs.intersection(column.signals)


@dataclass(frozen=True)
class Comparison:
    """Recorded and decided device on the same inputs, from step `begins` on. `others` are the other steps in
    which the decided device would do otherwise, with what it would execute. Where it never does, `begins` is
    None.
    """

    device: str
    begins: int | None
    others: tuple[tuple[int, str], ...]
    scans: int
    text: str


def compare(
    walk: Mapping[str, Any], device: str, names: Sequence[str], traces: Traces, cells: Cells
) -> Comparison:
    """The scans of one device beside those of the decided one."""
    decided = walk["decided"][device]
    rows = {row["at"]: row for row in walk["rows"]}
    departures = walk["departures"][device]
    if not departures:
        return Comparison(device, None, (), len(decided), "")
    outputs = set(decided[0]["outputs"])
    columns = [one for one in cells.columns(names, ()) if one.signals and outputs.issuperset(one.signals)]
    known = cells.interface.devices[device]
    names_read = [
        one for one in cells.columns(names, ()) if one.signals and not set(one.signals) - set(known.inputs)
    ]
    pairs, reads = [], []
    for scan in decided:
        row = rows[scan["at"]]
        reads.append([cells.show(one, row["wires"], {}) for one in names_read])
        left = [f"`{row['step']}`", _state(cells, device, row["variables"])]
        right = [f"`{scan['step']}`", _state(cells, device, scan["memory"])]
        left += [cells.show(one, row["wires"], {}) for one in columns]
        right += [cells.show(one, scan["outputs"], {}) for one in columns]
        pairs.append((scan["at"] - 1, left, right))
    differing = [n for n in range(2 + len(columns)) if n < 2 or any(a[n] != b[n] for _, a, b in pairs)]
    heads = ["scan" if walk["outputs"] else "step", *(f"reads<br>{one.heading}" for one in names_read)]
    for n in differing:
        name = ("executes", "then is in")[n] if n < 2 else columns[n - 2].heading
        heads += [f"{name}:<br>restored", f"{name}:<br>decided"]
    begins = pairs[0][0]
    lines = []
    for (at, left, right), read in zip(pairs, reads, strict=True):
        line = [f"{PART} {at}" if at == begins else str(at), *read]
        for n in differing:
            line += [left[n], bold(right[n], left[n] != right[n])]
        lines.append(line)
    others = tuple((one["at"] - 1, one["step"]) for one in departures if one["at"] - 1 < begins)
    return Comparison(device, begins, others, len(pairs), markdown(heads, lines))


def _state(cells: Cells, device: str, variables: Mapping[str, Any]) -> str:
    return str(variables.get(cells.state_variable(device, variables), ""))

"""A counterexample as a short table: a row a scan or step, only columns that change, new cells in bold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.files import markdown
from modeproof.registers.replay import Traces
from modeproof.report.scan_table_cells import Cells, Column

WHOLE, END = 14, 12
"""A counterexample of more rows than WHOLE is shown by its last rows, END of them."""


def scan_table(walk: Mapping[str, Any], traces: Traces, cells: Cells) -> str:
    """The table of a walk, what is the same in every row, and what the decided device does instead.

    Row 0 is the state after power-up.
    """
    rows = walk["rows"] if len(walk["rows"]) <= WHOLE else walk["rows"][-END:]
    hidden = len(walk["rows"]) - len(rows)
    columns = cells.columns(traces.tops[walk["module"]].columns, list(rows[0]["variables"]))
    shown = [[cells.show(column, row["wires"], row["variables"]) for column in columns] for row in rows]
    # What a scan read is a wire of that scan: at power-up there has been none.
    first = [1 if _is_input(column, walk) and not hidden and len(rows) > 1 else 0 for column in columns]
    moving = [n for n in range(len(columns)) if len({row[n] for row in shown[first[n] :]}) > 1]
    still = [n for n in range(len(columns)) if n not in moving and columns[n].id != "dt"]
    several = len({_who(traces, row) for row in walk["rows"][1:]}) > 1
    heads = ["step", "who", "executes"] if several else ["scan", "executes"]
    lines = []
    for at, row in enumerate(rows):
        number = at + hidden
        name = f"`{row['step']}`" if row["step"] else "power-up" if number == 0 else ""
        line = [str(number), _who(traces, row) if number else "", name] if several else [str(number), name]
        for n in moving:
            read_nothing = number == 0 and _is_input(columns[n], walk)
            changed = at > 0 and shown[at][n] != shown[at - 1][n]
            # In a table of several devices a word is spelled out where it changes.
            text = shown[at][n] if changed or not several else shown[at][n].split(" =<br>")[0]
            line.append("" if read_nothing else f"**{text}**" if changed and text else text)
        lines.append(line)
    notes = []
    if hidden:
        notes.append(f"Steps 1 to {hidden - 1} lead here and are not shown.")
    if still:
        same = ", ".join(f"{columns[n].heading} {shown[-1][n]}".replace("<br>", " ") for n in still)
        notes.append(f"The same in every row: {same}.")
    notes += _instead(walk, traces, hidden, heads[0])
    text = markdown([*heads, *(columns[n].heading for n in moving)], lines)
    return text + "".join(f"\n{note}\n" for note in notes)


def _who(traces: Traces, row: Mapping[str, Any]) -> str:
    """Who executed a step, as a table says it."""
    device = str(row["who"])
    if device:
        return traces.devices[device].short if device in traces.devices else device
    return traces.nobody.get(str(row["step"]), "environment")


def _instead(walk: Mapping[str, Any], traces: Traces, hidden: int, word: str) -> list[str]:
    """What each decided device does in the first row of the table in which it goes another way."""
    steps = {row["at"]: row["step"] for row in walk["rows"]}
    notes = []
    for device, departures in walk.get("departures", {}).items():
        shown = [departure for departure in departures if departure["at"] > hidden]
        for departure in shown[:1]:
            here, decided = steps[departure["at"]], departure["step"]
            rest = f"it executes `{decided}`, not `{here}`"
            if decided == here:
                rest = f"it executes `{here}` too, but ends with other values"
            short = traces.devices[device].short
            notes.append(
                f"What we decided: in {word} {departure['at'] - 1} the {short} reads the same, and {rest}."
            )
    return notes


def _is_input(column: Column, walk: Mapping[str, Any]) -> bool:
    """Whether a column holds what the one device of the walk read."""
    outputs = set(walk.get("outputs", ()))
    return column.of in ("wire", "vector") and bool(outputs) and not outputs.intersection(column.signals)

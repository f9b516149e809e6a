"""The picture of a wiring, as a Mermaid flowchart: who sends what to whom."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from machines.signal_names import leaves
from machines.wiring import Wiring
from programs.language.tree import Member, Name

START = "start"
"""The box of the standard blocks, the named signals and the matrix."""


def picture(wiring: Wiring) -> str:
    """Senders, the documents' blocks, the start circuit, and readers, with each wire between them."""
    boxes, wires = boxes_and_wires(wiring)
    lines = ["flowchart LR"]
    for box in boxes:
        shown = f'["{box["id"]}<br>{box["title"]}"]' if not box["outside"] else f'(["{box["title"]}"])'
        lines.append(f"    {box['id']}{shown}".replace(f'["{START}<br>', '["start circuit<br>'))
    for wire in wires:
        texts = wire["names"]
        rows = [", ".join(texts[at : at + 3]) for at in range(0, len(texts), 3)]
        lines.append(f'    {wire["source"]} -- "{"<br>".join(rows)}" --> {wire["target"]}')
    return "\n".join(lines) + "\n"


def boxes_and_wires(wiring: Wiring) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Each box with its title, and whether it is outside; what runs from one to another."""
    table = wiring.table
    documents = [name for name in table.order if wiring.kinds[name].unit is not None]
    boxes = {f"from_{_key(row.source)}": (row.source, True) for row in table.inputs.values()}
    boxes |= {name: (table.block[name].of, False) for name in documents}
    boxes[START] = "edges, latches, activation matrix", False
    boxes |= {f"to_{_key(row.target)}": (row.target, True) for row in table.outputs.values()}
    found: dict[tuple[str, str], dict[str, None]] = {}
    for source, target, text in _wires(wiring, documents):
        if source != target:
            found.setdefault((source, target), {})[text] = None
    return (
        [{"id": id, "title": title, "outside": outside} for id, (title, outside) in boxes.items()],
        [{"source": one, "target": other, "names": list(names)} for (one, other), names in found.items()],
    )


def matrix(wiring: Wiring) -> str:
    """The activation matrix as a table: a number for each set of safeguards, one of which must hold."""
    shown = wiring.table.safeguards
    lines = [f"| mode | {' | '.join(shown)} | why |", "|---" * (len(shown) + 2) + "|"]
    lines += [f"| {row['mode']} | {' | '.join(row['sets'])} | {row['why']} |" for row in matrix_rows(wiring)]
    return "\n".join(lines) + "\n"


def matrix_rows(wiring: Wiring) -> list[dict[str, Any]]:
    """Its rows: for each safeguard the numbers of the sets that it is in."""
    table = wiring.table
    return [
        {
            "mode": mode,
            "sets": [
                ", ".join(str(at) for at, part in enumerate(sets, 1) if name in part)
                for name in table.safeguards
            ],
            "why": table.modes[mode].why,
        }
        for mode, sets in table.matrix.items()
    ]


def _wires(wiring: Wiring, documents: list[str]) -> Iterator[tuple[str, str, str]]:
    """Each wire: its two boxes and its name."""
    table = wiring.table

    def box(leaf: Name | Member) -> tuple[str, str]:
        if isinstance(leaf, Member) and isinstance(leaf.of, Name):
            return (leaf.of.name if leaf.of.name in documents else START), leaf.name
        assert isinstance(leaf, Name)
        if leaf.name in table.inputs:
            return f"from_{_key(table.inputs[leaf.name].source)}", leaf.name
        return START, leaf.name

    for name, pins in wiring.sources.items():
        target = name if name in documents else START
        for pin, tree in pins.items():
            for source, text in map(box, leaves(tree)):
                yield source, target, pin if source == START else text
    for name, tree in wiring.signals.items():
        if name in table.signals or not name.endswith("_in_use"):
            for source, text in map(box, leaves(tree)):
                yield source, START, text
    for name, tree in wiring.shown.items():
        for source, _ in map(box, leaves(tree)):
            yield source, f"to_{_key(table.outputs[name].target)}", name


def _key(text: str) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in text)

"""The picture of a wiring, as a Mermaid flowchart: who sends what to whom."""

from __future__ import annotations

from collections.abc import Iterator

from programs.tree import Binary, Expression, Member, Name, Unary
from programs.wiring import Wiring

START = "start"
"""The box of the standard blocks, the named signals and the matrix."""


def picture(wiring: Wiring) -> str:
    """Senders, the documents' blocks, the start circuit, and readers, with each wire between them."""
    table = wiring.table
    documents = [name for name in table.order if wiring.kinds[name].unit is not None]
    boxes = [f'    from_{_key(row.source)}(["{row.source}"])' for row in table.inputs.values()]
    boxes += [f'    {name}["{name}<br>{table.block[name].of}"]' for name in documents]
    boxes.append(f'    {START}["start circuit<br>edges, latches, activation matrix"]')
    boxes += [f'    to_{_key(row.target)}(["{row.target}"])' for row in table.outputs.values()]
    arrows: dict[tuple[str, str], list[str]] = {}
    for source, target, text in _wires(wiring, documents):
        known = arrows.setdefault((source, target), [])
        if source != target and text not in known:
            known.append(text)
    lines = ["flowchart LR", *dict.fromkeys(boxes)]
    for (source, target), texts in arrows.items():
        rows = [", ".join(texts[at : at + 3]) for at in range(0, len(texts), 3)]
        if rows:
            lines.append(f'    {source} -- "{"<br>".join(rows)}" --> {target}')
    return "\n".join(lines) + "\n"


def matrix(wiring: Wiring) -> str:
    """The activation matrix as a table: a number for each set of safeguards, one of which must hold."""
    table = wiring.table
    lines = [f"| mode | {' | '.join(table.safeguards)} | why |", "|---" * (len(table.safeguards) + 2) + "|"]
    for mode, sets in table.matrix.items():
        cells = [
            ", ".join(str(at) for at, part in enumerate(sets, 1) if name in part) for name in table.safeguards
        ]
        lines.append(f"| {mode} | {' | '.join(cells)} | {table.modes[mode].why} |")
    return "\n".join(lines) + "\n"


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
            for source, text in map(box, _leaves(tree)):
                yield source, target, pin if source == START else text
    for name, tree in wiring.signals.items():
        if name in table.signals or not name.endswith("_in_use"):
            for source, text in map(box, _leaves(tree)):
                yield source, START, text
    for name, tree in wiring.shown.items():
        for source, _ in map(box, _leaves(tree)):
            yield source, f"to_{_key(table.outputs[name].target)}", name


def _leaves(tree: Expression) -> Iterator[Name | Member]:
    match tree:
        case Name() | Member():
            yield tree
        case Unary(_, operand, _):
            yield from _leaves(operand)
        case Binary(_, left, right, _):
            yield from _leaves(left)
            yield from _leaves(right)


def _key(text: str) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in text)

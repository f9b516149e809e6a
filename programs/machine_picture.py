"""The picture of a wiring, as a Mermaid flowchart: who sends what to whom."""

from __future__ import annotations

from collections.abc import Iterator

from programs.tree import Expression
from programs.wiring import Wiring, names


def picture(wiring: Wiring) -> str:
    """Inputs by their senders, the documents' blocks, the start circuit, and outputs by their readers."""
    table = wiring.table
    lines = ["flowchart LR"]
    lines += [f'    in_{_key(source)}(["{source}"])' for source in _senders(wiring)]
    documents = [name for name in table.order if wiring.kinds[name].unit is not None]
    lines += [f'    {name}["{name}<br>{table.block[name].of}"]' for name in documents]
    lines.append('    start["start circuit<br>edges, latches and the activation matrix"]')
    lines += [f'    out_{_key(output.target)}(["{output.target}"])' for output in table.outputs.values()]
    arrows: dict[tuple[str, str], list[str]] = {}

    def arrow(source: str, target: str, text: str) -> None:
        known = arrows.setdefault((source, target), [])
        if source != target and text not in known:
            known.append(text)

    for name in table.order:
        target = name if name in documents else "start"
        for pin, tree in wiring.sources[name].items():
            for source, text in _sources(wiring, tree, documents):
                arrow(source, target, pin if target == name and source == "start" else text)
    for name, tree in wiring.shown.items():
        for source, _ in _sources(wiring, tree, documents):
            arrow(source, f"out_{_key(table.outputs[name].target)}", name)
    for (source, target), texts in arrows.items():
        if texts:
            rows = [", ".join(texts[at : at + 3]) for at in range(0, len(texts), 3)]
            lines.append(f'    {source} -- "{"<br>".join(rows)}" --> {target}')
    return "\n".join(dict.fromkeys(lines)) + "\n"


def _sources(wiring: Wiring, tree: Expression, documents: list[str]) -> Iterator[tuple[str, str]]:
    """The boxes that an expression reads, and the name of what it reads there."""
    table = wiring.table
    for name in names(tree):
        if name in table.inputs:
            yield f"in_{_key(table.inputs[name].source)}", name
        elif name in documents:
            yield name, name
        elif name in table.block or name in wiring.signals:
            if name in wiring.signals:
                for source, text in _sources(wiring, wiring.signals[name], documents):
                    if source not in documents or name in table.modes:
                        yield source, text
            yield "start", name


def _senders(wiring: Wiring) -> list[str]:
    return list(dict.fromkeys(row.source for row in wiring.table.inputs.values()))


def _key(text: str) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in text)

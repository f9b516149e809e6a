"""What the questions leave out: an output or a device that none is about, an input that nothing reads.

Wired without effect, or with an effect that nobody asked about, both pass in silence: a forgotten emergency
stop, a second drive. A file of properties may say why, by name, in its table `unasked`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from machines.composed_program import Watched
from machines.missing_names import EXPRESSIONS
from machines.signal_names import leaves, names
from machines.wiring import Wiring
from modeproof.ground.errors import Unjudged, suggestion
from programs.language.tree import Member, Name
from programs.properties.property_file import Questions, parsed

TABLE = "unasked"


def unread(wiring: Wiring) -> Iterator[str]:
    """The inputs that reach no pin of a block and no output."""
    read: set[str] = set()
    waiting = [tree for pins in wiring.sources.values() for tree in pins.values()]
    waiting += wiring.shown.values()
    while waiting:
        for name in set(names(waiting.pop())) - read:
            read.add(name)
            waiting += [wiring.signals[name]] if name in wiring.signals else []
    yield from (name for name in wiring.table.inputs if name not in read)


def unasked(wiring: Wiring, watched: Watched, questions: Questions) -> Iterator[str]:
    """The outputs that no property is about: by the output's name, or by the one signal that it shows."""
    place = wiring.place("outputs")
    waiting = [row[key] for row in questions.rows for key in EXPRESSIONS if isinstance(row.get(key), str)]
    observers = {name.upper(): seen for name, seen in watched.rows.items()}
    said: set[str] = set()
    while waiting:
        tree = parsed(waiting.pop(), place)
        said |= {_shown(leaf) for leaf in leaves(tree)}
        for name in {name.upper() for name in names(tree)} & observers.keys():
            waiting += observers.pop(name).inputs.values()
    for name, tree in wiring.shown.items():
        if not {name.upper(), *([_shown(tree)] if isinstance(tree, Name | Member) else [])} & said:
            yield name


def unasked_blocks(wiring: Wiring, watched: Watched, questions: Questions) -> Iterator[str]:
    """The documents' blocks, and those of one's own, of which no property names a pin: a second door."""
    place = wiring.place("block")
    texts = [row[key] for row in questions.rows for key in EXPRESSIONS if isinstance(row.get(key), str)]
    texts += [text for seen in watched.rows.values() for text in seen.inputs.values()]
    said = {name.upper() for text in texts for name in names(parsed(text, place))}
    yield from (name for name, of in wiring.kinds.items() if (of.unit or of.own) and name.upper() not in said)


def _shown(leaf: Name | Member) -> str:
    if isinstance(leaf, Member):
        return f"{leaf.of.name if isinstance(leaf.of, Name) else ''}.{leaf.name}".upper()
    return leaf.name.upper()


def excused(questions: Questions, wiring: Wiring, strictly: bool) -> Mapping[str, Any]:
    """Why a name is left out. Raises Unjudged: no reason, or, `strictly`, a name that the wiring has not."""
    rows = questions.tables.get(TABLE, {})
    if not isinstance(rows, dict):
        raise Unjudged(f"{questions.file}: [{TABLE}] is a table of names, each with its reason")
    known = [*wiring.table.inputs, *wiring.table.outputs, *wiring.table.block]
    for name, why in rows.items():
        if not isinstance(why, str) or not why.strip():
            raise Unjudged(f"{questions.file}: {TABLE}.{name}: say why nothing is asked about it")
        if strictly and name not in known:
            raise Unjudged(f"{questions.file}: {TABLE}.{name}: no such name; {suggestion(name, known)}")
    return rows

"""What a file of properties names and a wiring has not: those properties are not judged, the others are."""

from __future__ import annotations

from collections.abc import Iterator

from machines.composed_program import Watched
from machines.signal_names import leaves
from machines.wiring import Wiring
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import Member, Name, Place
from programs.properties.property_file import Questions, parsed

EXPRESSIONS = ("never", "always", "after", "holds", "only_if", "only_once")


def observers_lacking(wiring: Wiring, watched: Watched) -> dict[str, str]:
    """By observer the first name that it reads and the wiring has not. Raises Unjudged: no expression."""
    found: dict[str, str] = {}
    for name, seen in watched.rows.items():
        known = {other for other in watched.rows if other not in found}
        for text in seen.inputs.values():
            for lost in _lost(wiring, text, watched, known, watched.place(name)):
                found.setdefault(name, found.get(lost.partition(".")[0], lost))
    return found


def lacking(wiring: Wiring, watched: Watched, questions: Questions) -> dict[str, str]:
    """By property the first name that it needs and the wiring has not. Raises Unjudged: no expression."""
    lost_observers = observers_lacking(wiring, watched)
    known = {name for name in watched.rows if name not in lost_observers}
    found: dict[str, str] = {}
    for row in questions.rows:
        for key in EXPRESSIONS:
            if isinstance(text := row.get(key), str):
                for lost in _lost(wiring, text, watched, known, questions.place(row)):
                    found.setdefault(row["id"], lost_observers.get(lost.partition(".")[0], lost))
    return found


def _lost(wiring: Wiring, text: str, watched: Watched, known: set[str], place: Place) -> Iterator[str]:
    """The names in an expression that nothing of the cell has; names are the same in either case."""
    table = wiring.table
    plain = {name.upper() for name in (*table.inputs, *table.outputs, *table.block, *wiring.texts, *known)}
    pins = {name: {*wiring.kinds[name].inputs, *wiring.kinds[name].outputs} for name in table.block}
    pins |= {name: {*BLOCKS[of][0], *BLOCKS[of][1]} for name in known if (of := _kind(watched, name))}
    upper = {name.upper(): {pin.upper() for pin in some} for name, some in pins.items()}
    for leaf in leaves(parsed(text, place)):
        match leaf:
            case Name(name, _) if name.upper() not in plain:
                yield name
            case Member(Name(block, _), pin, _) if pin.upper() not in upper.get(block.upper(), set()):
                yield f"{block}.{pin}"


def _kind(watched: Watched, name: str) -> str:
    of = watched.rows[name].of.upper()
    return of if of in BLOCKS else ""

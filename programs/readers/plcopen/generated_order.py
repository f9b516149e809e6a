"""The order in which the generator of Beremiz and OpenPLC carries out a diagram: not that of networks.

It goes by what it writes: elements with a number first; then each variable and coil that is written, and
before it the blocks that it needs, and no others; then the blocks that are left. Elements without a number
come from top to bottom, or (since it runs on Python 3) as they stand in the file. A contact is read anew for
everything behind it. Beremiz, `PLCGenerator.py`, `ComputeProgram` and `GenerateBlock`, seen on 2026-11-26.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cmp_to_key

from programs.readers.plcopen.diagrams import Node

NEAR = 10
"""Two elements whose tops are less than this apart stand beside each other: the left one comes first."""
WRITTEN = ("outVariable", "inOutVariable", "coil")


Sources = Mapping[str, Sequence[Node]]
"""For each element by its id those from which it takes values."""


def generated(running: Sequence[Node], sources: Sources) -> Iterator[list[Node]]:
    """What runs, one after the other, by each rule of that generator: a contact once for each use.

    running: the elements that do something, as they stand in the file.
    """
    yield _Generated(sources).all(sorted(running, key=cmp_to_key(_by_place)))
    yield _Generated(sources).all(running)


def read_anew(found: Iterable[Node], sources: Sources) -> list[Node]:
    """The elements as they are found, but each contact is read for everything behind it."""
    again = _Generated(sources)
    for node in found:
        if node.kind != "contact":
            again.events += [*again.contacts(node), node]
    return again.events


def differs(
    found: Sequence[Node], events: Sequence[Node], uses: Mapping[str, Sequence[tuple[str, bool]]]
) -> tuple[str, Node, Node] | None:
    """The first two elements that touch one thing in another order, with its name; None: there are none.

    uses: for each thing, the elements that touch it, and whether they change it.
    """
    number = {node.id: n for n, node in enumerate(found)}
    moments: dict[str, list[int]] = defaultdict(list)
    for n, node in enumerate(events):
        moments[node.id].append(n)
    for name, touching in uses.items():
        for one, changes in touching:
            for other, also in touching:
                if not (changes or also) or number[one] >= number[other]:
                    continue
                if moments[one] and moments[other] and max(moments[one]) > min(moments[other]):
                    return name, found[number[one]], found[number[other]]
    return None


def _by_place(one: Node, other: Node) -> int:
    (y, _, x), (v, _, u) = one.area, other.area
    return x - u if abs(y - v) < NEAR else y - v


class _Generated:
    """One walk over the elements of a body."""

    def __init__(self, sources: Sources) -> None:
        self.sources = sources
        self.events: list[Node] = []
        self.begun: set[str] = set()

    def all(self, others: Sequence[Node]) -> list[Node]:
        """Everything that runs; others: the elements in the order of those without a number."""
        numbered = [node for node in others if node.order and node.kind != "coil"]
        left = [node for node in others if node not in numbered]
        first = sorted(numbered, key=lambda node: node.order or 0)
        for node in (*first, *(node for node in left if node.kind in WRITTEN)):
            if node.kind == "block":
                self.block(node, asked_in_order=False)
            else:
                self.needed(node, asked_in_order=False)
                self.events += [*self.contacts(node), node]
        for node in left:
            if node.kind == "block":
                self.block(node, asked_in_order=False)
        return self.events

    def block(self, node: Node, asked_in_order: bool) -> None:
        """A block, once; one that a numbered block asks for is not carried out for it."""
        if node.id in self.begun or asked_in_order:
            return
        self.begun.add(node.id)
        self.needed(node, asked_in_order=bool(node.order))
        self.events += [*self.contacts(node), node]

    def needed(self, node: Node, asked_in_order: bool) -> None:
        """The blocks from which an element takes values, through contacts and coils."""
        for source in self.sources[node.id]:
            if source.kind == "block":
                self.block(source, asked_in_order)
            elif source.kind in ("contact", "coil"):
                if source.kind == "contact":
                    self.events.append(source)
                self.needed(source, asked_in_order)

    def contacts(self, node: Node) -> Iterator[Node]:
        """The contacts that are read when an element runs."""
        for source in self.sources[node.id]:
            if source.kind in ("contact", "coil"):
                yield from self.contacts(source)
            if source.kind == "contact":
                yield source

"""In which order the elements of a function block diagram or a ladder run.

What is drawn does not always say what is carried out first. An order that is written (executionOrderId) is
taken; without one, elements follow the flow of data, and networks that lie below each other run from top to
bottom. Where that leaves open who reads or writes a variable first, the body is refused; so it is where
`generated_order` has it the other way round, unless titles of networks (CODESYS) say what comes first.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from modeproof.ground.errors import suggestion
from programs.language.tree import Binary, Bit, Expression, Function, Index, Member, Name, Unary
from programs.readers.plcopen.diagrams import Node, Pin
from programs.readers.plcopen.generated_order import differs, generated, read_anew


def roots(expression: Expression | None) -> Iterator[str]:
    """The variables and instances that an expression reads, in upper case."""
    match expression:
        case Name(name, _):
            yield name.upper()
        case Member(of, _, _) | Bit(of, _, _):
            yield from roots(of)
        case Index(of, index, _):
            yield from roots(of)
            yield from roots(index)
        case Unary(_, operand, _):
            yield from roots(operand)
        case Binary(_, left, right, _):
            yield from roots(left)
            yield from roots(right)
        case Function(_, arguments, _):
            for _, argument in arguments:
                yield from roots(argument)


def written_root(target: Expression | None) -> str:
    """The variable or instance that an assignment to the target changes."""
    while isinstance(target, Member | Index | Bit):
        target = target.of
    return target.name.upper() if isinstance(target, Name) else ""


@dataclass
class Order:
    """The elements of a body in the order in which they run."""

    nodes: Mapping[str, Node]
    beyond: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """For each block by its name in upper case: the globals that it, or one below it, may use."""
    after: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    """For each element those that must have run before it."""

    @cached_property
    def connectors(self) -> dict[str, Node]:
        """The connectors by their names."""
        found: dict[str, Node] = {}
        for node in self.nodes.values():
            if node.kind == "connector":
                if node.label in found:
                    raise node.place.refuse(f"there are two connectors {node.label}")
                found[node.label] = node
        return found

    def source(self, pin: Pin, target: str, seen: tuple[str, ...] = ()) -> Node:
        """The element at the other end of a connection, behind connectors."""
        node = self.nodes.get(target)
        if node is None:
            raise pin.place.refuse(f"connection to {target}: there is no such element")
        if node.kind != "continuation":
            if node.kind in ("outVariable", "connector", "rightPowerRail"):
                raise pin.place.refuse(f"connection to {node.what()}, which has no output")
            return node
        if node.id in seen or node.label not in self.connectors:
            cause = "leads back to itself" if node.id in seen else suggestion(node.label, self.connectors)
            raise node.place.refuse(f"continuation {node.label}: {cause}")
        (end,) = self.connectors[node.label].pins
        if len(end.sources) != 1:
            raise end.place.refuse(f"connector {node.label} needs one connection")
        return self.source(end, end.sources[0][0], (*seen, node.id))

    def end(self, pin: Pin, source: tuple[str, str]) -> tuple[Node, str]:
        """The element that gives the value, and the name of its output."""
        while self.nodes.get(source[0]) and self.nodes[source[0]].kind == "continuation":
            self.source(pin, source[0])
            source = self.connectors[self.nodes[source[0]].label].pins[0].sources[0]
        return self.source(pin, source[0]), source[1]

    def sources(self, node: Node) -> Iterator[tuple[Pin, Node]]:
        """The elements from which a node takes values."""
        for pin in node.pins:
            for target, _ in pin.sources:
                yield pin, self.source(pin, target)

    def reads(self, node: Node) -> set[str]:
        """The variables and instances that a node reads when it runs."""
        found = set(roots(node.variable)) if node.kind == "contact" else set()
        for pin in node.pins:
            found |= set(roots(pin.expression))
        for _, source in self.sources(node):
            if source.kind in ("inVariable", "inOutVariable"):
                found |= set(roots(source.variable))
            found |= set(roots(source.instance))
        return found

    def writes(self, node: Node) -> set[str]:
        """The variables and instances that it changes."""
        targets = [node.instance, *(target for out in node.outs for target in out.targets)]
        if node.kind in ("outVariable", "inOutVariable", "coil"):
            targets.append(node.variable)
        shared = self.beyond.get(node.block.upper(), frozenset())
        return {written_root(target) for target in targets} - {""} | shared

    @cached_property
    def numbers(self) -> dict[str, int]:
        """The written order; 0 alone, or more than once, is no number."""
        given = {node.id: node.order for node in self.running if node.order is not None}
        zeros = [key for key, value in given.items() if value == 0]
        if len(zeros) > 1 or sorted(given.values()) != list(range(len(self.running))):
            given = {key: value for key, value in given.items() if value}
        places: dict[int, str] = {}
        for key, value in given.items():
            if value in places:
                raise self.nodes[key].place.refuse(f"executionOrderId {value} is there twice")
            places[value] = key
        return given

    @cached_property
    def running(self) -> list[Node]:
        """The elements that do something."""
        return [node for node in self.nodes.values() if node.runs]

    def feeds_back(self, source: Node, node: Node) -> bool:
        """Whether the written order lets a node take the value of the scan before."""
        numbers = self.numbers
        if source.id not in numbers or node.id not in numbers:
            return False
        return numbers[source.id] >= numbers[node.id]

    @cached_property
    def sequence(self) -> list[Node]:
        """The elements in their order. Raises Unjudged: it is not clear."""
        for node in self.running:
            for _, source in self.sources(node):
                if source.runs and not self.feeds_back(source, node):
                    self.after[node.id].add(source.id)
        ordered = sorted(self.numbers, key=self.numbers.__getitem__)
        for first, second in itertools.pairwise(ordered):
            self.after[second].add(first)
        if not self.numbers:
            self._by_networks()
        found = self._sorted()
        self._clear(found)
        self._same_elsewhere(found)
        return found

    def _by_networks(self) -> None:
        groups = self._networks()
        borders = [
            (min(node.area[0] for node in group), max(node.area[1] for node in group)) for group in groups
        ]
        for n, group in enumerate(groups):
            for m, other in enumerate(groups):
                numbers = group[0].network, other[0].network
                above = borders[n][1] <= borders[m][0] and borders[n][0] < borders[m][0]
                if numbers[0] < numbers[1] or (numbers[0] == numbers[1] and above):
                    for node in other:
                        if node.runs:
                            self.after[node.id] |= {first.id for first in group if first.runs}

    def _networks(self) -> list[list[Node]]:
        """The groups of elements that are connected otherwise than by a power rail."""
        joined = {node.id: node.id for node in self.nodes.values()}

        def top(key: str) -> str:
            while joined[key] != key:
                joined[key] = joined[joined[key]]
                key = joined[key]
            return key

        for node in self.nodes.values():
            if node.kind != "rightPowerRail":
                for _, source in self.sources(node):
                    if source.kind != "leftPowerRail":
                        joined[top(node.id)] = top(source.id)
        groups: dict[str, list[Node]] = defaultdict(list)
        for node in self.nodes.values():
            if node.kind not in ("leftPowerRail", "rightPowerRail"):
                groups[top(node.id)].append(node)
        return list(groups.values())

    def _sorted(self) -> list[Node]:
        waiting = sorted(self.running, key=lambda node: (node.network, node.area[0], node.area[2]))
        done: set[str] = set()
        found: list[Node] = []
        while waiting:
            ready = next((node for node in waiting if self.after[node.id] <= done), None)
            if ready is None:
                raise waiting[0].place.refuse(
                    f"{waiting[0].what()} is in a loop (or behind one): with executionOrderId at each element"
                    " it is clear where the value of the scan before is taken"
                )
            waiting.remove(ready)
            done.add(ready.id)
            found.append(ready)
        return found

    def _clear(self, found: Sequence[Node]) -> None:
        """Refuse a body where it is open who reads or writes a variable first."""
        number = {node.id: n for n, node in enumerate(found)}
        before = [0] * len(found)
        for n, node in enumerate(found):
            for key in self.after[node.id]:
                before[n] |= before[number[key]] | 1 << number[key]
        for name, places in self._uses(found).items():
            for second, (key, writes) in enumerate(places):
                for other, also in places[:second]:
                    n, m = number[key], number[other]
                    if (writes or also) and not before[n] >> m & 1:
                        raise found[n].place.refuse(
                            f"{name}: {found[m].what()} (line {found[m].place.line}) and {found[n].what()}"
                            " use it, and nothing says which comes first; give both an executionOrderId"
                        )

    def _uses(self, found: Sequence[Node]) -> dict[str, list[tuple[str, bool]]]:
        """For each variable and instance the elements that use it, in order, and whether they change it."""
        touched: dict[str, list[tuple[str, bool]]] = defaultdict(list)
        for node in found:
            written = self.writes(node)
            for name in written | self.reads(node):
                touched[name].append((node.id, name in written))
        return touched

    def _same_elsewhere(self, found: Sequence[Node]) -> None:
        """Refuse a body that tools carry out in another order, where that makes a difference."""
        uses = self._uses(found)
        for node in found:
            for _, source in self.sources(node):
                if source.kind == "block":
                    uses.setdefault(f"the output of {source.what()}", []).append((node.id, False))
        for node in found:
            if (key := f"the output of {node.what()}") in uses:
                uses[key].append((node.id, True))
        sources = {node.id: [source for _, source in self.sources(node)] for node in found}
        again = read_anew(found, sources)
        ways = [again] if any(node.network for node in found) else [again, *generated(self.running, sources)]
        for events in ways:
            if (pair := differs(found, events, uses)) is not None:
                name, one, other = pair
                first = f"{name}: {one.what()} (line {one.place.line})"
                raise other.place.refuse(
                    f"{first} feeds several elements, and tools read it once, or again for each of them;"
                    " put a variable between"
                    if events is again
                    else f"{first} comes before {other.what()} here, and the generator of Beremiz and OpenPLC"
                    " takes them the other way round; write this in Structured Text, or number all from 1 on"
                )

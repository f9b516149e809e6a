"""Layered placement of boxes that are linked: downwards as far as possible, without overlaps.

A chain is a link from one box to another, with a label box between them where it has one. Chains that would
close a cycle, seen from the first box, run upwards. Layers, the order in a layer and the places come from
grandalf (Sugiyama, Brandes and Köpf); here is what it is given, and how lines are led between the layers.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import networkx
from grandalf.graphs import Edge, Graph, Vertex
from grandalf.layouts import SugiyamaLayout

ACROSS, DOWN, MARGIN = 18.0, 36.0, 10.0
"""Pixels between two boxes of a layer, between two layers, and around the whole."""
ROUNDS = 6
_PAIR = re.compile(r"(-?[\d.]+) (-?[\d.]+)")
PORT = 14.0
"""Pixels between two lines at the side of a box, where there is room."""


@dataclass(frozen=True)
class Size:
    """Width and height of a box in pixels."""

    width: float
    height: float


@dataclass(frozen=True)
class Chain:
    """A link of two boxes, by way of its label box if it has one."""

    source: str
    target: str
    label: str = ""

    @property
    def boxes(self) -> tuple[str, ...]:
        """The boxes that it touches, in its direction."""
        return (self.source, self.label, self.target) if self.label else (self.source, self.target)


@dataclass(frozen=True)
class Point:
    """A place in pixels from the upper left corner."""

    x: float
    y: float


@dataclass(frozen=True)
class Placed:
    """The middle of each box, and for each chain the lines (SVG path data) between its boxes."""

    width: float
    height: float
    middle: Mapping[str, Point]
    lines: tuple[tuple[str, ...], ...]


@dataclass
class _View:
    """What grandalf reads and writes."""

    w: float
    h: float
    xy: tuple[float, float] = (0.0, 0.0)


@dataclass
class _Column:
    """One connected piece: its boxes, the lines through its layers, and the layers from top to bottom."""

    views: dict[str, _View]
    passes: dict[tuple[str, str], list[_View]]
    layers: list[tuple[float, float]]
    of: dict[int, int] = field(default_factory=dict)


def narrowest(sizes: Mapping[str, Size], chains: Sequence[Chain]) -> Placed:
    """As `place`, downwards or to the right: whichever is narrower."""
    return min((place(sizes, chains), place(sizes, chains, aside=True)), key=lambda placed: placed.width)


def place(sizes: Mapping[str, Size], chains: Sequence[Chain], *, aside: bool = False) -> Placed:
    """Place boxes and lines. The order of `sizes` and `chains` decides where several places are as good.

    With `aside` the layers follow each other to the right instead of downwards. Every chain must name boxes
    of `sizes`; a chain from a box to itself is refused (ValueError).
    """
    if aside:
        turned = {name: Size(size.height, size.width) for name, size in sizes.items()}
        found = place(turned, chains)
        return Placed(
            found.height,
            found.width,
            {name: Point(at.y, at.x) for name, at in found.middle.items()},
            tuple(tuple(_turned(path) for path in paths) for paths in found.lines),
        )
    for chain in chains:
        if chain.source == chain.target or set(chain.boxes) - set(sizes):
            raise ValueError(f"a chain from {chain.source!r} to {chain.target!r} cannot be placed")
    upwards = _upwards(sizes, chains)
    links: dict[tuple[str, str], None] = {}
    for chain in chains:
        boxes = chain.boxes[::-1] if chain in upwards else chain.boxes
        links.update(dict.fromkeys(pairwise(boxes)))
    middle: dict[str, Point] = {}
    drawn: dict[tuple[str, str], str] = {}
    left, height = MARGIN, 0.0
    for names in _pieces(sizes, links):
        column = _layout(names, sizes, [one for one in links if one[0] in names])
        views = [*column.views.values(), *(view for views in column.passes.values() for view in views)]
        shift = left - min(view.xy[0] - view.w / 2 for view in views)
        for view in views:
            view.xy = (view.xy[0] + shift, view.xy[1])
        left = max(view.xy[0] + view.w / 2 for view in views) + 2 * ACROSS
        height = max(height, column.layers[-1][1])
        middle |= {name: Point(*view.xy) for name, view in column.views.items()}
        drawn |= _lines(column)
    lines = tuple(
        tuple(
            drawn[link] if link in drawn else _reversed(drawn[link[1], link[0]])
            for link in pairwise(chain.boxes)
        )
        for chain in chains
    )
    return Placed(left - 2 * ACROSS + MARGIN, height + MARGIN, middle, lines)


def _upwards(sizes: Mapping[str, Size], chains: Sequence[Chain]) -> set[Chain]:
    """The chains that lead back to a box on the way from the first box (depth first)."""
    after: dict[str, list[Chain]] = {name: [] for name in sizes}
    for one in chains:
        after[one.source].append(one)
    found: set[Chain] = set()
    done: set[str] = set()
    for root in sizes:
        if root in done:
            continue
        way, stack = {root}, [(root, iter(after[root]))]
        while stack:
            here, rest = stack[-1]
            chain = next(rest, None)
            if chain is None:
                stack.pop()
                way.discard(here)
                done.add(here)
            elif chain.target in way:
                found.add(chain)
            elif chain.target not in done:
                way.add(chain.target)
                stack.append((chain.target, iter(after[chain.target])))
    return found


def _pieces(sizes: Mapping[str, Size], links: Mapping[tuple[str, str], None]) -> list[list[str]]:
    """The connected pieces, each in the order of the boxes."""
    graph: networkx.Graph[str] = networkx.Graph()
    graph.add_nodes_from(sizes)
    graph.add_edges_from(links)
    return [[name for name in sizes if name in piece] for piece in networkx.connected_components(graph)]


def _layout(names: Sequence[str], sizes: Mapping[str, Size], links: Sequence[tuple[str, str]]) -> _Column:
    vertices = {name: Vertex(name) for name in names}
    for name, vertex in vertices.items():
        vertex.view = _View(sizes[name].width, sizes[name].height)
    edges = {link: Edge(vertices[link[0]], vertices[link[1]]) for link in links}
    piece = Graph(list(vertices.values()), list(edges.values())).C[0]
    sugiyama = SugiyamaLayout(piece)
    sugiyama.xspace, sugiyama.yspace, sugiyama.dw, sugiyama.dh = ACROSS, DOWN, 4.0, 4.0
    roots = [vertices[name] for name in names if not vertices[name].e_in()]
    sugiyama.init_all(roots=roots, inverted_edges=[], optimize=True)
    sugiyama.draw(ROUNDS)
    ends = []
    top = MARGIN
    for layer in sugiyama.layers:
        bottom = top + max(vertex.view.h for vertex in layer)
        right = float("-inf")
        for vertex in layer:
            middle, half = vertex.view.xy[0], vertex.view.w / 2
            if middle - half < right:  # grandalf's mean of four places can bring two boxes together
                middle = right + ACROSS + half
            vertex.view.xy = (middle, (top + bottom) / 2)
            right = middle + half
        ends.append((top, bottom))
        top = bottom + DOWN
    views = {name: vertex.view for name, vertex in vertices.items()}
    passes: dict[tuple[str, str], list[Any]] = {}
    for link, edge in edges.items():
        ranks = sugiyama.ctrls.get(edge, {})
        passes[link] = [ranks[rank].view for rank in sorted(ranks) if ranks[rank] not in vertices.values()]
    column = _Column(views, passes, ends)
    for rank, layer in enumerate(sugiyama.layers):
        column.of |= {id(vertex.view): rank for vertex in layer}
    return column


def _lines(column: _Column) -> dict[tuple[str, str], str]:
    """Path data for each link: straight through a layer, curved between two."""
    ports = _ports(column)
    drawn = {}
    for link, passes in column.passes.items():
        views = [column.views[link[0]], *passes, column.views[link[1]]]
        xs = [ports[link, "out"], *(view.xy[0] for view in passes), ports[link, "in"]]
        first, last = views[0], views[-1]
        points: list[Point] = [Point(xs[0], first.xy[1] + first.h / 2)]
        for n, view in enumerate(views):
            top, bottom = column.layers[column.of[id(view)]]
            if n > 0:
                points.append(Point(xs[n], top))
            if n < len(views) - 1:
                points.append(Point(xs[n], bottom))
        points.append(Point(xs[-1], last.xy[1] - last.h / 2))
        drawn[link] = _path(points)
    return drawn


def _path(points: Sequence[Point]) -> str:
    """Through the points: straight where it goes straight down, else a curve that begins and ends so."""
    text = f"M{_n(points[0].x)} {_n(points[0].y)}"
    for before, after in pairwise(points):
        if abs(before.x - after.x) < 0.05 and abs(before.y - after.y) < 0.05:
            continue
        if abs(before.x - after.x) < 0.05:
            text += f"L{_n(after.x)} {_n(after.y)}"
        else:
            half = (before.y + after.y) / 2
            text += f"C{_n(before.x)} {_n(half)} {_n(after.x)} {_n(half)} {_n(after.x)} {_n(after.y)}"
    return text


def _turned(path: str) -> str:
    """The same line with x and y exchanged."""
    return _PAIR.sub(r"\2 \1", path)


def _reversed(path: str) -> str:
    """The same line the other way round."""
    pieces = path[1:].replace("L", "|L").replace("C", "|C").split("|")
    here = pieces[0]
    back: list[tuple[str, str, list[str]]] = []
    for piece in pieces[1:]:
        numbers = piece[1:].split(" ")
        back.append((piece[0], here, numbers[:-2]))
        here = " ".join(numbers[-2:])
    text = f"M{here}"
    for kind, end, turns in reversed(back):
        text += f"{kind}{' '.join([*turns[2:], *turns[:2], end])}"
    return text


def _ports(column: _Column) -> dict[tuple[tuple[str, str], str], float]:
    """Where each link leaves and enters: along the side, in the order of the places that it goes to."""
    sides: dict[tuple[str, str], list[tuple[float, int, tuple[str, str]]]] = {}
    for n, (link, passes) in enumerate(column.passes.items()):
        ends = [column.views[link[0]], *passes, column.views[link[1]]]
        sides.setdefault((link[0], "out"), []).append((ends[1].xy[0], n, link))
        sides.setdefault((link[1], "in"), []).append((ends[-2].xy[0], n, link))
    ports = {}
    for (name, side), entries in sides.items():
        view = column.views[name]
        step = min(PORT, (view.w - PORT) / len(entries))
        begin = view.xy[0] - step * (len(entries) - 1) / 2
        for n, (_, _, link) in enumerate(sorted(entries)):
            ports[link, side] = begin + n * step
    return ports


def _n(value: float) -> str:
    """A number with one digit after the point, and none where it is 0."""
    return f"{value:.1f}".removesuffix(".0")

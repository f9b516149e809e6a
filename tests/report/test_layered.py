"""Boxes never overlap, no line runs through one, and the same graph is always placed alike."""

from __future__ import annotations

import re
from itertools import combinations, pairwise

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from modeproof.report.drawing.layered import Chain, Placed, Point, Size, narrowest, place

Graph = tuple[dict[str, Size], list[Chain]]


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    """Up to eight boxes with up to twelve labelled links, cycles and separate pieces among them."""
    names = [f"b{n}" for n in range(draw(st.integers(1, 8)))]
    side = st.integers(10, 200)
    sizes = {name: Size(draw(side), draw(side)) for name in names}
    pairs = [(a, b) for a in names for b in names if a != b]
    chosen = draw(st.lists(st.sampled_from(pairs), max_size=12, unique=True)) if pairs else []
    chains = []
    for n, (a, b) in enumerate(chosen):
        sizes[f"l{n}"] = Size(draw(side), draw(side))
        chains.append(Chain(a, b, f"l{n}"))
    return sizes, chains


def points(path: str) -> list[Point]:
    """The points that a path goes through, without those that bend it."""
    found = []
    for numbers in re.findall(r"[MLC]([-\d. ]+)", path):
        values = [float(one) for one in numbers.split()]
        found.append(Point(values[-2], values[-1]))
    return found


def overlap(placed: Placed, sizes: dict[str, Size], one: str, other: str) -> bool:
    a, b, s, t = placed.middle[one], placed.middle[other], sizes[one], sizes[other]
    return abs(a.x - b.x) < (s.width + t.width) / 2 and abs(a.y - b.y) < (s.height + t.height) / 2


CROWDED = (
    {f"b{n}": Size(10, 10 if n else 145) for n in range(8)} | {f"l{n}": Size(10, 10) for n in range(11)},
    [
        Chain(f"b{source}", f"b{target}", f"l{n}")
        for n, (source, target) in enumerate(
            [(1, 3), (1, 0), (5, 4), (7, 0), (7, 1), (0, 1), (7, 2), (4, 1), (0, 6), (3, 4), (6, 0)]
        )
    ],
)
"""Two of its boxes were placed over one another."""


@pytest.mark.parametrize("aside", [False, True])
@settings(max_examples=60, deadline=None)
@given(graph=graphs())
@example(graph=CROWDED)
def test_boxes_stand_apart_within_the_picture(aside: bool, graph: Graph) -> None:
    sizes, chains = graph
    placed = place(sizes, chains, aside=aside)
    assert set(placed.middle) == set(sizes)
    for one, other in combinations(sizes, 2):
        assert not overlap(placed, sizes, one, other)
    for name, at in placed.middle.items():
        assert sizes[name].width / 2 <= at.x <= placed.width - sizes[name].width / 2
        assert sizes[name].height / 2 <= at.y <= placed.height - sizes[name].height / 2


@settings(max_examples=60, deadline=None)
@given(graph=graphs())
def test_each_line_meets_its_own_boxes_and_passes_all_others(graph: Graph) -> None:
    sizes, chains = graph
    placed = place(sizes, chains)
    for chain, paths in zip(chains, placed.lines, strict=True):
        for (source, target), path in zip(pairwise(chain.boxes), paths, strict=True):
            way = points(path)
            for name, end in ((source, way[0]), (target, way[-1])):
                at, size = placed.middle[name], sizes[name]
                assert abs(end.x - at.x) <= size.width / 2
                assert abs(abs(end.y - at.y) - size.height / 2) < 0.1
            for name, at in placed.middle.items():
                for one in way[1:-1]:
                    inside = abs(one.x - at.x) < sizes[name].width / 2 - 0.1
                    assert not (inside and abs(one.y - at.y) < sizes[name].height / 2 - 0.1), name


def test_a_back_link_runs_upwards_and_points_where_it_leads() -> None:
    sizes = {name: Size(20, 10) for name in ("first", "second", "there", "back")}
    placed = place(sizes, [Chain("first", "second", "there"), Chain("second", "first", "back")])
    assert placed.middle["first"].y < placed.middle["there"].y < placed.middle["second"].y
    assert placed.middle["there"].y == placed.middle["back"].y
    end = points(placed.lines[1][-1])[-1]
    assert end.y == pytest.approx(placed.middle["first"].y + 5, abs=0.1)


def test_the_same_graph_is_placed_alike() -> None:
    sizes = {f"b{n}": Size(20 + n, 10) for n in range(9)}
    chains = [Chain(f"b{a}", f"b{b}") for a in range(9) for b in range(9) if (a * 5 + b) % 7 == 1 and a != b]
    assert place(sizes, chains) == place(dict(sizes), list(chains))


def test_a_wide_fan_is_turned_aside() -> None:
    sizes = {"root": Size(50, 20)} | {f"leaf{n}": Size(150, 20) for n in range(9)}
    chains = [Chain("root", f"leaf{n}") for n in range(9)]
    assert place(sizes, chains).width > 9 * 150 > narrowest(sizes, chains).width


@pytest.mark.parametrize("chain", [Chain("a", "a"), Chain("a", "nowhere"), Chain("a", "b", "nowhere")])
def test_a_link_that_cannot_be_placed_is_refused(chain: Chain) -> None:
    with pytest.raises(ValueError, match="cannot be placed"):
        place({"a": Size(1, 1), "b": Size(1, 1)}, [chain])

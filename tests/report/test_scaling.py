"""The chart of growth: the law is the one that the points follow, and what was not measured is said."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.report.scaling import Curve, Measured, best_law, chart, page


def record(distinct: int, as_expected: bool = True) -> dict[str, Any]:
    return {
        "as_expected": as_expected,
        "reason": "" if as_expected else "time limit of 180 s reached",
        "machine": {"cpu": "a processor", "arch": "x", "cores": 2},
        "tools": {"java": {"version": "a Java"}},
        "result": {
            **{"distinct": distinct, "generated": 9 * distinct, "depth": 7},
            **{"cpu_seconds": distinct / 1000, "limit_s": 180.0},
        },
    }


CURVES = (
    Curve(
        "levels",
        "MC_x",
        "levels",
        "0 faults",
        (
            *(Measured(x, record(1000 * 3**x)) for x in (1, 2, 3)),
            Measured(4, record(0, as_expected=False)),
            Measured(5, None),
        ),
    ),
    Curve("few", "MC_x", "levels", "2 < 3 faults", tuple(Measured(x, record(10**x)) for x in (1, 2))),
    Curve("swaps", "MC_y", "swaps", "swaps", tuple(Measured(x, record(100 + 50 * x)) for x in (0, 1, 2))),
)


@given(st.floats(1, 1e6), st.floats(1.2, 20))
def test_an_exponential_law_is_found(a: float, b: float) -> None:
    law = best_law([(x, a * b**x) for x in range(1, 7)])
    assert law is not None and law.kind == "exponential"
    assert law.a == pytest.approx(a, rel=1e-3) and law.b == pytest.approx(b, rel=1e-3)
    assert law.r_squared == pytest.approx(1.0)


@given(st.floats(1, 1e6), st.floats(1.5, 9))
def test_a_power_law_is_found(a: float, b: float) -> None:
    law = best_law([(x, a * x**b) for x in range(1, 7)])
    assert law is not None and law.kind == "power" and law.b == pytest.approx(b, rel=1e-3)


@given(st.integers(50, 5000), st.integers(50, 5000))
def test_a_straight_line_is_found(a: int, b: int) -> None:
    law = best_law([(x, a + b * x) for x in range(0, 6)])
    assert law is not None and law.kind == "line"
    assert (law.a, law.b) == (pytest.approx(a, rel=1e-6), pytest.approx(b, rel=1e-6))


def test_points_that_follow_no_law_say_so_by_their_r_squared() -> None:
    law = best_law([(1, 10.0), (2, 1000.0), (3, 20.0), (4, 900.0)])
    assert law is not None and law.r_squared < 0.9


def test_two_points_have_no_law() -> None:
    assert best_law([(1, 10.0), (2, 100.0)]) is None


def test_the_page_has_every_point_and_says_which_were_left_out() -> None:
    text = page(CURVES, "scale", "chart.svg")
    assert "| 3 | 27,000 | 243,000 | 7 | 27.0 | |" in text
    assert "| 4 | | | | | left out: time limit of 180 s reached |" in text
    assert "| 5 | | | | | not measured |" in text
    assert "| 0 faults | levels | 1,000 · 3^x (R² = 1.0000) | 1 · 3^x (R² = 1.0000) |" in text
    assert "fewer than 3 points" in text and "100 + 50 · x" in text
    assert "Measured on: a processor, 2 cores, a Java." in text


def test_the_chart_has_a_dot_for_every_point_inside_its_panel() -> None:
    root = ElementTree.fromstring(chart(CURVES))
    width, height = float(root.attrib["width"]), float(root.attrib["height"])
    panels = root.findall("{*}g")
    assert len(panels) == 4
    for panel in panels:
        x, y = map(float, re.findall(r"-?[\d.]+", panel.attrib["transform"]))
        dots = panel.findall("{*}circle")
        assert len(dots) in (3 + 2, 3)
        for dot in dots:
            assert 0 < x + float(dot.attrib["cx"]) < width and 0 < y + float(dot.attrib["cy"]) < height
    rising = [float(dot.attrib["cy"]) for dot in panels[0].findall("{*}circle")][:3]
    assert rising == sorted(rising, reverse=True), "more states stand higher"


def test_nothing_measured_is_drawn_as_nothing() -> None:
    empty = (Curve("a", "MC_x", "levels", "t", (Measured(1, None), Measured(2, None))),)
    assert chart(empty).count("not measured") == 2 and "Nothing was measured." in page(
        empty, "scale", "c.svg"
    )

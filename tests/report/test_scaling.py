"""The chart of growth: the law is the one that the points follow, and what was not measured is said."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.errors import Unjudged
from modeproof.report.scaling import Curve, best_law, chart, curves_of, page

ROOT = Path(__file__).resolve().parents[2]


def curve(x: str, title: str, places: tuple[int, ...], points: list[tuple[int, float]]) -> Curve:
    return Curve(
        "MC_x", x, title, places, {"distinct": tuple(points), "cpu_s": tuple((n, y / 1e3) for n, y in points)}
    )


CURVES = (
    curve("levels", "0 faults", (1, 2, 3, 4, 5), [(x, 1000 * 3**x) for x in (1, 2, 3)]),
    curve("levels", "2 < 3 faults", (1, 2), [(x, 10**x) for x in (1, 2)]),
    curve("swaps", "swaps", (0, 1, 2), [(x, 100 + 50 * x) for x in (0, 1, 2)]),
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


def test_the_page_states_the_law_of_each_curve() -> None:
    text = page(CURVES, "box")
    assert "| 0 faults (`MC_x`) | levels | 1,000 · 3^x (R² = 1.0000) | 1 · 3^x (R² = 1.0000) |" in text
    assert "fewer than 3 points" in text and "100 + 50 · x" in text


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
    assert chart((curve("levels", "t", (1, 2), []),)).count("not measured") == 2


def test_the_published_chart_and_page_are_those_of_the_figures() -> None:
    curves = curves_of(ROOT, "mode_selection")
    folder = ROOT / "docs/mode_selection"
    assert (folder / "scaling.svg").read_text(encoding="utf-8") == chart(curves)
    assert (folder / "scaling.md").read_text(encoding="utf-8") == page(curves, "mode_selection")


def test_a_series_without_its_run_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "spec/box/scaling.toml"
    path.parent.mkdir(parents=True)
    path.write_text('[[series]]\nx = "levels"\ntitle = "t"\npoints = []\n')
    with pytest.raises(Unjudged, match="run is missing"):
        curves_of(tmp_path, "box")

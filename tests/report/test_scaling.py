"""The chart of growth: every measured point is drawn, and what was not measured is said."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.report.scaling import Curve, chart, curves_of

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


def test_the_chart_has_every_points_dot_inside_its_panel() -> None:
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


def test_the_published_chart_is_that_of_the_figures() -> None:
    picture = ROOT / "docs/mode_selection-growth.svg"
    assert picture.read_text(encoding="utf-8") == chart(curves_of(ROOT, "mode_selection"))


def test_a_series_without_its_run_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "spec/box/runs.toml"
    path.parent.mkdir(parents=True)
    path.write_text('[[series]]\nx = "levels"\ntitle = "t"\npoints = []\n')
    with pytest.raises(Unjudged, match="run is missing"):
        curves_of(tmp_path, "box")

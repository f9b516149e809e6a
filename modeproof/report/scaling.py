"""The chart of how a model grows, from the series of runs in spec/<document>/runs.toml."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

from modeproof.ground.errors import Unjudged

FIGURES = {"distinct": "distinct states", "cpu_s": "CPU seconds"}
_COLOURS = ("#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad", "#b9770e")
_WIDTH, _HEIGHT = 380, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 12, 34, 44


@dataclass(frozen=True)
class Curve:
    """One series: the run of which `x` is varied, the places on the axis, and the figures measured there."""

    run: str
    x: str
    title: str
    places: tuple[int, ...]
    figures: dict[str, tuple[tuple[int, float], ...]]

    def values(self, name: str) -> tuple[tuple[int, float], ...]:
        """The measured points of one figure; all are greater than 0."""
        return self.figures.get(name, ())


def curves_of(place: Path, document: str) -> list[Curve]:
    """The series of a document, if there are any. Raises Unjudged when one lacks something."""
    source = f"spec/{document}/runs.toml"
    try:
        data = tomllib.loads((place / source).read_text(encoding="utf-8"))
        return [
            Curve(
                series["run"],
                series["x"],
                series["title"],
                tuple(point["x"] for point in series["points"]),
                {
                    name: tuple((point["x"], point[name]) for point in series["points"] if name in point)
                    for name in FIGURES
                },
            )
            for series in data.get("series", ())
        ]
    except (OSError, ValueError) as error:
        raise Unjudged(f"{source}: {error}") from None
    except KeyError as error:
        raise Unjudged(f"{source}: {error.args[0]} is missing") from None


def chart(curves: Sequence[Curve]) -> str:
    """The chart as SVG: a row of two panels for each thing that is varied, both with a logarithmic axis."""
    kinds = list(dict.fromkeys(curve.x for curve in curves))
    width, height = 2 * _WIDTH, len(kinds) * _HEIGHT
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    for row, kind in enumerate(kinds):
        chosen = [curve for curve in curves if curve.x == kind]
        for column, (name, title) in enumerate(FIGURES.items()):
            parts.append(f'<g transform="translate({column * _WIDTH},{row * _HEIGHT})">')
            parts += _panel(chosen, name, title, kind)
            parts.append("</g>")
    return "\n".join([*parts, "</svg>", ""])


def _panel(curves: Sequence[Curve], name: str, title: str, kind: str) -> list[str]:
    values = [pair for curve in curves for pair in curve.values(name)]
    parts = [f'<text x="{_LEFT}" y="16" font-size="13">{escape(title)} against {escape(kind)}</text>']
    if not values:
        return [*parts, f'<text x="{_LEFT}" y="60">not measured</text>']
    places = sorted({x for curve in curves for x in curve.places})
    low = math.floor(min(math.log10(y) for _, y in values))
    high = max(low + 1, math.ceil(max(math.log10(y) for _, y in values)))
    right, bottom = _WIDTH - _RIGHT, _HEIGHT - _BOTTOM

    def across(x: float) -> float:
        return _LEFT + 12 + (x - places[0]) / (places[-1] - places[0]) * (right - _LEFT - 24)

    def up(y: float) -> float:
        return bottom - (math.log10(y) - low) / (high - low) * (bottom - _TOP)

    for power in range(low, high + 1):
        y = up(10.0**power)
        parts.append(f'<line x1="{_LEFT}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="#dddddd"/>')
        parts.append(f'<text x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{_tick(power)}</text>')
    for x in places:
        parts.append(f'<text x="{across(x):.1f}" y="{bottom + 16}" text-anchor="middle">{x}</text>')
    middle = (_LEFT + right) / 2
    parts.append(f'<text x="{middle:.1f}" y="{bottom + 34}" text-anchor="middle">{escape(kind)}</text>')
    for number, curve in enumerate(curves):
        colour = _COLOURS[number % len(_COLOURS)]
        line = " ".join(f"{across(x):.1f},{up(y):.1f}" for x, y in curve.values(name))
        label = curve.title if curve.values(name) else f"{curve.title} (not measured)"
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        parts += [
            f'<circle cx="{across(x):.1f}" cy="{up(y):.1f}" r="3" fill="{colour}"/>'
            for x, y in curve.values(name)
        ]
        y = bottom - 8 - 14 * (len(curves) - 1 - number)
        parts.append(
            f'<text x="{right - 4}" y="{y}" text-anchor="end" fill="{colour}">{escape(label)}</text>'
        )
    return parts


def _tick(power: int) -> str:
    return f"{10**power:,}" if power >= 0 else f"{10.0**power:g}"

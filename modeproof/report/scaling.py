"""The chart of how a model grows, from the figures in spec/<document>/scaling.toml.

    python -m modeproof.report.scaling DOCUMENT

writes docs/<document>/scaling.svg and scaling.md. The law stated is the one of three (exponential, power,
straight line) that fits best: R squared is the share of the variance of log y that it explains.
"""

from __future__ import annotations

import math
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

from modeproof.errors import Unjudged
from modeproof.evidence.files import write_whole
from modeproof.places import root

LEAST = 3
"""With fewer points no law is stated."""
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
    """The series of a document. Raises Unjudged when the file is missing or lacks something."""
    source = f"spec/{document}/scaling.toml"
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
            for series in data["series"]
        ]
    except (OSError, ValueError) as error:
        raise Unjudged(f"{source}: {error}") from None
    except KeyError as error:
        raise Unjudged(f"{source}: {error.args[0]} is missing") from None


@dataclass(frozen=True)
class Law:
    """How y grows with x, and R squared of log y (1: exactly so)."""

    kind: str
    a: float
    b: float
    r_squared: float

    def at(self, x: float) -> float:
        """What the law says of x."""
        if self.kind == "exponential":
            return self.a * math.pow(self.b, x)
        return self.a * math.pow(x, self.b) if self.kind == "power" else self.a + self.b * x

    def __str__(self) -> str:
        a = f"{self.a:,.3g}" if self.a < 999 else f"{self.a:,.0f}"
        words = {
            "exponential": f"{a} · {self.b:.3g}^x",
            "power": f"{a} · x^{self.b:.3g}",
            "line": f"{a} + {self.b:,.0f} · x",
        }[self.kind]
        return f"{words} (R² = {self.r_squared:.4f})"


def best_law(points: Sequence[tuple[int, float]]) -> Law | None:
    """The law that explains most of the variance of log y; None for less than LEAST points or a constant."""
    if len(points) < LEAST or len({y for _, y in points}) == 1:
        return None
    xs = [float(x) for x, _ in points]
    ys = [y for _, y in points]
    logs = [math.log(y) for y in ys]
    found: list[Law] = []
    a, b = _line(xs, logs)
    found.append(_judged("exponential", math.exp(a), math.exp(b), xs, logs))
    if min(xs) > 0:
        a, b = _line([math.log(x) for x in xs], logs)
        found.append(_judged("power", math.exp(a), b, xs, logs))
    a, b = _line(xs, ys)
    if all(a + b * x > 0 for x in xs):
        found.append(_judged("line", a, b, xs, logs))
    return max(found, key=lambda law: law.r_squared)


def _line(xs: Sequence[float], ys: Sequence[float]) -> tuple[float, float]:
    """Intercept and slope of the least squares line."""
    n, mean_x, mean_y = len(xs), sum(xs) / len(xs), sum(ys) / len(ys)
    slope = sum(xs[i] * ys[i] for i in range(n)) - n * mean_x * mean_y
    slope /= sum(x * x for x in xs) - n * mean_x * mean_x
    return mean_y - slope * mean_x, slope


def _judged(kind: str, a: float, b: float, xs: Sequence[float], logs: Sequence[float]) -> Law:
    law = Law(kind, a, b, 0.0)
    mean = sum(logs) / len(logs)
    rest = sum((log - math.log(law.at(x))) ** 2 for x, log in zip(xs, logs, strict=True))
    return Law(kind, a, b, 1.0 - rest / sum((log - mean) ** 2 for log in logs))


def page(curves: Sequence[Curve], document: str) -> str:
    """The law of each curve and the chart, as Markdown."""
    rows = [
        "# How the model grows",
        "",
        f"Made by `python -m modeproof.report.scaling {document}` from the figures in "
        f"[`scaling.toml`](../../spec/{document}/scaling.toml).",
        "",
        "![distinct states and CPU seconds](scaling.svg)",
        "",
        "| series | varies | distinct states | CPU seconds |",
        "|---|---|---|---|",
    ]
    for curve in curves:
        laws = [best_law(curve.values(name)) or f"fewer than {LEAST} points" for name in FIGURES]
        rows.append(f"| {curve.title} (`{curve.run}`) | {curve.x} | {laws[0]} | {laws[1]} |")
    return "\n".join([*rows, "", "The laws describe the points measured and say nothing beyond them.", ""])


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


def main(document: str) -> None:
    """Write chart and page of a document."""
    place = root()
    curves = curves_of(place, document)
    for name, text in (("scaling.svg", chart(curves)), ("scaling.md", page(curves, document))):
        write_whole(place / "docs" / document / name, text.encode())


if __name__ == "__main__":
    main(sys.argv[1])

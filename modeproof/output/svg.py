"""SVG elements as markup: every text and attribute is escaped here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from markupsafe import Markup, escape

CHARACTER = 0.61
"""Width of a character of the monospace font, in its size."""
LEAST = 0.75
"""A picture is made no smaller than this on a screen, so that its text can be read; it scrolls instead."""


@dataclass(frozen=True)
class Line:
    """One line of a box: its text, its class in the style sheet, and its font size in pixels."""

    text: str
    kind: str = ""
    size: float = 11.0

    @property
    def width(self) -> float:
        """Pixels."""
        return len(self.text) * self.size * CHARACTER

    @property
    def height(self) -> float:
        """Pixels, with the space to the next line."""
        return self.size * 1.3


def element(tag: str, *children: str, **attributes: str | float | None) -> Markup:
    """An element. `_` in an attribute's name stands for `-`, a last `_` is dropped; None leaves it out."""
    given = Markup("").join(
        Markup(' {}="{}"').format(name.removesuffix("_").replace("_", "-"), number(value))
        for name, value in attributes.items()
        if value is not None
    )
    inner = Markup("").join(children)  # a child that is no markup is escaped
    return Markup("<{0}{1}>{2}</{0}>").format(Markup(tag), given, inner)


def number(value: str | float) -> str:
    """A number with one digit after the point at most; text as it is."""
    return value if isinstance(value, str) else f"{value:.1f}".removesuffix(".0")


def lines(shown: Sequence[Line], x: float, top: float, anchor: str = "middle") -> Markup:
    """Lines of text below each other; `top` is the upper edge of the first."""
    found, y = [], top
    for line in shown:
        y += line.height
        found.append(
            element(
                "text",
                escape(line.text),
                x=x,
                y=y - line.height * 0.28,
                font_size=line.size,
                text_anchor=None if anchor == "start" else anchor,
                class_=line.kind or None,
            )
        )
    return Markup("").join(found)


def height_of(shown: Iterable[Line]) -> float:
    """Pixels."""
    return sum(line.height for line in shown)


def wrapped(
    words: Iterable[str], width: int, *, kind: str = "", size: float = 11.0, between: str = " "
) -> list[Line]:
    """Words in lines of at most `width` characters where they are no longer themselves."""
    found: list[str] = []
    for word in words:
        if found and len(found[-1]) + len(between) + len(word) <= width:
            found[-1] += between + word
        else:
            found.append(word)
    return [Line(text, kind, size) for text in found]


def picture(width: float, height: float, title: str, *children: str, **attributes: str | None) -> Markup:
    """The whole picture: as wide as it is, or as the page where that is narrower."""
    return element(
        "svg",
        element("title", escape(title)),
        *children,
        viewBox=f"0 0 {number(width)} {number(height)}",
        width=width,
        height=height,
        style=f"min-width:{number(width * LEAST)}px",
        role="group",
        **attributes,
    )


def arrow_head(id: str) -> Markup:
    """The definition of an arrow's head; `id` must be the picture's own."""
    return element(
        "defs",
        element(
            "marker",
            element("path", d="M0 0L8 4L0 8z"),
            id=id,
            viewBox="0 0 8 8",
            refX=7,
            refY=4,
            markerWidth=8,
            markerHeight=8,
            markerUnits="userSpaceOnUse",
            orient="auto",
        ),
    )

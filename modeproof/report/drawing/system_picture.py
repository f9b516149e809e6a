"""The picture of a system: devices as boxes, what runs between them as lines with the names of the signals.

A system of one device is drawn as its block: inputs at the left side, outputs at the right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from modeproof.output.svg import Line, arrow_head, element, height_of, lines, picture, wrapped
from modeproof.report.drawing.layered import Chain, Size, place

PAD = 8.0
NAME, SIGNAL, CLAUSE = 13.0, 11.0, 9.5
"""Font sizes in pixels."""
WIDE = 34
"""Characters in a line."""
ROW, STUB = 30.0, 46.0
"""Pixels: height of a pin of a block, and the length of its line outside."""


@dataclass(frozen=True)
class Wire:
    """A signal as a line shows it: its name and type, and the ids that declare it."""

    name: str
    type: str
    tag: str = ""
    cites: tuple[str, ...] = ()


@dataclass(frozen=True)
class Box:
    """A device, or what is outside of all devices."""

    id: str
    title: str
    outside: bool = False


@dataclass(frozen=True)
class Cable:
    """What runs from one box to another."""

    source: str
    target: str
    wires: tuple[Wire, ...]


def system_picture(boxes: Sequence[Box], cables: Sequence[Cable], *, id: str, title: str) -> Markup:
    """Boxes and cables, downwards. `id` begins the ids within the picture."""
    contents = {box.id: _box(box) for box in boxes}
    labels = {f"label {n}": _label(one) for n, one in enumerate(cables)}
    sizes = {name: _size(shown) for name, shown in {**contents, **labels}.items()}
    chains = [Chain(one.source, one.target, f"label {n}") for n, one in enumerate(cables)]
    placed = place(sizes, chains)
    head = f"{id}-head"

    def corner(name: str) -> tuple[float, float]:
        at, size = placed.middle[name], sizes[name]
        return at.x - size.width / 2, at.y - size.height / 2

    drawn = []
    for n, chain in enumerate(chains):
        x, y = corner(chain.label)
        size = sizes[chain.label]
        drawn.append(
            element(
                "g",
                element("path", d=placed.lines[n][0]),
                element("path", d=placed.lines[n][1], marker_end=f"url(#{head})"),
                element("rect", x=x, y=y, width=size.width, height=size.height, rx=3),
                lines(labels[chain.label], placed.middle[chain.label].x, y + PAD / 2),
                class_="link",
                data_from=chain.source,
                data_to=chain.target,
            )
        )
    for box in boxes:
        x, y = corner(box.id)
        size = sizes[box.id]
        shape = element(
            "rect", x=x, y=y, width=size.width, height=size.height, rx=size.height / 2 if box.outside else 4
        )
        text = lines(contents[box.id], placed.middle[box.id].x, y + PAD / 2)
        drawn.append(element("g", shape, text, class_="outside" if box.outside else "device"))
    return picture(placed.width, placed.height, title, arrow_head(head), *drawn, class_="flow", id=id)


def block_picture(
    box: Box, inputs: Sequence[Wire], outputs: Sequence[Wire], *, id: str, title: str
) -> Markup:
    """One block with its pins: name and type inside, the tag of the document's wiring and the ids outside."""
    inside = [
        max((Line(_named(pin), "", SIGNAL).width for pin in pins), default=0.0) for pins in (inputs, outputs)
    ]
    beside = [max((_beside(pin) for pin in pins), default=0.0) for pins in (inputs, outputs)]
    header = [Line(box.id, "name", NAME), *wrapped(box.title.split(), WIDE + 16, kind="cites", size=CLAUSE)]
    width = max(inside[0] + inside[1] + 6 * PAD, max(line.width for line in header) + 2 * PAD)
    left = beside[0] + STUB + PAD
    top, body = PAD, height_of(header) + 2 * PAD
    height = body + ROW * max(len(inputs), len(outputs)) + PAD
    head = f"{id}-head"
    drawn = [
        element("rect", x=left, y=top, width=width, height=height, rx=4),
        element("path", class_="rule", d=f"M{left:.1f} {top + body:.1f}H{left + width:.1f}"),
        lines(header, left + width / 2, top + PAD),
    ]
    pins = []
    for out, group in enumerate((inputs, outputs)):
        for n, one in enumerate(group):
            y = top + body + ROW * (n + 0.5)
            edge = left + width if out else left
            begin, end = (edge, edge + STUB) if out else (edge - STUB, edge)
            pins.append(
                element(
                    "g",
                    element("path", d=f"M{begin:.1f} {y:.1f}H{end:.1f}", marker_end=f"url(#{head})"),
                    lines(
                        [Line(_named(one), "", SIGNAL)],
                        edge - PAD if out else edge + PAD,
                        y - SIGNAL * 0.7,
                        "end" if out else "start",
                    ),
                    lines(
                        [Line(text, "cites", CLAUSE) for text in (one.tag, " ".join(one.cites)) if text],
                        end + PAD / 2 if out else begin - PAD / 2,
                        y - CLAUSE * (1.3 if one.tag and one.cites else 0.7),
                        "start" if out else "end",
                    ),
                    class_="link",
                )
            )
    whole = left + width + STUB + beside[1] + PAD
    return picture(
        whole,
        height + 2 * PAD,
        title,
        arrow_head(head),
        element("g", *drawn, class_="device"),
        *pins,
        class_="flow",
        id=id,
    )


def _named(wire: Wire) -> str:
    return f"{wire.name}: {wire.type}"


def _beside(wire: Wire) -> float:
    return max(Line(text, "", CLAUSE).width for text in (wire.tag, " ".join(wire.cites)))


def _box(box: Box) -> list[Line]:
    if box.outside:
        return [Line(box.title, "name", NAME)]
    return [Line(box.id, "name", NAME), *wrapped(box.title.split(), WIDE, kind="cites", size=CLAUSE)]


def _label(cable: Cable) -> list[Line]:
    """The signals of one type in a row, then what they cite."""
    by_type: dict[str, list[str]] = {}
    for wire in cable.wires:
        by_type.setdefault(wire.type, []).append(wire.name)
    shown = []
    for kind, names in by_type.items():
        words = [f"{name}," for name in names[:-1]] + [f"{names[-1]}: {kind}" if kind else names[-1]]
        shown += wrapped(words, WIDE, kind="step", size=SIGNAL)
    cites = dict.fromkeys(id for wire in cable.wires for id in wire.cites)
    return [*shown, *wrapped(cites, WIDE + 4, kind="cites", size=CLAUSE)]


def _size(shown: Sequence[Line]) -> Size:
    return Size(max(line.width for line in shown) + 2 * PAD, height_of(shown) + PAD)

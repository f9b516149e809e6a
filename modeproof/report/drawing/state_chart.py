"""The picture of a state chart: boxes for control states, a line for each pair that steps lead along.

A step that stays in its state is listed in the box. A step that leads to one state from many is listed in the
box of that state, with the states that it comes from, for so many lines could not be told apart.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from markupsafe import Markup, escape

from modeproof.output.svg import Line, arrow_head, element, height_of, lines, picture, wrapped
from modeproof.report.drawing.layered import Chain, Point, Size, narrowest

MANY = 3
"""From so many states on the sources of a step are listed, not drawn."""
FEW = 4
"""So many states that a step does not come from are named instead of those that it comes from."""
PAD, CORNER = 6.0, 9.0
STEP, CLAUSE, STATE = 10.5, 9.5, 12.0
"""Font sizes in pixels."""
WIDE_STATE, WIDE_LABEL = 38, 27
"""Characters in a line of a state's box and of a label."""
STAYS, COMES = "↻", "⇥"


@dataclass(frozen=True)
class Step:
    """A step from one control state to another, or to the same."""

    source: str
    name: str
    target: str


@dataclass(frozen=True)
class Box:
    """A control state: the outputs that are on in it, whether it is one of error, initial, ever entered."""

    name: str
    on: tuple[str, ...] = ()
    error: bool = False
    initial: bool = False
    entered: bool = True


@dataclass(frozen=True)
class Entry:
    """Steps that lead to `target` from many states."""

    target: str
    names: tuple[str, ...]
    sources: tuple[str, ...]


def entries(steps: Sequence[Step]) -> tuple[Entry, ...]:
    """The steps that lead to one state from many others, those from the same states together."""
    sources: dict[tuple[str, str], list[str]] = {}
    for step in steps:
        if step.source != step.target:
            sources.setdefault((step.target, step.name), []).append(step.source)
    grouped: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for (target, name), comes in sources.items():
        if len(comes) >= MANY:
            grouped.setdefault((target, tuple(comes)), []).append(name)
    return tuple(Entry(target, tuple(names), comes) for (target, comes), names in grouped.items())


def state_chart(
    boxes: Sequence[Box], steps: Sequence[Step], cites: Mapping[str, Sequence[str]], *, id: str, title: str
) -> Markup:
    """The picture, which begins at the state after power-up.

    `cites` holds the ids that each step cites; `id` begins the ids within the picture.
    """
    listed = entries(steps)
    hidden = {(arrow.target, name) for arrow in listed for name in arrow.names}
    pairs: dict[tuple[str, str], list[str]] = {}
    for step in steps:
        if step.source != step.target and (step.target, step.name) not in hidden:
            pairs.setdefault((step.source, step.target), []).append(step.name)
    drawn = sorted((box for box in boxes if box.entered), key=lambda box: not box.initial)
    contents = {
        arrow.name: _content(arrow, steps, [e for e in listed if e.target == arrow.name], cites, drawn)
        for arrow in drawn
    }
    labels = {f"{n}": _label(names, cites) for n, names in enumerate(pairs.values())}
    sizes = {name: _size([line for part in parts for line in part]) for name, parts in contents.items()}
    sizes |= {f"label {n}": _size(shown) for n, shown in labels.items()}
    chains = [Chain(source, target, f"label {n}") for n, (source, target) in enumerate(pairs)]
    placed = narrowest(sizes, chains)
    head = f"{id}-head"
    moves = [
        _move(chain, labels[f"{n}"], sizes[chain.label], placed.middle[chain.label], placed.lines[n], head)
        for n, chain in enumerate(chains)
    ]
    states = [
        _state(arrow, contents[arrow.name], sizes[arrow.name], placed.middle[arrow.name], listed)
        for arrow in drawn
    ]
    return picture(
        placed.width, placed.height, title, arrow_head(head), *moves, *states, class_="chart", id=id
    )


def _content(
    box: Box,
    steps: Sequence[Step],
    comes: Sequence[Entry],
    cites: Mapping[str, Sequence[str]],
    drawn: Sequence[Box],
) -> list[list[Line]]:
    """The parts of a box from top to bottom: name, outputs, steps that stay, steps that come from many."""
    name = [Line(f"● {box.name}" if box.initial else box.name, "name", STATE)]
    on = wrapped([f"{one}" for one in box.on], WIDE_STATE, kind="on", size=CLAUSE, between=" ")
    stays: list[Line] = []
    for one in steps:
        if one.source == one.target == box.name:
            stays += wrapped([STAYS, one.name], WIDE_STATE, kind="step", size=STEP)
            stays += wrapped(cites.get(one.name, ()), WIDE_STATE, kind="cites", size=CLAUSE)
    parts = [name, on, stays]
    for entry in comes:
        lines_of = []
        for step in entry.names:
            lines_of += wrapped([COMES, step], WIDE_STATE, kind="step", size=STEP)
            lines_of += wrapped(cites.get(step, ()), WIDE_STATE, kind="cites", size=CLAUSE)
        lines_of += wrapped(
            _from(entry, [arrow.name for arrow in drawn]), WIDE_STATE, kind="from", size=CLAUSE
        )
        parts.append(lines_of)
    return parts


def _from(entry: Entry, all_states: Sequence[str]) -> list[str]:
    """The words that say where an entry comes from."""
    others = [state for state in all_states if state != entry.target and state not in entry.sources]
    if not others:
        return ["from", "every", "other", "state"]
    if len(others) < len(entry.sources) and len(others) <= FEW:
        return ["from", "every", "other", "state", "but", *_commas(others)]
    return ["from", *_commas(entry.sources)]


def _commas(names: Sequence[str]) -> list[str]:
    return [f"{name}," for name in names[:-1]] + [names[-1]]


def _label(names: Sequence[str], cites: Mapping[str, Sequence[str]]) -> list[Line]:
    shown: list[Line] = []
    for name in names:
        shown.append(Line(name, "step", STEP))
        shown += wrapped(cites.get(name, ()), WIDE_LABEL, kind="cites", size=CLAUSE)
    return shown


def _size(shown: Sequence[Line]) -> Size:
    return Size(max(line.width for line in shown) + 2 * PAD + CORNER, height_of(shown) + PAD)


def _move(
    chain: Chain, shown: Sequence[Line], size: Size, middle: Point, parts: Sequence[str], head: str
) -> Markup:
    left, top = middle.x - size.width / 2, middle.y - size.height / 2
    return element(
        "g",
        element("path", d=parts[0]),
        element("path", d=parts[1], marker_end=f"url(#{head})"),
        element("rect", x=left, y=top, width=size.width, height=size.height, rx=3),
        lines(shown, middle.x, top + PAD / 2),
        class_="move",
        data_from=chain.source,
        data_to=chain.target,
    )


def _state(
    box: Box, parts: Sequence[Sequence[Line]], size: Size, middle: Point, listed: Sequence[Entry]
) -> Markup:
    left, top = middle.x - size.width / 2, middle.y - size.height / 2
    right, bottom = left + size.width, top + size.height
    if box.error:
        inner, outer = (left + CORNER, right - CORNER), (top + CORNER, bottom - CORNER)
        corners = [
            *((inner[0], top), (inner[1], top), (right, outer[0]), (right, outer[1])),
            *((inner[1], bottom), (inner[0], bottom), (left, outer[1]), (left, outer[0])),
        ]
        shape = element("path", d="M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in corners) + "z")
    else:
        shape = element("rect", x=left, y=top, width=size.width, height=size.height, rx=CORNER)
    shown, y = [], top + PAD / 2
    for n, part in enumerate(parts):
        if n > 0 and part:
            shown.append(element("path", class_="rule", d=f"M{left + 4:.1f} {y:.1f}H{right - 4:.1f}"))
        comes = [arrow for arrow in listed if arrow.target == box.name][n - 3] if n > 2 else None
        text = lines(part, middle.x, y)
        if comes is not None:
            text = element("g", text, class_="entry", data_to=box.name, data_from=" ".join(comes.sources))
        shown.append(text)
        y += height_of(part)
    words = [f"control state {box.name}"]
    words += ["after power-up"] if box.initial else []
    words += ["an error"] if box.error else []
    return element(
        "g",
        shape,
        *shown,
        class_="state error" if box.error else "state",
        data_state=box.name,
        tabindex="0",
        role="button",
        aria_pressed="false",
        aria_label=str(escape(", ".join(words))),
    )

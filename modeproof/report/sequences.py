"""The sequences of the documents as people read them: published cases that walk a document's own diagrams."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Device, Document
from modeproof.registers.stale import RENEW
from modeproof.registers.vector_files import VectorFile, read_vectors, vectors_path, why_stale
from modeproof.report.codes import Codes, codes_of
from modeproof.report.scan_table_cells import NONE
from modeproof.report.sources import Sources
from modeproof.report.story import OUTSIDE, POWER_UP, Lane, Message, Row, Story

SUITE = "sequences"
REGISTER = "sequences.toml"
REMEDY = RENEW
ANSWERED = ">"
"""The id of the lane of all that reads what the device writes."""
AFTER = "after"
_QUOTED = re.compile(r'"([^"]*)"')
_OF_FINDING = "finding:"


@dataclass(frozen=True)
class Sequence:
    """One case: the document's sentence on it, who demands the answer, and what happens scan by scan.

    `finding` is the decision that demands the answer, "" where none of ours does but what `basis` names.
    """

    id: str
    why: str
    basis: str
    finding: str
    clauses: tuple[str, ...]
    parameters: str
    story: Story


@dataclass(frozen=True)
class Published:
    """The sequences of one target in the order of their file; where they cannot be shown, `hole` says why."""

    target: str
    path: str
    guarantees: str = ""
    does_not_show: str = ""
    sequences: tuple[Sequence, ...] = ()
    hole: str = ""


def published(sources: Sources, document: Document) -> list[Published]:
    """Each device of which the room has a file, or should: it is published, and its diagrams are drawn."""
    drawn = _drawn(sources, document)
    found = []
    for device in document.interface.devices.values():
        path = vectors_path(device.id, SUITE)
        packed = sources.content(path)
        if packed is not None or (device.published and device.id in drawn):
            found.append(_published(sources, document, device, path, packed))
    return found


def _drawn(sources: Sources, document: Document) -> set[str]:
    """The devices whose diagrams are written down; where that cannot be read: all."""
    try:
        text = (sources.content(f"spec/{document.name}/{REGISTER}") or b"").decode("utf-8")
        return {str(flow["device"]) for flow in tomllib.loads(text).get("flow", [])}
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, LookupError, TypeError):
        return set(document.interface.devices)


def _published(
    sources: Sources, document: Document, device: Device, path: str, packed: bytes | None
) -> Published:
    if packed is None:
        return Published(device.id, path, hole=f"{path} is not there")
    try:
        read = read_vectors(packed)
        if text := why_stale(sources.root, device.id):
            raise Unjudged(f"is of another text: {text}")
        about = tuple(str(read.header[key]) for key in ("target", "document", "suite"))
        if about != (device.id, document.name, SUITE):
            raise Unjudged(f"holds other vectors: {' '.join(about)}")
        codes = codes_of(sources, document)
        return Published(
            device.id,
            path,
            str(read.header["guarantees"]),
            str(read.header["does_not_show"]),
            tuple(_sequence(read, case, device, codes) for case in read.cases),
        )
    except Unjudged as error:
        return Published(device.id, path, hole=f"{path} {error.message}")
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        return Published(device.id, path, hole=f"{path} is no file of vectors ({type(error).__name__})")


def _sequence(
    read: VectorFile, case: Mapping[str, Any], device: Device, codes: Mapping[str, Codes]
) -> Sequence:
    basis = str(case["basis"])
    return Sequence(
        str(case["id"]),
        str(case["why"]),
        basis,
        basis.removeprefix(_OF_FINDING) if basis.startswith(_OF_FINDING) else "",
        tuple(str(one) for one in case["clauses"]),
        ", ".join(f"{name} {_text(value)}" for name, value in case["params"].items()),
        _story(read, case, device, codes),
    )


def _story(read: VectorFile, case: Mapping[str, Any], device: Device, codes: Mapping[str, Codes]) -> Story:
    """The case with what is on each signal in each scan; row 0 is the device after the reset."""
    header = read.header
    graph = header["graphs"][case["graph"]]
    values: dict[str, str] = {device.id: _state(device, graph["views"][graph["initial"]])}
    stands, rows = [values], [Row(POWER_UP, device.id, "", (), (), dict(values))]
    for scan in case["scans"]:
        asked, answered = (
            {
                name: _value(codes, name, header[group][name]["type"], value)
                for name, value in scan[key].items()
            }
            for key, group in (("in", "inputs"), ("out", "outputs"))
        )
        state = {device.id: _state(device, graph["views"][scan["to"]])}
        values = {**values, **asked, **answered, **state}
        messages = [
            Message(source, target, tuple(f"{name} {text}" for name, text in some.items()))
            for source, target, some in ((OUTSIDE, device.id, asked), (device.id, ANSWERED, answered))
            if some
        ]
        step = str(header["steps"][scan["step"]]["name"])
        cells = (f"{int(scan['dt_ms'])} ms",)
        rows.append(Row(step, device.id, device.id, cells, (), state, tuple(messages)))
        stands.append(values)
    names = [*header["inputs"], device.id, *header["outputs"]]
    first, last = stands[1], stands[-1]
    if missing := [name for name in names if name not in first]:
        raise ValueError(f"the first scan says nothing of {', '.join(missing)}")
    moving = [name for name in names if len({stand[name] for stand in stands if name in stand}) > 1]
    shown = [
        replace(
            row,
            cells=(*(row.cells or ("",)), *(now.get(name, "") for name in moving)),
            changed=tuple(n for n, name in enumerate(moving, 1) if name in old and old[name] != now[name]),
        )
        for row, old, now in zip(rows, [{}, *stands], stands, strict=False)
    ]
    return Story(
        (Lane(OUTSIDE, "inputs"), Lane(device.id, device.id), Lane(ANSWERED, "outputs")),
        (AFTER, *(_heading(device, name) for name in moving)),
        tuple(shown),
        ", ".join(f"{_heading(device, name)} {last[name]}" for name in names if name not in moving),
        True,
    )


def _heading(device: Device, name: str) -> str:
    return f"{name} is in" if name == device.id else name


def _state(device: Device, view: str) -> str:
    """The state of the device in a state of its graph; the whole of it where it holds none of them."""
    return next((one for one in _QUOTED.findall(view) if one in device.states), view)


def _value(codes: Mapping[str, Codes], name: str, kind: str, value: Any) -> str:
    """One value of a signal: a word in hex with what it means where it is, all else as `_text`."""
    text = _text(value)
    if kind != "word":
        return text
    if not text.strip("0"):
        return "0"
    if name not in codes:
        return text
    of = codes[name]
    return f"{text} = {of.says} {of.words[text]}" if text in of.words else f"{text} = no code"


def _text(value: Any) -> str:
    """A boolean as 1 or 0, several by each, nothing by its name."""
    if isinstance(value, bool):
        return "1" if value else "0"
    if value is None or value in ("", []):
        return NONE
    if isinstance(value, list):
        return ", ".join(str(one) for one in value)
    return str(value)

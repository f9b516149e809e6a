"""What logs can be of: a device or the whole system, as spec/<document>/replay.toml declares them."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from modeproof.graph.values import ValueForms
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import documents
from modeproof.registers.load import load_interface
from modeproof.registers.replay import load_targets
from modeproof.registers.rows import Device
from modeproof.registers.typed import Entry, LowerName, Name, Text, typed

PLACEHOLDER = re.compile(r"\$([a-z][a-z0-9_]*)\.(\w+)")
SEEN, WORDS = "seen", "words"
"""Placeholders that stand for what the log shows, not for a parameter."""


Hex = Annotated[
    str, Meta(pattern="^[0-9A-F]{4}$", description="a word of four upper-case hexadecimal digits")
]


class _Device(Entry, frozen=True, kw_only=True):
    scan: Text
    row: Text
    view: Text


class _Copies(Entry, frozen=True, kw_only=True):
    one: Hex
    other: Hex
    compares: tuple[Name, Name]


class _Row(Entry, frozen=True, kw_only=True):
    """A target of replay.toml."""

    id: LowerName
    module: Name
    init: Text
    constants: dict[Name, str]
    devices: Annotated[dict[LowerName, _Device], Meta(min_length=1)]
    anywhere: str = ""
    copies: _Copies | None = None


@dataclass(frozen=True)
class Copies:
    """Of a device that only copies words: the word of its graph that is looked at, and that for all others.

    It compares the output `kept` with the input `read`, and decides nothing else by a word.
    """

    one: int
    other: int
    kept: str
    read: str


@dataclass(frozen=True)
class Part:
    """One device of a target. TLA+ texts: the action of a scan, the outputs after it, its memory."""

    device: Device
    scan: str
    row: str
    view: str


@dataclass(frozen=True)
class Target:
    """What a log is of. `init` and `anywhere` are TLA+ texts, `constants` TLA+ with placeholders.

    `anywhere` is empty when a log must begin at power-up. `copies`: of a device that only copies words.
    """

    document: str
    id: str
    module: str
    init: str
    anywhere: str
    constants: Mapping[str, str]
    parts: Mapping[str, Part]
    forms: ValueForms
    copies: Copies | None = None

    @property
    def system(self) -> bool:
        """Whether a line of the log is of one of several devices."""
        return len(self.parts) > 1

    @property
    def only(self) -> Part:
        """The part of a target of one device."""
        return next(iter(self.parts.values()))

    @property
    def names(self) -> frozenset[str]:
        """The names that a log of it may use: of signals, as declared or as tags, and of parameters."""
        devices = [part.device for part in self.parts.values()]
        tables = [table for one in devices for table in (one.inputs, one.outputs, one.parameters)]
        signals = [signal for table in tables for signal in table.values()]
        return frozenset(name for one in signals for name in (one.name, one.tag) if name)

    def timed(self, device: str) -> bool:
        """Whether the device counts time: some of its memory is milliseconds."""
        return any(signal.type == "ms" for signal in self.parts[device].device.memory.values())


def targets_of(place: Path, document: str) -> tuple[Target, ...]:
    """All targets of a document; none when its replay.toml declares none.

    Raises Unjudged for a register that is wrong, and for a device or parameter that does not exist.
    """
    source = f"spec/{document}/replay.toml"
    found = load_targets(place, document)
    rows = [typed(_Row, row, f"{source}: target {id}") for id, row in found.items()]
    if not rows:
        return ()
    interface = load_interface(place, document)
    forms = ValueForms([int(mode) for mode in interface.constants.get("MODES", ())])
    return tuple(_target(place, document, row, interface.devices, forms) for row in rows)


def _target(
    place: Path, document: str, row: _Row, devices: Mapping[str, Device], forms: ValueForms
) -> Target:
    source = f"spec/{document}/replay.toml: target {row.id}"
    for name in row.devices:
        if name not in devices:
            raise Unjudged(f"{source}: no device {name!r}; {suggestion(name, devices)}")
    if not (place / "spec" / document / f"{row.module}.tla").is_file():
        raise Unjudged(f"{source}: {row.module}.tla is missing")
    for constant, text in row.constants.items():
        for group, name in PLACEHOLDER.findall(text):
            _check_placeholder(f"{source}: {constant}", group, name, list(row.devices), devices)
    return Target(
        document=document,
        id=row.id,
        module=row.module,
        init=row.init,
        anywhere=row.anywhere,
        constants=row.constants,
        parts={name: Part(devices[name], own.scan, own.row, own.view) for name, own in row.devices.items()},
        forms=forms,
        copies=None if row.copies is None else _copies(source, row.copies, [devices[n] for n in row.devices]),
    )


def _copies(source: str, row: _Copies, devices: Sequence[Device]) -> Copies:
    if len(devices) != 1:
        raise Unjudged(f"{source}: copies: belongs to a target of one device, not of {len(devices)}")
    (device,) = devices
    kept, read = row.compares
    remembered = [name for name in device.outputs if name in device.memory]
    for name, side in ((kept, remembered), (read, device.inputs)):
        if name not in side:
            what = "input" if side is device.inputs else "output that it remembers"
            raise Unjudged(f"{source}: copies: {device.id} has no {what} {name!r}; {suggestion(name, side)}")
    return Copies(int(row.one, 16), int(row.other, 16), kept, read)


def _check_placeholder(
    source: str, group: str, name: str, own: Sequence[str], devices: Mapping[str, Device]
) -> None:
    device, kind = (name, "") if group in (SEEN, WORDS) else (group, name)
    if device not in own:
        raise Unjudged(f"{source}: ${group}.{name}: no device {device!r} here; {suggestion(device, own)}")
    if kind and kind not in devices[device].parameters:
        raise Unjudged(f"{source}: {device} has no parameter {kind!r}")


def find_target(place: Path, name: str, document: str | None = None) -> Target:
    """The target of this name. Raises Unjudged when there is none, or more than one."""
    known = [listed for each in documents(place) for listed in targets_of(place, each)]
    found = [listed for listed in known if listed.id == name and document in (None, listed.document)]
    if not found:
        where = f" in {document}" if document else ""
        names = [listed.id for listed in known if document in (None, listed.document)]
        raise Unjudged(f"no log can be of {name!r}{where}; {suggestion(name, names)}")
    if len(found) > 1:
        raise Unjudged(
            f"{name} is in {' and '.join(listed.document for listed in found)}; choose with --document"
        )
    return found[0]


def rather_of(place: Path, target: Target, path: Path) -> str:
    """Of which target a log rather is than of this one, in words that end a complaint; empty: of this one.

    It is of the one that has all names of its first lines that are names of any target.
    """
    try:
        with path.open(encoding="utf-8", errors="replace") as lines:
            words = set(re.findall(r"\w+", "".join(itertools.islice(lines, 40))))
    except OSError:
        return ""
    known = [listed for each in documents(place) for listed in targets_of(place, each)]
    told = words & frozenset().union(*(other.names for other in known))
    fitting = [other for other in known if told <= other.names]
    if not told or target.names >= told or not fitting:
        return ""
    likely = min(fitting, key=lambda other: len(other.names))
    return f"; its names are those of {likely.id}: modeproof trace {likely.id} {path}"

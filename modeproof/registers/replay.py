"""The register replay.toml: how traces and logs of a document are read as scans.

A document without the file has no rendered traces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

from msgspec import Meta, field
from msgspec.structs import replace

from modeproof.registers.demands import MODULE
from modeproof.registers.load import read_register
from modeproof.registers.typed import (
    Entry,
    LowerName,
    Name,
    Names,
    SomeNames,
    SomeTexts,
    Table,
    Text,
    tables,
    typed,
)

OPEN, OF_DEMANDS = "Open", "DemandsNext"
"""The end of the name of a module in which a device is alone, and the step relation of the module in which
its demands are judged: that one is read as the other, where nothing else is said.
"""


class Words(Entry, frozen=True, kw_only=True):
    """Signals whose words mean something by one table (an operator: number -> word); `says` names the
    number.
    """

    table: Name
    says: Text
    signals: SomeNames


class Vector(Entry, frozen=True, kw_only=True):
    """Boolean signals that are shown in one column, each by its label; `says` comes before the labels."""

    id: Name
    signals: SomeNames
    labels: SomeTexts
    says: str = ""


class Replay(Entry, frozen=True, kw_only=True):
    """The operators of a device's module: first state, scan of one input, record of the outputs."""

    init: Name
    scan: Name
    outputs: Name
    short: Text
    """The name of the device in a table."""


class Top(Entry, frozen=True, kw_only=True):
    """One module that runs check. `next` is the step relation that finds out a step which was not recorded,
    `wires` the record of all that is on the wires, `inputs` what a device read in the step just executed.

    `columns` are those of a table: signals, vectors, variables; a device stands for its state.
    """

    next: Name = "OpenNext"
    wires: Name = "Wires"
    columns: SomeNames
    inputs: dict[LowerName, Text]


class Traces(Entry, frozen=True, kw_only=True):
    """The whole register. `step` is the variable with the step's name, written where the constant `recorded`
    is true, and `with_step` are the variables written with it. `no_step` is its value after a scan in which
    the device of a model takes no step.
    """

    step: Name = "step"
    recorded: Name = "RECORD_STEPS"
    with_step: Names = ()
    no_step: Name = "NoStep"
    nobody: dict[str, str] = field(default_factory=dict)
    words: tuple[Words, ...] = field(default=(), name="word")
    vectors: tuple[Vector, ...] = field(default=(), name="vector")
    devices: Annotated[dict[LowerName, Replay], Meta(min_length=1)]
    tops: Annotated[dict[Name, Top], Meta(min_length=1)]


def has_replay(root: Path, name: str) -> bool:
    """Whether the document has the register."""
    return (root / "spec" / name / "replay.toml").is_file()


def load_targets(root: Path, name: str) -> dict[str, Table]:
    """What logs can be of ([target.ID]), as plain tables by their ids; none without the register."""
    if not has_replay(root, name):
        return {}
    data = read_register(root, name, "replay")
    return dict(tables(f"spec/{name}/replay.toml", data, "target")) if "target" in data else {}


def meanings(
    traces: Traces, tables: Mapping[str, Sequence[Sequence[int]]]
) -> dict[str, tuple[str, dict[int, int]]]:
    """For each signal whose words mean something: what a number is called, and the number of each word.

    `tables` holds, for each table, pairs of number and word.
    """
    return {
        signal: (words.says, {word: number for number, word in tables.get(words.table, ())})
        for words in traces.words
        for signal in words.signals
    }


def load_replay(root: Path, name: str) -> Traces:
    """The register of one document. Raises Unjudged with one line when it is missing or wrong."""
    data = read_register(root, name, "replay")
    data.pop("target", None)
    traces = typed(Traces, data, f"spec/{name}/replay.toml")
    of_demands = {
        f"{module.removesuffix(OPEN)}{MODULE}": replace(top, next=OF_DEMANDS)
        for module, top in traces.tops.items()
        if module.endswith(OPEN)
    }
    return replace(traces, tops=of_demands | traces.tops)

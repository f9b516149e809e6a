"""The register replay.toml: how a recorded trace of a document is read as scans and replayed.

A document without the file has no rendered traces.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.registers.load import read_register


@dataclass(frozen=True)
class Words:
    """Signals whose words mean something by one table (an operator: number -> word); `says` names the
    number.
    """

    table: str
    says: str
    signals: tuple[str, ...]


@dataclass(frozen=True)
class Vector:
    """Boolean signals that are shown in one column, each by its label; `says` comes before the labels."""

    id: str
    signals: tuple[str, ...]
    labels: tuple[str, ...]
    says: str = ""


@dataclass(frozen=True)
class Replay:
    """The operators of a device's module: first state, scan of one input, record of the outputs."""

    init: str
    scan: str
    outputs: str
    short: str
    """The name of the device in a table."""


@dataclass(frozen=True)
class Top:
    """One module that runs check. `next` is the step relation that finds out a step which was not recorded,
    `wires` the record of all that stands on the wires, `inputs` what a device read in the step just executed.

    `columns` are those of a table: signals, vectors, variables; a device stands for its state.
    """

    next: str
    wires: str
    columns: tuple[str, ...]
    inputs: Mapping[str, str]


@dataclass(frozen=True)
class Traces:
    """The whole register. `step` is the variable with the step's name, written where the constant `recorded`
    is true, and `with_step` are the variables written with it.
    """

    step: str
    recorded: str
    with_step: tuple[str, ...]
    nobody: Mapping[str, str]
    words: tuple[Words, ...]
    vectors: tuple[Vector, ...]
    devices: Mapping[str, Replay]
    tops: Mapping[str, Top]


def has_replay(root: Path, name: str) -> bool:
    """Whether the document has the register."""
    return (root / "spec" / name / "replay.toml").is_file()


def load_replay(root: Path, name: str) -> Traces:
    """The register of one document. Raises Unjudged with one line when it is missing or wrong."""
    table = read_register(root, name, "replay")
    return Traces(
        step=table["step"],
        recorded=table["recorded"],
        with_step=tuple(table.get("with_step", [])),
        nobody=dict(table.get("nobody", {})),
        words=tuple(Words(row["table"], row["says"], tuple(row["signals"])) for row in table.get("word", [])),
        vectors=tuple(
            Vector(row["id"], tuple(row["signals"]), tuple(row["labels"]), row.get("says", ""))
            for row in table.get("vector", [])
        ),
        devices={key: Replay(**row) for key, row in table["devices"].items()},
        tops={
            key: Top(row["next"], row["wires"], tuple(row["columns"]), dict(row["inputs"]))
            for key, row in table["tops"].items()
        },
    )

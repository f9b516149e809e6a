"""The typed rows of the registers. Every field means what docs and schemas say; lists keep their order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.registers.runs import Run


@dataclass(frozen=True)
class Problem:
    """A contradiction between registers, or between a register and the tree."""

    file: str
    place: str
    text: str

    def __str__(self) -> str:
        return f"{self.file}: {self.place}: {self.text}" if self.place else f"{self.file}: {self.text}"


@dataclass(frozen=True)
class About:
    """Which paper it is, and what of it we had."""

    title: str
    number: str
    edition: str
    publisher: str
    prefix: str
    seed: str
    sha256: str
    available: tuple[str, ...]
    not_available: tuple[str, ...]
    not_endorsed: str
    sources: tuple[str, ...] = ()


@dataclass(frozen=True)
class Clause:
    """One thing that the document says. `device` lists whose behaviour it is."""

    id: str
    title: str
    text: str
    kind: str
    device: tuple[str, ...]
    because: str = ""
    pages: str = ""
    figure: str = ""


@dataclass(frozen=True)
class Signal:
    """One memory variable, input, output or parameter of a device.

    `python` and `tla` are its names in the implementation and the specification (`tla` is empty when the
    specification leaves it out). `default` is None where none is declared.
    """

    name: str
    type: str
    clauses: tuple[str, ...]
    why: str
    python: str
    tla: str
    tag: str = ""
    minimum: int | None = None
    maximum: int | None = None
    values: tuple[str, ...] = ()
    default: int | str | bool | list[int] | None = None
    required: bool = False
    project: bool = False


@dataclass(frozen=True)
class Device:
    """One device or function block with all its names."""

    id: str
    title: str
    module: str
    published: bool
    states: tuple[str, ...]
    steps: tuple[str, ...]
    memory: Mapping[str, Signal]
    inputs: Mapping[str, Signal]
    outputs: Mapping[str, Signal]
    parameters: Mapping[str, Signal]


@dataclass(frozen=True)
class Interface:
    """The one declaration of every name."""

    document: str
    constants: Mapping[str, tuple[int | str, ...]]
    devices: Mapping[str, Device]


@dataclass(frozen=True)
class Property:
    """What must be true. `tla` is its operator in `module`; `antecedent` the witness that it is not empty."""

    id: str
    title: str
    sentence: str
    hazard: str
    clauses: tuple[str, ...]
    tla: str
    module: str
    kind: str
    environments: tuple[str, ...]
    antecedent: str
    findings: tuple[str, ...] = ()
    reason: str = ""


@dataclass(frozen=True)
class Finding:
    """Where the document is wrong or silent, and what was decided."""

    id: str
    title: str
    clauses: tuple[str, ...]
    says: str
    readings: tuple[str, ...]
    consequence: str
    decision: str
    severity: str
    """The key `class` of the register: safety, availability or wording."""
    drawing_could_settle: bool
    tries: tuple[str, ...] = ()
    """The readings, by the names that they have in the specification, that runs of its evidence try."""
    parameter: str = ""
    """The constant of the specification that leaves the choice to the project."""
    evidence: tuple[str, ...] = ()
    evidence_open: str = ""


@dataclass(frozen=True)
class Assumption:
    """What is taken for granted; `breaks` lists the runs that show what happens without it."""

    id: str
    title: str
    text: str
    kind: str
    clauses: tuple[str, ...]
    who: str
    check: str
    breaks: tuple[str, ...] = ()
    breaks_open: str = ""


@dataclass(frozen=True)
class Fall:
    """A property that falls under a class of faults: the run that shows it, and what it takes."""

    property: str
    run: str
    needs: str


@dataclass(frozen=True)
class Fault:
    """One class of faults from outside: what detects it, what holds, what falls, what nothing detects."""

    id: str
    kind: str
    """The key `class` of the register: the class of the communication error list, or of wires."""
    title: str
    model: str
    detected_by: tuple[str, ...]
    not_detected: str
    holds: tuple[str, ...] = ()
    runs: tuple[str, ...] = ()
    falls: tuple[Fall, ...] = ()
    not_modelled: str = ""


@dataclass(frozen=True)
class Matrix:
    """A run whose witnesses are the cells of a table: `ROW at COLUMN: WHAT`."""

    run: str
    title: str


@dataclass(frozen=True)
class Document:
    """All registers of one document. `root` is the repository, `name` the folder below `spec`."""

    root: Path
    name: str
    about: About
    clauses: tuple[Clause, ...]
    interface: Interface
    properties: tuple[Property, ...]
    findings: tuple[Finding, ...]
    assumptions: tuple[Assumption, ...]
    runs: tuple[Run, ...]
    faults: tuple[Fault, ...] = ()
    matrix: Matrix | None = None

    @property
    def folder(self) -> Path:
        """The folder of the registers and the specification."""
        return self.root / "spec" / self.name

    def source(self, register: str) -> str:
        """The register's file as it is named in messages."""
        return f"spec/{self.name}/{register}.toml"

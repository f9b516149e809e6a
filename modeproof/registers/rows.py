"""The typed rows of the registers. Every field means what docs say; lists keep their order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta, field

from modeproof.registers.runs import Run
from modeproof.registers.typed import (
    Clauses,
    Count,
    Entry,
    LowerName,
    Name,
    Names,
    RowId,
    RunId,
    Sha256,
    SomeNames,
    SomeTexts,
    Text,
    Texts,
)

FaultClass = Literal[
    "corruption",
    "repetition",
    "wrong sequence",
    "loss",
    "delay",
    "insertion",
    "masquerade",
    "wrong address",
    "stuck wire",
    "lost wire",
    "extra wire",
]


@dataclass(frozen=True)
class Problem:
    """A contradiction between registers, or between a register and the tree."""

    file: str
    place: str
    text: str

    def __str__(self) -> str:
        return f"{self.file}: {self.place}: {self.text}" if self.place else f"{self.file}: {self.text}"


class About(Entry, frozen=True, kw_only=True):
    """Which paper it is, and what of it we had. `prefix` begins its clause ids, `sha256` is of the seed."""

    title: Text
    number: str
    edition: Text
    publisher: Text
    prefix: Annotated[str, Meta(pattern="^[A-Z]+$", description="capital letters")]
    seed: Text
    sha256: Sha256
    available: SomeTexts
    not_available: Texts
    not_endorsed: Text
    sources: Texts = ()


class Clause(Entry, frozen=True, kw_only=True):
    """One thing that the document says. `device` lists whose behaviour it is."""

    id: Annotated[str, Meta(pattern=r"^[A-Z]+(-[A-Z0-9]+)+$", description="a clause id such as AB-2-18")]
    title: Text
    text: Text
    kind: Literal["behaviour", "property", "assumption", "not modelled"]
    device: tuple[LowerName, ...]
    because: str = ""
    pages: str = ""
    figure: str = ""


class Signal(Entry, frozen=True, kw_only=True):
    """One memory variable, input, output or parameter of a device.

    `python` and `tla` are its names in the implementation and the specification (`tla` is empty when the
    specification leaves it out); `tag` is that of the document's own wiring. `project`: our own choice, which
    the document does not print. Parameters alone may be required or have a default, which is None where none
    is declared. The defaults are the profile `letter`; `cautious` is the value of the profile of that name
    where it is another, and `because` says why either is what it is.
    """

    name: str
    type: Literal["word", "bool", "mode", "modes", "text", "int", "ms", "function"]
    clauses: Clauses
    why: Text
    python: Name
    tla: Annotated[str, Meta(pattern=r"^([A-Za-z_]\w*)?$", description="a name, or empty")]
    tag: str = ""
    minimum: int | None = field(default=None, name="min")
    maximum: int | None = field(default=None, name="max")
    values: tuple[str, ...] = ()
    default: int | str | bool | list[int] | None = None
    required: bool = False
    cautious: int | str | bool | list[int] | None = None
    because: str = ""
    project: bool = False


class Device(Entry, frozen=True, kw_only=True):
    """One device or function block with all its names.

    `codes`: of a block that shows its state as a code, the code of each state, in upper-case hex digits.
    """

    id: LowerName
    title: Text
    module: Name
    published: bool
    states: SomeNames
    steps: SomeNames
    memory: dict[Name, Signal]
    inputs: dict[Name, Signal]
    outputs: dict[Name, Signal]
    parameters: dict[Name, Signal]
    codes: dict[Name, Annotated[str, Meta(pattern="^[0-9A-F]{4}$")]] = msgspec.field(default_factory=dict)


@dataclass(frozen=True)
class Interface:
    """The one declaration of every name."""

    document: str
    constants: Mapping[str, tuple[int | str, ...]]
    devices: Mapping[str, Device]


class Property(Entry, frozen=True, kw_only=True):
    """What must be true. `antecedent` is the witness that it is not empty.

    `tla` is its operator in `module`; it has the id as its name where none is given. `profiles` are those
    with which it holds.
    """

    id: Name
    title: Text
    sentence: Text
    hazard: Text
    clauses: Clauses
    module: Name
    kind: Literal["invariant", "action", "liveness", "refinement"]
    environments: Annotated[tuple[LowerName, ...], Meta(min_length=1)]
    antecedent: str = ""
    tla: str = ""
    findings: tuple[RowId, ...] = ()
    profiles: tuple[Literal["letter", "cautious"], ...] = (
        "letter",
        "cautious",
    )
    reason: str = ""


class Telling(Entry, frozen=True, kw_only=True):
    """The counterexample of a finding that the document's page shows, and the story before it."""

    run: Text
    story: Text


class Finding(Entry, frozen=True, kw_only=True):
    """Where the document is wrong or silent, and what was decided.

    `severity`, its class, is computed from the runs (modeproof.registers.standing), and never typed.
    `tries` are the readings, by the names that they have in the specification, that runs of its evidence try;
    `parameter` is the constant of the specification that leaves the choice to the project. `unasked` says of
    a reading why no demand on a device can be asked of it.
    """

    id: RowId
    title: Text
    clauses: Clauses
    says: str
    readings: SomeTexts
    consequence: Text
    decision: Text
    severity: str = ""
    drawing_could_settle: bool
    tries: Texts = ()
    unasked: dict[str, Text] = msgspec.field(default_factory=dict)
    parameter: str = ""
    evidence: Texts = ()
    evidence_open: str = ""
    telling: Telling | None = None


class Assumption(Entry, frozen=True, kw_only=True):
    """What is taken for granted; `breaks` lists the runs that show what happens without it."""

    id: RowId
    title: Text
    text: Text
    kind: Literal["assumption", "abstraction", "merged step"]
    clauses: Clauses
    who: Text
    check: Text
    breaks: tuple[RunId, ...] = ()
    breaks_open: str = ""


class Fall(Entry, frozen=True, kw_only=True):
    """A property that fails under a class of faults: the run that shows it, and what it takes."""

    property: Name
    run: RunId
    needs: Text


class Fault(Entry, frozen=True, kw_only=True):
    """One class of faults from outside: what detects it, what holds, what fails, what nothing detects.

    `kind` is the class of the communication error list, or of wires.
    """

    id: LowerName
    kind: FaultClass = field(name="class")
    title: Text
    model: Text
    detected_by: Texts
    not_detected: Text
    holds: Names = ()
    runs: tuple[RunId, ...] = ()
    falls: tuple[Fall, ...] = ()
    not_modelled: str = ""


class Response(Entry, frozen=True, kw_only=True):
    """How soon a device answers what is on its wires; times are ms.

    `calls` counts calls of the device, the one that sees it first included; `times` are parameters of the
    device, and how often each is waited for besides, up to the first call that finds it over. The theorem
    that names the row proves just this number and these times. A row without `calls` has no bound:
    `unbounded` says why, and the theorem shows it.
    """

    id: RowId
    device: LowerName
    start: Text = field(name="from")
    end: Text = field(name="to")
    clauses: Clauses
    calls: Annotated[int, Meta(ge=1)] | None = None
    times: dict[Name, Count] = field(default_factory=dict)
    unbounded: str = ""

    @property
    def waits(self) -> int:
        """How many times are waited for."""
        return sum(self.times.values())


class Chain(Entry, frozen=True, kw_only=True):
    """Responses one after the other, with a transfer between each two.

    `steps` are ids of rows, those of another document after its name; `then` is what comes
    last and is no program's, such as a contactor, with its time in ms in the example.
    """

    id: RowId
    title: Text
    steps: SomeTexts
    then: str = ""
    then_ms: Annotated[int, Meta(ge=0)] = 0


class Example(Entry, frozen=True, kw_only=True):
    """Numbers for a worked example, in ms: the longest cycle of each device, parameters, one transfer."""

    cycle: dict[LowerName, Count]
    times: dict[Name, Count] = field(default_factory=dict)
    transfer: Count


_NO_EXAMPLE = Example(cycle={}, transfer=1)


@dataclass(frozen=True)
class Responses:
    """The register of response times of a document; empty where it has none. `source` is its file."""

    source: str = ""
    rows: tuple[Response, ...] = ()
    chains: tuple[Chain, ...] = ()
    example: Example = _NO_EXAMPLE


class Matrix(Entry, frozen=True, kw_only=True):
    """A run whose witnesses are the cells of a table: `ROW at COLUMN: WHAT`."""

    run: RunId
    title: Text


class Faults(Entry, frozen=True, kw_only=True):
    """What is said of the faults from outside together."""

    summary: str = ""
    matrix: Matrix | None = None


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
    faults_summary: str = ""
    matrix: Matrix | None = None
    responses: Responses = Responses()

    @property
    def folder(self) -> Path:
        """The folder of the registers and the specification."""
        return self.root / "spec" / self.name

    def source(self, register: str) -> str:
        """The register's file as it is named in messages."""
        return f"spec/{self.name}/{register}.toml"

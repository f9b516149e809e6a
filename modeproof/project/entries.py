"""What a project file may list: programs, machines, adapters and logs, each as one command judges it.

A key has the name of the option that it stands for, so what the page of the command says is true here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

import msgspec
from msgspec import Meta

from modeproof.kit.adapter import split_command
from modeproof.kit.errors import Unjudged
from modeproof.registers.typed import Entry, SomeTexts, Text, Texts

Seconds = Annotated[float, Meta(gt=0)]
Number = Annotated[int, Meta(ge=0)]
Factor = Annotated[int, Meta(ge=1)]
Params = dict[str, bool | int | str]
At = Callable[[str], str]
"""How a path of the project file is written from where a command runs."""


class Binding(Entry, frozen=True, kw_only=True):
    """What the file of `prove-program --binding` says, written into the project file."""

    names: dict[str, str] = msgspec.field(default_factory=dict)
    parameters: dict[str, Any] = msgspec.field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    profile: Literal["letter", "cautious"] | None = None
    assume: dict[str, Any] = msgspec.field(default_factory=dict)

    @property
    def unfinished(self) -> list[str]:
        """The signals whose names are still to be written."""
        return [name for name, text in self.names.items() if not text.strip()]


class Row(Entry, frozen=True, kw_only=True):
    """An entry of the file. PATHS: its keys that name files. OPTIONS: those that are options as they are."""

    KIND: ClassVar[str]
    PATHS: ClassVar[tuple[str, ...]]
    OPTIONS: ClassVar[tuple[str, ...]]

    def paths(self) -> list[tuple[str, str]]:
        """The files that it names, each with its key."""
        return [(key, path) for key in self.PATHS for path in texts(getattr(self, key))]

    def words(self, at: At, binding: str | None = None) -> list[str]:
        """The command that judges it, without the name of the tool. binding: a file with its inline table."""
        raise NotImplementedError

    def trouble(self) -> str:
        """Which of its keys do not go together; nothing where they do."""
        return ""

    def options(self, at: At) -> Iterator[str]:
        """The words of its options."""
        for name in self.OPTIONS:
            value, option = getattr(self, name), f"--{key_of(type(self), name)}"
            if value is True:
                yield option
            elif isinstance(value, Mapping):
                for key, one in value.items():
                    yield from (option, f"{key}={str(one).lower() if isinstance(one, bool) else one}")
            elif isinstance(value, float):
                yield from (option, f"{value:g}")
            elif value is not None and value is not False:
                for one in texts(value) if isinstance(value, str | tuple) else [str(value)]:
                    yield from (option, at(one) if name in self.PATHS else one)


class Program(Row, frozen=True, kw_only=True):
    """A program beside a published target, or with properties of its own: `prove-program`."""

    KIND = "program"
    PATHS = ("files", "own", "binding")
    OPTIONS = ("target", "own", "unit", "same", "codes", "latency", "wrap", "seconds")

    files: SomeTexts
    target: Text | None = None
    own: Text | None = msgspec.field(default=None, name="property")
    unit: Text | None = None
    binding: Text | Binding | None = None
    profile: Literal["letter", "cautious"] | None = None
    same: bool = False
    codes: bool = False
    latency: int | None = None
    wrap: bool = False
    seconds: Seconds | None = None

    def trouble(self) -> str:
        """As `Row.trouble`."""
        if (self.target is None) == (self.own is None):
            return "needs `target`, or `property` for a program of your own; one of the two"
        if self.own is not None and (self.binding is not None or self.profile is not None):
            return "`binding` and `profile` belong to `target`; properties use the names of the program"
        if self.own is not None and (self.same or self.codes or self.latency is not None):
            return "`same`, `codes` and `latency` belong to `target`"
        if self.profile is not None and isinstance(self.binding, str):
            return f"`profile` stands in {self.binding}, the file of the binding; leave it out here"
        if self.profile is not None and isinstance(self.binding, Binding) and self.binding.profile:
            return "`profile` stands here and in the binding; leave one out"
        return ""

    @property
    def inline(self) -> Binding | None:
        """The binding that is in the project file itself."""
        if self.profile is None:
            return self.binding if isinstance(self.binding, Binding) else None
        written = self.binding if isinstance(self.binding, Binding) else Binding()
        return msgspec.structs.replace(written, profile=self.profile)

    def words(self, at: At, binding: str | None = None) -> list[str]:
        """As `Row.words`."""
        file = at(self.binding) if isinstance(self.binding, str) else binding
        bound = ["--binding", file] if file is not None else []
        return ["prove-program", *map(at, self.files), *self.options(at), *bound]


class Machine(Row, frozen=True, kw_only=True):
    """How blocks are wired to a machine, or a program that is the machine: `machine`."""

    KIND = "machine"
    PATHS = ("wiring", "properties", "use", "source")
    OPTIONS = ("properties", "use", "seconds", "recheck", "equal", "unit")

    wiring: Text
    properties: Text | None = None
    use: Text | None = None
    source: Texts = ()
    unit: Text | None = None
    equal: bool = False
    recheck: bool = False
    seconds: Seconds | None = None

    def trouble(self) -> str:
        """As `Row.trouble`."""
        if not self.source and (self.unit is not None or self.equal):
            return "`unit` and `equal` belong to `source`"
        if self.equal and self.properties is not None:
            return "`equal` asks for equal outputs, not for properties; leave `properties` out"
        return ""

    def words(self, at: At, binding: str | None = None) -> list[str]:
        """As `Row.words`."""
        source = ["--source", *map(at, self.source)] if self.source else []
        return ["machine", at(self.wiring), *source, *self.options(at)]


class Adapter(Row, frozen=True, kw_only=True):
    """A program behind an adapter: `conform`. files: what the program is made of."""

    KIND = "adapter"
    PATHS = ("files", "vectors")
    OPTIONS = (
        *("document", "suite", "vectors", "relation", "latency", "hold", "slow", "param", "profile"),
        *("same", "codes", "jobs", "timeout"),
    )

    target: Text
    command: Text
    files: Texts = ()
    document: Text | None = None
    suite: Texts = ()
    vectors: Text | None = None
    relation: Literal["exact", "settled", "monitor"] | None = None
    latency: Number | None = None
    hold: Number | None = None
    slow: Factor | None = None
    param: Params = msgspec.field(default_factory=dict)
    profile: Literal["letter", "cautious", "all"] | None = None
    same: bool = False
    codes: bool = False
    jobs: Factor | None = None
    timeout: Seconds | None = None

    def trouble(self) -> str:
        """As `Row.trouble`."""
        try:
            split_command(self.command)
        except Unjudged as error:
            return f"`command`: {error}"
        return (
            "`vectors` names files, and `suite` others; leave one out" if self.vectors and self.suite else ""
        )

    def words(self, at: At, binding: str | None = None) -> list[str]:
        """As `Row.words`."""
        return ["conform", self.target, "--adapter", self.command, *self.options(at)]


class Log(Row, frozen=True, kw_only=True):
    """A recorded log: `trace`."""

    KIND = "log"
    PATHS = ("file", "wiring")
    OPTIONS = (
        *("document", "begins", "samples", "param", "format", "separator", "decimal_words", "time"),
        *("ignore", "codes", "wiring"),
    )

    file: Text
    target: Text
    document: Text | None = None
    begins: Literal["power-up", "anywhere"] | None = msgspec.field(default=None, name="from")
    samples: Text | None = None
    param: Params = msgspec.field(default_factory=dict)
    format: Literal["lines", "table"] | None = None
    separator: Text | None = None
    decimal_words: bool = msgspec.field(default=False, name="decimal-words")
    time: Text | None = None
    ignore: Texts = ()
    codes: bool = False
    wiring: Text | None = None

    def words(self, at: At, binding: str | None = None) -> list[str]:
        """As `Row.words`."""
        return ["trace", self.target, at(self.file), *self.options(at)]


KINDS: tuple[type[Row], ...] = (Program, Machine, Adapter, Log)


def texts(value: object) -> list[str]:
    """A text, or several, or none, as a list."""
    if isinstance(value, str):
        return [value]
    return list(value) if isinstance(value, tuple) else []


def key_of(kind: type[Row], name: str) -> str:
    """The key of a field, as the file has it."""
    return next(field.encode_name for field in msgspec.structs.fields(kind) if field.name == name)

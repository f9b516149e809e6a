"""The register of the tools: what is known to be unsound in them, and why this use is not affected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_toml
from modeproof.registers.runs import Kind
from modeproof.registers.typed import Count, Entry, SomeTexts, Text, only_keys, typed_rows

SOURCE = "docs/report.toml"
Link = Annotated[str, Meta(pattern="^https://[^ ]+$", description="an address that begins with https://")]


class Check(Entry, frozen=True, kw_only=True):
    """The check of one engine by another. `kind` is the kind of evidence of the comparison."""

    engine: Text
    by: Text
    kind: Literal["conformance", "agreement", "proof", "coverage", "strength", "registers"]


class _Holds(Entry, frozen=True, kw_only=True):
    """One condition as the register writes it: one of these keys, and `of`."""

    of: tuple[Kind, ...] = ()
    word_absent: SomeTexts | None = None
    cfg_absent: SomeTexts | None = None
    text_absent: SomeTexts | None = None
    option: Text | None = None
    option_absent: Text | None = None
    workers: Count | None = None
    collision_below: Annotated[float, Meta(gt=0)] | None = None
    queue_empty: bool | None = None
    jar_pinned: bool | None = None
    solvers_agree: bool | None = None
    compared: bool | None = None


@dataclass(frozen=True)
class Condition:
    """What a machine checks of a judgement. `name` and `value` as the register has them; `of`: kinds of run,
    all where there are none.
    """

    name: str
    value: Any
    of: tuple[str, ...] = ()


class ToolProblem(Entry, frozen=True, kw_only=True):
    """One known problem of a tool, and its judgement."""

    id: Annotated[str, Meta(pattern="^[A-Za-z0-9]+-[0-9]+$", description="an id such as TLC-1")]
    tool: Literal["tlc", "z3", "cvc5", "java", "python"]
    title: Text
    reference: Link
    what: Text
    affects: Text
    judgement: Literal["not reached", "covered", "only refuses"]
    because: Text
    also: tuple[Link, ...] = ()
    holding: tuple[_Holds, ...] = msgspec.field(default=(), name="holds")

    @property
    def holds(self) -> tuple[Condition, ...]:
        """What a machine checks of `because`."""
        return tuple(
            Condition(name, value, entry.of)
            for entry in self.holding
            for name, value in msgspec.structs.asdict(entry).items()
            if name != "of" and value is not None
        )


@dataclass(frozen=True)
class Tools:
    """The whole register."""

    checks: tuple[Check, ...]
    problems: tuple[ToolProblem, ...]


def load_tools(root: Path) -> Tools:
    """Read the register; it may state none. Raises Unjudged with one line when it is missing or wrong."""
    data = read_toml(root, root / SOURCE)
    only_keys(SOURCE, data, ("check", "problem", "term"))
    if not {"check", "problem"} & set(data):
        return Tools((), ())
    found = Tools(typed_rows(Check, SOURCE, data, "check"), typed_rows(ToolProblem, SOURCE, data, "problem"))
    for problem in found.problems:
        if len(problem.holds) != len(problem.holding):
            place = f"{SOURCE}: [[problem]] {problem.id}"
            raise Unjudged(f"{place}: a condition under `holds` has exactly one key besides `of`")
    return found

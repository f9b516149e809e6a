"""The machine as a TLA+ module, from the data of a wiring.

A scan is a row of steps in the order of the calls. A step calls standard blocks and then one block of a
document; the last one also lets the observers look and judges the properties. A block of a document stands in
it by its contract (`<name>Contract`), by the part of it that needs no memory, as a whole (`<name>Shows`), or
as anything whatsoever. An input is chosen in the step that reads it first, and forgotten after the one that
reads it last. Nothing is taken from the steps in Python. spec/machine_cell/tlc.toml says how a block is
called.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from machines.signal_names import names as leaves
from machines.wiring import Wiring
from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import Entry, Text, typed
from programs.language.tree import Binary, Expression, Member, Name, Place, Unary
from programs.language.tree import Literal as Value
from programs.properties.property_file import parsed, shown

As = Literal["contract", "at_once", "whole", "anything"]
"""By its contract, by the part of it that needs no memory, as a whole, or as anything whatsoever."""
CONTRACT: As = "contract"
LOOSE = ("at_once", "anything")
PINS = {"R_TRIG": "Q", "F_TRIG": "Q", "SR": "Q1", "RS": "Q1"}
"""The output of each standard block that the model has."""


class Block(Entry, frozen=True, kw_only=True):
    """How the model calls a block of a document; tlc.toml says what each key means."""

    name: Text
    folder: Text
    reads: tuple[Text, ...]
    pins: tuple[Text, ...]
    at_once: tuple[Text, ...] = ()
    variables: tuple[Text, ...]
    constants: dict[str, str]
    ticks: int = 0
    besides: str = ""


class Blocks(Entry, frozen=True, kw_only=True):
    """Of the file: [block.NAME]."""

    block: dict[str, Block]


def read_blocks(path: Path) -> Mapping[str, Block]:
    """How the model calls the blocks, by their names in capitals. Raises Unjudged."""
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {error}") from None
    return {
        name.upper(): row
        for name, row in typed(Blocks, {"block": table.get("block", {})}, str(path)).block.items()
    }


@dataclass(frozen=True)
class Asked:
    """A property: it is broken after a scan with `bad`; where `once` is there, `after` arms it first."""

    id: str
    bad: Expression
    after: Expression | None = None
    once: Expression | None = None

    @property
    def name(self) -> str:
        """As an operator of TLA+."""
        return "".join(part.capitalize() for part in self.id.split("-"))


def asked_of(table: Mapping[str, Any], file: str, wanted: Sequence[str] | None = None) -> list[Asked]:
    """The properties of a file without those that have a time, or those that are wanted. Raises Unjudged."""
    place = Place(file, 1)
    found = []
    for row in table["property"]:
        if "within_ms" in row or (wanted is not None and row["id"] not in wanted):
            continue
        if "never" in row:
            bad = row["never"]
        elif "always" in row:
            bad = f"NOT ({row['always']})"
        elif "only_if" in row:
            bad = f"({row['holds']}) AND NOT ({row['only_if']})"
        else:
            bad = row["holds"]
        both = [parsed(row[key], place) if key in row else None for key in ("after", "only_once")]
        found.append(Asked(row["id"], parsed(bad, place), *both))
    for name in wanted or ():
        if name not in {rule.id for rule in found}:
            raise Unjudged(f"{file}: no property {name!r} without a time, and a run of TLC asks for it")
    return found


@dataclass
class Step:
    """A step of the scan: standard blocks, then a block of a document."""

    number: int
    standard: list[str] = field(default_factory=list)
    document: str = ""
    chosen: dict[str, None] = field(default_factory=dict)
    """The inputs that are chosen in it."""
    free: list[str] = field(default_factory=list)
    """The outputs of standard blocks that may be anything."""
    before: list[str] = field(default_factory=list)
    """What has a name before the block of a document is called."""
    lets: list[str] = field(default_factory=list)
    """What has a name after it; only in the last one."""
    texts: dict[str, str] = field(default_factory=dict)
    """The signals that have a name in it, by their texts."""
    done: set[str] = field(default_factory=set)
    """The standard blocks that were called in it so far."""
    after: dict[str, str] = field(default_factory=dict)
    """The new value of each variable that it changes."""

    def let(self, name: str, text: str) -> str:
        """The name of a text in this step; one that has a name already keeps it."""
        if not self.number:  # what is at power-up has no names
            return f"({text})"
        if text not in self.texts:
            known = [line.split(" ==")[0] for line in (*self.before, *self.lets)]
            while name in known:
                name += "_"
            self.texts[text] = name
            self.lets.append(f"{name} == {text}")
        return self.texts[text]


class Model:
    """The module of a wiring."""

    def __init__(
        self,
        wiring: Wiring,
        blocks: Mapping[str, Block],
        observers: Mapping[str, Mapping[str, Any]],
        asked: Sequence[Asked],
        stand: Mapping[str, As] | None = None,
        held: Mapping[str, str] | None = None,
        helped: str = "",
    ) -> None:
        """`stand` says how a block stands in it, where it is not by its contract. Raises Unjudged.

        `held` are inputs that keep a value. `helped` is what must be true once somebody has done what
        MachineHelper says; with it every block begins where it rests.
        """
        self.helped = parsed(helped, self.place) if helped else None
        self.held = held or {}
        self.wiring, self.asked, self.observers = wiring, asked, observers
        table = wiring.table
        self.blocks: dict[str, Block] = {}
        for name in table.order:
            if wiring.kinds[name].unit is not None:
                kind = table.block[name].of.upper()
                if kind not in blocks:
                    raise wiring.refuse(
                        f"block.{name}", f"the model has no contract of {table.block[name].of}"
                    )
                self.blocks[name] = blocks[kind]
            elif table.block[name].of.upper() not in PINS:
                raise wiring.refuse(f"block.{name}", f"the model has no time, so no {table.block[name].of}")
        self.stand: dict[str, As] = {**dict.fromkeys(self.blocks, CONTRACT), **(stand or {})}
        self.sites: dict[str, list[tuple[int, bool]]] = {}
        """Who reads a value: the number of the step, and whether it is that of the scan before."""
        self.seen: dict[str, set[str]] = {name: set() for name in self.blocks}
        """The outputs of each block of a document that are read."""
        self.read: set[str] = set()
        """The standard blocks that are read."""
        self.sites_known = False
        self.needed = list(_needed(observers, asked, wiring))
        self._scan()
        self.sites_known = True
        self.steps = self._scan()

    # ------------------------------------------------------------ the scan

    def _scan(self) -> list[Step]:
        steps, following = [Step(1)], list(self.needed)
        for name in self.wiring.table.order:
            if name in self.blocks:
                steps[-1].document = name
                steps.append(Step(len(steps) + 1))
            else:
                steps[-1].standard.append(name)
        following = [*steps.pop().standard, *following] if len(steps) > 1 else following
        for step in steps:
            for name in step.standard:
                self._call(step, name)
            if step.document:
                self._document(step, step.document)
        last = steps[-1]
        last.before, last.lets = last.lets, []
        for name in following:
            self._call(last, name)
        self._judge(last)
        for step in steps[:-1]:
            step.before, step.lets = step.lets, []
        return steps

    def pin(self, name: str, pin: str) -> Expression:
        if name in self.observers:
            return parsed(self.observers[name]["inputs"][pin], self.place)
        return self.wiring.sources[name][pin]

    place = Place("safety.toml", 1)

    def kind(self, name: str) -> str:
        row = self.observers[name]["of"] if name in self.observers else self.wiring.table.block[name].of
        return str(row).upper()

    def _call(self, step: Step, name: str) -> None:
        kind = self.kind(name)
        variable = f"{name}_{PINS[kind]}"
        if self.stand.get(name) == "anything":
            step.done.add(name)
            if self.sites_known and name in self.read:
                step.free.append(f"new_{variable}")
            if self.lives(name, step.number):
                step.after[variable] = f"new_{variable}"
            return

        def pin(at: str) -> str:
            return self.expression(step, self.pin(name, at))

        if kind in ("R_TRIG", "F_TRIG"):
            clock, before = step.let(f"new_{name}_CLK", pin("CLK")), f"{name}_CLK"
            step.after[before] = clock
            rises = (clock, before) if kind == "R_TRIG" else (before, clock)
            shows = f"{rises[0]} /\\ ~{rises[1]}"
        elif kind == "SR":
            shows = f"{pin('S1')} \\/ ({name}_Q1 /\\ ~{pin('R')})"
        else:
            shows = f"~{pin('R1')} /\\ ({pin('S')} \\/ {name}_Q1)"
        step.let(f"new_{variable}", shows)
        if kind in ("SR", "RS") or self.lives(name, step.number):
            step.after[variable] = f"new_{variable}"
        step.done.add(name)

    def _document(self, step: Step, name: str) -> None:
        reads = self.wiring.sources[name]
        whole = self.stand[name] == "whole"
        spoken = {"contract": self.blocks[name].reads, "at_once": self.blocks[name].at_once, "anything": ()}
        pins = [pin for pin in reads if whole or pin in spoken[self.stand[name]]]
        rows = [f"{pin} |-> {self.expression(step, reads[pin])}" for pin in pins]
        rows += ["dt |-> dt"] if whole else []
        if rows:
            step.lets.append(f"i == [{', '.join(rows)}]")
        step.done.add(name)

    def _judge(self, step: Step) -> None:
        for rule in self.asked:
            bad = self.expression(step, rule.bad)
            if rule.once is not None and rule.after is not None:
                waits = f"{rule.name}_waits"
                armed, ends = self.expression(step, rule.after), self.expression(step, rule.once)
                step.after[waits] = step.let(f"new_{waits}", f"({waits} \\/ {armed}) /\\ ~{ends}")
                bad = f"(new_{waits} /\\ {bad})"
            step.lets.append(f"bad_{rule.name} == {bad}")

    def expression(self, step: Step, tree: Expression) -> str:
        """An expression as this step reads it. Raises Unjudged for what a wire does not have."""
        match tree:
            case Value(value, _, _) if isinstance(value, bool):
                return "TRUE" if value else "FALSE"
            case Name(name, _) if name in self.wiring.table.inputs and not step.number:
                return f"helper!Rest.{name}"
            case Name(name, _) if name in self.wiring.table.inputs:
                self._site(name, step.number, False)
                if self.sites_known and step.number == self._first(name):
                    step.chosen[name] = None
                    return f"new_{name}"
                return name
            case Name(name, _) if name in self.wiring.signals:
                return step.let(name, self.expression(step, self.wiring.signals[name]))
            case Name(name, _) if name in self.wiring.shown:
                return step.let(name, self.expression(step, self.wiring.shown[name]))
            case Member(Name(name, _), pin, _) if name in self.blocks:
                if pin not in self.blocks[name].pins:
                    kind = self.wiring.table.block[name].of
                    raise self.wiring.refuse(
                        f"block.{name}", f"the contract of {kind} does not speak of {pin}"
                    )
                self.seen[name].add(pin)
                if name in step.done:
                    return f"({name}').{pin}"
                self._site(name, step.number, not self._called(name, step))
                return f"{name}.{pin}"
            case Member(Name(name, _), pin, _) if name in self.wiring.table.block or name in self.observers:
                if not step.number:
                    return f"{name}_Q1" if pin == "Q1" else "FALSE"
                self.read.add(name)
                if name in step.done:
                    return f"new_{name}_{pin}"
                order = [*self.wiring.table.order, *self.needed]
                self._site(name, step.number, not self._called(name, step))
                assert name in order
                return f"{name}_{pin}"
            case Unary("NOT", operand, _):
                return f"~{self.expression(step, operand)}"
            case Binary("AND" | "OR" as word, left, right, _):
                sign = "/\\" if word == "AND" else "\\/"
                return f"({self.expression(step, left)} {sign} {self.expression(step, right)})"
        raise Unjudged(f"{tree.place.file}: the model has no {shown(tree)!r}: values of BOOL only")

    def _called(self, name: str, step: Step) -> bool:
        """Whether a standard block was called in a step before this one."""
        order = [*self.wiring.table.order, *self.needed]
        if not step.standard and not step.document:
            return True
        first = step.standard[0] if step.standard else step.document
        return order.index(name) < order.index(first)

    # ------------------------------------------------------------ how long a value is kept

    def _site(self, name: str, number: int, late: bool) -> None:
        if not self.sites_known:
            self.sites.setdefault(name, []).append((number, late))

    def _first(self, name: str) -> int:
        return min(number for number, _ in self.sites[name])

    def lives(self, name: str, number: int) -> bool:
        """Whether a value is read after this step: later in the scan, or in the next one."""
        return any(late or site > number for site, late in self.sites.get(name, ()))

    @cached_property
    def kept(self) -> dict[str, str]:
        """Each variable of the wires and what it is at power-up."""
        found = {}
        for name, row in self.wiring.table.inputs.items():
            if name in self.sites and self.lives(name, self._first(name)):
                found[name] = "FALSE" if row.type == "BOOL" else "0"
        for step in self.steps:
            found |= dict.fromkeys(step.after, "FALSE")
        return found

    def shown(self, name: str, row: str) -> str:
        """What is kept of a row of a block: of one without memory the outputs that are read."""
        if self.stand[name] not in LOOSE:
            return row
        return f"[{', '.join(f'{pin} |-> {row}.{pin}' for pin in sorted(self.seen[name]))}]"

    def forgotten(self, step: Step) -> dict[str, str]:
        """The variables that nothing reads after this step and that it does not set, and what they become."""
        table, found = self.wiring.table, dict[str, str]()
        for name, stand in self.stand.items():
            if (
                stand in LOOSE
                and name in self.blocks
                and name != step.document
                and not self.lives(name, step.number)
            ):
                found[name] = self.shown(name, f"{name}_is!Start")
        for name, start in self.kept.items():
            block = name.removesuffix(
                "_Q1" if self.stand.get(name.removesuffix("_Q1")) == "anything" else "_Q"
            )
            value = name if name in table.inputs else block
            wire = name in table.inputs or (name != block and block in {*table.block, *self.needed})
            if wire and name not in {*step.after, *step.chosen} and not self.lives(value, step.number):
                found[name] = start
        return found


def _needed(
    observers: Mapping[str, Mapping[str, Any]], asked: Sequence[Asked], wiring: Wiring
) -> Iterator[str]:
    """The observers that these properties read, and those that they read, in the order of the file."""
    place, found = Place("safety.toml", 1), set[str]()
    trees = [tree for rule in asked for tree in (rule.bad, rule.after, rule.once) if tree is not None]
    while trees:
        for name in set(leaves(trees.pop())) & set(observers) - found:
            found.add(name)
            trees += [parsed(text, place) for text in observers[name]["inputs"].values()]
    yield from (name for name in observers if name in found)

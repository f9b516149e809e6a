"""The machine as a TLA+ module, from the data of a wiring.

A scan is a row of steps in the order of the calls. A step calls standard blocks and then one block of a
document; the last one also lets the observers look and judges the properties. A block of a document stands in
it by its contract (`<name>Contract`), by the part of it that needs no memory, as a whole (`<name>Shows`), or
as anything whatsoever. An input is chosen in the step that reads it first, and forgotten after the one that
reads it last. Nothing is taken from the steps in Python. spec/machine_cell/blocks.toml says how a block is
called.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import Entry, Text, typed
from programs.questions import parsed
from programs.tree import Binary, Expression, Member, Name, Place, Unary
from programs.tree import Literal as Value
from programs.wiring import Wiring
from programs.wiring import names as leaves

As = Literal["contract", "at_once", "whole", "anything"]
"""By its contract, by the part of it that needs no memory, as a whole, or as anything whatsoever."""
CONTRACT: As = "contract"
LOOSE = ("at_once", "anything")
PINS = {"R_TRIG": "Q", "F_TRIG": "Q", "SR": "Q1", "RS": "Q1"}
"""The output of each standard block that the model has."""


class Block(Entry, frozen=True, kw_only=True):
    """How the model calls a block of a document; blocks.toml says what each key means."""

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
    """The file."""

    block: dict[str, Block]


def read_blocks(path: Path) -> Mapping[str, Block]:
    """How the model calls the blocks, by their names in capitals. Raises Unjudged."""
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {error}") from None
    return {name.upper(): row for name, row in typed(Blocks, {"block": table}, str(path)).block.items()}


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
    """The properties of a file without those that have a time; only those that are wanted, if any are."""
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
    return found


@dataclass
class _Step:
    """A step of the scan: standard blocks, then a block of a document (none in the last one)."""

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
    ) -> None:
        """`stand` says how a block stands in it, where it is not by its contract; `held` are inputs that keep
        a value. Raises Unjudged.
        """
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

    def _scan(self) -> list[_Step]:
        steps, following = [_Step(1)], list(self.needed)
        for name in self.wiring.table.order:
            if name in self.blocks:
                steps[-1].document = name
                steps.append(_Step(len(steps) + 1))
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

    def _pin(self, name: str, pin: str) -> Expression:
        if name in self.observers:
            return parsed(self.observers[name]["inputs"][pin], self._place)
        return self.wiring.sources[name][pin]

    _place = Place("safety.toml", 1)

    def _kind(self, name: str) -> str:
        row = self.observers[name]["of"] if name in self.observers else self.wiring.table.block[name].of
        return str(row).upper()

    def _call(self, step: _Step, name: str) -> None:
        kind = self._kind(name)
        variable = f"{name}_{PINS[kind]}"
        if self.stand.get(name) == "anything":
            step.done.add(name)
            if self.sites_known and name in self.read:
                step.free.append(f"new_{variable}")
            if self._lives(name, step.number):
                step.after[variable] = f"new_{variable}"
            return

        def pin(at: str) -> str:
            return self._text(step, self._pin(name, at))

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
        if kind in ("SR", "RS") or self._lives(name, step.number):
            step.after[variable] = f"new_{variable}"
        step.done.add(name)

    def _document(self, step: _Step, name: str) -> None:
        reads = self.wiring.sources[name]
        whole = self.stand[name] == "whole"
        spoken = {"contract": self.blocks[name].reads, "at_once": self.blocks[name].at_once, "anything": ()}
        pins = [pin for pin in reads if whole or pin in spoken[self.stand[name]]]
        rows = [f"{pin} |-> {self._text(step, reads[pin])}" for pin in pins]
        rows += ["dt |-> dt"] if whole else []
        if rows:
            step.lets.append(f"i == [{', '.join(rows)}]")
        step.done.add(name)

    def _judge(self, step: _Step) -> None:
        for one in self.asked:
            bad = self._text(step, one.bad)
            if one.once is not None and one.after is not None:
                waits = f"{one.name}_waits"
                text = f"({waits} \\/ {self._text(step, one.after)}) /\\ ~{self._text(step, one.once)}"
                step.after[waits] = step.let(f"new_{waits}", text)
                bad = f"(new_{waits} /\\ {bad})"
            step.lets.append(f"bad_{one.name} == {bad}")

    def _text(self, step: _Step, tree: Expression) -> str:
        """An expression as this step reads it. Raises Unjudged for what a wire does not have."""
        match tree:
            case Value(value, _, _) if isinstance(value, bool):
                return "TRUE" if value else "FALSE"
            case Name(name, _) if name in self.wiring.table.inputs:
                self._site(name, step.number, False)
                if self.sites_known and step.number == self._first(name):
                    step.chosen[name] = None
                    return f"new_{name}"
                return name
            case Name(name, _) if name in self.wiring.signals:
                return step.let(name, self._text(step, self.wiring.signals[name]))
            case Name(name, _) if name in self.wiring.shown:
                return step.let(name, self._text(step, self.wiring.shown[name]))
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
                self.read.add(name)
                if name in step.done:
                    return f"new_{name}_{pin}"
                order = [*self.wiring.table.order, *self.needed]
                self._site(name, step.number, not self._called(name, step))
                assert name in order
                return f"{name}_{pin}"
            case Unary("NOT", operand, _):
                return f"~{self._text(step, operand)}"
            case Binary("AND" | "OR" as word, left, right, _):
                sign = "/\\" if word == "AND" else "\\/"
                return f"({self._text(step, left)} {sign} {self._text(step, right)})"
        raise Unjudged(f"{self._place.file}: the model has no {tree!r}")

    def _called(self, name: str, step: _Step) -> bool:
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

    def _lives(self, name: str, number: int) -> bool:
        """Whether a value is read after this step: later in the scan, or in the next one."""
        return any(late or site > number for site, late in self.sites.get(name, ()))

    @cached_property
    def kept(self) -> dict[str, str]:
        """Each variable of the wires and what it is at power-up."""
        found = {}
        for name, row in self.wiring.table.inputs.items():
            if name in self.sites and self._lives(name, self._first(name)):
                found[name] = "FALSE" if row.type == "BOOL" else "0"
        for step in self.steps:
            found |= dict.fromkeys(step.after, "FALSE")
        return found

    def _forgotten(self, step: _Step) -> dict[str, str]:
        """The variables that nothing reads after this step and that it does not set, and what they become."""
        table, found = self.wiring.table, dict[str, str]()
        for name, stand in self.stand.items():
            if (
                stand in LOOSE
                and name in self.blocks
                and name != step.document
                and not self._lives(name, step.number)
            ):
                found[name] = self._shown(name, f"{name}_is!Start")
        for name, start in self.kept.items():
            block = name.removesuffix(
                "_Q1" if self.stand.get(name.removesuffix("_Q1")) == "anything" else "_Q"
            )
            value = name if name in table.inputs else block
            wire = name in table.inputs or (name != block and block in {*table.block, *self.needed})
            if wire and name not in {*step.after, *step.chosen} and not self._lives(value, step.number):
                found[name] = start
        return found

    # ------------------------------------------------------------ as text

    def text(self, module: str, comment: Sequence[str] = ()) -> str:
        """The module."""
        return "\n".join(self._lines(module, comment)) + "\n"

    def _lines(self, module: str, comment: Sequence[str]) -> Iterator[str]:
        yield f"{'-' * 20} MODULE {module} {'-' * 20}"
        yield from (f"\\* {line}" for line in comment)
        yield "EXTENDS Integers"
        yield "CONSTANT Words    \\* the words that are tried"
        rows = [name for name in self.blocks if self.stand[name] != "whole"]
        whole = [name for name in self.blocks if self.stand[name] == "whole"]
        inner = [f"{name}_{variable}" for name in whole for variable in self.blocks[name].variables]
        variables = ["at", "broken", *rows, *inner, *(["step"] if whole else []), *self.kept]
        yield "VARIABLES"
        yield "    at,        \\* the step of the scan that comes next"
        yield "    broken,    \\* what was found broken in the step before"
        yield f"    {', '.join(variables[2:])}"
        yield f"vars == <<{', '.join(variables)}>>"
        for name in rows:
            yield f"{name}_is == INSTANCE {self.blocks[name].name}Contract"
        for name in whole:
            yield from self._instance(name)
        yield ""
        yield "Init =="
        yield "    /\\ at = 1 /\\ broken = {}"
        yield from (f"    /\\ {name} = {self._shown(name, f'{name}_is!Start')}" for name in rows)
        yield from (f"    /\\ {name}_is!Starts" for name in whole)
        if whole:
            yield '    /\\ step = ""'
        yield from (f"    /\\ {name} = {start}" for name, start in self.kept.items())
        for step in self.steps:
            yield ""
            yield from self._step(step, variables)
        yield ""
        yield "Next == " + " \\/ ".join(f"Step{step.number}" for step in self.steps)
        yield "Spec == Init /\\ [][Next]_vars"
        yield ""
        if whole and self.held:
            same = ", ".join(f"{name} <- {name}" for name in whole)
            yield "\\* The same with the contracts of the blocks that are whole here"
            yield f"Over == INSTANCE {module}Over WITH {same}"
            yield "IsOverContracts == Over!Spec"
        yield "\\* What each contract assumes is true wherever the block is called"
        for name in self.blocks:
            yield f'Assumes_{name} == "{name}" \\notin broken'
        for one in self.asked:
            yield f'{one.name} == "{one.id}" \\notin broken'
        yield "=" * 77

    def _instance(self, name: str) -> Iterator[str]:
        block, row = self.blocks[name], self.wiring.table.block[name]
        constants = dict(block.constants)
        for pin, value in row.parameters.items():
            if pin in constants and not isinstance(value, int):
                constants[pin] = f'"{value}"'
            elif isinstance(value, bool) and pin in constants:
                constants[pin] = str(value).upper()
        given = [f"{key} <- {value}" for key, value in constants.items()]
        given += ["RECORD_STEPS <- FALSE", "step <- step"]
        given += [f"{variable} <- {name}_{variable}" for variable in block.variables]
        yield f"{name}_is == INSTANCE {block.name}Shows WITH {', '.join(given)}"
        yield f"{name}_keeps == INSTANCE {block.name}Contract"
        yield f"{name} == {name}_is!Row"

    def _step(self, step: _Step, variables: Sequence[str]) -> Iterator[str]:
        name, after, last = step.document, dict(step.after), step is self.steps[-1]
        stand = self.stand[name]
        chosen = [f"new_{at} \\in {self._values(at)}" for at in step.chosen]
        chosen += [f"{free} \\in BOOLEAN" for free in step.free]
        chosen += [f"dt \\in 0..{self.blocks[name].ticks}"] if stand == "whole" else []
        for at in step.chosen:
            if at in self.kept and self._lives(at, step.number):
                after[at] = f"new_{at}"
        after |= self._forgotten(step)
        changed = {"at", "broken", *after, name}
        yield f"Step{step.number} =="
        yield f"    /\\ at = {step.number} /\\ at' = {1 if last else step.number + 1}"
        lead = "    "
        if chosen:
            yield f"    /\\ \\E {', '.join(chosen)} :"
            lead = "       "
        if step.before:
            yield from _let(step.before, lead if chosen else f"{lead}/\\ ")
            lead = "       "
        assumed = "TRUE"
        if stand == "contract":
            yield f"{lead}/\\ \\E row \\in {name}_is!Rows :"
            yield f"{lead}      {name}_is!Guarantees({name}, i, row) /\\ {name}' = row"
            assumed = f"{name}_is!Assumes({name}, i)"
        elif stand in LOOSE:
            rows = f"{name}_is!Rows"
            if stand == "at_once":
                rows = f"{{row \\in {rows} : {name}_is!AtOnce(i, row)}}"
            yield f"{lead}/\\ {name}' \\in {{{self._shown(name, 'row')} : row \\in {rows}}}"
        else:
            yield f"{lead}/\\ {name}_is!Call(i)"
            changed |= {"step", *(f"{name}_{variable}" for variable in self.blocks[name].variables)}
            assumed = f"{name}_keeps!Assumes({name}, i)"
        if step.lets:
            yield from _let(step.lets, f"{lead}/\\ ")
            lead = "          "
        found = [f'(IF bad_{one.name} THEN {{"{one.id}"}} ELSE {{}})' for one in self.asked if last]
        fine = " \\cup ".join(found) or "{}"
        yield f'{lead}/\\ broken\' = IF {assumed} THEN {fine} ELSE {{"{name}"}}'
        yield from (f"{lead}/\\ {key}' = {value}" for key, value in after.items())
        yield f"{lead}/\\ UNCHANGED <<{', '.join(key for key in variables if key not in changed)}>>"

    def _shown(self, name: str, row: str) -> str:
        """What is kept of a row of a block: of one without memory the outputs that are read."""
        if self.stand[name] not in LOOSE:
            return row
        return f"[{', '.join(f'{pin} |-> {row}.{pin}' for pin in sorted(self.seen[name]))}]"

    def _values(self, name: str) -> str:
        if name in self.held:
            return f"{{{self.held[name]}}}"
        return "BOOLEAN" if self.wiring.table.inputs[name].type == "BOOL" else "Words"


def _let(lines: Sequence[str], lead: str) -> Iterator[str]:
    """Names for values. A set of one value, because TLC works out a LET anew wherever its name stands."""
    for line in lines:
        name, _, text = line.partition(" == ")
        yield f"{lead}\\E {name} \\in {{{text}}} :"
        lead = " " * len(lead)


def _needed(
    observers: Mapping[str, Mapping[str, Any]], asked: Sequence[Asked], wiring: Wiring
) -> Iterator[str]:
    """The observers that these properties read, and those that they read, in the order of the file."""
    place, found = Place("safety.toml", 1), set[str]()
    trees = [tree for one in asked for tree in (one.bad, one.after, one.once) if tree is not None]
    while trees:
        for name in set(leaves(trees.pop())) & set(observers) - found:
            found.add(name)
            trees += [parsed(text, place) for text in observers[name]["inputs"].values()]
    yield from (name for name in observers if name in found)

"""The runs of TLC for a machine: module, cfg and what is expected, from spec/machine_cell/tlc.toml."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from machines.concrete_runs import read_use
from machines.missing_names import lacking
from machines.own_machine import refuse_own
from machines.tla_model import As, Asked, Block, asked_of, read_blocks
from machines.tla_module import Module
from machines.verdicts import Machine
from machines.wiring import Wiring, read_wiring
from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import Count, Entry, Text, only_keys, typed_rows


class Row(Entry, frozen=True, kw_only=True):
    """A row of tlc.toml; the file says what each key means."""

    id: Text
    keeps: str = ""
    needs: str = ""
    permits: str = ""
    assumes: tuple[Text, ...] = ()
    properties: tuple[Text, ...] = ()
    anything: tuple[Text, ...] = ()
    at_once: tuple[Text, ...] = ()
    whole: tuple[Text, ...] = ()
    free: tuple[Text, ...] | None = None
    rests: str = ""
    helped: str = ""
    words: Text = "{0}"
    counts: tuple[Count, Count] | None = None
    """States of TLC with the shipped wiring: distinct, generated."""

    @property
    def distinct(self) -> int | None:
        """The first of them."""
        return self.counts[0] if self.counts else None

    @property
    def generated(self) -> int | None:
        """The second."""
        return self.counts[1] if self.counts else None


@dataclass(frozen=True)
class Task:
    """What TLC is to run: the files by their names, the invariants and temporal formulas that it checks."""

    id: str
    files: Mapping[str, str]
    checks: tuple[str, ...]
    breaks: bool
    """Whether it must be refuted."""
    distinct: int | None
    generated: int | None


def tasks(
    file: Path | None, folder: Path, properties: Path | None = None, use: Path | None = None
) -> Iterator[Task]:
    """The runs for a wiring (None: the shipped one). Raises Unjudged."""
    path, source = folder / "tlc.toml", file or folder / "wiring.toml"
    wiring = read_wiring(source)
    names = str(source), properties or folder / "safety.toml", use or folder / "use.toml"
    machine = Machine(source.read_text("utf-8"), *names, leave_out=properties is None)
    table = _looked_at(machine)
    blocks, rest = read_blocks(path), read_use(machine.use).rest
    try:
        declared = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {error}") from None
    only_keys(str(path), declared, ("run", "block"))
    if not declared.get("run"):
        raise Unjudged(f"{path}: declares no run")
    rows = typed_rows(Row, str(path), declared, "run")
    for row in rows:
        name = row.rests or row.keeps or row.needs
        if name and name.upper() not in blocks:
            raise Unjudged(f"{path}: {row.id}: no block {name!r} in it")
        if row.rests:
            yield _rested(row, blocks[name.upper()])
        elif name:
            yield _kept(row, blocks[name.upper()])
        else:
            yield _cell(row, wiring, blocks, table, str(machine.properties), rest)


def _looked_at(machine: Machine) -> Mapping[str, Any]:
    """The file of properties with its observers. Raises Unjudged with file, line and cause."""
    refuse_own(machine, "a TLA+ module")
    lost = lacking(machine.wiring, machine.observers, machine.every)
    for row in () if machine.leave_out else machine.every.rows:
        if name := lost.get(row["id"]):
            raise machine.every.place(row).refuse(f"{row['id']}: {machine.file} has no {name!r}")
    assert machine.cell is not None  # each observer has its pins
    return {**machine.every.tables, "property": machine.every.rows}


def model_of(machine: Machine, folder: Path) -> str:
    """The module of a wiring over the contracts of its blocks, with every property that has no time.

    Those that name what the wiring has not are left out, as in a judgement. Raises Unjudged.
    """
    _looked_at(machine)
    there = {name: {"of": row.of, "inputs": row.inputs} for name, row in machine.watched.rows.items()}
    asked = asked_of({"property": machine.questions.rows}, str(machine.properties))
    model = Module(machine.wiring, read_blocks(folder / "tlc.toml"), there, asked)
    title = f"{machine.wiring.table.title}, over the contracts of its blocks."
    left = [f"Left out, for the wiring has no {lost}: {id}." for id, lost in machine.lacking.items()]
    left += [f"Left out, for the machine has {why}: {id}." for id, why in machine.not_asked.items()]
    return model.text("MachineCell", (title, *MADE, *left))


CALLS = 8
"""After so many calls a block that nobody touches rests."""
ANYTHING: As = "anything"
AT_ONCE: As = "at_once"
WHOLE: As = "whole"
MADE = ("Made by `modeproof machine --model FILE` from a wiring. Our own design: no claim about a paper.",)


def _cell(
    row: Row,
    wiring: Wiring,
    blocks: Mapping[str, Block],
    table: Mapping[str, Any],
    safety: str,
    rest: Mapping[str, Any],
) -> Task:
    asked: list[Asked] = asked_of(table, safety, row.properties)
    stand: dict[str, As] = {}
    stand |= dict.fromkeys(row.anything, ANYTHING)
    stand |= dict.fromkeys(row.at_once, AT_ONCE)
    stand |= dict.fromkeys(row.whole, WHOLE)
    for name in (*stand, *row.assumes):
        if name not in wiring.table.block:
            raise wiring.refuse("block", f"tlc.toml: {row.id} speaks of a block {name!r}, which is not there")
    held = {} if row.free is None else _held(wiring, rest, row.free)
    observers = table.get("observer", {})
    model = Module(wiring, blocks, observers, asked, stand, held, row.helped)
    checks = [*(f"Assumes_{name}" for name in row.assumes), *(rule.name for rule in asked)]
    checks += ["GoalIsReached"] if row.helped else []
    cfg = f"CONSTANT Words = {row.words}\nSPECIFICATION Spec\nINVARIANTS {' '.join(checks)}\n"
    files = {"Cell.tla": model.text("Cell"), "Cell.cfg": cfg}
    if row.whole and row.free is not None:
        over = {name: how for name, how in stand.items() if how != WHOLE}
        files["CellOver.tla"] = Module(wiring, blocks, observers, asked, over, held).text("CellOver")
        files["Cell.cfg"] += "PROPERTY IsOverContracts\n"
        checks.append("IsOverContracts")
    return Task(row.id, files, tuple(checks), False, row.distinct, row.generated)


def _held(wiring: Wiring, rest: Mapping[str, Any], free: tuple[str, ...]) -> dict[str, str]:
    """The inputs that are not free, each with its value at rest as TLA+."""
    values = {name: rest.get(name, False) for name, row in wiring.table.inputs.items() if row.type == "BOOL"}
    values |= {name: 0 for name, row in wiring.table.inputs.items() if row.type == "WORD"}
    return {name: str(value).upper() for name, value in values.items() if name not in free}


def _rested(row: Row, block: Block) -> Task:
    variables = ", ".join(block.variables)
    lines = [
        "---- MODULE Rested ----",
        f"EXTENDS {block.name}Shows",
        "VARIABLE calls",
        f"C == INSTANCE {block.name}Contract",
        'Init == Starts /\\ step = "" /\\ calls = 0',
        "AnyCall == calls = 0 /\\ (\\E i \\in Inputs : C!Assumes(Row, i) /\\ Call(i)) /\\ UNCHANGED calls",
        f"RestCall == calls < {CALLS} /\\ (\\E i \\in RestInputs : Call(i)) /\\ calls' = calls + 1",
        f"Spec == Init /\\ [][AnyCall \\/ RestCall]_<<{variables}, step, calls>>",
        f"ComesToRest == calls = {CALLS} => Rests",
        "====",
    ]
    return _task(row, block, lines, ("ComesToRest",), False)


def _kept(row: Row, block: Block) -> Task:
    variables = ", ".join(block.variables)
    permitted = "C!Assumes(Row, i) /\\ " if row.keeps else f"{row.permits or 'TRUE'} /\\ "
    lines = [
        "---- MODULE Kept ----",
        f"EXTENDS {block.name}Shows",
        "VARIABLES in, beat",
        f"C == INSTANCE {block.name}Contract",
        'Init == Starts /\\ step = "" /\\ beat = FALSE /\\ in = <<>>',
        f"Next == \\E i \\in Inputs : {permitted}Call(i) /\\ in' = i /\\ beat' = ~beat",
        f"Spec == Init /\\ [][Next]_<<{variables}, step, in, beat>>",
        f"View == <<{variables}>>",
        "HasARow == Row \\in C!Rows /\\ (in = <<>> => Row = C!Start)",
        "Keeps == [][C!Guarantees(Row, in', Row')]_beat",
        f"Besides == [][{block.besides or 'TRUE'}]_beat",
        "====",
    ]
    checks = ("HasARow", "Keeps", "Besides") if row.keeps else ("Keeps",)
    return _task(row, block, lines, checks, bool(row.needs))


def _task(row: Row, block: Block, lines: list[str], checks: tuple[str, ...], breaks: bool) -> Task:
    """A run of one block. A cfg has no place for a function, so each constant gets its value by a name."""
    name = lines[0].split()[2]
    values = [f"Value_{key} == {value}" for key, value in block.constants.items()]
    cfg = ["CONSTANT RECORD_STEPS = FALSE", *(f"CONSTANT {key} <- Value_{key}" for key in block.constants)]
    cfg += ["SPECIFICATION Spec", *(["VIEW View"] if "Keeps" in checks else [])]
    cfg += [f"{'PROPERTY' if check in ('Keeps', 'Besides') else 'INVARIANT'} {check}" for check in checks]
    text = "\n".join([*lines[:2], *values, *lines[2:]])
    files = {f"{name}.tla": f"{text}\n", f"{name}.cfg": "\n".join(cfg) + "\n"}
    return Task(row.id, files, checks, breaks, row.distinct, row.generated)

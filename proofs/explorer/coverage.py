"""How much of a step its feasible paths pass through: lines, branches, and outcomes of each guard.

Of every feasible path one member is run in the plain interpreter, so what these runs pass through is not
dead. All members of a path take the same way; so, with the claim that the paths are exhaustive, what is never
passed through is unreachable for every input in range. Each such place must be explained in the document's
register `strength.toml` (rows `unreached`), and the register may explain nothing else.
"""

from __future__ import annotations

import ast
import inspect
import sys
import textwrap
import tomllib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path as File
from types import CodeType, FrameType, FunctionType
from typing import Any

import z3

from proofs.explorer import lint
from proofs.explorer.device import Device, Scan, scans
from proofs.explorer.errors import ExplorationError
from proofs.explorer.explore import Path, Place
from proofs.explorer.records import plain

Line = tuple[str, int]
Branch = tuple[str, int, bool]
"""File, line of the `if`, and whether its block is entered."""


@dataclass(frozen=True)
class Coverage:
    """What the feasible paths of a step pass through, and all that there is."""

    device: str
    states: int
    paths: int
    functions: Mapping[Line, str]
    """The function that each line belongs to."""
    lines: frozenset[Line]
    passed_lines: frozenset[Line]
    branches: frozenset[Branch]
    passed_branches: frozenset[Branch]
    guards: frozenset[tuple[str, Place, bool]]
    """For each control state and each question asked in it: both answers."""
    passed_guards: frozenset[tuple[str, Place, bool]]

    def figures(self) -> str:
        """One line: how many of how many."""
        return (
            f"lines {len(self.passed_lines)} of {len(self.lines)}, "
            f"branches {len(self.passed_branches)} of {len(self.branches)}, "
            f"answers of guards by control state {len(self.passed_guards)} of {len(self.guards)}"
        )

    def missing(self) -> tuple[str, ...]:
        """Everything that no path passes, by name: the function and the text, so that it survives a move."""
        lines = [
            f"line {self.functions[line]}: {_text(*line)}" for line in sorted(self.lines - self.passed_lines)
        ]
        branches = [
            f"branch {self.functions[file, line]}: {_text(file, line)} {_word(entered)}"
            for file, line, entered in sorted(self.branches - self.passed_branches)
        ]
        guards = [
            f"guard {control}: {place.function}: {_text(place.file, place.line, place.columns)}: "
            f"{_word(answer)}"
            for control, place, answer in self.guards - self.passed_guards
        ]
        return (*lines, *branches, *sorted(guards))


def _word(answer: bool) -> str:
    return "yes" if answer else "no"


@cache
def _source(file: str) -> tuple[str, ...]:
    return tuple(File(file).read_text(encoding="utf-8").splitlines())


def _text(file: str, line: int, columns: tuple[int, int] | None = None) -> str:
    text = _source(file)[line - 1]
    return text.split("  #")[0].strip() if columns is None else text[slice(*columns)]


@dataclass(frozen=True)
class Explained:
    """The lines that no path of a device passes, with their reasons, and the faults in the explanations."""

    coverage: Coverage
    reasons: tuple[tuple[str, str], ...]
    unexplained: tuple[str, ...]
    idle: tuple[str, ...]
    """Explained, and yet passed, or not there at all."""


def explained(device: Device, register: File) -> Explained:
    """The coverage of a device beside what `register` says of it. Raises ExplorationError."""
    rows = _rows(register)
    coverage = coverage_of(device)
    missing = coverage.missing()
    reasons = {what: row["why"] for row in rows if device.name in row["devices"] for what in row["places"]}
    return Explained(
        coverage,
        tuple((what, reasons[what]) for what in missing if what in reasons),
        tuple(what for what in missing if what not in reasons),
        tuple(what for what in reasons if what not in missing),
    )


def _rows(register: File) -> list[dict[str, Any]]:
    """The rows `unreached`: devices, places and why, none of them empty. Raises ExplorationError."""
    try:
        rows: list[dict[str, Any]] = tomllib.loads(register.read_text(encoding="utf-8"))["unreached"]
    except (OSError, tomllib.TOMLDecodeError, KeyError) as error:
        raise ExplorationError(f"{register.name} cannot be read: {error!r}") from None
    for number, row in enumerate(rows, start=1):
        if set(row) != {"devices", "places", "why"} or not all(row.values()):
            raise ExplorationError(f"{register.name}: row {number} must have devices, places and why")
    return rows


def coverage_of(device: Device) -> Coverage:
    """Run a member of every path from every control state, and watch what runs."""
    reach = lint.reach_of(device.module.step, stand_ins=[stand_in.name for stand_in in device.stand_ins])
    reach.refuse_faults()
    explored = scans(device)
    watch = Watch({function.__code__ for function in reach.functions})
    asked: dict[tuple[str, Place], set[bool]] = defaultdict(set)
    for scan in explored:
        for path in scan.paths:
            _run_member(device, scan, path, watch)
            for place, answer in path.asked:
                asked[scan.control.value, place].add(answer)
    branches = frozenset(
        (file, line, entered)
        for function in reach.functions
        for file, line, _, _ in _ifs(function)
        for entered in (True, False)
    )
    functions = {line: function.__qualname__ for function in reach.functions for line in _lines(function)}
    return Coverage(
        device.name,
        len(explored),
        sum(len(scan.paths) for scan in explored),
        functions,
        frozenset(functions),
        frozenset(watch.lines),
        branches,
        frozenset(branch for function in reach.functions for branch in _passed(function, watch.arcs)),
        frozenset((control, place, answer) for control, place in asked for answer in (True, False)),
        frozenset((control, place, answer) for (control, place), found in asked.items() for answer in found),
    )


def _run_member(device: Device, scan: Scan, path: Path, watch: Watch) -> None:
    """Run the example of a path in the plain interpreter, watched. Raises ExplorationError if it raises."""
    state, inputs = plain(scan.state, path.example), plain(scan.inputs, path.example)
    with answering(device, path.example):
        try:
            with watch:
                device.module.step(state, inputs)
        except Exception as error:
            if type(error) is not type(path.raised):
                raise ExplorationError(
                    f"{device.name}: a member of a path from {scan.control.value} raises {error!r}"
                ) from error


@contextmanager
def answering(device: Device, model: z3.ModelRef) -> Iterator[None]:
    """Replace the stand-ins of the device by their answers in the example."""
    before = [(each.module, each.name, getattr(each.module, each.name)) for each in device.stand_ins]
    try:
        for stand_in in device.stand_ins:
            answer = plain(stand_in.answer, model)
            setattr(stand_in.module, stand_in.name, lambda *_, answer=answer: answer)
        yield
    finally:
        for module, name, function in before:
            setattr(module, name, function)


class Watch:
    """Notes the lines of some functions as they run, and which line followed which."""

    def __init__(self, codes: set[CodeType]) -> None:
        self.codes = codes
        self.lines: set[Line] = set()
        self.arcs: set[tuple[CodeType, int, int]] = set()
        self.last: dict[FrameType, int] = {}

    def __enter__(self) -> None:
        self.before = sys.gettrace()
        sys.settrace(self._called)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self.before)

    def _called(self, frame: FrameType, event: str, argument: Any) -> Any:
        return self._moved if frame.f_code in self.codes else None

    def _moved(self, frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line":
            self.lines.add((frame.f_code.co_filename, frame.f_lineno))
            self.arcs.add((frame.f_code, self.last.get(frame, 0), frame.f_lineno))
            self.last[frame] = frame.f_lineno
        elif event == "return":
            self.last.pop(frame, None)
        return self._moved


def _lines(function: FunctionType) -> Iterator[Line]:
    """The lines of a function that can run: all with code but that of `def` itself."""
    for _, _, line in function.__code__.co_lines():
        if line is not None and line != function.__code__.co_firstlineno:
            yield function.__code__.co_filename, line


def _ifs(function: FunctionType) -> Iterator[tuple[str, int, range, range]]:
    """Each `if` of a function: file, line, the lines of its condition, the lines of its block."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    ast.increment_lineno(tree, function.__code__.co_firstlineno - 1)
    for node in ast.walk(tree):
        if isinstance(node, ast.If):
            condition = range(node.lineno, (node.test.end_lineno or node.lineno) + 1)
            block = range(node.body[0].lineno, (node.body[-1].end_lineno or node.lineno) + 1)
            yield function.__code__.co_filename, node.lineno, condition, block


def _passed(function: FunctionType, arcs: set[tuple[CodeType, int, int]]) -> Iterator[Branch]:
    moves = [(start, end) for code, start, end in arcs if code is function.__code__]
    for file, line, condition, block in _ifs(function):
        for start, end in moves:
            if start in condition and end not in condition:
                yield file, line, end in block

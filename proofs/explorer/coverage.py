"""How much of a step its feasible paths pass through: lines, branches, and outcomes of each guard.

Every run of the explorer is a run of the code on a feasible path, so what its runs pass through is not dead.
What they never pass through is listed, line by line, for a person to judge: with the claim that the paths are
exhaustive, it is unreachable for every input in range.
"""

from __future__ import annotations

import ast
import inspect
import sys
import textwrap
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path as File
from types import CodeType, FrameType, FunctionType
from typing import Any

from proofs.explorer import lint
from proofs.explorer.device import Device, explored_from
from proofs.explorer.explore import Place

Line = tuple[str, int]
Branch = tuple[str, int, bool]
"""File, line of the `if`, and whether its block is entered."""


@dataclass(frozen=True)
class Coverage:
    """What the feasible paths of a step pass through, and all that there is."""

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

    def missing_lines(self) -> tuple[str, ...]:
        """Each line that no path passes: file:line: its text."""
        missing = sorted(self.lines - self.passed_lines)
        return tuple(f"{File(file).name}:{line}: {_text(file, line)}" for file, line in missing)


def _text(file: str, line: int) -> str:
    return File(file).read_text(encoding="utf-8").splitlines()[line - 1].strip()


def coverage_of(device: Device) -> Coverage:
    """Explore the device anew, from every control state, and watch what runs."""
    reach = lint.reach_of(device.module.step, stand_ins=[one.name for one in device.stand_ins])
    reach.refuse_faults()
    watch = _Watch({function.__code__ for function in reach.functions})
    asked: dict[tuple[str, Place], set[bool]] = defaultdict(set)
    with watch:
        for control in device.module.Step:
            for path in explored_from(device, control).paths:
                for one in path.decisions:
                    asked[control.value, one.place].add(one.answer)
    branches = frozenset(
        (file, line, entered)
        for function in reach.functions
        for file, line, _, _ in _ifs(function)
        for entered in (True, False)
    )
    passed = {branch for function in reach.functions for branch in _passed(function, watch.arcs)}
    return Coverage(
        frozenset(line for function in reach.functions for line in _lines(function)),
        frozenset(watch.lines),
        branches,
        frozenset(passed),
        frozenset((control, place, answer) for control, place in asked for answer in (True, False)),
        frozenset((control, place, answer) for (control, place), found in asked.items() for answer in found),
    )


class _Watch:
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

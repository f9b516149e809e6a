"""Whether a vector file is what it says: schema, counts, unique ids, values within their types."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator

from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal
from modeproof.kit.vectors import Case, Suite, open_suite, read_lines
from modeproof.suites.complete import Track, gaps

LARGEST = 20_000_000
"""Bytes of a file, as it is stored."""
EVERY = 50
"""The schema is applied to the first so many cases and then to each so many-th; the other checks to all."""


def lint(path: Path, every: int = EVERY) -> list[str]:
    """What is wrong with a vector file, one line each; nothing when it is in order.

    An id that does not belong to its inputs, or another number of cases than the header says, is found too.
    """
    problems: list[str] = []
    try:
        suite = open_suite(path)
        problems += _against(suite.header, "header", "header")
        problems += _shapes(path, every)
        tracks = _Tracks(suite)
        problems += _cases(suite, tracks)
        problems += tracks.gaps()
    except Unjudged as error:
        problems.append(str(error))
    return problems


def _schema() -> dict[str, Any]:
    text = resources.files("modeproof.suites").joinpath("vectors.schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def _against(row: Mapping[str, Any], part: str, place: str) -> list[str]:
    schema = _schema()
    checker = Draft202012Validator({"$ref": f"#/$defs/{part}", "$defs": schema["$defs"]})
    return [_line(place, error.json_path, error.message) for error in checker.iter_errors(row)]


def _shapes(path: Path, every: int) -> list[str]:
    checker = Draft202012Validator({"$ref": "#/$defs/case", "$defs": _schema()["$defs"]})
    problems = []
    for number, line in enumerate(read_lines(path), 1):
        if number > 1 and (number <= every or number % every == 0):
            try:
                row = json.loads(line)
            except ValueError:
                break  # reading the cases says so
            for error in checker.iter_errors(row):
                problems.append(_line(f"line {number}", error.json_path, error.message))
    if path.stat().st_size > LARGEST:
        problems.append(f"{path.stat().st_size:,} bytes, more than {LARGEST:,}")
    return problems


def _line(place: str, where: str, message: str) -> str:
    return f"{place}: {where}: {message[:200]}"


def _cases(suite: Suite, tracks: _Tracks) -> list[str]:
    problems: list[str] = []
    ids: set[str] = set()
    scans = 0
    good: set[tuple[str, str]] = set()
    for case in suite.cases():
        if case.id in ids:
            problems.append(f"{case.id}: the id is there twice")
        ids.add(case.id)
        scans += sum(scan.request is None for scan in case.scans)
        if case.basis == "document" and not case.clauses and any(step.clauses for step in suite.steps):
            problems.append(f"{case.id}: no clause is cited")
        if not any(scan.compared or scan.request for scan in case.scans):
            problems.append(f"{case.id}: every scan is settling, so nothing is compared")
        problems += _values(suite, case, good)
        tracks.add(case)
    if scans != suite.scan_count:
        problems.append(f"{scans} scans, the header says {suite.scan_count}")
    return problems


class _Tracks:
    """What the completeness of a suite is judged by, graph by graph (see modeproof.suites.complete)."""

    def __init__(self, suite: Suite) -> None:
        self._about: list[Mapping[str, Any]] = [
            graph.get("complete", {}) if isinstance(graph, Mapping) else {}
            for graph in suite.header.get("graphs", [])
        ]
        self._tracks: list[list[Track]] = [[] for _ in self._about]
        self._codes = frozenset(suite.codes)
        self._numbers: dict[str, int] = {}

    def add(self, case: Case) -> None:
        """Keep a case of a graph for which completeness is claimed."""
        about = self._about[case.graph]
        if not about:
            return
        track, number_of = Track(), about["number_of"]
        before: Mapping[str, Any] | None = None
        number = 0
        for scan in case.scans:
            if scan.outputs != before:
                before = scan.outputs
                seen = [output for output in scan.outputs.items() if output[0] not in self._codes]
                text = repr(sorted(seen))
                number = self._numbers.setdefault(text, len(self._numbers))
            track.add(scan.column, number, number_of[scan.to])
        self._tracks[case.graph].append(track)

    def gaps(self) -> list[str]:
        """What a program is still free to do that passes and has no more states than the header says."""
        return [
            f"graph {number}: not complete: {gap}"
            for number, (about, tracks) in enumerate(zip(self._about, self._tracks, strict=True))
            if about
            for gap in gaps(tracks, about["states"], about["columns"])
        ]


def _values(suite: Suite, case: Case, good: set[tuple[str, str]]) -> list[str]:
    problems = []
    for number, scan in enumerate(case.scans, 1):
        if scan.request is not None:
            continue
        for signals, values in ((suite.inputs, scan.inputs), (suite.outputs, scan.outputs)):
            for name, value in values.items():
                key = (name, repr(value))
                if key not in good:
                    problem = _fault(signals, name, value)
                    if problem:
                        problems.append(f"{case.id}, scan {number}: {problem}")
                    else:
                        good.add(key)
    return problems


def _fault(signals: Mapping[str, Signal], name: str, value: Any) -> str:
    return signals[name].fault(value) if name in signals else f"no signal {name!r}"

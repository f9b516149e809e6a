"""Walks through a graph in a tenth of the room that gzip needs for them.

Of each scan only its column is stored where it is. Its input comes from the list of the inputs of this
column, in the order of their use, which repeats itself; its step and the state after it are those of state
and column; its outputs are those of that state, and where that is not enough, of that input. A file in which
this is not so is refused, and stays as it is. Ids are made again from what goes in.

The form: a line of JSON with the lengths of the parts, then the parts, each packed with LZMA: the header, the
cases without their scans, the rows of inputs and of outputs, and five tables of numbers of four bytes, column
by column.
"""

from __future__ import annotations

import json
import sys
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.ids import case_id

FORM = "modeproof-compact-1"
LARGEST_PART = 1 << 28
"""Bytes of a part when it is unpacked."""
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode
_SCAN = {"dt_ms", "in", "out", "step", "to", "column"}
_WIDTHS = (1, 3, 1, 5, 4)
"""How many numbers a row of each table has."""


def compact(lines: Iterable[bytes]) -> bytes:
    """The lines of a vector file in this form. Raises ValueError for a file that it is not for."""
    rows = iter(lines)
    header = next(rows)
    about = json.loads(header)
    target, initial = about["target"], [graph["initial"] for graph in about["graphs"]]
    cases: list[dict[str, Any]] = []
    letters, outputs = _Rows(), _Rows()
    columns: list[tuple[int, ...]] = []
    used: dict[tuple[int, int], list[int]] = {}
    moves: dict[tuple[int, int, int], tuple[int, int]] = {}
    plain: dict[tuple[int, int, int], int] = {}
    shown: dict[tuple[int, int, int], int] = {}
    for line in rows:
        case = json.loads(line)
        graph, scans = case["graph"], case.pop("scans")
        if any(set(scan) != _SCAN for scan in scans):
            raise ValueError("a scan of another kind")
        if case["id"] == case_id(target, case["params"], [(scan["dt_ms"], scan["in"]) for scan in scans]):
            del case["id"]
        cases.append({**case, "scans": len(scans)})
        state = initial[graph]
        now_in: Mapping[str, Any] = {}
        now_out: Mapping[str, Any] = {}
        for scan in scans:
            now_in, now_out = {**now_in, **scan["in"]}, {**now_out, **scan["out"]}
            column, move = scan["column"], (scan["step"], scan["to"])
            columns.append((column,))
            letter = letters.number([scan["dt_ms"], now_in])
            used.setdefault((graph, column), []).append(letter)
            if moves.setdefault((graph, state, column), move) != move:
                raise ValueError("one state and column lead to two states")
            state, row = scan["to"], outputs.number(now_out)
            if plain.setdefault((graph, state, 0), row) != row:
                plain[graph, state, 0] = -1
            if shown.setdefault((graph, state, letter + 1), row) != row:
                raise ValueError("one state and input show two rows of outputs")
    if -1 not in plain.values():
        shown = plain
    tables: list[Sequence[tuple[int, ...]]] = [
        columns,
        [(*key, len(used[key])) for key in sorted(used)],
        [(letter,) for key in sorted(used) for letter in used[key]],
        [(*key, *moves[key]) for key in sorted(moves)],
        [(*key, shown[key]) for key in sorted(shown)],
    ]
    lzma = _lzma()
    texts = [header, _ENCODE(cases).encode(), _ENCODE(letters.rows).encode(), _ENCODE(outputs.rows).encode()]
    parts = [lzma.compress(part, preset=6) for part in [*texts, *map(_bytes, tables)]]
    return b"".join([_ENCODE({"form": FORM, "parts": [*map(len, parts)]}).encode(), b"\n", *parts])


def expand(data: bytes) -> Iterator[dict[str, Any]]:
    """The rows of the file, the header first, as JSON would give them. Raises Unjudged for other bytes."""
    try:
        yield from _expanded(data)
    except (
        ValueError,
        KeyError,
        IndexError,
        TypeError,
        AttributeError,
        EOFError,
        _lzma().LZMAError,
    ) as error:
        raise Unjudged(f"not a compact vector file: {type(error).__name__} {error}") from None


def _expanded(data: bytes) -> Iterator[dict[str, Any]]:
    start = data.index(b"\n") + 1
    about = json.loads(data[:start])
    if about["form"] != FORM:
        raise ValueError(f"form {about['form']}")
    parts = []
    for length in about["parts"]:
        unpacked = _lzma().LZMADecompressor()
        parts.append(unpacked.decompress(data[start : start + length], LARGEST_PART))
        if not unpacked.eof:
            raise ValueError(f"a part that is cut off, or has more than {LARGEST_PART:,} bytes")
        start += length
    header, cases, letters, outputs = map(json.loads, parts[:4])
    columns, uses, order, moves, shown = (
        _numbers(part, width) for part, width in zip(parts[4:], _WIDTHS, strict=True)
    )
    yield header
    at: dict[tuple[int, int], int] = {}
    first = 0
    for graph, column, count in zip(*uses, strict=True):
        at[graph, column] = first
        first += count
    move = {(g, s, c): (step, to) for g, s, c, step, to in zip(*moves, strict=True)}
    row_of = {(g, s, letter): row for g, s, letter, row in zip(*shown, strict=True)}
    by_letter = any(shown[2])
    initial = [graph["initial"] for graph in header["graphs"]]
    changes: dict[tuple[int, int], Mapping[str, Any]] = {}
    letter_of, done = order[0], 0
    for case in cases:
        graph, scans = case["graph"], []
        state, letter, row = initial[graph], -1, -1
        for column in columns[0][done : done + case["scans"]]:
            key = (graph, column)
            before, letter = letter, letter_of[at[key]]
            at[key] += 1
            step, state = move[graph, state, column]
            row_before, row = row, row_of[graph, state, letter + 1 if by_letter else 0]
            if (before, letter) not in changes:
                changes[before, letter] = _changed(
                    letters[before][1] if before >= 0 else {}, letters[letter][1]
                )
            scans.append(
                {
                    "dt_ms": letters[letter][0],
                    "in": changes[before, letter],
                    "out": _changed(outputs[row_before] if row_before >= 0 else {}, outputs[row])
                    if row != row_before
                    else {},
                    "step": step,
                    "to": state,
                    "column": column,
                }
            )
        done += len(scans)
        going_in = [(scan["dt_ms"], scan["in"]) for scan in scans]
        yield {"id": case_id(header["target"], case["params"], going_in), **case, "scans": scans}


def _changed(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in now.items() if name not in before or before[name] != value}


class _Rows:
    """Different values, numbered as they come."""

    def __init__(self) -> None:
        self.rows: list[Any] = []
        self._at: dict[str, int] = {}

    def number(self, value: Any) -> int:
        """Its number; a new one for a new value."""
        key = _ENCODE(value)
        if key not in self._at:
            self._at[key] = len(self.rows)
            self.rows.append(value)
        return self._at[key]


def _bytes(rows: Sequence[tuple[int, ...]]) -> bytes:
    """Column by column, little end first."""
    text = b""
    for column in zip(*rows, strict=True):
        numbers = array("I", column)
        if sys.byteorder == "big":
            numbers.byteswap()
        text += numbers.tobytes()
    return text


def _numbers(part: bytes, width: int) -> list[array[int]]:
    numbers = array("I")
    numbers.frombytes(part)
    if sys.byteorder == "big":
        numbers.byteswap()
    length, rest = divmod(len(numbers), width)
    if rest:
        raise ValueError("a table with half a row")
    return [numbers[n * length : (n + 1) * length] for n in range(width)]


def _lzma() -> Any:
    try:
        import lzma
    except ImportError:
        raise Unjudged("this Python was built without lzma, which the large suites need") from None
    return lzma


def same(lines: Iterable[bytes], data: bytes) -> bool:
    """Whether the compact form gives the rows of these lines."""
    return all(json.loads(line) == row for line, row in zip(lines, expand(data), strict=True))

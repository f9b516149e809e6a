"""Logs that somebody has mutated: read, or refused in one line that no terminal obeys."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.trace.lines import LONGEST_LINE, read_lines
from modeproof.trace.log import Log
from modeproof.trace.log_module import Reading
from modeproof.trace.table import read_table
from modeproof.trace.targets import find_target
from tests.trace.judging import LOGS

ODD: tuple[Any, ...] = (
    None, True, -1, 0.5, 1e308, 10**30, 2**63, int("9" * 4000), "", "\x1b[2J", "\u202e", "\ud800", "A" * 5000,
    [], [[]], {}, {"a": {}}, "NaN", [1, "x"], "0000 ", "-0",
)  # fmt: skip
TEXTS = (
    "1e999999", "9" * 5000, "-1", "\x1b]0;x\x07", "\u202e", "16#", "1;2", '"', "", "NaN", "inf", "\0", "1,5",
    "٣", "²", "W#16#FFFFF", "# T_ON_ms = 9", "\r", "\x85", "\u2028", "{1 2}", "0x",
)  # fmt: skip


def mutated_lines(text: str, chance: random.Random) -> bytes:
    """One or two values or keys of a log as JSON Lines are something odd, or some bytes are."""
    lines = text.splitlines()
    for _ in range(chance.randint(1, 2)):
        at = chance.randrange(len(lines))
        try:
            row = json.loads(lines[at])
        except ValueError:
            continue
        side = chance.choice([row, *(one for one in row.values() if isinstance(one, dict))])
        name = chance.choice([*side, *side, "in", "params", "\x1b[1m", "\u202ename", "T_ON_ms"])
        side[name] = chance.choice(ODD)
        try:
            lines[at] = json.dumps(row, ensure_ascii=chance.random() < 0.7)
        except ValueError:  # more digits than Python writes
            lines[at] = lines[at].replace("0", "9" * 5000, 1)
    return broken("\n".join(lines) + "\n", chance)


def mutated_table(text: str, chance: random.Random) -> bytes:
    """One or two cells of a table are something odd, or some bytes are."""
    lines = text.splitlines()
    for _ in range(chance.randint(1, 2)):
        at = chance.randrange(min(12, len(lines)))
        cells = lines[at].split(";")
        cells[chance.randrange(len(cells))] = chance.choice(TEXTS)
        lines[at] = ";".join(cells)
    return broken("\n".join(lines) + "\n", chance)


def broken(text: str, chance: random.Random) -> bytes:
    """The text as bytes, now and then with other bytes in it or without its end."""
    content = bytearray(text.encode("utf-8", "surrogatepass"))
    kind = chance.random()
    if kind < 0.1:
        for _ in range(3):
            content[chance.randrange(len(content))] = chance.randrange(256)
    elif kind < 0.15:
        del content[chance.randrange(len(content)) :]
    return bytes(content)


@pytest.mark.sampled
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("target", "name", "mutate", "read"),
    [
        ("fplc", "fplc_good.jsonl", mutated_lines, read_lines),
        ("fplc", "fplc_good.csv", mutated_table, read_table),
        ("key_flows", "key_flows_good.jsonl", mutated_lines, read_lines),
    ],
)
def test_a_mutated_log_is_read_or_refused_in_one_line(
    target: str,
    name: str,
    mutate: Callable[[str, random.Random], bytes],
    read: Callable[..., Log],
    seed: int,
    tmp_path: Path,
) -> None:
    of, text = find_target(root(), target), "\n".join((LOGS / name).read_text().splitlines()[:40])
    chance, refused = random.Random(seed), 0
    path = tmp_path / "log"
    for _ in range(200):
        path.write_bytes(mutate(text, chance))
        try:
            reading = Reading(of, read(path, of), {})
            for row, _ in reading.log.rows.kinds():
                reading.line(row, {})
        except Unjudged as error:
            refused += 1
            assert error.message.isprintable() and len(error.message) <= 4000, ascii(error.message)
            assert str(path) in error.message
    assert refused > 50


def test_a_line_of_megabytes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text('{"dt_ms":' + "1" * (LONGEST_LINE + 5) + "}\n")
    with pytest.raises(Unjudged, match="line 1: longer than 1,048,576 bytes"):
        read_lines(path, find_target(root(), "fplc"))


def test_foreign_text_of_a_log_does_not_reach_the_terminal(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_ms;LA;\x1b]0;owned\x07\u202e\n0;1;1\n")
    with pytest.raises(Unjudged) as refused:
        read_table(path, find_target(root(), "fplc"))
    assert refused.value.message.isprintable() and "x1b]0" in refused.value.message

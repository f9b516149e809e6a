"""Suite `wp1`: as `wp`, for a program with one state more than the graph, over a few columns.

For each state of the graph, and each sequence of at most two columns of the sub-alphabet after it, every
sequence that tells the state it leads to from others. Any two states share a sequence, or the beginning of
one, that tells them apart (harmonized identifiers), so that places of the program are told from each other
and not from the graph's states alone. A program with at most n + 1 states that passes answers every sequence
of the sub-alphabet rightly, after the way to each state: the argument of the W-method for one extra state.
The cases are made while they are judged (modeproof.kit.rule); the file holds the table.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.kit import rule as kit_rule
from modeproof.suites.identify import Machine, Word, between, machine, separating_columns

MOST_COLUMNS = 8
MOST_SCANS = 3_000_000
"""The sub-alphabet has so many columns at most, as many as keep the suite of a graph below these scans."""


def rule(device: DeviceGraph, columns: Columns) -> dict[str, Any]:
    """The table and the rule of one graph, for its entry in the header."""
    graph = device.graph
    seen = machine(columns, device.seen, graph.initial)
    identify = harmonized(seen, separating_columns(seen))
    chosen = sub_alphabet(seen, identify)
    used = dict.fromkeys(
        [*chosen, *(c for way in seen.cover for c in way), *(c for of in identify for w in of for c in w)]
    )
    at = {column: n for n, column in enumerate(used)}
    letters = [columns.members[column][0] for column in used]
    wire = [device.wire_outputs(device.expected(s, device.alphabet[0])) for s in range(len(device.rows))]
    return {
        "sub": len(chosen),
        "letters": [
            [device.alphabet[n]["dt_ms"], device.wire_inputs(device.alphabet[n]), column]
            for n, column in zip(letters, used, strict=True)
        ],
        "next": [[row[n] for n in letters] for row in graph.next_of],
        "step": [[row[n] for n in letters] for row in graph.step_of],
        "rows": wire,
        "passed": dict(device.passed),
        "cover": _ways(seen, columns, graph.initial, at),
        "identify": [[[at[c] for c in word] for word in identify[n]] for n in seen.number_of],
        "states": len(seen.next_of),
        "extra_states": 1,
    }


def _ways(seen: Machine, columns: Columns, initial: int, at: dict[int, int]) -> list[list[int] | None]:
    """The way to one of the states of the graph that outputs do not tell apart; none to the others."""
    ways: list[list[int] | None] = [None] * len(columns.next_of)
    for way in seen.cover:
        state = initial
        for column in way:
            state = columns.next_of[state][column]
        ways[state] = [at[column] for column in way]
    return ways


def harmonized(of: Machine, chosen: Sequence[int]) -> list[tuple[Word, ...]]:
    """For each state words; any two states have a beginning of words in common that tells them apart."""
    states = range(len(of.next_of))
    order = _telling(of, chosen)
    needed: list[dict[int, int]] = [{} for _ in states]
    for one in states:
        for other in range(one):
            for n, word in enumerate(order):
                length = of.apart_at(one, other, word)
                if length:
                    for state in (one, other):
                        needed[state][n] = max(length, needed[state].get(n, 0))
                    break
    return [tuple(order[n][:length] for n, length in sorted(row.items())) or ((),) for row in needed]


def _telling(of: Machine, chosen: Sequence[int]) -> list[Word]:
    """Words that together tell all states apart, the one that tells most first."""
    states = range(len(of.next_of))
    answers: dict[Word, list[Word]] = {(one,): _answers(of, (one,)) for one in chosen}
    now = [0] * len(of.next_of)
    found: list[Word] = []
    while len(set(now)) < len(now):
        best = max(answers, key=lambda word: len({(now[s], answers[word][s]) for s in states}))
        told = len({(now[s], answers[best][s]) for s in states})
        if told == len(set(now)):
            first: dict[int, int] = {}
            one, other = next((first[n], s) for s, n in enumerate(now) if first.setdefault(n, s) != s)
            best = between(of, chosen, one, other)
            answers[best] = _answers(of, best)
        found.append(best)
        numbers: dict[object, int] = {}
        now = [numbers.setdefault((now[s], answers[best][s]), len(numbers)) for s in states]
    return found


def _answers(of: Machine, word: Word) -> list[tuple[int, ...]]:
    found = []
    for first in range(len(of.next_of)):
        state, outs = first, []
        for column in word:
            outs.append(of.out_of[state][column])
            state = of.next_of[state][column]
        found.append(tuple(outs))
    return found


def sub_alphabet(of: Machine, identify: Sequence[Sequence[Word]]) -> list[int]:
    """Columns that lead on to most states, as many as the limits allow and one at least."""
    reached = [{state} for state in range(len(of.next_of))]
    found: list[int] = []
    while len(found) < min(MOST_COLUMNS, len(of.columns)):
        left = [column for column in of.columns if column not in found]
        best = max(
            left, key=lambda c: sum(row[c] not in seen for row, seen in zip(of.next_of, reached, strict=True))
        )
        if found and _scans(of, identify, len(found) + 1) > MOST_SCANS:
            break
        found.append(best)
        for row, seen in zip(of.next_of, reached, strict=True):
            seen.add(row[best])
    return found


def _scans(of: Machine, identify: Sequence[Sequence[Word]], width: int) -> int:
    """About how many scans a sub-alphabet of so many columns needs."""
    middles = sum(int(width**n) for n in range(kit_rule.STEPS + 1))
    words = sum(map(len, identify)) / len(identify)
    length = sum(len(word) for row in identify for word in row) / max(1, sum(map(len, identify)))
    way = sum(map(len, of.cover)) / len(of.cover)
    return round(len(of.cover) * middles * words * (way + kit_rule.STEPS + length))

"""Suite `wp` leaves no program of n states any freedom; what judges that is sound, and finds what lacks."""

from __future__ import annotations

import gzip
import itertools
import json
from array import array
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from modeproof.graph.columns import Columns, merge_columns
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import open_suite
from modeproof.suites.complete import Track, gaps
from modeproof.suites.identify import Identifiers, Machine, Word, machine, separating_columns
from modeproof.suites.lint import lint
from modeproof.suites.wp import walks, words
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.programs import starter
from tests.suites.relay import relay_graph

Table = tuple[tuple[tuple[int, int], ...], ...]
"""For each state and column the outputs and the next state."""


def every_machine(states: int, columns: int, outputs: int) -> Iterator[Table]:
    """All machines with so many states, numbered from 0 for power-up."""
    cells = list(itertools.product(range(outputs), range(states)))
    for flat in itertools.product(cells, repeat=states * columns):
        yield tuple(flat[n * columns : (n + 1) * columns] for n in range(states))


def answers(table: Table, word: Word) -> list[int]:
    state, found = 0, []
    for column in word:
        out, state = table[state][column]
        found.append(out)
    return found


def same(one: Table, other: Table) -> bool:
    """Whether no sequence of columns tells two machines apart."""
    seen = {(0, 0)}
    queue = [(0, 0)]
    for a, b in queue:
        for (out_a, next_a), (out_b, next_b) in zip(one[a], other[b], strict=True):
            if out_a != out_b:
                return False
            if (next_a, next_b) not in seen:
                seen.add((next_a, next_b))
                queue.append((next_a, next_b))
    return True


def as_machine(table: Table) -> Machine | None:
    """The machine when all its states are reached and told apart, else None.

    A graph shows outputs by states, so each pair of outputs and next state becomes a state of a graph first.
    """
    start = (-1, 0)
    states = [start]
    for state in states:
        states += [cell for cell in dict.fromkeys(table[state[1]]) if cell not in states]
    at = {state: n for n, state in enumerate(states)}
    columns = Columns(
        members=tuple((n,) for n in range(len(table[0]))),
        step_of=tuple(array("l", [0] * len(table[0])) for _ in states),
        next_of=tuple(array("l", [at[cell] for cell in table[state[1]]]) for state in states),
    )
    found = machine(columns, [state[0] for state in states], 0)
    return found if len(found.next_of) == len(table) else None


def tracks(of: Machine, cases: Sequence[Word]) -> list[Track]:
    found = []
    for word in cases:
        track, state = Track(), 0
        for column in word:
            out, state = of.out_of[state][column], of.next_of[state][column]
            track.add(column, out, state)
        found.append(track)
    return found


def judged(of: Machine, cases: Sequence[Word]) -> list[str]:
    return gaps(tracks(of, cases), len(of.next_of), len(of.columns))


TWO = [(table, found) for table in every_machine(2, 2, 2) if (found := as_machine(table)) is not None]
LETTERS_3 = list(every_machine(3, 2, 2))
tables = st.lists(
    st.lists(st.tuples(st.integers(0, 1), st.integers(0, 2)), min_size=2, max_size=2).map(tuple),
    min_size=3,
    max_size=3,
).map(tuple)


def test_there_are_machines_to_try() -> None:
    assert len(TWO) == 144 and len(LETTERS_3) == 46_656


@pytest.mark.parametrize("part", range(4))
def test_of_machines_of_two_states_only_right_ones_pass(part: int) -> None:
    for table, found in TWO[part::4]:
        cases = words(found)
        assert judged(found, cases) == []
        wanted = [answers(table, word) for word in cases]
        for other in every_machine(2, 2, 2):
            passes = all(answers(other, word) == good for word, good in zip(cases, wanted, strict=True))
            assert passes == same(table, other)


@pytest.mark.deep
@settings(max_examples=40, deadline=None)
@given(tables)
def test_no_wrong_machine_of_three_states_passes(table: Table) -> None:
    found = as_machine(table)
    assume(found is not None)
    assert found is not None
    cases = words(found)
    assert judged(found, cases) == []
    wanted = [(word, answers(table, word)) for word in sorted(cases, key=len)]
    for other in LETTERS_3:
        if all(answers(other, word) == good for word, good in wanted):
            assert same(table, other)


@pytest.mark.deep
@settings(max_examples=150, deadline=None)
@given(st.sampled_from(TWO), st.data())
def test_cases_that_are_judged_complete_let_no_wrong_machine_pass(
    chosen: tuple[Table, Machine], data: st.DataObject
) -> None:
    """Soundness of the judge, with cases of any kind: it never calls complete what lets a wrong one pass."""
    table, found = chosen
    word = st.lists(st.integers(0, 1), min_size=1, max_size=7).map(tuple)
    cases = data.draw(st.lists(word | st.sampled_from(words(found)), min_size=1, max_size=9))
    wrong = [
        other
        for other in every_machine(2, 2, 2)
        if not same(table, other) and all(answers(other, one) == answers(table, one) for one in cases)
    ]
    if not judged(found, cases):
        assert not wrong


def test_power_up_must_be_told_apart_itself() -> None:
    """The states are told apart after 0 and after 0, 1; power-up is not: there 1 is never tried."""
    table = (((0, 1), (0, 0)), ((0, 1), (1, 0)))
    wrong = (((0, 0), (1, 1)), ((0, 0), (0, 1)))
    cases = [(0, 0, 1, 1, 1), (0, 1, 1), (0, 1, 0)]
    found = as_machine(table)
    assert found is not None and not same(table, wrong)
    assert all(answers(wrong, one) == answers(table, one) for one in cases)
    assert judged(found, cases) == ["no case tells the states 0 and 1 apart"]
    assert judged(found, [*cases, (1,)]) == []


@settings(max_examples=30, deadline=None)
@given(tables, st.data())
def test_a_missing_case_that_passes_a_wrong_machine_is_noticed(table: Table, data: st.DataObject) -> None:
    found = as_machine(table)
    assume(found is not None)
    assert found is not None
    cases = words(found)
    without = data.draw(st.integers(0, len(cases) - 1))
    cases = [word[:-1] if n == without else word for n, word in enumerate(cases)]
    cases = [word for word in cases if word]
    freed = judged(found, cases)
    wrong = [
        other
        for other in LETTERS_3[data.draw(st.integers(0, 6)) :: 7]
        if all(answers(other, one) == answers(table, one) for one in cases) and not same(table, other)
    ]
    assert freed or not wrong


def test_every_state_is_told_from_every_other_by_its_sequences(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    found = machine(merge_columns(graph), [str(row) for row in graph.rows], graph.graph.initial)
    for state, sequences in enumerate(Identifiers(found, separating_columns(found)).words):
        for other in range(len(found.next_of)):
            told = [found.apart_at(state, other, word) for word in sequences]
            assert any(told) == (other != state)


def test_states_that_no_output_tells_apart_count_as_one(tmp_path: Path) -> None:
    """What a relay will copy over next is no state of it that anyone could see."""
    graph = relay_graph(tmp_path)
    columns, rows = merge_columns(graph), [str(row) for row in graph.rows]
    found = machine(columns, rows, graph.graph.initial)
    assert len(found.next_of) == 6 < len(columns.next_of) == 18
    assert judged(found, words(found)) == []
    for walk in walks(columns, graph.graph.initial, rows):
        state = graph.graph.initial
        for move in walk:
            assert move.state == state
            state = columns.next_of[state][move.column]


# ------------------------------------------------------------------------------------------------ the file

WRONG_STATE = """
right = scan
def scan(m):  # a second press, right after the first one, stops the time once
    again = on and elapsed == 0 and m["dt_ms"] == 250 and m["in"]["press"] and same(m["in"]["word"])
    return right({**m, "dt_ms": 0} if again else m)
"""


def test_a_hidden_wrong_state_passes_the_tour_but_not_wp(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    verdicts = {}
    for name in ("tour", "wp"):
        write_suite(tmp_path / name, name, [graph])
        good = run_suite(open_suite(tmp_path / name), starter(tmp_path))
        assert good.word == CONFORMS and all(have == all_ for have, all_ in good.covered.values())
        verdicts[name] = run_suite(open_suite(tmp_path / name), starter(tmp_path, WRONG_STATE))
    assert verdicts["tour"].word == CONFORMS
    assert verdicts["wp"].word == DIFFERS and verdicts["wp"].difference is not None


def test_files_say_for_whom_they_are_complete_and_lint_agrees(tmp_path: Path) -> None:
    path = tmp_path / "wp.jsonl"
    write_suite(path, "wp", [lamp_graph(tmp_path)])
    assert lint(path, every=1) == []
    about = json.loads(path.read_text(encoding="utf-8").splitlines()[0])["graphs"][0]["complete"]
    assert (about["states"], about["extra_states"], about["columns"]) == (3, 0, 6)


def test_lint_notices_each_case_of_a_walk_that_is_missing(tmp_path: Path) -> None:
    path = tmp_path / "wp.jsonl"
    write_suite(path, "wp", [lamp_graph(tmp_path)])
    header, *cases = path.read_text(encoding="utf-8").splitlines(keepends=True)
    longest = max(cases, key=len)
    rows = [row for row in cases if row != longest]
    about = json.loads(header)
    about |= {"cases": len(rows), "scans": sum(len(json.loads(row)["scans"]) for row in rows)}
    path.write_text("".join([json.dumps(about) + "\n", *rows]), encoding="utf-8")
    assert any("not complete" in problem and "not settled" in problem for problem in lint(path, every=1))


def test_lint_notices_an_untold_end_state_and_wrong_numbers(tmp_path: Path) -> None:
    path = tmp_path / "wp.jsonl"
    write_suite(path, "tour", [lamp_graph(tmp_path)])
    header, *cases = path.read_text(encoding="utf-8").splitlines(keepends=True)
    about = json.loads(header)
    about["graphs"][0]["complete"] = {"states": 3, "columns": 6, "number_of": [0, 1, 2]}
    path.write_text("".join([json.dumps(about) + "\n", *cases]), encoding="utf-8")
    assert any("not complete" in problem for problem in lint(path, every=1)), "a tour is not complete"

    write_suite(path, "wp", [lamp_graph(tmp_path)])
    for wrong, said in (
        ({"states": 4}, "come to 3 states, not to 4"),
        ({"columns": 7}, "not settled"),
        ({"number_of": [0, 2, 1]}, ""),
    ):
        text = path.read_text(encoding="utf-8")
        header, *cases = text.splitlines(keepends=True)
        about = json.loads(header)
        about["graphs"][0]["complete"] |= wrong
        spoiled = tmp_path / "spoiled.jsonl.gz"
        spoiled.write_bytes(gzip.compress("".join([json.dumps(about) + "\n", *cases]).encode()))
        problems = [one for one in lint(spoiled, every=1) if "not complete" in one and said in one]
        assert bool(problems) == bool(said), "other numbers are other names, and nothing rests on names"


def test_cases_that_contradict_each_other_are_noticed(tmp_path: Path) -> None:
    found = as_machine((((0, 1), (0, 0)), ((1, 0), (0, 1))))
    assert found is not None
    spoiled = tracks(found, words(found))
    last = spoiled[-1]
    last.outputs[-1] ^= 1
    assert gaps(spoiled, 2, 2)
    begun = tracks(found, [(0, 0), (0, 1)])
    begun[1].outputs[0] ^= 1
    assert gaps(begun, 2, 2) == ["two cases begin alike and expect different outputs"]

"""Wrong words catch a program that looks at part of a word, wherever a word decides."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.graph.columns import merge_columns
from modeproof.ground.errors import Unjudged
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import Case, Suite, open_suite
from modeproof.suites.apart import Apart
from modeproof.suites.words import wrong_words
from modeproof.suites.write import write_suite
from tests.graph.printed import CODE, lamp_graph
from tests.kit.programs import starter
from tests.suites.relay import relay_graph, relay_starter
from tests.suites.test_tour import graphs

LOW_BYTE = 'same = lambda word: word[2:] == "F0"'
HIGH_BYTE = 'same = lambda word: word[:2] == "0F"'
MASKED = "same = lambda word: int(word, 16) & 0xFBFF == 0x0BF0"


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    write_suite(tmp_path / "words.jsonl", "words", [lamp_graph(tmp_path)])
    return open_suite(tmp_path / "words.jsonl")


def wrong(case: Case) -> list[str]:
    return [scan.inputs["word"] for scan in case.scans if scan.inputs["word"] not in ("0000", "0001", "0FF0")]


def test_every_word_that_agrees_in_one_byte_only_is_tried(suite: Suite) -> None:
    tried = {int(word, 16) for case in suite.cases() for word in wrong(case)}
    half = {word for word in range(1 << 16) if (word & 0xFF == 0xF0) != (word >> 8 == 0x0F)}
    assert len(half) == 510 and half <= tried
    assert {0xF00F, 0x1FE0, 0x07F8, 0x7FFF, 0x8000, 0xFFFF} <= tried
    assert suite.header["graphs"][0]["words"]["word"]["Off"]["0FF0"] == len(tried)


def test_a_program_that_compares_the_whole_word_passes(suite: Suite, tmp_path: Path) -> None:
    assert run_suite(suite, starter(tmp_path)).word == CONFORMS


@pytest.mark.parametrize("fault", [LOW_BYTE, HIGH_BYTE, MASKED])
def test_a_program_that_compares_part_of_the_word_is_caught(suite: Suite, tmp_path: Path, fault: str) -> None:
    verdict = run_suite(suite, starter(tmp_path, fault))
    assert verdict.word == DIFFERS
    found = verdict.difference
    assert found is not None and found.confirmed and found.shortest.scans == found.case.scans[: found.scan]
    assert "no code: StayOff; a program that takes it for 0FF0 would do as SwitchOn" in found.case.why


def test_such_a_program_agrees_on_every_representative(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    words = {f"{letter['word']:04X}" for letter in graph.alphabet}
    assert {word for word in words if word[2:] == "F0"} == {"0FF0"}, "so no class representative tells them"


def test_each_case_has_one_wrong_word_and_one_sentence(suite: Suite) -> None:
    for case in suite.cases():
        assert len(wrong(case)) == 1 and wrong(case)[0] in case.why and "\n" not in case.why


@given(st.integers(0, 0xFFFF), st.integers(1, 9))
def test_control_states_share_the_half_words_and_leave_none_out(code: int, parts: int) -> None:
    shares = [set(wrong_words(code, [code], part, parts)) for part in range(parts)]
    half = {code ^ low for low in range(1, 256)} | {code ^ high << 8 for high in range(1, 256)}
    assert half <= set().union(*shares) and code not in set().union(*shares)
    for share in shares:
        assert {code ^ 1 << bit for bit in range(16)} <= share
        assert any(word & 0xFF == code & 0xFF for word in share)
        assert any(word >> 8 == code >> 8 for word in share)


def test_words_that_are_passed_on_come_out_unchanged(tmp_path: Path) -> None:
    write_suite(tmp_path / "words.jsonl", "words", [relay_graph(tmp_path)])
    suite = open_suite(tmp_path / "words.jsonl")
    seen = {word for case in suite.cases() for scan in case.scans for word in scan.inputs.values()}
    assert {f"{1 << bit:04X}" for bit in range(16)} <= seen
    assert run_suite(suite, relay_starter(tmp_path)).word == CONFORMS


@pytest.mark.parametrize(
    "fault",
    [
        'one = lambda word: "00" + word[2:]',
        "one = lambda word: word[2:] + word[:2]",
        'one = lambda word: word if word in ("0000", "33CC", "0001") else "0000"',
        'one = lambda word: f"{int(word, 16) & 0x7FFF:04X}"',
    ],
)
def test_a_relay_that_changes_words_is_caught(tmp_path: Path, fault: str) -> None:
    write_suite(tmp_path / "words.jsonl", "words", [relay_graph(tmp_path)])
    verdict = run_suite(open_suite(tmp_path / "words.jsonl"), relay_starter(tmp_path, fault))
    assert verdict.word == DIFFERS


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('words = ["33CC", "0001"]', 'words = ["33CC", "0000"]', "two words other than 0000"),
        ('words = ["33CC", "0001"]', 'words = ["33CC", "0002"]', "the alphabet lacks"),
        ('words = ["33CC", "0001"]', 'words = ["33CC", "xyz"]', "four hex digits"),
        ('fields = ["A", "B"]', 'fields = ["A", "Q"]', "'Q' is no input"),
    ],
)
def test_a_wrong_row_of_the_rule_copied_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(Unjudged, match=said):
        relay_graph(tmp_path, lambda text: text.replace(old, new))


@given(graphs(), st.data())
def test_outputs_tell_states_apart_as_soon_as_they_can(columns: object, data: st.DataObject) -> None:
    table = columns.next_of  # type: ignore[attr-defined]
    rows = data.draw(st.lists(st.integers(0, 1), min_size=len(table), max_size=len(table)))
    apart = Apart(columns, rows)  # type: ignore[arg-type]
    for one, other in itertools.combinations(range(len(table)), 2):
        found = apart.sequence(one, other)
        shortest = _shortest(table, rows, one, other)
        assert (found is None) == (shortest is None)
        if found is not None and shortest is not None:
            a, b = one, other
            for column in found:
                a, b = table[a][column], table[b][column]
            assert rows[a] != rows[b] and len(found) == shortest


def _shortest(table: list[list[int]], rows: list[int], one: int, other: int) -> int | None:
    level, seen = [(one, other)], {(one, other)}
    for length in itertools.count():
        if any(rows[a] != rows[b] for a, b in level):
            return length
        after = {(table[a][c], table[b][c]) for a, b in level for c in range(len(table[0]))} - seen
        if not after:
            return None
        seen |= after
        level = list(after)
    return None


def test_the_lamp_has_no_two_states_alike(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    apart = Apart(merge_columns(graph), [tuple(row.items()) for row in graph.rows])
    pairs = itertools.combinations(range(len(graph.rows)), 2)
    assert all(apart.sequence(one, other) is not None for one, other in pairs)
    assert CODE == 0x0FF0

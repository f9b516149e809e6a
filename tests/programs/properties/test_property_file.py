"""What is asked of a program of one's own: what cannot be judged, and what would say nothing."""

from __future__ import annotations

import pytest

from modeproof.ground.errors import Unjudged
from programs.commands.prove_properties import text_of
from programs.language.tree import Source
from programs.properties.transition_system import Cell
from programs.readers.structured_text.units import read_text
from tests.programs.properties.test_property_verdicts import asked, small, verdict


def test_a_loop_longer_than_ours_refutes_nothing() -> None:
    body = "i := 0; WHILE i < n DO i := i + 1; END_WHILE q := a;"
    with pytest.raises(Unjudged, match=r"p\.st:4: not so: the loop ends after 32 turns at most"):
        verdict(body, "never = 'q AND NOT a'", "VAR i : INT; END_VAR")


@pytest.mark.parametrize(
    ("function", "cause"),
    [
        ("VAR_INPUT x : BOOL; END_VAR f := f(x);", "f calls f: a block must not contain itself"),
        ("VAR_INPUT x : BOOL; END_VAR VAR t : TON; END_VAR f := x;", "t: a FUNCTION has plain variables"),
        ("VAR_INPUT x : ARRAY [0..1] OF BOOL; END_VAR f := TRUE;", "inputs and outputs of a FUNCTION"),
    ],
)
def test_a_function_of_a_property_is_looked_through(function: str, cause: str) -> None:
    text = (
        f"FUNCTION f : BOOL {function} END_FUNCTION\n"
        "PROGRAM P VAR_OUTPUT q : BOOL; END_VAR q := TRUE; END_PROGRAM"
    )
    source = Source({unit.name.upper(): unit for unit in read_text(text, "p.st")}, {})
    with pytest.raises(Unjudged, match=cause):
        asked("[[property]]\nid = 'x'\nsentence = 's'\nnever = 'f(q)'\n").asked(
            Cell.of(source, source.units["P"])
        )


@pytest.mark.parametrize(("once", "word"), [("TRUE", "EMPTY"), ("a OR b", "EMPTY"), ("b", "PROVED")])
def test_a_wait_that_never_begins_says_nothing(once: str, word: str) -> None:
    row = f"after = 'a'\nholds = 'q'\nonly_once = '{once}'"
    assert verdict("q := b;", row)[1].word == word


def test_a_verdict_is_written_in_one_line() -> None:
    row = 'id = "x"\nsentence = "s\\nPROVED: y"\nnever = "q\\nAND a"'
    text = "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR q := a; END_PROGRAM"
    source = Source({unit.name.upper(): unit for unit in read_text(text, "p.st")}, {})
    (one,) = asked(f"[[property]]\n{row}\n").asked(Cell.of(source, source.units["P"]))
    assert (one.sentence, one.text) == ("s PROVED: y", "never q AND a")


@pytest.mark.parametrize(
    ("row", "cause"),
    [
        ('id = "x\\ny"\nsentence = "s"\nnever = "q"', "one line is needed"),
        ('id = "x"\nsentence = "s\\u001b[2J"\nnever = "q"', "a character that cannot be printed"),
        ('id = "x"\nsentence = " "\nnever = "q"', "say it in a sentence"),
    ],
)
def test_a_text_that_hides_something_is_refused(row: str, cause: str) -> None:
    with pytest.raises(Unjudged, match=cause):
        asked(f"[[property]]\n{row}\n")


def test_a_time_that_stands_still_is_refused() -> None:
    with pytest.raises(Unjudged, match="the longest above 0"):
        verdict("q := a;", "never = 'q'", times="[0, 0]")


def test_numbers_that_wrap_are_said() -> None:
    judge = small("m := m + 1; q := a;", "holds = 'q'\nonly_if = 'a'", wrap=True)
    found = judge.all()
    assert found[0].word == "PROVED" and "no overflow" not in found[0].asked.text
    lines = list(text_of(judge.cell, found, 1))
    assert any(line.startswith("  numbers     wrap") for line in lines)


COUNT = (
    "VAR_INPUT dt_ms : {}; END_VAR VAR since : DINT; END_VAR "
    "IF a THEN since := MIN(since + dt_ms, 1000); ELSE since := 0; END_IF q := since >= 20;"
)


@pytest.mark.parametrize(("limit", "word"), [(29, "PROVED"), (18, "REFUTED")])
def test_an_input_may_have_the_time_of_the_scan(limit: int, word: str) -> None:
    row = f"after = 'a'\nwithin_ms = {limit}\nholds = 'q OR NOT a'"
    judge = small(COUNT.format("DINT"), row)
    found = judge.all()[1]
    assert found.word == word and "  dt_ms       is the time since the scan before" in text_of(
        judge.cell, [found], 1
    )
    if found.trace is not None:
        assert all(inputs["DT_MS"] == dt_ms for dt_ms, inputs in found.trace.scans)


def test_a_scan_longer_than_its_input_is_refused() -> None:
    with pytest.raises(Unjudged, match=r"p\.st:4: dt_ms holds 127 ms at most"):
        verdict(COUNT.format("SINT"), "never = 'q AND NOT a'", times="[1, 200]")

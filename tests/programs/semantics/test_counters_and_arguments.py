"""Counters, and arguments without names: by hand, and against the translator."""

from __future__ import annotations

from typing import Any

import pytest

from programs.semantics import interpreter_blocks as run_standard
from programs.semantics import terms
from tests.programs.fuzz import difference_of_text
from tests.programs.small_blocks import BOOL, END, HEAD, INT, given, ready, refusal

# ---------------------------------------------------------------- counters


def counted(block: str, pins: str, of: str, scans: str, preset: str = "2") -> list[Any]:
    """The output of a counter; each word of `scans` has a digit for `in` and for `on`."""
    kind = "INT" if of == "CV" else "BOOL"
    declared = f"VAR_OUTPUT y : {kind}; END_VAR VAR c : {block}; END_VAR"
    rows = [{"in": word[0] == "1", "on": word[1] == "1"} for word in scans.split()]
    return given(declared, f"c({pins}, PV := {preset}); y := c.{of};", rows)


def test_counters_count_edges() -> None:
    up, down = "CU := in, R := on", "CD := in, LD := on"
    assert counted("CTU", up, "CV", "10 10 00 10 00 10 11 11 10 00 10") == [1, 1, 1, 2, 2, 3, 0, 0, 0, 0, 1]
    assert counted("CTU", up, "Q", "10 10 00 10 00 11") == [False, False, False, True, True, False]
    assert counted("CTD", down, "CV", "01 10 00 10 00 10 01") == [2, 1, 1, 0, 0, -1, 2]
    assert counted("CTD", down, "Q", "00 01 10 00 10 10") == [True, False, False, False, True, True]


def test_both_edges_together_count_nothing() -> None:
    pins = "CU := in, CD := on"
    assert counted("CTUD", pins, "CV", "11 00 10 00 01 00 01 00 11 01 10") == [
        0,
        0,
        1,
        1,
        0,
        0,
        -1,
        -1,
        -1,
        -1,
        0,
    ]
    assert counted("CTUD", pins, "QU", "10 00 10 11", "1") == [True, True, True, True]
    assert counted("CTUD", pins, "QD", "00 10 00 01", "1") == [True, False, False, True]


def test_reset_goes_before_load_and_both_before_edges() -> None:
    assert counted("CTUD", "CU := in, R := on, LD := in", "CV", "10 00 10 11 00") == [2, 2, 2, 0, 0]


def test_a_counter_has_the_older_names_of_pins_too() -> None:
    assert counted("CTU", "CU := in, RESET := on", "CV", "10 00 10 01") == [1, 1, 2, 0]
    assert counted("CTD", "CD := in, LOAD := on", "CV", "01 10") == [2, 1]


@pytest.mark.parametrize(
    ("block", "first", "pins", "limit"),
    [
        ("CTU", 32766, "CU := in", 32767),
        ("CTD", -32767, "CD := in", -32768),
        ("CTUD_DINT", 2**31 - 2, "CU := in", 2**31 - 1),
    ],
)
def test_a_counter_stands_still_at_its_limit(block: str, first: int, pins: str, limit: int) -> None:
    kind = "DINT" if block.endswith("DINT") else "INT"
    text = (
        f"{HEAD}VAR_OUTPUT y : {kind}; END_VAR VAR c : {block}; END_VAR c({pins}, PV := 2); y := c.CV;{END}"
    )
    of = ready(text)
    of.memory.values["C"].values["CV"] = first
    scans = [{"x": 0, "in": number % 2 == 0, "on": False} for number in range(5)]
    assert [of.scan(inputs, 10)["y"] for inputs in scans] == [limit] * 5


def test_another_rule_for_both_edges_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = run_standard.Standard.count

    def wrong(self: Any, own: Any) -> None:
        edges = own["CU"] and own["CD"] and not self.up and not self.down
        right(self, own)
        own["CV"] += int(edges)

    monkeypatch.setattr(run_standard.Standard, "count", wrong)
    text = f"{HEAD}VAR_OUTPUT y : INT; END_VAR VAR c : CTUD; END_VAR c(CU := in, CD := on); y := c.CV;{END}"
    assert " the term gives " in difference_of_text(text, 2, 60)


def test_a_counter_without_a_limit_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = terms.BLOCKS["CTD_UDINT"]
    text = f"{HEAD}VAR_OUTPUT y : UDINT; END_VAR VAR c : CTD_UDINT; END_VAR c(CD := in); y := c.CV;{END}"
    assert difference_of_text(text, 1, 60) == ""
    other = {**terms.BLOCKS, "CTD_UDINT": (right[0], terms.BLOCKS["CTD"][1])}
    monkeypatch.setattr(terms, "BLOCKS", other)
    assert " is 0, the term gives -1" in difference_of_text(text, 1, 60)


# ---------------------------------------------------------------- arguments without names


def test_inputs_are_given_in_the_order_of_declaration() -> None:
    below = (
        "FUNCTION_BLOCK L VAR_INPUT a : INT; END_VAR VAR_INPUT b, c : INT; END_VAR VAR_OUTPUT q, r : INT; "
        "END_VAR q := a * 100 + b * 10 + c; r := a; END_FUNCTION_BLOCK\n"
    )
    declared = INT + "VAR l : L; END_VAR"
    assert given(declared, "l(x, 2, 3); y := l.q;", [{"x": 1}], below) == [123]
    assert given(declared, "l(x, 2, 3, n, y); y := y + n;", [{"x": 1}], below) == [124]
    for body, cause in (
        ("l(x, 2);", "2 arguments without names; the inputs are a, b, c"),
        ("l(x, 2, 3, n);", "4 arguments without names"),
        ("l(x, b := 2, c := 3);", "arguments with names and without"),
        ("l(a := 1, a := 2);", "a of L is given twice"),
    ):
        assert cause in refusal(declared, body, below)


def test_a_standard_block_takes_arguments_without_names() -> None:
    assert given(BOOL + "VAR t : TON; e : TIME; END_VAR", "t(in, T#10ms, y, e);", [{"in": True}] * 2) == [
        False,
        True,
    ]
    assert given(BOOL + "VAR s : SR; END_VAR", "s(in, on); y := s.Q1;", [{"in": True, "on": True}]) == [True]
    assert given(BOOL + "VAR s : RS; END_VAR", "s(in, on); y := s.Q1;", [{"in": True, "on": True}]) == [False]


def test_where_the_order_is_in_doubt_names_are_needed() -> None:
    lent = (
        "FUNCTION_BLOCK L VAR_INPUT a : INT; END_VAR VAR_IN_OUT b : INT; END_VAR b := a; END_FUNCTION_BLOCK\n"
    )
    mixed = (
        "FUNCTION_BLOCK L VAR_OUTPUT q : INT; END_VAR VAR_INPUT a : INT; END_VAR q := a; END_FUNCTION_BLOCK\n"
    )
    assert "has VAR_IN_OUT, or outputs before inputs" in refusal(INT + "VAR l : L; END_VAR", "l(x, n);", lent)
    assert "outputs before inputs" in refusal(INT + "VAR l : L; END_VAR", "l(x);", mixed)

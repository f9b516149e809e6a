"""What is asked of a program of one's own: what cannot be judged, and what would say nothing."""

from __future__ import annotations

import pytest

from modeproof.ground.errors import Unjudged
from programs.cell import Cell
from programs.st import read_text
from programs.tree import Source
from tests.programs.test_cell import asked, verdict


def test_a_loop_longer_than_ours_refutes_nothing() -> None:
    body = "i := 0; WHILE i < n DO i := i + 1; END_WHILE q := a;"
    with pytest.raises(Unjudged, match=r"p\.st:4: not so: the loop ends after 32 turns at most"):
        verdict(body, "never = 'q AND NOT a'", "VAR i : INT; END_VAR")


@pytest.mark.parametrize(
    ("function", "cause"),
    [
        ("VAR_INPUT x : BOOL; END_VAR f := f(x);", "f calls f: a block must not contain itself"),
        ("VAR_INPUT x : BOOL; END_VAR VAR t : TON; END_VAR f := x;", "t: a FUNCTION has inputs and plain"),
        ("VAR_INPUT x : ARRAY [0..1] OF BOOL; END_VAR f := TRUE;", "inputs and result of a FUNCTION"),
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

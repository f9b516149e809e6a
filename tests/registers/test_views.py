"""A view contains every variable whose value before a step a checked property reads, or a row says why."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.registers.cfg import Cfg
from modeproof.registers.made import Replacement
from modeproof.registers.tla import scan
from modeproof.registers.views import hidden_reads

TOY = """---- MODULE Toy ----
VARIABLES state, step, in, beat
View == state
Seen == [n |-> in]
Safe == [][step' = "Go" => state' = Other(in')]_beat
First == step = "" => state = 0 /\\ beat \\in BOOLEAN
Turns == [][step' = "Go" => step = "Stop"]_beat
Through == Seen.n = 1
====
"""
AS_PRINTED = """---- MODULE ToyAsPrinted ----
EXTENDS Toy
Seen_Anew == [n |-> beat]
====
"""
SPEC = "spec/door/"


@pytest.mark.parametrize(
    ("checked", "hidden"),
    [("Safe", set()), ("First", {"beat"}), ("Turns", {"step"}), ("Through", {"in"}), ("PrintAll", set())],
)
def test_a_hidden_variable_is_found_unless_primed(checked: str, hidden: set[str]) -> None:
    module = scan(TOY, "Toy", "Toy.tla")
    assert hidden_reads({"Toy": module}, "Toy", Cfg(properties=(checked,), view="View")) == hidden
    assert hidden_reads({"Toy": module}, "Toy", Cfg(properties=(checked,))) == set()


def test_what_a_reading_reads_is_in_the_view() -> None:
    modules = {"Toy": scan(TOY, "Toy", "Toy.tla"), "ToyAsPrinted": scan(AS_PRINTED, "ToyAsPrinted", "A.tla")}
    anew = Replacement("Anew", "Seen", "Seen_Anew", "ToyAsPrinted", "")
    assert hidden_reads(modules, "Toy", Cfg(properties=("Through",), view="View"), (anew,)) == {"beat"}


def test_a_view_that_hides_what_is_checked_needs_a_reason(tree: Any) -> None:
    cfg = "CONSTANTS T_HOLD = 2  LITERAL = {}\nSPECIFICATION Spec\nINVARIANT OpenIsUnlocked\n"
    tree.write(SPEC + "models/MC_Latch.cfg", f"{cfg}VIEW CODE\n")
    expected = "MC_Latch: its view CODE hides latchState, which a checked property reads"
    assert any(expected in line for line in tree.problems())
    runs = (tree.root / SPEC / "runs.toml").read_text(encoding="utf-8")
    tree.write(SPEC + "runs.toml", f'hidden.latchState = "it does not move"\n{runs}')
    assert not any("latchState" in line for line in tree.problems())
    tree.write(SPEC + "models/MC_Latch.cfg", cfg)
    assert any("hidden.latchState: no view hides it" in line for line in tree.problems())

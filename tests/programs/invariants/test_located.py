"""An invariant by places holds in every scan, and excludes nothing that happens."""

from __future__ import annotations

import time
from typing import Any

import pytest
import z3

from programs.invariants import induction as search
from programs.invariants.induction import System, induction, is_inductive, shortest, spacer
from programs.invariants.located import Located

STATE, WAITED, SEEN, GIVEN = z3.Int("state"), z3.Int("waited"), z3.BitVec("seen", 16), z3.BitVec("given", 16)


def course(steps: int) -> System:
    """A word is kept in state 0; after `steps` scans in state 1 it stays in state 2."""
    waits = z3.And(STATE == 1, steps > WAITED)
    after = {
        "state": z3.If(STATE == 0, z3.IntVal(1), z3.If(waits, z3.IntVal(1), z3.IntVal(2))),
        "waited": z3.If(STATE == 0, z3.IntVal(0), z3.If(WAITED < 40, WAITED + 1, z3.IntVal(40))),
        "seen": z3.If(STATE == 0, GIVEN, SEEN),
        "kept": z3.If(STATE == 0, GIVEN, z3.BitVec("kept", 16)),
    }
    zero = z3.BitVecVal(0, 16)
    start: dict[str, Any] = {"state": z3.IntVal(0), "waited": z3.IntVal(0), "seen": zero, "kept": zero}
    state = {"state": STATE, "waited": WAITED, "seen": SEEN, "kept": z3.BitVec("kept", 16)}
    true = z3.BoolVal(True)
    return System(state, {"given": GIVEN}, start, after, true, true, z3.And(STATE >= 0, WAITED >= 0))


def found(system: System) -> list[z3.BoolRef]:
    located = Located(system, ["state"])
    located.find(time.process_time() + 60)
    assert {place for (place,) in located.known} == {0, 1, 2}
    return located.lemmas()


@pytest.mark.parametrize("steps", [2, 30])
def test_what_is_found_is_an_invariant_that_shows_more(steps: int) -> None:
    system = course(steps)
    lemmas = found(system)
    assert is_inductive(system.cone(*lemmas), lemmas)
    differs = z3.And(STATE == 2, z3.BitVec("kept", 16) != SEEN)
    for bad in (differs, WAITED > 40, z3.And(STATE == 0, WAITED > 0), z3.And(STATE == 2, WAITED == 0)):
        assert induction(system, bad, lemmas, time.process_time() + 20) is not None


@pytest.mark.parametrize(
    "bad", [z3.And(STATE == 1, WAITED == 3), WAITED == 40, z3.And(STATE == 2, SEEN == 5)], ids=str
)
def test_what_happens_is_not_excluded(bad: z3.BoolRef) -> None:
    system = course(4)
    assert shortest(system, bad, 50, time.process_time() + 20)[0] is not None
    assert induction(system, bad, found(system), time.process_time() + 20) is None


def test_a_limit_counts_the_solvers_own_work(monkeypatch: pytest.MonkeyPatch) -> None:
    system, bad = course(30), z3.And(STATE == 2, z3.BitVec("kept", 16) != SEEN)
    monkeypatch.setattr(search, "PATIENCE", 1_000)
    assert spacer(system, bad, [], 20) is not None
    monkeypatch.setattr(search, "UNITS_A_SECOND", 5)
    assert spacer(system, bad, [], 20) is None

"""The search by gates: what the terms mean, the fewest scans, and where it must pass."""

from __future__ import annotations

import random
from typing import Any

import pytest
import z3

from programs.invariants import induction
from programs.invariants.bounded_search import BoundedSearch, shortest
from programs.invariants.gates import NoGates
from programs.invariants.induction import System

YES, NO = z3.BoolVal(True), z3.BoolVal(False)
LATE = float("inf")
ON, SINCE, ASKED, DT = z3.Bool("on"), z3.Int("since"), z3.Bool("asked"), z3.Int("dt_ms")


def system(after: Any, start: Any = 0) -> System:
    """A latch that `asked` sets, and a number; scans of 5 to 50 ms."""
    first = None if start is None else z3.IntVal(start)
    return System(
        {"on": ON, "since": SINCE},
        {"asked": ASKED, "dt_ms": DT},
        {"on": NO, "since": first},
        {"on": z3.Or(ON, ASKED), "since": after},
        z3.And(DT >= 5, DT <= 50),
        YES,
        z3.And(SINCE >= -9, SINCE <= 9) if start is None else SINCE >= 0,
    )


@pytest.mark.parametrize("limit", [49, 50, 149, 150, 151])
def test_a_time_is_passed_in_the_fewest_scans(limit: int) -> None:
    timer = system(z3.If(ON, SINCE + DT, 0))
    way, scans = shortest(timer, limit < SINCE, 9, LATE)
    assert way is not None
    assert scans == len(way.scans) == 2 + limit // 50 + 1
    assert induction.shortest(timer, limit < SINCE, 9, LATE)[1] == scans
    assert sum(values["dt_ms"] for values in way.scans[1:-1]) > limit
    assert shortest(timer, limit < SINCE, scans - 1, LATE) == (None, scans - 1)


def test_several_targets_are_looked_for_together() -> None:
    targets = {"late": SINCE > 100, "on": ON, "never": SINCE < 0}
    search = BoundedSearch(system(z3.If(ON, SINCE + DT, 0)), targets)
    found = search.look([*targets], 4, LATE)
    assert {name: len(way.scans) for name, way in found.ways.items()} == {"on": 2}
    more = search.look([*targets], 8, LATE, found)
    assert {name: len(way.scans) for name, way in more.ways.items()} == {"on": 2, "late": 5}
    assert more.clean == {"late": 4, "on": 1, "never": 8}


def test_a_clock_that_has_run_out_looks_at_nothing() -> None:
    assert shortest(system(SINCE), ON, 5, 0.0) == (None, 0)


def test_any_value_at_power_up_stays_within_its_range() -> None:
    kept = system(SINCE, start=None)
    way, scans = shortest(kept, SINCE == -9, 3, LATE)
    assert (scans, way and way.start["since"]) == (1, -9)
    assert shortest(kept, SINCE == 10, 3, LATE) == (None, 3)


@pytest.mark.parametrize("after", [SINCE * SINCE, SINCE / 3])
def test_what_has_no_gates_is_left_to_the_other_search(after: Any) -> None:
    with pytest.raises(NoGates):
        BoundedSearch(system(after), {"on": ON})
    assert shortest(system(after), ON, 3, LATE)[1] == 2


def test_terms_mean_the_same_as_gates() -> None:
    """For terms of all kinds: where z3 says that a value can be, a scan is found, and nowhere else."""
    choose = random.Random(3)
    a, b, p, w = z3.Int("a"), z3.Int("b"), z3.Bool("p"), z3.BitVec("w", 4)
    numbers = [a, b, a + b, a - b, -a, z3.If(p, a, b + 3), z3.IntVal(-2), z3.If(a < b, b, a) - 1]
    words = [w, ~w, w & 9, w | 2, w ^ 5, z3.Concat(z3.Extract(1, 0, w), z3.Extract(3, 2, w))]
    words.append(z3.ZeroExt(2, z3.Extract(2, 1, w)))
    bounds = z3.And(a >= -3, a <= 4, b >= 0, b <= 5)
    for _ in range(60):
        left, right, third = choose.sample(numbers, 3)
        one, other = choose.sample(words, 2)
        kinds = (left <= right, left < right, left >= third, left > third, left == right, left != third)
        parts = [*choose.sample(kinds, 2), one == other, z3.Xor(p, one != 6), z3.Implies(p, left == third)]
        bad = z3.And(*choose.sample(parts, 3))
        memoryless = System({}, {"a": a, "b": b, "p": p, "w": w}, {}, {}, bounds, YES, YES)
        way, _ = shortest(memoryless, bad, 1, LATE)
        solver = z3.Solver()
        solver.add(bounds, bad)
        assert (way is not None) == (solver.check() == z3.sat), bad
        if way is not None:
            (read,) = way.scans
            given = [(a, z3.IntVal(read["a"])), (b, z3.IntVal(read["b"])), (p, z3.BoolVal(read["p"]))]
            given.append((w, z3.BitVecVal(read["w"], 4)))
            assert z3.is_true(z3.simplify(z3.substitute(z3.And(bounds, bad), *given))), (bad, read)

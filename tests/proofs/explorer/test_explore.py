"""Every path of a function is found once, and what a symbolic value cannot give is refused."""

import operator
from collections.abc import Callable
from typing import Any

import pytest
import z3
from hypothesis import given, settings
from hypothesis import strategies as st

from proofs.explorer import explore as explore_module
from proofs.explorer.device import no_two_paths, some_path
from proofs.explorer.errors import (
    ConcretizationError,
    ExplorationError,
    HiddenStateError,
    TooManyPathsError,
    UndecidedError,
)
from proofs.explorer.explore import Exploration, explore
from proofs.explorer.records import evaluated
from proofs.explorer.values import Opaque, flag, number, text, word

W, V = word("w"), word("v")
N, T = number("n", -1, 4), number("t", 0)
B = flag("b")
S = text("s", ("", "yes", "no"))


def _applies(path: explore_module.Path, values: dict[z3.ExprRef, z3.ExprRef]) -> bool:
    return z3.is_true(z3.simplify(z3.substitute(path.condition, *values.items())))


def _refuted(premise: z3.BoolRef, claim: z3.BoolRef) -> bool:
    solver = z3.Solver()
    solver.add(premise, z3.Not(claim))
    return bool(solver.check() == z3.sat)


def _exhaustive_and_disjoint(found: Exploration) -> tuple[bool, bool]:
    conditions = [path.condition for path in found.paths]
    return (
        not _refuted(found.premise, some_path(conditions)),
        not _refuted(found.premise, no_two_paths(conditions)),
    )


# ---------------------------------------------------------------- what comes out


@given(st.lists(st.integers(0, 65535), max_size=5), st.integers(0, 65535))
@settings(deadline=None, max_examples=50)
def test_exactly_one_path_takes_each_word_as_the_interpreter_does(constants: list[int], value: int) -> None:
    def chain(read: int) -> int:
        for position, constant in enumerate(constants):
            if position % 2 and read != constant:
                continue
            if read == constant:
                return position
        return -1

    number_of = {W.term: z3.BitVecVal(value, 16)}
    applies = [path.result for path in explore(chain, (W,)).paths if _applies(path, number_of)]
    assert applies == [chain(value)]


def test_a_branch_that_is_not_feasible_is_no_path() -> None:
    def inconsistent(read: int) -> str:
        if read < 5:
            return "small" if read < 6 else "never"
        return "large" if read >= 5 else "never"

    found = explore(inconsistent, (W,))
    assert [path.result for path in found.paths] == ["small", "large"]
    assert found.pruned == 1
    assert _exhaustive_and_disjoint(found) == (True, True)


def test_times_are_unbounded_and_added_exactly() -> None:
    def late(elapsed: int, dt: int) -> int:
        return 0 if elapsed + dt >= 10**30 else elapsed + dt

    found = explore(late, (T, number("dt", 0)))
    assert len(found.paths) == 2
    elapsed, dt = z3.Ints("t dt")
    assert not _refuted(found.paths[0].condition, elapsed + dt >= 10**30)
    assert found.paths[1].result.term.eq(elapsed + dt)


def test_a_result_can_be_an_expression_without_a_decision() -> None:
    (path,) = explore(lambda n: (n == 2, n), (N,)).paths
    assert not path.decisions
    assert path.result[0].term.eq(N.term == z3.IntVal(2))
    assert path.result[1].term.eq(N.term)


def test_and_or_not_decide_in_the_order_of_the_interpreter() -> None:
    found = explore(lambda b, n: "in" if b and not (n == 1 or n == 2) else "out", (B, N))
    assert [len(path.decisions) for path in found.paths] == [2, 3, 3, 1]
    assert [path.result for path in found.paths] == ["out", "out", "in", "out"]


def test_a_question_and_its_negation_are_decided_once_a_path() -> None:
    def twice(n: int) -> int:
        if n != 3:
            return 1 if n == 3 else 2
        return 3

    assert [path.result for path in explore(twice, (N,)).paths] == [2, 3]


def test_texts_are_compared_with_texts_that_they_can_be() -> None:
    found = explore(lambda s: 1 if s == "yes" else 2 if s != "no" else 3, (S,))
    assert [path.result for path in found.paths] == [1, 2, 3]


def test_an_exception_of_the_code_ends_a_path() -> None:
    def refuses(read: int) -> int:
        if read == 7:
            raise ValueError(f"a message may show it: {read!r}")
        return 0

    raised, returned = explore(refuses, (W,)).paths
    assert isinstance(raised.raised, ValueError)
    assert (returned.raised, returned.result) == (None, 0)


def test_the_walk_has_a_fixed_order() -> None:
    def bits(b: bool, n: int, w: int) -> tuple[bool, bool, bool]:
        return (bool(b), bool(n > 2), bool(w > 9))

    def walk() -> list[Any]:
        return [path.result for path in explore(bits, (B, N, W)).paths]

    first = walk()
    assert first == walk()
    assert first == sorted(first, reverse=True)
    assert len(first) == 8


def test_words_are_joined_bit_by_bit_as_python_does() -> None:
    (path,) = explore(lambda w, v: ((w & v) | 0x00F0) ^ 1, (W, V)).paths
    solver = z3.Solver()
    solver.add(W.term == 0x0FF3, V.term == 0x3F0F)
    assert solver.check() == z3.sat
    assert evaluated(path.result, solver.model()) == ((0x0FF3 & 0x3F0F) | 0x00F0) ^ 1


# ---------------------------------------------------------------- what is refused

DIGITS = {1: 2}


@pytest.mark.parametrize(
    "function",
    [
        lambda w: DIGITS.get(w, 0),
        lambda w: 1 if w in {1, 2} else 0,
        lambda w: 1 if hash(w) == 1 else 0,
        lambda w: int(w),
        lambda w: float(w),
        lambda w: [1, 2, 3][w],
        lambda w: 1 if w else 0,
        lambda w: 1 if not w else 0,
        lambda w: w + 1,
        lambda w: 1 - w,
        lambda w: w << 1,
        lambda w: -w,
        lambda w: ~w,
        lambda w: w // 256,
        lambda w: w % 2,
        lambda w: abs(w),
        lambda w: round(w),
        lambda w: len(f"{w:04X}"),
        lambda w: str(w),
        lambda w: repr(w),
        lambda w: "%s" % w,  # noqa: UP031
        lambda w: 1 if w == "1" else 0,
        lambda w: 1 if w == 0x10000 else 0,
        lambda w: 1 if w == -1 else 0,
        lambda w: 1 if w == True else 0,  # noqa: E712
        lambda w: 1 if w == None else 0,  # noqa: E711
        lambda w: 1 if w == 1.0 else 0,
        lambda w: w.bit_length(),
        lambda w: w.to_bytes(2, "big"),
        lambda w: max(w, "a"),
        lambda w: range(w),
        lambda w: [w],
        lambda w: {"w": w},
        lambda w: 0.5,
        lambda w: (w == 1, lambda: w),
        lambda w: w(),
        lambda w: sum(1 for _ in w),
        lambda w: w[0],
        lambda w: 1 in w,
        lambda w: divmod(w, 2),
    ],
)
def test_what_would_need_the_value_of_a_word_is_refused(function: Callable[[int], object]) -> None:
    with pytest.raises(ConcretizationError):
        explore(function, (W,))


@pytest.mark.parametrize(
    "name", ["lt", "le", "gt", "ge", "add", "sub", "mul", "and_", "or_", "xor", "truediv"]
)
def test_a_flag_is_only_decided_or_compared_with_flags(name: str) -> None:
    with pytest.raises(ConcretizationError, match="a symbolic flag"):
        explore(lambda b: getattr(operator, name)(b, True), (B,))


@pytest.mark.parametrize(
    "function",
    [
        lambda n, w: 1 if n == w else 0,
        lambda n, w: n * 2,
        lambda n, w: n / 2,
        lambda n, w: n & 1,
        lambda n, w: n**2,
        lambda n, w: n + 0.5,
        lambda n, w: n + True,
        lambda n, w: 1 if n else 0,
    ],
)
def test_numbers_are_only_added_subtracted_or_compared_with_numbers(
    function: Callable[[int, int], object],
) -> None:
    with pytest.raises(ConcretizationError):
        explore(function, (N, W))


@pytest.mark.parametrize("function", [lambda s: s == "maybe", lambda s: s < "yes", lambda s: s + "s", len])
def test_a_text_is_only_compared_with_its_possible_texts(function: Callable[[str], object]) -> None:
    with pytest.raises(ConcretizationError):
        explore(function, (S,))


def test_a_refusal_names_line_question_and_what_to_write_instead() -> None:
    with pytest.raises(ConcretizationError, match=r"test_explore\.py:\d+: in .*hash.*compare with =="):
        explore(lambda w: hash(w), (W,))


def test_a_refusal_that_the_code_swallows_is_still_a_refusal() -> None:
    def hides(read: int) -> int:
        try:
            return DIGITS[read]
        except Exception:
            return 0

    with pytest.raises(ConcretizationError, match="hash"):
        explore(hides, (W,))


def test_a_value_only_to_be_handed_on_is_handed_on() -> None:
    (path,) = explore(lambda f, b: (f, b), (Opaque("f"), B)).paths
    assert path.result[0] == Opaque("f")
    with pytest.raises(ConcretizationError):
        explore(lambda f: f(1), (Opaque("f"),))


def test_code_that_counts_its_calls_is_caught() -> None:
    calls: list[int] = []

    def counts(read: int) -> int:
        calls.append(1)
        return len(calls) if read == 1 else 0

    with pytest.raises(HiddenStateError):
        explore(counts, (W,))


def test_code_that_asks_something_else_next_time_is_caught() -> None:
    calls: list[int] = []

    def alternates(read: int) -> int:
        calls.append(1)
        return 1 if read == len(calls) % 2 else 0

    with pytest.raises(HiddenStateError, match="keeps state"):
        explore(alternates, (W,))


def test_code_that_keeps_a_symbolic_value_between_calls_is_caught() -> None:
    kept: list[Any] = []

    def remembers(read: int) -> int:
        kept.append(read == 3)
        return 1 if kept[0] else 0

    with pytest.raises(HiddenStateError):
        explore(remembers, (W,))


def test_code_with_too_many_paths_or_endless_loops_is_refused() -> None:
    with pytest.raises(TooManyPathsError, match="more than 10 paths"):
        explore(lambda w: sum(1 for c in range(12) if w == c), (W,), max_paths=10)

    def endless(elapsed: int) -> int:
        while elapsed >= 0:
            elapsed = elapsed + 1
        return elapsed

    def counting(elapsed: int) -> int:
        bound = 0
        while elapsed != bound:
            bound = bound + 1
        return bound

    with pytest.raises(TooManyPathsError):
        explore(counting, (T,), max_paths=50)


def test_a_premise_that_cannot_be_met_is_no_exploration() -> None:
    with pytest.raises(ExplorationError, match="premise"):
        explore(lambda n: n, (N,), N.term > 7)


def test_a_branch_that_the_solver_cannot_judge_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(explore_module, "LIMIT_MS", 1)
    monkeypatch.setattr(z3.Solver, "check", lambda *_: z3.unknown)
    with pytest.raises(UndecidedError):
        explore(lambda n: n, (N,))


# ---------------------------------------------------------------- the explorer itself, with planted faults


def _steps(n: int) -> int:
    if n == 1:
        return 1
    if n == 2 or n == 3:
        return 2
    return 3


def test_paths_that_leave_something_out_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    found = explore(_steps, (N,))
    assert _exhaustive_and_disjoint(found) == (True, True)
    for left_out in range(len(found.paths)):
        fewer = [path.condition for number, path in enumerate(found.paths) if number != left_out]
        assert _refuted(found.premise, some_path(fewer))


def test_a_branch_that_was_pruned_wrongly_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    check = explore_module._Explorer.check

    def blind(self: Any, question: z3.BoolRef | None) -> z3.ModelRef | None:
        return None if self.questions == 2 else check(self, question)

    def counted(self: Any, question: z3.BoolRef | None) -> z3.ModelRef | None:
        found = blind(self, question)
        if found is None:
            self.questions += 1
        return found

    monkeypatch.setattr(explore_module._Explorer, "check", counted)
    exhaustive, disjoint = _exhaustive_and_disjoint(explore(_steps, (N,)))
    assert not exhaustive
    assert disjoint


def test_paths_that_overlap_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    found = explore(_steps, (N,))
    conditions = [path.condition for path in found.paths]
    assert _refuted(found.premise, no_two_paths([*conditions, conditions[2]]))
    shorter = [z3.And(*[d.literal for d in path.decisions[:1]]) for path in found.paths]
    assert _refuted(found.premise, no_two_paths(shorter))

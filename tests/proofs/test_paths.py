"""The path runner gives what the interpreter gives, and refuses what it cannot follow."""

from collections.abc import Callable

import pytest
import z3
from hypothesis import given
from hypothesis import strategies as st

from proofs.paths import ConcretizationError, paths

X = z3.BitVec("x", 16)


def _chain(constants: list[int]) -> Callable[[int], int]:
    """A function of the shape of the shipped ones: compare, compare, give up."""

    def function(number: int) -> int:
        for position, constant in enumerate(constants):
            if position % 2 and number != constant:
                continue
            if number == constant:
                return position
        return -1

    return function


@given(st.lists(st.integers(0, 65535), max_size=5), st.integers(0, 65535))
def test_exactly_one_path_applies_to_each_number_and_gives_what_the_interpreter_gives(
    constants: list[int], number: int
) -> None:
    function = _chain(constants)
    value = z3.BitVecVal(number, 16)
    applies = [
        path.result
        for path in paths(function, X)
        if z3.is_true(z3.simplify(z3.substitute(path.condition, (X, value))))
    ]
    assert applies == [function(number)]


def test_the_path_conditions_cover_every_number() -> None:
    conditions = [path.condition for path in paths(_chain([1, 2, 3]), X)]
    solver = z3.Solver()
    solver.add(z3.Not(z3.Or(*conditions)))
    assert solver.check() == z3.unsat


def test_a_path_that_raises_has_no_result() -> None:
    def function(number: int) -> int:
        if number == 7:
            raise ValueError("planted")
        return 0

    assert sorted(str(path.result) for path in paths(function, X)) == ["0", "None"]


@pytest.mark.parametrize(
    "function",
    [
        lambda number: {1: 2}.get(number, 0),
        lambda number: 1 if number < 5 else 0,
        lambda number: 1 if number >= 5 else 0,
        lambda number: int(number),
        lambda number: [1, 2, 3][number],
        lambda number: number & 0x00FF,
        lambda number: 0x00FF & number,
        lambda number: number + 1,
        lambda number: 1 if number else 0,
        lambda number: 1 if number in {1, 2} else 0,
        lambda number: 1 if number == "1" else 0,
        lambda number: 1 if number == 0x10000 else 0,
        lambda number: 1 if number == True else 0,  # noqa: E712
        lambda number: number,
        lambda number: number == 1,
        lambda number: len(f"{number:04X}"),
        lambda number: 1 if hash(number) == 1 else 0,
    ],
)
def test_code_that_needs_more_than_equality_is_refused(function: Callable[[int], int]) -> None:
    with pytest.raises(ConcretizationError):
        list(paths(function, X))


def test_code_with_too_many_paths_is_refused() -> None:
    def endless(number: int) -> int:
        return sum(1 for constant in range(11) if number == constant)

    with pytest.raises(ConcretizationError, match="more than 1000 paths"):
        list(paths(endless, X))

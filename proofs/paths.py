"""Runs a shipped function of one number on a symbolic number, path by path, unchanged.

Enough for functions that decide by `==` and `!=` alone, such as the decoding of code words. Everything else
that would turn the symbolic number into a concrete one (ordering, hash, index, arithmetic) raises.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NoReturn

import z3

MAX_PATHS = 1000


class ConcretizationError(TypeError):
    """The code asked a symbolic number for more than equality."""


@dataclass(frozen=True)
class Path:
    """One way through the function: the decisions taken, and what came out."""

    condition: z3.BoolRef
    result: int | None
    """What the function returned; None when it raised."""


class _Decisions:
    """The decisions of one run: a prefix to replay, then True for each new question."""

    def __init__(self, prefix: tuple[bool, ...]) -> None:
        self.prefix = prefix
        self.asked: list[z3.BoolRef] = []

    def take(self, question: z3.BoolRef) -> bool:
        self.asked.append(question)
        number = len(self.asked) - 1
        return self.prefix[number] if number < len(self.prefix) else True


class _Question:
    """The outcome of a comparison; asking for its truth takes a decision."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, question: z3.BoolRef, decisions: _Decisions) -> None:
        self._question = question
        self._decisions = decisions

    def __bool__(self) -> bool:
        return self._decisions.take(self._question)


class _Symbol:
    """A symbolic number that can only be compared for equality."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, expression: z3.BitVecRef, decisions: _Decisions) -> None:
        self._expression = expression
        self._decisions = decisions

    def __eq__(self, other: object) -> _Question:  # type: ignore[override]
        return _Question(self._expression == self._number(other), self._decisions)

    def __ne__(self, other: object) -> _Question:  # type: ignore[override]
        return _Question(self._expression != self._number(other), self._decisions)

    def _number(self, other: object) -> int:
        bits = self._expression.size()
        if type(other) is not int or not -(1 << (bits - 1)) <= other < 1 << bits:
            raise ConcretizationError(f"a symbolic {bits}-bit number is compared with {other!r}")
        return other

    def __repr__(self) -> str:
        return f"<symbolic {self._expression}>"

    def _refuse(self, *_: object) -> NoReturn:
        raise ConcretizationError("the code needs more of a symbolic number than == and !=")

    __bool__ = __int__ = __index__ = __float__ = __lt__ = __le__ = __gt__ = __ge__ = _refuse
    __add__ = __radd__ = __sub__ = __rsub__ = __and__ = __rand__ = __or__ = __ror__ = __xor__ = __rxor__ = (
        _refuse
    )


def paths(function: Callable[[int], int], symbol: z3.BitVecRef) -> Iterator[Path]:
    """Every path of `function` on the symbolic number.

    The decision sequences form the full binary tree, so the conditions are exhaustive and disjoint. A path on
    which the function raises an ordinary exception has the result None. Raises ConcretizationError when the
    code needs more than equality, or has more than MAX_PATHS paths.
    """
    waiting: list[tuple[bool, ...]] = [()]
    for _ in range(MAX_PATHS):
        if not waiting:
            return
        prefix = waiting.pop()
        decisions = _Decisions(prefix)
        result = _run(function, _Symbol(symbol, decisions))
        taken = prefix + (True,) * (len(decisions.asked) - len(prefix))
        waiting += [(*taken[:number], False) for number in range(len(prefix), len(taken))]
        literals = [
            question if choice else z3.Not(question)
            for question, choice in zip(decisions.asked, taken, strict=True)
        ]
        yield Path(_all(literals), result)
    raise ConcretizationError(f"more than {MAX_PATHS} paths")


def _all(literals: list[z3.BoolRef]) -> z3.BoolRef:
    """All the literals; SMT-LIB has no conjunction of none or of one."""
    if not literals:
        return z3.BoolVal(True)
    return literals[0] if len(literals) == 1 else z3.And(*literals)


def _run(function: Callable[[int], int], symbol: _Symbol) -> int | None:
    try:
        result = function(symbol)  # type: ignore[arg-type]
    except ConcretizationError:
        raise
    except TypeError as error:
        raise ConcretizationError(
            f"the code needs more of a symbolic number than == and !=: {error}"
        ) from error
    except Exception:
        return None
    if type(result) is not int:
        raise ConcretizationError(f"the code returned {result!r}, not a number")
    return result

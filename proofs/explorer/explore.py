"""Runs a function on symbolic values once for each feasible path: decide, replay, decide otherwise.

Each question that the code asks of a symbolic value forks the run, unless the solver shows that only one
answer is possible after the answers so far. The runs form a binary tree, walked in a fixed order (yes before
no). A path's condition is the conjunction of all its answers, the forced ones included, so that the claim
that the conditions are exhaustive also judges every branch that was pruned.

Afterwards each path is run once more, last one first. A function that asks other questions or returns
something else then keeps state between calls, and is refused.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path as File
from types import CodeType, FrameType, ModuleType
from typing import Any, Final, NoReturn

import z3

from proofs.explorer.errors import (
    ConcretizationError,
    ExplorationError,
    HiddenStateError,
    TooManyPathsError,
    UndecidedError,
)
from proofs.explorer.records import check_result, in_run, same, symbols
from proofs.explorer.values import Symbol

MAX_PATHS: Final = 20_000
MAX_DECISIONS: Final = 400
"""Questions on one path: a loop that never ends by itself stops here."""
LIMIT_MS: Final = 10_000
"""For one question of feasibility."""
EXPLORER: Final = str(File(__file__).parent)


@dataclass(frozen=True)
class Place:
    """Where in the code a question was asked: file, function, line and columns."""

    file: str
    function: str
    line: int
    columns: tuple[int, int]


@dataclass(frozen=True)
class Decision:
    """One question, its answer, and whether the answers before it left no other."""

    question: z3.BoolRef
    answer: bool
    forced: bool
    place: Place

    @cached_property
    def literal(self) -> z3.BoolRef:
        """The question or its negation, as it was answered."""
        return self.question if self.answer else z3.Not(self.question)


@dataclass(frozen=True)
class Path:
    """One feasible way through the function: its decisions, and what came out."""

    decisions: tuple[Decision, ...]
    result: Any
    """What the function returned, with proxies in it; None when it raised."""
    raised: Exception | None
    example: z3.ModelRef
    """A member of the path."""
    asked: frozenset[tuple[Place, bool]] = frozenset()
    """Where the code asked what, and the answer it got; also where the answer was known before."""

    @cached_property
    def condition(self) -> z3.BoolRef:
        """All answers of the path."""
        return conjunction([decision.literal for decision in self.decisions])


@dataclass(frozen=True)
class Exploration:
    """All feasible paths of a function under a premise, and what they cost."""

    premise: z3.BoolRef
    paths: tuple[Path, ...]
    questions: int
    """How often the solver was asked whether a branch is feasible."""
    pruned: int
    """Branches that are not feasible."""


@dataclass(frozen=True)
class StandIn:
    """In place of a function of the code, an arbitrary answer: a symbol that is free in each run.

    For what the code takes from outside, such as an algorithm that is not public. Of two calls in one run
    both get the same answer; so a stand-in is right only where a run calls it with one list of arguments.
    """

    module: ModuleType
    name: str
    answer: Symbol


def conjunction(literals: Sequence[z3.BoolRef]) -> z3.BoolRef:
    """The conjunction of the literals. In SMT-LIB a conjunction has at least two parts."""
    if not literals:
        return z3.BoolVal(True)
    return literals[0] if len(literals) == 1 else _joined(z3.Z3_mk_and, literals)


def disjunction(literals: Sequence[z3.BoolRef]) -> z3.BoolRef:
    """One of the literals at least."""
    if not literals:
        return z3.BoolVal(False)
    return literals[0] if len(literals) == 1 else _joined(z3.Z3_mk_or, literals)


def _joined(make: Callable[..., Any], literals: Sequence[z3.BoolRef]) -> z3.BoolRef:
    """As z3.And and z3.Or, which look at the type of every literal once more."""
    context = literals[0].ctx
    terms = (z3.Ast * len(literals))(*[literal.as_ast() for literal in literals])
    return z3.BoolRef(make(context.ref(), len(literals), terms), context)


def explore(
    function: Callable[..., Any],
    arguments: Sequence[Any],
    premise: z3.BoolRef | None = None,
    stand_ins: Sequence[StandIn] = (),
    max_paths: int = MAX_PATHS,
    twice: bool = True,
) -> Exploration:
    """Every feasible path of `function`, called with records, tuples, symbols and plain values.

    premise: what is known besides the ranges of the symbols. An exception that the function raises itself
    ends a path (`raised`). twice: run each path again, so that a function that keeps state is found out.
    Raises ExplorationError when the function cannot be followed.
    """
    ranges = [
        symbol.premise for symbol in (*_distinct(arguments), *(stand_in.answer for stand_in in stand_ins))
    ]
    known = [term for term in (*ranges, premise) if term is not None and not z3.is_true(term)]
    return _Explorer(function, arguments, conjunction(known), stand_ins, max_paths).explore(twice)


def _distinct(arguments: Sequence[Any]) -> Iterator[Symbol]:
    seen: set[int] = set()
    for argument in arguments:
        for symbol in symbols(argument):
            if symbol.term.get_id() not in seen:
                seen.add(symbol.term.get_id())
                yield symbol


@dataclass(frozen=True)
class _Atom:
    """A question as the code asked it, without its negation, or its constant answer."""

    asked: z3.BoolRef
    question: z3.BoolRef
    number: int
    """z3's number of the question."""
    negated: bool
    always: bool | None


class _Explorer:
    """The walk over the tree of decisions."""

    def __init__(
        self,
        function: Callable[..., Any],
        arguments: Sequence[Any],
        premise: z3.BoolRef,
        stand_ins: Sequence[StandIn],
        max_paths: int,
    ) -> None:
        self.function = function
        self.arguments = arguments
        self.premise = premise
        self.stand_ins = stand_ins
        self.max_paths = max_paths
        self.solver = z3.SimpleSolver()
        self.solver.set("timeout", LIMIT_MS)
        self.solver.add(premise)
        self.stack: list[z3.BoolRef] = []
        self.questions = 0
        self.pruned = 0
        self.atoms: dict[int, _Atom] = {}
        self.terms: dict[tuple[Any, int, int], tuple[Any, Any, Any]] = {}

    def explore(self, twice: bool = True) -> Exploration:
        if self.check(None) is None:
            raise ExplorationError("the premise cannot be met, so that there is no path to explore")
        waiting: list[tuple[tuple[Decision, ...], z3.ModelRef]] = [((), self.solver.model())]
        paths: list[Path] = []
        while waiting:
            prefix, model = waiting.pop()
            run = _Run(self, prefix, model)
            path = run.path()
            check_result(path.result)
            paths.append(path)
            waiting += run.branches
            if len(paths) > self.max_paths:
                raise TooManyPathsError(f"more than {self.max_paths} paths; split the function or its inputs")
        if twice:
            self._run_again(paths)
        return Exploration(self.premise, tuple(paths), self.questions, self.pruned)

    def _run_again(self, paths: list[Path]) -> None:
        for path in reversed(paths):
            again = _Run(self, path.decisions, path.example).path()
            raised = type(path.raised) is type(again.raised)
            if (
                len(again.decisions) != len(path.decisions)
                or not raised
                or not same(path.result, again.result)
            ):
                raise HiddenStateError(
                    "the same path run again gives another result; step must depend on its arguments alone"
                )

    def atom(self, question: z3.BoolRef) -> _Atom:
        """The question in a simpler form, always the same. It is kept, so that its identity stays valid."""
        known = self.atoms.get(id(question))
        if known is None:
            simple = z3.simplify(question)
            negated = z3.is_not(simple)
            always = True if z3.is_true(simple) else False if z3.is_false(simple) else None
            simple = simple.arg(0) if negated else simple
            known = _Atom(question, simple, simple.get_id(), negated, always)
            self.atoms[id(question)] = known
        return known

    def made(self, make: Callable[[Any, Any], Any], left: Any, right: Any) -> Any:
        """The term that `make` makes of two; it is kept with them, so that their identities stay valid."""
        key = make, id(left), id(right)
        if key not in self.terms:
            self.terms[key] = left, right, make(left, right)
        return self.terms[key][2]

    def check(self, question: z3.BoolRef | None) -> z3.ModelRef | None:
        """A model of the answers on the stack and the question, or None when there is none."""
        self.questions += 1
        answer = self.solver.check(*([] if question is None else [question]))
        if answer == z3.unknown:
            raise UndecidedError(
                f"the solver could not say whether a branch is feasible: {self.solver.reason_unknown()}"
            )
        return self.solver.model() if answer == z3.sat else None

    def assume(self, answers: list[z3.BoolRef]) -> None:
        """Put exactly these answers on the solver's stack."""
        common = 0
        while common < min(len(answers), len(self.stack)) and self.stack[common] is answers[common]:
            common += 1
        if len(self.stack) > common:
            self.solver.pop(len(self.stack) - common)
            del self.stack[common:]
        for answer in answers[common:]:
            self.solver.push()
            self.solver.add(answer)
            self.stack.append(answer)

    @contextmanager
    def standing_in(self, run: _Run) -> Iterator[None]:
        """Put the stand-ins in place for one run."""
        before = [(each.module, each.name, getattr(each.module, each.name)) for each in self.stand_ins]
        try:
            for stand_in in self.stand_ins:
                proxy = stand_in.answer.proxy(run)
                setattr(stand_in.module, stand_in.name, lambda *_, answer=proxy: answer)
            yield
        finally:
            for module, name, function in before:
                setattr(module, name, function)


@dataclass
class _Run:
    """One run: a prefix of answers to replay, then yes wherever both answers are feasible."""

    explorer: _Explorer
    prefix: tuple[Decision, ...]
    model: z3.ModelRef
    taken: list[Decision] = field(default_factory=list)
    branches: list[tuple[tuple[Decision, ...], z3.ModelRef]] = field(default_factory=list)
    answered: dict[int, bool] = field(default_factory=dict)
    asked: set[tuple[Place, bool]] = field(default_factory=set)
    refusal: str = ""
    said: bool = False
    over: bool = False

    # ---- what proxies call

    def decide(self, question: z3.BoolRef) -> bool:
        if self.over:
            raise HiddenStateError("a symbolic value of an earlier run is used: the code keeps state")
        atom = self.explorer.atom(question)
        place = _here()
        answer = atom.always if atom.always is not None else self._answer(atom, place) != atom.negated
        self.asked.add((place, answer))
        return answer

    def _answer(self, atom: _Atom, place: Place) -> bool:
        """The answer to the question of the atom, as it stands without its negation."""
        if atom.number in self.answered:  # asked before on this path
            return self.answered[atom.number]
        if len(self.taken) >= MAX_DECISIONS:
            raise TooManyPathsError(f"more than {MAX_DECISIONS} decisions on one path, at {place}")
        number = len(self.taken)
        if number < len(self.prefix):
            decision = self._replayed(self.prefix[number], atom.question)
        else:
            decision = self._new(atom.question, not atom.negated, place)
        self.taken.append(decision)
        self.answered[atom.number] = decision.answer
        return decision.answer

    def refuse(self, why: str) -> NoReturn:
        place = _here()
        self.refusal = self.refusal or f"{place.file}:{place.line}: in {place.function}: {why}"
        raise ConcretizationError(self.refusal)

    def spoken(self) -> None:
        self.said = True

    def made(self, make: Callable[[Any, Any], Any], left: Any, right: Any) -> Any:
        return self.explorer.made(make, left, right)

    # ---- the run

    def path(self) -> Path:
        result, raised = None, None
        try:
            with self.explorer.standing_in(self):
                arguments = [in_run(argument, self) for argument in self.explorer.arguments]
                result = self.explorer.function(*arguments)
        except ExplorationError:
            raise
        except (TypeError, AttributeError, RecursionError, MemoryError) as error:
            raise ConcretizationError(
                self.refusal or f"the code cannot be followed on symbolic values: {error!r}"
            ) from error
        except Exception as error:
            raised = error
        finally:
            self.over = True
        if self.refusal:  # the code caught the refusal and went on
            raise ConcretizationError(self.refusal)
        if self.said and raised is None:
            raise ConcretizationError(
                "a symbolic value is turned into text; texts are for error messages alone"
            )
        if len(self.taken) < len(self.prefix):
            raise HiddenStateError("the same path run again asks fewer questions: the code keeps state")
        return Path(tuple(self.taken), result, raised, self.model, frozenset(self.asked))

    def _replayed(self, expected: Decision, question: z3.BoolRef) -> Decision:
        if expected.question is not question and not expected.question.eq(question):
            raise HiddenStateError(
                f"the same path run again asks another question, {question} for {expected.question}: "
                "the code keeps state"
            )
        return expected

    def _new(self, question: z3.BoolRef, first: bool, place: Place) -> Decision:
        """first: the answer that means yes to the question as the code asked it."""
        self.explorer.assume([decision.literal for decision in self.taken if not decision.forced])
        answer = z3.is_true(self.model.eval(question, model_completion=True))
        otherwise = self.explorer.check(z3.Not(question) if answer else question)
        if otherwise is None:
            self.explorer.pruned += 1
            return Decision(question, answer, True, place)
        yes, no = (self.model, otherwise) if answer == first else (otherwise, self.model)
        self.branches.append(((*self.taken, Decision(question, not first, False, place)), no))
        self.model = yes
        return Decision(question, first, False, place)


def _here() -> Place:
    """The place in the code under exploration: the innermost frame that is none of the explorer's."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith(EXPLORER):
        frame = frame.f_back
    if frame is None:
        return Place("", "", 0, (0, 0))
    return _place(frame.f_code, frame.f_lasti)


@cache
def _place(code: CodeType, instruction: int) -> Place:
    line, _, start, end = list(code.co_positions())[instruction // 2]
    name = getattr(code, "co_qualname", code.co_name)
    return Place(code.co_filename, name, line or code.co_firstlineno, (start or 0, end or 0))

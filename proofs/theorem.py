"""What a theorem is: an English sentence, the clauses it speaks of, and the solver queries that decide it.

A theorem is a function with the decorator `theorem`. It yields queries; each is a list of named formulas and
the answer that we expect: `unsat` (no counterexample exists) or `sat` (an example exists). Write claims with
`claim`: it gives the `unsat` query together with its twin, the `sat` query that shows that the premises can
be met at all. `control` gives a `sat` query that must find an example, such as a planted fault.
"""

import pkgutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import z3

from modeproof.kit.by_name import module_named
from modeproof.registers import Response, load_responses

ROOT: Final = Path(__file__).parents[1]
Expected = Literal["unsat", "sat"]
COUNTEREXAMPLE: Final = "counterexample"
"""The name of the negated conclusion in the query of a claim."""


class TheoremError(ValueError):
    """A theorem that says nothing or cannot be trusted: no query, an `unsat` without a twin, a name used
    twice.
    """


class NotJudged(TheoremError):
    """What is asked for is not among the scans that are judged (see `proofs.explorer.device.judging`)."""


@dataclass(frozen=True)
class Query:
    """One question to a solver: can all the formulas be true at once?"""

    name: str
    formulas: Mapping[str, z3.BoolRef]
    """Named formulas, all asserted; the names appear in the exported file."""
    expected: Expected
    logic: str = "QF_BV"
    twin_of: str = ""
    """Of a twin: the name of the `unsat` query whose premises it shows to be satisfiable."""


Queries = Iterable[Query]
"""What a theorem function returns; most are generators."""


@dataclass(frozen=True)
class Theorem:
    """A registered theorem; calling it builds its queries."""

    name: str
    sentence: str
    remark: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    build: Callable[..., Queries]
    slow: bool = False
    """Takes too long for the lane smoke."""
    properties: tuple[str, ...] = ()
    """Ids of the properties of the document that it proves of the shipped code."""
    responses: tuple[str, ...] = ()
    """Ids of the response times of the document that it proves; `build` takes their rows in this order."""

    def rows(self) -> tuple[Response, ...]:
        """The rows of properties.toml that it proves. Raises TheoremError for an id that is not there."""
        if not self.responses:
            return ()
        document = self.build.__module__.split(".")[1]
        found = {row.id: row for row in load_responses(ROOT, document).rows}
        if lost := [name for name in self.responses if name not in found]:
            file = f"spec/{document}/properties.toml"
            raise TheoremError(f"theorem {self.name}: {file} has no {', '.join(lost)}")
        return tuple(found[name] for name in self.responses)

    def queries(self) -> tuple[Query, ...]:
        """Build the queries and refuse a set that proves nothing.

        Raises TheoremError: no query, a name used twice, an `unsat` without a twin, a twin that is not made
        of premises.
        """
        queries = tuple(self.build(*self.rows()))
        check_queries(self.name, queries)
        return queries


def theorem(
    clauses: list[str],
    findings: list[str],
    slow: bool = False,
    properties: Sequence[str] = (),
    responses: Sequence[str] = (),
) -> Callable[[Callable[..., Queries]], Theorem]:
    """Register a function as a theorem; the first paragraph of its docstring is the theorem in English.

    clauses, findings, properties, responses: ids from the registers of the document, written as literal lists
    so that they can be read without running the code. slow: left out of the lane smoke. Raises TheoremError
    without a sentence or without a clause.
    """

    def register(build: Callable[..., Queries]) -> Theorem:
        name = getattr(build, "__name__", "")
        paragraphs = [" ".join(part.split()) for part in (build.__doc__ or "").strip().split("\n\n")]
        if not paragraphs[0]:
            raise TheoremError(f"theorem {name}: the docstring must say the theorem in English")
        if not clauses:
            raise TheoremError(f"theorem {name}: cites no clause")
        sentence, remark = paragraphs[0], " ".join(paragraphs[1:])
        return Theorem(
            name,
            sentence,
            remark,
            tuple(clauses),
            tuple(findings),
            build,
            slow,
            tuple(properties),
            tuple(responses),
        )

    return register


def claim(
    name: str, given: Mapping[str, z3.BoolRef], then: z3.BoolRef, logic: str = "QF_BV"
) -> tuple[Query, Query]:
    """The claim that `then` follows from the premises `given`: the `unsat` query and its `sat` twin."""
    if not given:
        raise TheoremError(f"claim {name}: without premises its twin would say nothing")
    if COUNTEREXAMPLE in given:
        raise TheoremError(f"claim {name}: the name counterexample is taken")
    refutation = Query(name, {**given, COUNTEREXAMPLE: z3.Not(then)}, "unsat", logic)
    return refutation, Query(f"{name}: premises can be met", dict(given), "sat", logic, twin_of=name)


def control(name: str, formulas: Mapping[str, z3.BoolRef], logic: str = "QF_BV") -> Query:
    """A query that must find an example. If it finds none, the claims beside it are empty."""
    return Query(name, dict(formulas), "sat", logic)


def check_queries(theorem_name: str, queries: tuple[Query, ...]) -> None:
    """Refuse a set of queries that proves nothing (see `Theorem.queries`)."""
    if not any(query.expected == "unsat" for query in queries):
        raise TheoremError(
            f"theorem {theorem_name}: no query with the expected answer unsat, so it proves nothing"
        )
    by_name: dict[str, Query] = {}
    for query in queries:
        if query.name in by_name:
            raise TheoremError(f"theorem {theorem_name}: two queries are called {query.name!r}")
        if not query.formulas:
            raise TheoremError(f"theorem {theorem_name}: query {query.name!r} has no formula")
        by_name[query.name] = query
    twins = {query.twin_of: query for query in queries if query.twin_of}
    for query in queries:
        if query.expected == "unsat":
            _check_twin(theorem_name, query, twins.get(query.name))
    for target, twin in twins.items():
        if target not in by_name or by_name[target].expected != "unsat":
            raise TheoremError(f"theorem {theorem_name}: {twin.name!r} is the twin of no unsat query")


def _check_twin(theorem_name: str, query: Query, twin: Query | None) -> None:
    """The twin exists, expects `sat` and asserts every formula of the query except the negated conclusion."""
    if twin is None:
        raise TheoremError(f"theorem {theorem_name}: unsat query {query.name!r} has no sat twin")
    left_out = [name for name in query.formulas if name not in twin.formulas]
    same = all(name in query.formulas and query.formulas[name].eq(f) for name, f in twin.formulas.items())
    if twin.expected != "sat" or not same or len(left_out) != 1 or twin.logic != query.logic:
        raise TheoremError(
            f"theorem {theorem_name}: the twin of {query.name!r} must expect sat and assert its premises, "
            f"all but the negated conclusion; it leaves out {left_out}"
        )


def theorems_of(document: str) -> tuple[Theorem, ...]:
    """Every theorem in the modules of `proofs.<document>`, by module name and then in the order of the text.

    Raises TheoremError: no such room, no theorem in it, a name used twice.
    """
    room = f"proofs.{document}"
    try:
        package = module_named(room)
    except ModuleNotFoundError as error:
        if error.name is not None and (room == error.name or room.startswith(f"{error.name}.")):
            raise TheoremError(f"no theorems: there is no folder proofs/{document}") from error
        raise
    found: dict[str, Theorem] = {}
    for name in sorted(info.name for info in pkgutil.iter_modules(package.__path__)):
        for item in _own_theorems(f"{room}.{name}"):
            if item.name in found:
                raise TheoremError(f"two theorems are called {item.name}")
            found[item.name] = item
    if not found:
        raise TheoremError(f"no theorems in proofs/{document}")
    return tuple(found.values())


def _own_theorems(module_name: str) -> Iterator[Theorem]:
    """Theorems written in this module; imported ones belong to their own module."""
    for item in vars(module_named(module_name)).values():
        if isinstance(item, Theorem) and item.build.__module__ == module_name:
            yield item

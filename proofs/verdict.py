"""The verdict on a theorem from its queries, on the run and again from its evidence; needs no solver."""

from collections.abc import Sequence
from typing import Literal, Protocol

Verdict = Literal["PROVED", "VIOLATED", "INCONCLUSIVE", "UNJUDGED"]


class Answered(Protocol):
    """One query: the expected answer, what each solver answered, and the rest that a reason tells."""

    @property
    def name(self) -> str: ...
    @property
    def expected(self) -> str: ...
    @property
    def z3(self) -> str: ...
    @property
    def cvc5(self) -> str: ...
    @property
    def twin_of(self) -> str: ...
    @property
    def detail(self) -> str: ...


def judge(queries: Sequence[Answered]) -> tuple[Verdict, str]:
    """The verdict on a theorem from its queries, the gravest first, and one line of reason unless PROVED."""
    if not queries:
        return "UNJUDGED", "no query was asked"
    for query in queries:
        if {query.z3, query.cvc5} == {"sat", "unsat"}:
            return (
                "UNJUDGED",
                f"{query.name}: the solvers disagree, z3 says {query.z3}, cvc5 says {query.cvc5}",
            )
    for query in queries:
        if query.expected == "unsat" and query.z3 == query.cvc5 == "sat":
            return "VIOLATED", f"{query.name}: counterexample {query.detail}"
    for query in queries:
        if query.expected == "sat" and query.z3 == query.cvc5 == "unsat":
            what = "the premises cannot be met" if query.twin_of else "the example that must exist does not"
            return "UNJUDGED", f"{query.name}: {what}"
    for query in queries:
        if "error" in (query.z3, query.cvc5):
            return "UNJUDGED", f"{query.name}: {query.detail}"
    for query in queries:
        if (query.z3, query.cvc5) != (query.expected, query.expected):
            return "INCONCLUSIVE", f"{query.name}: z3 {query.z3}, cvc5 {query.cvc5}; {query.detail}"
    return "PROVED", ""

"""What the registry of theorems accepts and what it refuses."""

import types
from collections.abc import Callable

import pytest
import z3

from proofs.theorem import (
    Queries,
    Query,
    Theorem,
    TheoremError,
    check_queries,
    claim,
    control,
    theorem,
    theorems_of,
)

X = z3.BitVec("x", 16)
SMALL = {"x is small": z3.ULT(X, 10)}


def _theorem(build: Callable[[], Queries]) -> Theorem:
    return theorem(clauses=["EKS-T2"], findings=[])(build)


def test_a_claim_is_unsat_and_its_twin_of_premises_sat() -> None:
    refutation, twin = claim("less than 20", SMALL, z3.ULT(X, 20))
    assert (refutation.expected, twin.expected) == ("unsat", "sat")
    assert twin.twin_of == refutation.name
    assert dict(twin.formulas) == SMALL
    assert set(refutation.formulas) == {"x is small", "counterexample"}
    check_queries("t", (refutation, twin))


def test_an_unsat_query_without_a_twin_is_refused() -> None:
    refutation, _ = claim("less than 20", SMALL, z3.ULT(X, 20))
    with pytest.raises(TheoremError, match="has no sat twin"):
        check_queries("t", (refutation,))


def test_a_control_is_no_twin() -> None:
    refutation, _ = claim("less than 20", SMALL, z3.ULT(X, 20))
    with pytest.raises(TheoremError, match="has no sat twin"):
        check_queries("t", (refutation, control("an example", SMALL)))


@pytest.mark.parametrize(
    "formulas",
    [
        {},
        {"x is small": z3.ULT(X, 11)},
        {"another": z3.ULT(X, 10)},
        {"x is small": z3.ULT(X, 10), "another": X == 1},
    ],
)
def test_a_twin_that_asserts_other_than_the_premises_is_refused(formulas: dict[str, z3.BoolRef]) -> None:
    refutation, _ = claim("less than 20", SMALL, z3.ULT(X, 20))
    with pytest.raises(TheoremError):
        check_queries("t", (refutation, Query("twin", formulas, "sat", twin_of=refutation.name)))


def test_a_twin_that_leaves_out_a_premise_is_refused() -> None:
    refutation, _ = claim("less than 5", {**SMALL, "x is smaller": z3.ULT(X, 5)}, z3.ULT(X, 5))
    with pytest.raises(TheoremError, match="all but the negated conclusion"):
        check_queries("t", (refutation, Query("twin", SMALL, "sat", twin_of=refutation.name)))


def test_a_twin_of_nothing_is_refused() -> None:
    queries = (*claim("less than 20", SMALL, z3.ULT(X, 20)), Query("lost", SMALL, "sat", twin_of="nobody"))
    with pytest.raises(TheoremError, match="twin of no unsat query"):
        check_queries("t", queries)


def test_a_claim_without_premises_is_refused() -> None:
    with pytest.raises(TheoremError, match="without premises"):
        claim("always", {}, X == X)


def test_two_queries_of_one_name_are_refused() -> None:
    pair = claim("less than 20", SMALL, z3.ULT(X, 20))
    with pytest.raises(TheoremError, match="two queries are called"):
        check_queries("t", (*pair, *pair))


@pytest.mark.parametrize("queries", [(), (control("an example", SMALL),)])
def test_a_theorem_that_claims_nothing_is_refused(queries: tuple[Query, ...]) -> None:
    with pytest.raises(TheoremError, match="proves nothing"):
        check_queries("t", queries)


def test_a_theorem_without_a_sentence_or_a_clause_is_refused() -> None:
    def silent() -> Queries:
        return claim("less than 20", SMALL, z3.ULT(X, 20))

    def spoken() -> Queries:
        """Small numbers are less than 20."""
        return claim("less than 20", SMALL, z3.ULT(X, 20))

    with pytest.raises(TheoremError, match="in English"):
        _theorem(silent)
    with pytest.raises(TheoremError, match="no clause"):
        theorem(clauses=[], findings=[])(spoken)


def test_the_first_paragraph_of_the_docstring_is_the_sentence() -> None:
    def small_numbers_are_less_than_twenty() -> Queries:
        """Small numbers are
        less than 20.

        Not a deep result.
        """
        return claim("less than 20", SMALL, z3.ULT(X, 20))

    item = _theorem(small_numbers_are_less_than_twenty)
    assert item.name == "small_numbers_are_less_than_twenty"
    assert item.sentence == "Small numbers are less than 20."
    assert item.remark == "Not a deep result."
    assert (item.clauses, item.findings) == (("EKS-T2",), ())


def test_theorems_are_found_and_a_document_without_any_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    found = theorems_of("mode_selection")
    assert len({item.name for item in found}) == len(found) >= 25
    assert all(item.build.__module__.startswith("proofs.mode_selection.") for item in found)
    with pytest.raises(TheoremError, match="no folder proofs/no_such_document"):
        theorems_of("no_such_document")
    empty = types.ModuleType("proofs.empty")
    empty.__path__ = []
    monkeypatch.setitem(__import__("sys").modules, "proofs.empty", empty)
    with pytest.raises(TheoremError, match="no theorems in"):
        theorems_of("empty")

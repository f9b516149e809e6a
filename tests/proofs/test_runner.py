"""How a theorem is judged: only two solvers that both give every expected answer make it PROVED."""

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import z3

from modeproof.lane import theorem as lane_theorem
from proofs import runner, solvers
from proofs.runner import TheoremResult, prove, prove_all, unused_premises
from proofs.solvers import Answer, Judgment, Solver, ask_cvc5, ask_z3, core_of
from proofs.theorem import Queries, Query, Theorem, claim, control, theorem, theorems_of

ROOT = Path(__file__).resolve().parents[2]
X = z3.BitVec("x", 16)
SMALL = {"x is small": z3.ULT(X, 10)}


@theorem(clauses=["EKS-T2", "EKS-KS-9"], findings=["E-18"])
def small_numbers_are_less_than_twenty() -> Queries:
    """Small numbers are less than 20."""
    yield from claim("less than 20", SMALL, z3.ULT(X, 20))
    yield control("some are odd", {**SMALL, "x is odd": X & 1 == 1})


@theorem(clauses=["EKS-T2"], findings=[])
def small_numbers_are_less_than_five() -> Queries:
    """Small numbers are less than 5, which is false."""
    return claim("less than 5", SMALL, z3.ULT(X, 5))


@theorem(clauses=["EKS-T2"], findings=[])
def numbers_below_zero_are_even() -> Queries:
    """Unsigned numbers below zero are even; there are none."""
    return claim("even", {"x is below zero": z3.ULT(X, 0)}, X & 1 == 0)


@theorem(clauses=["EKS-T2"], findings=[])
def a_control_finds_nothing() -> Queries:
    """A planted fault that no solver can see."""
    yield from claim("less than 20", SMALL, z3.ULT(X, 20))
    yield control("planted", {**SMALL, "x is large": z3.UGT(X, 20)})


@theorem(clauses=["EKS-T2"], findings=[])
def an_unsat_query_has_no_twin() -> Queries:
    """A refutation that nobody has shown to be about anything."""
    yield Query("alone", {"x is below zero": z3.ULT(X, 0)}, "unsat")


@theorem(clauses=["EKS-T2"], findings=[])
def a_theorem_cannot_be_built() -> Queries:
    """A theorem whose function raises."""
    raise ZeroDivisionError("planted")


def _always(answer: Answer) -> Solver:
    return lambda query, text, limit_ms: Judgment(answer, f"fake {answer}")


def _but(name: str, answer: Answer, honest: Solver) -> Solver:
    """A solver that lies about one query."""

    def solver(query: Query, text: str, limit_ms: int) -> Judgment:
        return Judgment(answer, "fake") if query.name == name else honest(query, text, limit_ms)

    return solver


def _one(
    item: Theorem, tmp_path: Path, z3_solver: Solver = ask_z3, cvc5_solver: Solver = ask_cvc5
) -> TheoremResult:
    return prove_all([item], tmp_path, lambda line: None, z3_solver=z3_solver, cvc5_solver=cvc5_solver)[0]


def test_a_true_theorem_is_proved_when_both_solvers_say_so(tmp_path: Path) -> None:
    result = _one(small_numbers_are_less_than_twenty, tmp_path)
    assert (result.verdict, result.reason) == ("PROVED", "")
    assert [(q.expected, q.z3, q.cvc5) for q in result.queries] == [
        ("unsat",) * 3,
        ("sat",) * 3,
        ("sat",) * 3,
    ]
    assert result.clauses == ("EKS-T2", "EKS-KS-9")


def test_a_false_theorem_is_violated_and_the_counterexample_is_shown(tmp_path: Path) -> None:
    result = _one(small_numbers_are_less_than_five, tmp_path)
    assert result.verdict == "VIOLATED"
    assert result.reason.startswith("less than 5: counterexample x = 000")


def test_premises_that_cannot_be_met_are_no_proof(tmp_path: Path) -> None:
    result = _one(numbers_below_zero_are_even, tmp_path)
    assert result.verdict == "UNJUDGED"
    assert "the premises cannot be met" in result.reason


def test_a_control_that_finds_nothing_is_no_proof(tmp_path: Path) -> None:
    result = _one(a_control_finds_nothing, tmp_path)
    assert result.verdict == "UNJUDGED"
    assert "planted" in result.reason


def test_an_unsat_without_a_twin_is_refused_and_never_asked(tmp_path: Path) -> None:
    result = _one(an_unsat_query_has_no_twin, tmp_path)
    assert (result.verdict, result.queries) == ("UNJUDGED", ())
    assert "has no sat twin" in result.reason


def test_a_theorem_that_raises_is_unjudged_and_others_run(tmp_path: Path) -> None:
    items = [a_theorem_cannot_be_built, small_numbers_are_less_than_twenty]
    lines: list[str] = []
    results = prove_all(items, tmp_path, lines.append)
    assert [result.verdict for result in results] == ["UNJUDGED", "PROVED"]
    assert results[0].reason == "ZeroDivisionError: planted"
    assert [line.split(" ")[:2] for line in lines] == [
        ["UNJUDGED", "a_theorem_cannot_be_built"],
        ["PROVED", "small_numbers_are_less_than_twenty"],
    ]


B, Y = z3.Bool("b"), z3.BitVec("y", 8)
F = z3.Function("f", z3.BitVecSort(16), z3.BoolSort())
OF_WRONG_SORTS: dict[str, Callable[[], object]] = {
    "a word in And": lambda: z3.And(B, X),
    "a word in Or": lambda: z3.Or(X, B),
    "a word is denied": lambda: z3.Not(X),
    "a word implies": lambda: z3.Implies(X, B),
    "a word decides": lambda: z3.If(X, B, B),
    "arms of two lengths": lambda: z3.If(B, X, Y) == X,
    "words of two lengths are compared": lambda: X == Y,
    "and ordered": lambda: z3.ULT(X, Y),
    "and told apart": lambda: z3.Distinct(X, Y),
    "and put in the place of one another": lambda: z3.substitute(X == 1, (X, Y)),
    "a function of another length": lambda: F(Y),
    "a function of too many": lambda: F(X, X),
    "bits that a word does not have": lambda: z3.Extract(20, 3, X) == 1,
    "no truth value": lambda: X,
}


def test_prove_leaves_the_second_look_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("z3.z3.Z3_DEBUG", True)
    assert lane_theorem.theorems_of("edm")
    assert not z3.z3_debug()


@pytest.mark.parametrize("twice", [False, True])
@pytest.mark.parametrize("wrong", OF_WRONG_SORTS.values(), ids=OF_WRONG_SORTS)
def test_a_formula_of_wrong_sorts_is_always_unjudged(
    wrong: Callable[[], object], twice: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """libz3 refuses it; `modeproof prove` leaves out the second look of the Python layer."""
    monkeypatch.setattr("z3.z3.Z3_DEBUG", twice)

    def of_wrong_sorts() -> Queries:
        yield from claim("planted", SMALL, wrong())  # type: ignore[arg-type]

    result = _one(replace(a_theorem_cannot_be_built, build=of_wrong_sorts), tmp_path)
    assert result.verdict == "UNJUDGED" and result.reason
    right = replace(a_theorem_cannot_be_built, build=small_numbers_are_less_than_twenty.build)
    assert _one(right, tmp_path).verdict == "PROVED"


@pytest.mark.parametrize(
    ("name", "lie"),
    [("less than 20", "sat"), ("less than 20: premises can be met", "unsat"), ("some are odd", "unsat")],
)
@pytest.mark.parametrize("liar", ["z3", "cvc5"])
def test_solvers_that_disagree_are_never_a_pass(tmp_path: Path, name: str, lie: Answer, liar: str) -> None:
    first = _but(name, lie, ask_z3) if liar == "z3" else ask_z3
    second = _but(name, lie, ask_cvc5) if liar == "cvc5" else ask_cvc5
    result = _one(small_numbers_are_less_than_twenty, tmp_path, first, second)
    assert result.verdict == "UNJUDGED"
    assert "the solvers disagree" in result.reason


@pytest.mark.parametrize("silent", ["z3", "cvc5", "both"])
def test_unknown_is_inconclusive(tmp_path: Path, silent: str) -> None:
    first = _but("less than 20", "unknown", ask_z3) if silent != "cvc5" else ask_z3
    second = _but("less than 20", "unknown", ask_cvc5) if silent != "z3" else ask_cvc5
    result = _one(small_numbers_are_less_than_twenty, tmp_path, first, second)
    assert result.verdict == "INCONCLUSIVE"
    assert result.reason.startswith("less than 20: ")


def test_a_solver_that_fails_leaves_the_theorem_unjudged(tmp_path: Path) -> None:
    result = _one(small_numbers_are_less_than_twenty, tmp_path, cvc5_solver=_always("error"))
    assert (result.verdict, result.reason) == ("UNJUDGED", "less than 20: fake error")


@pytest.fixture
def hard() -> Query:
    """A pair of factors that no solver finds in a millisecond."""
    a, b = z3.BitVecs("a b", 96)
    wide = z3.ZeroExt(96, a) * z3.ZeroExt(96, b)
    factors = {
        "a is not 1": z3.UGT(a, 1),
        "b is not 1": z3.UGT(b, 1),
        "product": wide == (2**89 - 1) * (2**61 - 1),
    }
    return Query("factors", factors, "sat")


def test_a_time_limit_that_is_hit_is_unknown(hard: Query, tmp_path: Path) -> None:
    @theorem(clauses=["EKS-T2"], findings=[])
    def the_number_is_prime() -> Queries:
        """A product of two primes has no factors, which is false and hard to see."""
        premises = {name: f for name, f in hard.formulas.items() if name != "product"}
        return claim("no factors", premises, z3.Not(hard.formulas["product"]))

    result = prove_all([the_number_is_prime], tmp_path, lambda line: None, limit_ms=30)[0]
    assert result.verdict == "INCONCLUSIVE"
    assert (result.queries[0].z3, result.queries[0].cvc5) == ("unknown", "unknown")


@pytest.mark.parametrize("text", ["", "(assert", "(check-sat)\n(check-sat)", "(exit)", "(assert (= y 1))"])
def test_text_that_cvc5_cannot_answer_is_an_error(text: str) -> None:
    assert ask_cvc5(control("any", SMALL), text, 1000).answer == "error"


def _corrupted(change: Callable[[str], str]) -> Solver:
    return lambda query, text, limit_ms: ask_cvc5(query, change(text), limit_ms)


def test_a_wrong_export_is_seen_as_only_cvc5_reads_it(tmp_path: Path) -> None:
    wrong = _corrupted(lambda text: text.replace("(not (bvult x #x0014))", "(bvult x #x0014)"))
    result = _one(small_numbers_are_less_than_twenty, tmp_path, cvc5_solver=wrong)
    assert result.verdict == "UNJUDGED"


def test_every_query_is_exported_and_earlier_files_are_gone(tmp_path: Path) -> None:
    folder = tmp_path / "small_numbers_are_less_than_twenty"
    folder.mkdir()
    (folder / "999-old.smt2").write_text("(check-sat)")
    result = _one(small_numbers_are_less_than_twenty, tmp_path)
    assert sorted(folder.iterdir()) == [query.smt2 for query in result.queries]
    assert [file.name for file in sorted(folder.iterdir())] == [
        "001-less-than-20.smt2",
        "002-less-than-20-premises-can-be-met.smt2",
        "003-some-are-odd.smt2",
    ]


def test_an_exported_file_names_theorem_clauses_and_expected_answer(tmp_path: Path) -> None:
    result = _one(small_numbers_are_less_than_twenty, tmp_path)
    assert result.queries[0].smt2.read_text().splitlines() == [
        "; Theorem: Small numbers are less than 20.",
        "; Name: small_numbers_are_less_than_twenty",
        "; Query: less than 20",
        "; Clauses: EKS-T2, EKS-KS-9",
        "; Findings: E-18",
        "; Expected: unsat (no counterexample exists)",
        "(set-logic QF_BV)",
        "(declare-fun x () (_ BitVec 16))",
        "; Assert: x is small",
        "(assert (bvult x #x000a))",
        "; Assert: counterexample",
        "(assert (not (bvult x #x0014)))",
        "(check-sat)",
    ]


def test_a_place_that_cannot_be_written_is_unjudged(tmp_path: Path) -> None:
    (tmp_path / "small_numbers_are_less_than_twenty").write_text("a file where the folder should be")
    assert _one(small_numbers_are_less_than_twenty, tmp_path).verdict == "UNJUDGED"


def test_every_theorem_is_asked_and_unknown_is_no_proof(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    few = [one for one in theorems_of("mode_selection") if one.build.__module__.endswith("code_tables")]
    monkeypatch.setattr(runner, "theorems_of", {"mode_selection": few}.__getitem__)
    lines: list[str] = []
    silent = _always("unknown")
    results = prove("mode_selection", tmp_path, lines.append, z3_solver=silent, cvc5_solver=silent)
    assert [result.name for result in results] == [one.name for one in few]
    assert len(lines) == len(few) > 3
    assert {result.verdict for result in results} == {"INCONCLUSIVE"}


EXPORT = """
from proofs.smtlib import to_smtlib
from proofs.theorem import theorems_of
item = next(t for t in theorems_of("mode_selection") if t.name.startswith("the_undetected"))
print("".join(to_smtlib(item, query) for query in item.queries()))
"""


def test_the_exported_text_is_the_same_in_every_run() -> None:
    def text(seed: str) -> str:
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-c", EXPORT]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout

    assert text("1") == text("2") != ""


@theorem(clauses=["EKS-T2"], findings=[])
def a_premise_is_not_needed() -> Queries:
    """Small numbers are less than 20, also when they are odd."""
    odd = {**SMALL, "x is odd": X & 1 == 1}
    yield from claim("less than 20", odd, z3.ULT(X, 20))
    yield from claim("less than 30", odd, z3.ULT(X, 30))


def test_exactly_the_premises_that_no_proof_needs_are_named(tmp_path: Path) -> None:
    result = _one(a_premise_is_not_needed, tmp_path)
    assert (result.verdict, result.unused) == ("PROVED", ("x is odd",))
    assert [query.core for query in result.queries if query.expected == "unsat"] == [
        ("x is small", "counterexample")
    ] * 2
    assert _one(small_numbers_are_less_than_twenty, tmp_path).unused == ()


def test_a_core_has_no_formula_that_can_be_left_out() -> None:
    a, b, c = z3.Bools("a b c")
    formulas = {"a": a, "a or b": z3.Or(a, b), "not b": z3.Not(b), "b or c": z3.Or(b, c), "not a": z3.Not(a)}
    assert core_of(Query("q", formulas, "unsat")) == ("a or b", "not b", "not a")
    assert core_of(control("q", {"a": a})) is None


def test_a_core_is_not_known_when_z3_reaches_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = z3.BitVecs("x y", 16)
    hard = {"a product": x * y == 40961, "both large": z3.And(x > 1, y > 1, z3.ULT(x, 300), z3.ULT(y, 130))}
    query = Query("q", {**hard, "and not": z3.BoolVal(False)}, "unsat")
    assert core_of(query) == ("and not",)
    monkeypatch.setattr(solvers, "CORE_LIMIT", 1)
    assert core_of(query) is None


def test_a_premise_counts_as_needed_until_a_core_is_known(tmp_path: Path) -> None:
    result = _one(a_premise_is_not_needed, tmp_path)
    built = a_premise_is_not_needed.queries()
    without = [replace(query, core=None) for query in result.queries]
    assert unused_premises(built, result.queries) == ("x is odd",)
    assert unused_premises(built, without) == ()

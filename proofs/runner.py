"""Runs the theorems of a document: every query exported, asked of two solvers, and judged.

PROVED: both solvers gave every expected answer. VIOLATED: both found a counterexample to a claim.
INCONCLUSIVE: a solver did not know or reached its limit. UNJUDGED: the solvers disagree, a solver failed, a
theorem is malformed, or an example that must exist does not (a premise that cannot be met, a planted fault
that went unseen). Only PROVED is a pass.
"""

import os
import re
import shutil
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from proofs.smtlib import to_smtlib
from proofs.solvers import Judgment, Solver, ask_cvc5, ask_z3, core_of
from proofs.theorem import COUNTEREXAMPLE, Query, Theorem, TheoremError, theorems_of
from proofs.verdict import Verdict, judge

LIMIT_MS = 20_000


@dataclass(frozen=True)
class QueryResult:
    """One query: the expected answer, what each solver answered, where the exported file is."""

    name: str
    expected: str
    z3: str
    cvc5: str
    seconds: float
    smt2: Path
    twin_of: str = ""
    detail: str = ""
    """Of a query not as expected: the example found, or why there is no answer."""
    core: tuple[str, ...] | None = None
    """Of an `unsat` query: the formulas that contradict one another, none too many; None when not known."""
    work: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Seconds of the processor for z3, for cvc5 and for the core."""


@dataclass(frozen=True)
class TheoremResult:
    """One theorem with its verdict; `reason` is one line when it is not PROVED."""

    name: str
    sentence: str
    remark: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    verdict: Verdict
    reason: str
    queries: tuple[QueryResult, ...]
    seconds: float
    premises: tuple[str, ...] = ()
    """Names of all premises of its claims."""
    unused: tuple[str, ...] = ()
    """Those that no proof of the theorem needs."""
    work: float = 0.0
    """Seconds of the processor for all of it: exploring, building, writing, both solvers, cores."""


def prove(
    document: str,
    out_dir: Path,
    progress: Callable[[str], None],
    limit_ms: int = LIMIT_MS,
    z3_solver: Solver = ask_z3,
    cvc5_solver: Solver = ask_cvc5,
) -> list[TheoremResult]:
    """Prove every theorem of `proofs/<document>`; one result each, in a fixed order.

    out_dir: gets one folder a theorem with one `.smt2` file a query; folders of an earlier run are replaced.
    progress: called with one line a theorem. limit_ms: time limit a query and solver, in milliseconds.
    Raises TheoremError: no such document, no theorem, a name used twice.
    """
    return prove_all(theorems_of(document), out_dir, progress, limit_ms, z3_solver, cvc5_solver)


def prove_all(
    theorems: Iterable[Theorem],
    out_dir: Path,
    progress: Callable[[str], None],
    limit_ms: int = LIMIT_MS,
    z3_solver: Solver = ask_z3,
    cvc5_solver: Solver = ask_cvc5,
) -> list[TheoremResult]:
    """Prove the given theorems (see `prove`)."""
    results: list[TheoremResult] = []
    for item in theorems:
        result = _prove_one(item, out_dir / item.name, limit_ms, z3_solver, cvc5_solver)
        results.append(result)
        progress(f"{result.verdict} {result.name} ({len(result.queries)} queries, {result.seconds:.1f} s)")
    return results


def _prove_one(
    item: Theorem, folder: Path, limit_ms: int, z3_solver: Solver, cvc5_solver: Solver
) -> TheoremResult:
    started, begun = time.monotonic(), time.process_time()
    queries: list[QueryResult] = []
    built: tuple[Query, ...] = ()
    try:
        built = item.queries()
        _empty(folder)
        for number, query in enumerate(built, start=1):
            file = folder / f"{number:03d}-{_slug(query.name)}.smt2"
            queries.append(_ask(item, query, file, limit_ms, z3_solver, cvc5_solver))
        verdict, reason = judge(queries)
    except (
        Exception
    ) as error:  # a theorem that cannot be built or asked is reported, and the others still run
        kind = "" if isinstance(error, TheoremError) else f"{type(error).__name__}: "
        verdict, reason = "UNJUDGED", kind + " ".join(str(error).split())
    seconds = time.monotonic() - started
    return TheoremResult(
        item.name,
        item.sentence,
        item.remark,
        item.clauses,
        item.findings,
        verdict,
        reason,
        tuple(queries),
        seconds,
        premises_of(built),
        unused_premises(built, queries) if verdict == "PROVED" else (),
        time.process_time() - begun,
    )


def _ask(
    item: Theorem, query: Query, file: Path, limit_ms: int, z3_solver: Solver, cvc5_solver: Solver
) -> QueryResult:
    started = time.monotonic()
    text = to_smtlib(item, query)
    _write(file, text)
    moments = [time.process_time()]
    first = z3_solver(query, text, limit_ms)
    moments.append(time.process_time())
    second = cvc5_solver(query, text, limit_ms)
    moments.append(time.process_time())
    as_expected = first.answer == second.answer == query.expected
    core = core_of(query) if as_expected and query.expected == "unsat" else None
    moments.append(time.process_time())
    return QueryResult(
        query.name,
        query.expected,
        first.answer,
        second.answer,
        time.monotonic() - started,
        file,
        query.twin_of,
        "" if as_expected else _detail(first, second),
        core,
        (moments[1] - moments[0], moments[2] - moments[1], moments[3] - moments[2]),
    )


def premises_of(built: Iterable[Query]) -> tuple[str, ...]:
    """Names of all premises of a theorem's claims."""
    names = [name for query in built if query.expected == "unsat" for name in query.formulas]
    return tuple(name for name in dict.fromkeys(names) if name != COUNTEREXAMPLE)


def unused_premises(built: tuple[Query, ...], results: Iterable[QueryResult]) -> tuple[str, ...]:
    """The premises that no core of a theorem's claims uses. A claim without a core counts as using all."""
    used: set[str] = set()
    for query, result in zip(built, results, strict=True):
        if query.expected == "unsat":
            used |= set(query.formulas if result.core is None else result.core)
    return tuple(name for name in premises_of(built) if name not in used)


def _detail(first: Judgment, second: Judgment) -> str:
    return "; ".join(part for part in (first.detail, second.detail) if part)


def _slug(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")[:60].strip("-")


def _empty(folder: Path) -> None:
    """A fresh folder, so that no file of an earlier run can be mistaken for one of this run."""
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)


def _write(file: Path, text: str) -> None:
    """Write through a temporary file, so that no half file is left under the name."""
    partial = file.with_suffix(".partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, file)

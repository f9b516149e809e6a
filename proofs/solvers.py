"""The two solvers. Z3 judges the formulas as built; cvc5 judges the exported text, so a wrong export shows
too.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Final, Literal

import z3

from proofs.theorem import Query

Answer = Literal["unsat", "sat", "unknown", "error"]


@dataclass(frozen=True)
class Judgment:
    """What a solver answered; `detail` is the reason for `unknown` or `error`, or an example that z3
    found.
    """

    answer: Answer
    detail: str = ""


Solver = Callable[[Query, str, int], Judgment]
"""A solver gets the query, its SMT-LIB 2 text, and a limit in milliseconds."""


def ask_z3(query: Query, text: str, limit_ms: int) -> Judgment:
    """Z3 on the formulas in memory (the text is not used).

    Where words and numbers stand in one query its plain core is taken: what the full solver would do before
    costs a hundred times what it saves.
    """
    solver = _z3_for(query)
    solver.set("timeout", limit_ms)
    solver.add(*query.formulas.values())
    answer = solver.check()
    if answer == z3.unsat:
        return Judgment("unsat")
    if answer == z3.sat:
        return Judgment("sat", _example(solver.model()))
    return Judgment("unknown", solver.reason_unknown())


def _z3_for(query: Query) -> z3.Solver:
    return z3.SimpleSolver() if query.logic == "ALL" else z3.SolverFor(query.logic)


CORE_LIMIT: Final = 50_000_000
"""Steps of z3 for one question about a core: z3's own count, the same on a busy machine."""


def core_of(query: Query) -> tuple[str, ...] | None:
    """Names of the formulas of an `unsat` query that contradict one another, none of which can be left out.

    Each formula in turn is left out if the rest still contradict one another, so that the result does not
    depend on what z3 was asked before. None when z3 does not find out within its limit, and where it is not
    asked: in real arithmetic with products it takes minutes. A formula outside the core was not needed for
    the proof.
    """
    if query.logic == "QF_NRA":
        return None
    solver = _z3_for(query)
    solver.set("rlimit", CORE_LIMIT)
    marks = {name: z3.Bool(f"asserted {number}") for number, name in enumerate(query.formulas)}
    for name, mark in marks.items():
        solver.add(z3.Implies(mark, query.formulas[name]))
    core = list(marks)
    if solver.check(*marks.values()) != z3.unsat:
        return None
    for name in marks:
        answer = solver.check(*[marks[other] for other in core if other != name])
        if answer == z3.unknown:
            return None
        if answer == z3.unsat:
            core.remove(name)
    return tuple(core)


def ask_cvc5(query: Query, text: str, limit_ms: int) -> Judgment:
    """cvc5 on the exported text (the formulas in memory are not used). Every failure is the answer
    `error`.
    """
    try:
        import cvc5
    except ImportError as error:
        return Judgment("error", f"cvc5 cannot be loaded: {error}")
    try:
        solver = cvc5.Solver(cvc5.TermManager())
        solver.setOption("tlimit-per", str(limit_ms))
        parser = cvc5.InputParser(solver)
        parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, text, "query")
        said = ""
        while not (command := parser.nextCommand()).isNull():
            said += str(command.invoke(solver, parser.getSymbolManager()))
    except Exception as error:  # the binding raises several unrelated types; none of them is an answer
        return Judgment("error", " ".join(str(error).split())[:300])
    return _answer_of(said.strip())


def _answer_of(said: str) -> Judgment:
    if said == "unsat":
        return Judgment("unsat")
    if said == "sat":
        return Judgment("sat")
    if said.startswith("unknown"):
        return Judgment("unknown", f"cvc5: {said}")
    return Judgment("error", f"cvc5 said {said[:300]!r}")


def _example(model: z3.ModelRef) -> str:
    values: Mapping[str, z3.ExprRef] = {decl.name(): model[decl] for decl in model.decls()}
    return ", ".join(f"{name} = {_readable(values[name])}" for name in sorted(values))


def _readable(value: z3.ExprRef) -> str:
    if z3.is_bv_value(value) and value.size() == 16:
        return f"{value.as_long():04X}H"
    return str(value)


def versions() -> dict[str, str]:
    """Installed versions of the solvers, by package name."""
    return {"z3-solver": version("z3-solver"), "cvc5": version("cvc5")}

"""A query as an SMT-LIB 2 file that a person can read and any solver can judge."""

import re
import textwrap

import z3

from proofs.theorem import Query, Theorem


def to_smtlib(theorem: Theorem, query: Query) -> str:
    """The query as SMT-LIB 2.6 text; the header says the theorem, its clauses and the expected answer.

    The expected answer stands in a comment only, so that no solver knows it.
    """
    meaning = {
        "unsat": "no counterexample exists",
        "sat": "the premises of the claim can be met" if query.twin_of else "an example exists",
    }
    header = [
        ("Theorem", theorem.sentence),
        ("Name", theorem.name),
        ("Query", query.name),
        ("Clauses", ", ".join(theorem.clauses)),
        ("Findings", ", ".join(theorem.findings) or "none"),
        ("Expected", f"{query.expected} ({meaning[query.expected]})"),
    ]
    if query.twin_of:
        header.append(("Twin of", query.twin_of))
    lines = [line for label, text in header for line in _comment(label, text)]
    printed = {name: _printed(formula) for name, formula in query.formulas.items()}
    lines += [
        f"(set-logic {query.logic})",
        *sorted({declaration for symbols, _ in printed.values() for declaration in symbols}),
    ]
    for name, (_, assertion) in printed.items():
        lines += [*_comment("Assert", name), assertion]
    lines += ["(check-sat)", ""]
    return "\n".join(lines)


def _comment(label: str, text: str) -> list[str]:
    return textwrap.wrap(f"{label}: {text}", 100, initial_indent="; ", subsequent_indent=";   ")


_DECLARATION = re.compile(r"^\(declare-fun .*\)$", re.MULTILINE)
_SHARED = re.compile(r"([?$])x\d+")
_NUMERAL = re.compile(r"\(_ bv(\d+) 16\)")


def _printed(formula: z3.BoolRef) -> tuple[list[str], str]:
    """The declarations of the formula's free symbols, and the formula as z3's plain printer writes it: every
    term that occurs more than once has a name.

    The names are z3's own numbers of terms, which differ from run to run; they are counted anew from 1.
    Words are written as four hexadecimal digits.
    """
    # to_smt2() calls this too, but it needs a solver for every formula and takes 25 times as long.
    text = z3.Z3_benchmark_to_smtlib_string(
        formula.ctx.ref(), "", "", "unknown", "", 0, (z3.Ast * 0)(), formula.as_ast()
    )
    symbols = _DECLARATION.findall(text)
    if "(assert" not in text:  # z3 leaves out what is true by itself
        return symbols, "(assert true)"
    text = text[text.index("(assert") : text.rindex("(check-sat)")]
    numbers: dict[str, str] = {}
    text = _SHARED.sub(lambda found: numbers.setdefault(found[0], f"{found[1]}x{len(numbers) + 1}"), text)
    text = _NUMERAL.sub(lambda found: f"#x{int(found[1]):04x}", text)
    return symbols, re.sub(r"\A\(assert\s+", "(assert ", text.rstrip())

"""A query as an SMT-LIB 2 file that a person can read and any solver can judge."""

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
    lines += [f"(set-logic {query.logic})", *_declarations(query)]
    for name, formula in query.formulas.items():
        lines += _comment("Assert", name)
        lines.append(f"(assert {formula.sexpr()})")
    lines += ["(check-sat)", ""]
    return "\n".join(lines)


def _comment(label: str, text: str) -> list[str]:
    return textwrap.wrap(f"{label}: {text}", 100, initial_indent="; ", subsequent_indent=";   ")


def _declarations(query: Query) -> list[str]:
    """One `declare-const` for each free symbol, by name."""
    symbols: dict[str, z3.FuncDeclRef] = {}
    seen: set[int] = set()
    stack: list[z3.AstRef] = list(query.formulas.values())
    while stack:
        node = stack.pop()
        if node.get_id() in seen:
            continue
        seen.add(node.get_id())
        if z3.is_const(node) and node.decl().kind() == z3.Z3_OP_UNINTERPRETED:
            symbols[node.decl().name()] = node.decl()
        stack.extend(node.children())
    return [symbols[name].sexpr() for name in sorted(symbols)]

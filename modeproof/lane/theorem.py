"""One theorem: what its verdict rests on, and its evidence."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import is_there, reached
from modeproof.ground.places import build, within
from modeproof.ground.solvers import needing_solvers
from modeproof.kit.by_name import module_named

CODE = ("modeproof.lane.theorem", "proofs.runner")
"""What runs a theorem and judges the answers."""


def theorems_of(document: str) -> list[Any]:
    """The theorems of a document. Raises Unjudged when they cannot be imported."""
    with needing_solvers():
        from proofs import theorem
    # libz3 refuses wrong sorts by itself; its Python layer would check every argument once more.
    vars(module_named("z3.z3"))["Z3_DEBUG"] = False
    try:
        return list(theorem.theorems_of(document))
    except (theorem.TheoremError, ImportError) as error:
        raise Unjudged(f"proofs of {document}: {error}") from None


def rests_of(place: Path, document: str, module: str) -> evidence.Rests:
    """What the verdict on a theorem of a module rests on: what that module, and the code that all theorems of
    the document share, need; the registers that proofs read; the solvers. Raises Unjudged.
    """
    entries = [module]
    if is_there(place, shared := f"proofs.{document}.prepared"):
        entries.append(shared)
    registers = [place / "spec" / document / f"{name}.toml" for name in ("interface", "properties")]
    code = [path for path in reached(place, *entries) if path.is_relative_to(place / "refimpl")]
    inputs = evidence.hashes(place, [*code, *(path for path in registers if path.is_file())])
    return evidence.Rests(inputs, (*CODE, *entries), evidence.solvers())


def prove_theorem(
    place: Path, document: str, name: str, rests: evidence.Rests, limit_ms: int, shared_s: float
) -> dict[str, Any]:
    """Prove one theorem and write its evidence; shared_s: the seconds of the processor for what was made for
    all theorems together.

    Raises Unjudged when the proofs cannot be imported or a file cannot be written.
    """
    if str(place) not in sys.path:
        sys.path.insert(0, str(place))
    one = next(theorem for theorem in theorems_of(document) if theorem.name == name)
    with needing_solvers():
        from proofs import runner
    out = build(place) / "proofs" / document
    evidence.discard(place, document, name)
    started = time.time()
    try:
        (result,) = runner.prove_all([one], out, lambda line: None, limit_ms)
    except OSError as error:
        raise Unjudged(f"{out}: {error.strerror or error}") from None
    good = result.verdict == "PROVED"
    record = evidence.make(
        kind="proof",
        id=name,
        document=document,
        verdict=result.verdict,
        expected="PROVED",
        as_expected=good,
        strength=f"{len(result.queries)} queries, each asked of two solvers",
        command=f"modeproof prove --document {document} {name}",
        started=started,
        seconds=result.seconds,
        inputs=rests.inputs,
        code=rests.code,
        place=place,
        tools=rests.tools,
        result={
            "sentence": result.sentence,
            "remark": result.remark,
            "clauses": list(result.clauses),
            "findings": list(result.findings),
            "properties": list(one.properties),
            "premises": list(result.premises),
            "unused": list(result.unused),
            "work": round(result.work, 3),
            "shared": round(shared_s, 3),
            "queries": [
                {
                    "name": query.name,
                    "expected": query.expected,
                    "z3": query.z3,
                    "cvc5": query.cvc5,
                    "twin_of": query.twin_of,
                    "seconds": round(query.seconds, 3),
                    "detail": query.detail,
                    "core": None if query.core is None else list(query.core),
                    "work": [round(part, 3) for part in query.work],
                    "smt2": within(place, query.smt2),
                    "smt2_sha256": evidence.sha256(query.smt2),
                }
                for query in result.queries
            ],
        },
        reason=result.reason if not good else "",
    )
    evidence.write(place, record)
    return record

"""Checks a kept certificate again, without any search: both solvers on obligations that are made anew."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cvc5
import z3

from modeproof.ground.errors import Unjudged
from programs.certificate import NAME, Obligation, obligations, read
from programs.command import about, make
from programs.product import Pair, Product, shown

LIMIT_MS = 300_000
"""For one obligation, of the clock."""


@dataclass(frozen=True)
class Rechecked:
    """What came out. answers: for each solver its answers other than `unsat`, by file. seconds: of CPU."""

    product: Product
    folder: Path
    files: int
    count: int
    answers: dict[str, dict[str, str]]
    seconds: dict[str, float]
    unreached: Sequence[Pair]

    @property
    def status(self) -> int:
        """0: everything is shown again. 1: an obligation does not hold. 2: a solver gave no answer."""
        found = {answer for answers in self.answers.values() for answer in answers.values()}
        return 1 if "sat" in found else 2 if found else 0

    def lines(self, seconds: float) -> Iterator[str]:
        """What is printed."""
        binding = self.product.binding
        name = f"{binding.unit.kind} {binding.unit.name} of {', '.join(binding.source.files)}"
        target = f"{binding.reference.device.name} ({binding.reference.document})"
        if self.status == 0:
            yield f"PROVED, checked again: {name} has the outputs of {target} in every scan from power-up"
        else:
            word = "REFUSED" if self.status == 1 else "UNKNOWN"
            yield f"{word}: {self.folder} does not show that {name} equals {target}"
        for solver, answers in self.answers.items():
            said = ", ".join(f"{file}: {answer}" for file, answer in list(answers.items())[:3])
            yield (
                f"  {solver:<11} {self.files - len(answers)} of {self.files} files unsat, {self.count} "
                f"questions in all, {self.seconds[solver]:.1f} s CPU{'; but ' + said if said else ''}"
            )
        for label, text in about(self.product):
            yield f"  {label:<11} {text}"
        pairs = len(self.product.nodes)
        way = "scans from power-up were replayed to each"
        if self.unreached:
            way = f"no scans are known to {', '.join(map(shown, self.unreached))}"
        yield f"  pairs       {pairs}; {way}"
        yield f"  effort      {seconds:.1f} s CPU"


def recheck(folder: Path) -> Rechecked:
    """Make all obligations anew from the sources and the relations of the certificate, and judge them.

    Raises Unjudged: the sources, the binding or the reference have changed, or the certificate was edited.
    """
    kept = read(folder)
    record = kept.record
    try:
        given = kept.table("binding")
        names = {"names": given["names"], "fixed": given["parameters"], "left_out": tuple(given["left_out"])}
        files, unit, target = kept.sources, str(record["unit"]), str(record["target"])
        product = make(files, target, unit, names, bool(record["wrap"]), tuple(record["split"]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Unjudged(f"{folder / NAME}: not the form of a certificate: {error!r:.100}") from None
    ways = kept.fill(product)
    unreached = kept.follow(product, ways)
    owed = list(obligations(product))
    kept.compare({part.file: part.text for part in owed})
    answers: dict[str, dict[str, str]] = {}
    seconds: dict[str, float] = {}
    for name, solver in SOLVERS.items():
        started = time.process_time()
        said = {part.file: solver(part) for part in owed}
        answers[name] = {file: answer for file, answer in said.items() if answer != "unsat"}
        seconds[name] = time.process_time() - started
    count = sum(part.count for part in owed)
    return Rechecked(product, folder, len(owed), count, answers, seconds, unreached)


def _z3(owed: Obligation) -> str:
    """z3 on the text."""
    context = z3.Context()
    said = str(z3.Z3_eval_smtlib2_string(context.ref(), f"(set-option :timeout {LIMIT_MS})\n{owed.text}"))
    return _joint(said, owed)


def _cvc5(owed: Obligation) -> str:
    """cvc5 on the text. Every failure is an answer that begins with `error`."""
    said = ""
    try:
        solver = cvc5.Solver(cvc5.TermManager())
        solver.setOption("tlimit-per", str(LIMIT_MS))
        solver.setOption("incremental", "true")
        solver.setOption("ite-simp", "true")  # the scans of the reference are deep trees of choices
        solver.setOption("ext-rew-prep", "use")  # half the time for the words of the mode selection
        parser = cvc5.InputParser(solver)
        parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, owed.text, owed.file)
        while not (command := parser.nextCommand()).isNull():
            said += f"{command.invoke(solver, parser.getSymbolManager())}".strip() + "\n"
    except Exception as error:  # the binding raises several unrelated types; none of them is an answer
        return f"error: {' '.join(str(error).split())[:200]}"
    return _joint(said, owed)


def _joint(said: str, owed: Obligation) -> str:
    """`unsat` if all questions were answered so; else `sat`, or what else was said."""
    answers = said.split()
    if answers == ["unsat"] * owed.count:
        return "unsat"
    if len(answers) == owed.count and set(answers) <= {"sat", "unsat"}:
        return "sat"
    return f"no answer: {' '.join(answers)[:200]}"


SOLVERS: dict[str, Callable[[Obligation], str]] = {"z3": _z3, "cvc5": _cvc5}
"""Each judges the text of an obligation: `unsat`, or what else was said."""

"""Checks a kept certificate again, without any search: both solvers on obligations that are made anew."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cvc5
import z3

from modeproof.ground.errors import Unjudged
from programs.certificates import change_certificate, demand_certificate, property_certificate
from programs.certificates.certificate_folder import NAME, Obligation, record_in
from programs.certificates.demand_certificate import REFERENCE
from programs.certificates.equality_certificate import FORMAT, obligations, read
from programs.demands.verdicts import Judgement as DemandJudgement
from programs.equality.comparison import about, make
from programs.equality.product import Pair, Product, shown
from programs.equality.two_programs import Pair as Two
from programs.invariants.induction import Proof
from programs.properties.property_verdicts import Judgement
from programs.properties.transition_system import Asked

FORMATS = (FORMAT, property_certificate.FORMAT, demand_certificate.FORMAT, change_certificate.FORMAT)
FOLLOWS = "follows"
"""The folder in the certificate of equality that holds that of the demands."""
LIMIT_MS = 300_000
"""For one obligation, of the clock."""


@dataclass(frozen=True)
class Answers:
    """What both solvers said: answers other than `unsat`, by solver and file, and the seconds of CPU."""

    folder: Path
    files: int
    count: int
    answers: Mapping[str, Mapping[str, str]]
    seconds: Mapping[str, float]

    @property
    def status(self) -> int:
        """0: everything is shown again. 1: an obligation does not hold. 2: a solver gave no answer."""
        found = {answer for answers in self.answers.values() for answer in answers.values()}
        return 1 if "sat" in found else 2 if found else 0

    @property
    def word(self) -> str:
        """The status as a word."""
        return ("PROVED, checked again", "REFUSED", "UNKNOWN")[self.status]

    def lines(self) -> Iterator[str]:
        """What is printed of both solvers."""
        for solver, answers in self.answers.items():
            said = ", ".join(f"{file}: {answer}" for file, answer in list(answers.items())[:3])
            yield (
                f"  {solver:<11} {self.files - len(answers)} of {self.files} files unsat, {self.count} "
                f"questions in all, {self.seconds[solver]:.1f} s CPU{'; but ' + said if said else ''}"
            )


@dataclass(frozen=True)
class Rechecked:
    """What came out. unreached: pairs to which no scans are known. about: the lines that say of what."""

    answers: Answers
    about: Sequence[str]
    unreached: Sequence[Pair] = ()

    @property
    def status(self) -> int:
        """As the answers'."""
        return self.answers.status

    def lines(self, seconds: float) -> Iterator[str]:
        """What is printed."""
        first, *rest = self.about
        yield first
        yield from self.answers.lines()
        yield from rest
        yield f"  effort      {seconds:.1f} s CPU"


ALIKE = ("target", "document", "unit", "free_parameters", "fixed_parameters", "binding", "wrap", "sources")
"""What two certificates say that are about one program with one binding."""


def folders_of(folder: Path) -> list[Path]:
    """The folders of certificates in this one. Raises Unjudged: one that rests on another is without it."""
    own = record_in(folder, *FORMATS)
    if own["format"] == demand_certificate.FORMAT and own.get("subject") == REFERENCE:
        raise Unjudged(
            f"{folder}: it is of the reference; name the folder above, with the certificate of equality"
        )
    inner = folder / FOLLOWS
    if not inner.is_dir():
        return [folder]
    other = record_in(inner, demand_certificate.FORMAT)
    if odd := next((key for key in ALIKE if own.get(key) != other.get(key)), ""):
        raise Unjudged(f"{inner}: its {odd} is not that of the certificate in {folder}")
    return [folder, inner]


def recheck(folder: Path) -> Rechecked:
    """Make all obligations anew from the sources and from what the certificate found, and judge them.

    Raises Unjudged: the sources, the binding or the reference have changed, or the certificate was edited.
    """
    kinds = {
        FORMAT: _equality,
        property_certificate.FORMAT: _properties,
        demand_certificate.FORMAT: _demands,
        change_certificate.FORMAT: _change,
    }
    return kinds[record_in(folder, *kinds)["format"]](folder)


def _demands(folder: Path) -> Rechecked:
    kept = demand_certificate.read(folder)
    judgement = kept.judgement()
    proofs = kept.proofs(judgement)
    owed = demand_certificate.obligations(judgement, proofs)
    kept.compare({part.file: part.text for part in owed})
    answers = asked(folder, owed)
    return Rechecked(answers, list(_about_demands(kept.record, judgement, proofs, answers)))


def _about_demands(
    record: Mapping[str, Any],
    judgement: DemandJudgement,
    proofs: Sequence[Any],
    answers: Answers,
) -> Iterator[str]:
    name = f"{record['unit']} of {', '.join(record['sources'])}"
    count = sum(bool(asked.clauses) for asked, _ in proofs)
    page, of = f"the page ({record['document']})", record["subject"]
    if answers.status == 0 and of == REFERENCE:
        yield f"{answers.word}: the reference keeps {count} demands of {page}, for ever"
        yield f"  so          {name} FOLLOWS {page}: the certificate in the folder above shows it to be equal"
    elif answers.status == 0:
        yield f"{answers.word}: {name} FOLLOWS {page}: {count} demands, for ever"
    else:
        yield f"{answers.word}: {answers.folder} does not show that {name} follows the page"
    for asked, proof in proofs:
        count = len(proof.lemmas)
        scans = f"{proof.deep} scan{'s' * (proof.deep != 1)}"
        yield f"  {asked.id}: {asked.says}"
        yield f"    {asked.text}; {count} invariant{'s' * (count != 1)}, over {scans}"
    yield f"  latency     {judgement.beside.latency}"
    for text in judgement.beside.assumed.words():
        yield f"  assumed     {text}"


def _equality(folder: Path) -> Rechecked:
    kept = read(folder)
    record = kept.record
    try:
        given = kept.table("binding")
        names = {"names": given["names"], "fixed": given["parameters"], "left_out": tuple(given["left_out"])}
        kept.files("binding_file")
        files, unit, target = kept.files("sources"), str(record["unit"]), str(record["target"])
        product = make(files, target, unit, names, bool(record["wrap"]), tuple(record["split"]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Unjudged(f"{folder / NAME}: not the form of a certificate: {error!r:.100}") from None
    ways = kept.fill(product)
    unreached = kept.follow(product, ways)
    owed = list(obligations(product))
    kept.compare({part.file: part.text for part in owed})
    answers = asked(folder, owed)
    return Rechecked(answers, list(_about_equality(product, answers, unreached)), unreached)


def _about_equality(product: Product, answers: Answers, unreached: Sequence[Pair]) -> Iterator[str]:
    binding = product.binding
    name = f"{binding.unit.kind} {binding.unit.name} of {', '.join(binding.source.files)}"
    target = f"{binding.reference.device.name} ({binding.reference.document})"
    if answers.status == 0:
        yield f"{answers.word}: {name} has the outputs of {target} in every scan from power-up"
    else:
        yield f"{answers.word}: {answers.folder} does not show that {name} equals {target}"
    for label, text in about(product):
        yield f"  {label:<11} {text}"
    yield f"  pairs       {len(product.nodes)}; {_way_to(unreached)}"


def _change(folder: Path) -> Rechecked:
    kept, pair, product = change_certificate.read(folder)
    ways = kept.fill(product, change_certificate.claim_of(pair, product, kept.record))
    unreached = kept.follow(product, ways)
    owed = list(obligations(product))
    kept.compare({part.file: part.text for part in owed})
    answers = asked(folder, owed)
    return Rechecked(answers, list(_about_change(kept.record, pair, product, answers, unreached)), unreached)


def _about_change(
    record: Mapping[str, Any],
    pair: Two,
    product: Product,
    answers: Answers,
    unreached: Sequence[Pair],
) -> Iterator[str]:
    new = f"{pair.new.name} of {', '.join(record['sources'])}"
    old = f"{record['old_unit']} of {', '.join(record['old_sources'])}"
    if answers.status == 0:
        yield f"{answers.word}: {new} gives the outputs of {old} in every scan, for ever"
    else:
        yield f"{answers.word}: {answers.folder} does not show that {new} gives the outputs of {old}"
    yield f"  compared    {', '.join(record['compared'])}"
    if record["unless"]:
        yield f"  except      where {record['unless']}"
    if record["constant"]:
        yield f"  constant    {', '.join(record['constant'])}: as in the first scan"
    yield f"  numbers     {'wrap' if record['wrap'] else 'stay within their types in both'}"
    yield f"  pairs       {len(product.nodes)}; {_way_to(unreached)}"


def _way_to(unreached: Sequence[Pair]) -> str:
    if unreached:
        return f"no scans are known to {', '.join(map(shown, unreached))}"
    return "scans from power-up were replayed to each"


def _properties(folder: Path) -> Rechecked:
    kept = property_certificate.read(folder)
    judgement = kept.judgement()
    proofs = kept.proofs(judgement)
    owed = list(property_certificate.obligations(judgement, proofs))
    kept.compare({part.file: part.text for part in owed})
    answers = asked(folder, owed)
    return Rechecked(answers, list(_about_properties(judgement, proofs, answers)))


def _about_properties(
    judgement: Judgement, proofs: Sequence[tuple[Asked, Proof]], answers: Answers
) -> Iterator[str]:
    cell = judgement.cell
    name = f"{cell.unit.kind} {cell.unit.name} of {', '.join(cell.source.files)}"
    if answers.status == 0:
        yield f"{answers.word}: {len(proofs)} properties of {name} in every scan from power-up"
    else:
        yield f"{answers.word}: {answers.folder} does not show the properties of {name}"
    for asked, proof in proofs:
        count = len(proof.lemmas)
        yield f"  {asked.id}: {asked.sentence}"
        scans = f"{proof.deep} scan{'s' * (proof.deep != 1)}"
        yield f"    {asked.text}; {count} invariant{'s' * (count != 1)}, over {scans}"
    triggers = sum(len(asked.trigger) for asked, _ in proofs)
    yield f"  not empty   {triggers} triggers; scans from power-up to each were run again"


def asked(folder: Path, owed: Sequence[Obligation]) -> Answers:
    """Both solvers on every text."""
    answers: dict[str, dict[str, str]] = {}
    seconds: dict[str, float] = {}
    for name, solver in SOLVERS.items():
        started = time.process_time()
        said = {part.file: solver(part) for part in owed}
        answers[name] = {file: answer for file, answer in said.items() if answer != "unsat"}
        seconds[name] = time.process_time() - started
    return Answers(folder, len(owed), sum(part.count for part in owed), answers, seconds)


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

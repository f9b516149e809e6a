"""The certificate that a program follows the page: for each demand an invariant, and what must be `unsat`.

The questions are over the program as it was translated, beside the observer of the demands. That every value
stays within its type is asked first where there is something to it, and the demands build on it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from programs.certificates import inductive, kept_proofs
from programs.certificates.certificate_folder import (
    VERSION,
    Obligation,
    Stored,
    digest,
    empty,
    fill,
    record_in,
    tools,
)
from programs.certificates.inductive import Claim, read_invariants
from programs.demands.assumptions import Assumed
from programs.demands.reference_subject import Implementation
from programs.demands.register import demands_of
from programs.demands.subject import Program
from programs.demands.verdicts import Asked, Found, Judgement
from programs.demands.watched import Beside
from programs.equality.comparison import make
from programs.equality.product import Product
from programs.invariants.induction import DEEPEST, Proof

FORMAT: Final = "modeproof-demand-certificate"
TRUSTED: Final = (
    "the reader and translator of programs (compared with a separate interpreter in random scans)",
    "the model of the timers and of the other standard blocks",
    "the binding of names",
    "the reading of demands as terms (compared with the kit's in random scans)",
)
"""Besides the solver."""
PROGRAM, REFERENCE = "program", "reference"
"""Of what the demands are proved; if of the reference, they hold of a program that is proved equal to it."""
REGISTERS = ("interface.toml", "demands.toml", "sequences.toml")


def register_files(document: str) -> dict[str, str]:
    """The SHA-256 of every file that says what the document demands."""
    place = root()
    paths = [place / "spec" / document / name for name in REGISTERS]
    paths.append(place / "proofs" / document / "devices.py")
    return {str(path.relative_to(place)): digest(path) for path in paths if path.is_file()}


def obligations(judgement: Judgement, found: Sequence[tuple[Asked, Proof]]) -> list[Obligation]:
    """For each demand what must be `unsat`, so that its proof is one."""
    claims = [Claim(asked.id, asked.text, judgement.plainly_bad(asked), proof) for asked, proof in found]
    return list(inductive.obligations(judgement.beside.system, claims))


def write(
    judgement: Judgement, product: Product, found: Sequence[Found], folder: Path, binding: Path | None
) -> None:
    """Write the certificate of demands that are all PROVED. binding: the file of the binding.

    Raises Unjudged: the folder holds something else, or no certificate can be written.
    """
    system = judgement.beside.system
    try:
        proofs = [
            (one.asked, inductive.kept(system, judgement.plainly_bad(one.asked), one.proof))
            for one in found
            if one.proof is not None
        ]
        texts = {owed.file: owed.text for owed in obligations(judgement, proofs)}
    except (NotImplementedError, TimeoutError) as error:
        raise Unjudged(f"{folder}: no certificate can be written: {error}") from None
    rows = [
        {
            "id": asked.id,
            "by": proof.by,
            "scans": proof.deep,
            "invariants": [lemma.sexpr() for lemma in proof.lemmas],
        }
        for asked, proof in proofs
    ]
    kept = {"binding_file": {} if binding is None else {str(binding): digest(binding)}}
    empty(folder)
    fill(folder, {**claim(judgement, product), **kept, "proofs": rows}, texts)


def claim(judgement: Judgement, product: Product) -> dict[str, Any]:
    """What a certificate is about."""
    binding, beside = product.binding, judgement.beside
    return {
        "format": FORMAT,
        "version": VERSION,
        "target": binding.reference.device.name,
        "document": binding.reference.document,
        "unit": binding.unit.name,
        "subject": REFERENCE if isinstance(beside.subject, Implementation) else PROGRAM,
        "latency": beside.latency,
        "assumed": dict(beside.assumed.own),
        "assumptions": list(beside.assumed.words()),
        "demands": [[asked.id, asked.says, list(asked.clauses), asked.text] for asked in judgement.every],
        "free_parameters": list(binding.free_parameters),
        "fixed_parameters": binding.values,
        "binding": {
            "names": dict(binding.names),
            "parameters": binding.chosen,
            "left_out": list(binding.left_out),
        },
        "wrap": product.wrap,
        "sources": dict(binding.source.files),
        "register": register_files(binding.reference.document),
        "trusted": list(TRUSTED),
        "tools": tools(),
    }


def judgement_of(
    product: Product,
    assumed: Mapping[str, Any],
    latency: int,
    vectors: Path | None,
    seconds: float,
    tell: Any,
) -> Judgement:
    """The program with what is demanded of it. Raises Unjudged."""
    of = product.binding.reference
    demands = demands_of(of)
    beside = Beside(Program(product), demands, Assumed(of, assumed, demands.constant), latency)
    beside.check()
    return Judgement(beside, vectors, seconds, tell, product.wrap)


def of_reference(judgement: Judgement) -> Judgement:
    """The same demands under the same assumptions, asked of the reference with the binding's parameters."""
    beside = judgement.beside
    subject = Implementation(beside.subject.reference, beside.subject.fixed)
    own = Beside(subject, beside.demands, beside.assumed, beside.latency)
    kept = kept_proofs.of_subject(root(), subject, own.system)
    return Judgement(
        own, judgement.vectors, judgement.seconds, judgement.tell, kept=kept.proofs, places=kept.places
    )


# ---------------------------------------------------------------- reading


@dataclass(frozen=True)
class Kept(Stored):
    """A certificate of demands as it was read."""

    def judgement(self) -> Judgement:
        """The program with its demands, as the files say. Raises Unjudged: they have changed."""
        record = self.record
        try:
            given = self.table("binding")
            names = {
                "names": given["names"],
                "fixed": given["parameters"],
                "left_out": tuple(given["left_out"]),
            }
            self.files("binding_file")
            sources, unit = self.files("sources"), str(record["unit"])
            product = make(sources, str(record["target"]), unit, names, record["wrap"] is True)
            latency = int(record["latency"])
            found = judgement_of(product, self.table("assumed"), latency, None, 0.0, lambda text: None)
            if record["subject"] == REFERENCE:
                found = of_reference(found)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise self.refuse(f"not the form of a certificate: {error!r:.100}") from None
        self.same("register", register_files(product.binding.reference.document))
        self.claims(claim(found, product))
        return found

    def proofs(self, judgement: Judgement) -> list[tuple[Asked, Proof]]:
        """The proof of each demand. Raises Unjudged: one is not there, or has not the form of one."""
        rows = self.record.get("proofs")
        if not isinstance(rows, list) or len(rows) != len(judgement.every) or judgement.beside.unjudged:
            raise self.refuse("it has not one proof for each demand")
        found = []
        for asked, row in zip(judgement.every, rows, strict=True):
            try:
                deep = row["scans"]
                if row["id"] != asked.id or type(deep) is not int or not 1 <= deep <= DEEPEST:
                    raise ValueError(f"{row['id']} over {deep} scans")
                lemmas = read_invariants(judgement.beside.system, row["invariants"])
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                raise self.refuse(f"{asked.id}: not the form of a certificate: {error!r:.200}") from None
            found.append((asked, Proof(deep, lemmas, str(row["by"]))))
        return found


def read(folder: Path) -> Kept:
    """The certificate of demands in a folder. Raises Unjudged."""
    return Kept(folder, record_in(folder, FORMAT))

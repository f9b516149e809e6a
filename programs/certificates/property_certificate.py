"""The certificate of proofs of properties: for each property an invariant, and what must be `unsat`.

The questions are over the program as it was translated; of memory only what the property depends on stands in
them. That every value stays within its type is a property of its own, the first, and the others build on it.
What makes a property say something, its trigger, is shown by scans from power-up that are run again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from modeproof.ground.errors import Unjudged
from programs.certificates import inductive
from programs.certificates.certificate_folder import (
    VERSION,
    Obligation,
    Stored,
    digest,
    empty,
    fill,
    record_in,
    reference_files,
    tools,
)
from programs.certificates.inductive import Claim, read_invariants
from programs.invariants.induction import DEEPEST, Proof
from programs.properties.property_file import read_questions
from programs.properties.property_verdicts import Found, Judgement, never
from programs.properties.transition_system import Asked, Cell, Scans
from programs.readers.sources import read_sources

FORMAT: Final = "modeproof-property-certificate"
TRUSTED: Final = (
    "the reader and translator of programs",
    "the model of the timers",
    "the path explorer, which reads the blocks",
)
"""Besides the solver."""


# ---------------------------------------------------------------- obligations


def obligations(judgement: Judgement, found: Sequence[tuple[Asked, Proof]]) -> Iterator[Obligation]:
    """For each property what must be `unsat`, so that its proof is one."""
    claims = [Claim(asked.id, asked.text, judgement.plainly_bad(asked), proof) for asked, proof in found]
    yield from inductive.obligations(judgement.whole, claims)


def pruned(judgement: Judgement, asked: Asked, proof: Proof) -> Proof:
    """The proof with the invariants alone that it needs. Raises TimeoutError."""
    return inductive.pruned(judgement.whole, judgement.plainly_bad(asked), proof)


# ---------------------------------------------------------------- writing


def write(judgement: Judgement, found: Sequence[Found], properties: Path, folder: Path) -> None:
    """Write the certificate of properties that are all PROVED, into a folder that is new or an older one.

    Raises Unjudged: the folder holds something else, or no certificate can be written.
    """
    try:
        proofs = [(one.asked, _kept(judgement, one)) for one in found]
        texts = {owed.file: owed.text for owed in obligations(judgement, proofs)}
    except (NotImplementedError, TimeoutError) as error:
        raise Unjudged(f"{folder}: no certificate can be written: {error}") from None
    rows = [
        {
            "id": asked.id,
            "by": proof.by,
            "scans": proof.deep,
            "invariants": [lemma.sexpr() for lemma in proof.lemmas],
            "reached_by": [
                {
                    "retained": dict(trace.retained),
                    "scans": [{"dt_ms": dt_ms, "in": dict(inputs)} for dt_ms, inputs in trace.scans],
                }
                for trace in one.reached
            ],
        }
        for one, (asked, proof) in zip(found, proofs, strict=True)
    ]
    empty(folder)
    fill(folder, {**claim(judgement, properties), "proofs": rows}, texts)


def _kept(judgement: Judgement, found: Found) -> Proof:
    """The proof as it will be read again."""
    assert found.proof is not None
    return inductive.kept(judgement.whole, judgement.plainly_bad(found.asked), found.proof)


def claim(judgement: Judgement, properties: Path) -> dict[str, Any]:
    """What a certificate is about."""
    cell = judgement.cell
    return {
        "format": FORMAT,
        "version": VERSION,
        "unit": cell.unit.name,
        "wrap": cell.wrap,
        "scan_time_ms": list(cell.scan_time),
        "blocks": {name: block.reference.device.name for name, block in cell.blocks.items()},
        "asked": [[asked.id, asked.sentence, asked.text] for asked in judgement.every],
        "sources": dict(cell.source.files),
        "properties": {str(properties): digest(properties)},
        "reference": reference_of(cell),
        "trusted": list(TRUSTED),
        "tools": tools(),
    }


def reference_of(cell: Cell) -> dict[str, str]:
    """The files of the documents' blocks that a program calls, with their SHA-256."""
    documents = sorted({block.reference.document for block in cell.blocks.values()})
    return {path: known for document in documents for path, known in reference_files(document).items()}


# ---------------------------------------------------------------- reading


@dataclass(frozen=True)
class Kept(Stored):
    """A certificate of properties as it was read."""

    def judgement(self) -> Judgement:
        """The program with its properties, as the files say. Raises Unjudged: they have changed."""
        sources, questions = self.files("sources"), self.files("properties")
        if len(questions) != 1:
            raise self.refuse("it has not one file of properties")
        asked = read_questions(questions[0])
        source = read_sources(sources)
        unit = source.chosen(str(self.record.get("unit")))
        cell = Cell.of(source, unit, asked.times(source, unit), self.record.get("wrap") is True)
        found = Judgement(cell, asked.asked(cell), 0.0, lambda text: None)
        self.claims(claim(found, Path(next(iter(self.table("properties"))))))
        return found

    def proofs(self, judgement: Judgement) -> list[tuple[Asked, Proof]]:
        """The proof of each property. Raises Unjudged: one is not there, or has not the form of one."""
        rows = self.record.get("proofs")
        if not isinstance(rows, list) or len(rows) != len(judgement.every):
            raise self.refuse("it has not one proof for each property")
        found = []
        for asked, row in zip(judgement.every, rows, strict=True):
            try:
                deep = row["scans"]
                if row["id"] != asked.id or type(deep) is not int or not 1 <= deep <= DEEPEST:
                    raise ValueError(f"{row['id']} over {deep} scans")
                lemmas = read_invariants(judgement.whole, row["invariants"])
                self._follow(judgement.cell, asked, row["reached_by"])
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                raise self.refuse(f"{asked.id}: not the form of a certificate: {error!r:.200}") from None
            found.append((asked, Proof(deep, lemmas, str(row["by"]))))
        return found

    def _follow(self, cell: Cell, asked: Asked, rows: Sequence[Mapping[str, Any]]) -> None:
        """Run the scans to each trigger. Raises Unjudged: they do not lead there."""
        if len(rows) != len(asked.trigger):
            raise self.refuse(f"{asked.id}: it has not one way to each of its {len(asked.trigger)} triggers")
        for (text, trigger), row in zip(asked.trigger, rows, strict=True):
            scans: Scans = [(int(scan["dt_ms"]), dict(scan["in"])) for scan in row["scans"]]
            retained = dict(row["retained"])
            odd = _outside(cell, retained, scans)
            if odd or cell.run(retained, scans, never(asked, trigger)) is None:
                raise self.refuse(f"{asked.id}: the scans to `{text}` do not lead there{odd}")


def read(folder: Path) -> Kept:
    """The certificate of properties in a folder. Raises Unjudged."""
    return Kept(folder, record_in(folder, FORMAT))


def _outside(cell: Cell, retained: Mapping[str, Any], scans: Scans) -> str:
    """What scans start from or take that the claim is not about; nothing: it is about all of it."""
    low, high = cell.scan_time
    if any(dt_ms < low or dt_ms > (dt_ms if high is None else high) for dt_ms, _ in scans):
        return ": a scan is too short or too long"
    given = [(cell.inputs, inputs) for _, inputs in scans]
    if any(path not in cell.retained for path in retained):
        return ": a value at power-up is not RETAIN"
    for slots, values in [(cell.slots, retained), *given]:
        for path, value in values.items():
            if path not in slots or not slots[path].type.low <= value <= slots[path].type.high:
                return f": {path} is not, or cannot be {value}"
    return ""

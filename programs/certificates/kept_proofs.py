"""Proofs of the demands on a reference that were found once: invariants, kept beside the theorems.

They are believed by nobody. Whoever reads them asks both solvers again, over the code and the demands as they
are now; a proof that is none any more is searched for anew.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.kit.files import write_text
from modeproof.registers.profiles import PROFILES
from programs.certificates.inductive import read_invariants
from programs.demands.reference_subject import Implementation
from programs.invariants.induction import DEEPEST, Proof, System


def place_of(root: Path, document: str, target: str, profile: str) -> Path:
    """The file of a target in one of its profiles."""
    return root / "proofs" / document / "demands" / f"{target}_{profile}.json"


@dataclass(frozen=True)
class Kept:
    """What a file holds: proofs by the ids of their demands, and the names by which an invariant may be split
    where one has to be searched for.
    """

    proofs: Mapping[str, Proof]
    places: Sequence[str] = ()


def read(path: Path, system: System) -> Kept:
    """What is kept; without what is no formula over this system."""
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        rows, places = table["proofs"], [str(name) for name in table["places"]]
    except (OSError, ValueError, KeyError, TypeError):
        return Kept({})
    found = {}
    for row in rows:
        try:
            id, deep, by = str(row["id"]), row["scans"], str(row["by"])
            if type(deep) is int and 1 <= deep <= DEEPEST:
                found[id] = Proof(deep, read_invariants(system, row["invariants"]), by)
        except (KeyError, TypeError, ValueError):
            continue
    return Kept(found, places)


def of_subject(root: Path, subject: Implementation, system: System) -> Kept:
    """The proofs of the profile that the subject has; none where it has no such profile."""
    of = subject.reference
    for profile in PROFILES:
        chosen = Implementation.in_profile(of, profile).fixed
        if chosen.items() <= subject.fixed.items():
            return read(place_of(root, of.document, of.device.name, profile), system)
    return Kept({})


def write(path: Path, kept: Kept) -> None:
    """Keep these proofs and no others."""
    rows: list[Mapping[str, Any]] = [
        {
            "id": id,
            "by": proof.by,
            "scans": proof.deep,
            "invariants": [" ".join(lemma.sexpr().split()) for lemma in proof.lemmas],
        }
        for id, proof in kept.proofs.items()
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps({"places": [*kept.places], "proofs": rows}, indent=1) + "\n")

"""Proofs of the demands on a reference that were found once: invariants, kept beside the theorems.

They are believed by nobody. Whoever reads them asks both solvers again, over the code and the demands as they
are now; a proof that is none any more is searched for anew.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
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


def read(path: Path, system: System) -> dict[str, Proof]:
    """The proofs by the ids of their demands; without what is no formula over this system."""
    try:
        rows = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    found = {}
    for row in rows if isinstance(rows, list) else ():
        try:
            id, deep, by = str(row["id"]), row["scans"], str(row["by"])
            if type(deep) is int and 1 <= deep <= DEEPEST:
                found[id] = Proof(deep, read_invariants(system, row["invariants"]), by)
        except (KeyError, TypeError, ValueError):
            continue
    return found


def of_subject(root: Path, subject: Implementation, system: System) -> Mapping[str, Proof]:
    """The proofs of the profile that the subject has; none where it has no such profile."""
    of = subject.reference
    for profile in PROFILES:
        chosen = Implementation.in_profile(of, profile).fixed
        if chosen.items() <= subject.fixed.items():
            return read(place_of(root, of.document, of.device.name, profile), system)
    return {}


def write(path: Path, proofs: Iterable[tuple[str, Proof]]) -> None:
    """Keep these proofs and no others."""
    rows: list[Mapping[str, Any]] = [
        {
            "id": id,
            "by": proof.by,
            "scans": proof.deep,
            "invariants": [" ".join(lemma.sexpr().split()) for lemma in proof.lemmas],
        }
        for id, proof in proofs
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(rows, indent=1) + "\n")

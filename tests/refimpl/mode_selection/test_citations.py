"""Each clause that a device must carry out is cited by its own module, though another may speak for all."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.registers import load_document

ROOT = Path(__file__).resolve().parents[3]
CLAUSES = load_document(ROOT, "mode_selection").clauses
DEVICES = ("fplc", "plc", "hmi", "eks")


def cited(name: str) -> set[str]:
    source = (ROOT / "refimpl/mode_selection" / f"{name}.py").read_text(encoding="utf-8")
    return set(re.findall(r"\bEKS(?:-[A-Z0-9]+)+\b", source))


@pytest.mark.parametrize("device", DEVICES)
def test_the_code_cites_every_behaviour_clause_of_its_device(device: str) -> None:
    demanded = {c.id for c in CLAUSES if c.kind == "behaviour" and device in c.device}
    assert len(demanded) > 5
    assert sorted(demanded - cited(device)) == []

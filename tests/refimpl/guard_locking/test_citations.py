"""Each clause that the block must carry out is cited by its code, and no citation points to nothing."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
CLAUSES = tomllib.loads((ROOT / "spec/guard_locking/clauses.toml").read_text(encoding="utf-8"))["clause"]
FINDINGS = tomllib.loads((ROOT / "spec/guard_locking/findings.toml").read_text(encoding="utf-8"))["finding"]
SOURCE = (ROOT / "refimpl/guard_locking/sf_guard_locking.py").read_text(encoding="utf-8")
CITED = set(re.findall(r"\bGL(?:-[A-Z0-9]+)+\b", SOURCE))


def test_every_behaviour_clause_is_cited_by_the_code() -> None:
    demanded = {one["id"] for one in CLAUSES if one["kind"] == "behaviour"}
    assert len(demanded) > 15
    assert sorted(demanded - CITED) == []


def test_every_cited_clause_and_finding_exists() -> None:
    assert sorted(CITED - {one["id"] for one in CLAUSES}) == []
    assert set(re.findall(r"\bGLF-\d+\b", SOURCE)) <= {one["id"] for one in FINDINGS}

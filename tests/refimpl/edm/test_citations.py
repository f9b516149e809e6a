"""Each clause that the block must carry out is cited by its code, and no citation points to nothing."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
CLAUSES = tomllib.loads((ROOT / "spec/edm/clauses.toml").read_text(encoding="utf-8"))["clause"]
FINDINGS = tomllib.loads((ROOT / "spec/edm/findings.toml").read_text(encoding="utf-8"))["finding"]
SOURCE = (ROOT / "refimpl/edm/sf_edm.py").read_text(encoding="utf-8")
CITED = set(re.findall(r"\bEDM(?:-[A-Z0-9]+)+\b", SOURCE))


def test_every_behaviour_clause_is_cited_by_the_code() -> None:
    demanded = {one["id"] for one in CLAUSES if one["kind"] == "behaviour"}
    assert len(demanded) > 10
    assert sorted(demanded - CITED) == []


def test_every_cited_clause_and_finding_exists() -> None:
    assert sorted(CITED - {one["id"] for one in CLAUSES}) == []
    assert set(re.findall(r"\bEDMF-\d+\b", SOURCE)) <= {one["id"] for one in FINDINGS}

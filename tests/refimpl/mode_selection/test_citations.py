"""Each clause that a device must carry out is cited by its code, and no citation points to nothing."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
CLAUSES = tomllib.loads((ROOT / "spec/mode_selection/clauses.toml").read_text(encoding="utf-8"))["clause"]
DEVICES = ("fplc", "plc", "hmi", "eks")


def cited(name: str) -> set[str]:
    source = (ROOT / "refimpl/mode_selection" / f"{name}.py").read_text(encoding="utf-8")
    return set(re.findall(r"\bEKS(?:-[A-Z0-9]+)+\b", source))


@pytest.mark.parametrize("device", DEVICES)
def test_the_code_cites_every_behaviour_clause_of_its_device(device: str) -> None:
    demanded = {c["id"] for c in CLAUSES if c["kind"] == "behaviour" and device in c["device"]}
    assert len(demanded) > 5
    assert sorted(demanded - cited(device)) == []


@pytest.mark.parametrize("name", [*DEVICES, "code_tables", "permissions", "key_flows"])
def test_every_cited_clause_exists(name: str) -> None:
    assert cited(name)
    assert sorted(cited(name) - {c["id"] for c in CLAUSES}) == []

"""Premises that no proof needs are named, from the evidence of the proofs alone."""

from __future__ import annotations

from typing import Any

from modeproof.report.verdicts import never_needed


def record(name: str, premises: list[str], unused: list[str]) -> dict[str, Any]:
    return {"id": name, "result": {"premises": premises, "unused": unused}}


def test_a_premise_that_one_proof_needs_is_needed() -> None:
    one = record("one", ["a premise", "another"], ["a premise", "another"])
    other = record("other", ["a premise", "another"], ["another"])
    assert never_needed([one, other]) == ["another"]
    assert never_needed([one]) == ["a premise", "another"]
    assert never_needed([other]) == ["another"]

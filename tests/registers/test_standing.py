"""The class of a finding follows from the runs that try its readings."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.load import load_findings
from modeproof.registers.standing import ALLOWED, FORBIDDEN, OPEN, UNASKED, class_of, standings


def run(id: str, module: str, falls: str = "") -> Any:
    kind = id.partition("_")[0]
    return SimpleNamespace(id=id, kind=kind, module=module, readings=("Waits",), property=falls)


def finding(readings: int = 2, tries: tuple[str, ...] = ("Waits",), parameter: str = "") -> Any:
    evidence = ("NEG_a", "MC_b")
    return SimpleNamespace(
        tries=tries, readings=("r",) * readings, parameter=parameter, evidence=evidence, id="E-1"
    )


HOLDS = run("MC_demands", "BoxDemands")
DEMAND_FALLS = run("NEG_demands", "BoxDemands", "Shuts")
PROPERTY_FALLS = run("NEG_a", "BoxOpen", "Safe")
HARMLESS = run("MC_b", "BoxOpen")


@pytest.mark.parametrize(
    ("runs", "word", "broken", "kind"),
    [
        ([HOLDS, HARMLESS], OPEN, "", "open"),
        ([HOLDS, PROPERTY_FALLS], ALLOWED, "Safe", "safety"),
        ([DEMAND_FALLS, PROPERTY_FALLS], FORBIDDEN, "Shuts", "decided"),
        ([DEMAND_FALLS, HOLDS], FORBIDDEN, "Shuts", "decided"),
        ([PROPERTY_FALLS], UNASKED, "Safe", "safety"),
        ([HARMLESS], UNASKED, "", "open"),
    ],
)
def test_a_reading_stands_as_the_runs_show(runs: list[Any], word: str, broken: str, kind: str) -> None:
    (one,) = standings(finding(), runs)
    assert (one.word, one.broken) == (word, broken)
    assert class_of(finding(), runs) == kind


def test_a_finding_without_a_tried_reading_says_so() -> None:
    assert class_of(finding(readings=1), []) == "hazard"
    assert class_of(finding(tries=()), []) == "untried"
    assert class_of(finding(tries=()), [HARMLESS]) == "open"
    assert class_of(finding(tries=(), parameter="CHOICE"), [PROPERTY_FALLS]) == "safety"


def test_nobody_types_the_class(tree: Any) -> None:
    tree.edit("spec/door/findings.toml", "tries = []", 'tries = []\nseverity = "open"')
    with pytest.raises(Unjudged, match="E-01: severity is computed from the runs: remove it"):
        load_findings(tree.root, "door")

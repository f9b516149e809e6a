"""Each clause is demanded, or the register of demands says why not; what it names is there."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, root
from modeproof.registers.demands import load_demand_rows
from modeproof.registers.demands_page import check_demands, demands_pages, standing_of
from modeproof.registers.load import load_document

DEMANDS = """
[device.latch.demand.OpensOnRequest]
says = "It opens on request."
clauses = ["DR-1-1"]
when = "True"
holds = "True"
"""
REST = """
[undemanded]
definition = ["DR-1-2"]
"""


def problems(tree: Any, text: str) -> list[str]:
    (tree.root / "spec/door/demands.toml").write_text(text, encoding="utf-8")
    return [str(problem) for problem in check_demands(load_document(tree.root, "door"))]


def test_a_clause_that_nobody_names_is_left_over(tree: Any) -> None:
    left = problems(tree, DEMANDS)
    assert left and all("no demand cites it" in one for one in left)
    assert any("DR-1-2" in one for one in left) and not any("DR-1-1" in one for one in left)
    assert problems(tree, DEMANDS + REST) == []
    page = demands_pages(load_document(tree.root, "door"))["docs/door-demands.md"]
    assert "1 demanded, 1 definition" in page and "OpensOnRequest" in page


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('clauses = ["DR-1-1"]', 'clauses = ["DR-9-9"]', "OpensOnRequest: unknown clause 'DR-9-9'"),
        ('"DR-1-2"]', '"DR-1-2", "DR-1-1"]', "DR-1-1 is cited by a demand"),
        ('"DR-1-2"]', '"DR-1-2", "DR-9-9"]', "[undemanded]: unknown clause 'DR-9-9'"),
        ('"DR-1-2"]', '"DR-1-2"]\ndrawing = ["DR-1-2"]', "DR-1-2 has 2 reasons"),
        ('definition = ["DR-1-2"]', 'open = { "DR-1-2" = ["E-99"] }', "unknown finding 'E-99'"),
        ('definition = ["DR-1-2"]', 'open = { "DR-1-2" = [] }', "which finding lists what it allows?"),
    ],
)
def test_what_does_not_fit_is_named(tree: Any, old: str, new: str, said: str) -> None:
    assert (DEMANDS + REST).count(old) == 1
    assert any(said in one for one in problems(tree, (DEMANDS + REST).replace(old, new)))


def test_a_demand_needs_a_clause(tree: Any) -> None:
    with pytest.raises(Unjudged, match="OpensOnRequest"):
        problems(tree, DEMANDS.replace('["DR-1-1"]', "[]"))


def test_no_clause_of_the_documents_is_left_over() -> None:
    for name in documents(root()):
        document = load_document(root(), name)
        demands = load_demand_rows(root(), name)
        assert demands.rows and all(standing_of(clause, demands) for clause in document.clauses), name

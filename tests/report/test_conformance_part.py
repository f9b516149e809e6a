"""Conformance and proofs in the report: graphs, programs, theorems; what is missing shows in its place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.report.build import make
from modeproof.report.parts import conformance, proofs
from modeproof.report.verdicts import never_needed
from tests.report.paper import RESULT, declare_graph, entry, make_paper, put, without

THEOREM = "it_shuts_over_the_door_only"
COMPARED = {
    "run": "box/OPEN_Box",
    "device": "box",
    "implementation": "refimpl.box.box",
    "states": 2,
    "transitions": 4,
    "replayed": 4,
    "implementation_states": 2,
    "class_scans": 7,
    "classes": {"WORD other": 3},
    "covered": {"Stay": [2, 2], "Close": [1, 2]},
    "difference_count": 0,
}
PROGRAM = {
    "target": "box",
    "adapter": "box.c 1 <b>",
    "suite": "brief",
    "relation": "exact",
    "cases": 3,
    "cases_total": 3,
    "scans": 40,
    "unobserved": ["LAMP"],
    "covered": {"Close": [2, 2]},
    "clauses": {"BX-1-1": [5, 6]},
    "says": {"guarantees": "every step", "hypothesis": "all alike", "does_not_show": "the rest"},
}
AGREEMENT = {
    "rows": [
        {
            "id": "ShutsOverDoor",
            "environment": "arbitrary",
            "runs": ["MC_Box"],
            "tlc": "HOLDS",
            "theorem": THEOREM,
            "proved": "PROVED",
            "rests_on": ["A-01"],
            "reason": "",
            "note": "",
        }
    ]
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all its evidence, and a graph."""
    made = make_paper(tmp_path)
    declare_graph(made, "states = 2\nedges = 4\n")
    put(made, "OPEN_Box", result={"graph": {"states": 2, "edges": 4}})
    return made


def test_a_graph_stands_beside_the_program_compared_with_it(root: Path) -> None:
    put(root, "refimpl_OPEN_Box", kind="conformance", verdict="EQUAL", expected="EQUAL", result=COMPARED)
    graph = entry(conformance, root)["graphs"][0]
    one = graph["compared"][0]
    assert (graph["states"].value, graph["edges"].value) == (2, 4)
    assert (one["word"], one["good"], one["implementation_states"].value) == ("EQUAL", True, 2)
    assert [(row["id"], row["full"]) for row in one["steps"]] == [("Close", False), ("Stay", True)]
    assert "not in full" in make(root).html


def test_a_graph_compared_with_nothing_is_a_hole_with_command(root: Path) -> None:
    assert entry(conformance, root)["graphs"][0]["compared"] == []
    html = make(root).html
    assert "modeproof conform box --builtin refimpl --document box" in html
    assert "no program was run against test vectors" in html


def test_a_program_has_its_suites_guarantees_and_limits(root: Path) -> None:
    put(root, "adapter_box_brief", kind="conformance", verdict="CONFORMS", result=PROGRAM)
    one = entry(conformance, root)["programs"][0]
    assert (one["relation"], one["suite"], one["scans"].value) == ("exact", "brief", 40)
    assert one["says"]["does_not_show"] == "the rest"
    assert (one["clauses"][0]["id"], one["clauses"][0]["full"]) == ("BX-1-1", False)
    html = make(root).html
    assert "not observed: LAMP" in html and "box.c 1 &lt;b&gt;" in html and "box.c 1 <b>" not in html


def test_a_program_that_differs_is_not_as_expected(root: Path) -> None:
    changes = {"verdict": "DIFFERS", "expected": "CONFORMS", "as_expected": False, "reason": "scan 3"}
    put(root, "adapter_box_brief", kind="conformance", result=PROGRAM, **changes)
    one = entry(conformance, root)["programs"][0]
    assert (one["word"], one["good"], one["why"]) == ("DIFFERS", False, "scan 3")
    assert make(root).status == 1


def test_a_theorem_has_its_sentence_questions_and_unneeded_assumptions(root: Path) -> None:
    put(root, THEOREM, result={"unused": ["there is one door"]})
    found = entry(proofs, root)
    one = found["theorems"][0]
    assert one["sentence"] == "It shuts only over the door, whatever happens."
    counts = {key: figure.value for key, figure in one["counts"].items()}
    assert counts == {"claims": 1, "twins": 1, "examples": 0, "agree": 2, "all": 2}
    assert found["solvers"] == {"z3": ["5.4.0.0"], "cvc5": ["not recorded"]}
    assert found["never_needed"] == ["there is one door"]


def test_an_unexpected_answer_of_the_solvers_is_no_agreement(root: Path) -> None:
    queries = [{**RESULT[THEOREM]["queries"][0], "cvc5": "sat"}, RESULT[THEOREM]["queries"][1]]
    changes = {"verdict": "UNJUDGED", "as_expected": False, "reason": "the solvers disagree"}
    put(root, THEOREM, result={"queries": queries}, **changes)
    one = entry(proofs, root)["theorems"][0]
    assert (one["word"], one["good"], one["counts"]["agree"].value) == ("UNJUDGED", None, 1)


def test_a_theorem_without_evidence_is_a_hole_with_its_sentence(root: Path) -> None:
    without(root, THEOREM)
    one = entry(proofs, root)["theorems"][0]
    assert (one["word"], one["good"], one["counts"]) == ("not there", None, None)
    assert one["sentence"] == "It shuts only over the door, whatever happens."


def test_the_table_of_agreement_tells_both_from_one_alone(root: Path) -> None:
    assert entry(proofs, root)["agreement"] is None
    alone = {**AGREEMENT["rows"][0], "theorem": "", "proved": "", "reason": "it needs fairness"}
    put(root, "agreement", kind="agreement", result={"rows": [*AGREEMENT["rows"], alone]})
    found = entry(proofs, root)["agreement"]
    assert (found["both"].value, found["all"].value) == (1, 2)
    assert [row["good"] for row in found["rows"]] == [True, None]
    against = {**AGREEMENT["rows"][0], "proved": "VIOLATED"}
    put(root, "agreement", kind="agreement", result={"rows": [against]})
    assert entry(proofs, root)["agreement"]["rows"][0]["good"] is False


def test_unreached_code_has_its_reason_and_unexplained_code_stands_apart(root: Path) -> None:
    counted = {key: [3, 4] for key in ("lines", "branches", "answers")}
    lost = {"unreachable": [{"what": "line 7", "why": "never"}], "unexplained": ["line 9"]}
    device = {"states": 2, "paths": 5, **counted, **lost}
    put(root, "coverage", kind="coverage", result={"devices": {"box": device}})
    row = entry(proofs, root)["coverage"][0]
    assert (row["lines"]["have"].value, row["lines"]["total"].value) == (3, 4)
    assert row["unexplained"] == ["line 9"] and row["unreachable"][0]["why"] == "never"


def record(name: str, premises: list[str], unused: list[str]) -> dict[str, Any]:
    return {"id": name, "result": {"premises": premises, "unused": unused}}


def test_a_premise_that_one_proof_needs_is_needed() -> None:
    one = record("one", ["a premise", "another"], ["a premise", "another"])
    other = record("other", ["a premise", "another"], ["another"])
    assert never_needed([one, other]) == ["another"]
    assert never_needed([one]) == ["a premise", "another"]
    assert never_needed([other]) == ["another"]

"""Tool confidence: each known problem of a tool is judged, and what a machine can check is checked anew."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root as repository_root
from modeproof.registers.tools import load_tools
from modeproof.report.build import make
from modeproof.report.conditions import judged
from modeproof.report.parts.confidence import part
from modeproof.report.sources import DIFFERS, HOLE, NOTE, gather
from tests.report.paper import RESULT, change, declare_graph, make_paper, put

REGISTER = """
[[check]]
engine = "the model checker"
by = "two solvers"
kind = "proof"
[[problem]]
id = "T-1"
tool = "tlc"
title = "a <b>problem</b>"
reference = "https://example.org/1"
what = "It forgets."
affects = "all"
judgement = "not reached"
because = "We do not do that."
holds = [{condition}]
"""
SAID = {
    "workers": 1,
    "queue": 0,
    "jar_pinned": True,
    "tlc_command": "java tlc2.TLC -workers 1 -lncheck final Box",
}
RUNS = ("MC_Box", "MC_Box_lazy", "NEG_Box_eager", "NEG_Box_hasty", "WIT_Box")


def with_register(root: Path, condition: str) -> Path:
    """The box with a register of one problem and one condition, and what runs say of themselves."""
    made = make_paper(root)
    for name in RUNS:
        put(made, name, result={**RESULT[name], **SAID})
    (made / "docs").mkdir()
    (made / "docs" / "report.toml").write_text(REGISTER.replace("{condition}", condition))
    return made


def met(root: Path) -> tuple[Any, str]:
    """Whether the only condition holds, and what was found."""
    one = part(gather(root)).data["problems"][0]["conditions"][0]
    return one["good"], one["found"]


HOLDING = {
    '{ word_absent = ["EXCEPT"] }': "3 looked at",
    '{ cfg_absent = ["SYMMETRY"] }': "5 looked at",
    '{ cfg_absent = ["INVARIANT"], of = ["WIT"] }': "1 looked at",
    '{ text_absent = ["set_param"] }': "1 looked at",
    '{ workers = 1, of = ["MC"] }': "2 looked at",
    "{ queue_empty = true }": "5 looked at",
    "{ jar_pinned = true }": "5 looked at",
    '{ option = "-lncheck final" }': "5 looked at",
    '{ option_absent = "-continue" }': "5 looked at",
    "{ solvers_agree = true }": "2 looked at",
    "{ collision_below = 1e-9 }": "largest of 5 runs, MC_Box",
}


@pytest.mark.parametrize("condition", HOLDING)
def test_a_condition_that_holds_says_what_was_looked_at(condition: str, tmp_path: Path) -> None:
    root = with_register(tmp_path, condition)
    assert met(root) == (True, HOLDING[condition])
    assert part(gather(root)).troubles == ()


PLANTED: dict[str, tuple[str, Any]] = {
    "a word": (
        '{ word_absent = ["EXCEPT"] }',
        lambda root: change(root / "spec" / "box" / "Box.tla", "Needed == TRUE", "Needed == EXCEPT"),
    ),
    "a section of a cfg": (
        '{ cfg_absent = ["SYMMETRY"] }',
        lambda root: (root / "spec/box/models/MC_Box.cfg").write_text("SYMMETRY Perms\n"),
    ),
    "a text": (
        '{ text_absent = ["set_param"] }',
        lambda root: (root / "proofs" / "box" / "more.py").write_text("z3.set_param()\n"),
    ),
    "workers": ("{ workers = 1 }", lambda root: put(root, "MC_Box", result={**SAID, "workers": 2})),
    "states left": ("{ queue_empty = true }", lambda root: put(root, "MC_Box", result={**SAID, "queue": 3})),
    "another jar": (
        "{ jar_pinned = true }",
        lambda root: put(root, "MC_Box", result={**SAID, "jar_pinned": False}),
    ),
    "an option that is missing": (
        '{ option = "-lncheck final" }',
        lambda root: put(root, "MC_Box", result={**SAID, "tlc_command": "java tlc2.TLC Box"}),
    ),
    "an option too many": (
        '{ option_absent = "-continue" }',
        lambda root: put(root, "MC_Box", result={**SAID, "tlc_command": "java tlc2.TLC -continue Box"}),
    ),
    "too many states": (
        "{ collision_below = 1e-9 }",
        lambda root: put(root, "MC_Box", result={**SAID, "distinct": 10**6, "generated": 10**9}),
    ),
    "solvers that disagree": (
        "{ solvers_agree = true }",
        lambda root: put(
            root,
            "it_shuts_over_the_door_only",
            result={"queries": [{**RESULT["it_shuts_over_the_door_only"]["queries"][0], "cvc5": "sat"}]},
        ),
    ),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_a_judgement_that_does_not_stand_is_not_as_expected(fault: str, tmp_path: Path) -> None:
    condition, plant = PLANTED[fault]
    root = with_register(tmp_path, condition)
    plant(root)
    good, found = met(root)
    assert good is False and found.startswith(("not so: ", "largest of "))
    troubles = part(gather(root)).troubles
    assert [one.status for one in troubles] == [DIFFERS]
    assert "the judgement is not true here" in troubles[0].what


def test_a_graph_compared_with_nothing_leaves_the_judgement_open(tmp_path: Path) -> None:
    root = with_register(tmp_path, "{ compared = true }")
    assert met(root) == (None, "nothing to judge it by")
    declare_graph(root)
    assert met(root) == (None, "not there, or of another text: OPEN_Box")
    compared = {"run": "box/OPEN_Box", "states": 4, "transitions": 7}
    put(root, "refimpl_OPEN_Box", kind="conformance", verdict="EQUAL", expected="EQUAL", result=compared)
    assert met(root) == (True, "1 looked at")
    changes = {"verdict": "DIFFERS", "expected": "EQUAL", "as_expected": False, "reason": "one transition"}
    put(root, "refimpl_OPEN_Box", kind="conformance", result=compared, **changes)
    assert met(root) == (False, "not so: OPEN_Box")


def test_evidence_of_another_text_leaves_the_judgement_open(tmp_path: Path) -> None:
    root = with_register(tmp_path, "{ queue_empty = true }")
    change(root / "spec" / "box" / "Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    assert met(root)[0] is None and met(root)[1].startswith("not there, or of another text: MC_Box")


def test_each_tool_version_has_its_hash_and_count_of_uses(tmp_path: Path) -> None:
    root = make_paper(tmp_path)
    put(root, "MC_Box", tools={"z3": {"version": "1.0", "sha256": None}})
    rows = [(row["id"], row["version"].value, row["files"].value) for row in part(gather(root)).data["tools"]]
    assert [row for row in rows if row[0] == "z3"] == [("z3", "1.0", 1), ("z3", "5.4.0.0", 5)]


def test_a_check_counts_the_evidence_that_is_as_expected(tmp_path: Path) -> None:
    root = with_register(tmp_path, "{ solvers_agree = true }")
    check = part(gather(root)).data["checks"][0]
    assert (check["good"], check["as_expected"].value, check["all"].value) == (True, 1, 1)
    put(root, "it_shuts_over_the_door_only", verdict="VIOLATED", as_expected=False, reason="counterexample")
    check = part(gather(root)).data["checks"][0]
    assert (check["good"], check["as_expected"].value) == (False, 0)


def test_missing_registers_are_named_and_damaged_ones_are_holes(tmp_path: Path) -> None:
    root = make_paper(tmp_path)
    assert [one.status for one in part(gather(root)).troubles] == [NOTE]
    assert "no known problem of a tool is judged" in make(root).html
    (root / "docs").mkdir()
    (root / "docs" / "report.toml").write_text("[[problem]]\n")
    assert [one.status for one in part(gather(root)).troubles] == [HOLE]


def test_the_register_cannot_bring_markup_into_the_page(tmp_path: Path) -> None:
    html = make(with_register(tmp_path, "{ queue_empty = true }")).html
    assert "a &lt;b&gt;problem&lt;/b&gt;" in html and "a <b>problem</b>" not in html


@pytest.mark.parametrize(
    ("condition", "said"),
    [
        ("{ queue_empty = true, workers = 1 }", "exactly one key"),
        ('{ of = ["MC"] }', "exactly one key"),
        ("{ nothing = true }", "nothing"),
    ],
)
def test_a_condition_that_nobody_can_judge_is_refused(condition: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=said):
        load_tools(with_register(tmp_path, condition))


def test_judgements_have_public_references_and_covered_ones_have_checks() -> None:
    problems = load_tools(repository_root()).problems
    assert {one.tool for one in problems} == {"tlc", "z3", "cvc5", "java", "python"}
    assert all(one.holds for one in problems if one.judgement == "covered")


def test_what_texts_say_of_our_tools_stands_today() -> None:
    sources = gather(repository_root())
    told = {
        f"{problem.id}: {condition.name}": judged(sources, condition)
        for problem in load_tools(repository_root()).problems
        for condition in problem.holds
        if condition.name in ("word_absent", "cfg_absent", "text_absent")
    }
    assert len(told) > 4
    assert not {name: one.found for name, one in told.items() if one.good is not True}

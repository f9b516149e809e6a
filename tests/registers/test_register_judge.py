"""Contradictions, unresolved citations, orphans: a sound document has none, and each planted one is found."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.registers import Unjudged, check_document, judge, load_document

SPEC = "spec/door/"
LATCH = "spec/door/Latch.tla"
CODE = "refimpl/door/latch.py"
PROOF = "proofs/door/bolt.py"


def test_a_sound_document_has_no_problem_and_a_full_matrix(tree: Any) -> None:
    judgement = judge(load_document(tree.root, "door"))
    assert [str(problem) for problem in judgement.problems] == []
    assert judgement.as_expected and judgement.unresolved == 0 and judgement.citations > 10
    first, second, third, fourth = judgement.rows
    assert first.action == ("Latch!CloseLatch", "Latch!OpenLatch")
    assert first.step == ("latch.power_up", "latch.step")
    assert first.vector == ("latch/tour:CloseLatch", "latch/tour:OpenLatch")
    assert first.finding == ("E-01",)
    assert second.property == ("OpenIsUnlocked",) and second.theorem == ("the_bolt_moves",)
    assert second.definition == ("Latch!OpenIsUnlocked",)
    assert third.assumption == ("A-01",)
    assert fourth.kind == "not modelled"
    assert check_document(tree.root, "door") == []


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        # citations that lead nowhere
        (
            LATCH,
            "\\* DR-1-1, E-01",
            "\\* DR-1-1, DR-9-9",
            "Latch!CloseLatch: cites DR-9-9, which no register",
        ),
        (LATCH, "\\* DR-1-1, E-01", "\\* DR-1-1, E-77", "Latch!CloseLatch: cites E-77, which no register"),
        (LATCH, "the door; DR-1-1.", "the door; DR-7.", "Latch: cites DR-7, which no register"),
        (LATCH, "\\* DR-1-1, E-01", "\\* DR-1-1..4", "'DR-1-1..4' reads like a range"),
        (CODE, "# DR-1-1", "# DR-1-1, DR-1-8", "latch.step: cites DR-1-8, which no register"),
        (CODE, '"""E-01"""', '"""E-02"""', "latch._shut: cites E-02, which no register"),
        (PROOF, '["DR-1-2"]', '["DR-1-2", "DR-5-5"]', "the_bolt_moves: cites DR-5-5, which no register"),
        (SPEC + "properties.toml", '["E-01"]', '["E-03"]', "OpenIsUnlocked: cites E-03, which no register"),
        (SPEC + "interface.toml", '["DR-1-1"]', '["DR-1-0"]', "devices.latch.memory.state: cites DR-1-0"),
        (SPEC + "findings.toml", '["DR-1-1"]', '["DR-1-0"]', "E-01: cites DR-1-0"),
        (SPEC + "assumptions.toml", '["DR-1-3"]', '["DR-1-3", "DR-1-0"]', "A-01: cites DR-1-0"),
        # clauses that nobody carries out
        (SPEC + "assumptions.toml", '["DR-1-3"]', "[]", "DR-1-3: no assumption and no property cites"),
        (SPEC + "clauses.toml", "colour decides nothing", " ", "DR-1-4: not modelled, and `because`"),
        (
            SPEC + "properties.toml",
            ', "DR-1-1"]',
            "]",
            "DR-1-1: no property and no theorem cites this behaviour",
        ),
        # work that no clause asks for
        (LATCH, "\\* DR-1-1\n", "\\* nothing\n", "Latch!OpenLatch: the step cites no clause and no finding"),
        (CODE, "open. DR-1-1", "open.", "power_up: the function is public and cites no clause"),
        (CODE, '"""E-01"""', '"""Shut."""', "_shut: the function implements a state and cites no clause"),
        (
            SPEC + "properties.toml",
            '["DR-1-2", "DR-1-1"]',
            "[]",
            "OpenIsUnlocked: the property cites no clause",
        ),
        (PROOF, '["DR-1-2"]', "[]", "the_bolt_moves: the theorem cites no clause"),
        (
            PROOF,
            'findings=["E-01"]',
            'findings=["E-01"], properties=["OpenIsUnlockd"]',
            "the_bolt_moves: proves the unknown property 'OpenIsUnlockd'; did you mean 'OpenIsUnlocked'",
        ),
        # registers that contradict each other
        (SPEC + "clauses.toml", '"DR"', '"DX"', "DR-1-1: the id does not begin with the prefix DX-"),
        (SPEC + "clauses.toml", '["latch"]', '["lach"]', "unknown device 'lach'; did you mean 'latch'?"),
        (
            SPEC + "interface.toml",
            "default = 100",
            "default = 1001",
            "T_HOLD_ms: default 1001 is not in 1..1000",
        ),
        (SPEC + "interface.toml", "default = 100", "default = true", "default True is not an integer"),
        (SPEC + "interface.toml", "min = 1,", "min = 2000,", "min 2000 is greater than max 1000"),
        (SPEC + "interface.toml", " default = 100,", "", "a parameter needs a default, or required = true"),
        (SPEC + "interface.toml", 'type = "word"', 'type = "text"', "a text needs the list of its values"),
        (SPEC + "interface.toml", "CODE =", "door_closed =", "door_closed is both an input and an output"),
        (
            SPEC + "properties.toml",
            '"honest"',
            '"arbitrary"',
            "no run checks it in the environment 'arbitrary'",
        ),
        (SPEC + "properties.toml", '"open_seen"', '"opn_seen"', "no run has the witness 'opn_seen'; did you"),
        (SPEC + "properties.toml", '"open_seen"', '""', "names no antecedent, and `reason` does not say why"),
        (
            SPEC + "runs.toml",
            'lanes = ["full"]\nenvironment = "honest"\nproperties = []',
            'lanes = ["exhaustive"]\nenvironment = "honest"\nproperties = []',
            "the witness 'open_seen' is reached by no run of what was decided in lane full",
        ),
        (
            SPEC + "properties.toml",
            'antecedent = "open_seen"',
            'antecedent = "open_seen"\nreason = "none"',
            "names an antecedent, and `reason` says why it needs none",
        ),
        (
            SPEC + "properties.toml",
            'tla = "Open',
            'tla = "Opn',
            "Latch.tla does not define OpnIsUnlocked; did",
        ),
        (SPEC + "properties.toml", '"Latch"', '"Lach"', "module Lach does not exist; did you mean 'Latch'?"),
        (
            SPEC + "findings.toml",
            '"NEG_Latch"',
            '"NEG_Lach"',
            "evidence 'NEG_Lach' is no run and no theorem; did",
        ),
        (
            SPEC + "findings.toml",
            "tries = []",
            'parameter = "T_HLD"',
            "E-01: parameter 'T_HLD' is no CONSTANT of the specification; did you mean 'T_HOLD'?",
        ),
        (SPEC + "findings.toml", '["NEG_Latch", "the_bolt_moves"]', "[]", "E-01: names no evidence, and"),
        (
            SPEC + "findings.toml",
            '["NEG_Latch", "the_bolt_moves"]',
            '[]\nevidence_open = "comes with the next release"',
            "E-01: `evidence_open` is a promise ('comes with'); say why no model can show it",
        ),
        (
            SPEC + "assumptions.toml",
            '["NEG_Latch"]',
            '[]\nbreaks_open = "No run yet"',
            "A-01: `breaks_open` is a promise ('No run yet'); say why no run can break it",
        ),
        (SPEC + "assumptions.toml", '"NEG_Latch"', '"NEG_Lach"', "breaks: unknown run 'NEG_Lach'; did you"),
        (SPEC + "assumptions.toml", '["NEG_Latch"]', "[]", "A-01: names no run that breaks it, and"),
        (SPEC + "runs.toml", ', "OpenIsUnlocked"]', "]", "OpenIsUnlocked: no run checks OpenIsUnlocked"),
        (
            SPEC + "runs.toml",
            '"TypeOK", "Open',
            '"TypeOK", "Opn',
            "OpnIsUnlocked is in no row of properties.toml",
        ),
        (SPEC + "runs.toml", 'module = "Latch"', 'module = "Lach"', "MC_Latch: module Lach does not exist"),
        (SPEC + "runs.toml", 'device = "latch"', 'device = "lach"', "graph.device: did you mean 'latch'?"),
        (SPEC + "runs.toml", "T_HOLD_ms = 20", "T_HLD_ms = 20", "graph.params: unknown parameter 'T_HLD_ms'"),
        (
            SPEC + "runs.toml",
            "T_HOLD_ms = 20",
            "T_HOLD_ms = 0",
            "graph.params: T_HOLD_ms = 0 is not in 1..1000",
        ),
        (
            SPEC + "runs.toml",
            "params = {",
            "pass = { LCK = 'door_closed' }\nparams = {",
            "unknown output 'LCK'",
        ),
        # names
        (LATCH, "\nCloseLatch(i)", "\nShutLatch(i)", "CloseLatch: declared as a step, but not defined"),
        (SPEC + "interface.toml", '"Shut"]', '"Shut", "Ajar"]', "Ajar: declared as a state, but the string"),
        (LATCH, "VARIABLES latchState ", "VARIABLES lState ", "state: declared as memory, but no VARIABLE"),
        (
            LATCH,
            "    T_HOLD,",
            "    T_HLD,",
            "T_HOLD: declared as the parameter T_HOLD_ms, but not a CONSTANT",
        ),
        (LATCH, "i.door_closed", "i.door_shut", "door_closed: declared as an input or output, but nothing"),
        (CODE, '"Shut"', '"Shutt"', "Step: the state 'Shut' is declared, but no value here"),
        (CODE, '"Shut"', '"Shutt"', "Step: the value 'Shutt' is not a declared state"),
        (CODE, "    LOCK_1: bool\n", "", "Outputs.LOCK_1: declared in interface.toml, but no field here"),
        (CODE, "    CODE: int\n", "    CODE: int\n    X: int\n", "Outputs.X: a field here, but not declared"),
        (CODE, "door_closed: bool", "door_closed: int", "Inputs.door_closed: must be bool, not int"),
        (CODE, "class Params", "class Parameters", "Params: the class is missing"),
        (CODE, "def step(", "def scan(", "step: the function is missing"),
    ],
)
def test_each_planted_fault_is_found(tree: Any, file: str, old: str, new: str, expected: str) -> None:
    tree.edit(file, old, new)
    found = tree.problems()
    assert any(expected in problem for problem in found), found
    assert not judge(load_document(tree.root, "door")).as_expected


def test_a_behaviour_that_no_definition_carries_out_is_an_orphan(tree: Any) -> None:
    tree.edit(LATCH, "\\* DR-1-1, E-01", "\\* E-01")
    tree.edit(LATCH, "\\* DR-1-1\n", "\\* E-01\n")
    assert any("DR-1-1: no TLA+ definition cites this behaviour" in one for one in tree.problems())


def test_a_behaviour_that_no_function_carries_out_is_an_orphan(tree: Any) -> None:
    tree.edit(CODE, "DR-1-1", "E-01")
    tree.edit(CODE, "# DR-1-1", "# E-01")
    assert any("DR-1-1: no Python function cites this behaviour" in one for one in tree.problems())


def test_a_clause_of_two_devices_needs_both(tree: Any) -> None:
    text = (tree.root / "spec/door/interface.toml").read_text(encoding="utf-8")
    device = text[text.index("[devices.latch]") :].replace("latch", "bell").replace("Latch", "Bell")
    tree.write("spec/door/interface.toml", text + device)
    latch = (tree.root / LATCH).read_text(encoding="utf-8")
    tree.write(
        "spec/door/Bell.tla",
        latch.replace("Latch", "Bell").replace("latch", "bell").replace("DR-1-1", "E-01"),
    )
    tree.write(
        "refimpl/door/bell.py", (tree.root / CODE).read_text(encoding="utf-8").replace("DR-1-1", "E-01")
    )
    runs = (tree.root / "spec/door/runs.toml").read_text(encoding="utf-8")
    opened = runs[runs.index('[[run]]\nid = "OPEN_Latch"') :]
    tree.write("spec/door/runs.toml", runs + opened.replace("Latch", "Bell").replace("latch", "bell"))
    tree.pin()
    assert tree.problems() == []
    tree.edit("spec/door/clauses.toml", '["latch"]', '["latch", "bell"]')
    assert tree.problems() == [
        "spec/door/clauses.toml: DR-1-1: no TLA+ definition of bell cites this behaviour",
        "spec/door/clauses.toml: DR-1-1: no Python function of bell cites this behaviour",
    ]


def test_a_property_clause_without_property_or_theorem_is_an_orphan(tree: Any) -> None:
    tree.edit("spec/door/properties.toml", '"DR-1-2", "DR-1-1"', '"DR-1-1"')
    tree.edit(PROOF, "DR-1-2", "DR-1-1")
    assert "spec/door/clauses.toml: DR-1-2: no property and no theorem cites this property" in tree.problems()


def test_an_unpublished_or_unprinted_device_has_no_vectors(tree: Any) -> None:
    tree.edit("spec/door/interface.toml", "published = true", "published = false")
    assert all(row.vector == () for row in judge(load_document(tree.root, "door")).rows)


def test_a_finding_names_the_parameter_that_leaves_the_choice(tree: Any) -> None:
    tree.edit("spec/door/findings.toml", "tries = []", 'parameter = "T_HOLD"')
    assert load_document(tree.root, "door").findings[0].parameter == "T_HOLD"
    assert tree.problems() == []


def test_a_negative_run_that_nothing_names_shows_nothing(tree: Any) -> None:
    tree.edit("spec/door/findings.toml", '"NEG_Latch", ', "")
    tree.edit("spec/door/assumptions.toml", '["NEG_Latch"]', '[]\nbreaks_open = "one door is one door"')
    assert tree.problems() == [
        "spec/door/runs.toml: NEG_Latch: no finding and no assumption names this negative run"
    ]


def test_a_step_that_no_run_shows_to_fire_is_found(tree: Any) -> None:
    text = (tree.root / "spec/door/runs.toml").read_text(encoding="utf-8")
    tree.write("spec/door/runs.toml", text[: text.index('[[run]]\nid = "OPEN_Latch"')])
    tree.edit("spec/door/runs.toml", '["open_seen"]', '["open_seen", "OpenLatch"]')
    tree.pin()
    assert tree.problems() == ["spec/door/runs.toml: no run shows that these steps of latch fire: CloseLatch"]


def test_ids_of_theorems_that_need_code_to_run_are_refused(tree: Any) -> None:
    tree.edit(PROOF, '["DR-1-2"]', '["DR-1-" + str(2)]')
    with pytest.raises(Unjudged, match="must be a literal list of ids"):
        tree.problems()


def test_python_that_does_not_parse_is_refused_with_its_line(tree: Any) -> None:
    tree.edit(CODE, "def step(", "def step((")
    with pytest.raises(Unjudged, match=r"refimpl/door/latch.py: line \d+: not valid Python"):
        tree.problems()


def test_no_implementation_at_all_is_a_problem(tree: Any) -> None:
    (tree.root / CODE).unlink()
    assert "refimpl/door/latch.py: not found" in tree.problems()

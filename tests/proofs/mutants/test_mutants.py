"""Changed copies of a shipped device: the same is EQUIVALENT, what is wrong falls to the right theorem."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import z3

from proofs.explorer.device import judged, judging, scans
from proofs.mode_selection import (
    eks_prompt,
    fplc_order,
    fplc_prompt,
    fplc_response,
    fplc_safety,
    judges,
    panel_prompt,
)
from proofs.mode_selection.devices import HMI, PLC
from proofs.mode_selection.judges import JUDGES
from proofs.mode_selection.plc_safety import the_plc_leaves_no_copy_out
from proofs.mode_selection.subjects import SUBJECTS
from proofs.mutants.copies import Change, CopyError, copied
from proofs.mutants.copy_judge import Bench, Found, claims
from proofs.mutants.shipped import POWER_UP, functions_of, shipped
from proofs.theorem import Queries, Theorem, TheoremError, claim, theorem
from refimpl.mode_selection import code_tables, plc

PACKAGE = "refimpl.mode_selection"
FILE = Path(plc.__file__)
TEXT = FILE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def bench() -> Bench:
    (subject,) = [one for one in SUBJECTS if one.device is PLC]
    return Bench(PACKAGE, {PLC.name: shipped(subject)}, {PLC.name: JUDGES[PLC.name]})


def change(definition: str, old: str, new: str) -> Change:
    function = next(
        one for one in ast.parse(TEXT).body if isinstance(one, ast.FunctionDef) and one.name == definition
    )
    lines = TEXT.splitlines()
    first, last = function.lineno, function.end_lineno or 0
    own = "\n".join(lines[first - 1 : last])
    assert own.count(old) == 1
    return Change(plc.__name__, definition, TEXT.replace(own, own.replace(old, new)), (first, last))


def judge(bench: Bench, definition: str, old: str, new: str) -> Found:
    return bench.judge(change(definition, old, new), str(FILE))


def with_theorem(bench: Bench, build: Callable[[], Queries]) -> Bench:
    return replace(bench, theorems={PLC.name: [theorem(clauses=["EKS-GP-3"], findings=[])(build)]})


# ---------------------------------------------------------------- verdicts


@pytest.mark.parametrize(
    ("definition", "old", "new", "killer"),
    [
        ("_copy_mw03", "i.SelectMSO", "i.SwitchMSO", "the_plc_sends_each_word_unchanged"),
        ("_copy_mw03", "i.SelectMSO", "s.MW03", "the_plc_leaves_no_copy_out"),
        ("_copy_mw07", "Step.COPY_READ_AUTHORIZATION", "Step.COPY_MW07", "the_plc_leaves_no_copy_out"),
        ("outputs", "s.CheckMSO, s.MW03", "s.MW03, s.CheckMSO", "the_plc_sends_each_word_unchanged"),
        (
            "power_up",
            "ZERO, ZERO, ZERO, ZERO",
            "ZERO, 1, ZERO, ZERO",
            "every_device_is_safe_from_the_first_moment",
        ),
        (
            "step",
            "if state.turn == Step.COPY_READ_AUTHORIZATION",
            "if state.turn != Step.COPY_MW07 and state.turn != Step.COPY_MW03",
            "the_plc_copies_a_new_level_before_anything_else",
        ),
    ],
)
def test_the_theorem_that_a_wrong_copy_breaks_kills_it(
    bench: Bench, definition: str, old: str, new: str, killer: str
) -> None:
    found = judge(bench, definition, old, new)
    assert (found.verdict, found.killers) == ("KILLED", (killer,))
    assert found.witness.startswith("plc, ")
    assert found.asked[-1].result == "refuted"


def test_a_scan_that_raises_breaks_the_theorem_of_answers(bench: Bench) -> None:
    found = judge(bench, "step", "elif state.turn == Step.COPY_MW07", "elif state.turn == Step.COPY_MW03")
    assert found.killers == ("every_scan_of_the_plc_takes_exactly_one_path",)


@pytest.mark.parametrize(
    ("definition", "old", "new"),
    [
        ("_copy_mw03", "s.MW07\n", "(s.MW07 if i.dt_ms > 5 else s.MW07)\n"),
        ("_copy_mw03", "i.SelectMSO", "(s.MW03 if i.SelectMSO == s.MW03 else i.SelectMSO)"),
        ("step", "raise StateError", "raise ValueError"),
    ],
)
def test_a_copy_that_does_the_same_is_equivalent(bench: Bench, definition: str, old: str, new: str) -> None:
    found = judge(bench, definition, old, new)
    assert (found.verdict, found.killers, found.witness) == ("EQUIVALENT", (), "")


def test_a_wrong_copy_that_no_theorem_speaks_of_survives(bench: Bench) -> None:
    found = judge(bench, "power_up", "Step.COPY_READ_AUTHORIZATION", "Step.COPY_MW03")
    assert (found.verdict, found.killers) == ("SURVIVED", ())
    assert POWER_UP in found.witness


def test_one_word_of_all_is_enough_to_differ(bench: Bench) -> None:
    found = judge(bench, "_copy_mw07", "i.SwitchMSO", "(0 if i.SwitchMSO == 0xBEEF else i.SwitchMSO)")
    assert found.killers == ("the_plc_sends_each_word_unchanged",)
    assert f"{0xBEEF}" in found.witness


@pytest.mark.parametrize(
    ("old", "new"), [("s.MW07)", "s.MW07"), ("i.SelectMSO", "(1.5)"), ("i.SelectMSO", "{i.SelectMSO: 1}[0]")]
)
def test_what_cannot_be_followed_is_invalid_and_not_killed(bench: Bench, old: str, new: str) -> None:
    found = judge(bench, "_copy_mw03" if old != "s.MW07)" else "outputs", old, new)
    assert found.verdict == "INVALID"
    assert found.reason


# ---------------------------------------------------------------- a theorem that cannot judge


def test_a_theorem_that_cannot_be_built_leaves_it_unmeasured(bench: Bench) -> None:
    def broken() -> Queries:
        """It cannot be built."""
        raise TheoremError("no idea")

    found = judge(with_theorem(bench, broken), "_copy_mw03", "i.SelectMSO", "s.MW03")
    assert (found.verdict, found.reason) == ("UNMEASURED", "no idea")


def test_a_theorem_false_of_the_shipped_code_kills_nobody(bench: Bench) -> None:
    def false() -> Queries:
        """No number is greater than 5."""
        x = z3.Int("x")
        yield from claim("of all", {"x is positive": x > 0}, x <= 5)

    found = judge(with_theorem(bench, false), "power_up", "ZERO, ZERO, ZERO, ZERO", "ZERO, 1, ZERO, ZERO")
    assert found.verdict == "UNMEASURED"
    assert "does not hold of the shipped code" in found.reason


def test_an_answer_that_is_not_known_leaves_it_unmeasured(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("proofs.mutants.copy_judge._answer", lambda query: (z3.unknown, "too hard"))
    found = judge(bench, "_copy_mw03", "i.SelectMSO", "s.MW03")
    assert found.verdict == "UNMEASURED"
    assert "too hard" in found.reason


def test_a_counterexample_that_its_run_contradicts_kills_nobody(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("proofs.mutants.copy_judge.evaluated_plain", lambda result, model: "elsewhere")
    found = judge(bench, "_copy_mw03", "i.SelectMSO", "s.MW03")
    assert found.verdict == "UNMEASURED"
    assert "ends otherwise" in found.reason


# ---------------------------------------------------------------- copies


def test_only_the_copy_sees_a_change_deep_in_the_package() -> None:
    text = Path(code_tables.__file__).read_text(encoding="utf-8")
    wrong = text.replace(
        "    if mode == 0:\n        return codes[0]", "    if mode == 0:\n        return codes[1]"
    )
    assert wrong != text
    copy = copied(PACKAGE, Change(code_tables.__name__, "encode", wrong, (1, 1)))
    hmi = copy.of(HMI).module
    state = hmi.State(hmi.Params(), hmi.Step.AWAIT_ECHO, 0, 0)
    assert hmi.outputs(state).SelectMSO == code_tables.SE[1]
    assert HMI.module.outputs(state).SelectMSO == code_tables.SE[0]
    assert copied(PACKAGE).of(HMI).module.outputs(state).SelectMSO == code_tables.SE[0]


def test_a_changed_constant_is_seen_wherever_it_was_imported() -> None:
    text = Path(code_tables.__file__).read_text(encoding="utf-8")
    wrong = text.replace("ZERO = 0x0000", "ZERO = 0x0001")
    copy = copied(PACKAGE, Change(code_tables.__name__, "ZERO", wrong, None))
    module = copy.of(PLC).module
    assert module.power_up(module.Params()).MW03 == 1
    assert plc.power_up(plc.Params()).MW03 == 0


@pytest.mark.parametrize(
    ("module", "definition", "text"),
    [("refimpl.gone", "step", ""), (plc.__name__, "step", "def step("), (plc.__name__, "gone", "x = 1")],
)
def test_a_text_that_cannot_be_taken_is_refused(module: str, definition: str, text: str) -> None:
    with pytest.raises(CopyError):
        copied(PACKAGE, Change(module, definition, text, None))


def test_a_function_behind_a_stand_in_is_not_edited() -> None:
    (eks,) = [one.device for one in SUBJECTS if one.device.name == "eks"]
    names = {name for _, name in functions_of(eks)}
    assert "checksum_agrees" not in names
    assert {"step", "power_up", "outputs", "decode"} <= names


# ---------------------------------------------------------------- the theorems as judges


def test_within_judging_a_theorem_speaks_of_the_given_scans_alone() -> None:
    of_one = [one for one in scans(PLC) if one.control.value == "CopyMW03"]
    with judging(PLC, of_one):
        names = [query.name for query in claims(the_plc_leaves_no_copy_out)]
        assert judged(PLC) is PLC
    assert names == ["from CopyMW03"]
    assert len(list(claims(the_plc_leaves_no_copy_out))) == 4


def _yields(item: Theorem) -> Iterator[bool]:
    """For each `yield` of the theorem's body, in order, whether it hands on claims."""
    (function,) = ast.parse(inspect.getsource(item.build)).body
    assert isinstance(function, ast.FunctionDef)
    own = [one for one in function.body if not isinstance(one, ast.FunctionDef)]
    for statement in own:
        for node in ast.walk(statement):
            if isinstance(node, (ast.Yield, ast.YieldFrom)):
                yield isinstance(node, ast.YieldFrom)


@pytest.mark.parametrize(
    "item", sorted({one for found in JUDGES.values() for one in found}, key=lambda one: one.name)
)
def test_the_claims_of_a_judge_come_before_its_controls(item: Theorem) -> None:
    """Where only some control states are judged, the first control of another one ends the theorem."""
    found = list(_yields(item))
    assert found
    assert found == sorted(found, reverse=True)


def test_every_theorem_of_a_property_of_one_device_judges() -> None:
    modules = (eks_prompt, fplc_order, fplc_prompt, fplc_response, fplc_safety, panel_prompt)
    stated = {one.name for module in modules for one in vars(module).values() if isinstance(one, Theorem)}
    assert stated <= {one.name for found in JUDGES.values() for one in found}
    assert inspect.getmodule(judges) is judges

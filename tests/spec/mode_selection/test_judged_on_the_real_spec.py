"""Faults of the machinery around the specification: each is planted in a copy of the real one and is seen.

A control run on the unchanged copy gives the pins, so that nothing but the fault can differ.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from modeproof.graph.read import read_graph
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.registers.cfg import parse_cfg
from modeproof.registers.made import cfg_text
from modeproof.registers.runs import Run as DeclaredRun
from modeproof.tlc.check import register_problems
from modeproof.tlc.run_judge import Judgement, judge
from tests.spec.mode_selection.planted import (
    DOCUMENT,
    KEY_FLOWS,
    RUNS,
    SPEC,
    Base,
    Fault,
    Finding,
    Trial,
    change,
    copy,
    pinned,
    run_copy,
)

WITNESSES = Base("WIT_KeyFlows_honest", (("LEVELS = {0, 1, 2, 3, 4}", "LEVELS = {1}"),))
PLC, EKS = Base("OPEN_Plc"), Base("OPEN_Eks6")
SHORTER = (("T_ON", 2, 1), ("T_SEQ", 3, 1), ("T_REM", 4, 2), ("T_DWELL", 2, 1))
FPLC_GRAPH = Base(
    "OPEN_Fplc",
    (
        *((f"{name} = {long}\n", f"{name} = {short}\n") for name, long, short in SHORTER),
        ("PRINT_GRAPH = TRUE", "PRINT_GRAPH = TRUE  InputsToTry <- SmallInputs"),
    ),
    module="FplcSmall",
)


Run = Callable[[Trial], Finding]


def judged(found: Finding, control: Finding) -> Judgement:
    """The judgement of a run against the pins of the control."""
    assert found.run.cfg_sha256 is not None
    run = msgspec.structs.replace(pinned(control), cfg_sha256=found.run.cfg_sha256)
    return judge(run, found.cfg, found.run.cfg_sha256, found.outcome)


@pytest.mark.parametrize(
    "trial", [Trial(base) for base in (WITNESSES, KEY_FLOWS, PLC, EKS, FPLC_GRAPH)], ids=str
)
def test_unchanged_it_is_as_expected(trial: Trial, trials: Run) -> None:
    found = judged(trials(trial), trials(trial))
    assert found.as_expected, found.reason


# ------------------------------------------------------------------ an action deleted

DELETED = {
    "TouchReject": Fault(
        "nobody can reject", "Hmi.tla", "TouchConfirm(i) \\/ TouchReject(i)", "TouchConfirm(i)"
    ),
    "LeaveError": Fault(
        "no way out of the error mode", "Fplc.tla", "StayInError(i) \\/ LeaveError(i)", "StayInError(i)"
    ),
    "SetOneOutput": Fault(
        "no output after the pulse", "Eks.tla", " \\/ HoldZeros(i) \\/ SetOneOutput(i)", " \\/ HoldZeros(i)"
    ),
    "CopyMW07": Fault("MW07 is not copied", "Plc.tla", "CopyCheckMSO(i) \\/ CopyMW07(i)", "CopyCheckMSO(i)"),
    "RemoveKey": Fault(
        "a key stays for ever", "KeyFlows.tla", "InsertKey(k)) \\/ RemoveKey", "InsertKey(k))"
    ),
}


@pytest.mark.parametrize(
    ("action", "trial"), [(action, Trial(WITNESSES, fault)) for action, fault in DELETED.items()], ids=DELETED
)
def test_a_deleted_action_turns_its_witness_red(action: str, trial: Trial, trials: Run) -> None:
    control = trials(Trial(WITNESSES))
    assert action in control.judgement.reached
    found = judged(trials(trial), control)
    assert found.verdict == "UNREACHED" and not found.as_expected
    assert action in found.reason.removeprefix("not reached: ").split(", ")


def test_only_the_step_itself_sets_its_name() -> None:
    for path in {*SPEC.glob("*.tla")} - {*SPEC.glob("*AsPrinted.tla")}:
        names = [part.split('"')[0] for part in path.read_text().split('Did("')[1:]]
        assert len(set(names)) == len(names), path.name


# ------------------------------------------------------------------ an environment emptied

NOBODY = Fault(
    "the user does nothing", "KeyFlows.tla", "InsertKey(k)) \\/ RemoveKey", "InsertKey(k) /\\ FALSE)"
)
NAMELESS = replace(WITNESSES, edits=(*WITNESSES.edits, ("RECORD_STEPS = TRUE", "RECORD_STEPS = FALSE")))


@pytest.mark.parametrize("trial", [Trial(KEY_FLOWS, NOBODY)], ids=str)
def test_an_emptied_environment_changes_the_counts(trial: Trial, trials: Run) -> None:
    found = judged(trials(trial), trials(Trial(KEY_FLOWS)))
    assert found.verdict == "HOLDS" and not found.as_expected
    assert found.reason.startswith("distinct states: ")


@pytest.mark.parametrize("trial", [Trial(WITNESSES, NOBODY)], ids=str)
def test_an_emptied_environment_leaves_witnesses_out(trial: Trial, trials: Run) -> None:
    found = judged(trials(trial), trials(Trial(WITNESSES)))
    assert found.verdict == "UNREACHED" and not found.as_expected
    assert {"InsertKey", "SwitchMode"}.isdisjoint(found.reached)


@pytest.mark.parametrize("trial", [Trial(NAMELESS)], ids=["RECORD_STEPS = FALSE"])
def test_witnesses_without_names_are_never_a_pass(trial: Trial, trials: Run) -> None:
    found = judged(trials(trial), trials(Trial(WITNESSES)))
    assert not found.judged and found.reason.startswith("a witness line cannot be read")


# ------------------------------------------------------------------ a constant shrunk, a word wrong

SHRUNK = replace(KEY_FLOWS, edits=(("LEVELS = {1}", "LEVELS = {0}"),))


@pytest.mark.parametrize("trial", [Trial(SHRUNK)], ids=["LEVELS = {0}"])
def test_a_shrunk_constant_is_noticed_despite_a_new_pin(trial: Trial, trials: Run) -> None:
    after, control = trials(trial), trials(Trial(KEY_FLOWS))
    assert after.run.cfg_sha256 is not None
    found = judge(pinned(control), after.cfg, after.run.cfg_sha256, after.outcome)
    assert found.reason == f"{after.run.config} was changed since its counts were pinned"
    found = judged(after, control)
    assert found.verdict == "HOLDS" and not found.as_expected
    assert found.reason.startswith("distinct states: ")


WRONG_WORDS = (
    Fault(
        "two rows of one range are swapped",
        "CodeTables.tla",
        "0 -> \\h0FF0 [] m = 1 -> \\h3333",
        "0 -> \\h3333 [] m = 1 -> \\h0FF0",
    ),
    Fault(
        "one bit of a word is wrong",
        "CodeTables.tla",
        "SW == TLCEval([m \\in MSO |-> CASE m = 0 -> \\h33CC",
        "SW == TLCEval([m \\in MSO |-> CASE m = 0 -> \\h33CD",
    ),
)


@pytest.mark.parametrize("trial", [Trial(PLC, fault) for fault in WRONG_WORDS], ids=str)
def test_a_wrong_word_in_table_2_leaves_no_verdict(trial: Trial, trials: Run) -> None:
    found = trials(trial).judgement
    assert found.verdict == "UNJUDGED" and "Assumption" in found.reason


# ------------------------------------------------------------------ memory hidden from the state

HIDDEN = (
    (
        PLC,
        Fault(
            "MW07 is hidden",
            "PlcOpen.tla",
            "View == plc",
            "View == <<turn, ReadAuthorization, MW03, CheckMSO>>",
        ),
    ),
    (EKS, Fault("eksElapsed is hidden", "EksOpen.tla", "View == eks", "View == <<eksState, key>>")),
    (
        FPLC_GRAPH,
        Fault(
            "fplcElapsed is hidden",
            "FplcOpen.tla",
            "View == fplc",
            "View == <<fplcState, accepted, authority, fplcSelection, mode>>",
        ),
    ),
    (
        FPLC_GRAPH,
        Fault(
            "the active mode is hidden",
            "FplcOpen.tla",
            "View == fplc",
            "View == <<fplcState, accepted, authority, fplcSelection, fplcElapsed>>",
        ),
    ),
)


@pytest.mark.parametrize("trial", [Trial(base, fault) for base, fault in HIDDEN], ids=str)
def test_memory_hidden_from_the_state_changes_the_counts(trial: Trial, trials: Run) -> None:
    control, after = trials(Trial(trial.base)), trials(trial)
    assert after.outcome.log.tags["STATE"] < control.outcome.log.tags["STATE"]
    assert after.outcome.log.tags["EDGE"] < control.outcome.log.tags["EDGE"]
    found = judged(after, control)
    assert found.verdict == "HOLDS" and not found.as_expected
    assert found.reason.startswith("distinct states: ")


# ------------------------------------------------------------------ a graph that is not complete


def silent(base: Base, step: str) -> Fault:
    """PrintEdge says nothing of one step."""
    return Fault(
        f"{step} is not printed",
        f"{base.checks}.tla",
        "PrintEdge == PRINT_GRAPH",
        f'PrintEdge == PRINT_GRAPH /\\ step\' # "{step}"',
    )


LOST = [
    Trial(base, silent(base, step))
    for base, step in ((PLC, "CopyMW07"), (EKS, "LatchFault"), (FPLC_GRAPH, "SwitchMode"))
]
GAP = Fault(
    "a register check that fails has no step",
    "Eks.tla",
    "PassRegisterCheck(i) \\/ LatchFault(i)",
    "PassRegisterCheck(i)",
)
OVERLAP = Fault(
    "two steps for one level", "Eks.tla", 'At("CheckLevel", i) /\\ ~Accepted(key)', 'At("CheckLevel", i)'
)


@pytest.mark.parametrize("trial", LOST, ids=str)
def test_judge_and_reader_refuse_the_loss_of_printed_edges(trial: Trial, trials: Run) -> None:
    after = trials(trial)
    found = judged(after, trials(Trial(trial.base)))
    assert not found.as_expected and "edges were printed, but TLC took" in found.reason
    assert after.outcome.graph_file is not None
    with pytest.raises(Unjudged, match=r"edges are missing|view that power-up never reaches"):
        read_graph(after.outcome.graph_file)


UNASKED = replace(EKS, edits=(*EKS.edits, (" EveryScanIsAnswered", "")))


@pytest.mark.parametrize("trial", [Trial(UNASKED, GAP)], ids=str)
def test_a_state_without_a_step_for_some_input_is_refused(trial: Trial, trials: Run) -> None:
    """Unless it is asked for an answer to every scan, TLC is content: no step, nothing that could break."""
    after = trials(trial)
    assert after.judgement.verdict != "VIOLATED"
    assert not judged(after, trials(Trial(UNASKED))).as_expected
    assert after.outcome.graph_file is not None
    with pytest.raises(Unjudged, match="edges are missing"):
        read_graph(after.outcome.graph_file)


@pytest.mark.parametrize("trial", [Trial(EKS, OVERLAP)], ids=str)
def test_two_steps_for_one_input_are_refused(trial: Trial, trials: Run) -> None:
    after = trials(trial)
    assert after.judgement.verdict == "HOLDS"
    assert not judged(after, trials(Trial(EKS))).as_expected
    assert after.outcome.graph_file is not None
    with pytest.raises(Unjudged, match="two edges for input"):
        read_graph(after.outcome.graph_file)


# ------------------------------------------------------------------ what is checked, taken away


@pytest.mark.parametrize("run", [pytest.param(run, id=run.id) for run in RUNS.values() if run.properties])
def test_a_property_taken_out_of_its_cfg_is_missed(run: DeclaredRun, trials: Run) -> None:
    """The outcome is a good one: TLC has nothing to object to a property that it does not check."""
    good = trials(Trial(PLC)).outcome
    good = replace(good, printed=frozenset(f'<<"REACHED", "{name}">>'.encode() for name in run.witnesses))
    text = cfg_text(root(), run)
    for name in run.properties:
        assert re.search(rf"\b{name}\b", text)
        bare = re.sub(rf"\b{name}\b", "", text)
        digest = hashlib.sha256(bare.encode()).hexdigest()
        found = judge(
            msgspec.structs.replace(run, cfg_sha256=digest), parse_cfg(bare, run.config), digest, good
        )
        assert found.verdict in ("HOLDS", "REACHED") and not found.as_expected
        assert found.reason in (f"{run.config} does not check {name}", f"{run.config} checks no property")


def test_an_invariant_taken_out_of_a_real_run_is_missed(tmp_path: Path, trials: Run) -> None:
    copy(tmp_path)
    text = change(EKS.cfg_text, ((" NoOutputWithoutLA", ""),), "OPEN_Eks6.cfg")
    found = run_copy(tmp_path, pinned(trials(Trial(EKS))), text).judgement
    assert found.verdict == "HOLDS" and not found.as_expected
    assert found.reason == f"{EKS.declared.config} does not check NoOutputWithoutLA"


def test_an_emptied_property_list_is_missed(tmp_path: Path, trials: Run) -> None:
    control = trials(Trial(PLC))
    run = msgspec.structs.replace(pinned(control), properties=())
    assert run.cfg_sha256 is not None
    found = judge(run, control.cfg, run.cfg_sha256, control.outcome)
    assert not found.as_expected and found.reason == "runs.toml lists no property"
    copy(tmp_path)
    path = tmp_path / "spec" / DOCUMENT / "runs.toml"
    head, row = path.read_text().split("[run.OPEN_Plc]\n")
    row, rest = row.split("\n\n", 1)
    row = re.sub(r"properties = \[[^]]*\]", "properties = []", row)
    rest = re.sub(r"\[based.OPEN_Plc[^]]*\]\n(?:[^\n]+\n)*", "", rest)
    path.write_text(f"{head}[run.OPEN_Plc]\n{row}\n\n{rest}")
    assert "run OPEN_Plc: the property list is empty" in register_problems(tmp_path, DOCUMENT)


def test_a_cfg_that_no_run_names_is_noticed(tmp_path: Path) -> None:
    copy(tmp_path)
    assert register_problems(tmp_path, DOCUMENT) == ()
    models = tmp_path / "spec" / DOCUMENT / "models"
    models.mkdir()
    (models / "MC_more.cfg").write_text("SPECIFICATION Spec\n")
    assert register_problems(tmp_path, DOCUMENT) == ("models/MC_more.cfg is in no run",)

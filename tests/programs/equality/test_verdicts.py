"""The verdicts of prove-program: PROVED, REFUTED with a trace that was replayed, UNKNOWN."""

from __future__ import annotations

import json
import time
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.kit.vectors import open_suite
from programs.commands.prove_program import limits, record_of, states, text_of
from programs.equality.binding import read_binding
from programs.equality.comparison import make
from programs.equality.fixpoint import Search
from programs.equality.product import Product
from programs.equality.replay import Difference, Run, replay
from programs.equality.verdict import Verdict, judge
from programs.invariants.relations import Relation

ROOT = Path(__file__).parents[3]
EDM = ROOT / "examples" / "st" / "sf_edm.st"
EDM_OUTPUTS = ["Ready", "S_EDM_Out", "SafetyDemand", "ResetRequest", "Error", "DiagCode"]
VECTORS = ROOT / "vectors"
FAULTS = {
    "a code of another error": ("code := 16#C070", "code := 16#C080"),
    "a request that must go first": (
        "IF S_OutControl THEN\n                    mode := On",
        "IF control.Q THEN\n                    mode := On",
    ),
    "a timer that is not restarted": ("mode := On; restart := TRUE;", "mode := On;"),
    "one contactor for two": ("IF S_EDM1 AND S_EDM2 THEN", "IF S_EDM1 THEN"),
    "an output that stays on": ("S_EDM_Out := mode = On;", "S_EDM_Out := mode = On OR mode = Fault;"),
}


def silent(text: str) -> None:
    """Nothing is told."""


def judged(path: Path, target: str, vectors: Path = VECTORS, **options: Any) -> Verdict:
    """The verdict on a program."""
    return judge(make([path], target, **options), vectors / target, 120, silent)


@cache
def edm() -> Verdict:
    """The verdict on the shipped example."""
    return judged(EDM, "sf_edm")


def changed(folder: Path, old: str, new: str) -> Path:
    """The example with one edit."""
    text = EDM.read_text("utf-8")
    assert text.count(old) >= 1, old
    path = folder / "changed.st"
    path.write_text(text.replace(old, new, 1), "utf-8")
    return path


def replayed(found: Verdict) -> Difference:
    """The difference, after it came out once more."""
    assert found.difference is not None
    again = replay(found.product.binding, found.product.wrap, found.difference.run, "")
    assert again is not None and again.differing == found.difference.differing and again.differing
    assert len(again.scans) == len(found.difference.scans)
    return found.difference


def test_the_example_is_proved_equal() -> None:
    found = edm()
    assert found.word == "PROVED"
    text = "\n".join(text_of(found, 1.0))
    assert "any MonitoringTime_ms 0..3600000; AFTER_RESET = at_once" in text
    assert len(found.product.nodes) == 24 and found.replayed is not None and found.replayed.cases > 100


@pytest.mark.deep
@pytest.mark.parametrize("path", [path for path in sorted(EDM.parent.glob("sf_*.st")) if path != EDM])
def test_every_other_example_is_proved_equal(path: Path) -> None:
    assert judged(path, path.stem).word == "PROVED"


@pytest.mark.sampled(3)
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_refuted_by_published_vectors(name: str, tmp_path: Path) -> None:
    found = judged(changed(tmp_path, *FAULTS[name]), "sf_edm")
    assert found.word == "REFUTED"
    replayed(found)


@pytest.mark.sampled
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_refuted_without_vectors(name: str, tmp_path: Path) -> None:
    found = judged(changed(tmp_path, *FAULTS[name]), "sf_edm", vectors=tmp_path)
    assert found.word == "REFUTED"
    assert replayed(found).found_by == "search along the pairs"


@pytest.mark.deep
def test_an_inequality_at_one_value_is_found(tmp_path: Path) -> None:
    found = judged(
        changed(tmp_path, "PT := MonitoringTime", "PT := MAX(MonitoringTime, T#1ms)"), "sf_edm", tmp_path
    )
    assert found.word == "REFUTED"
    assert replayed(found).parameters["MonitoringTime_ms"] == 0


@pytest.mark.deep
def test_a_value_out_of_its_type_is_refuted(tmp_path: Path) -> None:
    path = changed(tmp_path, "missing : WORD;", "missing : WORD; count : SINT := 123;")
    text = path.read_text("utf-8").replace("edge(CLK := Reset);", "count := count + 1; edge(CLK := Reset);")
    path.write_text(text, "utf-8")
    found = judged(path, "sf_edm")
    assert found.word == "REFUTED" and found.difference is not None
    assert "128 is outside SINT" in found.difference.stopped
    assert len(found.difference.scans) == 5
    assert judged(path, "sf_edm", wrap=True).word == "PROVED"


def test_the_command_prints_and_writes_the_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, file = changed(tmp_path, *FAULTS["an output that stays on"]), tmp_path / "out.json"
    binding = tmp_path / "binding.toml"
    binding.write_text("left_out = ['DiagCode']\n", "utf-8")
    given = ["prove-program", str(path), "--target", "sf_edm", "--json", str(file), "--same"]
    assert main([*given, "--binding", str(binding)]) == 1
    assert "S_EDM_Out        reference 0        program 1   <- differs" in capsys.readouterr().out
    record = json.loads(file.read_text("utf-8"))
    assert record["verdict"] == record["follows"]["verdict"] == "BREAKS"
    assert record["same"]["verdict"] == "REFUTED"
    assert record["same"]["difference"]["differing"] == ["S_EDM_Out"]
    assert list(record["binding_file"]) == [str(binding)]


def test_a_proof_has_no_difference_in_its_record() -> None:
    record, rows = record_of(edm()), states(edm().product, {})
    assert record["verdict"] == "PROVED" and "difference" not in record and record["pairs"] == 24
    assert len(rows) == 24 and {row["reached_after"] for row in rows} == {0, None}
    assert "what the compiler and the PLC make of the source" in limits(edm().product)


@pytest.mark.deep
def test_an_edit_without_effect_is_proved(tmp_path: Path) -> None:
    level = ("ELSIF edge.Q AND S_EDM1 AND S_EDM2", "ELSIF Reset AND S_EDM1 AND S_EDM2")
    assert judged(changed(tmp_path, *level), "sf_edm").word == "PROVED"


def test_the_scan_time_may_be_an_input(tmp_path: Path) -> None:
    path = changed(tmp_path, "MonitoringTime : TIME;", "MonitoringTime : TIME; dt_ms : TIME;")
    text = path.read_text("utf-8").replace(
        "END_FUNCTION_BLOCK", "Ready := Ready OR dt_ms = T#77ms;\nEND_FUNCTION_BLOCK"
    )
    path.write_text(text, "utf-8")
    found = judged(path, "sf_edm", vectors=tmp_path)
    assert found.word == "REFUTED" and replayed(found).scans[-1][0] == 77
    assert "elapsed times up to 2,147,483,647" in "\n".join(text_of(found, 1.0))


# ---------------------------------------------------------------- what would make a proof worthless


def fresh(path: Path = EDM) -> Product:
    """A product whose pairs were found."""
    product = make([path], "sf_edm")
    Search(product, {}, time.process_time() + 120, silent).run()
    return product


def test_a_forgotten_pair_is_noticed() -> None:
    product = edm().product
    gone = next(pair for pair in product.nodes if pair[0] == "OutputEnable")
    node = product.nodes.pop(gone)
    try:
        assert any("the next pair is known" in doubt.what for doubt in product.doubts())
    finally:
        product.nodes[gone] = node


def test_a_relation_that_does_not_hold_is_noticed() -> None:
    product = edm().product
    pair = next(pair for pair in product.nodes if pair[0] == "OutputDisable")
    before = product.nodes[pair].relations
    product.nodes[pair].relations = [*before, Relation("constant", "p:STARTFAULT", value=False)]
    try:
        assert any("the next pair is known" in doubt.what for doubt in product.doubts())
    finally:
        product.nodes[pair].relations = before


def test_a_pair_without_values_is_no_proof() -> None:
    product = edm().product
    pair = next(pair for pair in product.nodes if pair[0] == "OutputDisable")
    before = product.nodes[pair].relations
    one = next(relation for relation in before if relation.kind == "constant")
    other = type(one)(one.kind, one.left, one.right, not one.value)
    product.nodes[pair].relations = [*before, other]
    try:
        with pytest.raises(TimeoutError, match="no values fulfil its relations"):
            list(product.doubts())
    finally:
        product.nodes[pair].relations = before


def test_memory_ranges_of_the_reference_are_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    product = make([EDM], "sf_edm")
    reference = product.binding.reference
    narrow = z3.And(reference.memory_ranges, reference.memory_terms["elapsed_ms"] <= 1000)
    reference.__dict__["memory_ranges"] = narrow
    Search(product, {}, time.process_time() + 120, silent).run()
    assert any("memory stays within" in doubt.what for doubt in product.doubts())


def test_an_obligation_of_the_program_is_asked(tmp_path: Path) -> None:
    path = changed(tmp_path, "missing : WORD;", "missing : WORD; count : SINT := 118;")
    text = path.read_text("utf-8").replace("edge(CLK := Reset);", "count := count + 1; edge(CLK := Reset);")
    path.write_text(text, "utf-8")
    assert any("a value stays within SINT" in doubt.what for doubt in fresh(path).doubts())


@pytest.mark.deep
def test_a_difference_of_a_first_retained_value_is_replayed(tmp_path: Path) -> None:
    path = changed(
        tmp_path, "missing : WORD;\nEND_VAR", "missing : WORD;\nEND_VAR\nVAR RETAIN kept : BOOL; END_VAR"
    )
    text = path.read_text("utf-8").replace("Ready := mode <> Inactive;", "Ready := mode <> Inactive OR kept;")
    path.write_text(text, "utf-8")
    found = judged(path, "sf_edm")
    assert found.word == "REFUTED" and replayed(found).run.retained == {"KEPT": True}
    assert "  retained    KEPT=1" in "\n".join(text_of(found, 1.0))


@pytest.mark.deep
def test_a_difference_is_kept_as_a_vector(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, file = changed(tmp_path, *FAULTS["an output that stays on"]), tmp_path / "difference.jsonl"
    junit = tmp_path / "out.xml"
    given = ["prove-program", str(path), "--target", "sf_edm", "--vector", str(file), "--junit", str(junit)]
    given.append("--same")
    assert main(given) == 1
    assert 'failures="1"' in junit.read_text("utf-8")
    case = next(iter(open_suite(file).cases()))
    assert len(case.scans) == 3
    assert main(["conform", "sf_edm", "--builtin", "refimpl", "--vectors", str(file)]) == 0
    assert "CONFORMS(exact, difference, not published)" in capsys.readouterr().out
    reference = make([path], "sf_edm").binding.reference
    scans = [(scan.dt_ms, reference.from_wire("inputs", scan.inputs)) for scan in case.scans]
    run = Run(reference.with_defaults(reference.from_wire("parameters", case.params)), scans)
    again = replay(make([path], "sf_edm").binding, False, run, "")
    assert again is not None and again.differing == ["S_EDM_Out"]


@pytest.mark.deep
def test_a_difference_has_the_fewest_scans(tmp_path: Path) -> None:
    path = changed(tmp_path, *FAULTS["a code of another error"])
    found = judged(path, "sf_edm")
    assert found.difference is not None and len(found.difference.scans) == 4


@pytest.mark.deep
def test_flags_that_tell_states_apart_are_found(tmp_path: Path) -> None:
    """A level that is latched in one of two words, by a flag that no state of the reference knows."""
    path = tmp_path / "plc.st"
    text = (EDM.parent / "plc.st").read_text("utf-8")
    text = text.replace("turn : BYTE", "first, second : WORD; side : BOOL; turn : BYTE")
    text = text.replace(
        "IF (turn AND 16#01) <> 16#00 THEN ReadAuthorization := MW01; END_IF",
        "IF (turn AND 16#01) <> 16#00 THEN side := NOT side; "
        "IF side THEN first := MW01; ELSE second := MW01; END_IF END_IF\n"
        "IF side THEN ReadAuthorization := first; ELSE ReadAuthorization := second; END_IF",
    )
    path.write_text(text, "utf-8")
    found = judged(path, "plc")
    assert found.word == "PROVED" and found.product.split == ("SIDE",)


# ---------------------------------------------------------------- the binding


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("[names]\nRedy = 'Ready'\n", "sf_edm has no Redy; did you mean 'Ready'"),
        ("[names]\nReady = 'Redy'\n", "the binding names 'Redy', which is no output"),
        ("left_out = ['Activate']\n", "Activate is no output"),
        ("[parameters]\nMonitoringTime_ms = 5\n", "is an input of SF_EDM, so it has no single value"),
        ("[parameters]\nAFTER_RESET = 'never'\n", "AFTER_RESET"),
        ("profile = 'bold'\n", "no profile 'bold'"),
        ("profile = 1\n", "profile: a text is needed"),
        ("[name]\n", "unknown key 'name'; did you mean 'names'"),
        (f"left_out = {EDM_OUTPUTS}\n", "no output is compared"),
        ("[names]\nS_EDM1 = 'S_EDM2'\n", "are both bound to S_EDM2"),
        ("[names]\ndt_ms = 'MonitoringTime'\n", "MonitoringTime_ms and dt_ms are both bound"),
        ("[names]\nError = 'Ready'\n", "Ready and Error are both bound to READY"),
        ("left_out = ['Ready']\n[names]\nReady = 'Redy'\n", "under .names. and under left_out"),
    ],
)
def test_a_binding_that_cannot_be_right_is_refused(text: str, cause: str, tmp_path: Path) -> None:
    path = tmp_path / "binding.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(Unjudged, match=cause):
        make([EDM], "sf_edm", binding=read_binding(path))


def test_an_enumeration_in_another_order_is_refused(tmp_path: Path) -> None:
    kinds = ("(stop_first, at_once)", "(Other, Names)")
    for kind in kinds:
        make([changed(tmp_path, "Activate : BOOL;", f"Activate : BOOL; AFTER_RESET : {kind};")], "sf_edm")
    path = changed(tmp_path, "Activate : BOOL;", "Activate : BOOL; AFTER_RESET : (At_once, Stop_first);")
    with pytest.raises(Unjudged, match="AFTER_RESET counts"):
        make([path], "sf_edm")


def test_an_output_of_nobody_is_named(tmp_path: Path) -> None:
    path = changed(tmp_path, "Ready : BOOL;", "Ready : BOOL; Spare : BOOL;")
    found = judged(path, "sf_edm", binding={"left_out": ("DiagCode",)})
    assert "  left out    DiagCode; of the program's own: Spare" in text_of(found, 1)
    assert "output Spare of the program: the target has none such" in limits(found.product)


def test_a_binding_gives_names_and_parameters(tmp_path: Path) -> None:
    program = tmp_path / "renamed.st"
    program.write_text(EDM.read_text("utf-8").replace("S_OutControl", "Demand"), "utf-8")
    path = tmp_path / "binding.toml"
    path.write_text("left_out = ['DiagCode']\n[names]\nS_OutControl = 'Demand'\n", "utf-8")
    found = judged(program, "sf_edm", binding=read_binding(path))
    assert found.word == "PROVED" and "DiagCode" not in found.product.binding.compared


@pytest.mark.deep
def test_another_parameter_is_another_verdict(tmp_path: Path) -> None:
    path = tmp_path / "binding.toml"
    path.write_text("profile = 'cautious'\n", "utf-8")
    assert judged(EDM, "sf_edm", binding=read_binding(path)).word == "REFUTED"

"""Does a program follow the page? Proved, broken by scans, or not known; what is assumed; the certificate."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from programs.certificates import demand_certificate
from programs.certificates.certificate_folder import NAME, digest_of
from programs.certificates.demand_certificate import judgement_of
from programs.certificates.recheck import recheck
from programs.commands.following import Followed
from programs.demands.assumptions import Assumed
from programs.equality.comparison import make
from programs.equality.replay import Run

SWITCH = TREE / "examples/st/sf_enable_switch.st"


def followed(
    path: Path, assumed: dict[str, Any] | None = None, latency: int = 1, seconds: float = 30
) -> Followed:
    """The verdicts on a program beside the page of the enable switch."""
    product = make([path], "sf_enable_switch", codes=False)
    vectors = TREE / "vectors/sf_enable_switch"
    judgement = judgement_of(product, assumed or {}, latency, vectors, seconds, lambda text: None)
    return Followed(product, judgement, judgement.all())


def changed(folder: Path, old: str, new: str) -> Path:
    """The program with one text in the place of another."""
    text = SWITCH.read_text("utf-8")
    assert text.count(old) >= 1
    path = folder / "switch.st"
    path.write_text(text.replace(old, new, 1), "utf-8")
    return path


@pytest.fixture(scope="module")
def good() -> Followed:
    """The example, which follows the page."""
    return followed(SWITCH)


def test_an_example_follows_its_page(good: Followed) -> None:
    assert good.word == "FOLLOWS" and not good.judgement.beside.unjudged
    assert good.sentence.endswith(f"{len(good.rows)} of {len(good.rows)} demands, proved for ever")
    assert all(one.proof is not None for one in good.found)


def test_a_block_that_does_nothing_breaks_its_page(tmp_path: Path) -> None:
    head, _, _ = SWITCH.read_text("utf-8").partition("END_VAR\nVAR\n")
    path = tmp_path / "nothing.st"
    path.write_text(f"{head}END_VAR\nReady := Activate;\nEND_FUNCTION_BLOCK\n", "utf-8")
    found = followed(path)
    assert found.word == "BREAKS" and "Stage1Enables" in {one.asked.id for one in found.broken}
    for one in found.broken:
        assert one.broken is not None
        watch = found.judgement.beside.watch(one.broken.run, [one.asked.id])
        *before, last = [watch.scan(step.dt_ms, step.inputs, step.outputs) for step in one.broken.steps]
        assert before == [None] * len(before) and last is not None


def test_a_program_that_leaves_its_types_follows_nothing(tmp_path: Path) -> None:
    text = SWITCH.read_text("utf-8").replace("\nVAR\n", "\nVAR\n    count : SINT;\n", 1)
    path = tmp_path / "counts.st"
    path.write_text(text.replace("END_FUNCTION_BLOCK", "count := count + 100;\nEND_FUNCTION_BLOCK"), "utf-8")
    found = followed(path, seconds=5)
    assert found.word == "BREAKS" and found.broken[0].asked.id == "types"
    assert {one.word for one in found.rows} == {"UNKNOWN"}


def test_an_output_that_is_left_out_leaves_demands_unjudged(tmp_path: Path) -> None:
    product = make([SWITCH], "sf_enable_switch", binding={"left_out": ("Error",)}, codes=False)
    judgement = judgement_of(product, {}, 1, None, 20, lambda text: None)
    found = Followed(product, judgement, judgement.all())
    assert found.word == "UNKNOWN" and "ErrorNeedsReason" in {row.id for row in judgement.beside.unjudged}


@pytest.mark.deep
def test_the_command_says_both_answers_in_order(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "out.json"
    assert main(["prove-program", str(SWITCH), "--target", "sf_enable_switch", "--json", str(file)]) == 0
    said = capsys.readouterr().out
    assert said.startswith("FOLLOWS: ") and said.index("FOLLOWS") < said.index("SAME AS the reference")
    record = json.loads(file.read_text("utf-8"))
    assert (record["verdict"], record["status"], record["same"]["verdict"]) == ("FOLLOWS", 0, "PROVED")
    assert "DiagCode" in record["same"]["left_out"]


# ---------------------------------------------------------------- what is assumed


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ({"constants": []}, "unknown key 'constants'; did you mean 'constant'"),
        ({"constant": ["Rest"]}, "sf_enable_switch has no input Rest; did you mean 'Reset'"),
        ({"never_both": [["Reset"]]}, "lists of two inputs or more"),
        ({"never_both": ["Reset"]}, "a list of lists is needed"),
        ({"held_ms": {"Reset": 0}}, "whole ms above 0"),
        (
            {"constant": {"Reset": True, "Activate": True}, "never_both": [["Reset", "Activate"]]},
            "no run fulfils",
        ),
    ],
)
def test_an_assumption_that_is_none_is_refused(own: dict[str, Any], said: str) -> None:
    with pytest.raises(Unjudged, match=said):
        judgement_of(make([SWITCH], "sf_enable_switch", codes=False), own, 1, None, 5, lambda text: None)


@pytest.mark.deep
def test_an_assumption_holds_in_the_scans_that_are_found(tmp_path: Path) -> None:
    last = "    END_CASE\nEND_CASE\nEND_FUNCTION_BLOCK"
    path = changed(tmp_path, last, last.replace("END_FUNC", "Error := Error OR Reset;\nEND_FUNC"))
    free = followed(path, seconds=5)
    assert "InactiveShowsNothing" in {one.asked.id for one in free.broken}
    held = followed(path, {"constant": {"Reset": False}}, seconds=5)
    assert (
        not held.broken
        and "Reset: constant FALSE during a run (yours)" in held.judgement.beside.assumed.words()
    )


def test_a_run_is_cut_where_an_assumption_ends() -> None:
    of = make([SWITCH], "sf_enable_switch", codes=False).binding.reference
    names = list(of.signals("inputs"))
    rows = [dict.fromkeys(names, False) for _ in range(4)]
    rows[1]["Reset"] = rows[3]["Reset"] = rows[3]["Activate"] = True
    run = Run({}, [(10, row) for row in rows])
    for own, scans in (
        ({}, 4),
        ({"constant": ["Reset"]}, 1),
        ({"constant": {"Activate": False}}, 3),
        ({"never_both": [["Reset", "Activate"]]}, 3),
        ({"held_ms": {"Reset": 11}}, 2),
        ({"held_ms": {"Reset": 10}}, 4),
    ):
        assert len(Assumed(of, own).fulfilling(run).scans) == scans, own


def test_an_input_that_the_page_calls_constant_is_so() -> None:
    of = make([SWITCH], "sf_enable_switch", codes=False).binding.reference
    found = Assumed(of, {}, ("S_AutoReset",))
    assert found.constant == ("S_AutoReset",)
    assert list(found.words()) == ["S_AutoReset: constant during a run, as the page has it"]
    assert Assumed(of, {"flips": True}, ("S_AutoReset",)).constant == ()
    on, off = (dict.fromkeys(of.signals("inputs"), value) for value in (True, False))
    held = found.steadied(Run({}, [(0, on), (10, off)]))
    assert len(found.fulfilling(held).scans) == 2 and held.scans[1][1] == {**off, "S_AutoReset": True}


# ---------------------------------------------------------------- the certificate


@pytest.fixture(scope="module")
def written(good: Followed, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A certificate of the example."""
    place = tmp_path_factory.mktemp("written") / "certificate"
    demand_certificate.write(good.judgement, good.product, good.found, place, None)
    return place


@pytest.fixture
def folder(written: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(written, tmp_path / "certificate"))


def record_of(folder: Path) -> Any:
    """The record of a certificate."""
    return json.loads((folder / NAME).read_text("utf-8"))


def test_a_certificate_is_checked_by_both_solvers(folder: Path) -> None:
    found = recheck(folder)
    assert found.status == 0 and set(found.answers.answers) == {"z3", "cvc5"}
    assert "FOLLOWS the page (enable_switch)" in found.about[0]


def weaker_demand(record: Any) -> None:
    """Another text of a demand."""
    record["demands"][0][3] = "when False: holds True"


def other_latency(record: Any) -> None:
    """More time for every reaction."""
    record["latency"] = 2


def more_assumed(record: Any) -> None:
    """An assumption that was not asked for."""
    record["assumed"] = {"constant": ["Activate"]}


def no_proof(record: Any) -> None:
    """One proof fewer."""
    record["proofs"].pop()


def false_invariant(record: Any) -> None:
    """An invariant that does not hold."""
    record["proofs"][0]["invariants"] = ["false"]


@pytest.mark.parametrize(
    "edit",
    [weaker_demand, other_latency, more_assumed, no_proof, false_invariant],
    ids=lambda one: one.__name__,
)
def test_an_edited_certificate_is_refused(edit: Any, folder: Path) -> None:
    record = record_of(folder)
    edit(record)
    (folder / NAME).write_text(json.dumps(record), "utf-8")
    with pytest.raises(Unjudged):
        recheck(folder)


def test_a_proof_of_nothing_is_not_shown(folder: Path) -> None:
    kept, record = demand_certificate.read(folder), record_of(folder)
    deep = next(row for row in record["proofs"] if row["invariants"] or row["scans"] > 1)
    deep["invariants"], deep["scans"] = [], 1
    (folder / NAME).write_text(json.dumps(record), "utf-8")
    judgement = kept.judgement()
    kept = demand_certificate.read(folder)
    texts = {one.file: one.text for one in demand_certificate.obligations(judgement, kept.proofs(judgement))}
    for path in folder.glob("*.smt2"):
        path.unlink()
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")
    record["queries"] = {name: digest_of(text) for name, text in texts.items()}
    (folder / NAME).write_text(json.dumps(record), "utf-8")
    assert recheck(folder).status == 1

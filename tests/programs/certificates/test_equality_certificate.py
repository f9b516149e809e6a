"""Certificates: checked again without search, and each cheat is noticed."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.kit.errors import Unjudged as KitUnjudged
from programs.certificates import equality_certificate as certificate
from programs.certificates.certificate_folder import NAME, digest, digest_of
from programs.certificates.recheck import recheck
from programs.equality.comparison import make
from programs.equality.replay import Run
from programs.equality.verdict import Verdict, judge
from programs.invariants.relations import Relation

ROOT = Path(__file__).parents[3]
PLC = ROOT / "examples" / "st" / "plc.st"
EDM = ROOT / "examples" / "st" / "sf_edm.st"


def silent(text: str) -> None:
    """Nothing is told."""


@cache
def proved() -> Verdict:
    """The verdict on the shipped PLC."""
    return judge(make([PLC], "plc"), ROOT / "vectors" / "plc", 60, silent)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A certificate of a copy of the shipped PLC, which a test may spoil."""
    program, place = tmp_path / "plc.st", tmp_path / "certificate"
    shutil.copy(PLC, program)
    found = proved()
    assert found.word == "PROVED" and found.replayed is not None
    product = make([program], "plc")
    product.nodes = {pair: replace(node) for pair, node in found.product.nodes.items()}
    assert certificate.write(product, found.replayed, place).keys() == product.nodes.keys()
    return place


def record_of(folder: Path) -> Any:
    """certificate.json as it stands."""
    return json.loads((folder / NAME).read_text("utf-8"))


def keep(folder: Path, record: Any) -> None:
    """Put another record in its place."""
    (folder / NAME).write_text(json.dumps(record), "utf-8")


def written_anew(folder: Path, spoil: Callable[[Any], None]) -> None:
    """A cheat that is consistent: the relations or pairs are spoilt, and the queries made to go with them."""
    kept = certificate.read(folder)
    product = make(kept.files("sources"), "plc")
    kept.fill(product)
    spoil(product)
    replayed = proved().replayed
    assert replayed is not None
    certificate.write(product, replayed, folder)


def test_a_certificate_is_shown_by_both_solvers(folder: Path) -> None:
    found = recheck(folder)
    assert found.status == 0 and not found.unreached
    assert (
        found.answers.files == 5
        and found.answers.count >= 16
        and set(found.answers.answers) == {"z3", "cvc5"}
    )
    text = "\n".join(found.lines(0.0))
    assert text.startswith("PROVED, checked again: function block PLC") and "cvc5        5 of 5 files" in text


def test_every_pair_is_reached_by_scans(folder: Path) -> None:
    rows = record_of(folder)["pairs"]
    assert len(rows) == 4 and all(row["reached_by"] is not None for row in rows)


@pytest.mark.deep
def test_the_command_writes_and_checks_a_certificate(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place, junit = tmp_path / "made", tmp_path / "out.xml"
    given = ["prove-program", str(PLC), "--target", "plc", "--certificate", str(place), "--junit", str(junit)]
    assert main([*given, "--same"]) == 0
    assert f"check it with --recheck {place}" in capsys.readouterr().out
    assert main(["prove-program", "--recheck", str(place)]) == 0
    said = capsys.readouterr().out
    assert "has the outputs of plc" in said and "FOLLOWS the page (mode_selection)" in said
    assert 'failures="0"' in junit.read_text("utf-8")


# ---------------------------------------------------------------- cheats


def drop_pair(record: Any) -> None:
    """One pair fewer."""
    record["pairs"].pop(0)


def drop_relation(record: Any) -> None:
    """One relation fewer."""
    next(row for row in record["pairs"] if row["relations"])["relations"].pop()


def lead_elsewhere(record: Any) -> None:
    """One successor fewer."""
    record["pairs"][0]["leads_to"] = []


def other_scans(record: Any) -> None:
    """Scans that lead to another pair."""
    rows = [row["reached_by"] for row in record["pairs"]]
    record["pairs"][1]["reached_by"], record["pairs"][2]["reached_by"] = rows[2], rows[1]


def leave_out(record: Any) -> None:
    """An output that is not compared any more."""
    record["binding"]["left_out"] = ["MW07"]


def unknown_name(record: Any) -> None:
    """A relation about what is no memory."""
    record["pairs"][0]["relations"].append(
        {"kind": "constant", "left": "p:NOTHING", "right": "", "value": 0, "text": ""}
    )


def unknown_kind(record: Any) -> None:
    """A relation of no kind."""
    record["pairs"][0]["relations"].append({"kind": "any", "left": "p:MW03", "right": "", "value": 0})


def no_start(record: Any) -> None:
    """Without the pair of power-up."""
    record["pairs"] = [row for row in record["pairs"] if row["reached_by"]["scans"]]


def other_reference(record: Any) -> None:
    """Another reference implementation."""
    record["reference"]["refimpl/mode_selection/plc.py"] = "0" * 64


def another_beginning(record: Any) -> None:
    """Scans from a memory that is not that of power-up."""
    record["pairs"][1]["reached_by"]["retained"] = {"TURN": 0x22}


def no_variable(record: Any) -> None:
    """Scans from the value of nothing."""
    record["pairs"][1]["reached_by"]["retained"] = {"NOTHING": 1}


def no_queries(record: Any) -> None:
    """A shorter list of queries."""
    record["queries"].popitem()


EDITS = {
    drop_pair: "the queries are not those",
    drop_relation: "not the obligation that follows",
    lead_elsewhere: "not the obligation that follows",
    other_scans: "do not lead there",
    leave_out: "compared is not what the sources and the binding give",
    unknown_name: "p:NOTHING = 0 is no relation",
    unknown_kind: "is no relation|not the form",
    no_start: "the pair of power-up",
    other_reference: "refimpl/mode_selection/plc.py has changed since",
    another_beginning: "TURN is no RETAIN variable",
    no_variable: "do not lead there: KeyError",
    no_queries: "the queries are not those",
}


@pytest.mark.parametrize(("edit", "cause"), EDITS.items(), ids=lambda case: getattr(case, "__name__", ""))
def test_an_edited_certificate_is_refused(edit: Callable[[Any], None], cause: str, folder: Path) -> None:
    record = record_of(folder)
    edit(record)
    keep(folder, record)
    with pytest.raises(Unjudged, match=cause):
        recheck(folder)


def test_wrapping_numbers_are_no_numbers_that_stay_in_range(tmp_path: Path) -> None:
    program, place = tmp_path / "plc.st", tmp_path / "certificate"
    text = PLC.read_text("utf-8").replace("BYTE := 16#11;", "BYTE := 16#11; count : SINT;")
    program.write_text(text.replace("turn := ROL(turn, 1);", "turn := ROL(turn, 1); count := count + 1;"))
    given = ["prove-program", str(program), "--target", "plc", "--certificate", str(place)]
    assert main([*given, "--wrap", "--same"]) == 0 and recheck(place).status == 0
    record = record_of(place)
    assert record["wrap"] is True
    keep(place, record | {"wrap": False})
    with pytest.raises(Unjudged, match="not the obligation that follows from the program"):
        recheck(place)


def test_a_weaker_query_is_refused(folder: Path) -> None:
    path = sorted(folder.glob("*.smt2"))[1]
    path.write_text(path.read_text("utf-8").replace("(push 1)", "(push 1)\n(assert false)", 1), "utf-8")
    record = record_of(folder)
    record["queries"][path.name] = digest_of(path.read_text("utf-8"))
    keep(folder, record)
    with pytest.raises(Unjudged, match="not the obligation that follows from the program"):
        recheck(folder)


def test_a_certificate_that_is_no_text_is_refused(folder: Path) -> None:
    sorted(folder.glob("*.smt2"))[1].write_bytes(b"\xff")
    with pytest.raises(Unjudged, match="not the obligation that follows"):
        recheck(folder)
    (folder / NAME).write_text("[" * 100_000, "utf-8")
    with pytest.raises(Unjudged, match="no JSON"):
        recheck(folder)


def test_scans_with_other_parameters_show_no_pair() -> None:
    product, run = make([EDM], "sf_edm"), Run({"AFTER_RESET": "at_once", "MonitoringTime_ms": 5}, [])
    assert not certificate._outside(product, run)
    other = Run({"AFTER_RESET": "stop_first", "MonitoringTime_ms": 5}, [])
    assert certificate._outside(product, other) == "their parameters are none of the claim"


@pytest.mark.parametrize("stop", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_half_a_certificate_is_not_left_behind(
    stop: BaseException, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from modeproof.kit import files

    right, count = files.write_whole, iter(range(3))

    def full(path: Path, content: bytes, mode: int = 0o644) -> None:
        if next(count, None) is None:
            raise stop
        right(path, content, mode)

    replayed = proved().replayed
    assert replayed is not None
    with monkeypatch.context() as patched:
        patched.setattr(files, "write_whole", full)
        with pytest.raises((KitUnjudged, KeyboardInterrupt)):
            certificate.write(proved().product, replayed, folder)
    assert not list(folder.iterdir())
    certificate.write(proved().product, replayed, folder)
    assert recheck(folder).status == 0


@pytest.mark.parametrize("more", [True, False])
def test_another_set_of_queries_is_refused(more: bool, folder: Path) -> None:
    if more:
        (folder / "999-more.smt2").write_text("(check-sat)\n", "utf-8")
    else:
        sorted(folder.glob("*.smt2"))[-1].unlink()
    with pytest.raises(Unjudged, match=r"the queries are not those that follow from the program"):
        recheck(folder)


def test_a_changed_program_is_refused(folder: Path) -> None:
    program = folder.parent / "plc.st"
    program.write_text(program.read_text("utf-8") + "\n", "utf-8")
    with pytest.raises(Unjudged, match=r"plc.st has changed since"):
        recheck(folder)


def test_another_program_under_the_same_queries_is_refused(folder: Path) -> None:
    program, record = folder.parent / "plc.st", record_of(folder)
    program.write_text(program.read_text("utf-8").replace("MW03 := SelectMSO", "MW03 := SwitchMSO"), "utf-8")
    record["sources"] = {str(program): digest(program)}
    keep(folder, record)
    with pytest.raises(Unjudged, match=r"not the obligation that follows|the outputs differ on the way"):
        recheck(folder)


def test_a_changed_binding_is_refused(tmp_path: Path) -> None:
    binding, place = tmp_path / "binding.toml", tmp_path / "made"
    binding.write_text("left_out = ['MW07']\n", "utf-8")
    given = ["prove-program", str(PLC), "--target", "plc", "--binding", str(binding)]
    assert main([*given, "--certificate", str(place), "--same"]) == 0
    binding.write_text("left_out = []\n", "utf-8")
    with pytest.raises(Unjudged, match=r"binding.toml has changed since"):
        recheck(place)


def false_relation(product: Any) -> None:
    """A relation that does not hold."""
    node = next(node for pair, node in product.nodes.items() if pair != product.start[0])
    node.relations.append(Relation("constant", "p:MW03", value=1))


def too_few(product: Any) -> None:
    """A pair without the relations that it needs."""
    max(product.nodes.values(), key=lambda node: len(node.relations)).relations.clear()


def forgotten(product: Any) -> None:
    """A pair that is reached and not there."""
    del product.nodes[sorted(product.nodes)[0]]


@pytest.mark.parametrize("spoil", [false_relation, too_few, forgotten], ids=lambda case: case.__name__)
def test_consistent_cheats_are_not_shown(spoil: Callable[[Any], None], folder: Path) -> None:
    written_anew(folder, spoil)
    try:
        found = recheck(folder)
    except Unjudged as error:
        assert "do not lead there" in str(error) or "power-up" in str(error)
        return
    assert found.status == 1
    assert all("sat" in answers.values() for answers in found.answers.answers.values())


@pytest.mark.parametrize(
    "more",
    ["--json=x", "--junit=x", "--vector=x", "--certificate=x", "--seconds=5", "--wrap", "--unit=x", "--same"],
)
def test_an_option_without_effect_is_refused(more: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove-program", "--recheck", "folder", more]) == 2
    assert "has no effect with --recheck; leave it out" in capsys.readouterr().err


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf"])
def test_a_limit_that_is_none_is_refused(seconds: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove-program", str(PLC), "--target", "plc", "--seconds", seconds]) == 2
    assert "a time above 0 is needed" in capsys.readouterr().err


def test_a_folder_with_other_files_is_not_emptied(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine", "utf-8")
    replayed = proved().replayed
    assert replayed is not None
    with pytest.raises(Unjudged, match=r"holds files that are no certificate"):
        certificate.write(proved().product, replayed, tmp_path)
    assert (tmp_path / "mine.txt").is_file()

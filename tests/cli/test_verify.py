"""verify runs every stage, reports each one that fails, and ends with the worst status of all."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.lane.verify import Stage, check_lane, check_registers, verify
from modeproof.report.verdicts import PropertyRow
from tests.toy_tree import toy_tree

Made = tuple[list[dict[str, Any]], dict[str, str]]


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(
        "modeproof.lane.verify.property_rows",
        lambda place, document: [PropertyRow("Type", "TypeOK", ("honest",))],
    )
    return toy_tree(tmp_path)


def stage(verdict: str, as_expected: bool = True) -> Stage:
    def run(place: Path, names: Sequence[str], lane: str, progress: Progress) -> Made:
        return [
            evidence.make(
                kind="proof",
                id=f"proof_{verdict}",
                document=document,
                verdict=verdict,
                expected="PROVED",
                as_expected=as_expected,
                command="modeproof prove",
                started=0.0,
                seconds=0.5,
                reason="" if as_expected else "planted",
            )
            for document in names
        ], {}

    return run


def unable(place: Path, names: Sequence[str], lane: str, progress: Progress) -> Made:
    raise Unjudged("planted: no solver")


def idle(place: Path, names: Sequence[str], lane: str, progress: Progress) -> Made:
    return [], {}


def half(place: Path, names: Sequence[str], lane: str, progress: Progress) -> Made:
    made, _ = stage("PROVED")(place, names[:1], lane, progress)
    return made, {names[1]: "planted: no graph"}


def run(place: Path, *stages: Stage) -> tuple[int, list[dict[str, Any]]]:
    named = [(f"stage {n}", one) for n, one in enumerate(stages)]
    return verify(place, ["toy"], "smoke", named, Progress(quiet=True))


def test_an_expected_lane_ends_with_0_and_lists_each_property(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, records = run(toy, check_lane, stage("PROVED"))
    out = capsys.readouterr().out
    assert status == 0 and len(records) == 2
    assert "Type     HOLDS   honest      a counter up to 4" in out
    assert "proofs       1 of 1 PROVED" in out
    assert out.splitlines()[-1] == "result       as expected (exit status 0)"


@pytest.mark.parametrize(
    ("stages", "status", "words"),
    [
        ((stage("PROVED"), stage("VIOLATED", False)), 1, "toy/proof_VIOLATED: VIOLATED: planted"),
        ((stage("VIOLATED", False), stage("INCONCLUSIVE", False)), 2, "proof_INCONCLUSIVE"),
        ((unable, stage("PROVED")), 2, "toy, stage 0: UNJUDGED: planted: no solver"),
        ((idle,), 2, "toy, stage 0: UNJUDGED: nothing was done"),
    ],
)
def test_the_worst_of_all_counts_and_each_failure_is_named(
    toy: Path, capsys: pytest.CaptureFixture[str], stages: tuple[Stage, ...], status: int, words: str
) -> None:
    got, _ = run(toy, *stages)
    out = capsys.readouterr().out
    assert got == status and words in out
    assert f"(exit status {status})" in out.splitlines()[-1]


def test_a_property_that_no_run_checks_spoils_the_result(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [PropertyRow("Forgotten", "Nobody", ("honest",))]
    monkeypatch.setattr("modeproof.lane.verify.property_rows", lambda place, document: rows)
    assert run(toy, stage("PROVED"))[0] == 2
    assert "property Forgotten (honest): UNJUDGED: no run checks it" in capsys.readouterr().out


def test_each_document_has_a_screen_and_the_total_names_failures(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(toy / "spec/toy", toy / "spec/twin")
    stages = [("TLC", check_lane), ("proofs", stage("PROVED"))]
    status, records = verify(toy, ["toy", "twin"], "smoke", stages, Progress(quiet=True))
    out = capsys.readouterr().out
    assert status == 0 and len(records) == 4
    assert out.index("== toy") < out.index("== twin") < out.index("== 2 documents")
    for line in ("properties   2 of 2 hold, by environment", "proofs       2 of 2 PROVED", "time         "):
        assert line in out.split("== 2 documents")[1]

    status, _ = verify(toy, ["toy", "twin"], "smoke", [("proofs", half), stages[0]], Progress(quiet=True))
    out = capsys.readouterr().out
    assert status == 2 and "NOT AS EXPECTED  twin, proofs: UNJUDGED: planted: no graph" in out
    assert "toy, proofs" not in out


def test_no_document_at_all_is_refused(toy: Path) -> None:
    with pytest.raises(Unjudged, match="nothing to verify"):
        verify(toy, [], "full", [("stage", idle)], Progress(quiet=True))


def test_registers_that_cannot_be_read_are_unjudged_with_evidence(toy: Path) -> None:
    (record,), _ = check_registers(toy, ["toy"], "full", Progress(quiet=True))
    assert (record["verdict"], record["as_expected"]) == ("UNJUDGED", False)
    assert "spec/toy/clauses.toml" in record["reason"]
    assert evidence.read(evidence.evidence_path(toy, "toy", "registers")) == record

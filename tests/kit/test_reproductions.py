"""What is printed to run again is true: a program that is right passes it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.builtin import Builtin, reference
from modeproof.kit.suite_judge import Options, Plan, run_suite
from tests.kit.faulty import ROOT, TARGETS, campaign, cases_of, chosen, faulty_programs, runs_of, suite_of


@pytest.mark.sampled(3)
@pytest.mark.parametrize("target", sorted(TARGETS, reverse=True))
def test_a_right_program_settles_as_every_target_demands(target: str) -> None:
    """Also where every scan of a case takes time, in which something may happen while inputs are held."""
    suite = suite_of(target, "sic")
    assert suite is not None
    verdict = run_suite(suite, lambda: Builtin("refimpl", suite), plan=Plan(Options("settled"), effort=0))
    assert (verdict.word, verdict.reason) == ("CONFORMS", "")


@pytest.mark.parametrize("target", TARGETS)
def test_programs_of_every_target_are_judged_and_compared(target: str) -> None:
    assert {"exact"} <= {relation for _, relation in runs_of(target)}


@pytest.mark.parametrize(
    "programs", [pytest.param(15, marks=pytest.mark.deep), pytest.param(200, marks=pytest.mark.long)]
)
def test_no_reproduction_of_a_faulty_program_is_wrong(programs: int) -> None:
    counts = campaign(chosen(programs), 3)
    assert counts.found > programs / 2 and counts.replayed > 3 * programs, str(counts)
    assert counts.shorter > programs, str(counts)
    assert counts.wrong == []


def test_a_part_that_a_right_program_fails_is_not_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the question to the reference implementation pieces of time are cut as loops."""
    slow = [one for one in faulty_programs("sf_edm") if one.fault in ("cuts 10", "rounds 100")]
    assert len(slow) == 2 and campaign(slow, 20).wrong == []
    monkeypatch.setattr("modeproof.kit.suite_judge.reference", lambda suite: lambda case: True)
    assert campaign(slow, 20).wrong != []


def test_the_reference_knows_what_a_case_expects() -> None:
    suite = suite_of("sf_edm", "brief")
    assert suite is not None
    gives = reference(suite)
    case = next(iter(cases_of("sf_edm", "brief").values()))
    assert gives is not None and gives(case)
    wrong = replace(case.scans[-1], outputs={**case.scans[-1].outputs, "Ready": "?"})
    assert not gives(replace(case, scans=(*case.scans[:-1], wrong)))
    assert not gives(replace(case, params={"NONE": 1}))
    assert reference(replace(suite, target="none")) is None


def test_what_was_not_run_again_is_not_said_to_be(capsys: pytest.CaptureFixture[str]) -> None:
    """Neither with the first difference, nor where a part is judged."""
    path = ROOT / "vectors/sf_edm/brief.jsonl.gz"
    package = next(one.package for one in faulty_programs("sf_edm") if one.text and differs(one.package))
    args = ["conform", "sf_edm", "--builtin", package, "--vectors", str(path)]
    assert kit_main(args) == 1
    told = capsys.readouterr()
    assert "first difference:" in told.err and "NO difference" not in told.err + told.out
    assert "the case up to there" not in told.err and "shortest way there" not in told.err
    again = next(line for line in told.out.splitlines() if line.startswith("again:")).split()
    tail = [word.strip('"') for word in again[again.index("--case") :]]
    assert kit_main([*args, *tail]) == 1
    told = capsys.readouterr()
    assert "NO difference" not in told.err + told.out and "the case up to there" in told.out
    again = next(line for line in told.out.splitlines() if line.startswith("again:")).split()
    assert [word.strip('"') for word in again[again.index("--case") :]] == tail, "a case that exists"


def differs(package: str) -> bool:
    suite = suite_of("sf_edm", "brief")
    assert suite is not None
    found = run_suite(suite, lambda: Builtin(package, suite), plan=Plan(effort=60)).difference
    return found is not None and found.part != f"1-{found.scan}"

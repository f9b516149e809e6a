"""Programs that are wrong in one place do not conform, and the one without a fault does (test_c_program)."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from examples.faulty.run import (
    HERE,
    PAGE,
    PARTS,
    ROOT,
    Fault,
    build,
    build_all,
    judge,
    judge_all,
    load_faults,
    main,
    open_all,
)
from modeproof.kit.errors import Unjudged
from modeproof.kit.judge import Verdict
from modeproof.kit.vectors import Suite

FAULTS = load_faults()
SPEC = ROOT / "spec/mode_selection"


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Every program of the pack, built once."""
    return build_all(tmp_path_factory.mktemp("faulty"), FAULTS)


@pytest.fixture(scope="module")
def suites() -> dict[str, Suite]:
    return open_all()


@pytest.fixture(scope="module")
def verdicts(programs: dict[str, Path], suites: dict[str, Suite]) -> dict[str, Verdict]:
    return judge_all(programs, [fault for fault in FAULTS if not fault.reason], suites)


@pytest.mark.parametrize("fault", [one for one in FAULTS if not one.reason], ids=lambda one: one.id)
def test_a_program_that_is_wrong_in_one_place_is_rejected(fault: Fault, verdicts: dict[str, Verdict]) -> None:
    verdict = verdicts[fault.id]
    assert (verdict.word, verdict.status, verdict.reason) == ("DIFFERS", 1, "")
    found = verdict.difference
    assert found is not None and found.expected != found.got
    broken = ", ".join(fault.breaks)
    cells = [fault.id, fault.mistake, broken, fault.suite, f"{verdict.scans:,}", found.step]
    assert f"| {' | '.join(cells)} |" in PAGE.read_text(encoding="utf-8").splitlines(), (
        "run examples/faulty/run.py --render"
    )


@pytest.mark.parametrize("fault", [one for one in FAULTS if one.reason], ids=lambda one: one.id)
def test_what_the_pack_says_no_vector_of_it_shows_is_not_shown_by_those_that_show_others(
    fault: Fault, programs: dict[str, Path], suites: dict[str, Suite]
) -> None:
    """By all of `brief` in run.py, which takes too long for each of them here."""
    for name in PARTS:
        assert judge(programs[fault.id], suites[name]).word == "CONFORMS"
    row = f"| {fault.id} | {fault.mistake} | {fault.reason} |"
    assert row in PAGE.read_text(encoding="utf-8").splitlines(), "run examples/faulty/run.py --render"


def test_the_page_lists_the_faults_of_the_pack_and_no_others() -> None:
    rows = re.findall(r"^\| (\S+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(rows) == sorted(["fault", "fault", *(fault.id for fault in FAULTS)])
    assert len([fault for fault in FAULTS if not fault.reason]) >= 40


def test_what_a_fault_breaks_is_declared_in_the_registers() -> None:
    findings = tomllib.loads((SPEC / "findings.toml").read_text(encoding="utf-8"))["finding"]
    clauses = tomllib.loads((SPEC / "clauses.toml").read_text(encoding="utf-8"))["clause"]
    known = {row["id"] for row in [*findings, *clauses]}
    for fault in FAULTS:
        assert set(fault.breaks) <= known, fault.id
        assert any(one.startswith("EKS-") for one in fault.breaks), fault.id


def test_every_decision_that_a_vector_may_depend_on_is_broken_by_a_fault(suites: dict[str, Suite]) -> None:
    depended = {finding for step in suites["brief"].steps for finding in step.findings}
    assert len(depended) > 40
    assert depended - {one for fault in FAULTS if not fault.reason for one in fault.breaks} == set()


def test_every_step_is_where_some_fault_is_seen_or_named_by_its_clauses(suites: dict[str, Suite]) -> None:
    broken = {one for fault in FAULTS if not fault.reason for one in fault.breaks}
    for step in suites["brief"].steps:
        assert broken & {*step.clauses, *step.findings}, step.name


def written(folder: Path, *changes: tuple[str, str]) -> Path:
    text = (HERE / "faults.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "faults.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ('old = "0x3C3C, 0x0F0F}; /* MW03"', 'old = "0x3C3C, 0x0F0F"', "stands 3 times"),
        ('old = "0x3C3C, 0x0F0F}; /* MW03"', 'old = "0x3C3D"', "stands 0 times"),
        ('id = "letter-for-zero"', 'id = "word-mistyped"', "the same id"),
        ('suite = "brief"', 'suite = "breif"', "breif"),
        ('suite = "none"\nreason', 'suite = "brief"\nreason', "reason"),
        ('mistake = "One', 'mistakes = "One', "mistake"),
        ('id = "word-mistyped"', "id = ", "faults.toml"),
    ],
)
def test_a_pack_with_a_mistake_is_not_judged(tmp_path: Path, old: str, new: str, cause: str) -> None:
    assert load_faults(written(tmp_path)) == FAULTS
    with pytest.raises(Unjudged, match=cause):
        load_faults(written(tmp_path, (old, new)))


def test_a_fault_that_does_not_compile_is_not_judged(tmp_path: Path) -> None:
    broken = replace(FAULTS[0], new="0x3C3C, 0x0F0F / * MW03")
    with pytest.raises(Unjudged, match="error"):
        build(tmp_path / "broken", broken)


def test_the_command_tells_expected_from_not_and_from_unjudged(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["word-mistyped"]) == 0
    assert "ok  word-mistyped: DIFFERS" in capsys.readouterr().out
    assert main(["no-such-fault"]) == 2
    assert "no-such-fault" in capsys.readouterr().err

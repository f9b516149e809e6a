"""Programs that are wrong in one place do not conform, and the one without a fault does (test_c_program)."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import pytest

from examples.faulty.run import (
    FPLC,
    HEAD,
    HERE,
    ROOT,
    SUITES,
    Fault,
    Program,
    build,
    build_all,
    judge,
    load_faults,
    main,
    open_all,
    programs,
    row,
)
from modeproof.ground.processes import in_forks
from modeproof.kit.diagnosis import unseen
from modeproof.kit.errors import Unjudged
from modeproof.kit.suite_judge import Verdict
from modeproof.kit.vectors import Suite
from tests.any_machine import PATIENCE_S
from tests.examples.entries import entries, entry
from tests.examples.test_diagnosis import leads_there

FAULTS = load_faults()
PACKS = {program.target: program for program in programs()}
AT_ONCE = 6
"""The kit waits a moment before it believes a difference, so more than one a core."""
EVERY = [(target, fault) for target, program in PACKS.items() for fault in load_faults(program.pack)]
WHOLE = "MODEPROOF_LONG" in os.environ
REJECTED = [one for one in EVERY if not one[1].reason]
AGAIN = [one for at, one in enumerate(REJECTED) if WHOLE or at % 4 == 0]
"""`renew` judges each fault when the cases of its target change; one in four is judged again each time."""


@dataclass(frozen=True)
class Judged:
    """One pack: the built programs, its suites, and what the kit says of those that it must reject."""

    programs: dict[str, Path]
    suites: dict[str, Suite]
    verdicts: dict[str, Verdict]


def several_at_a_time(
    made: Mapping[str, Path], faults: Sequence[Fault], suites: Mapping[str, Suite]
) -> dict[str, Verdict]:
    """As `judge_all`, in processes of their own: threads would wait for one another at each scan."""
    work = partial(of_fault, made, suites)
    found: dict[str, Verdict] = {}
    for outcome in in_forks(work, faults, AT_ONCE, PATIENCE_S):
        if outcome is not None:
            assert outcome.result is not None, outcome.why
            found[faults[outcome.number].id] = outcome.result
    return found


def of_fault(made: Mapping[str, Path], suites: Mapping[str, Suite], fault: Fault) -> Verdict:
    return judge(made[fault.id], suites[fault.suite])


@pytest.fixture(scope="module")
def judged(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Judged]:
    """Every pack by its target; each is built and judged once."""

    @cache
    def of(target: str) -> Judged:
        program = PACKS[target]
        made = build_all(tmp_path_factory.mktemp(target), [f for of, f in AGAIN if of == target], program)
        suites = open_all(program)
        again = [fault for of, fault in AGAIN if of == target]
        return Judged(made, suites, several_at_a_time(made, again, suites))

    return of


@pytest.mark.deep
@pytest.mark.parametrize(("target", "fault"), AGAIN, ids=lambda one: getattr(one, "id", one))
def test_a_program_that_is_wrong_in_one_place_is_rejected(
    target: str, fault: Fault, judged: Callable[[str], Judged]
) -> None:
    verdict = judged(target).verdicts[fault.id]
    assert (verdict.word, verdict.status) == ("DIFFERS", 1)
    found = verdict.difference
    assert found is not None and found.expected != found.got
    assert verdict.reason.startswith(f"case {found.case.id}, scan {found.scan} ({found.step}): ")
    assert entry(HEAD, row(fault, verdict)) in entries(PACKS[target].page), (
        "run examples/faulty/run.py --render"
    )


@pytest.mark.long  # it is about all of them
def test_nine_of_ten_diagnoses_name_what_the_fault_touches(judged: Callable[[str], Judged]) -> None:
    missed, count = [], 0
    for target, fault in AGAIN:
        pack = judged(target)
        suite, found = pack.suites[fault.suite], pack.verdicts[fault.id].difference
        count += 1
        if found is None or not leads_there(suite, fault, found):
            missed.append(f"{fault.id}: {found and (found.step, unseen(suite, found), [*found.expected])}")
    assert count == len(REJECTED) > 200
    assert len(missed) * 10 <= count, "\n".join(missed)


@pytest.mark.parametrize("program", PACKS.values(), ids=PACKS)
def test_the_page_lists_exactly_the_faults_of_the_pack(program: Program) -> None:
    faults = load_faults(program.pack)
    assert sorted(one.split("**")[1] for one in entries(program.page)) == sorted(fault.id for fault in faults)
    assert len([fault for fault in faults if not fault.reason]) >= (40 if program == FPLC else 6)


@pytest.mark.parametrize("program", PACKS.values(), ids=PACKS)
def test_what_a_fault_breaks_is_declared_in_the_registers(program: Program) -> None:
    (spec,) = (
        path.parent
        for path in ROOT.glob("spec/*/interface.toml")
        if program.target in tomllib.loads(path.read_text(encoding="utf-8"))["devices"]
    )
    findings = tomllib.loads((spec / "findings.toml").read_text(encoding="utf-8"))["finding"]
    clauses = set(tomllib.loads((spec / "clauses.toml").read_text(encoding="utf-8"))["clause"])
    for fault in load_faults(program.pack):
        assert set(fault.breaks) <= clauses | set(findings), fault.id
        assert set(fault.breaks) & clauses, fault.id


@pytest.mark.deep
@pytest.mark.parametrize("target", PACKS)
def test_every_decision_behind_a_vector_is_broken_by_a_fault(target: str) -> None:
    depended = {finding for step in open_all(PACKS[target])["brief"].steps for finding in step.findings}
    assert len(depended) > (40 if target == FPLC.target else 2)
    faults = [fault for fault in load_faults(PACKS[target].pack) if target != FPLC.target or not fault.reason]
    assert depended - {one for fault in faults for one in fault.breaks} == set()


@pytest.mark.deep
@pytest.mark.parametrize("target", PACKS)
def test_every_step_has_a_fault_that_breaks_what_it_cites(target: str) -> None:
    broken = {one for fault in load_faults(PACKS[target].pack) if not fault.reason for one in fault.breaks}
    for step in open_all(PACKS[target])["brief"].steps:
        assert broken & {*step.clauses, *step.findings}, step.name


def test_a_suite_is_brief_or_a_part_or_none() -> None:
    assert {fault.suite for _, fault in EVERY} <= set(SUITES)


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
    assert main(["--program", "no-such-program"]) == 2
    assert main(["--renew", "anywhere"]) == 2
    assert "--program" in capsys.readouterr().err

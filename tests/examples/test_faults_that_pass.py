"""Programs with a fault that is said to be invisible conform, and so do those without one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from examples.faulty.run import (
    FPLC,
    HEAD_PASSED,
    WHOLE,
    Fault,
    build_all,
    judge,
    load_faults,
    open_all,
    programs,
)
from modeproof.kit.adapter import Adapter
from modeproof.kit.suite_judge import Options, Plan, run_suite
from modeproof.kit.vectors import Suite
from tests.examples.entries import entries, entry

PACKS = {program.target: program for program in programs()}
PASSED = [(target, fault) for target, one in PACKS.items() for fault in load_faults(one.pack) if fault.reason]
LONG = ("soak", "words")
"""Suites that take half a minute for each program."""


@dataclass(frozen=True)
class Built:
    """The programs of one pack that its vectors cannot reject, and its suites."""

    programs: Mapping[str, Path]
    suites: Mapping[str, Suite]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Built]:
    """Every pack by its target, built once."""

    @cache
    def of(target: str) -> Built:
        faults = [fault for name, fault in PASSED if name == target]
        made = build_all(tmp_path_factory.mktemp(target), faults, PACKS[target])
        return Built(made, open_all(PACKS[target]))

    return of


def conforms(pack: Built, fault: str, names: list[str]) -> bool:
    assert names
    return all(judge(pack.programs[fault], pack.suites[name]).word == "CONFORMS" for name in names)


@pytest.mark.deep
@pytest.mark.parametrize(("target", "fault"), PASSED, ids=lambda one: getattr(one, "id", one))
def test_a_fault_said_to_be_invisible_conforms_to_short_suites(
    target: str, fault: Fault, built: Callable[[str], Built]
) -> None:
    """By all of `brief` in run.py, which takes too long for each of them here."""
    pack = built(target)
    assert conforms(pack, fault.id, [name for name in pack.suites if name not in (WHOLE, *LONG)])
    line = f"| {fault.id} | {fault.mistake} | {fault.reason} |"
    assert entry(HEAD_PASSED, line) in entries(PACKS[target].page), "run examples/faulty/run.py --render"


@pytest.mark.long
@pytest.mark.parametrize(("target", "fault"), PASSED, ids=lambda one: getattr(one, "id", one))
def test_a_fault_said_to_be_invisible_conforms_to_long_suites(
    target: str, fault: Fault, built: Callable[[str], Built]
) -> None:
    pack = built(target)
    assert conforms(pack, fault.id, [name for name in pack.suites if name in LONG])


@pytest.mark.deep
@pytest.mark.parametrize(
    ("target", "fault"),
    [one for one in PASSED if "--codes" in one[1].reason],
    ids=lambda one: getattr(one, "id", one),
)
def test_what_only_our_own_codes_show_is_rejected_with_them(
    target: str, fault: Fault, built: Callable[[str], Built]
) -> None:
    pack = built(target)
    verdict = run_suite(
        pack.suites["brief"], lambda: Adapter([str(pack.programs[fault.id])]), plan=Plan(Options(codes=True))
    )
    assert verdict.word == "DIFFERS" and verdict.difference is not None
    assert verdict.reason.startswith(f"case {verdict.difference.case.id}, scan ")


@pytest.mark.deep
@pytest.mark.parametrize(
    "target",
    [pytest.param(one, marks=[pytest.mark.long] * (one not in (FPLC.target, "sf_edm"))) for one in PACKS],
)
def test_the_program_without_fault_conforms_to_short_suites(
    target: str, built: Callable[[str], Built]
) -> None:
    pack = built(target)
    seen = LONG if target != FPLC.target else (WHOLE, *LONG)  # test_c_program has brief
    assert conforms(pack, "", [name for name in pack.suites if name not in seen])


@pytest.mark.long
@pytest.mark.parametrize("target", PACKS)
def test_the_program_without_fault_conforms_to_long_suites(
    target: str, built: Callable[[str], Built]
) -> None:
    pack = built(target)
    assert conforms(pack, "", [name for name in pack.suites if name in LONG])

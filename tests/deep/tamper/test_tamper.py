"""No slip or cheat is a false green: each is noticed, by the verdict that must follow."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import pytest

from tests.cli.test_sixth_document import empty_root, with_the_sixth
from tests.deep.tamper.records import RECORDS
from tests.deep.tamper.slips import EVERY
from tests.deep.tamper.trees import LEFT_OUT, ROOT, Case, Copy, copy_of, linked

pytestmark = pytest.mark.deep


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Copy]:
    """A copy of the repository."""
    made = Copy(copy_of(ROOT, tmp_path_factory.mktemp("tampered") / "copy"))
    yield made
    made.close()


@pytest.fixture(scope="module")
def sluice(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Copy]:
    """The sixth document alone, verified, with its vectors and its report."""
    root = with_the_sixth(empty_root(tmp_path_factory.mktemp("sluice") / "root"))
    (root / "modeproof").unlink()
    shutil.copytree(ROOT / "modeproof", root / "modeproof", ignore=LEFT_OUT, copy_function=linked)
    (root / "vectors").mkdir(exist_ok=True)
    made = Copy(root)
    for command in ("verify --quiet", *BRIEF, "report"):
        status, said = made.judged(command)
        assert status == (2 if command == "report" else 0), said  # it has no pages on limits and words
    made.keep()
    yield made
    made.close()


BRIEF = [f"vectors build {target} --suite brief" for target in ("gate", "beacon")]


def judge(copy: Copy, case: Case) -> None:
    with copy.changed(case):
        status, said = copy.judged(case.command)
    copy.as_kept()
    assert status == case.status, said
    assert case.says in said, said


FIRST = {case.command: case for case in reversed(EVERY)}
"""Of each command the first slip that it notices."""


def test_every_case_has_a_name_of_its_own() -> None:
    every = (*EVERY, *RECORDS)
    assert len({case.name for case in every}) == len(every) >= 76


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case, marks=[pytest.mark.long] * (place % 3 > 0 and case is not FIRST[case.command]), id=case.name
        )
        for place, case in enumerate(EVERY)
    ],
)
def test_no_slip_is_a_false_green(repository: Copy, case: Case) -> None:
    judge(repository, case)


@pytest.mark.parametrize("command", sorted({case.command for case in EVERY}))
def test_without_a_slip_the_same_command_passes(repository: Copy, command: str) -> None:
    assert repository.judged(command)[0] == 0


@pytest.mark.parametrize("case", RECORDS, ids=[case.name for case in RECORDS])
def test_no_edited_record_is_a_false_green(sluice: Copy, case: Case) -> None:
    judge(sluice, case)


@pytest.mark.parametrize(
    "command", ["report --verify", "conform gate --builtin refimpl --quiet", "vectors lint"]
)
def test_without_an_edit_the_records_are_as_they_were(sluice: Copy, command: str) -> None:
    assert sluice.judged(command)[0] == 0

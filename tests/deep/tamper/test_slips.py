"""No slip or cheat of an author is a false green: each is noticed, by the verdict that must follow."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.deep.tamper.slips import EVERY
from tests.deep.tamper.trees import ROOT, Case, Copy, copy_of

pytestmark = pytest.mark.deep


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Copy]:
    """A copy of the repository."""
    made = Copy(copy_of(ROOT, tmp_path_factory.mktemp("tampered") / "copy"))
    yield made
    made.close()


def cases() -> list[object]:
    """Every case; what another piece of work is to mend may still be a false green."""
    marks = {case.name: pytest.mark.xfail(reason=case.pending) for case in EVERY if case.pending}
    return [pytest.param(case, id=case.name, marks=marks.get(case.name, ())) for case in EVERY]


def test_every_case_has_a_name_of_its_own() -> None:
    assert len({case.name for case in EVERY}) == len(EVERY) >= 60


@pytest.mark.parametrize("case", cases())
def test_no_slip_is_a_false_green(copy: Copy, case: Case) -> None:
    with copy.changed(case):
        status, said = copy.judged(case.command)
    assert status == case.status, said
    assert case.says in said, said


@pytest.mark.parametrize("command", sorted({case.command for case in EVERY}))
def test_without_a_slip_the_same_command_passes(copy: Copy, command: str) -> None:
    assert copy.judged(command)[0] == 0

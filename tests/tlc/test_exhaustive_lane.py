"""The rows of the exhaustive lane of the four blocks are as pinned, and a wrong pin is noticed there."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from modeproof.ground.places import root
from modeproof.ground.progress import Progress
from modeproof.tlc.check import check_all, select
from modeproof.tlc.toolchain import find_toolchain

pytestmark = pytest.mark.deep
BLOCKS = ("edm", "enable_switch", "guard_locking", "testable_safety_sensor")
"""The first takes ten seconds of CPU, the others one to four minutes each."""
ROWS = {name: [run.id for run in select(root(), lane="exhaustive", document=name)] for name in BLOCKS}


def judged(place: Path, document: str, names: list[str]) -> dict[str, tuple[bool, str]]:
    """Whether each of these runs is as expected, and why not."""
    runs = select(place, [f"{document}/{name}" for name in names], "exhaustive", document)
    found = check_all(place, runs, find_toolchain(), Progress(quiet=True))
    return {one.run.id: (one.judgement.as_expected, one.judgement.reason) for one in found}


@pytest.fixture
def place(tmp_path: Path) -> Path:
    shutil.copytree(root() / "spec", tmp_path / "spec")
    return tmp_path


@pytest.mark.parametrize(
    "document", [pytest.param(name, marks=[pytest.mark.long] * (name != "edm")) for name in BLOCKS]
)
def test_every_row_of_a_block_is_as_pinned(place: Path, document: str) -> None:
    found = judged(place, document, ROWS[document])
    assert len(found) == len(ROWS[document]) >= 6
    assert [f"{id}: {why}" for id, (fits, why) in found.items() if not fits] == []


def test_a_wrong_count_is_noticed(place: Path) -> None:
    path, pin = place / "spec/edm/runs.toml", "counts = [68, 13057]"
    text = path.read_text()
    assert text.count(pin) == 1
    path.write_text(text.replace(pin, "counts = [67, 13057]"))
    (found,) = judged(place, "edm", ["MC_SF_EDM_request_waits"]).items()
    assert found[1][0] is False and "67" in found[1][1]

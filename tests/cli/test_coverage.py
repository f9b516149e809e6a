"""modeproof prove --coverage: 0 if all that no path passes is explained, 1 if not, 2 without judgement."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.lane.coverage import cover_document
from modeproof.report.verdicts import status_of
from proofs.mode_selection import devices

REGISTER = Path("proofs/mode_selection/strength.toml")
ROOT = Path(__file__).parents[2]


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(devices, "DEVICES", (devices.PLC,))
    (tmp_path / REGISTER).parent.mkdir(parents=True)
    (tmp_path / REGISTER).write_text((ROOT / REGISTER).read_text(encoding="utf-8"), encoding="utf-8")
    return tmp_path


def _status(place: Path) -> int:
    return status_of(cover_document(place, "mode_selection", Progress(quiet=True)))


def test_all_that_is_not_passed_is_explained(place: Path) -> None:
    assert _status(place) == 0


def test_what_is_not_explained_is_not_as_expected(place: Path) -> None:
    text = (place / REGISTER).read_text(encoding="utf-8")
    (place / REGISTER).write_text(text.replace("elif state.turn == Step.COPY_MW07", "elif other"))
    record = cover_document(place, "mode_selection", Progress(quiet=True))
    assert status_of(record) == 1
    assert [problem.split(": ", 1)[1] for problem in record["result"]["problems"]] == [
        "on no feasible path, and not explained: branch step: elif state.turn == Step.COPY_MW07: no",
        "strength.toml explains what is passed or not there: branch step: elif other: no",
    ]


def test_without_a_register_nothing_is_judged(place: Path) -> None:
    (place / REGISTER).unlink()
    with pytest.raises(Unjudged, match=r"strength\.toml cannot be read"):
        _status(place)


def test_coverage_speaks_of_no_single_theorem(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "some_theorem", "--coverage"]) == 2
    assert "give it no" in capsys.readouterr().err

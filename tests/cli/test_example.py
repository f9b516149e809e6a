"""`modeproof example` copies files to begin with, all or none, and overwrites nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.places import TREE


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_list_names_files_that_can_be_copied(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["example"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert {"cell.st", "cell.toml", "fplc_good.csv", "wiring.toml", "safety.toml"} <= {
        name for name, _ in rows
    }
    assert main(["example", *(name for name, _ in rows)]) == 0
    for name, path in rows:
        assert (folder / name).read_bytes() == (TREE / path).read_bytes()


def test_nothing_is_overwritten_and_none_is_copied_alone(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "cell.st").write_text("mine")
    assert main(["example", "cell.toml", "cell.st"]) == 2
    assert capsys.readouterr().err == "modeproof: cell.st is here already; it was left alone\n"
    assert (folder / "cell.st").read_text() == "mine" and not (folder / "cell.toml").exists()


def test_an_unknown_name_gets_what_was_meant(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["example", "cel.st"]) == 2
    assert "no example 'cel.st'; did you mean 'cell.st'? " in capsys.readouterr().err

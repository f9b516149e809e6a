"""Where things lie: the tree of the tool, the user's project, and the folder for what is made."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground import places
from modeproof.ground.places import TREE, build, located, project, root, within


@pytest.fixture(autouse=True)
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("MODEPROOF_ROOT", "MODEPROOF_STATE"):
        monkeypatch.delenv(name, raising=False)


def test_what_is_made_lies_in_the_users_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    deep = tmp_path / "plc" / "spec" / "foo"
    deep.mkdir(parents=True)
    (deep / "interface.toml").write_text("")
    monkeypatch.chdir(deep)
    assert root() == TREE and project() == deep and build(root()) == deep / ".modeproof"
    (tmp_path / "modeproof.toml").write_text("version = 1\n")
    assert root() == TREE and project() == tmp_path and build(root()) == tmp_path / ".modeproof"


def test_in_the_checkout_it_lies_in_build(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(TREE / "docs")
    assert build(root()) == TREE / "build"


def test_nothing_is_ever_written_into_an_installed_tool(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "INSTALLED", True)
    monkeypatch.chdir(TREE)
    assert build(TREE) == TREE / ".modeproof"  # as of any project: nobody stands in an installed one


def test_a_place_that_was_named_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_STATE", str(tmp_path / "kept"))
    assert build(TREE) == tmp_path / "kept"


def test_what_was_made_has_one_name_wherever_it_lies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    made = build(TREE) / "evidence" / "edm" / "x.json"
    assert within(TREE, made) == "build/evidence/edm/x.json"
    assert located(TREE, "build/evidence/edm/x.json") == made
    assert located(TREE, "spec/edm/EDM.tla") == TREE / "spec/edm/EDM.tla"
    with pytest.raises(ValueError):
        within(TREE, tmp_path / "other.txt")

"""What a test lets the command write below build/ stays out of this tree: the report would show it."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def a_build_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("programs.commands.results", "programs.commands.prove_program"):
        monkeypatch.setattr(f"{module}.build", lambda place: tmp_path / "build")

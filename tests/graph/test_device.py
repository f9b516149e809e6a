"""The evidence of a comparison names every file that it rests on."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from modeproof.graph.device import compared_files, graph_file


def test_only_existing_files_of_a_comparison_are_listed(tmp_path: Path) -> None:
    run: Any = SimpleNamespace(document="toy", id="OPEN_Lamp")
    wanted = [
        tmp_path / "code" / "errors.py",
        tmp_path / "code" / "toy" / "lamp.py",
        *(tmp_path / "spec" / "toy" / f"{name}.toml" for name in ("interface", "classes", "runs")),
        graph_file(tmp_path, run),
    ]
    for path in wanted:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    assert compared_files(tmp_path, run, "code") == wanted
    wanted[3].unlink()
    assert compared_files(tmp_path, run, "code") == [path for path in wanted if path != wanted[3]]

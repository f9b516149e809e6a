"""What is in the page: whole, small, with the code that is shipped, and with nothing to load."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.load import load_document
from modeproof.report.story import digest_of
from modeproof.simulate import build, bundle, facts
from tests.simulate.conftest import ROOT, SCENE


def carried(html: str) -> dict[str, Any]:
    found = re.search(r"update_VFS\((\{.*?\})\);</script>", html, re.DOTALL)
    assert found
    modules: dict[str, Any] = json.loads(found.group(1))
    return modules


def test_the_page_is_small_and_names_nothing_to_load(page_file: Path) -> None:
    html = page_file.read_text(encoding="utf-8")
    own = html[: html.index("<script type=")]
    assert 1_000_000 < len(html.encode()) <= build.LARGEST
    assert "default-src 'none'" in own
    assert not re.findall(r"""(?:src|href)\s*=\s*["'](?!data:|#)[^"']*""", own)
    assert "@import" not in own and "url(" not in own


def test_the_page_carries_the_shipped_code_unchanged(page_file: Path) -> None:
    modules = carried(page_file.read_text(encoding="utf-8"))
    files = sorted((ROOT / "refimpl").rglob("*.py"))
    assert files
    for path in files:
        name = path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".").removesuffix(".__init__")
        assert modules[name][1] == path.read_text(encoding="utf-8"), name


def test_a_page_that_is_too_large_is_not_made() -> None:
    assert build.small_enough("x" * build.LARGEST)
    with pytest.raises(Unjudged, match="4,000,001 bytes, more than 4,000,000: not written"):
        build.small_enough("x" * (build.LARGEST - 1) + "é")


def test_without_brython_no_page_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(name: str) -> Any:
        raise ModuleNotFoundError(name)

    monkeypatch.setattr("importlib.resources.files", gone)
    with pytest.raises(Unjudged, match="Brython cannot be read: brython; run make venv"):
        bundle.brython()


def test_a_step_without_a_mark_is_refused(tmp_path: Path) -> None:
    for folder in ("spec", "refimpl", "proofs"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    code = tmp_path / "refimpl/edm/sf_edm.py"
    code.write_text(code.read_text(encoding="utf-8").replace("# Initialize", "# Begin"), encoding="utf-8")
    with pytest.raises(Unjudged, match=r"sf_edm\.py: no line is marked with the step Initialize"):
        facts.of_document(load_document(tmp_path, "edm"))


def test_no_text_can_end_its_script() -> None:
    assert "</script" not in build._json({"x": "</script><!-- <script>"})
    assert json.loads(build._json({"x": "</script>"})) == {"x": "</script>"}


def test_a_walk_of_another_trace_is_not_shown(tmp_path: Path, recorded_place: Path) -> None:
    document = load_document(recorded_place, SCENE)
    shown = facts.of_document(document)["recorded"]
    assert [(run["run"], len(run["rows"])) for run in shown] == [("NEG_Fplc_figure7", 2)]
    assert shown[0]["findings"][0][0] == "E-01"
    walk = recorded_place / "build/walks" / SCENE / "NEG_Fplc_figure7.json"
    found = json.loads(walk.read_text())
    walk.write_text(json.dumps({**found, "trace_sha256": digest_of([])}))
    assert facts.of_document(document)["recorded"] == []

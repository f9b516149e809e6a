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
from modeproof.simulate import build, bundle, facts, recorded
from modeproof.simulate.program.play import of_recorded
from tests.simulate.conftest import ROOT, RUN, SCENE, WIRES


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
    with pytest.raises(Unjudged, match="Brython cannot be read: brython; run `make venv`"):
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


def rows(shown: list[dict[str, Any]]) -> int:
    """How many rows the run of the fixture has."""
    return len(json.loads(next(run["rows"] for run in shown if run["run"] == RUN)))


def test_a_walk_of_another_trace_is_not_shown(tmp_path: Path, recorded_place: Path) -> None:
    document = load_document(recorded_place, SCENE)
    shown = facts.of_document(document)["recorded"]
    assert rows(shown) == 2
    walk = recorded_place / "build/walks" / SCENE / "NEG_Fplc_figure7.json"
    found = json.loads(walk.read_text())
    walk.write_text(json.dumps({**found, "trace_sha256": digest_of([])}))
    assert rows(facts.of_document(document)["recorded"]) == 14, "the one that is kept is shown"


def test_recording_keeps_what_the_evidence_holds(recorded_place: Path) -> None:
    document = load_document(recorded_place, SCENE)
    (recorded_place / "scenes" / SCENE / "recorded.jsonl").unlink()
    held, changed, missing = recorded.record(document)
    assert (held, changed) == (1, [])
    assert RUN not in missing and len(missing) > 80
    shutil.rmtree(recorded_place / "build")
    (shown,) = recorded.shown(document)
    first, second = json.loads(shown["rows"])
    assert first["wires"] == WIRES
    assert second["wires"] == {"MSO_3": True, "MW01": 0, "MW05": 0}
    assert second["states"] == {"fplc": "Settle"}


def test_a_record_of_another_specification_is_told(recorded_place: Path) -> None:
    shutil.rmtree(recorded_place / "build")
    document = load_document(recorded_place, SCENE)
    assert all(run["fresh"] for run in recorded.shown(document))
    module = recorded_place / "spec" / SCENE / "FplcOpen.tla"
    text = module.read_text(encoding="utf-8")
    module.write_text(text.replace("\nEXTENDS", "\n\\* a comment\nEXTENDS"), encoding="utf-8")
    assert all(run["fresh"] for run in recorded.shown(document))
    module.write_text(text.replace("\nOpenInit ==", "\nMore == TRUE\nOpenInit =="), encoding="utf-8")
    assert recorded.unrecorded(document)
    fresh = {run["run"]: run["fresh"] for run in recorded.shown(document)}
    assert not fresh[RUN] and fresh["NEG_Hmi_acknowledges_own_selection"]
    player = of_recorded(
        {"run": RUN, "fresh": False, "loop": "", "property": "P", "says": ""}, [], FOUND, print
    )
    assert "The specification has changed since." in player.intro


FOUND = {"id": "E-01", "title": "title", "story": "story"}


def test_an_edit_that_fits_nowhere_makes_no_page(recorded_place: Path) -> None:
    readings = recorded_place / "scenes" / SCENE / "stories.toml"
    text = readings.read_text(encoding="utf-8")
    for old, new, said in (
        ("mode=s.selection)", "mode=nothing)", "does not hold just once"),
        ('id = "Figure7"', 'id = "Figure8"', "no finding tries this reading"),
    ):
        assert old in text
        readings.write_text(text.replace(old, new), encoding="utf-8")
        with pytest.raises(Unjudged, match=said):
            facts.of_document(load_document(recorded_place, SCENE))


def test_a_record_that_cannot_be_read_is_refused(recorded_place: Path) -> None:
    (recorded_place / "scenes" / SCENE / "recorded.jsonl").write_text('{"run": "x"}\n')
    with pytest.raises(Unjudged, match=r"recorded\.jsonl: cannot be read: .*modeproof renew writes it"):
        recorded.shown(load_document(recorded_place, SCENE))

"""A play as test vectors: in order for the linter, with the id of the kit, and judged by `conform`."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.simulate.program.block import Block
from modeproof.simulate.program.play import log_of_case
from modeproof.simulate.program.vectors import hashed, written
from modeproof.suites.lint import lint
from scenes.mode_selection.scene import Scene, header_of
from tests.simulate.conftest import SCENE
from tests.simulate.test_program import CHANGE


def file_of(scene: Any, id: str, path: Path) -> str:
    """The file as the page saves it."""
    header, case = scene.vectors(id)
    text = written(header, case, hashlib.sha256(hashed(case).encode()).hexdigest())
    path.write_text(text, encoding="utf-8")
    return text


@pytest.mark.parametrize("profile", ["letter", "cautious"])
def test_a_played_change_conforms_as_test_vectors(
    profile: str, tmp_path: Path, known: dict[str, Any]
) -> None:
    path, chosen = tmp_path / "played.jsonl", known[SCENE]["devices"]["fplc"]["profiles"][profile]
    scene = Scene(known[SCENE], {"fplc": chosen})
    for action in CHANGE:
        scene.do(action)
    for id in ("plc", "hmi", "fplc"):
        file_of(scene, id, path)
        assert lint(path) == [], id
    command = ["conform", "fplc", "--builtin", "refimpl", "--vectors", str(path), "--quiet", "--same"]
    records = ["--record", str(tmp_path / "record.json")]
    assert main([*command, "--profile", profile, *records]) == 0
    text = path.read_text(encoding="utf-8")
    assert text.count('"MSO_1":true') == 1
    path.write_text(text.replace('"MSO_1":true', '"MSO_2":true'), encoding="utf-8")
    assert main([*command, "--profile", profile, *records]) == 1


def test_a_play_of_a_block_is_a_case(tmp_path: Path, known: dict[str, Any]) -> None:
    block = Block("sf_edm", known["edm"], {"MonitoringTime_ms": 40})
    with pytest.raises(ValueError, match="sf_edm has not been called yet"):
        block.vectors("sf_edm")
    for action in ("set Activate 1", "call 20", "set S_EDM1 1", "call 20 3"):
        block.do(action)
    path = tmp_path / "played.jsonl"
    header, case = (json.loads(line) for line in file_of(block, "sf_edm", path).splitlines())
    assert lint(path) == [] and case["params"] == {"MonitoringTime_ms": 40}
    assert header["scans"] == 4 and list(case["scans"][1]["in"]) == ["S_EDM1"]
    path.write_text(path.read_text().replace('"S_EDM1":true', '"S_EDM2":true'), encoding="utf-8")
    assert "does not belong to these inputs" in lint(path)[0]


def test_a_case_is_played_as_a_log(known: dict[str, Any]) -> None:
    scene, again = Scene(known[SCENE], {}), Scene(known[SCENE], {})
    for action in CHANGE:
        scene.do(action)
    header, case = scene.vectors("fplc")
    _, *rows = log_of_case(header, case, "fplc")
    for text, differs in (("", ""), ("MSO_4", "MSO_4 is False, the log has True")):
        again.begin_log(header_of(case["params"]))
        for row in rows:
            again.play({**row, "out": {**row["out"], **({text: True} if text else {})}})
        assert (again.show()["on"]["MSO_1"], len(again.lines)) == (True, len(rows))
        assert differs in again.differs and bool(again.differs) == bool(differs)
    with pytest.raises(ValueError, match="asks for a refusal"):
        log_of_case(header, {**case, "scans": [{"refuse": "no"}]})

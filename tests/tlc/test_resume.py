"""An interrupted lane goes on with what has no fitting evidence; whatever has changed is run again."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.ground.progress import Progress
from modeproof.tlc.check import check_all, kept, select
from modeproof.tlc.resume import why_stale
from modeproof.tlc.schedule import ORDINARY_MB, memory_mb
from modeproof.tlc.toolchain import Toolchain, find_toolchain
from tests.any_machine import until
from tests.toy_tree import toy_tree

NAMES = ("MC_toy", "NEG_small", "OPEN_toy")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = toy_tree(tmp_path_factory.mktemp("made"), *NAMES)
    check_all(made, select(made), find_toolchain(), Progress(quiet=True))
    return made


@pytest.fixture
def root(made: Path, tmp_path: Path) -> Path:
    return shutil.copytree(made, tmp_path / "root")


def reasons(root: Path, tools: Toolchain | None = None) -> dict[str, str]:
    return {run.id: why_stale(root, run, tools or find_toolchain()) for run in select(root)}


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_what_is_as_expected_and_unchanged_is_kept(root: Path) -> None:
    assert reasons(root) == dict.fromkeys(NAMES, "")
    for run in select(root):
        one = kept(root, run)
        assert one.kept and one.status == 0 and one.record["id"] == run.id


def change_model(root: Path) -> None:
    edit(root / "spec/toy/Toy.tla", "Small == count < 3", "Small == count < 2 + 1")


def change_cfg(root: Path) -> None:
    edit(root / "spec/toy/models/MC_toy.cfg", "N = 4", "N = 4 ")


def change_pin(root: Path) -> None:
    edit(root / "spec/toy/runs.toml", "distinct = 16", "distinct = 17")


def change_graph(root: Path) -> None:
    edit(root / "build/graphs/toy/OPEN_toy.txt", "Up", "Down")


def lose_graph(root: Path) -> None:
    (root / "build/graphs/toy/OPEN_toy.txt").unlink()


def damage_evidence(root: Path) -> None:
    path = evidence.evidence_path(root, "toy", "MC_toy")
    path.write_text(path.read_text()[:-40])


def spoil_evidence(root: Path) -> None:
    path = evidence.evidence_path(root, "toy", "MC_toy")
    record = json.loads(path.read_text())
    path.write_text(json.dumps(record | {"as_expected": False, "reason": "planted"}))


@pytest.mark.parametrize(
    ("change", "again"),
    [
        (change_model, dict.fromkeys(NAMES, "spec/toy/Toy.tla has changed")),
        (change_cfg, {"MC_toy": "spec/toy/models/MC_toy.cfg has changed"}),
        (change_pin, {"MC_toy": "its declaration has changed"}),
        (change_graph, {"OPEN_toy": "build/graphs/toy/OPEN_toy.txt has changed"}),
        (lose_graph, {"OPEN_toy": "build/graphs/toy/OPEN_toy.txt has changed"}),
        (damage_evidence, {"MC_toy": "its evidence cannot be read"}),
        (spoil_evidence, {"MC_toy": "its evidence says HOLDS, not as expected"}),
    ],
)
def test_what_has_changed_is_run_again_and_nothing_else(
    root: Path, change: Callable[[Path], None], again: dict[str, str]
) -> None:
    change(root)
    assert reasons(root) == dict.fromkeys(NAMES, "") | again


def test_other_tools_make_every_run_again(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tools = find_toolchain()
    assert set(reasons(root, replace(tools, jar_sha256="0" * 64)).values()) == {"tlc has changed"}
    assert set(reasons(root, replace(tools, java_version="another")).values()) == {"java has changed"}
    other = {"modeproof": {"version": "0", "sha256": "0" * 64}}
    monkeypatch.setattr(evidence, "own_tools", lambda: other)
    assert set(reasons(root).values()) == {"modeproof has changed"}


@pytest.mark.deep
def test_a_lane_that_was_killed_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    root = toy_tree(tmp_path, "MC_toy", "MC_big")
    monkeypatch.setenv("MODEPROOF_ROOT", str(root))
    command = [sys.executable, "-m", "modeproof", "check", "--quiet"]
    log = tmp_path / "out"
    with log.open("wb") as out:
        running = subprocess.Popen(command, env=os.environ.copy(), stdout=out, stderr=out)
    until(evidence.evidence_path(root, "toy", "MC_toy").is_file, "evidence of the first run")
    running.kill()
    running.wait()
    path = root / "spec/toy/models/MC_big.cfg"
    small = path.read_text().replace("N = 900000", "N = 4")
    path.write_text(small)  # so that it ends at all; not as it was pinned
    assert main(["check", "--quiet", "--resume"]) == 1
    said = capsys.readouterr().out
    assert "ok  toy/MC_toy: HOLDS; kept, of " in said
    assert "again toy/MC_big: no evidence" in said and "NOT toy/MC_big: HOLDS; 16 distinct" in said
    assert "1 of 2 runs as expected" in said


def test_a_resumed_repin_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MODEPROOF_ROOT", str(toy_tree(tmp_path, "MC_toy")))
    monkeypatch.delenv("CI", raising=False)
    assert main(["check", "MC_toy", "--resume", "--repin", "--reason", "x"]) == 2
    assert "give one of them" in capsys.readouterr().err


def test_the_exhaustive_lane_may_use_the_memory_that_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MODEPROOF_HEAP_MB", raising=False)
    monkeypatch.setattr("modeproof.tlc.schedule.machine_mb", lambda: 24 * 1024)
    assert (memory_mb(), memory_mb(exhaustive=True)) == (ORDINARY_MB, 23 * 1024)
    monkeypatch.setattr("modeproof.tlc.schedule.machine_mb", lambda: 4096)
    assert (memory_mb(), memory_mb(exhaustive=True)) == (3072, 3072)
    monkeypatch.setenv("MODEPROOF_HEAP_MB", "700")
    assert memory_mb(exhaustive=True) == 700


def test_a_heap_beyond_the_machines_memory_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = toy_tree(tmp_path, "MC_toy", heap_mb=8192)
    monkeypatch.setattr("modeproof.tlc.check.machine_mb", lambda: 4096)
    (one,) = check_all(root, select(root), find_toolchain(), Progress(quiet=True))
    assert one.judgement.verdict == "UNJUDGED"
    assert one.judgement.reason == "toy/MC_toy: heap_mb = 8192, but this machine has 4096 MiB of memory"

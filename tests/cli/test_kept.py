"""verify keeps a result as long as nothing that it rests on has changed, and judges the others again."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.evidence import Rests, record, why_again
from modeproof.ground.places import TREE
from modeproof.ground.progress import Progress
from modeproof.lane import verify
from modeproof.lane.keep import KEPT, Keep, kept_line
from modeproof.tlc import rests
from modeproof.tlc.check import check_all, select
from modeproof.tlc.toolchain import find_toolchain
from tests.any_machine import until
from tests.toy_tree import toy_tree

NAMES = ("MC_toy", "NEG_small", "OPEN_toy")
CHANGED = "has changed"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The toy document, judged, and the code of the tool beside it."""
    made = toy_tree(tmp_path_factory.mktemp("made"), *NAMES)
    shutil.copytree(TREE / "modeproof", made / "modeproof", ignore=shutil.ignore_patterns("__pycache__"))
    check_all(made, select(made), find_toolchain(), Progress(quiet=True))
    return made


@pytest.fixture
def root(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    def judged_again(*_: Any, **__: Any) -> Any:
        raise AssertionError("TLC was started")

    monkeypatch.setattr(verify, "check_all", lambda place, runs, *_: [] if not runs else judged_again())
    yield shutil.copytree(made, tmp_path / "root")
    record.own_tools.cache_clear()


class Said(Progress):
    def __init__(self) -> None:
        super().__init__(quiet=True)
        self.lines: list[str] = []

    def say(self, line: str) -> None:
        self.lines.append(line)


def again(root: Path, monkeypatch: pytest.MonkeyPatch, anew: bool = False) -> dict[str, str]:
    """The runs that the lane judges again, and the line that says why."""
    runs: list[str] = []
    monkeypatch.setattr(verify, "check_all", lambda place, found, *_: runs.extend(r.id for r in found) or [])
    said = Said()
    kept, _ = verify.check_lane(root, ["toy"], "full", said, Keep(anew))
    assert {one["id"] for one in kept} == {*NAMES} - {*runs} and all(one[KEPT] for one in kept)
    why = " ".join(said.lines)
    assert bool(why) == bool(runs) or anew
    return dict.fromkeys(runs, why)


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def tamper(root: Path, name: str, seal: bool, change: Callable[[dict[str, Any]], Any]) -> None:
    """Edit a piece of evidence, and its seal too, as somebody would who knows of it."""
    path = evidence.evidence_path(root, "toy", name)
    one = json.loads(path.read_text())
    change(one)
    path.write_text(json.dumps(one | ({"seal": record.seal_of(one)} if seal else {})))


def test_what_is_the_same_is_kept_and_anew_repeats_all(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert again(root, monkeypatch) == {}
    assert {*again(root, monkeypatch, anew=True)} == {*NAMES}


SAME = {
    "a comment of a module": ("spec/toy/Toy.tla", "Small ==", "\\* not so many\nSmall =="),
    "a comment of the register": ("spec/toy/runs.toml", "# runs", "# some runs"),
    "a docstring of the judge": ("modeproof/tlc/run_judge.py", '"""', '"""Words. '),
    "a comment of the judge": ("modeproof/tlc/run_judge.py", "def judge(", "# words\ndef judge("),
    "a module that does not judge": ("modeproof/report/build.py", "import base64", "import base64, sys"),
    "the page to play with": ("modeproof/simulate/build.py", "import", "import sys\nimport"),
}
CHANGES: dict[str, tuple[str, str, str, tuple[str, ...], str]] = {
    "a module": ("spec/toy/Toy.tla", "count < 3", "count < 2 + 1", NAMES, f"spec/toy/Toy.tla {CHANGED}"),
    "a cfg": ("spec/toy/models/MC_toy.cfg", "N = 4", "N = 5", ("MC_toy",), f"MC_toy.cfg {CHANGED}"),
    "a row": ("spec/toy/runs.toml", "distinct = 16", "distinct = 17", ("MC_toy",), f"declaration {CHANGED}"),
    "a graph": ("build/graphs/toy/OPEN_toy.txt", "Up", "Down", ("OPEN_toy",), "is not what it made"),
    "the judge": ("modeproof/tlc/run_judge.py", "import", "import sys\nimport", NAMES, "code that judges it"),
    "what reads a run": ("modeproof/registers/runs.py", "import", "import sys\nimport", NAMES, "code"),
    "what says unjudged": ("modeproof/ground/errors.py", "import", "import sys\nimport", NAMES, "code"),
}


@pytest.mark.parametrize("file, old, new", SAME.values(), ids=SAME)
def test_what_is_no_change_runs_nothing(
    root: Path, monkeypatch: pytest.MonkeyPatch, file: str, old: str, new: str
) -> None:
    edit(root / file, old, new)
    assert again(root, monkeypatch) == {}


@pytest.mark.parametrize("file, old, new, runs, why", CHANGES.values(), ids=CHANGES)
def test_a_change_runs_what_rests_on_it(
    root: Path, monkeypatch: pytest.MonkeyPatch, file: str, old: str, new: str, runs: Any, why: str
) -> None:
    if file.endswith(".py"):
        old, new = "from __future__ import annotations\n", "from __future__ import annotations\nimport sys\n"
    edit(root / file, old, new)
    found = again(root, monkeypatch)
    assert {*found} == {*runs} and all(why in line for line in found.values())


@pytest.mark.parametrize("lost", ["code", "modules", "row"])
def test_a_dependency_that_is_left_out_goes_unseen(
    root: Path, monkeypatch: pytest.MonkeyPatch, lost: str
) -> None:
    """So the tests above would fail."""
    if lost == "code":
        monkeypatch.setattr(rests, "CODE", ("modeproof.tlc.toolchain",))
        for name in NAMES:
            tamper(root, name, True, lambda one: one.update(code=list(rests.CODE)))
        tools = record.own_tools(root, *rests.CODE)
        for name in NAMES:
            tamper(root, name, True, lambda one: one["tools"].update(tools))
        record.own_tools.cache_clear()
        edit(root / "modeproof/tlc/run_judge.py", "from __future__", "import sys\nfrom __future__")
    if lost == "modules":
        monkeypatch.setattr(rests, "reached", lambda *_: ())
        for name in NAMES:
            tamper(root, name, True, lambda one: one["inputs"].pop("spec/toy/Toy.tla"))
        edit(root / "spec/toy/Toy.tla", "count < 3", "count < 2 + 1")
    if lost == "row":
        monkeypatch.setattr(rests, "row_of", lambda run: {})
        monkeypatch.setattr(verify, "doubt", lambda place, run, one: "")
        edit(root / "spec/toy/runs.toml", "distinct = 16", "distinct = 17")
    assert again(root, monkeypatch) == {}


@pytest.mark.parametrize("tool", ["jar_sha256", "java_version"])
def test_another_tool_runs_all_again(root: Path, monkeypatch: pytest.MonkeyPatch, tool: str) -> None:
    other = replace(find_toolchain(), **{tool: "0" * 64})
    monkeypatch.setattr(verify, "find_toolchain", lambda: other)
    found = again(root, monkeypatch)
    assert {*found} == {*NAMES} and "is another" in found["MC_toy"]


def test_another_python_runs_all_again(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("platform.python_version", lambda: "3.99.0")
    record.own_tools.cache_clear()
    found = again(root, monkeypatch)
    assert {*found} == {*NAMES} and "python is another" in found["MC_toy"]


CHEATS: dict[str, tuple[str, Callable[[dict[str, Any]], Any]]] = {
    "the verdict": ("NEG_small", lambda one: one.update(verdict="HOLDS")),
    "the counts": ("MC_toy", lambda one: one["result"].update(distinct=15)),
    "the bounds": ("MC_toy", lambda one: one.update(strength="a counter up to 400")),
    "the trace": ("NEG_small", lambda one: one["result"]["trace"].pop()),
    "what is printed": ("OPEN_toy", lambda one: one["result"]["printed"].update(EDGE=17)),
    "the exit status": ("MC_toy", lambda one: one["result"].update(exit_status=1)),
    "a failure that says as expected": ("MC_toy", lambda one: one.update(as_expected=False, reason="x")),
}


@pytest.mark.parametrize("seal", [False, True], ids=["without its seal", "with its seal"])
@pytest.mark.parametrize("name, change", CHEATS.values(), ids=CHEATS)
def test_evidence_that_was_touched_is_judged_again(
    root: Path, monkeypatch: pytest.MonkeyPatch, name: str, change: Any, seal: bool
) -> None:
    tamper(root, name, seal, change)
    assert {*again(root, monkeypatch)} == {name}


def test_evidence_that_is_damaged_or_lost_is_judged_again(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = evidence.evidence_path(root, "toy", "MC_toy")
    path.write_text(path.read_text()[:-40])
    assert again(root, monkeypatch) == {"MC_toy": "again toy/MC_toy: its evidence cannot be read"}
    (root / "build/graphs/toy/OPEN_toy.txt").unlink()
    assert {*again(root, monkeypatch)} == {"MC_toy", "OPEN_toy"}


def test_a_query_that_was_edited_is_asked_again(tmp_path: Path) -> None:
    query = tmp_path / "build/proofs/toy/a/001-a.smt2"
    query.parent.mkdir(parents=True)
    query.write_text("(check-sat)")
    found = {"smt2": query.relative_to(tmp_path).as_posix(), "smt2_sha256": evidence.sha256(query)}
    solvers = evidence.solvers()
    made = evidence.make(
        kind="proof",
        id="a",
        document="toy",
        verdict="PROVED",
        expected="PROVED",
        as_expected=True,
        command="modeproof prove",
        started=0.0,
        seconds=1.0,
        tools=solvers,
        result={"queries": [found]},
    )
    one = evidence.read(evidence.write(tmp_path, made))
    now = Rests({}, (), solvers)
    assert why_again(tmp_path, one, now) == ""
    assert why_again(tmp_path, one, Rests({}, (), solvers | {"z3": evidence.tool("0")})) == "z3 is another"
    query.write_text("(check-sat) ")
    assert why_again(tmp_path, one, now) == "build/proofs/toy/a/001-a.smt2 is not what it made"
    query.unlink()
    assert why_again(tmp_path, one, now) == "build/proofs/toy/a/001-a.smt2 is not what it made"


def test_the_days_of_what_was_kept_are_said() -> None:
    kept = [{"started": f"2026-11-{day}T10:00:00Z", KEPT: True} for day in (23, 23, 24)]
    now = [{"started": "2026-11-25T10:00:00Z"}]
    assert kept_line([*kept, *now]) == (
        "kept         3 results of 2026-11-23 (2), 2026-11-24 (1); 1 results judged now"
    )
    assert kept_line(now) == "kept         none; 1 results judged now"


@pytest.mark.deep
def test_a_lane_that_was_killed_goes_on_where_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = toy_tree(tmp_path, "MC_toy", "MC_big")
    command = [sys.executable, "-m", "modeproof", "check", "--quiet"]
    with (tmp_path / "out").open("wb") as out:
        env = {**os.environ, "MODEPROOF_ROOT": str(root)}
        running = subprocess.Popen(command, env=env, stdout=out, stderr=out)
    until(evidence.evidence_path(root, "toy", "MC_toy").is_file, "evidence of the first run")
    running.kill()
    running.wait()
    runs: list[str] = []
    monkeypatch.setattr(verify, "check_all", lambda place, found, *_: runs.extend(r.id for r in found) or [])
    kept, _ = verify.check_lane(root, ["toy"], "full", Said(), Keep(anew=False))
    assert [one["id"] for one in kept] == ["MC_toy"] and runs == ["MC_big"]

"""Vectors of a whole machine: the reference conforms, mistakes of the wiring differ, drift is noticed."""

from __future__ import annotations

import json
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from machines.trial import edits
from machines.wiring import wiring_of
from modeproof.cli import main
from modeproof.kit.adapter import Adapter
from modeproof.kit.machine_reference import Wired
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, Plan, run_suite
from modeproof.kit.vectors import Suite, open_suite
from modeproof.registers.vector_files import check_vectors
from modeproof.suites.pack import pack

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
ROOM = ROOT / "vectors/machine_cell"
NAMES = ("sequences", "faults", "sic", "mistakes")
ADAPTER = [sys.executable, str(ROOT / "examples/adapters/machine_adapter.py")]
ON_THE_PAGE = [
    line.split("`")[1]
    for line in (ROOT / "docs/wire-your-machine.md").read_text("utf-8").splitlines()
    if line.startswith("| `") and line.count("|") == 5
]


def suite(name: str) -> Suite:
    return open_suite(ROOM / f"{name}.jsonl.gz")


def wired(text: str) -> Wired:
    return Wired("refimpl", "machine_cell", tomllib.loads(text))


def differs(text: str, names: tuple[str, ...] = NAMES) -> str:
    """The first suite by which a wiring differs; nothing where it conforms."""
    for name in names:
        one = suite(name)
        verdict = run_suite(one, lambda: wired(text), plan=Plan(most=1, effort=0))
        if verdict.word == DIFFERS:
            return name
        assert verdict.word == CONFORMS, verdict.reason
    return ""


@pytest.mark.parametrize("name", ["mistakes", pytest.param("sequences", marks=pytest.mark.deep)])
def test_the_shipped_reference_conforms_as_an_adapter(name: str) -> None:
    one = suite(name)
    assert run_suite(one, lambda: Adapter(shlex.join(ADAPTER))).word == CONFORMS


@pytest.mark.deep
@pytest.mark.parametrize("name", NAMES)
def test_the_wired_reference_gives_what_every_suite_expects(name: str) -> None:
    one = suite(name)
    assert run_suite(one, lambda: wired(TEXT)).word == CONFORMS


def test_a_crossed_wire_differs_with_scan_and_inputs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text(
        TEXT.replace('S_OutControl = "running.Q1 OR held.Q1"', 'S_OutControl = "guard.S_GuardLocked"'),
        "utf-8",
    )
    args = [
        "conform",
        "machine_cell",
        "--adapter",
        shlex.join([*ADAPTER, str(mine)]),
        "--suite",
        "sequences",
        "--quiet",
    ]
    assert main([*args, "--differences", "1", "--json", str(tmp_path / "verdict.json")]) == 1
    said = capsys.readouterr().out
    assert "S_DriveEnable        false                true" in said
    found = json.loads((tmp_path / "verdict.json").read_text("utf-8"))["difference"]
    scans = found["shortest"]["scans"]
    assert found["shortest_confirmed"]
    assert len(scans) < found["scan"]
    again = next(line for line in said.splitlines() if line.startswith("again:"))
    assert "--scans" in again


@pytest.mark.parametrize("id", ON_THE_PAGE[:3])
def test_a_mistake_on_the_page_differs(id: str) -> None:
    assert differs(edited(id))


@pytest.mark.deep
def test_every_mistake_on_the_page_differs() -> None:
    assert len(ON_THE_PAGE) >= 15
    unseen = [id for id in ON_THE_PAGE if not differs(edited(id))]
    assert set(unseen) <= set(suite("mistakes").header["edits"]["shown_nowhere"])
    assert len(unseen) < 3


def edited(id: str) -> str:
    return next(edit.after for edit in edits(TEXT, wiring_of(TEXT, "w")) if edit.id == id)


SMALL = """title = "one contactor"
cycle_ms = 10
scan_ms = [5, 50]
order = ["edm"]
[inputs]
Start = { type = "BOOL", from = "desk", why = "held to run" }
Reset = { type = "BOOL", from = "desk", why = "resets" }
S_Contactor = { type = "BOOL", from = "contactor", why = "TRUE is dropped out" }
[modes]
on = { is = "Start", why = "the only one" }
[safeguards]
none = { is = "TRUE", why = "none is needed" }
[matrix]
on = [["none"]]
[block.edm]
of = "SF_EDM"
why = "the contactor"
[block.edm.inputs]
Activate = "TRUE"
S_OutControl = "Start"
S_EDM1 = "S_Contactor"
S_EDM2 = "S_Contactor"
S_StartReset = "FALSE"
Reset = "Reset"
[block.edm.parameters]
MonitoringTime = 200
[outputs]
S_Drive = { is = "edm.S_EDM_Out", to = "contactor", why = "picks up" }
Lamp = { is = "edm.Error", to = "desk", why = "an error" }
"""
USE = """[rest]
S_Contactor = true
[follows]
S_Contactor = "NOT S_Drive"
[[story]]
id = "run"
first = true
row = [{ Reset = true }, { Reset = false }, { Start = true, scans = 5 }, { Start = false }]
"""


def test_vectors_of_an_own_wiring_are_written_and_judge(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, use, wrong = (tmp_path / name for name in ("my.toml", "use.toml", "wrong.toml"))
    mine.write_text(SMALL, "utf-8")
    use.write_text(USE, "utf-8")
    wrong.write_text(SMALL.replace("MonitoringTime = 200", "MonitoringTime = 2000"), "utf-8")
    folder = tmp_path / "vectors"
    assert main(["machine", str(mine), "--use", str(use), "--vectors", str(folder)]) == 0
    assert {path.name.split(".")[0] for path in folder.glob("*")} >= {"sequences", "faults", "sic"}
    for file, status in ((mine, 0), (wrong, 1)):
        args = [
            "conform",
            "machine_cell",
            "--adapter",
            shlex.join([*ADAPTER, str(file)]),
            "--vectors",
            str(folder),
            "--quiet",
        ]
        assert main(args) == status
    said = capsys.readouterr().out
    assert "edits show" in said or "no case is needed" in said


def test_headers_say_what_is_not_shown() -> None:
    for name in NAMES:
        one = suite(name)
        assert "no model checker walked a graph of the whole machine" in one.says["does_not_show"]
        assert one.header["wiring"] == tomllib.loads(TEXT)
        assert {case.basis for case in one.cases()} == {"design"}


def test_published_files_are_small_and_lint_passes(capsys: pytest.CaptureFixture[str]) -> None:
    paths = [ROOM / f"{name}.jsonl.gz" for name in NAMES]
    assert sorted(ROOM.glob("*")) == sorted(paths)
    assert sum(path.stat().st_size for path in paths) < 300_000
    assert main(["vectors", "lint", "machine_cell"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["ok"] * 4


def test_the_packed_kit_judges_the_machine_alone(tmp_path: Path) -> None:
    kit = tmp_path / "kit.pyz"
    contents = pack(ROOT, {}, kit)
    assert set(contents["targets"]) == {"machine_cell"}
    command = [
        sys.executable,
        "-I",
        str(kit),
        "conform",
        "machine_cell",
        "--adapter",
        shlex.join(ADAPTER),
        "--suite",
        "mistakes",
        "--quiet",
    ]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "CONFORMS(exact, mistakes)" in done.stdout


@pytest.mark.parametrize("source", ["spec/machine_cell/wiring.toml", "refimpl/edm/sf_edm.py"])
def test_vectors_of_another_wiring_are_no_longer_used(
    source: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("spec/machine_cell", "vectors/machine_cell", "refimpl"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    shutil.copy(ROOT / "vectors/SHA256SUMS", tmp_path / "vectors")
    ours = [one for one in check_vectors(tmp_path) if one.file.startswith("vectors/machine_cell")]
    assert ours == []
    with (tmp_path / source).open("a") as file:
        file.write("# a comment\n")
    assert not [one for one in check_vectors(tmp_path) if one.file.startswith("vectors/machine_cell")]
    with (tmp_path / source).open("a") as file:
        file.write("changed = 1\n")
    problems = [str(one) for one in check_vectors(tmp_path) if one.file.startswith("vectors/machine_cell")]
    assert len(problems) == 1
    assert f"{source} has changed since it was published" in problems[0]
    assert "if that was not meant, undo it; if it was: modeproof renew" in problems[0]


def test_an_unknown_suite_of_the_machine_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["conform", "machine_cell", "--builtin", "refimpl", "--suite", "tour"]) == 2
    assert "no suite 'tour'; allowed: fast, faults, mistakes, sequences, sic" in capsys.readouterr().err

"""The kit needs nothing but Python, on any system: its imports and calls are judged, and it runs alone."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
import zipfile
from itertools import chain
from pathlib import Path

import pytest

import modeproof.kit
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.suites import pack as packing
from tests.anywhere.no_posix.not_on_windows import ARGUMENTS, ATTRIBUTES, IN_PART, MODULES
from tests.kit.programs import program
from tests.suites.test_conform_command import toy as toy  # the fixture

SOURCES = sorted(Path(modeproof.kit.__file__).parent.glob("*.py"))
_WORDS = re.compile(
    rf"\b({'|'.join([*MODULES, *ARGUMENTS, *chain(*ATTRIBUTES.values()), *chain(*IN_PART.values())])})\b"
)
OTHER_WAY = {"PolledLines": "lines_of"}
"""Classes for systems that have what they need, and the function that chooses between them and others."""


def found(source: str) -> list[str]:
    """What a module has that Windows lacks, and for which it shows no other way."""
    problems: list[str] = []

    def visit(node: ast.AST, guarded: bool) -> None:
        if isinstance(node, ast.ClassDef) and node.name in OTHER_WAY:
            return
        if isinstance(node, ast.Import | ast.ImportFrom) and not guarded:
            names = [one.name for one in node.names] if isinstance(node, ast.Import) else [str(node.module)]
            problems.extend(f"imports {name}" for name in names if name in MODULES)
        named = isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and not guarded
        if named and node.attr in (*ATTRIBUTES.get(node.value.id, ()), *IN_PART.get(node.value.id, ())):
            problems.append(f"line {node.lineno}: {node.value.id}.{node.attr}")
        if isinstance(node, ast.keyword) and node.arg in ARGUMENTS:
            problems.append(f"{node.arg}")
        if isinstance(node, ast.If | ast.IfExp):
            guarded |= any(word in ast.unparse(node.test) for word in ("win32", "WINDOWS", "hasattr("))
        if isinstance(node, ast.Try):
            guarded |= any("AttributeError" in ast.unparse(one.type) for one in node.handlers if one.type)
        for child in ast.iter_child_nodes(node):
            visit(child, guarded)

    if _WORDS.search(source):  # else there is nothing to look for
        visit(ast.parse(source), False)
    return problems


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_the_kit_uses_nothing_that_one_system_alone_has(path: Path) -> None:
    assert found(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("import os\nos.fork()", "os.fork"),
        ("import os\ndef f():\n    os.killpg(1, 9)", "os.killpg"),
        ("import signal\nx = signal.SIGKILL", "signal.SIGKILL"),
        ("import select\nselect.select([], [], [])", "select.select"),
        ("import fcntl", "imports fcntl"),
        ("from pty import openpty", "imports pty"),
        ("import subprocess\nsubprocess.Popen('x', preexec_fn=print)", "preexec_fn"),
    ],
)
def test_such_a_thing_would_be_found(line: str, said: str) -> None:
    assert said in " ".join(found(line))


def test_with_another_way_beside_it_is_allowed() -> None:
    assert found("import os, sys\nif sys.platform == 'win32':\n    pass\nelse:\n    os.killpg(1, 9)") == []
    for choosing in OTHER_WAY.values():
        assert any(f"def {choosing}(" in path.read_text(encoding="utf-8") for path in SOURCES)


def alone(folder: Path, kit: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the packed kit in an empty folder, with Python's own library and nothing else to be found."""
    folder.mkdir(exist_ok=True)
    command = [sys.executable, "-I", "-S", str(kit), *words]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, env={"PATH": os.environ["PATH"]}, check=False
    )


@pytest.fixture
def kit(toy: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    assert main(["vectors", "pack"]) == 0
    said = capsys.readouterr().out
    assert "lamp: brief " in said and "without tour: it is none of the fast ones" in said
    return toy / "build" / packing.NAME


def test_the_packed_kit_judges_alone(kit: Path, toy: Path) -> None:
    good = " ".join(f'"{word}"' for word in program(toy))
    done = alone(
        toy / "empty", kit, "conform", "lamp", "--adapter", good, "--suite", "brief", "--suite", "words"
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "CONFORMS(exact, brief words)"
    (toy / "wrong").mkdir()
    wrong = " ".join(f'"{word}"' for word in program(toy / "wrong", "LIMIT = 501"))
    words = [
        "conform",
        "lamp",
        "--adapter",
        wrong,
        "--suite",
        "brief",
        "--json",
        "v.json",
        "--junit",
        "v.xml",
    ]
    done = alone(toy / "empty", kit, *words)
    assert done.returncode == 1 and "first difference:" in done.stderr
    again = next(line for line in done.stdout.splitlines() if line.startswith("again:"))
    assert f"python3 {kit} conform lamp" in again and "--case lamp-" in again
    assert json.loads((toy / "empty" / "v.json").read_text())["verdict"] == "DIFFERS"
    assert "<failure " in (toy / "empty" / "v.xml").read_text()


def test_the_packed_kit_says_what_is_not_inside(kit: Path, toy: Path) -> None:
    for words, said in (
        (
            ["lamp", "--adapter", "x", "--suite", "tour"],
            "suite tour is not inside: it is none of the fast ones",
        ),
        (["lamp", "--adapter", "x", "--suite", "none"], "suite none is not inside; allowed: fast, brief"),
        (["lump", "--adapter", "x"], "no target 'lump' inside; did you mean 'lamp'?"),
        (["lamp", "--adapter", "no_such_program"], "cannot be started"),
        (["lamp", "--s7", "127.0.0.1"], "--s7 needs --map"),
        (["lamp", "--builtin", "nothing_here"], "--builtin nothing_here"),
        (["lamp", "--adapter", "x", "--scans", "1"], "--scans belongs to --case"),
        (["lamp", "--adapter", "x", "--resume", "r"], "--resume is for one suite at a time"),
    ):
        done = alone(toy / "empty", kit, "conform", *words)
        assert done.returncode == 2 and said in done.stdout + done.stderr, done
        assert "Traceback" not in done.stderr


def test_the_packed_kit_has_the_same_bytes_and_no_dates(kit: Path) -> None:
    first = kit.read_bytes()
    assert main(["vectors", "pack"]) == 0
    assert kit.read_bytes() == first
    with zipfile.ZipFile(kit) as archive:
        infos = archive.infolist()
    assert {info.date_time for info in infos} == {(1980, 1, 1, 0, 0, 0)}
    assert [info.filename for info in infos] == sorted(info.filename for info in infos)


@pytest.mark.long
def test_the_slow_suites_go_in_when_they_are_asked_for(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["vectors", "pack", "--all"]) == 0
    said = capsys.readouterr().out
    assert "lamp: tour " in said and "without" not in said
    good = " ".join(f'"{word}"' for word in program(toy))
    kit = toy / "build" / packing.NAME
    for name in ("tour", "wp"):
        done = alone(toy / "empty", kit, "conform", "lamp", "--adapter", good, "--suite", name)
        assert done.stdout.splitlines()[-1] == f"CONFORMS(exact, {name})", done.stderr
    with zipfile.ZipFile(kit) as archive:
        assert any(name.endswith(".compact") for name in archive.namelist())


def test_what_the_compact_form_cannot_give_back_is_not_packed(
    kit: Path, toy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packing, "same", lambda lines, data: False)
    with pytest.raises(Unjudged, match="does not give the same rows"):
        packing.pack(toy, {"lamp": "toy"}, toy / "x.pyz")


def test_a_kit_that_would_be_too_large_is_not_written(
    kit: Path, toy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packing, "LARGEST", 1000)
    with pytest.raises(Unjudged, match="more than 1,000"):
        packing.pack(toy, {"lamp": "toy"}, toy / "x.pyz")
    assert not list(toy.glob("*.pyz")) and not list(toy.glob(".x.pyz*"))
    (toy / "build/vectors/toy/lamp/brief.jsonl.gz").unlink()
    with pytest.raises(Unjudged, match="suite brief is not built"):
        packing.pack(toy, {"lamp": "toy"}, toy / "x.pyz")

"""Tests that share what is made once are run in one process, and all others where there is room."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path, PurePath

import pytest

from tests.groups import FIRST, group_of, in_order

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = frozenset({"lamp", "door"})


@pytest.mark.parametrize(
    ("file", "group"),
    [
        ("proofs/lamp/test_a.py", "proofs/lamp"),
        ("proofs/lamp/test_b.py", "proofs/lamp"),
        ("proofs/door/test_a.py", "proofs/door"),
        ("proofs/explorer/test_a.py", "proofs"),
        ("proofs/test_a.py", "proofs"),
        ("trace/test_a.py", "trace"),
        ("report/test_a.py", "report"),
        ("report/browser/test_a.py", "report/browser"),
        ("kit/test_a.py", "kit/test_a.py"),
        ("test_a.py", "test_a.py"),
    ],
)
def test_a_document_or_a_room_or_a_file(file: str, group: str) -> None:
    assert group_of(PurePath(file), DOCUMENTS) == group


def test_what_takes_long_is_begun_first() -> None:
    groups = ["kit/a.py", "trace", "kit/b.py", "kit/b.py", "trace", "simulate"]
    assert [groups[place] for place in in_order(groups)] == [
        *("trace", "trace", "simulate"),
        *("kit/b.py", "kit/b.py", "kit/a.py"),
    ]
    assert in_order(groups)[:2] == [1, 4]


def test_every_group_that_is_begun_first_is_there() -> None:
    files = [path.relative_to(ROOT / "tests") for path in (ROOT / "tests").rglob("test_*.py")]
    assert set(FIRST) <= {group_of(PurePath(path)) for path in files}


@pytest.mark.deep
def test_processes_take_whole_groups(tmp_path: Path) -> None:
    """Run as `make test` does: all files of one room are run in one process."""
    tests = tmp_path / "tests"
    for file in ("trace/test_a.py", "trace/test_b.py", "kit/test_c.py"):
        (tests / file).parent.mkdir(parents=True, exist_ok=True)
        (tests / file).write_text(
            "import pytest, time\n@pytest.mark.parametrize('n', range(4))\ndef test(n): time.sleep(0.05)\n"
        )
    for file in ("conftest.py", "groups.py", "tiers.py", "any_machine.py"):
        shutil.copyfile(ROOT / "tests" / file, tests / file)
    shutil.copyfile(ROOT / "pyproject.toml", tmp_path / "pyproject.toml")
    shutil.copytree(ROOT / "modeproof", tmp_path / "modeproof", ignore=shutil.ignore_patterns("__pycache__"))
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-v",
        "-n",
        "2",
        "--dist",
        "loadscope",
        "-p",
        "no:cacheprovider",
    ]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    ran = re.findall(r"\[(gw\d)\].* tests/(\w+)/", done.stdout)
    assert (done.returncode, len(ran)) == (0, 12), done.stdout
    assert len({worker for worker, room in ran if room == "trace"}) == 1

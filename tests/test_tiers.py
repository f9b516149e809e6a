"""A sampled test is divided between the tiers, and no case is lost."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
TESTS = """
import pytest

@pytest.mark.sampled(3)
@pytest.mark.parametrize("n", range(7))
def test_every_third(n): pass

@pytest.mark.sampled
@pytest.mark.parametrize("n", range(3))
def test_first_alone(n): pass

@pytest.mark.deep
def test_second_tier(): pass

def test_plain(): pass

@pytest.mark.parametrize("n", [1, pytest.param(2, marks=pytest.mark.long)])
def test_long(n): pass
"""
CONFTEST = """
import pytest
from tests.tiers import divide

@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items): divide(items)
"""


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "tests").mkdir()
    shutil.copyfile(ROOT / "tests" / "tiers.py", tmp_path / "tests" / "tiers.py")
    shutil.copyfile(ROOT / "pyproject.toml", tmp_path / "pyproject.toml")
    (tmp_path / "tests" / "conftest.py").write_text(CONFTEST)
    (tmp_path / "tests" / "test_toy.py").write_text(TESTS)
    return tmp_path


def collected(place: Path, *words: str) -> list[str]:
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *words]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False)
    return [line.partition("::")[2] for line in done.stdout.splitlines() if "::" in line]


def test_the_tiers_are_apart_and_together_they_are_all(place: Path) -> None:
    first, second = collected(place, "-m", "not deep"), collected(place, "-m", "deep")
    third = ["test_every_third[0]", "test_every_third[3]", "test_every_third[6]"]
    assert first == [*third, "test_first_alone[0]", "test_plain", "test_long[1]"]
    assert sorted(first + second) == sorted(collected(place)) and len(second) == 8


@pytest.mark.deep
@pytest.mark.parametrize(
    ("asked", "words"), [({}, "7 passed, 1 skipped"), ({"MODEPROOF_LONG": "1"}, "8 passed")]
)
def test_a_long_case_runs_on_request_alone(place: Path, asked: dict[str, str], words: str) -> None:
    command = [sys.executable, "-m", "pytest", "-m", "deep", "-p", "no:cacheprovider"]
    environment = {name: value for name, value in os.environ.items() if name != "MODEPROOF_LONG"} | asked
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False, env=environment)
    assert words in done.stdout, done.stdout


def test_a_mark_without_a_sensible_number_is_refused(place: Path) -> None:
    (place / "tests" / "test_toy.py").write_text(TESTS.replace("sampled(3)", "sampled(0)"))
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False)
    assert done.returncode == 4 and "a number of 1 or more, not 0" in done.stdout + done.stderr

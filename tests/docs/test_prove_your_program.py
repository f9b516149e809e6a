"""Every command of docs/prove-your-program.md runs and gives what the page says."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/prove-your-program.md").read_text("utf-8")
STEPS = dict(re.findall(r"^## (\d)\. .*?\n(.*?)(?=^## )", PAGE, re.MULTILINE | re.DOTALL))
EXPECTED = {"1": "FOLLOWS", "3": "FOLLOWS", "4": "BREAKS", "5": "PROVED", "6": "FOLLOWS PROVED"}


def fenced(text: str, language: str) -> list[str]:
    """The blocks of a language."""
    every = re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return [inner for of, inner in every if of == language]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder that looks like the checkout, with a build folder of its own."""
    for name in (".venv", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "build").mkdir()
    (tmp_path / "build/names.toml").write_text(fenced(STEPS["3"], "toml")[0], "utf-8")
    return tmp_path


def output_of(commands: str, folder: Path) -> str:
    """What the commands print; all of them succeed."""
    done = subprocess.run(["bash", "-ec", commands], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_page_has_seven_steps() -> None:
    assert list(STEPS) == list("1234567")
    assert all(fenced(STEPS[step], "sh") for step in EXPECTED)


@pytest.mark.deep
@pytest.mark.parametrize(
    "step", [pytest.param(one, marks=[pytest.mark.long] * (one == "6")) for one in EXPECTED]
)
def test_the_commands_of_a_step_give_its_verdict(step: str, place: Path) -> None:
    said = output_of("\n".join(fenced(STEPS[step], "sh")), place)
    words = set(re.findall(r"^(FOLLOWS|BREAKS|PROVED|REFUTED|UNKNOWN|EMPTY|HOLDS)", said, re.MULTILINE))
    assert words == set(EXPECTED[step].split())
    for shown in fenced(STEPS[step], ""):
        for line in shown.splitlines():
            assert line == "..." or line in said.splitlines(), line


def test_the_forms_of_properties_are_those_that_are_read() -> None:
    from programs.properties.property_file import FORMS

    rows = re.findall(r"^\| (`.*?) \|", STEPS["5"], re.MULTILINE)
    assert [set(re.findall(r"`(\w+) =", row)) for row in rows] == [
        set(form) for form in ({"never"}, {"always"}, *FORMS[2:])
    ]

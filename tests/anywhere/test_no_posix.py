"""What users call runs on Windows, by construction: nothing that POSIX alone has is used.

Each command runs in a process that has taken from the tool what Python on Windows does not have
(`no_posix/sitecustomize.py`), with a console of code page 1252.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from tests.kit.test_alone import found

ROOMS = ("modeproof", "programs", "machines", "proofs", "refimpl", "scenes", "examples")
BLOCKER = Path(__file__).with_name("no_posix")
ST = TREE / "examples" / "st"
NOT_FOR_USERS = {"modeproof/strength/by_vectors.py"}
"""Of a maintainers' command: `mutate` ends what hangs by a timer of POSIX."""


def windows(tree: Path = TREE) -> dict[str, str]:
    """The environment in which Python is as on Windows for the tool in this tree."""
    return {
        "NO_POSIX_BELOW": os.pathsep.join(str(tree / room) for room in ROOMS),
        "PYTHONPATH": os.pathsep.join([str(BLOCKER), str(tree)]),
        "PYTHONIOENCODING": "cp1252",
    }


def without_posix(
    folder: Path, *words: str, tree: Path = TREE, status: int = 0
) -> subprocess.CompletedProcess[str]:
    """Run Python with these arguments as it is on Windows; what it says is of code page 1252."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MODEPROOF_")}
    done = subprocess.run(
        [sys.executable, *words],
        cwd=folder,
        env=environment | windows(tree),
        capture_output=True,
        encoding="cp1252",
        check=False,
    )
    assert done.returncode == status, done.stdout + done.stderr
    return done


def command(folder: Path, *words: str, status: int = 0) -> str:
    """What a command of the tool prints."""
    return without_posix(folder, "-m", "modeproof", *words, status=status).stdout


def windows_text(source: Path, place: Path) -> Path:
    """A copy as Windows writes it: lines end with CR and LF, a byte order mark before the first."""
    place.write_bytes(b"\xef\xbb\xbf" + source.read_bytes().replace(b"\n", b"\r\n"))
    return place


def test_the_help_and_the_version_are_there(tmp_path: Path) -> None:
    assert "prove-program" in command(tmp_path, "--help")
    assert command(tmp_path, "--version").startswith("modeproof ")


def test_a_program_of_windows_is_proved(tmp_path: Path) -> None:
    name = "Bündel Ω.st"  # the console has one of the two letters
    windows_text(ST / "sf_edm.st", tmp_path / name)
    said = command(tmp_path, "prove-program", name, "--target", "sf_edm", "--json", "v.json")
    assert said.startswith("FOLLOWS: function block SF_EDM of Bündel \\u03a9.st follows the page")
    assert (tmp_path / "v.json").is_file()


def test_every_module_can_be_imported(tmp_path: Path) -> None:
    names = [
        ".".join(path.relative_to(TREE).with_suffix("").parts)
        for room in ("modeproof", "programs", "machines")
        for path in sorted((TREE / room).rglob("*.py"))
        if path.name not in ("__main__.py", "__init__.py") and "simulate" not in path.parts
    ]
    assert len(names) > 300
    without_posix(tmp_path, "-c", f"import importlib\nfor name in {names}: importlib.import_module(name)")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("import fcntl", "fcntl"),
        ("import os; os.getuid()", "'os' has no attribute 'getuid'"),
        ("from signal import SIGKILL", "cannot import name 'SIGKILL'"),
        ("import multiprocessing; multiprocessing.get_context('fork')", "fork"),
        ("import sys; assert sys.platform == 'linux'", "AssertionError"),
    ],
)
def test_what_came_back_is_seen(tmp_path: Path, line: str, said: str) -> None:
    (tmp_path / "modeproof").mkdir()
    (tmp_path / "modeproof" / "planted.py").write_text(line + "\n")
    for name in ("__init__.py", "kit"):
        (tmp_path / "modeproof" / name).symlink_to(TREE / "modeproof" / name)
    words = ["-c", "import modeproof.planted"]
    assert said in without_posix(tmp_path, *words, tree=tmp_path, status=1).stderr


def test_no_file_of_the_tool_uses_what_windows_lacks() -> None:
    files = [path for room in ROOMS for path in sorted((TREE / room).rglob("*.py"))]
    assert len(files) > 500
    problems = {
        path.relative_to(TREE).as_posix(): lines
        for path in files
        if (lines := found(path.read_text(encoding="utf-8")))
    }
    assert set(problems) == NOT_FOR_USERS


@pytest.mark.deep
def test_a_project_file_of_windows_is_written_and_judged(tmp_path: Path) -> None:
    (tmp_path / "plc").mkdir()
    windows_text(ST / "sf_edm.st", tmp_path / "plc" / "Bündel Ω.st")
    assert "SF_EDM of plc/Bündel \\u03a9.st fits sf_edm" in command(tmp_path, "init")
    path = tmp_path / "modeproof.toml"
    text = path.read_text("utf-8").replace("plc/", "plc\\\\").replace("\n", "\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert "\\\\" in text and "1 entry: 1 as expected; 0 kept" in command(tmp_path, "judge")
    assert "1 entry: 1 as expected; 1 kept" in command(tmp_path, "judge")


@pytest.mark.deep
def test_the_other_commands_run(tmp_path: Path) -> None:
    assert "nothing is missing" in command(TREE, "doctor")
    assert "CONFORMS" in command(tmp_path, "conform", "sf_edm", "--builtin", "refimpl", "--suite", "brief")
    adapter = f'{sys.executable} "{TREE / "examples/adapters/refimpl_adapter.py"}" sf_edm'
    assert "CONFORMS" in command(tmp_path, "conform", "sf_edm", "--adapter", adapter, "--suite", "brief")
    assert "recorded counterexamples" in command(tmp_path, "simulate", "--out", "page.html")
    command(tmp_path, "machine", "--picture", "wiring.mmd")
    assert (tmp_path / "wiring.mmd").read_text(encoding="utf-8").startswith("flowchart")


@pytest.mark.deep
def test_a_project_file_of_windows_is_judged_and_kept(tmp_path: Path) -> None:
    (tmp_path / "plc").mkdir()
    windows_text(ST / "sf_edm.st", tmp_path / "plc" / "contactors.st")
    assert "SF_EDM of plc/contactors.st fits sf_edm" in command(tmp_path, "init")
    row = b"version = 1\r\n[program.contactors]\r\nfiles = ['plc\\contactors.st']\r\ntarget = 'sf_edm'\r\n"
    (tmp_path / "modeproof.toml").write_bytes(row)
    assert "1 as expected; 0 kept" in command(tmp_path, "judge", "--junit", "found.xml")
    assert "1 as expected; 1 kept" in command(tmp_path, "judge")
    (tmp_path / "modeproof.toml").write_bytes(row.replace(b"plc\\", b"D:\\plc\\"))
    done = without_posix(tmp_path, "-m", "modeproof", "judge", status=2)
    assert "D:/plc/contactors.st" in done.stderr and len(done.stderr.splitlines()) == 1

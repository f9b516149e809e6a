"""What `make wheels` collects, and what make says where the grammar cannot be built."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from modeproof.lane.wheelhouse import locked, needed

ABOUT = """Metadata-Version: 2.4
Name: mine
Version: 1
Provides-Extra: more
Requires-Dist: jsonschema==4
Requires-Dist: nothing-here==1; sys_platform == "nowhere"
Requires-Dist: Jinja2==3; extra == "more"
"""


def wheel(folder: Path) -> Path:
    path = folder / "mine-1-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mine-1.dist-info/METADATA", ABOUT)
    return path


def test_what_is_needed_by_what_is_needed_is_needed_too(tmp_path: Path) -> None:
    base = needed(wheel(tmp_path), ())
    assert {"jsonschema", "attrs", "rpds-py", "referencing"} <= base and "nothing-here" not in base
    assert needed(wheel(tmp_path), ["more"]) - base == {"jinja2", "markupsafe"}
    with pytest.raises(Unjudged, match="no extra 'mroe'; it has more"):
        needed(wheel(tmp_path), ["mroe"])


def test_a_package_may_have_rows_for_several_pythons() -> None:
    rows = locked(
        "# note\na-b==1 ; x \\\n    --hash=sha256:1\n\nA_b==2 \\\n    --hash=sha256:2\nc==3 \\\n  -\n"
    )
    assert set(rows) == {"a-b", "c"} and rows["a-b"].count("--hash") == 2


def test_without_a_compiler_make_says_so_before_pip_runs(tmp_path: Path) -> None:
    for name in ("Makefile", "requirements.lock", "programs/requirements.lock", "pyproject.toml", "setup.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(TREE / name, tmp_path / name)
    bare = tmp_path / "bin"
    bare.mkdir()
    for name in ("bash", "cmp", "make", "sh"):
        (bare / name).symlink_to(shutil.which(name) or "")
    command = ["make", f"PYTHON={sys.executable}", "verify"]
    environment = {"PATH": str(bare)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    said = [line for line in done.stderr.splitlines() if not line.startswith("make: ***")]
    assert done.returncode == 2 and done.stdout == ""
    assert [line.partition(":")[2] for line in said] == [
        " a C compiler is missing: it builds the grammar of Structured Text; install gcc, or a wheel of "
        "modeproof (docs/install.md)"
    ]
    assert not (tmp_path / ".venv").exists()
    (tmp_path / ".venv").mkdir()  # who has the grammar, is not asked
    shutil.copy(TREE / "programs/requirements.lock", tmp_path / ".venv" / "grammar.lock")
    ready = subprocess.run(
        ["make", f"PYTHON={sys.executable}", "compiler"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ready.returncode, ready.stderr) == (0, "")

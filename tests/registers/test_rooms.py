"""The walls between rooms hold, and each planted breach is found."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.registers import judge_tree, load_interface
from modeproof.registers.rooms import RULES, check_imports, check_no_document_known, check_order


@pytest.mark.parametrize(
    ("file", "line", "expected"),
    [
        ("refimpl/door/x.py", "import modeproof", "imports modeproof; refimpl may import refimpl"),
        ("refimpl/door/x.py", "from proofs.door import bolt", "imports proofs.door"),
        ("refimpl/door/x.py", "import z3", "imports z3"),
        ("proofs/door/x.py", "from modeproof.tlc import runs", "imports modeproof.tlc"),
        ("proofs/door/x.py", "from modeproof import tlc", "imports modeproof.tlc"),
        ("proofs/door/x.py", "import tests.door", "imports tests.door"),
        ("modeproof/kit/x.py", "import jsonschema", "imports jsonschema"),
        (
            "modeproof/kit/x.py",
            "from modeproof.ground.errors import Unjudged",
            "imports modeproof.ground.errors",
        ),
        ("modeproof/kit/x.py", "from ..errors import Unjudged", "imports modeproof.errors"),
        ("modeproof/kit/x.py", "from .. import errors", "imports modeproof.errors"),
        ("modeproof/kit/x.py", "def f():\n    import refimpl.door", "line 2: imports refimpl.door"),
        (
            "modeproof/report/x.py",
            "from modeproof.tlc.run_judge import judge",
            "imports modeproof.tlc.run_judge",
        ),
        (
            "modeproof/registers/x.py",
            "from modeproof.ground.evidence import write",
            "imports modeproof.ground.evidence",
        ),
    ],
)
def test_a_breach_is_found(tree: Any, file: str, line: str, expected: str) -> None:
    assert check_imports(tree.root) == []
    tree.write(file, line + "\n")
    found = [str(problem) for problem in check_imports(tree.root)]
    assert len(found) == 1 and found[0].startswith(f"{file}: ") and expected in found[0]


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("refimpl/door/x.py", "from refimpl.errors import InputError"),
        ("refimpl/door/x.py", "from . import latch"),
        ("proofs/door/x.py", "from modeproof.registers import load_document"),
        ("proofs/door/x.py", "from modeproof import registers"),
        ("proofs/door/x.py", "import z3"),
        ("modeproof/kit/x.py", "from modeproof.kit import protocol\nimport json"),
        ("modeproof/kit/x.py", "from . import protocol"),
        ("modeproof/report/x.py", "from modeproof.ground.evidence import files"),
        ("modeproof/lane/prove_command.py", "import proofs.runner"),
    ],
)
def test_what_is_allowed_is_not_reported(tree: Any, file: str, line: str) -> None:
    tree.write(file, line + "\n")
    assert check_imports(tree.root) == []


@pytest.mark.parametrize(
    "word",
    [
        "door",
        "latch",
        "Latch",
        "DR",
        "LOCK_1",
        "door_closed",
        "T_HOLD_ms",
        "CloseLatch",
        "OpenIsUnlocked",
        "MC_Latch",
    ],
)
@pytest.mark.parametrize(
    "file", ["modeproof/kit/x.py", "modeproof/kit/x.json", "modeproof/report/page/x.html.j2"]
)
def test_the_tool_may_not_know_a_declared_name(tree: Any, file: str, word: str) -> None:
    assert judge_tree(tree.root) == []
    tree.write(file, f'["{word}"]\n')
    assert [str(problem) for problem in judge_tree(tree.root)] == [
        f"{file}: line 1: knows {word!r}, which a register declares; take it from the register"
    ]


@pytest.mark.parametrize("word", ["doors", "Open", "state", "latched", "UNDER", "MC_Latch2", "CODED"])
def test_ordinary_words_are_free(tree: Any, word: str) -> None:
    tree.write("modeproof/kit/x.py", f"# {word}\n")
    assert judge_tree(tree.root) == []


def test_every_rule_reads_python_files_once_its_room_exists(real_root: Path) -> None:
    for rule in RULES:
        folder = real_root / rule.folder
        assert not folder.exists() or list(folder.rglob("*.py")), f"{rule.folder} holds no Python"
    assert len(list((real_root / "refimpl").rglob("*.py"))) > 4
    assert len(list((real_root / "proofs").rglob("*.py"))) > 4


def test_the_rooms_of_this_repository_keep_their_walls(real_root: Path) -> None:
    assert [str(problem) for problem in check_imports(real_root)] == []


def test_the_tool_of_this_repository_knows_no_document(real_root: Path) -> None:
    interfaces = [
        load_interface(real_root, path.parent.name) for path in real_root.glob("spec/*/interface.toml")
    ]
    assert interfaces
    assert [str(problem) for problem in check_no_document_known(real_root, interfaces, [])] == []


def test_imports_run_neither_upward_nor_in_a_circle(real_root: Path) -> None:
    assert check_order(real_root) == []


@pytest.mark.parametrize(
    ("file", "line", "said"),
    [
        (
            "graph",
            "from modeproof.report.claims import claims",
            "modeproof.report.claims, which is above",
        ),
        ("graph", "def f():\n    import modeproof.cli", "imports modeproof.cli, which is above"),
        ("graph", "from modeproof.graph import y", "imports in a circle"),
        ("graph", "def f():\n    from modeproof.graph import y", "imports in a circle"),
        ("graph", "from importlib import import_module as load", "import_module; what data name is"),
        ("graph", "import importlib\nm = importlib.import_module", "line 2: import_module; what data name"),
        ("graph", "m = __import__('z3')", "__import__; what data name is"),
        ("graph", "WORKS = ('machines.verdicts',)", "imports machines.verdicts, which is above"),
        ("graph", "def f(name):\n    return f'programs.commands.{name}'", "imports programs.commands, which"),
        ("graph", "from machines import verdicts", "imports machines.verdicts, which is above"),
        ("ground", "import proofs.runner", "imports proofs.runner, which is above"),
        ("ground", "from refimpl import door", ""),
        ("lane", "from machines import verdicts\nfrom programs.commands import prove_program", ""),
    ],
)
def test_an_upward_import_and_a_circle_are_found(tree: Any, file: str, line: str, said: str) -> None:
    tree.write("modeproof/graph/y.py", "from modeproof.graph import x\n")
    tree.write("modeproof/graph/x.py", "from modeproof.kit import lines\n")
    tree.write("machines/verdicts.py", "")
    assert check_order(tree.root) == []
    tree.write(f"modeproof/{file}/x.py", line + "\n")
    found = [str(problem) for problem in check_order(tree.root)]
    assert len(found) == bool(said) and all(said in problem for problem in found)


@pytest.mark.parametrize(
    ("file", "line", "said"),
    [
        (
            "programs/language/x.py",
            "from programs.readers.scl import structured_text",
            "programs.readers.scl",
        ),
        ("programs/equality/x.py", "from programs.commands import prove_program", "programs.commands"),
        ("programs/semantics/x.py", "import machines.wiring", "machines.wiring"),
        ("proofs/x.py", "from programs.semantics import terms", "programs.semantics.terms"),
        ("scenes/x.py", "from modeproof.simulate.program import page", "modeproof.simulate.program.page"),
    ],
)
def test_an_upward_import_is_found_in_every_room(tree: Any, file: str, line: str, said: str) -> None:
    tree.write("modeproof/simulate/program/page.py", "")
    tree.write("programs/semantics/terms.py", "")
    tree.write(file, line + "\n")
    (found,) = [str(problem) for problem in check_order(tree.root)]
    assert found.startswith(f"{file}: imports {said}") and "above it" in found


def test_a_file_outside_the_rooms_is_found(tree: Any) -> None:
    tree.write("programs/x.py", "from programs.language import tree\n")
    tree.write("programs/language/tree.py", "")
    assert ["is in no room" in str(problem) for problem in check_order(tree.root)] == [True]


@pytest.mark.parametrize("top", ["programs", "machines", "proofs"])
def test_a_circle_is_found_in_the_whole_tree(tree: Any, top: str) -> None:
    folder = f"{top}/language" if top == "programs" else top
    package = folder.replace("/", ".")
    tree.write(f"{folder}/one.py", f"def f():\n    from {package} import two\n")
    tree.write(f"{folder}/two.py", f"from {package}.one import f\n")
    (found,) = [str(problem) for problem in check_order(tree.root)]
    assert f"imports in a circle: {package}." in found


def test_no_file_of_the_tool_is_longer_than_450_lines(real_root: Path) -> None:
    tool = [
        path for room in ("modeproof", "programs", "machines") for path in real_root.glob(f"{room}/**/*.py")
    ]
    lengths = {path: len(path.read_bytes().splitlines()) for path in tool}
    assert lengths and not [path for path, length in lengths.items() if length > 450]

"""What counts as a change of a file, and which files a result depends on."""

from __future__ import annotations

import gzip
import hashlib
import itertools
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import key, meaning, meaning_of, meanings, reached
from modeproof.ground.places import TREE
from modeproof.registers import tla

PYTHON = """\
import json

def twice(n: int) -> int:
    return 2 * n
"""
MODULE = """\
---- MODULE Box ----
EXTENDS Naturals
VARIABLE x
Init == /\\ x = 0
        /\\ TRUE
Say == "a (* b \\\\* c"
====
"""
SAME = {
    "a docstring": ("a.py", PYTHON, PYTHON.replace("    return", '    """It doubles."""\n    return')),
    "a comment": ("a.py", PYTHON, PYTHON.replace("2 * n", "2 * n  # doubled")),
    "layout of Python": ("a.py", PYTHON, PYTHON.replace("2 * n", "(\n        2\n        * n\n    )")),
    "words below a constant": ("a.py", "A = 1\nB = 2\n", 'A = 1\n"""Of A."""\nB = 2\n'),
    "a comment to the end of the line": ("a.tla", MODULE, MODULE.replace("x = 0", "x = 0  \\* at first")),
    "a block comment": ("a.tla", MODULE, MODULE.replace("VARIABLE", "(* of (* it *)\n*)\nVARIABLE")),
    "blank lines of TLA+": ("a.tla", MODULE, MODULE.replace("VARIABLE", "\n  \nVARIABLE")),
    "text around the module": ("a.tla", MODULE, f'A (* "box\n{MODULE}and no more\n'),
    "a comment in a cfg": ("a.cfg", "CONSTANT A = 1\n", "\\* few\nCONSTANT\n  A = 1 (* one *)\n"),
    "layout of TOML": ("a.toml", "a = [1, 2]\n", "# two\na = [\n  1,\n  2, ]\n"),
    "layout of JSON": ("a.json", '{"a": [1]}', '{"a":\n [1]}\n'),
    "layout of lines of JSON": ("a.jsonl", '{"a": 1}\n[2]\n', '{"a":1}\n\n[2]'),
    "the packing": ("a.jsonl.gz", gzip.compress(b"1\n2\n", 1), gzip.compress(b"1\n2\n", 9, mtime=7)),
}
OTHER = {
    "a number": ("a.py", PYTHON, PYTHON.replace("2 * n", "3 * n")),
    "a number of another type": ("a.py", "A = 1\n", "A = True\n"),
    "an annotation": ("a.py", PYTHON, PYTHON.replace("n: int", "n: float")),
    "a string that is used": ("a.py", 'A = "a"\n', 'A = "b"\n'),
    "an assertion": ("a.py", PYTHON, PYTHON.replace("    return", "    assert n\n    return")),
    "the sentence of a theorem": (
        "a.py",
        '@theorem(clauses=())\ndef a():\n    "It holds."\n    return 1\n',
        '@theorem(clauses=())\ndef a():\n    "It never holds."\n    return 1\n',
    ),
    "a guard": ("a.tla", MODULE, MODULE.replace("x = 0", "x = 1")),
    "the column of a junction": ("a.tla", MODULE, MODULE.replace("        /\\", "          /\\")),
    "blanks in a string of TLA+": ("a.tla", MODULE, MODULE.replace("b \\\\", "b  \\\\")),
    "words after two backslashes": ("a.tla", *(MODULE.replace("= 0", f"= a \\\\* {n}") for n in "12")),
    "what follows a module within": (
        "a.tla",
        *(MODULE.replace("VARIABLE", f"---- MODULE In ----\n====\nA == {n}\nVARIABLE") for n in "12"),
    ),
    "a constant of a cfg": ("a.cfg", "CONSTANT A = 1\n", "CONSTANT A = 2\n"),
    "blanks in a string of a cfg": ("a.cfg", 'CONSTANT A = "a b"\n', 'CONSTANT A = "a  b"\n'),
    "a value of TOML": ("a.toml", "a = 1\n", "a = 2\n"),
    "a type of TOML": ("a.toml", "a = 1\n", "a = 1.0\n"),
    "the order of TOML": ("a.toml", "a = 1\nb = 2\n", "b = 2\na = 1\n"),
    "a value of JSON": ("a.json", "[1]", "[2]"),
    "a line of JSON": ("a.jsonl", "1\n", "1\n1\n"),
    "a packed line": ("a.jsonl.gz", gzip.compress(b"1\n"), gzip.compress(b"2\n")),
    "a blank of any other file": ("a.css", "a {}", "a  {}"),
    "a comment of a file that is no Python": ("a.py", "def", "def #"),
}


def bytes_of(text: str | bytes) -> bytes:
    return text if isinstance(text, bytes) else text.encode()


@pytest.mark.parametrize("name, old, new", SAME.values(), ids=SAME)
def test_what_means_the_same_is_no_change(name: str, old: str, new: str) -> None:
    assert bytes_of(old) != bytes_of(new)
    assert meaning_of(name, bytes_of(old)) == meaning_of(name, bytes_of(new))


@pytest.mark.parametrize("name, old, new", OTHER.values(), ids=OTHER)
def test_what_could_mean_something_else_is_a_change(name: str, old: str, new: str) -> None:
    assert meaning_of(name, bytes_of(old)) != meaning_of(name, bytes_of(new))


DAMAGED = {
    "a.py": b"def",
    "b.py": b"\0",
    "c.py": b"(" * 5000,
    "a.tla": b"VARIABLE x",
    "b.tla": b"---- MODULE \xff",
    "a.toml": b"a =",
    "a.json": b"{",
    "a.jsonl": b"1\n}",
    "a.jsonl.gz": b"no packing",
    "b.jsonl.gz": gzip.compress(b"1\n")[:-4],
    ".py": b"x",
    "README": b"x",
}


@pytest.mark.parametrize("name", DAMAGED)
def test_a_file_that_cannot_be_parsed_counts_by_its_bytes(name: str) -> None:
    assert meaning_of(name, DAMAGED[name]) == hashlib.sha256(DAMAGED[name]).hexdigest()


def test_the_same_text_means_another_in_another_language() -> None:
    found = {meaning_of(name, b"[1]\n") for name in ("a.py", "a.json", "a.jsonl", "a.toml", "a.txt")}
    assert len(found) == 5


def test_files_have_paths_below_the_root_and_no_others(tmp_path: Path) -> None:
    inner = tmp_path / "tree"
    inner.mkdir()
    for path in (tmp_path / "b.py", inner / "a.py"):
        path.write_text(PYTHON)
    assert meanings(inner, [inner / "a.py"]) == {"a.py": meaning(tmp_path / "b.py")}
    with pytest.raises(Unjudged, match="lies outside"):
        meanings(inner, [tmp_path / "b.py"])
    with pytest.raises(Unjudged, match=r"c\.py: No such file"):
        meaning(inner / "c.py")


FILES = {
    "pack/__init__.py": "",
    "pack/top.py": "import pack.plain\nfrom pack import middle\n",
    "pack/plain.py": "",
    "pack/middle.py": "def late():\n    from .inner import deep\n    from .. import other\n",
    "pack/inner/__init__.py": "from . import first\n",
    "pack/inner/first.py": "import json\n",
    "pack/inner/deep.py": "import_module('pack.named')\nROWS = 'pack/rows.toml'\n",
    "pack/rows.toml": "",
    "pack/named.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import pack.typed\n",
    "pack/typed.py": "",
    "other.py": "",
    "pack/unused.py": "",
    "pack/words.py": "SAYS = 'pack.unused'\n",
}


def lay(root: Path) -> Path:
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def names(root: Path, paths: tuple[Path, ...]) -> list[str]:
    return [path.relative_to(root).as_posix() for path in paths]


def test_a_module_needs_what_it_imports_anywhere_in_it(tmp_path: Path) -> None:
    root = lay(tmp_path)
    everything = sorted({*FILES} - {"pack/unused.py", "pack/words.py"})
    assert names(root, reached(root, "pack.top")) == everything
    assert (
        reached(root, "pack/top.py") == reached(root, root / "pack" / "top.py") == reached(root, "pack.top")
    )
    assert names(root, reached(root, "pack.inner")) == [
        f"pack/{name}.py" for name in ("__init__", "inner/__init__", "inner/first")
    ]
    assert root / "pack/unused.py" not in reached(root, "pack.words"), "a word is no import"
    assert root / "pack/unused.py" in reached(root, "pack/")


@pytest.mark.parametrize("entry", ["pack.none", "none.py", "none", "/etc/passwd"])
def test_an_entry_that_is_not_there_is_refused(tmp_path: Path, entry: str) -> None:
    with pytest.raises(Unjudged, match="no such file, folder or module"):
        reached(lay(tmp_path), entry)


def test_the_key_moves_with_what_is_needed_alone(tmp_path: Path) -> None:
    root = lay(tmp_path)
    (root / "rows.toml").write_text("a = 1\n")

    def now(z3: str = "1", said: str = "") -> str:
        return key(root, ["pack.top"], [root / "rows.toml"], {"z3": z3}, said).digest

    was = now()
    (root / "pack/unused.py").write_text("A = 1\n")
    (root / "pack/inner/first.py").write_text('"""Words."""\nimport json  # words\n')
    (root / "rows.toml").write_text("a = 1  # one\n")
    assert now() == was
    (root / "pack/inner/first.py").write_text("import json\nA = 1\n")
    moved = [was, now(), now("2"), now(said="a row")]
    (root / "rows.toml").write_text("a = 2\n")
    assert len({*moved, now()}) == 5


def test_a_specification_needs_at_least_what_it_extends() -> None:
    documents = sorted(path.parent.name for path in TREE.glob("spec/*/interface.toml"))
    count = 0
    for document, (name, module) in itertools.chain.from_iterable(
        ((document, item) for item in tla.read_modules(TREE, document).items()) for document in documents
    ):
        needed = {path.stem for path in reached(TREE, module.file)}
        assert {one.name for one in tla.closure(tla.read_modules(TREE, document), name)} <= needed
        count += 1
    assert count > 80

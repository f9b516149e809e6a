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
    """Which of our packages the files below a folder may import; `stdlib_only` forbids all others too."""

    folder: str
    allowed: tuple[str, ...]
    stdlib_only: bool = False


RULES = (
    Rule("refimpl", ("refimpl",), stdlib_only=True),
    Rule("scenes", ("scenes", "refimpl", "modeproof.simulate.program"), stdlib_only=True),
    Rule("modeproof/simulate/program", ("modeproof.simulate.program",)),
    Rule("proofs", ("proofs", "refimpl", "modeproof.registers")),
    Rule("programs", ("programs", "proofs", "modeproof.registers", "modeproof.ground", "modeproof.kit")),
    Rule(
        "machines",
        (
            *("machines", "programs", "modeproof.registers", "modeproof.ground", "modeproof.kit"),
            *("refimpl.machine_cell", "refimpl.errors"),
        ),
    ),
    Rule("modeproof/kit", ("modeproof.kit",), stdlib_only=True),
    Rule(
        "modeproof/report",
        (
            "modeproof.report",
            "modeproof.registers",
            "modeproof.ground.evidence",
            "modeproof.ground.errors",
            "modeproof.ground.meaning",
            "modeproof.ground.places",
            "modeproof.ground.progress",
            *(
                "modeproof.ground.proofs",
                "modeproof.tlc.run_judge_again",
                "modeproof.graph.equal",
            ),  # judged again
        ),
    ),
    Rule(
        "modeproof/registers",
        (
            "modeproof.registers",
            *("modeproof.ground.errors", "modeproof.ground.evidence.files"),
            *("modeproof.ground.comments", "modeproof.ground.meaning"),
            *("modeproof.ground.places", "modeproof.ground.progress", "modeproof.ground.reason"),
        ),
    ),
)

ORDER = (
    *(
        "kit",
        "s7",
        "ground",
        "registers",
        "tlc",
        "graph",
        "suites",
        "strength",
        "trace",
        "report",
        "simulate",
        "lane",
    ),
    "cli",
)
"""The rooms of modeproof/ from the ground up: a module imports from its own room and from those before it."""

PROOFS_REACHED_FROM = ("modeproof/lane/", "proofs/", "tests/")


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
    for path in sorted((root / "modeproof").rglob("*.py")):
        file = shown(root, path)
        if not file.startswith(PROOFS_REACHED_FROM):
            for line, name in imports(path):
                if name.split(".")[0] == "proofs":
                    problems.append(
                        Problem(file, "", f"line {line}: imports {name}; only modeproof/lane reaches proofs")
                    )
    return problems


def check_order(root: Path) -> list[Problem]:
    """Every import of modeproof/ that runs upward, and a problem for each circle of imports."""
    files = {
        ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"): path
        for path in sorted((root / "modeproof").rglob("*.py"))
    }
    problems: list[Problem] = []
    imports: dict[str, set[str]] = {}
    for module, path in files.items():
        own = _height(module)
        names = {name for _, name in _imports(root, path, submodules=frozenset(files))}
        imports[module] = {name for name in names if name in files and name != module}
        for name in sorted(names):
            if name.startswith("modeproof.") and own < _height(name) < len(ORDER):
                text = f"imports {name}, which stands above it in the order of rooms"
                problems.append(Problem(shown(root, path), "", text))
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        circle = " -> ".join(error.args[1])
        problems.append(Problem("modeproof", "", f"imports in a circle: {circle}"))
    return problems


def _height(module: str) -> int:
    """The place of a module's room in the order. A module in no room (`__main__`) stands above all rooms."""
    room = module.split(".")[1] if "." in module else ORDER[0]
    return ORDER.index(room) if room in ORDER else len(ORDER)


def _allowed(rule: Rule, name: str) -> bool:
    top = name.split(".")[0]
    if top in OURS:
        return any(name == package or name.startswith(f"{package}.") for package in rule.allowed)
    return not rule.stdlib_only or top in sys.stdlib_module_names


def _words(rule: Rule) -> str:
    others = "the standard library" if rule.stdlib_only else "any installed package"
    return f"{', '.join(rule.allowed)} and {others}"


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

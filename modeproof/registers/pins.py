"""What is checked and what is proved, pinned as text: spec/<document>/pins.toml.

A run's counts do not change when a property is weakened, and a theorem proves whatever its text says. So
each name that a cfg checks and each theorem has a hash of its definition and of what that refers to. Comments
and the layout of Python are left out. A hash moves only with a reason. Beside them stand the stamps of
modeproof.registers.killers and of modeproof.registers.refuting.
"""

from __future__ import annotations

import ast
import hashlib
import re
import time
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from typing import Annotated

import msgspec
import tomlkit

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import said_by
from modeproof.registers.cfg import Cfg
from modeproof.registers.citations import Sources
from modeproof.registers.files import read_text, read_toml
from modeproof.registers.made import base_cfg, used, words_of
from modeproof.registers.python_source import PythonModule
from modeproof.registers.rows import Document, Problem
from modeproof.registers.stale import stale
from modeproof.registers.tla import Module, closure
from modeproof.registers.typed import typed

Digest = Annotated[str, msgspec.Meta(pattern=r"^[0-9a-f]{16}$")]
Texts = Mapping[str, str]
"""By name, the text of a definition and of all that it refers to."""

HEADER = """\
# What each checked name (TLA+) and each theorem (Python) says: a hash of its text and of what that refers to.
# Of each edit (killers.toml, `refuted` of the proofs): a hash of the text on which it was judged.
# `modeproof renew` writes it.
"""
_FAIR = re.compile(r"\b[WS]F_")
"""Fairness is part of what a specification says, and no step shows it."""
_SUBSCRIPT = re.compile(r"\]_(?:\w+|<<.*?>>)", re.DOTALL)


class Pins(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The file: by name the hash of each checked definition and theorem, and the stamps of the edits."""

    document: str
    checked: dict[str, Digest] = {}
    theorems: dict[str, Digest] = {}
    killers: dict[str, Digest] = {}
    refuted: dict[str, Digest] = {}

    def of(self, table: str) -> dict[str, str]:
        """One of the two tables."""
        return self.checked if table == "checked" else self.theorems


def check_pins(document: Document, sources: Sources) -> list[Problem]:
    """Every text that is not the pinned one, and every property that can say nothing."""
    file, pins = document.source("pins"), load_pins(document)
    problems = [] if pins.document in ("", document.name) else [Problem(file, "document", "is another's")]
    for table, texts in texts_of(document, sources).items():
        pinned = pins.of(table)
        for name, text in texts.items():
            if name not in pinned:
                what = "is not pinned"
            elif pinned[name] != digest(text):
                what = f"{name}, or what it refers to, is not the text that was pinned"
            else:
                continue
            problems.append(Problem(file, f"{table}.{name}", stale(what, document.name, reason=True)))
        gone = (name for name in pinned if name not in texts)
        what = stale("nothing of this name is left", document.name, reason=True)
        problems += [Problem(file, f"{table}.{name}", what) for name in gone]
    return [*problems, *_saying_nothing(document, sources)]


def load_pins(document: Document) -> Pins:
    """The pins of a document; empty ones where it has none. Raises Unjudged when the file cannot be read."""
    path = document.root / document.source("pins")
    there = path.is_file()
    return (
        typed(Pins, read_toml(document.root, path), document.source("pins")) if there else Pins(document="")
    )


def texts_of(document: Document, sources: Sources) -> dict[str, Texts]:
    """Both tables: what is checked, and what is proved."""
    return {"checked": checked_texts(document, sources), "theorems": proved_texts(document, sources)}


def digest(text: str) -> str:
    """The hash of a text, as it is in the file."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def repin(document: Document, sources: Sources, reason: str) -> list[str]:
    """Write the hashes of the present texts; one line for each that moved.

    The reason is beside each. Raises Unjudged when a property says nothing or the file cannot be
    written.
    """
    for problem in _saying_nothing(document, sources):
        raise Unjudged(f"{problem}; nothing was pinned")
    path = document.root / document.source("pins")
    old = tomlkit.parse(read_text(document.root, path) if path.is_file() else HEADER)
    known = {table: dict(old.get(table, {})) for table in ("checked", "theorems")}
    first = "document" not in old
    old["document"] = document.name
    lines = []
    for table, texts in texts_of(document, sources).items():
        now = {name: digest(text) for name, text in texts.items()}
        rows = old.setdefault(table, tomlkit.table())
        for name in [name for name in rows if name not in now]:
            lines.append(f"{document.name}: {table}.{name}: {rows.pop(name)} -> none")
        for name, value in now.items():
            if (was := known[table].get(name)) != value:
                rows[name] = value
                if not first:
                    rows[name].comment(f"{time.strftime('%Y-%m-%d', time.gmtime())}: {reason}")
                lines.append(f"{document.name}: {table}.{name}: {was or 'none'} -> {value}")
    if lines:
        write_whole(path, tomlkit.dumps(old).encode("utf-8"))
    return lines


# ---------------------------------------------------------------------------------------------- TLA+


def checked_texts(document: Document, sources: Sources) -> Texts:
    """For each name that a run checks, or explores and views by: its definition in every root module, and
    what that refers to, without what the steps of the devices are made of: graphs and counts judge that.
    """
    roots: dict[str, set[str]] = {}
    starts: set[tuple[str, str]] = set()
    for run in document.runs:
        try:
            cfg = base_cfg(document.root, run)
        except Unjudged:
            cfg = Cfg()  # told elsewhere
        constraints = (*cfg.constraints, *cfg.action_constraints, *filter(None, (cfg.view, run.view)))
        for name in dict.fromkeys((*cfg.checked, *run.properties, *constraints)):
            roots.setdefault(name, set()).add(run.module)
        for name in filter(None, (cfg.specification, run.specification, cfg.init, cfg.next)):
            starts.add((run.module, name))
            roots.setdefault(name, set()).add(run.module)
    for prop in document.properties:
        roots.setdefault(prop.tla, set()).add(prop.module)
    modules = sources.modules
    steps = {(module, name) for module, start in starts for name in _reached(modules, module, start)}
    found = {}
    for name, within in sorted(roots.items()):
        parts: dict[str, str] = {}
        for root in sorted(within):
            bodies = _bodies(modules, root)
            own = {step for module, step in steps if module == root and not _FAIR.search(bodies[step][1])}
            parts |= _meaning(modules, bodies, name, own)
        if parts:
            found[name] = "\n".join(parts[key] for key in sorted(parts))
    return found


Bodies = dict[str, tuple[str, str]]


def _bodies(modules: dict[str, Module], root: str) -> Bodies:
    """By name, the module and the text of each definition of a module and of all that it extends."""
    found: dict[str, tuple[str, str]] = {}
    waiting = [root] if root in modules else []
    for name in waiting:  # it grows
        module = modules[name]
        for definition in module.definitions:
            found.setdefault(definition.name, (name, definition.body))
        waiting += [other for other in module.extends if other in modules and other not in waiting]
    return found


def _reached(modules: dict[str, Module], root: str, name: str) -> set[str]:
    bodies = {key: body for key, (_, body) in _bodies(modules, root).items()}
    return {name, *used(bodies, name)} if name in bodies else set()


def _meaning(
    modules: dict[str, Module], bodies: Bodies, name: str, left_out: Collection[str] = ()
) -> dict[str, str]:
    """The definition and those that it refers to, by module and name; a module that it takes an instance of
    belongs to it as a whole.
    """
    waiting: list[str] = [name] if name in bodies else []
    parts: dict[str, str] = {}
    while waiting:
        module, body = bodies[key := waiting.pop()]
        parts[f"{module}!{key}"] = "\n".join(line.rstrip() for line in body.splitlines() if line.strip())
        for instance in re.findall(r"\bINSTANCE\s+(\w+)", body):
            if instance in modules:
                whole = [definition.body for definition in modules[instance].definitions]
                parts[f"{instance}!"] = "\n".join(
                    line.rstrip() for text in whole for line in text.splitlines()
                )
        known = (word for word in words_of(body) if word in bodies and word not in left_out)
        waiting += [word for word in known if f"{bodies[word][0]}!{word}" not in parts]
    return parts


def _saying_nothing(document: Document, sources: Sources) -> Iterator[Problem]:
    """Properties that speak of no variable: each is always true, or never."""
    for prop in document.properties:
        modules = closure(sources.modules, prop.module)
        parts = _meaning(sources.modules, _bodies(sources.modules, prop.module), prop.tla)
        variables = {name for module in modules for name in module.variables}
        words = {word for text in parts.values() for word in re.findall(r"\w+", _SUBSCRIPT.sub("]", text))}
        if parts and not any("!" in key and key.endswith("!") for key in parts) and not variables & words:
            text = "speaks of no variable, so that it says nothing of any state"
            yield Problem(document.source("properties"), prop.id, text)


# ---------------------------------------------------------------------------------------------- theorems


def proved_texts(document: Document, sources: Sources) -> Texts:
    """For each theorem: its text, and that of everything in the room of the document that it refers to."""
    room = ".".join(("proofs", document.name))
    scopes = {module.name: _scope(module, room) for module in sources.proofs}

    @cache
    def read(place: tuple[str, str]) -> tuple[str, frozenset[tuple[str, str]]]:
        """The text of a definition, and what it refers to; nothing of what the room does not define."""
        here, name = place
        defined, imported = scopes.get(here, ({}, {}))
        nodes = defined.get(name, [])
        names = frozenset(other for node in nodes for other in _names(node, here, imported))
        return said_by(nodes), names

    found = {}
    for module in sources.proofs:
        for theorem in module.theorems:
            parts: dict[tuple[str, str], str] = {}
            waiting = [(module.name, theorem.name)]
            while waiting:
                text, names = read(place := waiting.pop())
                if text:
                    parts[place] = text
                    waiting += [other for other in names if other not in parts]
            found[theorem.name] = "\n".join(f"{key}\n{parts[key]}" for key in sorted(parts))
    return dict(sorted(found.items()))


Scope = tuple[dict[str, list[ast.stmt]], dict[str, tuple[str, str]]]
"""Of a module: the statements that define each name, and what each imported name is in the room."""


def _scope(module: PythonModule, room: str) -> Scope:
    defined: dict[str, list[ast.stmt]] = {}
    imported: dict[str, tuple[str, str]] = {}
    for node in module.tree.body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(room):
            inner = (node.module or "").removeprefix(room).removeprefix(".")
            for alias in node.names:
                place = (inner, alias.name) if inner else (alias.name, "")
                imported[alias.asname or alias.name] = place
            continue
        names = [node.name] if isinstance(node, ast.FunctionDef | ast.ClassDef) else _targets(node)
        for name in names:
            defined.setdefault(name, []).append(node)
    return defined, imported


def _targets(node: ast.stmt) -> list[str]:
    """Names that a statement of the module gives a value, inside a loop or a condition too."""
    stored = (part for part in ast.walk(node) if isinstance(part, ast.Name))
    return [] if isinstance(node, ast.Import) else [n.id for n in stored if isinstance(n.ctx, ast.Store)]


def _names(node: ast.stmt, here: str, imported: dict[str, tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """What a statement refers to: names of its own module, and imported ones of the room."""
    for part in ast.walk(node):
        if isinstance(part, ast.Attribute) and isinstance(part.value, ast.Name):
            module, name = imported.get(part.value.id, ("", "?"))
            if not name:
                yield module, part.attr
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load):
            yield imported.get(part.id, (here, part.id))

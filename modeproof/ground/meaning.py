"""What "changed" means, everywhere: the meaning of a file, and of all files that a result depends on.

The meaning of a file is a hash of what a program reads in it. Comments, docstrings and layout do not count.
Where that is not certain the bytes count: a result that is judged once more costs time, one that is kept
wrongly costs trust.
"""

from __future__ import annotations

import ast
import gc
import gzip
import hashlib
import json
import os
import re
import tomllib
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.ground.comments import split
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import within

SPOKEN = "theorem"
"""The docstring of a function with this decorator is the sentence that it proves, so it counts."""
_HEADER = re.compile(r"-{4,}[ \t]*MODULE\b")
_END = re.compile(r"^={4,}", re.MULTILINE)
_CFG_TOKEN = re.compile(r'"[^"\n]*"?|[^\s"]+')
_WORD = re.compile(r"\w+")
_DOTTED = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+")
_FILE = re.compile(r"[\w.-]+(?:/[\w.-]+)+\.(?:py|tla|cfg|toml|json)")
_BY_NAME = frozenset({"import_module", "__import__", "module_named", "-m"})
"""Where one of these is called or given, any string of the file may be the name of a module that it needs."""
_ERRORS = (OSError, EOFError, ValueError, SyntaxError, RecursionError, MemoryError, zlib.error)
"""What the readers below may raise for a file that is damaged."""


@dataclass(frozen=True)
class _Read:
    """What was read in a file: its meaning, and the names of what it may use.

    `names` are, for Python, dotted names of modules and paths of files; for TLA+ words.
    """

    digest: str
    names: frozenset[str] = frozenset()


_known: dict[tuple[str, bytes], _Read] = {}
"""By kind and SHA-256 of its bytes, what was read in a file: the same bytes are read once a process."""


def meaning(path: Path) -> str:
    """The meaning of a file, as 64 hexadecimal digits. Raises Unjudged when it cannot be read.

    Python, TLA+, cfg, TOML, JSON and packed lines are read; of any other file, and of one that is damaged, it
    is the SHA-256 of its bytes.
    """
    return _read(path.name, _bytes(path)).digest


def meaning_of(name: str, content: bytes) -> str:
    """The meaning of a file of this name with this content."""
    return _read(name, content).digest


def meanings(root: Path, paths: Iterable[Path]) -> dict[str, str]:
    """The meaning of each file, by its path relative to the root, in the order of the paths.

    Raises Unjudged when a file cannot be read or lies outside the root.
    """
    found: dict[str, str] = {}
    for path in paths:
        try:
            name = within(root, path)
        except ValueError:
            raise Unjudged(f"{path}: lies outside {root}") from None
        found[name] = meaning(path)
    return dict(sorted(found.items()))


def reached(root: Path, *entries: Path | str) -> tuple[Path, ...]:
    """All files below the root that these files need, themselves included, in the order of their paths.

    An entry is a file, a folder (all modules directly in it), or the dotted name of a module or package. A
    Python module needs what it imports anywhere in it, by a string too, and each file whose path from the
    root is one of its strings; a TLA+ module needs the modules beside it and in spec/common whose names are
    in it. What is loaded by a name put
    together at run time is an entry of its own. Raises Unjudged for an entry that is not there.
    """
    waiting = [path for entry in entries for path in _entry(root, entry)]
    found: dict[Path, None] = {}
    resolved: dict[str, tuple[Path, ...]] = {}
    with _without_collection():
        while waiting:
            path = waiting.pop()
            if path in found:
                continue
            found[path] = None
            names = _read(path.name, _bytes(path)).names
            if path.suffix == ".tla":
                waiting += _modules_beside(root, path, names)
            elif path.suffix == ".py":
                waiting += [root / name for name in names if "/" in name and (root / name).is_file()]
                for name in (_absolute(root, path, name) for name in names if "/" not in name):
                    if name not in resolved:
                        resolved[name] = tuple(_module(root, name))
                    waiting += resolved[name]
    return tuple(sorted(found))


def is_there(root: Path, name: str) -> bool:
    """Whether a file of this path, or a module or package of this dotted name, lies below the root."""
    place = root.joinpath(*name.split("."))
    return (
        (root / name).is_file()
        or place.with_name(f"{place.name}.py").is_file()
        or (place / "__init__.py").is_file()
    )


@dataclass(frozen=True)
class Key:
    """What a result depends on: `files` by path relative to the root, with their meanings; `tools` by name,
    with a version or hash; `said`: whatever else decides, such as the row of a run.
    """

    files: Mapping[str, str]
    tools: Mapping[str, str]
    said: str = ""

    @property
    def digest(self) -> str:
        """One hash of it all: the same where nothing that the result depends on has changed."""
        return _sha256(repr((sorted(self.files.items()), sorted(self.tools.items()), self.said)))


def key(
    root: Path,
    code: Iterable[Path | str] = (),
    data: Iterable[Path] = (),
    tools: Mapping[str, str] | None = None,
    said: str = "",
) -> Key:
    """The key of a result: the modules that judge it with all that they need, data files, and tools.

    Raises Unjudged as `reached` and `meanings` do.
    """
    return Key(meanings(root, [*reached(root, *code), *data]), dict(tools or {}), said)


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None


def _read(name: str, content: bytes) -> _Read:
    kind = name[name.index(".", 1) :] if "." in name[1:] else ""
    reader = next((reader for end, reader in _READERS.items() if kind.endswith(end)), None)
    digest = hashlib.sha256(content)
    if reader is None:
        return _Read(digest.hexdigest())
    known = kind, digest.digest()
    if known not in _known:
        try:
            said, names = reader(content)
            _known[known] = _Read(_sha256(f"{kind}\n{said}"), names)
        except _ERRORS:
            _known[known] = _Read(digest.hexdigest())
    return _known[known]


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _python(content: bytes) -> tuple[str, frozenset[str]]:
    said: list[str] = []
    names: set[str] = set()
    strings: set[str] = set()
    with _without_collection():
        _say(ast.parse(content), said, names, strings)
    names |= set(filter(_FILE.fullmatch, strings))
    if _BY_NAME & strings:
        names |= set(filter(_DOTTED.fullmatch, strings))
    return "".join(said), frozenset(names)


def said_by(nodes: Iterable[ast.AST]) -> str:
    """What statements of a module say: the same text where nothing but comments, docstrings or layout of them
    has changed.
    """
    said: list[str] = []
    for node in nodes:
        _say(node, said, set(), set())
    return "".join(said)


def _say(node: Any, said: list[str], names: set[str], strings: set[str]) -> None:
    """Add what a part of a syntax tree says, in a form that is the same in all versions of Python."""
    kind = node.__class__
    if kind is list:
        said.append("[")
        for one in node:
            if not _is_docstring(one):
                _say(one, said, names, strings)
        said.append("]")
    elif not isinstance(node, ast.AST):
        said.append(f"{node!r},")
        if kind is str:
            strings.add(node)
    else:
        said.append(f"{kind.__name__}(")
        for field in kind._fields:
            value = getattr(node, field, None)
            if value is not None and value != [] and field != "kind":
                said.append(f"{field}=")
                _say(value, said, names, strings)
        said.append(")")
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            stem = "." * node.level + (node.module or "")
            names.add(stem)
            names.update(f"{stem}{'' if stem.endswith('.') else '.'}{alias.name}" for alias in node.names)
        elif isinstance(node, ast.FunctionDef) and _spoken(node):
            said.append(repr(ast.get_docstring(node)))


def _is_docstring(node: Any) -> bool:
    return node.__class__ is ast.Expr and isinstance(getattr(node.value, "value", None), str)


def _spoken(node: ast.FunctionDef) -> bool:
    targets = (one.func if isinstance(one, ast.Call) else one for one in node.decorator_list)
    return any(SPOKEN in (getattr(one, "id", ""), getattr(one, "attr", "")) for one in targets)


def _tla(content: bytes) -> tuple[str, frozenset[str]]:
    """The lines of the module without comments; blanks at their beginnings count, for lists rest on them."""
    text = content.decode("utf-8")
    header = _HEADER.search(text)
    if not header:
        raise ValueError("no module")
    code, bare, _ = split(text[header.start() :])
    end = _END.search(bare)
    if end and len(_HEADER.findall(bare)) == 1:  # a module within a module ends before the outer one
        code, bare = code[: end.end()], bare[: end.end()]
    lines = (line.rstrip() for line in code.split("\n"))
    return "\n".join(line for line in lines if line), frozenset(_WORD.findall(bare))


def _cfg(content: bytes) -> tuple[str, frozenset[str]]:
    return repr(_CFG_TOKEN.findall(split(content.decode("utf-8"))[0])), frozenset()


def _toml(content: bytes) -> tuple[str, frozenset[str]]:
    """The value; the order of the keys counts, since a program may go through them in it."""
    return repr(tomllib.loads(content.decode("utf-8"))), frozenset()


def _json(content: bytes) -> tuple[str, frozenset[str]]:
    return repr(json.loads(content)), frozenset()


def _json_lines(content: bytes) -> tuple[str, frozenset[str]]:
    return repr([json.loads(line) for line in content.split(b"\n") if line.strip()]), frozenset()


def _packed_lines(content: bytes) -> tuple[str, frozenset[str]]:
    return hashlib.sha256(gzip.decompress(content)).hexdigest(), frozenset()


_READERS = {
    ".py": _python,
    ".tla": _tla,
    ".cfg": _cfg,
    ".toml": _toml,
    ".json": _json,
    ".jsonl": _json_lines,
    ".jsonl.gz": _packed_lines,
}


def _entry(root: Path, entry: Path | str) -> Iterator[Path]:
    path = root / entry
    found = [path] if path.is_file() else sorted(path.glob("*.py")) if path.is_dir() else []
    if not found and isinstance(entry, str):
        found = list(_module(root, entry)) if is_there(root, entry) else []
    if not found or not path.is_relative_to(root):
        raise Unjudged(f"{entry}: no such file, folder or module below {root}")
    yield from found


def _absolute(root: Path, path: Path, name: str) -> str:
    """The dotted name of what a module at this path calls by a name that may begin with dots."""
    bare = name.lstrip(".")
    if bare == name:
        return name
    folder = path.parent.relative_to(root)
    parts = folder.parts[: len(folder.parts) - (len(name) - len(bare) - 1)]
    return ".".join((*parts, bare) if bare else parts)


def _module(root: Path, name: str) -> Iterator[Path]:
    """The files of a module and of the packages that hold it; a name in a module gives that module."""
    place = str(root)
    for part in name.split("."):
        place = f"{place}/{part}"
        for file in (f"{place}.py", f"{place}/__init__.py"):
            if os.path.isfile(file):
                yield Path(file)


def _modules_beside(root: Path, path: Path, words: frozenset[str]) -> Iterator[Path]:
    for folder in (path.parent, root / "spec" / "common"):
        yield from (module for module in folder.glob("*.tla") if module.stem in words)


@contextmanager
def _without_collection() -> Iterator[None]:
    """Large trees of small objects are made here: searching them for cycles would take half of the time."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()

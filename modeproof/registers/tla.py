"""Reads TLA+ modules as text: definitions, the comments that belong to them, and the names they use.

Not a parser. It knows comments, strings, and what begins in column 0; that is enough for citations and
names, and SANY judges the rest.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from modeproof.ground.comments import split
from modeproof.registers.files import read_text, shown

WORD = re.compile(r"[A-Za-z_]\w*")
DEFINITION = re.compile(r"^(?:LOCAL\s+)?([A-Za-z_]\w*)\s*(?:\([^=]*?\)|\[[^=]*?\])?\s*==(?!=)", re.MULTILINE)
OTHER_START = re.compile(
    r"^(?:(?:CONSTANTS?|VARIABLES?|ASSUME|ASSUMPTION|AXIOM|THEOREM|LEMMA|COROLLARY|PROPOSITION|INSTANCE|EXTENDS|"
    r"RECURSIVE|LOCAL\s+INSTANCE)\b|----|====)",
    re.MULTILINE,
)
DECLARATION = re.compile(r"^(CONSTANTS?|VARIABLES?)\b", re.MULTILINE)
EXTENDS = re.compile(r"^EXTENDS\b((?:\s*\w+\s*,)*\s*\w+)", re.MULTILINE)
INSTANCE = re.compile(r"\bINSTANCE\s+([A-Za-z_]\w*)")
END = re.compile(r"^={4,}", re.MULTILINE)
MODULE = re.compile(r"^-{4,}\s*MODULE\s+(\w+)\s*-{4,}", re.MULTILINE)


@dataclass(frozen=True)
class Definition:
    """One definition of column 0, with its line and the text of the comments that belong to it.

    `body` is its text without comments.
    """

    name: str
    line: int
    comment: str
    body: str = ""

    @property
    def local(self) -> bool:
        """Whether only its own module sees it."""
        return self.body.startswith("LOCAL")

    @property
    def parameters(self) -> str:
        """Its parameters as they are after its name, in parentheses; "" where it has none."""
        return " ".join(self.body.partition("==")[0].partition(self.name)[2].split())


@dataclass(frozen=True)
class Module:
    """One module. `strings` are its string literals, `words` its identifiers outside comments.

    `stray` are the comments that belong to no definition, such as the box on top.
    """

    name: str
    file: str
    definitions: tuple[Definition, ...]
    constants: frozenset[str]
    variables: frozenset[str]
    extends: tuple[str, ...]
    instances: tuple[str, ...]
    strings: frozenset[str]
    words: frozenset[str]
    stray: str

    @property
    def defined(self) -> frozenset[str]:
        """The names of its definitions."""
        return frozenset(definition.name for definition in self.definitions)


def read_modules(root: Path, document: str) -> dict[str, Module]:
    """All modules of the document's folder and of spec/common, by name."""
    found: dict[str, Module] = {}
    for folder in (root / "spec" / "common", root / "spec" / document):
        for path in sorted(folder.glob("*.tla")):
            module = scan(read_text(root, path), path.stem, shown(root, path))
            found[module.name] = module
    return found


def closure(modules: Mapping[str, Module], name: str, instances: bool = True) -> tuple[Module, ...]:
    """The module and all that it extends or (`instances`) instantiates, as far as they are ours."""
    reached: dict[str, Module] = {}
    waiting = [name]
    while waiting:
        module_name = waiting.pop()
        if module_name in modules and module_name not in reached:
            found = reached[module_name] = modules[module_name]
            waiting += [*found.extends, *(found.instances if instances else ())]
    return tuple(reached.values())


@cache
def scan(text: str, name: str, file: str) -> Module:
    """Read one module; what is before its header or after its end is not part of it."""
    code, bare, comments = split(text)
    header = MODULE.search(bare)
    body_start = header.end() if header else 0
    last = END.search(bare, body_start)
    if last:
        text, code, bare = text[: last.end()], code[: last.end()], bare[: last.end()]
    comments = [(begin, stop) for begin, stop in comments if begin < len(text)]
    spans = _spans(bare, body_start)
    owned: dict[int, list[str]] = {n: [] for n in range(len(spans))}
    stray: list[str] = []
    before = _blocks_before(text, bare, comments, [start for _, start, _ in spans])
    for begin, end in comments:
        owner = _owner(begin, end, spans, before)
        (stray if owner is None else owned[owner]).append(text[begin:end])
    definitions = tuple(
        Definition(label, text.count("\n", 0, start) + 1, "\n".join(owned[n]), code[start:end])
        for n, (label, start, end) in enumerate(spans)
    )
    extends = tuple(word for match in EXTENDS.finditer(bare) for word in WORD.findall(match.group(1)))
    return Module(
        name=header.group(1) if header else name,
        file=file,
        definitions=definitions,
        constants=_declared(bare, "CONSTANT"),
        variables=_declared(bare, "VARIABLE"),
        extends=extends,
        instances=tuple(INSTANCE.findall(bare)),
        strings=frozenset(re.findall(r'"((?:[^"\\]|\\.)*)"', code)),
        words=frozenset(WORD.findall(bare)),
        stray="\n".join(stray),
    )


def _spans(bare: str, body_start: int) -> list[tuple[str, int, int]]:
    """Each definition with its start and the end of the line of its last code."""
    starts = [(match.start(), match.group(1)) for match in DEFINITION.finditer(bare, body_start)]
    others = [match.start() for match in OTHER_START.finditer(bare, body_start)]
    marks = sorted([*(start for start, _ in starts), *others, len(bare)])
    spans = []
    for start, label in starts:
        stop = next(mark for mark in marks if mark > start)
        last = start + len(bare[start:stop].rstrip())
        newline = bare.find("\n", last)
        spans.append((label, start, len(bare) if newline < 0 else newline))
    return spans


def _blocks_before(text: str, bare: str, comments: list[tuple[int, int]], starts: list[int]) -> list[int]:
    """For each definition the position where the comment block directly before it begins."""
    code_lines = bare.split("\n")
    commented: set[int] = set()
    for begin, end in comments:
        commented.update(range(text.count("\n", 0, begin), text.count("\n", 0, end) + 1))
    offsets = [0]
    for line in code_lines:
        offsets.append(offsets[-1] + len(line) + 1)
    begins = []
    for start in starts:
        first = text.count("\n", 0, start)
        while first - 1 in commented and not code_lines[first - 1].strip():
            first -= 1
        begins.append(offsets[first])
    return begins


def _owner(begin: int, end: int, spans: list[tuple[str, int, int]], before: list[int]) -> int | None:
    """The definition that a comment belongs to: it follows directly, or the comment lies in its lines."""
    for n, (_, start, _) in enumerate(spans):
        if before[n] <= begin and end <= start:
            return n
    for n, (_, start, last) in enumerate(spans):
        if start <= begin < last:
            return n
    return None


def _declared(bare: str, keyword: str) -> frozenset[str]:
    """The names that CONSTANT(S) or VARIABLE(S) declare."""
    marks = sorted(
        [match.start() for match in OTHER_START.finditer(bare)]
        + [match.start() for match in DEFINITION.finditer(bare)]
        + [len(bare)]
    )
    names: set[str] = set()
    for match in DECLARATION.finditer(bare):
        if match.group(1).startswith(keyword):
            stop = next(mark for mark in marks if mark > match.start())
            listed = re.sub(r"\([^)]*\)", " ", bare[match.end() : stop])
            names.update(part.split()[0] for part in listed.split(",") if part.split())
    return frozenset(names)

"""What has a name in this project, and where it is declared: read from the registers and from docs/."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from modeproof.ground.places import documents, machines
from modeproof.registers.files import read_text, read_toml, shown
from modeproof.registers.load import load_document
from modeproof.registers.python_source import scan_python
from modeproof.registers.rows import Device, Document

WORDS_FILE = "docs/report.toml"
VERDICTS_FILE = "docs/reference.md"
_THEOREM = re.compile(r"^@theorem\(.*?^def (\w+)\(", re.MULTILINE | re.DOTALL)
_VERDICT = re.compile(r"^- \*\*([A-Z][^*]*)\*\*\n  - meaning: (.*(?:\n    .*)*)", re.MULTILINE)


@dataclass(frozen=True)
class Thing:
    """One thing with a name. `row` is what its register says of it.

    `of` is the device of a signal, step or state. Its line is the first that declares `mark` after the text
    `after`; `line` is 0 until it is looked for, and where there is none.
    """

    kind: str
    id: str
    file: str
    row: Any
    document: Document | None = None
    of: Device | None = None
    mark: str = ""
    after: str = ""
    line: int = 0

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.file}:{self.line}" if self.line else self.file

    @property
    def name(self) -> str:
        """Its name across documents."""
        return f"{self.document.name}/{self.id}" if self.document else self.id


def bare(word: str) -> str:
    """A name as it is compared: in any case, a code without the mark of its base."""
    return re.sub(r"^(?:w#)?(?:16#|0x)", "", word.strip().casefold())


def find(root: Path, word: str) -> list[Thing]:
    """All that has this name, in any case; `DOCUMENT/NAME` is that of one document. Raises Unjudged."""
    of, _, name = word.rpartition("/")
    wanted = bare(name)
    found = [thing for thing in _all(root, wanted) if bare(thing.id) == wanted]
    exact = [thing for thing in found if thing.id == name]
    chosen = [thing for thing in exact or found if not of or (thing.document and thing.document.name == of)]
    texts = {file: read_text(root, root / file) for file in {thing.file for thing in chosen}}
    return [
        replace(thing, line=thing.line or line_of(texts[thing.file], thing.mark or thing.id, thing.after))
        for thing in chosen
    ]


def names(root: Path) -> list[str]:
    """Every name that `find` knows."""
    return list(dict.fromkeys(thing.id for thing in _all(root, "")))


def _all(root: Path, part: str) -> Iterator[Thing]:
    """Everything in the documents whose text has this part."""
    yield from _verdicts(root)
    yield from _terms(root)
    for name in documents(root):
        texts = (read_text(root, path) for path in (root / "spec" / name).glob("*.toml"))
        if part in name or any(part in text.casefold() for text in texts):
            yield from _declared(_loaded(root, name))
        yield from _theorems(root, name, part)
    for name in machines(root):
        file = f"spec/{name}/safety.toml"
        if part in read_text(root, root / file).casefold():
            for row in read_toml(root, root / file).get("property", ()):
                yield Thing("property of the machine", str(row["id"]), file, row)


_loaded = cache(load_document)


def _declared(document: Document) -> Iterator[Thing]:
    def thing(
        kind: str, id: str, register: str, row: Any, of: Device | None = None, after: str = ""
    ) -> Thing:
        return Thing(kind, id, document.source(register), row, document, of, after=after)

    yield Thing("document", document.name, document.source("clauses"), document.about, document, mark="paper")
    for kind, register, rows in (
        ("clause", "clauses", document.clauses),
        ("finding", "findings", document.findings),
        ("assumption", "assumptions", document.assumptions),
        ("fault from outside", "assumptions", document.faults),
        ("property", "properties", document.properties),
        ("response time", "properties", document.responses.rows),
        ("chain of response times", "properties", document.responses.chains),
        ("run", "runs", document.runs),
    ):
        for row in rows:
            yield thing(kind, row.id, register, row)
    for finding in document.findings:
        for reading in finding.tries:
            yield thing("reading", reading, "findings", finding, after=finding.id)
    for device in document.interface.devices.values():
        at = f"[devices.{device.id}"
        yield thing("target" if device.published else "device", device.id, "interface", device)
        for kind, group in (
            ("input", device.inputs),
            ("output", device.outputs),
            ("parameter", device.parameters),
            ("memory", device.memory),
        ):
            part = f"{at}.{kind if kind == 'memory' else f'{kind}s'}]"
            for name, signal in group.items():
                yield thing(kind, name, "interface", signal, device, part)
        for kind, listed in (("state", device.states), ("step", device.steps)):
            for name in listed:
                yield thing(kind, name, "interface", None, device, f"{at}]")
        for state, code in device.codes.items():
            one = thing("diagnostic code", code, "interface", state, device, f"{at}.codes]")
            yield replace(one, mark=state)


def _theorems(root: Path, name: str, part: str) -> Iterator[Thing]:
    """The theorems of a document; the modules in which one has this name are read as Python."""
    for path in sorted((root / "proofs" / name).glob("*.py")):
        text, file = read_text(root, path), shown(root, path)
        listed = _THEOREM.findall(text)
        if not part:
            yield from (Thing("theorem", id, file, None) for id in listed)
        elif part in (one.casefold() for one in listed):
            document = _loaded(root, name)
            for theorem in scan_python(text, path.stem, file).theorems:
                yield Thing("theorem", theorem.name, file, theorem, document, line=theorem.line)


def _verdicts(root: Path) -> Iterator[Thing]:
    text = read_text(root, root / VERDICTS_FILE)
    for match in _VERDICT.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        for word in match[1].split(", "):
            if word.isupper():
                yield Thing("verdict", word, VERDICTS_FILE, " ".join(match[2].split()), line=line)


def _terms(root: Path) -> Iterator[Thing]:
    for row in read_toml(root, root / WORDS_FILE).get("term", ()):
        for word in (row["word"], *row.get("forms", ())):
            yield Thing("word of the field", word, WORDS_FILE, row, mark=row["word"])


def line_of(text: str, id: str, after: str = "") -> int:
    """The line in which a register declares an id, after the first place that says `after`; 0: in none."""
    name = re.escape(id)
    begin = max(text.find(after), 0)
    for form in (
        rf'^\[+(?:[\w-]+\.)*"?{name}"?\]',
        rf'^(?:id|word) = "{name}"',
        rf'^"?{name}"? *=',
        rf'"{name}"',
    ):
        if match := re.compile(form, re.MULTILINE).search(text, begin):
            return text.count("\n", 0, match.start()) + 1
    return 0


def lines_with(root: Path, folders: Sequence[str], id: str, suffix: str) -> Iterator[tuple[Path, str]]:
    """The files directly in these folders whose text has an id, with their texts."""
    form = re.compile(rf"(?<![\w-]){re.escape(id)}(?![\w-])")
    for folder in folders:
        for path in sorted((root / folder).glob(f"*{suffix}")):
            text = read_text(root, path)
            if form.search(text):
                yield path, text

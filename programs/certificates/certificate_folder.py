"""The folder of a certificate: certificate.json, and the questions as SMT-LIB, one file for each part.

What is stored is never believed: to recheck is to make the questions anew from the sources and from what the
record gives, and to compare.
"""

from __future__ import annotations

import hashlib
import json
import platform
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import z3

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.files import write_json, write_text
from programs.certificates.smt_lib import Printer

NAME: Final = "certificate.json"
VERSION: Final = 1
TOOLS: Final = ("z3-solver", "cvc5", "tree-sitter", "tree-sitter-iec61131-3-st")


@dataclass(frozen=True)
class Obligation:
    """One file of a certificate: its name, its text, and how many questions it asks; each must be `unsat`."""

    file: str
    text: str
    count: int


def obligation(
    printer: Printer,
    number: int,
    name: str,
    sentence: str,
    known: Mapping[str, z3.BoolRef],
    asked: Mapping[str, z3.BoolRef],
) -> Obligation:
    """The file with this number and name; what it asks is asked under what is known."""
    words = re.findall("[A-Za-z0-9]+", name.replace(" -", " minus "))
    comments = [sentence, f"Expected: unsat, {len(asked)} times"]
    file = f"{number:03d}-{'-'.join(words)}.smt2"
    return Obligation(file, printer.questions(comments, known, asked), len(asked))


def digest(path: Path) -> str:
    """The SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def digest_of(text: str) -> str:
    """The SHA-256 of a text."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def tools() -> dict[str, str]:
    """Versions of what made a certificate."""
    return {"python": platform.python_version(), **{name: version(name) for name in TOOLS}}


def reference_files(document: str) -> dict[str, str]:
    """The SHA-256 of every file that says what the reference implementation does."""
    place = root()
    found = [
        *sorted((place / "refimpl").glob("*.py")),
        *sorted((place / "refimpl" / document).glob("*.py")),
        place / "spec" / document / "interface.toml",
        place / "proofs" / document / "devices.py",
    ]
    return {str(path.relative_to(place)): digest(path) for path in found}


def empty(folder: Path) -> None:
    """Make the folder, or take an older certificate out of it. Raises Unjudged: it holds something else."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        there = list(folder.iterdir())
        if there and not (folder / NAME).is_file():
            raise Unjudged(f"{folder}: holds files that are no certificate; name another folder")
        for path in there:
            if path.suffix == ".smt2" or path.name == NAME:
                path.unlink()
    except OSError as error:
        raise Unjudged(f"{folder}: cannot be written: {error.strerror or error}") from None


def fill(folder: Path, record: Mapping[str, Any], texts: Mapping[str, str]) -> None:
    """Write the questions, and the record last. Raises Unjudged; then nothing is left of them."""
    said = {**record, "queries": {name: digest_of(text) for name, text in texts.items()}}
    try:
        for name, text in texts.items():
            write_text(folder / name, text)
        write_json(folder / NAME, said)
    except BaseException:  # half a certificate is none
        for name in texts:
            (folder / name).unlink(missing_ok=True)
        raise


def record_in(folder: Path, *formats: str) -> dict[str, Any]:
    """The record of a certificate in one of these formats. Raises Unjudged."""
    path = folder / NAME
    try:
        record = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise Unjudged(f"{path}: no JSON: {error}") from None
    if (
        not isinstance(record, dict)
        or record.get("format") not in formats
        or record.get("version") != VERSION
    ):
        raise Unjudged(f"{path}: no certificate of a program, version {VERSION}")
    return dict(record)


@dataclass(frozen=True)
class Stored:
    """A certificate as it was read."""

    folder: Path
    record: Mapping[str, Any]

    def files(self, *names: str) -> list[Path]:
        """The files of these tables. Raises Unjudged: one of them has changed or is gone."""
        found = []
        for name, known in [row for table in names for row in self.table(table).items()]:
            path = next((path for path in (Path(name), root() / name) if path.is_file()), None)
            if path is None:
                raise self.refuse(f"{name} is not there; run it in the folder in which the proof was made")
            if digest(path) != known:
                raise self.refuse(f"{name} has changed since; prove the program again")
            found.append(path)
        return found

    def table(self, name: str) -> dict[str, Any]:
        """A table of the record. Raises Unjudged."""
        found = self.record.get(name)
        if not isinstance(found, dict):
            raise self.refuse(f"{name} is not there")
        return found

    def refuse(self, text: str) -> Unjudged:
        """The refusal of this certificate, in one line."""
        return Unjudged(f"{self.folder / NAME}: {text}")

    def same(self, name: str, now: Mapping[str, str]) -> None:
        """Refuse a table of files whose hashes are not those of today. Raises Unjudged."""
        given = self.table(name)
        for file in {**now, **given}:
            if given.get(file) != now.get(file):
                raise self.refuse(f"{file} has changed since; prove the program again")

    def claims(self, claim: Mapping[str, Any]) -> None:
        """Refuse a claim that is not the one that the sources give; tools may be others. Raises Unjudged."""
        for key, value in json.loads(json.dumps(claim)).items():
            if key != "tools" and self.record.get(key) != value:
                raise self.refuse(
                    f"{key} is not what the sources and the binding give; prove the program again"
                )

    def compare(self, texts: Mapping[str, str]) -> None:
        """Refuse a set of queries that is not the one that follows from the program. Raises Unjudged."""
        stored = sorted(path.name for path in self.folder.glob("*.smt2"))
        if stored != sorted(texts) or sorted(self.table("queries")) != sorted(texts):
            odd = sorted(set(stored) ^ set(texts)) or ["the list in it"]
            raise self.refuse(f"the queries are not those that follow from the program: {odd[0]}")
        for name, text in texts.items():
            kept = (self.folder / name).read_bytes()
            if kept != text.encode("utf-8") or self.table("queries")[name] != digest_of(text):
                raise Unjudged(f"{self.folder / name}: not the obligation that follows from the program")

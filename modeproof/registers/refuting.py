"""What refutes each theorem: the table `refuted` of proofs/<document>/strength.toml.

A theorem that no fault of the code could refute says nothing. So each is refuted by one edit of the code, or
a row says why none can (`[by_construction]`). `modeproof renew` judges the edits and writes a stamp for each
to pins.toml: a hash of the edit, the definitions that it edits, and the texts of the theorems.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.meaning import said_by
from modeproof.registers.citations import Sources
from modeproof.registers.edits import applied, check_stamps
from modeproof.registers.files import read_text, read_toml
from modeproof.registers.pins import digest, proved_texts
from modeproof.registers.rows import Document, Problem
from modeproof.registers.typed import Entry, SomeNames, Text, typed


class Edit(Entry, frozen=True, kw_only=True):
    """One edit of the code: in the file `in` the text `old`, which is there once, becomes `new`; and the
    theorems that it refutes.
    """

    file: Text = msgspec.field(name="in")
    old: Text
    new: str
    theorems: SomeNames


@dataclass(frozen=True)
class Refuting:
    """The rows of a document: edits by their names, and theorems that no edit refutes, with the reason."""

    edits: Mapping[str, Edit]
    by_construction: Mapping[str, str]


def load_refuting(root: Path, document: str) -> Refuting:
    """The rows of a document; none where it has no such file. Raises Unjudged for what is not understood."""
    file = f"proofs/{document}/strength.toml"
    data = read_toml(root, root / file) if (root / file).is_file() else {}
    edits = typed(dict[str, Edit], data.get("refuted", {}), f"{file}: [refuted]")
    reasons = typed(dict[str, Text], data.get("by_construction", {}), f"{file}: [by_construction]")
    return Refuting(edits, reasons)


def check_refuting(document: Document, sources: Sources) -> list[Problem]:
    """Every theorem that nothing refutes, and every row that is of no use or not judged."""
    file = f"proofs/{document.name}/strength.toml"
    refuting = load_refuting(document.root, document.name)
    there = {theorem.name: module.file for module in sources.proofs for theorem in module.theorems}
    refuted = {name for edit in refuting.edits.values() for name in edit.theorems}
    problems: list[Problem] = []
    for name, place in there.items():
        if name in refuted and name in refuting.by_construction:
            problems.append(Problem(file, name, "is no theorem by construction: an edit refutes it"))
        if name not in refuted and name not in refuting.by_construction:
            text = f"is refuted by nothing: give it an edit of the code in {file}, or say why none can be"
            problems.append(Problem(place, name, text))
    for name in (refuted | refuting.by_construction.keys()) - there.keys():
        problems.append(Problem(file, name, f"unknown theorem; {suggestion(name, there)}"))
    stamps = stamps_of(document, sources, refuting)
    return [*problems, *check_stamps(document, "refuted", file, stamps, "refuted.")]


def edited(root: Path, document: str, edit: Edit) -> str:
    """The whole text of the file with the edit. Raises Unjudged as `_edit`."""
    return _edit(root, document, edit)[0]


def _edit(root: Path, document: str, edit: Edit) -> tuple[str, list[ast.stmt]]:
    """The text with the edit, and the statements of the module that it changes.

    Raises Unjudged: a file that is no code of the document; what `applied` refuses.
    """
    room = edit.file.rpartition("/")[0]
    if room not in (f"refimpl/{document}", f"proofs/{document}", "refimpl") or not edit.file.endswith(".py"):
        raise Unjudged(
            f"edits {edit.file}, which is no module of refimpl/{document}, refimpl or proofs/{document}"
        )
    text = read_text(root, root / edit.file)
    changed, first, last = applied(text, edit.file, edit.old, edit.new)
    nodes = ast.parse(text).body
    return changed, [one for one in nodes if one.lineno <= last and (one.end_lineno or one.lineno) >= first]


def stamps_of(document: Document, sources: Sources, refuting: Refuting) -> dict[str, str | Unjudged]:
    """For each edit a hash of what its judgement rests on, or why it cannot be judged.

    Another change of the code does not move it: the tests judge some edits again, and `--complete` all.
    """
    said = proved_texts(document, sources)
    found: dict[str, str | Unjudged] = {}
    for name, edit in refuting.edits.items():
        try:
            touched = _edit(document.root, document.name, edit)[1]
            theorems = {one.name for one in touched if isinstance(one, ast.FunctionDef)} & {*edit.theorems}
            if theorems:
                raise Unjudged(f"edits the theorem {min(theorems)} and not the code")
            words = (edit.file, edit.old, edit.new, said_by(touched))
            found[name] = digest("\x00".join((*words, *(said.get(one, "") for one in edit.theorems))))
        except Unjudged as error:
            found[name] = error
    return found

"""The stamp under the rendered page of proofs, so that drift shows without proving anything.

It is the last line of the page: the SHA-256 (12 digits) of all theorems as their text gives them (name,
sentence, ids), and of the page's own text.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import asdict
from pathlib import Path

from modeproof.registers.citations import read_sources
from modeproof.registers.files import read_text
from modeproof.registers.pages import PROOFS, page_of
from modeproof.registers.python_source import PythonTheorem
from modeproof.registers.rows import Document, Problem

REMEDY = "run modeproof prove, modeproof prove --coverage and modeproof prove --render"
_STAMP = re.compile(r"<!-- rendered by modeproof prove: theorems (\w{12}), text (\w{12}) -->\n\Z")


def theorems_by_file(document: Document) -> dict[str, tuple[PythonTheorem, ...]]:
    """The theorems of a document by the file that they stand in, in the order of the text."""
    found = {module.file: module.theorems for module in read_sources(document).proofs}
    return {file: theorems for file, theorems in found.items() if theorems}


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:12]


def _theorems(document: Document) -> str:
    rows = [
        [document.name, file, {key: value for key, value in asdict(one).items() if key != "line"}]
        for file, theorems in theorems_by_file(document).items()
        for one in theorems
    ]
    return _digest(json.dumps(rows, sort_keys=True, ensure_ascii=False))


def stamped_proofs(document: Document, text: str) -> str:
    """The page with its stamp."""
    stamp = f"theorems {_theorems(document)}, text {_digest(text)}"
    return f"{text}\n<!-- rendered by modeproof prove: {stamp} -->\n"


def comparable(text: str) -> str:
    """The page without what is not the same twice: how long something took, and the digest of the text."""
    return re.sub(r"\| [\d,]+\.\d \|", "| s |", re.sub(r"text \w{12} -->", "text", text))


def proofs_page(document: str) -> str:
    """The path of a document's page."""
    return page_of(document, PROOFS)


def check_proofs_page(root: Path, document: Document) -> list[Problem]:
    """What has drifted between the theorems and their page; nothing where there is no page yet."""
    page = proofs_page(document.name)
    path = root / page
    if not path.is_file():
        return []
    text = read_text(root, path)
    match = _STAMP.search(text)
    if match is None:
        return [Problem(page, "", f"the page has no stamp; {REMEDY}")]
    problems = []
    if match.group(1) != _theorems(document):
        problems.append(Problem(page, "", f"the theorems have changed since the page was rendered; {REMEDY}"))
    if match.group(2) != _digest(text[: match.start() - 1]):
        problems.append(Problem(page, "", f"the page was changed by hand; {REMEDY}"))
    return problems

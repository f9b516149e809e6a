"""`modeproof report --verify`: are the report, and what it rests on, what they were when it was made?"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import OURS, YOURS, read
from modeproof.ground.evidence.record import other_tools, result_sha256
from modeproof.ground.places import build, located, within
from modeproof.report.baseline import NAME
from modeproof.report.integrity import json_of_page, seal_of_json, seal_of_page
from modeproof.report.sources import DIFFERS, HOLE, NOTE, few, hash_of

PAGE = "report.html"
_SCRIPT = r'<script type="application/json" id="{id}">(.*?)</script>'
AGAIN = "again"
"""The word for evidence that was made again and says the same."""


@dataclass(frozen=True)
class Difference:
    """One artefact that is not what the report says: it differs, is gone or new, or was made again with the
    same result; `status` as of troubles.
    """

    word: str
    path: str
    why: str
    status: int


@dataclass(frozen=True)
class Recheck:
    """What was compared: so many files, and what differs."""

    compared: int
    differences: tuple[Difference, ...]

    @property
    def status(self) -> int:
        """1 where something differs or is new, else 2 where something is gone, else 0."""
        return min(
            (difference.status for difference in self.differences if difference.status != NOTE), default=0
        )

    @property
    def again(self) -> int:
        """How many pieces of evidence were made again, with the same result."""
        return sum(difference.word == AGAIN for difference in self.differences)


def recheck(root: Path, file: Path) -> Recheck:
    """Recompute all hashes of a report, given its page or JSON; the other is compared when it is beside.

    Raises Unjudged when the file is not there or is no report.
    """
    page, record = file, file
    if file.suffix == ".json":
        page = file.with_name(PAGE)
    else:
        record = file.with_name(NAME)
    texts = {
        path: _text(path) for path in dict.fromkeys((file, page, record)) if path == file or path.exists()
    }
    found: list[Difference] = []
    listed: dict[Path, Mapping[str, str]] = {}
    results: Mapping[str, str] = {}
    for one, text in texts.items():
        seal = seal_of_json(text) if one.suffix == ".json" else seal_of_page(text)
        if seal is None:
            raise Unjudged(
                f"{one}: not a report of `modeproof report`, or damaged at its beginning: it has no seal"
            )
        if seal[0] != seal[1]:
            why = (
                f"its text was changed since it was written: SHA-256 {seal[1][:12]}, sealed as {seal[0][:12]}"
            )
            found.append(Difference("differs", str(one), why, DIFFERS))
        listed[one] = _hashes(one, text, "files")
        results = results or _hashes(one, text, "results")
    if page in texts and record in texts:
        sealed = seal_of_json(texts[record])
        if sealed is not None and json_of_page(texts[page]) != sealed[0]:
            why = f"does not belong to {record.name}: they are of two reports"
            found.append(Difference("differs", str(page), why, DIFFERS))
        found += _attachments(record, texts[record])
    files = listed[file]
    documents = _documents(file, texts[file])
    found += _compare(root, files, results, documents)
    found += _tools(root, "".join(texts.values()), documents)
    return Recheck(len(files), tuple(dict.fromkeys(found)))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def _hashes(path: Path, text: str, id: str) -> Mapping[str, str]:
    """The hashes that a report lists: of `files`, or of `results`. Raises Unjudged for a damaged list."""
    try:
        if path.suffix == ".json":
            found = json.loads(text)[id]
        else:
            name = "sources" if id == "files" else id
            match = re.search(_SCRIPT.format(id=name), text, re.DOTALL)
            found = json.loads(match.group(1)) if match else None
        return {str(name): str(digest) for name, digest in found.items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise Unjudged(f"{path}: damaged: its list of {id} cannot be read ({type(error).__name__})") from None


def _documents(path: Path, text: str) -> tuple[str, ...]:
    """The documents that a report is about; none: all."""
    if path.suffix == ".json":
        return tuple(json.loads(text).get("documents", ()))
    found = re.search(r'<meta name="modeproof-documents" content="([^"]*)">', text)
    return tuple(found.group(1).split()) if found else ()


def _attachments(record: Path, text: str) -> Iterator[Difference]:
    """Files beside the report; one that was not kept is no matter, for the page carries it."""
    listed = json.loads(text).get("attachments", {})
    for name, digest in sorted(listed.items()):
        now = _sha256(record.with_name(name))
        if now is not None and now != digest:
            yield Difference(
                "differs", str(record.with_name(name)), "was changed since it was written", DIFFERS
            )


def _compare(
    root: Path, files: Mapping[str, str], results: Mapping[str, str], documents: Sequence[str]
) -> Iterator[Difference]:
    """The listed files, and registers and evidence of these documents (none: of all) that are not listed.

    Evidence whose hash is another but whose result is the same was made again.
    """
    for path, digest in files.items():
        now = hash_of(root, path)
        if path.startswith(f"build/{YOURS}/"):
            if now != digest:
                yield Difference("yours", path, "your run, made again since or taken away", NOTE)
        elif now is None and path.startswith("build/") and not path.startswith("build/evidence/"):
            yield Difference("gone", path, "it was made, and is made again by what used it", NOTE)
        elif now is None:
            yield Difference("gone", path, f"the report has it as {digest[:12]}", HOLE)
        elif now != digest and (made := _made_again(located(root, path), results.get(path))):
            yield Difference(AGAIN, path, f"made again {made}: reproduced, same result", NOTE)
        elif now != digest:
            yield Difference(
                "differs", path, f"its hash is {now[:12]}, the report has {digest[:12]}", DIFFERS
            )
    for place, pattern in (build(root) / OURS, "*/*.json"), (root / "spec", "*/*.toml"):
        for one in sorted(place.glob(pattern)):
            name = within(root, one)
            if name not in files and (not documents or one.parent.name in documents):
                yield Difference("new", name, "the report does not know it", DIFFERS)


def _made_again(path: Path, result: str | None) -> str:
    """When a piece of evidence was made, if it has this result; else nothing."""
    with contextlib.suppress(Unjudged):
        record = read(path) if result is not None else {}
        if record and result_sha256(record) == result:
            return str(record["started"])
    return ""


def _tools(root: Path, text: str, documents: Sequence[str]) -> Iterator[Difference]:
    """The tools that made evidence of these documents (none: of all) and are not what they were, but for what
    the report says itself.
    """
    made: dict[str, list[str]] = {}
    for path in sorted(root.glob("build/evidence/*/*.json")):
        if documents and path.parent.name not in documents:
            continue
        with contextlib.suppress(Unjudged):  # a file that is damaged is not as the report has it
            for name in other_tools(root, read(path)):
                if f"{path.stem} ({name}" in text:
                    continue
                made.setdefault(name, []).append(f"{path.parent.name}/{path.stem}")
    for name, ids in made.items():
        why = f"was changed since it made the evidence of {few(ids)}"
        yield Difference("differs", name, why, DIFFERS)


def _sha256(path: Path) -> str | None:
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None

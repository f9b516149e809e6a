"""Writes and reads evidence files: build/evidence/<document>/<id>.json; of users' programs and logs below
build/yours/.

A file appears whole or not at all: it is written beside its place, flushed to the disk, then renamed.
"""

from __future__ import annotations

import gzip
import io
import json
from collections.abc import Iterable, Mapping, Set
from functools import cache
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.record import is_sealed, sealed
from modeproof.ground.places import build
from modeproof.kit import files


@cache
def _validator() -> Any:
    import jsonschema  # slow to load, and who only writes a file needs no schema

    schema = json.loads(Path(__file__).with_name("schema.json").read_text(encoding="utf-8"))
    return jsonschema.Draft202012Validator(schema)


def _check(record: Any, place: str) -> None:
    error = next(iter(sorted(_validator().iter_errors(record), key=lambda e: list(map(str, e.path)))), None)
    if error is not None:
        at = "/".join(str(part) for part in error.path) or "top level"
        raise Unjudged(f"{place}: not valid evidence at {at}: {error.message[:200]}")


OURS, YOURS = "evidence", "yours"
"""Folders of build/: what this project claims, and what was found out about a user's programs and logs."""


def evidence_path(place: Path, document: str, id: str, folder: str = OURS) -> Path:
    """Where the evidence of a run lies."""
    return build(place) / folder / document / f"{id}.json"


def write(place: Path, record: Mapping[str, Any], folder: str = OURS) -> Path:
    """Write one piece of evidence, sealed, and return its path.

    Raises Unjudged when the record breaks the schema or cannot be written (no space, no permission); then
    nothing is left behind.
    """
    _check(record, f"evidence to be written, {record.get('document')}/{record.get('id')}")
    path = evidence_path(place, record["document"], record["id"], folder)
    text = json.dumps(sealed(record), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    write_whole(path, text.encode("utf-8"))
    return path


def write_whole(path: Path, content: bytes, mode: int = 0o644) -> None:
    """Write a file atomically, its folders too. Raises Unjudged when that fails; the old file is still there.

    What is no regular file is written to, and never replaced.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write_whole(path, content, mode)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None


def write_lines(path: Path, lines: Iterable[str]) -> None:
    """Write a text, packed by gzip where the name ends so; the same lines give the same bytes."""
    content = "".join(lines).encode()
    if path.suffix == ".gz":
        held = io.BytesIO()
        # No name, date or system (gzip.compress names the system).
        with gzip.GzipFile("", "wb", 9, held, mtime=0) as packed:
            packed.write(content)
        content = held.getvalue()
    write_whole(path, content)


def discard(place: Path, document: str, id: str, folder: str = OURS) -> None:
    """Remove the evidence of an earlier run, so that a run that fails to write any cannot pass for it."""
    try:
        evidence_path(place, document, id, folder).unlink(missing_ok=True)
    except OSError as error:
        raise Unjudged(f"evidence {document}/{id} cannot be removed: {error.strerror or error}") from None


def discard_undeclared(place: Path, document: str, kind: str, declared: Set[str]) -> None:
    """Remove the evidence of one kind whose runs are declared no more; what cannot be read goes too."""
    for path in sorted((build(place) / "evidence" / document).glob("*.json")):
        try:
            if read(path)["kind"] != kind:
                continue
        except Unjudged:
            pass
        if path.stem not in declared:
            discard(place, document, path.stem)


def read(path: Path) -> dict[str, Any]:
    """Read one piece of evidence. Raises Unjudged when it is missing, cut off or breaks the schema."""
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: not JSON: {error}") from None
    if not (isinstance(record, dict) and is_sealed(record)):  # what was sealed here was checked before
        _check(record, str(path))
    if path.stem != record["id"] or path.parent.name != record["document"]:
        raise Unjudged(f"{path}: holds the evidence of {record['document']}/{record['id']}")
    return dict(record)


def read_document(place: Path, document: str) -> tuple[dict[str, Any], ...]:
    """All evidence of a document, in the order of the ids. Raises Unjudged as `read` does."""
    folder = build(place) / "evidence" / document
    return tuple(read(path) for path in sorted(folder.glob("*.json")))

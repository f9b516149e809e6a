"""What evidence says of a run or a theorem, if it was judged here and nothing has changed since."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import evidence_path
from modeproof.ground.evidence.record import is_sealed
from modeproof.ground.meaning import meaning


def record_of(root: Path, document: str, id: str) -> dict[str, Any] | None:
    """The evidence of a run, a theorem or a machine; None where there is none that can be read."""
    try:
        record = json.loads(evidence_path(root, document, id).read_bytes())
    except (OSError, ValueError):
        return None
    return record if isinstance(record, dict) else None


def verdict(root: Path, document: str, id: str) -> str:
    """Its verdict and day, or why there is none."""
    record = record_of(root, document, id)
    if record is None:
        return "not judged here"
    try:
        word, day, expected = str(record["verdict"]), str(record["started"])[:10], record["as_expected"]
        changed = _changed(root, record["inputs"])
        if not is_sealed(record):
            return "its evidence was changed since it was written"
    except (KeyError, TypeError, AttributeError):
        return "its evidence cannot be read"
    if changed:
        return f"was {word} on {day}; {changed} has changed since"
    return f"{word} on {day}{'' if expected is True else ', NOT as expected'}"


def _changed(root: Path, inputs: dict[str, str]) -> str:
    """The first file that does not say what it said."""
    for name, digest in inputs.items():
        try:
            if meaning(root / name) != digest:
                return name
        except Unjudged:
            return name
    return ""


def tally(root: Path, document: str, ids: Iterable[str]) -> str:
    """In short what was shown of several: how many were as expected, when, and the first that was not."""
    said = {id: verdict(root, document, id) for id in ids}
    if not said:
        return ""
    good = {id: text for id, text in said.items() if " on " in text and ";" not in text and "NOT" not in text}
    days = sorted({text.rpartition(" ")[2] for text in good.values()})
    text = f"{len(good)} of {len(said)} as expected here"
    if days:
        text += f" ({days[0]})" if len(days) == 1 else f" ({days[0]} to {days[-1]})"
    first = next(((id, text) for id, text in said.items() if id not in good), None)
    return text if first is None or not good else f"{text}; {first[0]}: {first[1]}"

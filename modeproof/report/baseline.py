"""With which earlier report a new one is compared.

The report before stays beside the new one as previous.json. A report that is made again from identical
evidence keeps the one that it was compared with, so that the file is identical.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.report.integrity import seal_of_json

NAME, PREVIOUS = "report.json", "previous.json"


@dataclass(frozen=True)
class Baseline:
    """The earlier report; `keep` is the text that becomes previous.json, None: that file stays as it is.

    `problem` says why there is none though there is a file.
    """

    report: Mapping[str, Any] | None = None
    keep: str | None = None
    problem: str = ""


def read_report(path: Path) -> tuple[str, dict[str, Any]]:
    """The text and the content of a report's JSON. Raises Unjudged when it is missing, damaged or changed."""
    try:
        text = path.read_text(encoding="utf-8")
        content = json.loads(text)
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise Unjudged(f"{path}: not JSON, so no report: {error}") from None
    seal = seal_of_json(text)
    if not isinstance(content, dict) or seal is None or not isinstance(content.get("snapshot"), dict):
        raise Unjudged(f"{path}: not a report of `modeproof report` (no seal, or no snapshot)")
    if seal[0] != seal[1]:
        raise Unjudged(
            f"{path}: changed since it was written: its seal is {seal[0][:12]}, its text {seal[1][:12]}"
        )
    return text, content


def choose(folder: Path, digest: str) -> Baseline:
    """The baseline of a report with this digest, to lie in `folder`. Damage is said and never raised."""
    problem = ""
    if (folder / NAME).exists():
        try:
            text, last = read_report(folder / NAME)
            if last.get("digest") != digest:
                return Baseline(last, text)
        except Unjudged as error:
            problem = error.message.replace(f"{folder}/", "")
    if (folder / PREVIOUS).exists():
        try:
            return Baseline(read_report(folder / PREVIOUS)[1], None, problem)
        except Unjudged as error:
            problem = error.message.replace(f"{folder}/", "")
    return Baseline(None, None, problem)

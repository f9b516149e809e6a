"""What the words of signals mean: which table a signal's words are of (replay.toml), and the words of each
table (sequences.toml, whose flows send them).
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged
from modeproof.registers.replay import load_replay
from modeproof.registers.rows import Document
from modeproof.report.sources import Sources


@dataclass(frozen=True)
class Codes:
    """`words` gives the number of a word (four hex digits); `says` names what the number is."""

    says: str
    words: dict[str, int]


def codes_of(sources: Sources, document: Document) -> dict[str, Codes]:
    """The codes by signal; nothing for a signal whose words have no meaning, or no known one."""
    return sources.once(f"codes {document.name}", lambda: _read(sources, document))


def _read(sources: Sources, document: Document) -> dict[str, Codes]:
    text = sources.content(f"spec/{document.name}/sequences.toml")
    try:
        traces = load_replay(document.root, document.name)
        tables = tomllib.loads((text or b"").decode("utf-8")).get("tables", {})
    except (Unjudged, UnicodeDecodeError, tomllib.TOMLDecodeError):
        return {}
    return {
        signal: Codes(one.says, {str(word): number for number, word in enumerate(tables[one.table])})
        for one in traces.words
        if one.table in tables
        for signal in one.signals
    }

"""What `verify` keeps of an earlier one: each result whose files, code and tools are the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import Rests
from modeproof.ground.progress import Progress
from modeproof.registers.load import load_document
from modeproof.report.evidence_judge import contradiction

Record = dict[str, Any]
KEPT = "kept"
"""The key of a kept record in what `verify` returns; no file has it."""


class Keep:
    """Judges which results are still valid, and remembers why the others are judged again. anew: none is."""

    def __init__(self, anew: bool = True) -> None:
        self.anew = anew
        self._why: dict[str, list[str]] = {}
        self._documents: dict[str, Any] = {}

    def record(
        self,
        place: Path,
        document: str,
        id: str,
        rests: Rests | Callable[[], Rests],
        doubt: Callable[[Record], str] | None = None,
    ) -> Record | None:
        """The evidence of a result that is still valid; None: it must be judged.

        Its own figures are judged once more, by `doubt` if that is given. What it rests on is asked only
        where there is evidence; where that cannot be said nothing is kept.
        """
        path = evidence.evidence_path(place, document, id)
        if self.anew or not path.is_file():
            return None
        try:
            record = evidence.read(path)
        except Unjudged:
            self._again("its evidence cannot be read", document, id)
            return None
        try:
            why = evidence.why_again(place, record, rests if isinstance(rests, Rests) else rests())
            if not why and doubt is not None:
                why = doubt(record)
            elif not why:
                why = contradiction(place, self._document(place, document), record)
        except Unjudged as error:
            why = error.message.replace(f"{place}/", "")
        if why:
            self._again(why, document, id)
            return None
        return {**record, KEPT: True}

    def _again(self, why: str, document: str, id: str) -> None:
        self._why.setdefault(why, []).append(f"{document}/{id}")

    def _document(self, place: Path, name: str) -> Any:
        if name not in self._documents:
            self._documents[name] = load_document(place, name)
        return self._documents[name]

    def say(self, progress: Progress) -> None:
        """One line for each reason why results of an earlier day are judged again, since the last call."""
        for why, names in self._why.items():
            more = f" and {len(names) - 1} more" if len(names) > 1 else ""
            progress.say(f"again {names[0]}{more}: {why}")
        self._why.clear()


NOTHING = Keep()
"""What keeps nothing."""


def kept_line(records: list[Record]) -> str:
    """How many results were kept, of which days, and how many were judged now."""
    days = Counter(str(record["started"])[:10] for record in records if KEPT in record)
    count = days.total()
    of = ", ".join(f"{day} ({number})" if len(days) > 1 else day for day, number in sorted(days.items()))
    judged = f"{len(records) - count} results judged now"
    return f"{'kept':<12} {count} results of {of}; {judged}" if count else f"{'kept':<12} none; {judged}"

"""The rows of the review sheet, and the sheet as a file: CSV, written by the page too, and read back."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.report.sources import Figure

NAME = "review.csv"
ANSWERS = ("accept", "reject", "remark")
HEADS = (
    *("row", "text", "question", "what", "readings", "decision", "consequence", "trace"),
    *("answer", "words", "name", "day"),
)
"""The columns; `row` and `text` (a fingerprint of what was judged) are no cells to fill in."""
MOST_BYTES = 5_000_000


@dataclass(frozen=True)
class Answer:
    """What a person said to a row whose text has this fingerprint."""

    text: str
    answer: str
    words: str = ""
    name: str = ""
    day: str = ""


QUESTIONS = {
    "safety": "A property of ours falls, no drawing can settle it: is the decision right for the machine?",
    "assumption": "What the machine must ensure: does somebody ensure it, and was it checked?",
    "hazard": "Hazard of the text as it stands: is what it leaves to the machine taken care of?",
    "drawing": "A property of ours falls, a drawing could settle it: does it say what was decided?",
    "requirement": "Requirements: are these the safety requirements that are meant, and is none missing?",
    "model": "What the model leaves out or merges: does that hide nothing that matters?",
    "open": "Open, and nothing that we ask falls: is the decision acceptable?",
    "decided": "Decided by the page: is the sentence read as it is meant?",
    "untried": "No reading was tried by a run: is the text read as it is meant?",
    "clause": "The paper in our words: does each sentence say what the paper says?",
}
"""The groups, the most important first, each with its question."""


@dataclass(frozen=True)
class Trace:
    """A counterexample that shows what is judged; `steps` is None where it was not recorded."""

    run: str
    steps: Figure | None


@dataclass(frozen=True)
class Item:
    """One entry of a register. `kind` is what it is put together by, within its group and document."""

    group: str
    document: str
    kind: str
    id: str
    anchor: str
    title: str
    readings: tuple[str, ...] = ()
    decision: str = ""
    consequence: str = ""
    traces: tuple[Trace, ...] = ()


@dataclass(frozen=True)
class Row:
    """What a person judges in one answer: an entry, or several entries of one kind.

    `text` is a fingerprint of all that is judged: an answer to another text does not count.
    """

    id: str
    text: str
    items: tuple[Item, ...]
    answer: Answer | None = None

    @property
    def question(self) -> str:
        """The question of its group."""
        return QUESTIONS[self.items[0].group]

    @property
    def alone(self) -> Item | None:
        """The only entry, where it is one."""
        return self.items[0] if len(self.items) == 1 else None

    @property
    def what(self) -> str:
        """What is judged, in one line."""
        return "; ".join(f"{item.id} {item.title}" for item in self.items)

    @property
    def readings(self) -> tuple[str, ...]:
        """How it can be read."""
        return self.alone.readings if self.alone else ()

    @property
    def decision(self) -> str:
        """What was decided."""
        if self.alone:
            return self.alone.decision
        return " ".join(f"{item.id}: {item.decision}" for item in self.items if item.decision)

    @property
    def consequence(self) -> str:
        """What follows where it is wrong."""
        return self.alone.consequence if self.alone else ""

    @property
    def traces(self) -> tuple[Trace, ...]:
        """What shows it."""
        return tuple(trace for item in self.items for trace in item.traces)

    @property
    def outdated(self) -> bool:
        """The answer is to another text."""
        return self.answer is not None and self.answer.text != self.text


def read_answers(path: Path, rows: Iterable[str]) -> Mapping[str, Answer]:
    """The answers of a file by their rows; `rows` are those of the sheet.

    Raises Unjudged, in one line with the line of the file, for what is no review sheet, for a row that the
    sheet does not have or that is there twice, and for an answer that is none of the three.
    """
    try:
        if path.stat().st_size > MOST_BYTES:
            raise Unjudged(f"{path}: larger than any review sheet ({MOST_BYTES:,} bytes)")
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    known = set(rows)
    found: dict[str, Answer] = {}
    reader = csv.DictReader(io.StringIO(text, newline=""), delimiter=_delimiter(text), strict=True)
    try:
        heads = tuple(reader.fieldnames or ())
        if not set(HEADS) <= set(heads):
            lost = ", ".join(head for head in HEADS if head not in heads)
            raise Unjudged(f"{path}: no review sheet of `modeproof report`: without the columns {lost}")
        for row in reader:
            place = f"{path}: line {reader.line_num}"
            if None in row or None in row.values():
                raise Unjudged(f"{place}: not as many cells as the first line has")
            if row["row"] not in known:
                raise Unjudged(
                    f"{place}: this report has no row {row['row'][:80]!r}; {suggestion(row['row'], known)}"
                )
            if row["row"] in found:
                raise Unjudged(f"{place}: the row {row['row']!r} is there twice")
            word = row["answer"].strip().lower()
            if word not in ("", *ANSWERS):
                raise Unjudged(
                    f"{place}: {row['answer'][:40]!r} is no answer; write {', '.join(ANSWERS[:-1])} "
                    f"or {ANSWERS[-1]}"
                )
            if word == "remark" and not row["words"].strip():
                raise Unjudged(f"{place}: a remark without words")
            answer = Answer(row["text"], word, *(row[key].strip() for key in ("words", "name", "day")))
            found[row["row"]] = answer
    except csv.Error as error:
        raise Unjudged(f"{path}: line {reader.line_num}: no CSV: {error}") from None
    return {row: answer for row, answer in found.items() if answer.answer}


def _delimiter(text: str) -> str:
    """What spreadsheets of this country put between two cells, by the first line."""
    head = text.partition("\n")[0]
    return max(",;\t", key=head.count)


def sheet_file(rows: Sequence[Row]) -> bytes:
    """The sheet as a file; UTF-8 with a mark at the beginning, as spreadsheets want."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(HEADS)
    for row in rows:
        answer = row.answer or Answer("", "")
        cells = (
            *(row.id, row.text, row.question, row.what, " / ".join(row.readings)),
            *(row.decision, row.consequence, "; ".join(trace.run for trace in row.traces)),
        )
        answered = (answer.answer, answer.words, answer.name, answer.day)
        writer.writerow([_plain(cell) for cell in (*cells, *answered)])
    return out.getvalue().encode("utf-8-sig")


def _plain(text: str) -> str:
    """A cell that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text


def tally(rows: Sequence[Row]) -> dict[str, int]:
    """How many rows have which answer, and how many none that counts."""
    words = [row.answer.answer if row.answer and not row.outdated else "" for row in rows]
    return {"rows": len(rows), **{word: words.count(word) for word in ANSWERS}, "open": words.count("")}

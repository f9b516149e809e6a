"""What `judge` says at its end: a row for each entry, and the next command for each that is not well."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from modeproof.kit.errors import plain
from modeproof.output.junit import ELEMENTS
from modeproof.output.outcome import UNJUDGED, Outcome, Problem
from modeproof.project.judging import Judged, Judging

HEAD = ("entry", "verdict", "about", "", "seconds")
MOST = 3
"""Rules that a row names."""
LONGEST = 300


def lines_of(judging: Judging, found: Sequence[Judged]) -> Iterator[str]:
    """The table, the reasons, and the sum as the last line."""
    rows = [HEAD, *(row_of(one) for one in found)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEAD))]
    for row in rows:
        *words, seconds = (f"{text:<{width}}" for text, width in zip(row, widths, strict=True))
        yield f"{'  '.join(words)}  {seconds.strip():>{widths[-1]}}"
    for one in found:
        if one.outcome.status:
            yield ""
            yield f"{one.entry.name}: {plain(why(one.outcome), LONGEST)}"
            yield f"  next: {judging.again(one.entry)}"
    yield ""
    counts = [sum(one.outcome.status == status for one in found) for status in (0, 1, 2)]
    parts = zip(counts, ("as expected", "not as expected", "not judged or unknown"), strict=True)
    said = ", ".join(f"{count} {word}" for count, word in parts if count)
    kept = sum(one.kept for one in found)
    yield f"{len(found)} {'entry' if len(found) == 1 else 'entries'}: {said}; {kept} kept"


def row_of(one: Judged) -> tuple[str, str, str, str, str]:
    """The row of an entry."""
    found = one.outcome
    return one.entry.name, found.word, about(found), "kept" if one.kept else "judged", f"{found.seconds:.1f}"


def about(found: Outcome) -> str:
    """What was asked, and which clauses or properties are broken, or not shown."""
    if not found.status:
        count = len(found.demands)
        return f"{count} properties" if count > 1 else found.target or found.subject
    if found.word == UNJUDGED:
        return found.target or found.subject
    judged = [demand for demand in found.demands if demand.required]
    named = list(dict.fromkeys(id for one in judged for problem in one.problems for id in ids_of(problem)))
    named = named or [one.id for one in judged if ELEMENTS.get(one.word) != "system-out"]
    more = f" and {len(named) - MOST} more" if len(named) > MOST else ""
    verb = "breaks" if found.status == 1 else "not shown:"
    return f"{verb} {', '.join(named[:MOST])}{more}" if named else found.target or found.subject


def line_of(found: Outcome) -> str:
    """The verdict, and what is broken, in a few words."""
    return f"{found.word}, {about(found)}" if found.status else found.word


def ids_of(problem: Problem) -> list[str]:
    """The clauses or the property that a problem is about; of a whole target or log those that it touches."""
    clauses = [rule.id for rule in problem.others if rule.kind == "clause"]
    return clauses if problem.rule.kind in ("target", "log") and clauses else [problem.rule.id]


def why(found: Outcome) -> str:
    """Why an entry is not well, in one line, with the place in the program where that is known."""
    if found.reason or not found.problems:
        return found.reason or found.sentence
    _, problem = found.problems[0]
    spot = problem.spot
    where = f"{spot.file}:{spot.line}: " if spot is not None and spot.line else ""
    return f"{where}{problem.message}"


def status_of(found: Sequence[Judged]) -> int:
    """1 if an entry is not as expected, else 2 if one could not be judged or there is none, else 0."""
    statuses = {one.outcome.status for one in found}
    return 1 if 1 in statuses else 0 if statuses == {0} else 2

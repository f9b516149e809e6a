"""Renders strength.md and strength.csv in docs/<document> from the results: which property each mutant breaks.

The last line of the page is a stamp: the hash of what each module's judgement rests on, and of the page's own
text. A page that was edited by hand is found out; one whose specification has moved says for what it holds.
"""

# ruff: noqa: E501 - the lines of the page are as long as its paragraphs

from __future__ import annotations

import csv
import hashlib
import io
import platform
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from modeproof.errors import EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.evidence.files import write_whole
from modeproof.registers.load import load_document
from modeproof.registers.pages import KILL_TABLE, STRENGTH, page_of
from modeproof.strength.campaign import WORDS, Judged, Known, inputs_now
from modeproof.strength.explain import explanation_of, explanation_problems, unexplained
from modeproof.strength.judge import Bench
from modeproof.strength.mutant import Mutant
from modeproof.strength.register import Explained
from modeproof.strength.results import Results
from modeproof.tlc.schedule import cores

_STAMP = re.compile(r"<!-- rendered by modeproof mutate: (.*), text (\w{12}) -->\n\Z")


def page_path(document: str) -> str:
    """The path of a document's page."""
    return page_of(document, STRENGTH)


def render(bench: Bench, every: Sequence[Mutant], results: Results) -> int:
    """Write the page and the table. Raises Unjudged when a mutant has not been judged for the inputs as they
    are now; exit status 1 when a survivor is unexplained.
    """
    judged = known(bench, every, results)
    missing = len(every) - len(judged)
    if missing:
        raise Unjudged(
            f"{missing} of {len(every)} mutants are not judged for this specification; run without --render"
        )
    text = page(bench, judged)
    inputs = ", ".join(f"{module} {value}" for module, value in sorted(inputs_now(bench).items()))
    stamp = f"<!-- rendered by modeproof mutate: {inputs}, text {text_digest(text)} -->\n"
    document = bench.strength.document
    write_whole(bench.place / page_path(document), (text + "\n" + stamp).encode("utf-8"))
    write_whole(bench.place / page_of(document, KILL_TABLE), table(judged).encode("utf-8"))
    explained = bench.strength.explained
    bad = unexplained(explained, judged) or explanation_problems(explained, judged, complete=True)
    return EXIT_NOT_AS_EXPECTED if bad else 0


def known(bench: Bench, every: Sequence[Mutant], results: Results) -> list[Judged]:
    """The mutants that are judged for the inputs as they are now."""
    holding = Known(bench, results)
    found = ((one, holding.find(one)) for one in every)
    return [Judged(one, record) for one, record in found if record is not None]


def stamp_of(place: Path, page: str) -> tuple[dict[str, str], bool]:
    """What a page says it rests on, and whether its text is as it was rendered.

    Raises Unjudged when there is no page or no stamp.
    """
    try:
        text = (place / page).read_text(encoding="utf-8")
    except OSError as error:
        raise Unjudged(f"{page}: {error.strerror or error}") from None
    found = _STAMP.search(text)
    if found is None:
        raise Unjudged(f"{page}: the page has no stamp; render it anew")
    inputs = dict(one.split(" ") for one in found[1].split(", "))
    return inputs, text_digest(text[: found.start() - 1]) == found[2]


def table(judged: Sequence[Judged]) -> str:
    """The kill matrix: a row a mutant, a column a property; x broken, - held, empty not tried."""
    columns = _columns(judged)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        ["mutant", "module", "definition", "operator", "old", "new", "verdict", "first killer", *columns]
    )
    for one in judged:
        mutant = one.mutant
        tried = {name for answer in one.record["answers"] for name in answer.get("asked", [])}
        cells = ["x" if name in one.killers else "-" if name in tried else "" for name in columns]
        first = one.killers[0] if one.killers else ""
        row = [
            mutant.id,
            mutant.module,
            mutant.definition,
            mutant.operator,
            mutant.old,
            mutant.new,
            one.word,
            first,
        ]
        writer.writerow([*row, *cells])
    return out.getvalue()


def page(bench: Bench, judged: Sequence[Judged]) -> str:
    """The text of the page, without its stamp."""
    document = load_document(bench.place, bench.strength.document)
    stated = [one.tla for one in document.properties]
    negatives = Counter(run.property for run in document.runs if run.kind == "NEG")
    parts = [
        _head(bench, judged),
        _by_module(bench, judged),
        by_operator(judged),
        _by_property(judged, stated, negatives),
        _matrix(judged),
        survivors(bench.strength.explained, judged),
        others(judged),
    ]
    return "\n".join(parts)


def _head(bench: Bench, judged: Sequence[Judged]) -> str:
    counts = Counter(one.word for one in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    seconds = sum(one.record["seconds"] for one in judged)
    open_ones = len(unexplained(bench.strength.explained, judged))
    modules = ", ".join(f"`{name}`" for name in bench.strength.rules)
    return f"""# How strong the properties are

One edit at a time was made in the device modules ({modules}) of `spec/{bench.strength.document}`, and the declared properties
were asked about each result. **{counts["KILLED"]} of {real} mutants that behave differently are killed by a named property
({percent(counts["KILLED"], real)}); {counts["SURVIVED"]} survive, {open_ones} of them unexplained; {counts["UNMEASURED"]} could not be measured.**

```
.venv/bin/modeproof mutate spec --document {bench.strength.document}            # judges what is not judged yet; can be stopped and taken up again
.venv/bin/modeproof mutate spec --document {bench.strength.document} --show ID  # one edit, and what came of it
.venv/bin/modeproof mutate spec --document {bench.strength.document} --render   # this page and strength.csv, the whole matrix
```

TLC ran for {seconds / 60:.0f} minutes in all on {cores()} cores ({platform.system()}, {platform.machine()}), as many runs at once as there are
cores. Which edits are made is a rule, not a sample: `modeproof/strength/operators.py`. Which runs judge, in which order and at which
bounds, is declared in [strength.toml](../../spec/{bench.strength.document}/strength.toml). A mutant that something has killed is not put to the
costlier runs (their columns are empty in the matrix), unless `--complete` asks for it.

| word | meaning |
|---|---|
| KILLED | a named property is false in a state or step that the mutant reaches; all that are false there are named |
| EQUIVALENT | nothing is broken, and the complete reachable graph (views, outputs, transitions; not the names of steps) equals the original's |
| SURVIVED | neither; the graph differs, so the comparison with the reference implementation would see it, but no property does |
| INVALID | TLC refuses the text, or an expression of the mutant has no value before any property is false; not counted as killed |
| UNMEASURED | a limit of time or memory came first |
"""


def _by_module(bench: Bench, judged: Sequence[Judged]) -> str:
    rows = []
    for module in bench.strength.rules:
        of_module = [one for one in judged if one.mutant.module == module]
        rows.append([f"`{module}`", *counted(of_module)])
    rows.append(["**all**", *counted(judged)])
    return "## By module\n\n" + markdown(["module", "mutants", *WORDS, "score"], rows)


def by_operator(judged: Sequence[Judged]) -> str:
    """Counts by operator."""
    operators = sorted({one.mutant.operator for one in judged})
    rows = [[name, *counted([one for one in judged if one.mutant.operator == name])] for name in operators]
    return "## By operator\n\n" + markdown(["operator", "mutants", *WORDS, "score"], rows)


def _by_property(judged: Sequence[Judged], stated: Sequence[str], negatives: Mapping[str, int]) -> str:
    killed = Counter(name for one in judged for name in one.killers)
    first = Counter(one.killers[0] for one in judged if one.killers)
    alone = Counter(one.killers[0] for one in judged if len(one.killers) == 1)
    asked = Counter(
        name for one in judged for name in {n for a in one.record["answers"] for n in a.get("asked", [])}
    )
    names = [*dict.fromkeys([*stated, *sorted(set(killed) - set(stated))])]
    rows = [
        [
            f"`{name}`" + ("" if name in stated else " (type)"),
            asked[name],
            killed[name],
            first[name],
            alone[name],
            negatives.get(name, 0),
        ]
        for name in names
    ]
    nothing = [name for name in stated if not killed[name] and asked[name]]
    never = [name for name in stated if not asked[name]]
    neither = [name for name in stated if not killed[name] and not negatives.get(name)]
    not_alone = [name for name in stated if killed[name] and not alone[name]]
    notes = [
        "Asked: mutants to which the property was put; alone: no other property that was asked fell; negatives: declared runs in which "
        "a literal reading or a fault breaks it.",
        f"Kill nothing: {names_of(nothing)}.",
        f"Kill nothing alone, but with others: {names_of(not_alone)}.",
        f"Put to no mutant (no tier has a run that checks them, or none was left for it): {names_of(never)}.",
        f"Broken by no mutant and no negative: {names_of(neither)}. These fall to faults planted in the tests, as every property does.",
    ]
    head = ["property", "asked", "killed", "first", "alone", "negatives"]
    return (
        "## By property\n\n" + markdown(head, rows) + "\n" + "\n".join(f"- {note}" for note in notes) + "\n"
    )


def _matrix(judged: Sequence[Judged]) -> str:
    """Operators against properties, for each module: how many mutants of the operator the property kills."""
    parts = [
        "## Matrix\n\nKilled mutants by operator (columns) and property (rows). [strength.csv](strength.csv) has a row "
        "for every mutant.\n"
    ]
    for module in dict.fromkeys(one.mutant.module for one in judged):
        of_module = [one for one in judged if one.mutant.module == module and one.killers]
        cells: dict[str, Counter[str]] = defaultdict(Counter)
        for one in of_module:
            for name in one.killers:
                cells[name][one.mutant.operator] += 1
        operators = sorted({one.mutant.operator for one in of_module})
        rows = [[f"`{name}`", *(cells[name][op] or "" for op in operators)] for name in sorted(cells)]
        parts.append(f"### {module}\n\n" + markdown(["property", *operators], rows))
    return "\n".join(parts)


def survivors(explained: Sequence[Explained], judged: Sequence[Judged]) -> str:
    """The survivors, by explanation."""
    groups: dict[str, list[Judged]] = defaultdict(list)
    kinds: Mapping[str, str] = {one.why: one.kind for one in explained}
    for one in judged:
        if one.word == "SURVIVED":
            found = explanation_of(explained, one.mutant.id)
            groups["" if found is None else found.why].append(one)
    parts = ["## Survivors\n"]
    for why, ones in sorted(groups.items()):
        parts.append(f"**{kinds[why]}.** {why}\n" if why else "**Not explained.**\n")
        parts += [f"- `{one.mutant.id}` {edit_of(one.mutant)}" for one in ones]
        parts.append("")
    if not groups:
        parts.append("None.\n")
    return "\n".join(parts)


def others(judged: Sequence[Judged]) -> str:
    """What was neither killed nor survived, folded away."""
    parts = ["## Equivalent, invalid, unmeasured\n"]
    for word in ("EQUIVALENT", "INVALID", "UNMEASURED"):
        ones = [one for one in judged if one.word == word]
        if not ones:
            continue
        parts.append(f"<details><summary>{len(ones)} {word}</summary>\n")
        for one in ones:
            why = str(one.record["reason"])[:160].replace("`", "'")
            parts.append(f"- `{one.mutant.id}` {edit_of(one.mutant)}" + (f": {why}" if why else ""))
        parts.append("\n</details>\n")
    return "\n".join(parts)


def edit_of(mutant: Mutant) -> str:
    """An edit in one line."""
    old, new = (text if len(text) < 70 else text[:67] + "..." for text in (mutant.old, mutant.new))
    return f"{mutant.operator} in {mutant.definition}: `{old}` → `{new}`"


def counted(judged: Sequence[Judged]) -> list[object]:
    """A row of counts: all, by verdict, and the score."""
    counts = Counter(one.word for one in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    return [len(judged), *(counts[word] for word in WORDS), percent(counts["KILLED"], real)]


def _columns(judged: Iterable[Judged]) -> list[str]:
    names = (name for one in judged for answer in one.record["answers"] for name in answer.get("asked", []))
    return sorted(set(names))


def percent(part: int, whole: int) -> str:
    """A share with one digit; `-` of nothing."""
    return f"{100 * part / whole:.1f} %" if whole else "-"


def names_of(names: Sequence[str]) -> str:
    """Names in one line."""
    return ", ".join(f"`{name}`" for name in names) or "none"


def markdown(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table."""
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    lines += [f"| {' | '.join(str(cell) for cell in row)} |" for row in rows]
    return "\n".join(lines) + "\n"


def text_digest(text: str) -> str:
    """The hash of a page's own text."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:12]

"""Renders docs/<document>/strength-impl.md from the results: which theorem each mutant of the shipped code breaks."""

# ruff: noqa: E501 - the lines of the page are as long as its paragraphs

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from modeproof.errors import EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.evidence.files import write_whole
from modeproof.registers.pages import STRENGTH_OF_CODE, page_of
from modeproof.strength.campaign import WORDS, Judged
from modeproof.strength.explain import explanation_problems, unexplained
from modeproof.strength.implementation import Implementation
from modeproof.strength.page import (
    by_operator,
    counted,
    markdown,
    names_of,
    others,
    percent,
    survivors,
    text_digest,
)
from modeproof.strength.results import Results


def page_path(document: str) -> str:
    """The path of a document's page."""
    return page_of(document, STRENGTH_OF_CODE)


def render(code: Implementation, results: Results) -> int:
    """Write the page. Raises Unjudged when a mutant has not been judged for the code and the theorems as they
    are now; exit status 1 when a survivor is unexplained.
    """
    judged = code.known(results)
    missing = len(code.every) - len(judged)
    if missing:
        raise Unjudged(
            f"{missing} of {len(code.every)} mutants are not judged for this code; run without --render"
        )
    text = page(code, judged)
    stamp = f"<!-- rendered by modeproof mutate: base {code.base}, text {text_digest(text)} -->\n"
    write_whole(code.place / page_path(code.document), (text + "\n" + stamp).encode("utf-8"))
    explained = code.register.explained
    bad = unexplained(explained, judged) or explanation_problems(explained, judged, complete=True)
    return EXIT_NOT_AS_EXPECTED if bad else 0


def page(code: Implementation, judged: Sequence[Judged]) -> str:
    """The text of the page, without its stamp."""
    return "\n".join(
        [
            _head(code, judged),
            _by_module(judged),
            by_operator(judged),
            _by_theorem(code, judged),
            survivors(code.register.explained, judged),
            others(judged),
        ]
    )


def _head(code: Implementation, judged: Sequence[Judged]) -> str:
    counts = Counter(one.word for one in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    seconds = sum(one.record["seconds"] for one in judged)
    open_ones = len(unexplained(code.register.explained, judged))
    passed = sum(1 for one in judged if one.word == "EQUIVALENT" and one.record["reason"])
    return f"""# How strong the theorems are

One edit at a time was made in what the `step` functions of `refimpl/{code.document}` reach, and the theorems about the devices were
asked about each result. **{counts["KILLED"]} of {real} mutants that behave differently are killed by a named theorem
({percent(counts["KILLED"], real)}); {counts["SURVIVED"]} survive, {open_ones} of them unexplained; {counts["UNMEASURED"]} could not be measured.**

```
.venv/bin/modeproof mutate impl --document {code.document}            # judges what is not judged yet; can be stopped and taken up again
.venv/bin/modeproof mutate impl --document {code.document} --show ID  # one edit, where it differs, and what the theorems say
.venv/bin/modeproof mutate impl --document {code.document} --render   # this page
```

Judging took {seconds / 60:.0f} minutes in all, one mutant a process. Which edits are made is a rule, not a sample:
`modeproof/strength/python_operators.py`. Which theorems judge is declared in [judges.py](../../proofs/{code.document}/judges.py), what is put in the
place of a name in [strength.toml](../../proofs/{code.document}/strength.toml).

| word | meaning |
|---|---|
| KILLED | a theorem has a counterexample where the mutant ends otherwise than the shipped code; run on the mutant, it ends as the solver says, and the shipped code has none there |
| EQUIVALENT | on every path of the shipped code that passes the edit, from every state of its invariant, with any inputs and parameters, the mutant returns the same, by a query for each path; or no path passes it ({passed} mutants) |
| SURVIVED | it ends otherwise somewhere, and no theorem has a counterexample there |
| INVALID | the text does not compile, or the explorer refuses to follow it; not counted as killed |
| UNMEASURED | a limit of time came first, or a solver did not know |

A scan that raises breaks the theorem that every scan ends with a state and outputs. The first theorem that falls is named; the others are
not asked unless `--complete` says so.

**What the score does not say.** It measures the theorems, by small faults in one place of one program: not that this program is right, and
nothing about a program of yours. It knows no fault in two places, no function that is missing from program and theorems alike, and no
misreading of the document that both share. A theorem that kills nothing here is not idle for that: those before it in the list may have killed first,
or no single edit may break it. [adequacy.md](adequacy.md) asks the test vectors about the same mutants.
"""


def _by_module(judged: Sequence[Judged]) -> str:
    rows: list[list[object]] = []
    for module in dict.fromkeys(one.mutant.module for one in judged):
        rows.append([f"`{module}`", *counted([one for one in judged if one.mutant.module == module])])
    rows.append(["**all**", *counted(judged)])
    return "## By module\n\n" + markdown(["module", "mutants", *WORDS, "score"], rows)


def _by_theorem(code: Implementation, judged: Sequence[Judged]) -> str:
    names = list(code.code.theorems(code.document))
    first = Counter(one.killers[0] for one in judged if one.killers)
    asked = Counter(
        name for one in judged for name in {answer["theorem"] for answer in one.record["answers"]}
    )
    rows = [[f"`{name}`", asked[name], first[name]] for name in names]
    nothing = [name for name in names if not first[name]]
    notes = [
        "Asked: mutants to which the theorem was put, those before it in the list having found nothing.",
        f"Kill nothing here: {names_of(nothing)}. Either others killed first, or no single edit breaks them; the planted faults that "
        "refute a theorem are among its examples in [proofs.md](proofs.md).",
    ]
    return (
        "## By theorem\n\n"
        + markdown(["theorem", "asked", "killed"], rows)
        + "\n"
        + "\n".join(f"- {note}" for note in notes)
        + "\n"
    )

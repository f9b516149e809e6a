"""Renders docs/<document>/adequacy.md from the results: which suite tells each mutant from the shipped code."""

# ruff: noqa: E501 - the lines of the page are as long as its paragraphs

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import Any

from modeproof.errors import EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.evidence.files import write_whole
from modeproof.registers.adequacy_page import adequacy_page, stamped_adequacy
from modeproof.strength import replay
from modeproof.strength.adequacy import BY_REFUSAL, Adequacy
from modeproof.strength.campaign import WORDS, Judged
from modeproof.strength.explain import explanation_problems, unexplained
from modeproof.strength.page import counted, edit_of, markdown, names_of, percent, survivors
from modeproof.strength.register import Explained
from modeproof.strength.results import Results
from modeproof.suites.write import SUITES


def render(adequacy: Adequacy, results: Results, explained: Sequence[Explained]) -> int:
    """Write the page. Raises Unjudged when a mutant has not been judged for this code and these vectors; exit
    status 1 when a survivor is unexplained.
    """
    judged = adequacy.known(results)
    missing = len(adequacy.every) - len(judged)
    if missing:
        raise Unjudged(
            f"{missing} of {len(adequacy.every)} mutants are not judged for this code and these vectors; "
            "run without --render"
        )
    text = page(adequacy, judged, explained)
    document = adequacy.code.document
    whole = stamped_adequacy(adequacy.place, document, text)
    write_whole(adequacy.place / adequacy_page(document), whole.encode("utf-8"))
    bad = unexplained(explained, judged) or explanation_problems(explained, judged, complete=True)
    return EXIT_NOT_AS_EXPECTED if bad else 0


def page(adequacy: Adequacy, judged: Sequence[Judged], explained: Sequence[Explained]) -> str:
    """The text of the page, without its stamp."""
    return "\n".join(
        [
            _head(adequacy, judged, explained),
            _by_suite(adequacy, judged),
            _matrix(adequacy, judged),
            _by_module(judged),
            survivors(explained, judged),
            _unmeasured(judged),
            _not_judged(adequacy, judged),
        ]
    )


def _head(adequacy: Adequacy, judged: Sequence[Judged], explained: Sequence[Explained]) -> str:
    counts = Counter(one.word for one in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    open_ones = len(unexplained(explained, judged))
    seconds = sum(one.record["seconds"] for one in judged)
    refusing = sum(one.word == "KILLED" and one.record["reason"].startswith(BY_REFUSAL) for one in judged)
    out = len(adequacy.out_of_scope)
    document = adequacy.code.document
    targets = ", ".join(f"`{one}`" for one in adequacy.targets)
    return f"""# How strong the published vectors are

A suite of test vectors is as good as the faults that it finds. One edit at a time was made in what the `step` functions of
`refimpl/{document}` reach, and each result was run against the vectors of the published targets ({targets}): no theorem, no
property, nothing but inputs and the outputs that must follow. **{counts["KILLED"]} of {real} mutants that behave differently are told from
the shipped code ({percent(counts["KILLED"], real)}); {counts["SURVIVED"]} survive, {open_ones} of them unexplained; {counts["UNMEASURED"]} could not be measured.**

```
.venv/bin/modeproof mutate impl --judge vectors --document {document}            # judges what is not judged yet; can be stopped and taken up again
.venv/bin/modeproof mutate impl --judge vectors --document {document} --show ID  # one edit, what each suite says, what the theorems say
.venv/bin/modeproof mutate impl --judge vectors --document {document} --render   # this page
```

Running the mutants took {seconds / 60:.0f} minutes, all processes together, on a busy machine. The mutants are those of [strength-impl.md](strength-impl.md): {len(judged) + out} in all. {out} of them are
edits of code that no published target reaches, such as that of a device which nobody builds and which has no vectors; they are out of scope here,
and the theorems judge them. The shortest suite is asked first, and a mutant that is caught is not put to the next one.

| word | meaning |
|---|---|
| KILLED | in some scan of some suite its outputs are not those that the vectors demand, or it raises an error. {refusing} of them do nothing else wrong but refuse inputs that they must answer; of such a program the kit says UNJUDGED, and never CONFORMS |
| EQUIVALENT | proved, for all inputs, times and parameters: by the theorem campaign, that it returns the same; or by an observer, that it differs only in memory that nothing reads again, so that nobody can tell it by inputs and outputs |
| SURVIVED | every suite of every target that reaches the edit passes |
| INVALID | the text does not compile; not counted as killed |
| UNMEASURED | a limit of time came first (it may never end); counts against the score |

Before a suite judges any mutant, the shipped code must pass it, and must be caught when its outputs are wrong in the very last scan. The mutants
run in process, without a wire; what an adapter must refuse (suite `refusals`) is therefore not part of this, for no edit is made in an adapter.
What is measured is the power of the vectors against *small* faults of *this* program: another program can be wrong in ways that no edit
of this one is, such as a memory that the specification does not have.
"""


def _until_caught(adequacy: Adequacy, judged: Sequence[Judged]) -> Iterator[tuple[Judged, Mapping[str, Any]]]:
    """The answers up to the first suite that catches a mutant."""
    order = adequacy.names.index
    for one in judged:
        caught = [order(answer["suite"]) for answer in one.record["answers"] if _caught(answer)]
        for answer in one.record["answers"]:
            if order(answer["suite"]) <= min(caught, default=len(adequacy.names)):
                yield one, answer


def _caught(answer: Mapping[str, Any]) -> bool:
    return answer["result"] in (replay.DIFFERS, replay.RAISES)


def _by_suite(adequacy: Adequacy, judged: Sequence[Judged]) -> str:
    real = [one for one in judged if one.word != "EQUIVALENT"]
    answers = list(_until_caught(adequacy, real))
    rows: list[list[object]] = []
    for name in adequacy.names:
        of_suite = [pair for pair in answers if pair[1]["suite"] == name]
        asked = len({one.mutant.id for one, _ in of_suite})
        caught = [answer for _, answer in of_suite if _caught(answer)]
        raised = sum(answer["result"] == replay.RAISES for answer in caught)
        refused = len({one.mutant.id for one, answer in of_suite if answer["result"] == replay.REFUSES})
        until = [answer["scans"] for answer in caught]
        rows.append(
            [
                f"`{name}`",
                f"{sum(one.suite.scan_count for one in adequacy.suites if one.name == name):,}",
                asked,
                len(caught),
                percent(len(caught), asked),
                raised,
                refused,
                f"{median(until):,.0f}" if until else "-",
                f"{max(until):,}" if until else "-",
            ]
        )
    head = ["suite", "scans", "asked", "caught", "of asked", "by an error", "refuse only", "median", "most"]
    text = (
        "## By suite\n\nIn the order of asking, which is that of length; all targets together. Asked: mutants that no suite above has caught. By an error: "
        "caught because a scan raises. Refuse only: not caught by this suite but for refusals; the next suites are asked too. Median and most: scans of the suite that were run until it caught one.\n\n"
    )
    others = [name for name in SUITES if name not in adequacy.names]
    left_out = f"\nNot asked: {names_of(others)}.\n" if others else ""
    return text + markdown(head, rows) + left_out + _alone(adequacy, real)


def _alone(adequacy: Adequacy, real: Sequence[Judged]) -> str:
    """What each suite catches by itself; nothing where not every suite was asked of every mutant."""
    if not real or not all(one.record.get("complete") for one in real):
        return ""
    rows = []
    for name in adequacy.names:
        by_itself = [one for one in real if name in one.killers]
        only = [one for one in by_itself if len(one.killers) == 1]
        rows.append([f"`{name}`", len(by_itself), percent(len(by_itself), len(real)), len(only)])
    head = ["suite", "catches by itself", "of all", "no other suite catches"]
    return (
        f"\nEvery suite was put to every one of the {len(real)} mutants (`--complete`). What each would catch alone:\n\n"
        + markdown(head, rows)
    )


def _matrix(adequacy: Adequacy, judged: Sequence[Judged]) -> str:
    operators = sorted({one.mutant.operator for one in judged})
    rows: list[list[object]] = []
    for operator in operators:
        ones = [one for one in judged if one.mutant.operator == operator]
        first = Counter(one.killers[0] for one in ones if one.word == "KILLED")
        words = Counter(one.word for one in ones)
        cells = [first[name] or "" for name in adequacy.names]
        rest = [words[word] or "" for word in WORDS if word != "KILLED"]
        rows.append([operator, len(ones), *cells, *rest])
    head = [
        "operator",
        "mutants",
        *(f"`{name}`" for name in adequacy.names),
        *(w for w in WORDS if w != "KILLED"),
    ]
    return "## Operators and suites\n\nBy the first suite that catches the mutant.\n\n" + markdown(head, rows)


def _by_module(judged: Sequence[Judged]) -> str:
    rows: list[list[object]] = []
    for module in dict.fromkeys(one.mutant.module for one in judged):
        rows.append([f"`{module}`", *counted([one for one in judged if one.mutant.module == module])])
    rows.append(["**all**", *counted(judged)])
    return "## By module\n\n" + markdown(["module", "mutants", *WORDS, "score"], rows)


def _unmeasured(judged: Sequence[Judged]) -> str:
    ones = [one for one in judged if one.word in ("INVALID", "UNMEASURED")]
    if not ones:
        return ""
    lines = [
        f"- {one.word} `{one.mutant.id}` {edit_of(one.mutant)}: {one.record['reason'][:200]}" for one in ones
    ]
    return "## Invalid, unmeasured\n\n" + "\n".join(lines) + "\n"


def _folded(ones: Sequence[Judged]) -> str:
    lines = [f"<details><summary>{len(ones)} EQUIVALENT</summary>\n"]
    lines += [f"- `{one.mutant.id}` {edit_of(one.mutant)}" for one in ones]
    return "\n".join([*lines, "\n</details>\n\n"]) if ones else ""


def _not_judged(adequacy: Adequacy, judged: Sequence[Judged]) -> str:
    equal = [one for one in judged if one.word == "EQUIVALENT"]
    same = [one for one in equal if one.mutant.id in adequacy.equivalent]
    unseen = [one for one in equal if one.mutant.id not in adequacy.equivalent]
    asked = [one for one in same if one.record["answers"]]
    modules = Counter(one.module for one in adequacy.out_of_scope)
    out = ", ".join(f"{count} of `{module}`" for module, count in sorted(modules.items())) or "none"
    control = (
        f" {len(asked)} of them were run against suites all the same, as a check on both judges, and none was caught."
        if asked
        else ""
    )
    return (
        "## Not judged here\n\n"
        f"- Proved EQUIVALENT by the theorem campaign: {len(same)}; they are listed in [strength-impl.md](strength-impl.md).{control}\n"
        f"- Told by nobody, by the observer (`proofs/mutants/observed.py`): {len(unseen)}. No suite that they were put to catches any of them:\n\n"
        + _folded(unseen)
        + f"- Out of scope, for no published target reaches them: {out}.\n"
    )

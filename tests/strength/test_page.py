"""The page says what the results say, for the specification that they were made from, and is not edited."""

from __future__ import annotations

import csv
import io
import warnings

import pytest

from modeproof.errors import Unjudged
from modeproof.places import documents, root
from modeproof.strength.campaign import Judged, inputs_now
from modeproof.strength.command import summary
from modeproof.strength.judge import Bench
from modeproof.strength.mutant import Mutant
from modeproof.strength.page import page, page_path, render, stamp_of, table
from modeproof.strength.results import Results
from tests.strength.shipped import bench_of, mutants_of

WORDS = ("KILLED", "KILLED", "SURVIVED", "EQUIVALENT", "INVALID")


def judged_as(every: tuple[Mutant, ...], words: tuple[str, ...]) -> list[Judged]:
    made = []
    for one, word in zip(every, words, strict=False):
        killers = ["LitOnlyWhenFull"] if word == "KILLED" else []
        answers = [{"tier": "alone", "asked": ["LitOnlyWhenFull", "OffAtOnce"]}]
        record = {"verdict": word, "killers": killers, "reason": "so", "answers": answers, "seconds": 2.0}
        made.append(Judged(one, record))
    return made


def test_the_summary_counts_what_is_no_mutant_apart(every: tuple[Mutant, ...]) -> None:
    line = summary(judged_as(every, WORDS), 1)
    assert line.startswith(
        "5 mutants: 2 KILLED, 1 EQUIVALENT, 1 SURVIVED, 1 INVALID, 0 UNMEASURED; score 2 of 3"
    )


def test_a_time_out_counts_against_the_score(every: tuple[Mutant, ...]) -> None:
    assert "score 1 of 2 (50.0 %)" in summary(judged_as(every, ("KILLED", "UNMEASURED")), 0)


def test_the_matrix_tells_broken_from_held_from_not_tried(every: tuple[Mutant, ...]) -> None:
    rows = list(csv.DictReader(io.StringIO(table(judged_as(every, WORDS)))))
    assert [row["verdict"] for row in rows] == list(WORDS)
    assert (rows[0]["LitOnlyWhenFull"], rows[0]["OffAtOnce"]) == ("x", "-")
    assert "StartsDark" not in rows[0]


def test_a_page_is_not_rendered_from_results_that_are_not_there(
    bench: Bench, every: tuple[Mutant, ...]
) -> None:
    with pytest.raises(Unjudged, match=f"{len(every)} of {len(every)} mutants are not judged"):
        render(bench, every, Results(bench.place / "none.jsonl"))


RENDERED = [name for name in documents(root()) if (root() / page_path(name)).is_file()]


@pytest.mark.parametrize("document", RENDERED)
def test_the_page_is_as_it_was_rendered_and_tells_what_it_holds_for(document: str) -> None:
    path = page_path(document)
    inputs, untouched = stamp_of(root(), path)
    assert untouched, f"{path} was edited by hand; run modeproof mutate spec --render"
    now = inputs_now(bench_of(document))
    assert set(inputs) == set(now)
    moved = sorted(module for module in now if now[module] != inputs[module])
    if moved:
        warnings.warn(f"{path} holds for an earlier specification of {', '.join(moved)}", stacklevel=1)


@pytest.mark.parametrize("document", RENDERED)
def test_every_explained_survivor_is_a_mutant_and_on_the_page(document: str) -> None:
    bench = bench_of(document)
    text = (root() / page_path(document)).read_text(encoding="utf-8")
    assert ("## Survivors\n\nNone.\n" in text) == (not bench.strength.explained)
    ids = {one.id for one in mutants_of(document)} if bench.strength.explained else set()
    for explained in bench.strength.explained:
        for id in explained.ids:
            assert "*" in id or id in ids, f"{id} is explained and is no mutant"
            assert "*" in id or id in text, f"{id} is explained and not on the page"


def test_a_page_says_what_was_not_asked(
    bench: Bench, every: tuple[Mutant, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    import modeproof.strength.page as module

    class Document:
        properties = ()
        runs = ()

    monkeypatch.setattr(module, "load_document", lambda *_: Document())
    text = page(bench, judged_as(every, WORDS))
    assert "| `Lamp` | 5 | 2 | 1 | 1 | 1 | 0 | 66.7 % |" in text
    assert "**Not explained.**" in text and "1 INVALID" in text

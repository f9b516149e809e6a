"""The page of a document is what the registers give: every way in which it can drift is found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from modeproof.ground.places import documents
from modeproof.ground.places import root as repository_root
from modeproof.registers import load_document, read_sources
from modeproof.registers.document_page import check_document_page, page, page_name, tables_of, tellings
from modeproof.registers.findings_page import findings_pages

TABLE = "| scan | executes |\n|---|---|\n| 0 | power-up |\n"
TELLING = '\n[finding.telling]\nrun = "NEG_Latch"\nstory = "The door is open, and the bolt comes out"\n'


def made(root: Path) -> str:
    """The page as the registers of the door give it, with a table of its counterexample."""
    document = load_document(root, "door")
    return page(document, read_sources(document), {telling.run: TABLE for _, telling in tellings(document)})


def problems(root: Path) -> list[str]:
    document = load_document(root, "door")
    return [one.text for one in check_document_page(document, read_sources(document))]


@pytest.fixture
def told(tree: Any) -> Any:
    """The door with a telling counterexample, a recorded campaign, and its page."""
    findings = (tree.root / "spec/door/findings.toml").read_text(encoding="utf-8")
    tree.write("spec/door/findings.toml", findings + TELLING)
    tree.write("docs/door.md", made(tree.root))
    for name, text in findings_pages(load_document(tree.root, "door")).items():
        tree.write(name, text)
    return tree


def test_the_page_tells_story_requirement_table_and_finding(told: Any) -> None:
    text = (told.root / "docs/door.md").read_text(encoding="utf-8")
    for expected in (
        "# A door",
        "**What we did not have.** The drawings.",
        "  - how much: 1 in 2 runs\n",
        "**theorems about our program for all words and times, by two solvers**\n  - how much: 1\n",
        "### E-01: when it opens\n\nThe door is open, and the bolt comes out.\n\n"
        "What fails: While the door is open the bolt is in. (`OpenIsUnlocked`)\n\n<!-- begin trace NEG",
        TABLE,
        "`modeproof check NEG_Latch --trace`",
        "1 of 4 clauses are not modelled",
    ):
        assert expected in text, text
    findings = (told.root / "docs/door-findings.md").read_text(encoding="utf-8")
    assert "**E-01 †: when it opens.** Nothing.\n- *Decided:* At once." in findings
    assert problems(told.root) == []


def test_without_a_page_nothing_is_said(tree: Any) -> None:
    assert problems(tree.root) == []


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("docs/door.md", "the bolt comes out", "the bolt stays in"),
        ("spec/door/findings.toml", 'decision = "at once"', 'decision = "later"'),
        ("spec/door/findings.toml", "the bolt comes out", "the bolt stays in"),
        ("spec/door/properties.toml", "the bolt is in", "the bolt is out"),
        ("spec/door/clauses.toml", "the drawings", "the index"),
        ("proofs/door/bolt.py", "@theorem", "@other"),
    ],
    ids=lambda text: text.strip()[:24],
)
def test_a_page_and_registers_that_differ_are_found(told: Any, file: str, old: str, new: str) -> None:
    told.edit(file, old, new)
    (problem,) = problems(told.root)
    assert "is not what the registers give; if that was not meant, undo it" in problem


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("docs/door.md", "| 0 | power-up |", "| 0 | power-down |"),
        ("docs/door.md", "<!-- end trace -->\n", ""),
        (
            "spec/door/runs.toml",
            'property = "OpenIsUnlocked"',
            'property = "OpenIsUnlocked"\ntrace_length = 9',
        ),
    ],
)
def test_a_table_that_left_its_run_is_found(told: Any, file: str, old: str, new: str) -> None:
    told.edit(file, old, new)
    (problem,) = problems(told.root)
    assert problem.startswith(
        "the table of NEG_Latch is missing, was changed by hand, or its run has changed"
    )


def test_a_reading_that_is_tried_is_named(told: Any) -> None:
    document = load_document(told.root, "door")
    runs = [msgspec.structs.replace(run, base="MC_Latch", reading="Slow") for run in document.runs]
    changed = replace(document, runs=tuple(runs))
    text = page(changed, read_sources(document), {"NEG_Latch": TABLE})
    assert "`modeproof check NEG_Latch --trace` tries the reading `Slow`." in text


def test_a_run_with_another_reading_is_counted_apart(told: Any) -> None:
    document = load_document(told.root, "door")
    slow = msgspec.structs.replace(document.runs[0], id="MC_Latch_slow", base="MC_Latch", reading="Slow")
    further = msgspec.structs.replace(slow, id="OPEN_Latch_with_Slow", of=("MC_Latch_slow", "OPEN_Latch"))
    changed = replace(document, runs=(*document.runs, slow, further))
    text = page(changed, read_sources(document), {"NEG_Latch": TABLE})
    assert "within the bounds of each run**\n  - how much: 1 in 2 runs\n" in text
    shown = "how much: 1 in 2 runs\n  - command: `modeproof check --document door MC_Latch_slow '*_with_*'`"
    assert f"in every module and profile**\n  - {shown}" in text


def test_what_changes_no_counterexample_leaves_its_table(told: Any) -> None:
    told.edit(
        "spec/door/runs.toml", 'property = "OpenIsUnlocked"', 'property = "OpenIsUnlocked"\nworkers = 2'
    )
    assert problems(told.root) == []


def test_a_telling_run_that_is_no_evidence_is_found(told: Any) -> None:
    told.edit("spec/door/findings.toml", 'run = "NEG_Latch"', 'run = "MC_Latch"')
    assert problems(told.root) == ["telling: MC_Latch is no counterexample of it"]


@pytest.mark.parametrize("name", documents(repository_root()))
def test_each_document_has_its_page_with_telling_counterexamples(name: str) -> None:
    document = load_document(repository_root(), name)
    text = (repository_root() / page_name(name)).read_text(encoding="utf-8")
    assert 3 <= len(tellings(document)) <= 5
    assert set(tables_of(document, text)) == {telling.run for _, telling in tellings(document)}
    listed = "".join(findings_pages(document).values())
    for finding in document.findings:
        assert f"**{finding.id}" in listed

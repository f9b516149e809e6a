"""The page of proofs: every theorem once, from evidence; drift is found by its stamp."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.registers import proofs_page
from modeproof.registers.load import load_document
from modeproof.registers.proofs_page import check_proofs_page, comparable, theorems_by_file
from modeproof.registers.rows import Document
from modeproof.report.proofs import render_proofs

ROOT = Path(__file__).parents[2]
QUERIES = [
    {"expected": "unsat", "twin_of": "", "core": ["counterexample"]},
    {"expected": "sat", "twin_of": "a", "core": None},
    {"expected": "sat", "twin_of": "", "core": None},
]


@pytest.fixture(scope="module")
def document() -> Document:
    return load_document(ROOT, "mode_selection")


def _evidence(document: Document, seconds: float = 1.5) -> dict[str, dict[str, Any]]:
    tools = {"z3": {"version": "4.99"}, "cvc5": {"version": "1.99"}}
    records: dict[str, Any] = {
        one.name: {
            "id": one.name,
            "verdict": "PROVED",
            "seconds": seconds,
            "tools": tools,
            "result": {
                "sentence": one.sentence,
                "clauses": list(one.clauses),
                "findings": list(one.findings),
                "properties": list(one.properties),
                "premises": ["a premise", "another"],
                "unused": ["a premise", "another"] if number == 0 else ["another"],
                "shared": seconds,
                "queries": QUERIES,
            },
        }
        for rows in theorems_by_file(document).values()
        for number, one in enumerate(rows)
    }
    device = {
        **{"states": 4, "paths": 4541, "lines": [16, 17], "branches": [7, 8], "answers": [3, 4]},
        "unreachable": [{"what": "line step: raise", "why": "a refusal"}],
    }
    records["coverage"] = {"result": {"devices": {"plc": device}}}
    row = {"id": "One", "environment": "honest", "tlc": "HOLDS", "theorem": "a_theorem", "proved": "PROVED"}
    row |= {"rests_on": ["A-01", "A-02"], "reason": "", "note": "in part"}
    other = {
        **row,
        "id": "Two",
        "theorem": "",
        "proved": "",
        "rests_on": [],
        "reason": "it moves",
        "note": "",
    }
    records["agreement"] = {"verdict": "EQUAL", "result": {"rows": [row, other], "problems": []}}
    return records


def test_every_theorem_is_on_the_page_once_with_clauses_questions_and_versions(document: Document) -> None:
    page = render_proofs(document, _evidence(document))
    theorems = [one for rows in theorems_by_file(document).values() for one in rows]
    assert len(theorems) > 40
    for one in theorems:
        (row,) = [line for line in page.splitlines() if f" `{one.name}` |" in line and line[0] == "|"]
        assert one.sentence in row
        assert ", ".join(one.clauses) in row
        assert row.endswith("| 1 claims, 1 twins, 1 examples | 1.5 |")
    assert "z3 4.99 and cvc5 1.99" in page
    assert f"{len(theorems)} theorems, {3 * len(theorems):,} questions" in page
    assert "In no theorem at all: another." in page
    assert page.count("`: a premise\n") == len(theorems_by_file(document))
    assert "| `plc` | 4 | 4,541 | 16 of 17 | 7 of 8 | 3 of 4 |" in page
    assert "EQUAL: 1 of 2 by both." in page
    assert "| One | honest | HOLDS | PROVED | `a_theorem`: in part | A-01, A-02 |" in page
    assert "| Two | honest | HOLDS | not proved | it moves |  |" in page
    assert "- a refusal\n  - `plc` line step: raise" in page


def test_a_theorem_without_evidence_is_no_page(document: Document) -> None:
    evidence = _evidence(document)
    del evidence["each_mode_has_its_own_acknowledgment_word"]
    with pytest.raises(KeyError):
        render_proofs(document, evidence)


def test_only_how_long_it_took_is_not_compared(document: Document) -> None:
    one, other = (render_proofs(document, _evidence(document, seconds)) for seconds in (1.5, 1234.5))
    assert one != other
    assert comparable(one) == comparable(other)
    assert comparable(one.replace("4.99", "5.00")) != comparable(one)
    assert comparable(one.replace("1 claims", "2 claims", 1)) != comparable(one)


def page(document: Document, root: Path) -> Path:
    return root / proofs_page.proofs_page(document.name)


@pytest.fixture
def root(document: Document, tmp_path: Path) -> Path:
    page(document, tmp_path).parent.mkdir(parents=True)
    page(document, tmp_path).write_text(render_proofs(document, _evidence(document)), encoding="utf-8")
    return tmp_path


def _texts(root: Path, document: Document) -> list[str]:
    return [problem.text.split(";")[0] for problem in check_proofs_page(root, document)]


def test_a_page_as_rendered_has_not_drifted_and_without_one_nothing_is_said(
    document: Document, root: Path
) -> None:
    assert _texts(root, document) == []
    page(document, root).unlink()
    assert _texts(root, document) == []


def test_a_page_changed_by_hand_is_found(document: Document, root: Path) -> None:
    text = page(document, root).read_text(encoding="utf-8")
    page(document, root).write_text(text.replace("PROVED", "HOLDS", 1), encoding="utf-8")
    assert _texts(root, document) == ["the page was changed by hand"]
    page(document, root).write_text(text.rsplit("<!--", 1)[0], encoding="utf-8")
    assert _texts(root, document) == ["the page has no stamp"]


def test_a_theorem_that_says_something_else_now_is_found(
    document: Document, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = theorems_by_file(document)
    file, rows = next(iter(found.items()))
    monkeypatch.setattr(proofs_page, "theorems_by_file", lambda document: {**found, file: rows[1:]})
    assert _texts(root, document) == ["the theorems have changed since the page was rendered"]

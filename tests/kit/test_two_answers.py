"""A program and its page: the first answer, whatever the reference does; and patience with what must come."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.kit.text import as_junit, as_record, as_text
from modeproof.kit.two_answers import judge_both
from modeproof.kit.verdict import Plan
from tests.kit.lamps import DEMANDS, Lamp, made

COMES = {
    "id": "LampComes",
    "says": "The code turns the lamp on.",
    "clauses": ["TOY-1"],
    "when": "press and word == CODE",
    "comes": "LAMP",
}
ASKED = {**DEMANDS, "demands": [*DEMANDS["demands"], COMES]}  # type: ignore[misc]


class OwnWord(Lamp):
    """Follows the page, and shows another word than the reference."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {**out, "MW": "1234"}


class AlwaysOn(Lamp):
    """Breaks the page in its first scan."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {**out, "LAMP": True}


class Dead(Lamp):
    """Does nothing, which no `only if` forbids."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"LAMP": False, "MW": "0000"}


def test_who_follows_the_page_may_differ_from_the_reference(tmp_path: Path) -> None:
    suite = made(tmp_path, "brief")
    verdict = judge_both(suite, OwnWord)
    assert verdict.page is not None
    assert (verdict.page.word, verdict.word, verdict.status) == ("FOLLOWS", "DIFFERS", 0)
    text = as_text(verdict, suite=suite)
    assert text.index("FOLLOWS(1 demands, brief") < text.index("DIFFERS: ") and "--same" in text
    assert 'failures="0"' in as_junit([verdict])
    assert as_record(verdict)["page"]["verdict"] == "FOLLOWS"
    assert judge_both(suite, OwnWord, same=True).status == 1


def test_who_breaks_the_page_is_told_so_first(tmp_path: Path) -> None:
    suite = made(tmp_path, "brief")
    verdict = judge_both(suite, AlwaysOn)
    assert verdict.page is not None and (verdict.page.word, verdict.status) == ("BREAKS", 1)
    text = as_text(verdict, suite=suite)
    assert "BREAKS LightNeedsCode (TOY-1)" in text and "The lamp goes on only with its code." in text


def test_a_program_that_does_nothing_follows_no_page(tmp_path: Path) -> None:
    suite = made(tmp_path, "brief", ASKED)

    plan = Plan(effort=20)
    verdict = judge_both(suite, Dead, plan)
    assert verdict.page is not None and verdict.page.word == "BREAKS"
    found = verdict.page.difference
    assert found is not None and found.broken == "LampComes" and found.confirmed
    right = judge_both(suite, Lamp, plan).page
    assert right is not None and right.word == "FOLLOWS", right.reason


def test_without_demands_the_reference_alone_is_the_answer(tmp_path: Path) -> None:
    verdict = judge_both(made(tmp_path, "brief", None), OwnWord)
    assert verdict.page is None and (verdict.word, verdict.status) == ("DIFFERS", 1)

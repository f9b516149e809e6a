"""Suite `wp1`: no wrong program with one state more than the graph passes; its cases are made, not stored."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.errors import Unjudged
from modeproof.kit.judge import CONFORMS, run_suite
from modeproof.kit.rule import words as words_of
from modeproof.kit.vectors import open_suite
from modeproof.suites.extra import harmonized
from modeproof.suites.identify import Machine, separating_columns
from modeproof.suites.lint import lint
from modeproof.suites.wp import words
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.programs import starter
from tests.suites.test_wp import LETTERS_3, TWO, answers, same


def rule(of: Machine) -> dict[str, Any]:
    return {
        "sub": len(of.columns),
        "next": of.next_of,
        "cover": of.cover,
        "identify": harmonized(of, separating_columns(of)),
    }


def test_no_wrong_machine_of_three_states_passes_what_is_made_for_two_and_one_more() -> None:
    freed = 0
    for table, found in TWO[::9]:
        every = {word: answers(table, word) for word in words_of(rule(found))}
        shorter = {word: answers(table, word) for word in words(found)}
        for other in LETTERS_3:
            if all(answers(other, word) == good for word, good in every.items()):
                assert same(table, other)
            elif all(answers(other, word) == good for word, good in shorter.items()):
                freed += 1
    assert freed > 0, "machines with a state more pass wp; that is what this suite is for"


def test_any_two_states_share_what_tells_them_apart() -> None:
    for _, found in TWO:
        one, other = harmonized(found, separating_columns(found))
        begins = [{word[:n] for word in row for n in range(1, len(word) + 1)} for row in (one, other)]
        assert any(found.apart_at(0, 1, word) for word in begins[0] & begins[1])


def test_a_file_holds_the_table_and_its_cases_are_as_many_as_it_says(tmp_path: Path) -> None:
    for name in ("a", "b"):
        stats = write_suite(tmp_path / name, "wp1", [lamp_graph(tmp_path)])
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    suite = open_suite(tmp_path / "a")
    cases = list(suite.cases())
    assert len((tmp_path / "a").read_text(encoding="utf-8").splitlines()) == 1
    assert len(cases) == suite.case_count == stats.cases
    assert sum(len(case.scans) for case in cases) == suite.scan_count
    assert lint(tmp_path / "a") == []
    verdict = run_suite(suite, starter(tmp_path))
    assert verdict.word == CONFORMS and all(have == all_ for have, all_ in verdict.covered.values())
    assert run_suite(suite, starter(tmp_path, "LIMIT = 501")).word != CONFORMS


@pytest.mark.parametrize(("name", "value"), [("sub", 1), ("letters", []), ("identify", None)])
def test_a_rule_that_was_spoiled_is_not_judged(tmp_path: Path, name: str, value: object) -> None:
    write_suite(tmp_path / "a", "wp1", [lamp_graph(tmp_path)])
    header = json.loads((tmp_path / "a").read_text(encoding="utf-8"))
    header["graphs"][0]["rule"][name] = value
    (tmp_path / "a").write_text(json.dumps(header) + "\n", encoding="utf-8")
    with pytest.raises(Unjudged):
        list(itertools.islice(open_suite(tmp_path / "a").cases(), 100_000))

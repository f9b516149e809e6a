"""Single input changes: never two at once, compared when settled, and nothing they can reach is missed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from modeproof.ground.places import root
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.programs import starter
from tests.suites.relay import relay_graph

LATE = """
last = [{"LAMP": False, "MW": "0000"}] * 3
exact = scan
def scan(m):
    last.append(exact(m))
    return last[-3]
"""


LEVELS, SELECTIONS = ["0F0F", "0FF0", "3333", "33CC", "3C3C"], ["0FF0", "3333", "33CC", "3C3C", "0F0F"]


def test_the_printed_sequences_are_walked_with_single_changes() -> None:
    drawn = [case.why for case in open_suite(root() / "vectors/sf_edm/sequences.jsonl.gz").cases()]
    found = [case for case in open_suite(root() / "vectors/sf_edm/sic.jsonl.gz").cases() if case.clauses]
    slow = [case for case in found if case.why.endswith(" Inputs change one at a time.")]
    assert [case.why.removesuffix(" Inputs change one at a time.") for case in slow] == drawn
    for case in slow:
        for before, now in zip(case.scans, case.scans[1:], strict=False):
            assert sum(now.inputs[name] != before.inputs[name] for name in now.inputs) <= 1


@pytest.mark.deep
def test_each_level_is_tried_with_each_selection_that_it_forbids() -> None:
    found = set()
    for case in open_suite(root() / "vectors/fplc/sic.jsonl.gz").cases():
        settled = before = ""
        for scan in case.scans:
            if settled in LEVELS and scan.inputs["MW03"] != before and scan.inputs["MW03"] in SELECTIONS:
                level, mode = LEVELS.index(settled), SELECTIONS.index(scan.inputs["MW03"])
                found.update({(level, mode)} if "PERMITS_1" not in case.params and mode > level else ())
            before = scan.inputs["MW03"]
            settled = scan.outputs["MW01"] if scan.compared else settled
    assert len(found) == 10


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    write_suite(tmp_path / "sic.jsonl", "sic", [lamp_graph(tmp_path)])
    return open_suite(tmp_path / "sic.jsonl")


def test_no_two_inputs_change_together_nor_with_the_time(suite: Suite) -> None:
    for case in suite.cases():
        for before, now in zip(case.scans, case.scans[1:], strict=False):
            changed = [name for name in now.inputs if now.inputs[name] != before.inputs[name]]
            assert len(changed) + (now.dt_ms > 0) <= 1
            if changed or now.dt_ms:
                assert before.compared, "the one before had settled"
        assert case.scans[-1].compared and not case.scans[-2].compared


def test_every_transition_is_taken_or_listed(suite: Suite, tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path).graph
    every = {
        (state, graph.steps[step], after)
        for state in range(len(graph.views))
        for step, after in zip(graph.step_of[state], graph.next_of[state], strict=True)
    }
    taken = set()
    for case in suite.cases():
        state = case.initial
        for scan in case.scans:
            taken.add((state, suite.steps[scan.step].name, scan.to))
            state = scan.to
    header = suite.header["graphs"][0]
    missed = sum(count for *_, count in header["not_so_places"])
    assert taken <= every and len(every - taken) == missed
    assert sum(int(text.split()[0]) for text in header["not_so"].values()) == missed


def test_what_needs_two_changes_at_once_is_listed(tmp_path: Path) -> None:
    """A lamp that is pressed in every other letter only: the code and the button never come one by one."""
    from tests.graph.printed import LETTERS, lines

    def kept(line: str) -> bool:
        return "word |-> 4080" not in line or "press |-> TRUE" in line

    gone = [n for n, (press, word, _) in enumerate(LETTERS) if word == 0x0FF0 and not press]
    gone += [n for n, (press, word, _) in enumerate(LETTERS) if press and word in (0, 1)]
    printed = [
        line
        for line in lines()
        if kept(line)
        and not any(line.startswith(f'<<"INPUT", {n},') for n in gone)
        and not any(f", {n}, <<" in line for n in gone)
    ]
    write_suite(tmp_path / "sic.jsonl", "sic", [lamp_graph(tmp_path, printed, sequences="")])
    header = json.loads((tmp_path / "sic.jsonl").read_text(encoding="utf-8").splitlines()[0])
    assert header["graphs"][0]["not_so"]["SwitchOn"] == "1 of 1"


def test_the_right_program_passes_even_if_it_settles_late(suite: Suite, tmp_path: Path) -> None:
    assert run_suite(suite, starter(tmp_path)).word == CONFORMS
    assert run_suite(suite, starter(tmp_path, LATE)).word == CONFORMS


@pytest.mark.parametrize(
    "fault", ["LIMIT = 501", "same = lambda word: False", LATE.replace("-3", "-5").replace("* 3", "* 5")]
)
def test_a_wrong_program_is_caught(suite: Suite, tmp_path: Path, fault: str) -> None:
    assert run_suite(suite, starter(tmp_path, fault)).word == DIFFERS


def test_a_device_that_goes_round_settles_by_its_outputs(tmp_path: Path) -> None:
    write_suite(tmp_path / "sic.jsonl", "sic", [relay_graph(tmp_path)])
    header = json.loads((tmp_path / "sic.jsonl").read_text(encoding="utf-8").splitlines()[0])
    graph = header["graphs"][0]
    assert graph["unsettled"] == 0 and header["transitions"] > 18

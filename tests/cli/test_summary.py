"""The summary says what the evidence says, never more."""

from __future__ import annotations

import io
from typing import Any

from modeproof.ground.progress import Progress
from modeproof.lane.summary import failures, render, total
from modeproof.report.verdicts import ASIDE, PropertyRow, property_lines, status_of


def tlc(id: str, **changes: Any) -> dict[str, Any]:
    result = {"run": id.split("_")[0], "properties": ["Safe"], "distinct": 16, **changes.pop("result", {})}
    base = {
        "kind": "tlc",
        "id": id,
        "document": "toy",
        "verdict": "HOLDS",
        "as_expected": True,
        "environment": "honest",
        "strength": "all levels",
        "seconds": 2.0,
        "reason": "",
        "result": result,
    }
    return {**base, **changes}


SAFE = PropertyRow("Safety", "Safe", ("honest",))
DECLARED = {"MC_a": {("Safe", "honest")}}


def test_a_property_has_the_verdict_of_its_run() -> None:
    (line,) = property_lines([SAFE], [tlc("MC_a")], DECLARED)
    assert (line.verdict, line.environment, line.distinct, line.status) == ("HOLDS", "honest", 16, 0)


def test_a_property_that_no_run_checks_is_unjudged() -> None:
    (line,) = property_lines([SAFE], [tlc("MC_a", environment="arbitrary")], {})
    assert (line.verdict, line.status) == ("UNJUDGED", 2)
    assert "no run checks it" in failures([], [line])[0]


def test_a_line_names_each_profile_in_which_the_property_holds() -> None:
    letter = tlc("MC_a", strength="profile letter; any input")
    runs = [letter, tlc("MC_b", strength="profile neither; any input")]
    (line,) = property_lines([SAFE], runs, DECLARED)
    assert line.strength == "profile letter; any input"
    runs.append(tlc("MC_c", strength="profile cautious; any input"))
    (line,) = property_lines([SAFE], runs, DECLARED)
    assert line.strength == "profile letter; any input; and in the profile cautious"
    runs.append(tlc("MC_d", strength="profile cautious; time 0", verdict="INCONCLUSIVE", as_expected=False))
    (line,) = property_lines([SAFE], runs, DECLARED)
    assert line.strength == "profile cautious; time 0"


def test_a_property_of_another_lane_is_named_and_not_counted() -> None:
    (line,) = property_lines([SAFE], [], DECLARED)
    assert (line.verdict, line.status) == (ASIDE, 0)
    assert render("toy", [line], [], width=100) == (
        "== toy\n0 of 1 properties checked, by environment; not in this lane: Safety (honest)"
    )


def test_a_lane_says_how_many_properties_it_checked() -> None:
    other = PropertyRow("Other", "Other", ("honest",))
    declared = {**DECLARED, "MC_b": {("Other", "honest")}}
    lines = property_lines([SAFE, other], [tlc("MC_a")], declared)
    said = "properties   1 of 2 checked in this lane, 1 of 1 hold, by environment"
    assert said in total(2, lines, [], 1.0)
    assert "properties   1 of 1 hold, by environment" in total(2, lines[:1], [], 1.0)


def test_the_weakest_of_several_runs_counts() -> None:
    weak = tlc("MC_b", verdict="INCONCLUSIVE", as_expected=False, reason="time limit")
    (line,) = property_lines([SAFE], [tlc("MC_a"), weak], DECLARED)
    assert (line.verdict, line.status) == ("INCONCLUSIVE", 2)


def test_among_equals_the_run_that_is_declared_first_is_shown() -> None:
    declared = {"MC_strong": {("Safe", "honest")}, "MC_small": {("Safe", "honest")}}
    small = tlc("MC_small", strength="two levels", result={"distinct": 99})
    (line,) = property_lines([SAFE], [small, tlc("MC_strong")], declared)
    assert (line.strength, line.distinct, line.seconds) == ("all levels", 16, 4.0)


def test_holding_with_other_counts_is_no_clean_holds() -> None:
    other = tlc("MC_a", as_expected=False, reason="distinct states: 16, pinned 17")
    (line,) = property_lines([SAFE], [other], DECLARED)
    assert (line.verdict, line.status) == ("HOLDS?", 1)


def test_another_propertys_violation_tells_nothing_about_this_one() -> None:
    other = tlc("MC_a", verdict="VIOLATED", as_expected=False, reason="x", result={"violated": "Other"})
    assert property_lines([SAFE], [other], DECLARED)[0].verdict == "INCONCLUSIVE"
    own = tlc("MC_a", verdict="VIOLATED", as_expected=False, reason="x", result={"violated": "Safe"})
    assert property_lines([SAFE], [own], DECLARED)[0].verdict == "VIOLATED"


def test_negatives_do_not_stand_for_a_property() -> None:
    (line,) = property_lines([SAFE], [tlc("NEG_a", verdict="VIOLATED")], {})
    assert line.verdict == "UNJUDGED"


def test_the_screen_lists_each_property_and_counts_the_rest() -> None:
    records = [
        tlc("MC_a"),
        tlc("NEG_a", verdict="VIOLATED"),
        tlc("NEG_b", verdict="HOLDS", as_expected=False, reason="x"),
        tlc("WIT_a", verdict="REACHED"),
    ]
    lines = property_lines([SAFE], records, DECLARED)
    screen = render("toy", lines, records, width=100)
    assert "Safety   HOLDS   honest" in screen and all(len(line) <= 100 for line in screen.splitlines())
    assert "negatives    1 of 2 VIOLATED, as expected, by the named property, 4.0 s; NOT: NEG_b" in screen
    assert "witnesses    1 of 1 REACHED" in screen


def test_another_jar_than_the_pinned_one_is_said() -> None:
    note = "pinned counts were taken with another jar"
    assert f"note         {note}" in render("toy", [], [tlc("MC_a", result={"jar_note": note})], width=100)


def test_status_follows_the_verdict() -> None:
    assert status_of(tlc("MC_a")) == 0
    assert status_of(tlc("MC_a", as_expected=False)) == 1
    assert status_of(tlc("MC_a", as_expected=False, verdict="UNJUDGED")) == 2


def test_progress_elsewhere_than_on_a_terminal_is_whole_lines() -> None:
    stream = io.StringIO()
    progress = Progress(stream)
    progress.expect(1)
    progress.begin("MC_a")
    progress._last -= 60
    progress.update("MC_a", "12 distinct")
    progress.update("MC_a", "13 distinct")
    progress.end("MC_a")
    assert stream.getvalue() == "[0/1] MC_a 0 s, 12 distinct\n"

"""The explanation names the step, the conjunct that was false and its place, and what was expected."""

from __future__ import annotations

import pytest

from modeproof.ground.places import root
from modeproof.tlc.parse_tree import read_tree
from modeproof.tlc.toolchain import find_toolchain
from modeproof.trace.guards import Guards
from modeproof.trace.log_judge import Graphs, why_not
from modeproof.trace.targets import find_target, targets_of
from modeproof.trace.text import as_record, as_text
from modeproof.trace.why import Why
from tests.trace.judging import example, judge

DOCUMENT = "mode_selection"


@pytest.fixture(scope="module")
def explained(graphs: Graphs) -> dict[str, tuple[Why, str]]:
    target = find_target(root(), "fplc")
    names = ("fplc_wrong_echo.jsonl", "fplc_short_dwell.jsonl", "fplc_skipped_step.jsonl")
    found = {}
    for name, one in zip(
        names, judge("fplc", [example("fplc", name) for name in names], graphs), strict=True
    ):
        why = why_not(root(), target, one, graphs, find_toolchain())
        assert why is not None
        assert as_record(target, one, why)["why"]["device"] == "fplc"
        found[name] = (why, as_text(target, one, why))
    return found


def test_a_wrong_output_stands_beside_the_expected_with_its_cause(
    explained: dict[str, tuple[Why, str]],
) -> None:
    why, text = explained["fplc_wrong_echo.jsonl"]
    (taken,) = why.taken
    assert (taken.step, taken.wrong, taken.expected["MW05"]) == ("PublishEcho", ("MW05",), 0x33CC)
    assert any('"AwaitAcknowledgment"' in one.text for one in taken.effects)
    assert why.before["state"] == '"EchoSelection"' and "EKS-2-20" in taken.cites
    assert "MW05    33CC       0FF0\n" in text
    assert taken.outputs[0][0].startswith("MW05 == IF fplcState") and taken.outputs[0][1].module == "Fplc"


def test_a_dwell_short_by_one_ms_shows_both_conjunct_sides(explained: dict[str, tuple[Why, str]]) -> None:
    why, text = explained["fplc_short_dwell.jsonl"]
    missed = why.missed[0]
    assert (missed.step, missed.conjunct.chain, missed.sides) == ("LeaveSettle", ("Dwelt(i)",), ("99", "100"))
    assert missed.conjunct.text.startswith("Now(i) >= T_DWELL")
    line = (
        (root() / "spec" / DOCUMENT / "Fplc.tla")
        .read_text()
        .splitlines()[missed.conjunct.place.first_line - 1]
    )
    assert "Dwelt(i) == Now(i) >= T_DWELL" in line
    assert why.taken[0].step == "AwaitSettled" and why.lost is None
    assert f"{missed.conjunct.place}: Now(i) >= T_DWELL" in text


def test_the_page_about_logs_shows_what_is_printed(explained: dict[str, tuple[Why, str]]) -> None:
    page = (root() / "docs/logs.md").read_text()
    shown = next(block for block in page.split("```\n") if block.startswith("first impossible scan"))
    printed = explained["fplc_short_dwell.jsonl"][1].replace(str(root()) + "/", "") + "\n"
    assert printed.endswith(shown)


def test_a_step_left_out_is_named_and_a_scan_missing(explained: dict[str, tuple[Why, str]]) -> None:
    why, _ = explained["fplc_skipped_step.jsonl"]
    assert [one.step for one in why.missed] == ["SwitchMode"] and why.taken[0].step == "MatchWords"
    assert (why.missed[0].conjunct.text, why.missed[0].sides) == (
        'fplcState = "Switch"',
        ('"Match"', '"Switch"'),
    )
    assert "E-42" in why.missed[0].cites
    assert why.lost == 1


@pytest.mark.deep
def test_in_the_whole_system_the_wire_is_named(graphs: Graphs) -> None:
    target = find_target(root(), "key_flows")
    (one,) = judge("key_flows", [example("key_flows", "key_flows_lost_word.jsonl")], graphs)
    why = why_not(root(), target, one, graphs, find_toolchain())
    assert why is not None and why.wrong_input == ("MW07", 0x3C3C, "plc") and why.fits_alone
    assert "the input MW07 is not what plc last wrote: 3C3C" in as_text(target, one, why)


@pytest.mark.deep
def test_every_step_of_each_device_has_its_own_guard() -> None:
    spec = root() / "spec"
    for target in targets_of(root(), DOCUMENT):
        if target.system or target.id not in ("fplc", "eks"):
            continue
        tree = read_tree(spec / DOCUMENT, target.module, find_toolchain(), spec / "common")
        steps = target.only.device.steps
        guards = Guards(tree, target.only.scan, steps)
        for step in steps:
            assert guards.paths(step), step
            assert any(one.sets for one in guards.effects(step)), step
        assert set(guards.row(target.only.row)) == set(target.only.device.outputs)
        assert len(guards.view(target.only.view)) == len(target.only.device.memory)


def test_beyond_an_else_the_condition_is_denied() -> None:
    """IF CheckPasses(i) THEN FplcStep(i) ELSE ...: a step of the ELSE rests on the failed check."""
    spec = root() / "spec"
    (target,) = (one for one in targets_of(root(), DOCUMENT) if one.id == "fplc" and not one.system)
    tree = read_tree(spec / DOCUMENT, target.module, find_toolchain(), spec / "common")
    guards = Guards(tree, target.only.scan, target.only.device.steps)
    (way,) = guards.paths("KeyGone")
    assert way[0].text == "~(CheckPasses(i))" and way[0].meaning.startswith("CheckPasses(i) ==")
    assert all(one[0].text != way[0].text for one in guards.paths("SwitchMode"))
    made = next(text for text in guards.made if "~(" in text)
    assert made.split("==", 1)[1].split() == ["~(", "CheckPasses(i)", ")"]

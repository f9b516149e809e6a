"""The three relations: what each lets pass, and what each finds."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.adapter import Adapter
from modeproof.kit.relation import groups
from modeproof.kit.suite_judge import Options, Plan, Verdict, run_suite
from modeproof.kit.text import as_record, as_text
from modeproof.kit.vectors import Case, Suite
from tests.kit.clocks import Clock, set_clock
from tests.kit.lamps import (
    Lamp,
    Late,
    Slow,
    SlowAndFlickering,
    SlowAndWrong,
    SlowerThanItSays,
    made,
)
from tests.kit.programs import PATIENT_S, program


@pytest.fixture
def sic(tmp_path: Path) -> Suite:
    return made(tmp_path, "sic")


@pytest.fixture
def tour(tmp_path: Path) -> Suite:
    return made(tmp_path, "tour")


def judged(suite: Suite, start: Callable[[], Any], relation: str, **options: Any) -> Verdict:
    programs: list[Lamp] = []

    def started() -> Any:
        programs.append(start())
        return programs[-1]

    verdict = run_suite(suite, started, plan=Plan(Options(relation, **options), effort=30))
    assert all(one.closed for one in programs), "a program was not closed"
    return verdict


def test_a_slow_program_passes_settled_and_monitor_and_not_exact(sic: Suite) -> None:
    assert judged(sic, Slow, "settled").word == "CONFORMS"
    assert judged(sic, Slow, "monitor").word == "FOLLOWS"
    assert "does not offer relation exact" in judged(sic, Slow, "exact").reason

    class Boasting(Slow):
        hello_says = {"relations": ["exact"], "max_latency_scans": 0}  # noqa: RUF012

    assert judged(sic, Boasting, "exact").word == "DIFFERS"


@pytest.mark.parametrize("relation", ["exact", "settled", "monitor"])
def test_who_answers_scan_by_scan_passes_them_all(sic: Suite, relation: str) -> None:
    verdict = judged(sic, Lamp, relation)
    word = "FOLLOWS" if relation == "monitor" else "CONFORMS"
    said = "FOLLOWS(1 demands, sic; within 1 scan)" if relation == "monitor" else f"CONFORMS({relation}, sic)"
    assert (verdict.word, verdict.relation) == (word, relation)
    assert as_text(verdict).endswith(said)


def test_settled_covers_transitions_and_counts_what_was_demanded(sic: Suite) -> None:
    assert all(have == total for have, total in judged(sic, Slow, "settled").covered.values())
    verdict = judged(sic, Slow, "monitor")
    assert verdict.properties["LightNeedsCode"] > 0 and verdict.latency == 3
    assert "demands, put in so many scans each (within 3 scans): LightNeedsCode" in as_text(verdict)
    assert as_record(verdict)["properties"] == verdict.properties


def test_what_settles_wrongly_is_found(sic: Suite) -> None:
    class Dim(Slow):
        def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
            return {**out, "MW": "0000"}

    found = judged(sic, Dim, "settled").difference
    assert found is not None and found.confirmed
    assert (found.expected, found.got) == ({"MW": "0FF0"}, {"MW": "0000"})
    late = judged(sic, Late, "settled").difference
    assert late is not None and "not what it settles to" in late.when and late.step == "Expire"


def test_a_forbidden_output_is_found_even_if_it_settles_well(sic: Suite) -> None:
    verdict = judged(sic, SlowAndFlickering, "settled")
    found = verdict.difference
    assert found is not None and dict(found.got) == {"MW": "FFFF"}
    assert "neither before, nor on the way" in found.when
    assert judged(sic, SlowAndFlickering, "monitor").word == "FOLLOWS", "no property speaks of it"


def test_a_program_slower_than_declared_differs_until_it_says_so(sic: Suite) -> None:
    assert judged(sic, SlowerThanItSays, "settled").word == "DIFFERS"
    assert judged(sic, SlowerThanItSays, "settled", latency=8).word == "CONFORMS"


def test_a_broken_demand_is_found_and_named(sic: Suite) -> None:
    verdict = judged(sic, SlowAndWrong, "monitor")
    found = verdict.difference
    assert found is not None and found.broken == "LightNeedsCode" and found.clauses == ("TOY-1",)
    assert "breaks:  LightNeedsCode: The lamp goes on only with its code." in as_text(verdict)
    assert len(found.shortest.scans) <= len(found.case.scans)


def test_monitor_passes_what_nothing_forbids_and_says_what_it_judged(tour: Suite) -> None:
    verdict = judged(tour, Late, "monitor")
    assert verdict.word == "FOLLOWS" and verdict.properties == {"LightNeedsCode": 79}
    assert "transitions" not in as_text(verdict), "what was passed through is not known"


def test_a_property_never_put_to_the_program_is_named(tour: Suite) -> None:
    class Dark(Lamp):
        def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
            return {"LAMP": False, "MW": "0000"}

    verdict = judged(tour, Dark, "monitor")
    assert verdict.word == "UNJUDGED" and verdict.status == 2
    assert "1 of 1 demands were never put to the program" in as_text(verdict)
    assert verdict.reason.endswith("LightNeedsCode")


def test_properties_of_unobserved_outputs_are_named_and_not_judged(sic: Suite) -> None:
    class Half(Slow):
        hello_says = {"unobserved": ["LAMP"]}  # noqa: RUF012

        def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
            return {"MW": out["MW"]}

    assert "nothing is demanded of the outputs" in judged(sic, Half, "monitor").reason


def test_a_suite_says_which_relations_it_is_for(tmp_path: Path, tour: Suite) -> None:
    assert "is for relation exact or monitor, not settled" in judged(tour, Lamp, "settled").reason
    bare = made(tmp_path, "sic", None)
    assert bare.relations == ("exact", "settled", "monitor")
    assert "nothing is demanded" in judged(bare, Lamp, "monitor").reason
    assert judged(bare, Slow, "settled").word == "CONFORMS"


def test_inputs_are_held_within_a_group(sic: Suite) -> None:
    for case in sic.cases():
        for first, last in groups(case):
            held = [scan.inputs for scan in case.scans[first : last + 1]]
            assert all(one == held[0] for one in held) and case.scans[last].compared


class RealTime(Slow):
    """Time passes by itself: what is given as dt is slept; each scan takes `lazy_s` more."""

    hello_says = {"time": "real"}  # noqa: RUF012

    def __init__(self, clock: Any, lazy_s: float) -> None:
        self.clock, self.lazy_s = clock, lazy_s
        super().__init__()

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.at = self.clock.monotonic()

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.clock.sleep(max(0.0, self.at + dt_ms / 1000 - self.clock.monotonic()) + self.lazy_s)
        now = self.clock.monotonic()
        passed, self.at = round((now - self.at) * 1000), now
        return super().scan(passed, inputs)


def timed(suite: Suite) -> Case:
    """A case in which time passes, and not much of it."""
    return next(one for one in suite.cases() if 0 < sum(scan.dt_ms for scan in one.scans) <= 500)


def test_a_real_time_program_can_be_judged_once_it_settles(
    sic: Suite, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock()
    set_clock(monkeypatch, clock, "modeproof.kit.relation")
    case = timed(sic)
    verdict = run_suite(sic, lambda: RealTime(clock, 0.001), plan=Plan(Options("settled"), only=case.id))
    assert verdict.word == "CONFORMS" and clock.now_s > 0.5
    exact = run_suite(sic, lambda: RealTime(clock, 0.001), plan=Plan(only=case.id))
    assert exact.word == "UNJUDGED" and "exact" in exact.reason


def test_holding_may_take_at_most_a_cases_shortest_time(sic: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    clock, case = Clock(), timed(sic)
    set_clock(monkeypatch, clock, "modeproof.kit.relation")
    plan = Plan(Options("settled"), only=case.id)
    scans = run_suite(sic, lambda: RealTime(clock, 0.0), plan=plan).scans
    enough = min(scan.dt_ms for scan in case.scans if scan.dt_ms) / 1000 / scans
    assert run_suite(sic, lambda: RealTime(clock, enough * 0.9), plan=plan).word == "CONFORMS"
    assert run_suite(sic, lambda: RealTime(clock, enough * 1.1), plan=plan).word == "UNJUDGED"


def test_holding_that_adds_to_the_cases_time_is_unjudged(sic: Suite) -> None:
    """By the clock on the wall; a busy machine only makes it worse."""
    verdict = run_suite(sic, lambda: RealTime(time, 0.06), plan=Plan(Options("settled"), only=timed(sic).id))
    assert verdict.word == "UNJUDGED" and "--slow" in verdict.reason


def test_times_can_be_made_longer(sic: Suite) -> None:
    seen: list[int] = []

    class Noting(Slow):
        def reset(self, params: Mapping[str, Any]) -> None:
            super().reset(params)
            seen.append(params.get("T_ms", 0))

    assert judged(sic, Noting, "settled", slow=7).word == "CONFORMS"
    assert set(seen[1:]) == {3500}


def test_over_the_protocol_the_relations_are_the_same(sic: Suite, tmp_path: Path) -> None:
    slow = """
HELLO["relations"], HELLO["max_latency_scans"] = ["settled"], 2
late = []
def answer(m, out):
    late.append(out)
    say({"out": late[-3] if len(late) > 2 else late[0]})
"""
    lists = slow + 'HELLO["scans"] = True\n'
    for code, relation, word in (
        ("", "settled", "CONFORMS"),
        ('HELLO["scans"] = True', "settled", "CONFORMS"),
        ('HELLO["scans"] = True', "monitor", "FOLLOWS"),
        ("LIMIT = 501", "settled", "DIFFERS"),
        ('HELLO["scans"] = True\nLIMIT = 501', "settled", "DIFFERS"),
        ("same = lambda word: True", "monitor", "BREAKS"),
        (slow, "exact", "UNJUDGED"),
        (lists, "exact", "UNJUDGED"),
    ):
        command = program(tmp_path, code)
        plan = Plan(Options(relation))
        assert run_suite(sic, lambda command=command: Adapter(command, PATIENT_S), plan=plan).word == word, (
            code
        )

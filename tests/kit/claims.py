"""What the kit's judge must do, as claims on a judge that is given: the shipped one, or one with an edit.

A claim raises AssertionError where the judge does otherwise. All programs run in this process.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any

from modeproof.kit.adapter import Adapter
from modeproof.kit.errors import Unjudged
from modeproof.kit.vectors import Suite
from tests.kit import plainly
from tests.kit.stages import (
    ARMED,
    DEMANDS,
    FIRED,
    LOWERED,
    OFF,
    ROWS,
    SPENT,
    STEPS,
    Given,
    Program,
    Spoiled,
    case,
    faulty,
    requested,
    suite,
    walks,
)

JUDGING = ("verdict", "hello", "relation", "shrink", "diagnosis", "suite_judge")
"""The modules of the kit that make a verdict, each after those that it imports."""


@dataclass(frozen=True)
class Kit:
    """The modules that make a verdict."""

    verdict: ModuleType
    hello: ModuleType
    relation: ModuleType
    judge: ModuleType

    def run(self, of: Suite, start: Callable[[], Any], relation: str = "exact", **more: Any) -> Any:
        """The verdict on a program; options and what a plan holds are given by name."""
        of_plan = {
            name: more.pop(name) for name in ("part", "jobs", "most", "effort", "skip") if name in more
        }
        told = {name: more.pop(name) for name in tuple(more) if name.startswith("on_")}
        only = more.pop("only", None)
        options = self.relation.Options(relation, **more)
        plan = self.verdict.Plan(options, only=only, **{"effort": 0, **of_plan})
        return self.judge.run_suite(of, start, plan=plan, **told)


@contextmanager
def judge_with(texts: Mapping[str, str]) -> Iterator[Kit]:
    """The judging modules, of which some have another text; those of the kit are as before afterwards."""
    names = [f"modeproof.kit.{name}" for name in JUDGING]
    before = {name: sys.modules.pop(name, None) for name in names}
    package = sys.modules["modeproof.kit"]
    held = {name: getattr(package, name) for name in JUDGING if hasattr(package, name)}
    try:
        for short, name in zip(JUDGING, names, strict=True):
            if short not in texts:
                importlib.import_module(name)
                continue
            module = sys.modules[name] = ModuleType(name)
            exec(compile(texts[short], name, "exec"), module.__dict__)
        yield Kit(
            *(
                sys.modules[f"modeproof.kit.{name}"]
                for name in ("verdict", "hello", "relation", "suite_judge")
            )
        )
    finally:
        for name in names:
            sys.modules.pop(name, None)
        sys.modules.update({name: module for name, module in before.items() if module is not None})
        for name, module in held.items():
            setattr(package, name, module)


class Wired(Adapter):
    """A program as an adapter that needs no process: it can be sent requests, and takes lists of scans."""

    def __init__(self, program: Program, lists: bool = True, refuses: bool = True) -> None:
        self.program, self.lists, self.refuses = program, lists, refuses
        self.asked: list[str] = []

    def hello(self, target: str) -> Mapping[str, Any]:
        return {**self.program.hello(target), "scans": self.lists}

    def reset(self, params: Mapping[str, Any]) -> None:
        self.asked.append("reset")
        self.program.reset(params)

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.asked.append("scan")
        return self.program.scan(dt_ms, inputs)

    def scans(self, scans: Sequence[tuple[int, Mapping[str, Any]]]) -> list[Mapping[str, Any]]:
        self.asked.append(f"scans {len(scans)}")
        return [self.program.scan(*one) for one in scans]

    def refused(self, request: Any) -> Mapping[str, Any]:
        self.asked.append("refused")
        return {} if self.refuses else {"answer": {"ok": True}}

    def bye(self) -> None:
        self.asked.append("bye")

    def quiet(self) -> None:
        self.asked.append("quiet")

    def close(self) -> None:
        self.program.close()


# ------------------------------------------------------------------------------- beside the plain judge


def _agree(
    kit: Kit, of: Given, start: Callable[[], Any], relation: str, latency: int, hidden: Sequence[str]
) -> None:
    """The verdict, and each difference, is the one that was worked out plainly."""
    wanted = plainly.judged(of, start, relation, hidden, latency)
    verdict = kit.run(of, start, relation, most=99, codes="CODE" not in hidden)
    word = verdict.word
    assert word == wanted["word"] and verdict.status == (word != "CONFORMS"), (word, verdict.reason, wanted)
    assert verdict.passed == wanted["passed"] and verdict.cases == len(verdict.passed)
    covered = {name: (have, dict(_totals(of))[name]) for name, have in wanted["covered"].items()}
    assert verdict.covered == covered and verdict.transitions[0] == sum(wanted["covered"].values())
    assert verdict.clauses["S-all"] == verdict.transitions and verdict.clauses["S-1"] == covered["Arm"]
    found = {one.case.id: one for one in verdict.differences}
    assert found.keys() == wanted["wrong"].keys()
    for id, plain in wanted["wrong"].items():
        one = found[id]
        assert (one.scan, one.expected, one.got) == (plain.scan, plain.expected, plain.got), (one, plain)
        assert one.step == " > ".join(plain.steps), (one.step, plain)
        numbers = sorted(STEPS.index(name) for name in plain.steps)
        assert one.clauses == tuple(sorted({"S-all", *(f"S-{n}" for n in numbers)}))
        assert one.findings == tuple(f"F-{n}" for n in numbers if n % 2)
        assert (one.part, one.confirmed) == (f"1-{one.scan}" if one.scan > 1 else "1", None)
        assert one.shortest.scans == one.case.scans[: one.scan] and one.broken == one.says == ""
        assert one.cause == (one.step, *sorted(one.expected))
    ids = {one.id: "differs" if one.id in found else "passed" for one in of.given}
    assert {id: "passed" if word == "not seen" else word for id, word in verdict.ids.items()} == ids


def _totals(of: Suite) -> Iterator[tuple[str, int]]:
    return ((step.name, step.transitions) for step in of.steps)


def exact_is_the_first_wrong_scan(kit: Kit) -> None:
    of = suite(walks(6, settled=False), ["exact"], None)
    for start in faulty(14, 0):
        _agree(kit, of, start, "exact", 0, ())
        _agree(kit, of, start, "exact", 0, ("CODE",))
        _agree(kit, of, lambda start=start: Wired(start()), "exact", 0, ())
        _agree(kit, of, lambda start=start: Wired(start()), "exact", 0, ("CODE",))
        _agree(kit, of, lambda start=start: Wired(start(), lists=False), "exact", 0, ())


def settled_names_the_steps_over_several_scans(kit: Kit) -> None:
    of = suite(walks(6, settled=True), ["exact", "settled"], None)
    for delay in (0, 2):
        for start in faulty(14, delay, seed=2):
            _agree(kit, of, start, "settled", delay, ())
            _agree(kit, of, start, "settled", delay, ("CODE",))
            _agree(kit, of, lambda start=start: Wired(start()), "settled", delay, ())


def a_difference_names_the_last_step_that_moves_the_output(kit: Kit) -> None:
    """By hand: the program shows everything but that B rises, which is the last of two scans."""
    of = suite([case([(0, False, True), (0, True, False), (0, True, True)])], ["exact", "settled"], None)
    (found,) = kit.run(of, lambda: Spoiled({(n, "B"): False for n in range(1, 9)}), "settled").differences
    assert (found.step, found.scan, found.findings) == ("Fire", 3, ())
    (found,) = kit.run(of, lambda: Spoiled({(n, "A"): False for n in range(1, 9)}), "settled").differences
    assert (found.step, found.scan, found.findings) == ("Arm", 3, ("F-1",))
    both = {(n, name): False for n in range(1, 9) for name in "AB"}
    (found,) = kit.run(of, lambda: Spoiled(both), "settled").differences
    assert (found.step, found.clauses) == ("Arm > Fire", ("S-1", "S-2", "S-all"))
    of = suite([case([(0, True, False), (0, True, True), (0, True, True)])], ["exact", "settled"], None)
    (found,) = kit.run(of, lambda: Spoiled({(n, "B"): False for n in range(5, 99)}), "settled").differences
    assert found.step == "Hold", "no step moves it: all since the inputs changed"


def outputs_that_are_not_seen_cover_nothing(kit: Kit) -> None:
    cases = [case([(0, True, True), (0, True, True), (0, True, True), (0, False, True)])]
    blind = lambda: Spoiled({}, unobserved=["B"])  # noqa: E731
    verdict = kit.run(suite(cases, demands=None), blind)
    assert verdict.covered["Fire"] == (0, 1) and verdict.covered["Arm"] == verdict.covered["Hold"] == (1, 1)
    assert verdict.covered["Lower"] == (1, 2)
    assert verdict.unobserved == ("B",) and verdict.not_compared == ("CODE",) and verdict.outputs == (1, 2)
    blind = lambda: Spoiled({}, unobserved=["A", "B"])  # noqa: E731
    verdict = kit.run(suite(cases, demands=None), blind, codes=True)
    assert (verdict.word, verdict.ids[cases[0].id]) == ("CONFORMS", "passed") and verdict.outputs == (1, 3)
    quiet = suite([case([(0, False, True), (0, False, True)])], demands=None)
    assert kit.run(quiet, blind, codes=True).ids == {quiet.given[0].id: "passed"}
    verdict = kit.run(quiet, blind)
    assert (
        verdict.word == "UNJUDGED" and "every output is unobserved, or its values are ours" in verdict.reason
    )


def a_column_counts_where_the_suite_says_so(kit: Kit) -> None:
    cases = [case([(0, False, True), (0, True, True), (0, False, True), (0, True, True)])]
    by_state = kit.run(suite(cases, demands=None), Program).covered
    by_column = kit.run(suite(cases, demands=None, counted_by="column"), Program).covered
    assert (by_state["Release"], by_column["Release"]) == ((1, 1), (1, 1))
    spent = [case([(0, True, True), (0, True, True), (500, True, True), (0, True, True), (0, False, True)])]
    assert kit.run(suite(spent, demands=None), Program).covered["Stay"] == (1, 2)
    both = [
        replace(one, scans=(*one.scans[:-1], replace(one.scans[-1], column=n)))
        for n, one in enumerate(spent * 2)
    ]
    both = [replace(one, id=f"c-{n}") for n, one in enumerate(both)]
    assert kit.run(suite(both, demands=None), Program).covered["Release"] == (1, 1)
    assert kit.run(suite(both, demands=None, counted_by="column"), Program).covered["Release"] == (2, 1)


# ---------------------------------------------------------------------------------------- safety properties


def a_property_that_fails_is_named_with_what_it_rests_on(kit: Kit) -> None:
    of = suite([case([(0, True, True), (0, True, True)])])
    early = {(1, "A"): False, (1, "B"): True, (1, "CODE"): "0001"}
    verdict = kit.run(of, lambda: Spoiled({(1, "B"): True}), "monitor", latency=0)
    (found,) = verdict.differences
    assert (found.broken, found.says, found.clauses, found.findings) == ("AFirst", "A.", ("S-8",), ())
    assert (found.scan, found.expected, found.got) == (1, {"B": False}, {"B": True})
    assert found.cause == ("AFirst", "B") and found.when == "breaks AFirst"
    assert verdict.reason.endswith("(breaks AFirst): B is true"), verdict.reason
    verdict = kit.run(of, lambda: Spoiled(early), "monitor")
    assert not verdict.differences, "the other property is about B with A"
    idle = suite([case([(0, False, True)])], ["monitor"])
    (found,) = kit.run(idle, lambda: Spoiled({(1, "B"): True}), "monitor").differences
    assert found.broken == "BNeedsGo" and found.expected == {"B": False}


def a_property_is_shown_with_its_own_outputs_alone(kit: Kit) -> None:
    never = {"id": "P", "says": "", "clauses": [], "when": "True", "holds": "A"}
    of = suite([case([(0, True, True)])], ["monitor"], {"constants": {}, "rules": [], "demands": [never]})
    (found,) = kit.run(of, lambda: Spoiled({(1, "A"): False, (1, "B"): True}), "monitor").differences
    assert (found.expected, found.got) == ({"A": True}, {"A": False})


def what_settles_is_not_compared_before(kit: Kit) -> None:
    of = suite([case([(0, True, False), (0, True, True)])], ["exact"], None)
    odd = {(1, "B"): True}
    for start in (
        lambda: Spoiled(odd),
        lambda: Wired(Spoiled(odd)),
        lambda: Wired(Spoiled(odd), lists=False),
    ):
        verdict = kit.run(of, start)  # type: ignore[arg-type]
        assert (verdict.word, verdict.compared) == ("CONFORMS", 1)
    late = suite([requested(of.given[0], 0)], ["exact"], None)
    assert kit.run(late, lambda: Wired(Spoiled(odd))).word == "CONFORMS"


def where_nothing_differs_what_the_property_rests_on_is_shown(kit: Kit) -> None:
    never = {
        "constants": {},
        "rules": [],
        "demands": [{"id": "P", "says": "", "clauses": [], "when": "A", "holds": "B"}],
    }
    of = suite([case([(0, True, True)])], ["monitor"], never)
    (found,) = kit.run(of, Program, "monitor").differences
    assert (found.expected, found.got) == ({"A": True, "B": False}, {"A": True, "B": False})
    held = replace(of, relations=("settled", "monitor"))
    (found,) = kit.run(held, lambda: Spoiled({}, 2), "monitor").differences
    assert found.broken == "P" and found.scan == 1


def the_monitor_says_what_was_put(kit: Kit) -> None:
    of = suite(
        [case([(0, True, True), (0, True, True)]), case([(10, True, True), (0, True, True)])], ["monitor"]
    )
    verdict = kit.run(of, Program, "monitor")
    assert (verdict.word, verdict.properties) == ("FOLLOWS", {"BNeedsGo": 6, "AFirst": 6, "BLasts": 0})
    assert verdict.compared == 4 and verdict.scans == 220 and verdict.cases_total == 2
    dark = {(n, "B"): False for n in range(1, 999)}
    verdict = kit.run(of, lambda: Spoiled(dark), "monitor")
    assert verdict.word == "UNJUDGED" and verdict.reason.startswith("3 of 3 demands were never put")
    half = {(n, "A"): False for n in range(1, 999)}
    verdict = kit.run(of, lambda: Spoiled(half), "monitor")
    assert verdict.reason.startswith("1 of 3 demands") and verdict.reason.endswith(": AFirst")
    few = suite([case([(0, True, True), (0, True, True), (0, False, True)])], ["monitor"])
    verdict = kit.run(few, Program, "monitor")
    assert verdict.word == "FOLLOWS", "no case of the suite puts the other one to a right program"
    verdict = kit.run(of, lambda: Spoiled({}, unobserved=["A"]), "monitor")
    assert verdict.word == "FOLLOWS" and verdict.unjudged == ("AFirst", "BLasts")
    verdict = kit.run(of, lambda: Spoiled({}, unobserved=["B"]), "monitor")
    assert "nothing is demanded of the outputs" in verdict.reason
    verdict = kit.run(replace(of, header={**of.header, "demands": None}), Program, "monitor")
    assert "nothing is demanded of the outputs" in verdict.reason
    lowered = case([(0, True, True), (0, True, True), (0, False, True)])
    stuck = {(n, "B"): False for n in range(3, 999)}
    verdict = kit.run(suite([lowered], ["monitor"]), lambda: Spoiled(stuck), "monitor")
    assert verdict.reason.startswith("1 of 3 demands") and verdict.reason.endswith(": BLasts")
    refused = suite([requested(of.given[1], 1), *of.given], ["monitor"])
    assert kit.run(refused, lambda: Wired(Spoiled(half)), "monitor").word == "UNJUDGED"


def no_page_speaks_of_other_values_of_a_parameter_of_ours(kit: Kit) -> None:
    put = case([(0, True, True), (0, True, True)])
    given = suite([replace(put, params={"N": 4})], ["monitor"])
    ours = {**given.parameters, "N": {**given.parameters["N"], "project": True}}
    verdict = kit.run(replace(given, parameters=ours), Program, "monitor")
    assert verdict.word == "UNJUDGED"
    assert verdict.reason == "no page speaks of a program with other values of N"
    both = suite([put, replace(put, id="other", params={"N": 4})], ["monitor"])
    assert kit.run(replace(both, parameters=ours), Program, "monitor").word == "FOLLOWS"
    assert kit.run(given, Program, "monitor").word == "FOLLOWS"


def where_something_must_come_that_alone_must_be_put(kit: Kit) -> None:
    comes = {**COMES, "id": "AComes", "comes": "A"}
    demands = {**DEMANDS, "demands": [*DEMANDS["demands"], comes]}  # type: ignore[misc]
    two, idle = case([(0, True, True), (0, True, True)], reset=False), case([(0, False, True)], reset=False)
    dark = {(n, "B"): False for n in range(1, 9)}
    assert kit.run(suite([two], ["monitor"], demands), lambda: Spoiled(dark), "monitor").word == "FOLLOWS"
    verdict = kit.run(suite([idle], ["monitor"], demands), Program, "monitor")
    assert verdict.word == "UNJUDGED" and verdict.reason.startswith("4 of 4 demands were never put")
    asked = {**comes, "when": "A and was_B"}  # the right program lowers it; who leaves A dark is never asked
    demands = {**DEMANDS, "demands": [*DEMANDS["demands"], asked]}  # type: ignore[misc]
    fired = case([(0, True, True), (0, True, True), (0, True, True)], reset=False)
    half = {(n, "A"): False for n in range(1, 9)}
    verdict = kit.run(suite([fired], ["monitor"], demands), lambda: Spoiled(half), "monitor")
    assert verdict.reason.startswith("1 of 4 demands") and verdict.reason.endswith(": AComes")
    assert kit.run(suite([two], ["monitor"], demands), lambda: Spoiled(half), "monitor").word == "FOLLOWS"


def latency_needs_inputs_that_are_held(kit: Kit) -> None:
    of = suite([case([(0, True, True), (0, True, True)])], ["exact", "monitor"])
    assert "changes inputs in every scan" in kit.run(of, Program, "monitor", latency=1).reason
    bare = replace(of, header={**of.header, "demands": None})
    assert "changes inputs in every scan" in kit.run(bare, Program, "monitor", latency=1).reason
    assert kit.run(of, Program, latency=1).word == "CONFORMS", "exact is exact"
    held = suite([case([(0, True, False), (0, True, True)])], ["settled", "monitor"])
    assert kit.run(held, Program, "monitor", latency=1).word == "FOLLOWS"
    odd = {(1, "A"): True, (1, "CODE"): "00FF", (2, "CODE"): "00FF"}
    assert kit.run(held, lambda: Spoiled(odd, 1), "monitor").word == "FOLLOWS", "nothing forbids it"
    assert kit.run(held, lambda: Spoiled(odd, 1), "settled", codes=True).word == "DIFFERS"
    (found,) = kit.run(
        held, lambda: Spoiled({(2, "B"): True, (2, "A"): False}, 3), "monitor", latency=0
    ).differences or [None]
    assert found is None or found.broken
    assert "is for relation settled or monitor, not exact" in kit.run(held, Program).reason


# ---------------------------------------------------------------------------------------------- patience


COMES = {"id": "BComes", "says": "BC.", "clauses": ["S-7"], "when": "go", "comes": "B"}
"""What must come, and no walk that changes its inputs in every scan ever waits for it."""
HELD = 27
"""Scans of a row of inputs that is held patiently."""


class Noted(Program):
    """The right program; `sent` has what it was sent: parameters at each reset, the ms of each scan."""

    def __init__(self, sent: list[Any]) -> None:
        self.sent = sent
        super().__init__()

    def reset(self, params: Mapping[str, Any]) -> None:
        self.sent.append(dict(params))
        super().reset(params)

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.sent.append(dt_ms)
        return super().scan(dt_ms, inputs)


def who_is_watched_is_asked_again_with_each_row_held(kit: Kit) -> None:
    def sent(*cases: Any, relations: Sequence[str] = ("monitor",), **options: Any) -> list[Any]:
        found: list[Any] = []
        kit.run(suite(list(cases), relations), lambda: Noted(found), "monitor", **options)
        return found[1:]

    two = case([(10, True, True), (20, False, True)])
    still = [{}, *[10] * HELD, 0, *[5] * (HELD - 1)]
    assert sent(two, hold_ms=5) == [{}, 10, 20, *still, {}, *[10] * HELD, *[20] * HELD]
    long = case([(10, True, True), (20, False, False), (30, False, True)])
    still = [{}, *[10] * HELD, 0, *[5] * (HELD - 1)]
    lasting = [{}, *[10] * HELD, 20, 30, *[20] * (HELD - 2)]
    assert sent(long, hold_ms=5) == [{}, 10, 20, 30, *still, *lasting]
    assert sent(replace(two, reset=False)) == [10, 20], "it cannot be asked again"
    held = case([(10, True, False), (0, True, True)])
    assert sent(held, relations=["settled", "monitor"], latency=3) == [{}, 10, 0, 0, 0, 0, 0]
    found: list[Any] = []
    kit.run(suite([requested(two, 1)], ["monitor"]), lambda: Wired(Noted(found)), "monitor")
    assert found[1:] == [{}, 10, 20]


def patience_has_an_end(kit: Kit) -> None:
    of = suite(
        [case([(10, True, True), (0, True, True)]), case([(20, True, True), (0, True, True)])], ["monitor"]
    )
    known = kit.relation.PATIENT_SCANS
    try:
        for patience, resets in ((0, 2), (1, 4), (4 * HELD, 4), (4 * HELD + 1, 6), (4 * HELD + 3, 6)):
            kit.relation.PATIENT_SCANS = patience  # type: ignore[attr-defined]
            found: list[Any] = []
            kit.run(of, lambda: Noted(found), "monitor")  # noqa: B023
            assert found[1:].count({}) == resets, patience
    finally:
        kit.relation.PATIENT_SCANS = known  # type: ignore[attr-defined]


def what_must_come_is_missed_with_patience_alone(kit: Kit) -> None:
    class Dead(Program):
        def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
            return ROWS[OFF]

    class Timed(Program):
        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            return super().scan(dt_ms, inputs) if dt_ms else dict(ROWS[self.device.state])

    demands = {**DEMANDS, "demands": [*DEMANDS["demands"], COMES]}  # type: ignore[misc]
    of = suite([case([(10, False, True), (10, True, True)])], ["monitor"], demands)
    assert kit.run(of, Program, "monitor").word != "BREAKS"
    verdict = kit.run(of, Timed, "monitor")
    assert verdict.word == "BREAKS", "while time stands still, though not while it goes on"
    known = kit.relation.PATIENT_SCANS
    try:
        kit.relation.PATIENT_SCANS = 1  # type: ignore[attr-defined]
        (found,) = kit.run(of, Dead, "monitor", effort=5).differences
    finally:
        kit.relation.PATIENT_SCANS = known  # type: ignore[attr-defined]
    assert found.broken == "BComes" and found.confirmed, "it is run again as patiently"


# ------------------------------------------------------------------------------------------ what is sent


def times_are_those_of_the_case_and_longer_where_asked(kit: Kit) -> None:
    of = suite([case([(10, True, False), (250, True, True), (7, True, True)])], ["exact", "settled"], None)
    sent: list[Any] = []

    class Noting(Program):
        def reset(self, params: Mapping[str, Any]) -> None:
            sent.append(dict(params))
            super().reset(params)

        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            sent.append(dt_ms)
            return super().scan(dt_ms, inputs)

    def of_run(*args: Any, **options: Any) -> list[Any]:
        sent.clear()
        assert kit.run(of, Noting, *args, **options).word == "CONFORMS"
        return sent[1:]

    assert of_run() == [{}, 10, 250, 7]
    assert of_run("exact", slow=3) == [{"T_ms": 1500}, 30, 750, 21]
    assert of_run("settled") == [{}, 10, 250, 0, 0, 7, 0, 0]
    held = replace(of, given=(case([(10, True, False), (0, True, True)]),))
    sent.clear()
    kit.run(held, Noting, "settled", hold_ms=5)
    assert sent[1:] == [{}, 10, 5, 5, 5]
    assert of_run("settled", latency=3, hold_ms=5) == [{}, 10, 250, 5, 5, 5, 5, 7, 5, 5, 5, 5, 5]
    assert of_run("settled", slow=2) == [{"T_ms": 1000}, 20, 500, 0, 0, 14, 0, 0]
    bare = replace(of, given=(replace(of.given[0], params={"T_ms": 300, "N": 4}),))
    sent.clear()
    kit.run(bare, Noting, slow=2)
    assert sent[1] == {"T_ms": 600, "N": 4}
    unreset = replace(of, given=(replace(of.given[0], reset=False),))
    sent.clear()
    assert kit.run(unreset, Noting).word == "CONFORMS" and sent[1:] == [10, 250, 7]


def lists_are_sent_in_batches_and_single_scans_else(kit: Kit) -> None:
    long = suite([case([(0, False, True)] * 70)], ["exact", "settled"], None)
    for lists, asked in (
        (True, ["reset", "scans 64", "scans 6", "bye"]),
        (False, ["reset", *["scan"] * 70, "bye"]),
    ):
        made = Wired(Program(), lists)
        verdict = kit.run(long, lambda made=made: made)
        assert (verdict.word, verdict.scans, made.asked) == ("CONFORMS", 70, asked)
        assert made.program.closed == 1
    slow = Wired(Program())
    assert (
        kit.run(suite(long.given[:1], ["settled"], None), lambda: slow, "settled", latency=70).scans
        == 70 * 73
    )
    assert slow.asked[1:3] == ["scans 64", "scans 9"]


def a_request_must_be_refused(kit: Kit) -> None:
    plain = case([(0, True, True), (0, True, True), (0, False, True)])
    of = suite([requested(plain, 0), requested(plain, 2, "!"), plain], ["exact"], None)
    made = Wired(Program())
    verdict = kit.run(of, lambda: made)
    assert (verdict.word, verdict.scans, verdict.compared) == ("CONFORMS", 9, 11)
    assert made.asked[:4] == ["reset", "refused", "scan", "scan"]
    verdict = kit.run(of, lambda: Wired(Program(), refuses=False))
    assert (
        verdict.word == "DIFFERS"
        and len(verdict.differences) == 2
        and "protocol 1 tells it to refuse" in verdict.reason
    )
    first, second = verdict.differences
    assert (first.step, first.scan, first.clauses, first.findings) == ("protocol", 1, (), ())
    assert (second.scan, second.when, second.confirmed) == (3, "not refused", None)
    wrong = lambda: Wired(Spoiled({(1, "A"): False}), refuses=False)  # noqa: E731
    verdict = kit.run(replace(of, given=of.given[::-1]), wrong)
    assert [one.step for one in verdict.differences] == ["Arm"] and verdict.reason.startswith("case stages-")
    assert "can only be sent to an adapter" in kit.run(of, Program).reason
    verdict = kit.run(of, lambda: Wired(Program(), refuses=False), effort=9)
    assert {one.confirmed for one in verdict.differences} == {None}


def an_answer_of_another_form_is_unjudged(kit: Kit) -> None:
    of = suite([case([(0, True, True), (0, True, True), (0, False, True)])], ["exact", "settled"], None)

    class Odd(Program):
        answer: Any = None

        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Any:
            out = super().scan(dt_ms, inputs)
            return self.answer(out) if self.count == 2 else out

    def reason(answer: Callable[[Any], Any], relation: str, **more: Any) -> str:
        kind = type("One", (Odd,), {"answer": staticmethod(answer)})
        verdict = kit.run(of, kind, relation, **more)
        assert (verdict.word, verdict.status, verdict.passed) == ("UNJUDGED", 2, [])
        return str(verdict.reason)

    for relation in ("exact", "settled"):
        assert "out must be an object, got 3" in reason(lambda out: 3, relation)
        assert "plain values" in reason(lambda out: {"A": object()}, relation)
        assert "'X' that the target does not have" in reason(lambda out: {**out, "X": 1}, relation)
        assert "output B is missing" in reason(lambda out: {"A": out["A"]}, relation)
        assert "true or false expected, got 1" in reason(lambda out: {**out, "A": 1}, relation)
        assert "hex digits" in reason(lambda out: {**out, "CODE": 1}, relation, codes=True)
    place = f"{of.given[0].id}, scan 2"
    third = type("Third", (Odd,), {"answer": staticmethod(lambda out: 3)})
    assert kit.run(of, lambda: Wired(third())).reason.startswith(f"{place}: out must be")
    held = kit.run(of, lambda: Wired(third()), "settled").reason
    assert held.startswith(f"{of.given[0].id}, scan 1, held for 1 scans: out must be"), held
    deaf = type("Deaf", (Wired,), {"scans": lambda self, scans: [][1]})
    assert kit.run(of, lambda: deaf(Program())).reason.startswith(
        f"{of.given[0].id}, scan 1 to 3: IndexError"
    )
    held = kit.run(of, lambda: deaf(Program()), "settled").reason
    assert held.startswith(f"{of.given[0].id}, scan 1, held for 0 scans and more: IndexError"), held
    assert reason(lambda out: 3, "exact").startswith(f"{place}: ")
    assert reason(lambda out: 3, "settled").startswith(f"{of.given[0].id}, scan 1, held for 1 scans: ")


def what_an_answer_repeats_is_read_again_where_it_is_another(kit: Kit) -> None:
    """A program may give the same object each time; then it is checked once, and compared each time."""
    of = suite([case([(0, True, True)] * 4)], ["exact"], None)

    class Keeping(Program):
        keeps_answers = True

        def __init__(self) -> None:
            self.given = {json(row): dict(row) for row in ROWS.values()}
            super().__init__()

        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            return self.given[json(super().scan(dt_ms, inputs))]

    def json(row: Mapping[str, Any]) -> str:
        return str(sorted(row.items()))

    assert kit.run(of, Keeping, codes=True).word == "CONFORMS"

    class Wrong(Keeping):
        def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
            return ROWS[ARMED] if self.count == 4 else row

    assert kit.run(of, Wrong, codes=True).differences[0].scan == 4
    session = kit.relation.Session(of, Keeping(), kit.relation.Options())
    session.case(of.given[0])
    assert len(session._kept) == 2 and len(session._good) == 2
    session = kit.relation.Session(of, Program(), kit.relation.Options())
    session.case(of.given[0])
    assert not session._kept and session.scans == 4


# ---------------------------------------------------------------------------------------------- hello


GREETINGS: tuple[tuple[Mapping[str, Any], str, str], ...] = (
    ({}, "exact", ""),
    ({}, "settled", ""),
    ({}, "monitor", ""),
    ({"ok": 1}, "exact", "hello was answered with"),
    ({"relations": ["settled"]}, "settled", ""),
    ({"relations": ["settled"]}, "monitor", ""),
    ({"relations": ["settled"]}, "exact", "does not offer relation exact"),
    ({"relations": ["monitor"]}, "settled", "does not offer relation settled"),
    ({"relations": ["monitor"]}, "monitor", ""),
    ({"relations": "exact"}, "exact", "does not offer"),
    ({"time": "real"}, "settled", ""),
    ({"time": "real"}, "exact", "needs virtual time"),
    ({"time": "other"}, "settled", "needs virtual time"),
    ({"max_latency_scans": 2}, "settled", ""),
    ({"max_latency_scans": 2}, "exact", "allows no latency"),
    ({"max_latency_scans": -1}, "settled", "allows no latency"),
    ({"max_latency_scans": True}, "settled", "allows no latency"),
    ({"max_latency_scans": 10_000}, "settled", ""),
    ({"unobserved": ["B", "B"]}, "exact", ""),
    ({"unobserved": "B"}, "exact", "must list outputs"),
    ({"unobserved": ["X"]}, "exact", "must list outputs"),
    ({"unobserved": [1]}, "exact", "must list outputs"),
    ({"scans": True}, "exact", ""),
    ({"scans": 1}, "exact", "scans must be true or false"),
    ({"name": "", "version": "2"}, "exact", ""),
)


def hello_is_taken_or_refused_with_a_reason(kit: Kit) -> None:
    outputs = ("A", "B", "CODE")
    for says, relation, refused in GREETINGS:
        answer = {"ok": True, **says}
        try:
            hello = kit.hello.read_hello(answer, outputs, relation)
            latency = says.get("max_latency_scans", 0)
            assert hello == kit.hello.Hello(
                says.get("name") or "unnamed",
                says.get("version", ""),
                tuple(dict.fromkeys(says.get("unobserved", ()))),
                says.get("scans", False),
                latency,
                says.get("time") == "real",
            )
        except Unjudged as error:
            assert refused and refused in str(error), (says, relation, str(error))
        else:
            assert not refused, (says, relation)
    plain = kit.hello.read_hello({"ok": True}, outputs)
    assert plain == kit.hello.Hello("unnamed", "")
    for answer in ([], None, {"ok": "true"}, {}):
        try:
            kit.hello.read_hello(answer, outputs)
        except Unjudged:
            continue
        raise AssertionError(answer)
    of = suite([case([(0, False, True), (0, True, False), (0, True, True)])], ["settled"], None)
    assert kit.run(of, Program, "settled", latency=10_000).word == "CONFORMS"
    for latency in (-1, 10_001):
        assert "a latency of 0 to 10000" in kit.run(of, Program, "settled", latency=latency).reason
    verdict = kit.run(of, lambda: Spoiled({}, 2), "settled")
    assert (verdict.word, verdict.latency, verdict.adapter) == ("CONFORMS", 2, "stages")
    assert kit.run(of, lambda: Spoiled({}, 2), "settled", latency=4).latency == 4
    assert kit.run(of, lambda: Spoiled({}, 2, version="7"), "settled").adapter == "stages 7"


def programs_that_introduce_themselves_differently_are_unjudged(kit: Kit) -> None:
    of = suite(walks(6, False), ["exact"], None)
    names = iter("abcdefgh")
    verdict = kit.run(of, lambda: Spoiled({}, name=next(names)), jobs=2)
    assert (verdict.word, verdict.cases < 6) == ("UNJUDGED", True) or verdict.cases == 6
    told: list[Any] = []
    assert kit.run(of, Program, jobs=3, on_hello=told.append).word == "CONFORMS" and len(told) == 1

    def refuses(hello: Any) -> None:
        raise Unjudged("another program")

    assert kit.run(of, Program, on_hello=refuses).reason.endswith("another program")


# ------------------------------------------------------------------------------------- which cases are run


def one_case_or_a_part_of_it_can_be_run(kit: Kit) -> None:
    cases = walks(5, False)
    of = suite(cases, ["exact"], None)
    verdict = kit.run(of, Program, only=cases[2].id)
    assert (verdict.word, verdict.cases, verdict.cases_total) == ("CONFORMS", 1, 1)
    assert verdict.only == f"case {cases[2].id}" and list(verdict.ids) == [cases[2].id]
    assert kit.judge.run_suite(of, Program, only=cases[2].id).only == verdict.only
    assert kit.judge.run_suite(of, Program).cases_total == 5 and kit.run(of, Program).only == ""
    verdict = kit.run(of, Program, only=cases[2].id, part="1")
    assert verdict.only == f"scans 1 of case {cases[2].id}" and verdict.scans == 1
    verdict = kit.run(of, Program, only="stages-none")
    assert verdict.word == "UNJUDGED" and f"allowed: {cases[0].id}" in verdict.reason
    assert "no case with the id stages-none in the suite by hand of stages" in verdict.reason


def cases_of_an_earlier_run_are_not_run_again(kit: Kit) -> None:
    cases = walks(4, False)
    of = suite(cases, ["exact"], None)
    told: list[int] = []
    verdict = kit.run(of, Program, skip={0, 2}, on_passed=told.append)
    assert (verdict.word, verdict.earlier, verdict.cases, told) == ("CONFORMS", 2, 4, [1, 3])
    assert verdict.scans == len(cases[1].scans) + len(cases[3].scans) and sorted(verdict.passed) == [
        0,
        1,
        2,
        3,
    ]
    verdict = kit.run(of, Program, skip=range(4))
    assert verdict.word == "UNJUDGED" and "all cases passed in an earlier run" in verdict.reason


def what_was_not_compared_is_no_pass(kit: Kit) -> None:
    of = suite([case([(0, True, False), (0, True, False)])], ["exact"], None)
    verdict = kit.run(of, Program)
    assert verdict.word == "UNJUDGED" and verdict.reason == "no output was compared in any scan"
    short = replace(suite(walks(2, False), ["exact"], None), case_count=3)
    verdict = kit.run(short, Program)
    assert (verdict.word, verdict.reason) == ("UNJUDGED", "2 of 3 cases were judged")
    lasts = case([(0, True, True), (0, True, True), (500, True, True)])
    unseen = suite(
        [
            replace(
                lasts,
                scans=(
                    replace(lasts.scans[0], outputs=ROWS[OFF]),
                    replace(lasts.scans[1], outputs=ROWS[OFF] | {"B": True}),
                ),
            )
        ],
        ["exact"],
        None,
    )
    hidden = {(1, "A"): False, (1, "CODE"): "0000", (2, "A"): False, (2, "CODE"): "0000"}
    verdict = kit.run(unseen, lambda: Spoiled(hidden, unobserved=["B"]))
    assert verdict.word == "CONFORMS" and verdict.transitions[0] == 1
    assert kit.run(suite([lasts], ["exact"], None), lambda: Spoiled({}, unobserved=["A"])).word == "CONFORMS"


def it_ends_after_so_many_differences(kit: Kit) -> None:
    of = suite([case([(n, True, True)] * 2) for n in range(6)], ["exact"], None)
    wrong = lambda: Spoiled({(2, "B"): False})  # noqa: E731
    for most in (1, 2, 99):
        first: list[Any] = []
        verdict = kit.run(of, wrong, most=most, on_difference=first.append)
        assert verdict.word == "DIFFERS" and len(verdict.differences) == min(most, 6)
        assert [one.case.id for one in first] == [of.given[0].id] and verdict.first_difference_s is not None
        assert verdict.scans == 2 * min(most, 6) and len(verdict.ids) == min(most, 6)
    ((cause, together),) = verdict.causes()
    assert cause == ("Fire", "B") and len(together) == 6
    assert verdict.difference is verdict.differences[0] and kit.run(of, Program).difference is None
    made = Wired(wrong().__class__({(2, "B"): False}))
    verdict = kit.run(of, lambda: made, most=3)
    assert made.asked.count("quiet") >= 1 and "bye" not in made.asked


def several_at_once_judge_alike(kit: Kit) -> None:
    of = suite([case([(n, True, True)] * 2) for n in range(9)], ["exact", "monitor"])
    for jobs in (1, 4):
        made: list[Any] = []

        def start(made: list[Any] = made) -> Any:
            made.append(Wired(Program()))
            return made[-1]

        verdict = kit.run(of, start, "monitor", jobs=jobs)
        assert (verdict.word, verdict.cases, verdict.properties) == (
            "FOLLOWS",
            9,
            {"BNeedsGo": 27, "AFirst": 27, "BLasts": 0},
        )
        assert len(made) == jobs and all(one.program.closed == 1 for one in made)
        assert kit.run(of, lambda: Spoiled({(2, "B"): False}), jobs=jobs).word == "DIFFERS"


def the_page_decides_and_the_reference_where_asked(kit: Kit) -> None:
    def verdict(word: str, **more: Any) -> Any:
        return kit.verdict.Verdict(word, "stages", "by hand", "exact", **more)

    words = {"FOLLOWS": 0, "BREAKS": 1, "UNJUDGED": 2}
    for page, status in words.items():
        for own, other in {"CONFORMS": 0, "DIFFERS": 1, "UNJUDGED": 2}.items():
            first = verdict(page)
            one, both = verdict(own, page=first), verdict(own, page=first, same=True)
            assert verdict(own).status == other and verdict(own).judged[0].word == own
            if page == "UNJUDGED":
                assert one.judged == (one,) and (one.status, both.status) == (other, other)
                continue
            assert one.judged == (first,) and both.judged == (first, both)
            assert (one.status, both.status) == (status, max(status, other))
    ended = verdict("UNJUDGED", interrupted=True)
    assert verdict("CONFORMS", page=ended).judged == (ended,)
    found = kit.run(
        suite([case([(0, False, True)])], ["monitor"]), lambda: Spoiled({(1, "B"): True}), "monitor"
    )
    line = found.difference.in_a_line
    assert "expected" not in line and line.endswith("(breaks BNeedsGo): B is true")


def trouble_of_any_kind_is_unjudged(kit: Kit) -> None:
    of = suite(walks(3, False), ["exact"], None)

    class Dying(Program):
        error: BaseException = ValueError("odd")

        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            if self.resets == 3:
                raise self.error
            return super().scan(dt_ms, inputs)

    made: list[Program] = []

    def start(kind: type[Program]) -> Callable[[], Program]:
        return lambda: made.append(kind()) or made[-1]  # type: ignore[func-returns-value]

    verdict = kit.run(of, start(Dying))
    assert (verdict.word, verdict.cases) == ("UNJUDGED", 1) and made[-1].closed == 1
    assert verdict.reason == f"{of.given[1].id}, scan 1: ValueError: odd"
    stopped = type("Stopped", (Dying,), {"error": KeyboardInterrupt()})
    verdict = kit.run(of, start(stopped))
    assert (verdict.word, verdict.reason) == ("UNJUDGED", "interrupted after 1 cases") and verdict.interrupted
    refused = type("Refused", (Dying,), {"error": Unjudged("it said no")})
    assert kit.run(of, start(refused)).reason == f"{of.given[1].id}, scan 1: it said no"

    def missing() -> Program:
        raise Unjudged("cannot be started")

    assert kit.run(of, missing).reason == "cannot be started"
    assert kit.run(of, lambda: Spoiled({}, ok=False)).reason.startswith("hello: hello was answered")


def progress_is_told_now_and_then(kit: Kit) -> None:
    of = suite(walks(4, False), ["exact"], None)
    told: list[tuple[int, int]] = []
    assert kit.run(of, Program, on_progress=lambda *now: told.append(now)).word == "CONFORMS" and not told
    clock = iter(range(1000))
    held, kit.judge.time = kit.judge.time, type("Clock", (), {"monotonic": staticmethod(lambda: next(clock))})
    try:
        verdict = kit.run(of, Program, on_progress=lambda *now: told.append(now))
    finally:
        kit.judge.time = held
    assert len(told) == 4 and told[-1] == (of.scan_count, of.scan_count) and verdict.seconds > 0


# ------------------------------------------------------------------------------------------------ shrinking

WAYS = {
    ARMED: (OFF, 0, True, 1),
    FIRED: (ARMED, 0, True, 2),
    LOWERED: (ARMED, 0, False, 4),
    SPENT: (FIRED, 500, True, 6),
}


def _ways() -> dict[str, Any]:
    way: list[Any] = [None] * 5
    for state, (before, dt_ms, go, step) in WAYS.items():
        way[state] = [before, dt_ms, {"go": go}, ROWS[state], step, 2 * state + go]
    return {"graphs": [{"params": {}, "initial": OFF, "views": [""] * 5, "ways": way}]}


def a_difference_is_made_short_and_run_again(kit: Kit) -> None:
    long = case(
        [
            (0, False, True),
            (0, True, True),
            (0, False, True),
            (0, False, True),
            (0, True, True),
            (0, True, True),
        ]
    )
    of = suite([long], ["exact"], None, **_ways())

    class Stiff(Program):
        def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
            return {**row, "B": False}

    moody = iter([True])
    once = type(
        "Once",
        (Program,),
        {"shown": lambda self, row: ROWS[ARMED] if self.count == 4 and next(moody, 0) else row},
    )
    (found,) = kit.run(of, once, effort=9).differences
    assert (found.confirmed, found.part, found.scan) == (False, "1-4", 4)
    (found,) = kit.run(of, Stiff, effort=40).differences
    assert (found.scan, found.step, found.confirmed, found.part) == (3, "Lower", True, "~2,3"), found
    assert [scan.to for scan in found.shortest.scans] == [ARMED, LOWERED]
    (found,) = kit.run(of, Stiff, effort=0).differences
    assert (found.confirmed, found.part) == (None, "1-3")
    verdict = kit.run(of, Stiff, only=long.id, part="1-3", effort=40)
    assert (verdict.differences[0].confirmed, verdict.differences[0].part) == (None, "1-3")
    assert verdict.scans == 3, "what is run again is not counted"


def a_program_that_is_late_is_told_by_how_much(kit: Kit) -> None:
    of = suite([case([(0, True, True), (0, True, True), (500, True, True)])], ["exact"], None, **_ways())

    class Late(Program):
        def reset(self, params: Mapping[str, Any]) -> None:
            super().reset(params)
            self.device.limit_ms = 512

    (found,) = kit.run(of, Late, effort=40).differences
    assert found.time == "it comes 12 ms late" and found.confirmed
    held = replace(of, relations=("settled",))
    (found,) = kit.run(held, Late, "settled", effort=40).differences
    assert found.time == ""
    real = lambda: type("Real", (Late,), {"says": {"time": "real"}})()  # noqa: E731
    (found,) = kit.run(held, real, "settled", effort=40).differences
    assert found.time == ""
    (found,) = kit.run(of, lambda: Spoiled({(n, "A"): False for n in range(1, 9)}), effort=40).differences
    assert found.time == "" and found.confirmed


def where_nothing_is_expected_any_scan_may_be_left_out(kit: Kit) -> None:
    of = suite([case([(0, False, True)] * 5 + [(0, True, True)])], ["monitor"])

    class Eager(Program):
        def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
            return {**row, "B": row["A"]}

    (found,) = kit.run(of, Eager, "monitor", effort=40).differences
    assert (found.broken, found.part, found.confirmed) == ("AFirst", "6", True)
    for effort, runs in ((0, 1), (1, 2), (2, 3), (3, 4)):
        tried: list[Program] = []
        kit.run(of, lambda tried=tried: tried.append(Eager()) or tried[0], "monitor", effort=effort)
        assert tried[0].resets == 1 + runs, (effort, tried[0].resets)


def only_the_first_of_a_cause_is_made_short(kit: Kit) -> None:
    of = suite(
        [case([(n, False, True), (0, True, True), (0, True, True)]) for n in range(3)],
        ["exact"],
        None,
        **_ways(),
    )
    verdict = kit.run(of, lambda: Spoiled({(n, "B"): False for n in range(9)}), most=9, effort=40)
    assert [one.confirmed for one in verdict.differences] == [True, None, None]
    made = Wired(Spoiled({(n, "B"): False for n in range(9)}))
    kit.run(of, lambda: made, most=9, effort=40)
    assert made.asked.count("quiet") == 2, "before and after it was made short"


def groups_end_where_outputs_are_compared(kit: Kit) -> None:
    of = case([(0, True, False), (0, True, True), (0, False, True), (0, True, False)])
    assert list(kit.relation.groups(of)) == [(0, 1), (2, 2), (3, 3)]


def a_failure_in_several_outputs_is_told_in_a_line(kit: Kit) -> None:
    of = suite([case([(0, True, True)])], ["exact"], None)
    verdict = kit.run(of, lambda: Spoiled({(1, "A"): False, (1, "B"): True, (1, "CODE"): "00FF"}), codes=True)
    said = 'A is false, expected true; B is true, expected false; CODE is "00FF", expected "0001"'
    assert verdict.reason == f"case {of.given[0].id}, scan 1 (Arm): {said}"
    found = replace(verdict.differences[0], expected=dict.fromkeys("ABCDE", 0), got=dict.fromkeys("ABCDE", 1))
    assert found.in_a_line.endswith("C is 1, expected 0, and 2 more")


def real_time_may_not_pass_unnoticed(kit: Kit) -> None:
    one = case([(0, True, False), (100, True, True), (0, False, False), (0, False, True)])
    for takes_ms, slow, word in (
        (0, 1, "CONFORMS"),
        (12, 1, "CONFORMS"),
        (20, 1, "UNJUDGED"),
        (20, 2, "CONFORMS"),
    ):
        now = [0.0]
        clock = type("Clock", (), {"monotonic": staticmethod(lambda now=now: now[0])})

        class Real(Program):
            says = {"time": "real"}  # noqa: RUF012

            def scan(
                self, dt_ms: int, inputs: Mapping[str, Any], now: list[float] = now, takes: int = takes_ms
            ) -> Any:
                now[0] += (dt_ms + takes) / 1000
                return super().scan(dt_ms, inputs)

        held, kit.relation.time = kit.relation.time, clock
        try:
            verdict = kit.run(suite([one], ["settled"], None), Real, "settled", slow=slow)
        finally:
            kit.relation.time = held
        assert verdict.word == word, (takes_ms, slow, verdict.reason)
        if word == "UNJUDGED":
            assert "took 160 ms, more than the case can bear (100 ms); --slow 2 gives" in verdict.reason, (
                verdict.reason
            )


CLAIMS: tuple[Callable[[Kit], None], ...] = tuple(
    value
    for name, value in list(globals().items())
    if callable(value)
    and getattr(value, "__module__", "") == __name__
    and name[0] != "_"
    and not isinstance(value, type)
    and name != "judge_with"
)

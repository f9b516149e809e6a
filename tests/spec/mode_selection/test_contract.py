"""The contract page: each of its conditions is needed by a property of its own, or follows from the others.

A refinement says nothing of a contract that allows too much. So each condition of ModeSelection.tla is
dropped, and each effect made free; a named property must fall. Where none does, the weaker contract refines
the shipped one from any values, so that nothing was lost.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec
import pytest

from tests.spec.mode_selection.planted import (
    CONTRACT_ANYWHERE,
    DOCUMENT,
    SPEC,
    Fault,
    Finding,
    Trial,
    copy,
    plant,
    run_copy,
)

TEXT = (SPEC / "ModeSelection.tla").read_text()
ACTIONS = ("Insert", "Signal", "Touch", "Show", "Confirm", "Switch")
FREE = "\\in MSO \\cup {None}"
AND = " /\\ "


@dataclass(frozen=True)
class Weaker:
    """One condition of an action dropped, or one of its effects made free."""

    action: str
    what: str
    text: str


def parts(action: str) -> tuple[str, list[str]]:
    """The text of an action, and its conjuncts without comments; UNCHANGED becomes one for each variable."""
    found = re.search(rf"^{action} ==(.*?)\n\n", TEXT, re.M | re.S)
    assert found is not None
    bare = re.sub(r"\\\*[^\n]*", "", found[1])
    conjuncts: list[str] = []
    for part in (one.strip() for one in bare.split("/\\")):
        listed = re.fullmatch(r"UNCHANGED <<(.*)>>", part, re.S)
        conjuncts += (
            [f"{name.strip()}' = {name.strip()}" for name in listed[1].split(",")] if listed else [part]
        )
    return found[0], [part for part in conjuncts if part]


def weakened() -> list[Weaker]:
    """Every condition dropped and every effect made free, one at a time; and both comparisons."""
    found = []
    for action in ACTIONS:
        old, conjuncts = parts(action)
        for number, part in enumerate(conjuncts):
            effect = re.match(r"(\w+)' ", part)
            if effect is not None and FREE in part:
                continue  # it is free already
            kept = [f"{effect[1]}' {FREE}"] if effect else []
            rest = conjuncts[:number] + kept + conjuncts[number + 1 :]
            found.append(Weaker(action, part, f"{action} == {AND.join(rest)}\n\n"))
        assert old in TEXT
    _, conjuncts = parts("Switch")
    rest = [part for part in conjuncts if part not in ("confirmed = touched", "confirmed = seen")]
    assert len(rest) == len(conjuncts) - 2
    found.append(Weaker("Switch", "both comparisons", f"Switch == {AND.join(rest)}\n\n"))
    return found


FOLLOWS = {
    ("Switch", "level # None"): "a confirmed mode is 0 or more, and no level is -1",
    ("Confirm", "seen # None"): "nothing seen and nothing confirmed is what a touch of the same mode leaves",
    ("Insert", "touched' = None"): "a key and then a touch, in one step: what a touch alone does",
    ("Touch", "touched' \\in MSO"): "a touch of nothing is what another key does",
}
"""Conditions that a reader wants to see, though they follow from the others."""
WEAKER = weakened()


def fault(weaker: Weaker) -> Fault:
    """The weaker contract as a fault to plant."""
    name = f"{weaker.action} without {weaker.what}"
    return Fault(name, "ModeSelection.tla", parts(weaker.action)[0], weaker.text)


CASES = [(one, Trial(CONTRACT_ANYWHERE, fault(one))) for one in WEAKER]


def test_every_condition_of_the_contract_is_weakened_once() -> None:
    assert len(WEAKER) == 37 and {one.action for one in WEAKER} == set(ACTIONS)


@pytest.mark.sampled(9)
@pytest.mark.parametrize(("weaker", "trial"), CASES, ids=[str(trial) for _, trial in CASES])
def test_the_weaker_contract_breaks_a_property_of_its_own(
    weaker: Weaker, trial: Trial, trials: Callable[[Trial], Finding]
) -> None:
    found = trials(trial)
    assert found.outcome.log.errors == []
    if (weaker.action, weaker.what) in FOLLOWS:
        assert found.judgement.verdict == "HOLDS"
    else:
        assert found.judgement.verdict == "VIOLATED"
        ((kind, name),) = found.outcome.log.violations
        assert kind == "property" and name in CONTRACT_ANYWHERE.declared.properties


COMPARED = """---- MODULE Compared ----
EXTENDS ModeSelectionAlone
Shipped == INSTANCE Shipped
LosesNothing == [][Shipped!Next]_vars
====
"""


@pytest.mark.parametrize(("action", "what"), [*FOLLOWS, ("Switch", "confirmed = seen")])
@pytest.mark.deep
def test_a_condition_that_follows_from_the_others_changes_no_step(
    action: str, what: str, tmp_path: Path
) -> None:
    (weaker,) = (one for one in WEAKER if (one.action, one.what) == (action, what))
    copy(tmp_path)
    folder = tmp_path / "spec" / DOCUMENT
    (folder / "Shipped.tla").write_text(TEXT.replace("MODULE ModeSelection", "MODULE Shipped"))
    (folder / "Compared.tla").write_text(COMPARED)
    plant(tmp_path, fault(weaker))
    run = msgspec.structs.replace(CONTRACT_ANYWHERE.declared, module="Compared", properties=("LosesNothing",))
    found = run_copy(tmp_path, run, "SPECIFICATION Anywhere\nPROPERTY LosesNothing\n")
    assert found.judgement.verdict == ("HOLDS" if (action, what) in FOLLOWS else "VIOLATED")

"""A program that is the reference with another reading of one finding is told so, and no other is."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import pytest

from modeproof.ground.places import documents, root
from modeproof.kit.builtin import REFERENCE, Builtin
from modeproof.kit.profile import of_profile
from modeproof.kit.readings import TYPES
from modeproof.kit.text import as_record, as_text
from modeproof.kit.two_answers import judge_both
from modeproof.kit.vectors import Suite, open_suite
from modeproof.kit.verdict import Plan, Verdict
from modeproof.registers.load import load_interface
from modeproof.suites.build import document_readings


def every_choice() -> list[tuple[str, str, str, Any]]:
    """Document, target, parameter and another value than that of the letter."""
    return [
        (document, target, name, value)
        for document in documents(root())
        if (root() / "spec" / document / "interface.toml").is_file()
        for target, device in load_interface(root(), document).devices.items()
        if device.published
        for name, of in device.parameters.items()
        if of.type in TYPES
        for value in (of.values or (False, True))
        if value != of.default
    ]


class Other(Builtin):
    """The reference, which has some parameters as it likes; `flips` is an output that it turns round."""

    def __init__(self, suite: Suite, own: Mapping[str, Any], flips: str = "") -> None:
        super().__init__(REFERENCE, suite)
        self.own, self.flips = own, flips

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset({**params, **self.own})

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        out = super().scan(dt_ms, inputs)
        return {**out, self.flips: not out[self.flips]} if self.flips and inputs[self.turned] else out

    turned = "Reset"


@cache
def letter(document: str, target: str, name: str) -> Suite:
    """The cases of a published suite that speak of the letter."""
    suite = of_profile(open_suite(root() / f"vectors/{target}/{name}.jsonl.gz"), "letter")
    assert suite is not None
    return suite.demanding(None, None, document_readings(root(), document))


def judged(suite: Suite, own: Mapping[str, Any], flips: str = "") -> Verdict:
    return judge_both(suite, lambda: Other(suite, own, flips), Plan(most=2))


def said(verdict: Verdict) -> set[str]:
    return {found.reading for found in verdict.differences if found.reading}


@pytest.mark.parametrize(
    "row",
    [
        pytest.param(
            row, marks=pytest.mark.deep if row[2] == "T_SEQ_FROM" else (), id=f"{row[1]}-{row[2]}-{row[3]}"
        )
        for row in every_choice()
    ],
)
def test_each_reading_that_is_a_parameter_is_recognized(row: tuple[str, str, str, Any]) -> None:
    document, target, name, value = row
    for suite in ("sequences", "brief"):  # two readings show in the second alone
        verdict = judged(letter(document, target, suite), {name: value})
        if verdict.word == "DIFFERS":
            break
    shown = str(value).upper() if isinstance(value, bool) else value
    finding = document_readings(root(), document)[name]
    (words,) = said(verdict)
    assert words.startswith(f"the program has the reading {name} = {shown} ({finding}): so the reference ")


def test_two_readings_at_once_are_those_of_the_other_profile() -> None:
    suite = letter("guard_locking", "sf_guard_locking", "brief")
    verdict = judged(suite, {"UNLOCK_ON": "edge", "UNLOCK_ENDS": "when_closed"})
    assert any("UNLOCK_ENDS = when_closed (GLF-03): the profile cautious" in words for words in said(verdict))


def test_a_fault_is_no_reading() -> None:
    suite = letter("edm", "sf_edm", "sequences")
    verdict = judged(suite, {}, flips="Ready")
    words = "none that the reference can have: no other value of AFTER_RESET (EDMF-04) explains it"
    assert said(verdict) and all(one.startswith(words) for one in said(verdict))
    assert f"reading: {words}" in as_text(verdict, suite=suite)
    assert as_record(verdict)["difference"]["reading"].startswith(words)


def test_a_reading_with_a_fault_is_no_reading() -> None:
    suite = letter("edm", "sf_edm", "sequences")
    verdict = judged(suite, {"AFTER_RESET": "stop_first"}, flips="Error")
    assert not any("all" in words and words.startswith("the program has") for words in said(verdict))

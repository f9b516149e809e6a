"""By the page an input that it calls constant stays as it is; with `flips` it changes as in the vectors."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.places import root
from modeproof.kit.builtin import REFERENCE, Builtin
from modeproof.kit.constants import changing, constant_inputs, with_constants
from modeproof.kit.errors import Unjudged
from modeproof.kit.text import as_record, as_text
from modeproof.kit.two_answers import judge_both
from modeproof.kit.vectors import Suite, open_suite
from modeproof.kit.verdict import Plan
from modeproof.registers.load import load_interface
from modeproof.suites.demands import load_demands
from tests.kit.lamps import DEMANDS, made

TARGET, DOCUMENT, INPUT = "sf_testable_safety_sensor", "testable_safety_sensor", "NoExternalTest"


def sensor(name: str) -> Suite:
    """A published suite of the sensor, with what its page demands."""
    device = load_interface(root(), DOCUMENT).devices[TARGET]
    return open_suite(root() / f"vectors/{TARGET}/{name}.jsonl.gz").demanding(
        load_demands(root(), DOCUMENT, device)
    )


class Takes(Builtin):
    """The reference, which takes the constant when it powers up, and goes wrong when it changes later."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.taken: Any = None

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.taken = inputs[INPUT] if self.taken is None else self.taken
        out = super().scan(dt_ms, inputs)
        return out if inputs[INPUT] == self.taken else {**out, "S_OSSD_Out": True, "Error": True}


def test_a_case_keeps_the_first_value() -> None:
    suite = sensor("sequences")
    assert constant_inputs(suite) == (INPUT,)
    pairs = list(zip(suite.cases(), with_constants(suite).cases(), strict=True))
    flipped = [(one, held) for one, held in pairs if changing((INPUT,), one.scans)]
    assert 0 < len(flipped) < len(pairs)
    assert not any(changing((INPUT,), held.scans) for _, held in pairs)
    assert all(held == one for one, held in pairs if (one, held) not in flipped)
    assert any(
        held.scans[n].outputs != scan.outputs for one, held in flipped for n, scan in enumerate(one.scans)
    )


@pytest.mark.deep
def test_who_takes_a_constant_once_follows_the_page() -> None:
    suite = sensor("sequences")
    verdict = judge_both(suite, lambda: Takes(REFERENCE, suite), Plan(most=20))
    assert verdict.page is not None and verdict.page.word == "FOLLOWS", verdict.page and verdict.page.reason
    text = as_text(verdict, suite=suite)
    assert f"{INPUT} constant, as the page has it)" in text
    assert verdict.word == "DIFFERS" and f"{INPUT} changes, which the page calls constant" in text
    assert as_record(verdict)["page"]["constant"] == [INPUT]


def test_flips_are_put_where_they_are_asked_for() -> None:
    suite = sensor("sequences")
    verdict = judge_both(suite, lambda: Takes(REFERENCE, suite), flips=True)
    assert verdict.page is not None and verdict.page.word == "BREAKS" and not verdict.page.constant


def test_a_constant_is_an_input(tmp_path: Path) -> None:
    suite = made(tmp_path, "brief", {**DEMANDS, "constant": {"pres": ["TOY-1"]}})
    with pytest.raises(Unjudged, match="constant: no input pres"):
        suite.demands()

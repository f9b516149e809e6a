"""Counters that overflow: no other suite runs long enough to see one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites import soak
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp


class Counting(Lamp):
    """Goes dark once after so many switchings, or so many scans in the dark."""

    most = 256
    waits = False

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.count = 0

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        before = self.on
        out = super().scan(dt_ms, inputs)
        self.count += (not self.on) if self.waits else (self.on and not before)
        if self.count == self.most:
            self.count, self.on = 0, not self.on
            return {"LAMP": self.on, "MW": "0FF0" if self.on else "0000"}
        return out


class Waiting(Counting):
    waits = True


class Word(Counting):
    most = 1 << 16


def made(folder: Path, name: str) -> Suite:
    write_suite(folder / f"{name}.jsonl.gz", name, [lamp_graph(folder)])
    return open_suite(folder / f"{name}.jsonl.gz")


@pytest.mark.parametrize("fault", [Counting, Waiting])
def test_a_counter_of_8_bits_passes_all_but_soak(tmp_path: Path, fault: type[Lamp]) -> None:
    for name, word in (("tour", CONFORMS), ("wp", CONFORMS), ("soak", DIFFERS)):
        assert run_suite(made(tmp_path, name), fault).word == word
    assert run_suite(made(tmp_path, "soak"), Lamp).word == CONFORMS


@pytest.mark.long
def test_a_counter_of_16_bits_overflows_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_suite(made(tmp_path, "soak"), Word).word == CONFORMS, "the short one"
    monkeypatch.setattr(soak, "MOST", 66_000)
    suite = made(tmp_path, "soak")
    assert run_suite(suite, Word).word == DIFFERS
    assert run_suite(suite, Lamp).word == CONFORMS
    assert suite.path.stat().st_size < 200_000, "what repeats takes little room"


def test_each_case_is_one_run_with_every_step_after_it(tmp_path: Path) -> None:
    suite = made(tmp_path, "soak")
    for case in suite.cases():
        last = {suite.steps[scan.step].name for scan in case.scans[-12:]}
        assert last == {"StayOff", "SwitchOn", "StayOn", "Expire"}, case.why
    assert "for 400 scans" in " ".join(case.why for case in suite.cases())

"""Every row of the printed table, in the code and in the specification, against a third transcription."""

from __future__ import annotations

import re
from dataclasses import astuple, fields
from pathlib import Path

import pytest

from refimpl.testable_safety_sensor.sf_testable_safety_sensor import Outputs, Params, State, Step, outputs
from tests.refimpl.testable_safety_sensor.printed_rows import ORDER, rows, state_of

ROOT = Path(__file__).resolve().parents[3]
SPEC = (ROOT / "spec/testable_safety_sensor/TestableSafetySensor.tla").read_text(encoding="utf-8")
PRINTED = {state_of(name, code): (code, row) for (name, code), row in rows().items()}


def specified(text: str) -> dict[str, tuple[int, tuple[bool, ...]]]:
    """The rows of the TLA+ table; that of Idle has a name of its own."""
    idle = text.partition("\nIdleRow == ")[2].partition("\n")[0]
    text = text.replace("-> IdleRow", f"-> {idle}")
    found = re.findall(r's = "(\w+)" +-> OutputRow\(\\h([0-9A-F]{4}), ((?:[TF](?:, )?){8})\)', text)
    return {
        state: (int(code, 16), tuple(letter == "T" for letter in row.split(", ")))
        for state, code, row in found
    }


def coded(step: Step) -> tuple[int, tuple[bool, ...]]:
    *row, code = astuple(outputs(State(Params(), step, False, False, False, False, 0)))
    return code, tuple(row)


def test_the_table_has_22_codes_and_each_is_a_state() -> None:
    assert len(PRINTED) == 22 == len({code for code, _ in PRINTED.values()})
    assert set(PRINTED) == {step.value for step in Step}


def test_the_outputs_are_those_of_the_table_in_its_order() -> None:
    assert tuple(field.name for field in fields(Outputs)) == (*ORDER, "DiagCode")


@pytest.mark.parametrize("step", Step, ids=lambda step: step.value)
def test_the_code_has_the_printed_row(step: Step) -> None:
    assert coded(step) == PRINTED[step.value]


def test_the_specification_has_the_printed_rows() -> None:
    assert specified(SPEC) == PRINTED


@pytest.mark.parametrize("state", sorted(PRINTED))
def test_one_wrong_output_in_the_specification_is_seen(state: str) -> None:
    begins = "IdleRow ==" if state == "Idle" else f's = "{state}" '
    line = next(line for line in SPEC.splitlines() if begins in line and "OutputRow" in line)
    wrong = re.sub(r", ([TF])\)", lambda last: ", F)" if last.group(1) == "T" else ", T)", line)
    assert specified(SPEC.replace(line, wrong)) != PRINTED

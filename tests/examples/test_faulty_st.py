"""The faulty programs in ST, SCL, diagrams and statement list: refuted by scans, or proved with a reason."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from examples.faulty.st import HEAD_PROVED, LINE, PAGE, as_page, judge, load_faults, main, row
from modeproof.ground.errors import Unjudged
from tests.examples.entries import entries, entry

FAULTS = {fault.id: fault for fault in load_faults()}
FEW = ("st-fplc-error-holds-the-mode", "st-fplc-level-kept-in-removal")
"""Of the F-PLC, whose faults take half a minute each; `examples/faulty/st.py` judges all."""


JUDGED = [name for name, fault in FAULTS.items() if fault.target != "fplc" or name in FEW]


@pytest.mark.sampled(16)
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.long] * (place % 3 > 0 if name not in FEW else name == FEW[0]))
        for place, name in enumerate(JUDGED)
    ],
)
def test_a_faulty_program_gets_its_verdict(name: str, tmp_path: Path) -> None:
    fault = FAULTS[name]
    found = judge(fault, tmp_path)
    assert found.word == fault.expected
    lines = PAGE.read_text("utf-8").splitlines()
    if fault.reason:
        assert entry(HEAD_PROVED, f"| {fault.id} | {fault.mistake} | {fault.reason} |") in entries(PAGE)
    elif found.difference is not None and found.difference.found_by.startswith("published"):
        assert row(fault, found) in lines, "run examples/faulty/st.py --render"
    if name == FEW[0]:  # no vector shows it: it takes a way through most pairs
        assert found.difference is not None and len(found.difference.scans) <= 14


def test_the_page_lists_exactly_the_faulty_programs() -> None:
    page = PAGE.read_text("utf-8")
    refuted = [name for name, _ in re.findall(LINE, page, re.MULTILINE)]
    proved = [one.split("**")[1] for one in entries(PAGE)]
    assert sorted([*refuted, *proved]) == sorted(FAULTS)
    lines = dict(re.findall(LINE, page, re.MULTILINE))
    assert as_page([*FAULTS.values()], lines) == page, "run examples/faulty/st.py --render"
    shown = Counter(name.partition("-")[0] for name, fault in FAULTS.items() if not fault.reason)
    assert shown["st"] >= 30 and min(shown[name] for name in ("scl", "fbd", "ld", "stl")) >= 4
    assert {fault.target for fault in FAULTS.values()} >= {"sf_edm", "sf_enable_switch", "sf_guard_locking"}


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("old = 'NOT THERE'\nnew = ''", "stands 0 times"),
        ("old = 'Ready'\nnew = ''", "times in"),
        ("old = 'edge(CLK := Reset);'\nnew = 'edge(CLK := Reset);'", "stands 1 times"),
        ("old = 'edge(CLK := Reset);'", "TypeError"),
    ],
)
def test_a_fault_that_is_none_is_not_judged(text: str, cause: str, tmp_path: Path) -> None:
    path = tmp_path / "st.toml"
    path.write_text(f"[[fault]]\nid = 'x'\nfile = 'examples/st/sf_edm.st'\nmistake = 'm'\n{text}\n", "utf-8")
    with pytest.raises(Unjudged, match=cause):
        load_faults(path)


def test_the_command_tells_expected_from_unjudged(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["st-edm-precedence"]) == 0
    assert "ok  st-edm-precedence: REFUTED" in capsys.readouterr().out
    assert main(["--target", "none"]) == 2
    assert "no fault of none" in capsys.readouterr().err
    assert main(["st-none"]) == 2
    assert "no fault st-none" in capsys.readouterr().err

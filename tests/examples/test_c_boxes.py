"""The C program that takes one diagram box in each cycle: right once settled, and not scan by scan."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from modeproof.kit.adapter import Adapter
from modeproof.kit.suite_judge import Options, Plan, Verdict, run_suite
from modeproof.kit.vectors import Suite, open_suite
from modeproof.registers.load import load_interface
from modeproof.suites.demands import load_demands

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "examples/c"
VECTORS = SOURCE / "settled.jsonl.gz"


def made(folder: Path, old: str = "", new: str = "", hello: tuple[str, str] = ("settled", "24")) -> Path:
    """The program with one edit, and with another hello."""
    for name in ("fplc.h", "wire.h", "wire.c", "adapter.c", "fplc_boxes.c"):
        text = (SOURCE / name).read_text(encoding="utf-8")
        if name == "fplc_boxes.c" and old:
            assert text.count(old) == 1
            text = text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")
    says = (("NAME", "boxes"), ("RELATION", hello[0]), ("LATENCY", hello[1]))
    defined = [f'-DFPLC_{name}="{value}"' for name, value in says]
    command = ["gcc", "-std=c99", "-w", *defined, "-o", "program", "adapter.c", "wire.c", "fplc_boxes.c"]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "program"


@pytest.fixture(scope="module")
def suite() -> Suite:
    device = load_interface(ROOT, "mode_selection").devices["fplc"]
    return open_suite(VECTORS).demanding(load_demands(ROOT, "mode_selection", device))


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("boxes"))


def judged(program: Path, suite: Suite, relation: str, effort: int = 0) -> Verdict:
    return run_suite(suite, lambda: Adapter([str(program)]), plan=Plan(Options(relation), effort=effort))


@pytest.mark.deep
@pytest.mark.parametrize("relation", ["settled", pytest.param("monitor", marks=pytest.mark.long)])
def test_it_passes_what_leaves_it_its_time(program: Path, suite: Suite, relation: str) -> None:
    verdict = judged(program, suite, relation)
    assert (verdict.word, verdict.reason) == ("FOLLOWS" if relation == "monitor" else "CONFORMS", "")
    assert relation == "settled" or any(verdict.properties.values())


@pytest.mark.deep
def test_it_does_not_pass_scan_by_scan(suite: Suite, tmp_path: Path) -> None:
    assert judged(made(tmp_path, hello=("exact", "0")), suite, "exact").word == "DIFFERS"


@pytest.mark.deep
def test_it_needs_the_scans_that_it_asks_for(suite: Suite, tmp_path: Path) -> None:
    assert judged(made(tmp_path, hello=("settled", "12")), suite, "settled").word == "DIFFERS"


FAULTS = {
    "Figure 7 as printed": ("0x0F0F, 0x0FF0, 0x3333};\n\n/* ---", "0x0FF0, 0x0FF0, 0x3333};\n\n/* ---"),
    "a changed selection is confirmed": (
        "if (in->MW03 != SE[m->selection]) {",
        "if (false) {",
    ),
    "another output is not noticed": ("level != m->accepted", "false"),
    "LA is not looked at": ("if (!in->LA && !removing) {", "if (false) {"),
    "two outputs are not noticed": ("count > 1 && !pulse", "false && !pulse"),
    "no dwell time": ("m->elapsed_ms >= m->set.T_DWELL_ms;", "true;"),
    "the echo is the selection": ("? CH[m->selection]", "? SE[m->selection]"),
    "the mode goes with the key": ("    timed(m, Clear);", "    m->mode = FPLC_NONE;\n    timed(m, Clear);"),
    "the selection need not come after zeros": ("    timed(m, Settle);", "    timed(m, AwaitSelection);"),
    "no switchover": ("            m->mode = m->selection;\n", ""),
    "nothing is too late": ("if (is_late(m)) {", "if (false) {"),
}
"""One edit each, and what it is."""
UNSAFE = {
    "two outputs are not noticed": "TwoOutputsAreAFault",
    "the echo is the selection": "EchoIsASelection",
    "the mode goes with the key": "ModeStays",
}
"""Those that break a demand of the note, and which one is seen first."""


@pytest.mark.sampled
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found_once_all_has_settled(name: str, suite: Suite, tmp_path: Path) -> None:
    verdict = judged(made(tmp_path, *FAULTS[name]), suite, "settled", effort=1)
    assert verdict.word == "DIFFERS", verdict.reason
    assert verdict.difference is not None and verdict.difference.confirmed


@pytest.mark.sampled
@pytest.mark.parametrize("name", UNSAFE)
def test_a_fault_that_the_note_forbids_breaks_a_demand(name: str, suite: Suite, tmp_path: Path) -> None:
    verdict = judged(made(tmp_path, *FAULTS[name]), suite, "monitor")
    assert verdict.difference is not None and verdict.difference.broken == UNSAFE[name]

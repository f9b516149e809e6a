"""The statement-list programs: their adapter speaks the protocol, they follow the specification, and each
planted fault is rejected.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

from examples.faulty.awl import ADAPTER, AWL, PACK, PAGE, judge, judge_all, main, row, suite_of, write
from examples.faulty.run import HEAD, HEAD_PASSED, Fault, load_faults, vectors
from modeproof.kit.adapter import Adapter, parse_answer
from modeproof.kit.suite_judge import Plan, Verdict
from modeproof.kit.vectors import open_suite
from refimpl.mode_selection import fplc, plc
from tests.examples.entries import entries, entry
from tests.examples.protocol import BYE, DARK, HELLO, REFUSED, RESET, scan, talk
from tests.examples.test_c_program import params, scans_of, ways

ROOT = Path(__file__).resolve().parents[2]
FAULTS = load_faults(PACK)
CAUGHT = [fault for fault in FAULTS if not fault.reason]
AGAIN = [fault for at, fault in enumerate(CAUGHT) if at % 3 == 0 or "MODEPROOF_LONG" in os.environ]
"""`renew` judges each fault when the cases of its target change; one in three is judged again each time."""
LONG_ONE = pytest.mark.long
COMMAND = [sys.executable, str(ADAPTER), "fplc"]
PLC_BRIEF = ROOT / "vectors" / "plc" / "brief.jsonl.gz"


@pytest.fixture(scope="module")
def adapter() -> Iterator[Adapter]:
    """One running F-PLC for the tests that need many cases; reset before each."""
    with Adapter(COMMAND, timeout_s=600.0) as running:
        yield running


# ------------------------------------------------------------------------------------------ the adapter


def test_the_session_of_the_protocol_page(tmp_path: Path) -> None:
    hello, reset, out, bye, *rest = talk(COMMAND, [HELLO, RESET, scan(on="B", LA=True), BYE, RESET], tmp_path)
    assert hello["ok"] is True and hello["time"] == "virtual" and "exact" in hello["relations"]
    assert (reset, out, bye, rest) == ({"ok": True}, {"out": DARK}, {"ok": True}, [])


def test_every_obligatory_refusal_is_one_line_and_changes_nothing(tmp_path: Path) -> None:
    lines: list[Any] = [RESET, scan(499), *[line for line, _ in REFUSED]]
    replies = talk(COMMAND, [*lines, scan(1), scan(1, LA=True, on="A B"), BYE], tmp_path)
    assert len(replies) == len(lines) + 3
    for (line, cause), reply in zip(REFUSED, replies[2:], strict=False):
        assert list(reply) == ["error"], line
        if cause.startswith(("MW", "T_", "PERMITS", "LA", "STR", "dt_ms", "protocol 1")):
            assert cause in reply["error"], line
    assert replies[-3:] == [{"out": DARK}, {"out": DARK}, {"ok": True}]


def test_one_bad_scan_has_the_whole_list_refused(tmp_path: Path) -> None:
    good = {"dt_ms": 500, "in": scan()["in"]}
    pair = {"op": "scans", "list": [good, {"dt_ms": 1}]}
    with_key = scan(1, LA=True, on="A B")
    replies = talk(COMMAND, [scan(), RESET, pair, with_key, with_key, BYE], tmp_path)
    assert "before reset" in replies[0]["error"]
    assert list(replies[2]) == ["error"]
    assert [reply["out"]["ERROR"] for reply in replies[3:5]] == [True, True]  # still in Start: two outputs


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ("      JL    LOST", "      JX    LOST", "JX"),
        ('L     "EKS_outputs"', 'L     "EKS_output"', "EKS_output"),
        ("LOST: JU    FAIL", "LOST: JU    LOST", "no answer within 2 s"),
    ],
)
def test_a_program_that_cannot_run_gives_one_line_without_verdict(
    tmp_path: Path, old: str, new: str, cause: str
) -> None:
    program = write(tmp_path)
    text = program.read_text(encoding="utf-8")
    assert text.count(old) == 1
    text = text.replace(old, new).replace("JU    STRT ", "JU    LOST ")
    program.write_text(text, encoding="utf-8")
    verdict = judge(program, open_suite(vectors("words")), 2.0 if cause.startswith("no answer") else 600.0)
    assert (verdict.word, verdict.status) == ("UNJUDGED", 2)
    assert cause in verdict.reason and "\n" not in verdict.reason


def test_without_awlsim_the_adapter_says_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "awlsim_loader.py").write_text("raise ImportError('no awlsim here')", encoding="utf-8")
    (tmp_path / "awlsim.py").write_text("raise ImportError('no awlsim here')", encoding="utf-8")
    code = f"import runpy, sys; sys.path.insert(0, {str(tmp_path)!r}); sys.argv = ['adapter.py', 'fplc']; "
    code += f"runpy.run_path({str(ADAPTER)!r}, run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and "examples/awl/requirements.lock" in done.stderr


def test_nothing_but_programs_of_their_own_import_the_simulator() -> None:
    found = [
        path.relative_to(ROOT)
        for room in ("modeproof", "refimpl", "proofs", "programs", "machines", "examples")
        for path in sorted((ROOT / room).rglob("*.py"))
        if "import awlsim" in (text := path.read_text(encoding="utf-8")) or "from awlsim" in text
    ]
    assert found == [ADAPTER.relative_to(ROOT), ADAPTER.with_name("tree.py").relative_to(ROOT)]


# ------------------------------------------------------------------------------------------ the programs


@pytest.mark.sampled
@pytest.mark.parametrize(
    "path",
    [
        PLC_BRIEF,
        vectors("brief"),
        *(pytest.param(vectors(name), marks=LONG_ONE) for name in ("words", "tour")),
    ],
    ids=["plc", "brief", "words", "tour"],
)
def test_the_programs_conform(path: Path) -> None:
    """To all of `brief`; of `words` and `tour`, for a simulator takes minutes, on request alone."""
    suite = open_suite(path)
    verdict = judge(AWL / f"{suite.target}.awl", suite)
    assert (verdict.word, verdict.reason, verdict.scans) == ("CONFORMS", "", suite.scan_count)


def answers(adapter: Adapter, reset: dict[str, Any], scans: list[dict[str, Any]]) -> list[Any]:
    assert parse_answer(adapter.ask(reset)) == {"ok": True}
    entries = [{"dt_ms": one["dt_ms"], "in": one["in"]} for one in scans]
    return [one["out"] for one in parse_answer(adapter.ask({"op": "scans", "list": entries}))["list"]]


def reference(chosen: dict[str, Any], scans: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What refimpl answers, as it is on the wire."""
    own = {name: value for name, value in chosen.items() if not name.startswith("PERMITS_")}
    for name in set(chosen) - set(own):
        own[name] = tuple(mode in chosen[name] for mode in range(5))
    state = fplc.power_up(fplc.Params(**own))
    found = []
    for one in scans:
        words = {name: int(one["in"][name], 16) for name in ("MW03", "MW07")}
        state, out = fplc.step(state, fplc.Inputs(one["dt_ms"], **(one["in"] | words)))
        wire = {name: getattr(out, name) for name in out.__slots__}
        found.append(wire | {name: f"{wire[name]:04X}" for name in ("MW01", "MW05")})
    return found


@pytest.mark.deep
@settings(max_examples=60, deadline=None)
@given(params, ways)
def test_with_any_times_it_does_what_the_reference_does(
    adapter: Adapter, chosen: dict[str, Any], way: list[tuple[str, int, int, int]]
) -> None:
    scans = scans_of(way)
    assert answers(adapter, RESET | {"params": chosen}, scans) == reference(chosen, scans)


LONG = {"T_ON_ms": 3_600_000, "T_SEQ_ms": 3_600_000, "T_REM_ms": 3_600_000, "T_DWELL_ms": 0}


def long_waits() -> list[dict[str, Any]]:
    """Times that no 16 bits hold, up to the longest deadline, and far beyond it."""
    into = [scan(0), scan(0, LA=True)]
    return [*into, scan(40_000, LA=True), scan(3_559_999, LA=True), scan(1, LA=True), scan(10**12, LA=True)]


def test_the_longest_times_are_kept(adapter: Adapter) -> None:
    found = answers(adapter, RESET | {"params": LONG}, long_waits())
    assert [one["ERROR"] for one in found] == [False, False, False, False, True, True]
    assert found == reference(LONG, long_waits())


def test_the_plc_passes_on_any_words_one_a_scan() -> None:
    state = plc.power_up(plc.Params())
    names = ("MW01", "MW05", "SelectMSO", "SwitchMSO")
    with Adapter([sys.executable, str(ADAPTER), "plc"], timeout_s=600.0) as running:
        assert parse_answer(running.ask(RESET)) == {"ok": True}
        for number in range(200):
            words = [(number * 40_503 + place * 9_973) % 65_536 for place in range(4)]
            wire = {name: f"{value:04X}" for name, value in zip(names, words, strict=True)}
            state, out = plc.step(state, plc.Inputs(10, *words))
            got = parse_answer(running.ask({"op": "scan", "dt_ms": 10, "in": wire}))["out"]
            assert got == {name: f"{getattr(out, name):04X}" for name in out.__slots__}, number


def test_flag_words_lie_as_noted_and_share_no_byte() -> None:
    places = {}
    for line in (AWL / "symbols.csv").read_text(encoding="utf-8").splitlines():
        symbol, address, *_ = line.split(";")
        if address.startswith("MW "):
            places[symbol] = int(address[3:])
    assert places == {"MW01": 1, "MW03": 3, "MW05": 5, "MW07": 7}
    covered = [byte for first in places.values() for byte in (first, first + 1)]
    assert len(covered) == len(set(covered)) == 8


# ------------------------------------------------------------------------------------------ the faults


@pytest.fixture(scope="module")
def verdicts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Verdict]:
    """Of each fault, without a search for a shorter way to it."""
    return judge_all(tmp_path_factory.mktemp("awl"), AGAIN, 600.0, Plan(effort=0))


@pytest.mark.deep
@pytest.mark.parametrize("fault", AGAIN, ids=lambda one: one.id)
def test_a_program_that_is_wrong_in_one_place_is_rejected(fault: Fault, verdicts: dict[str, Verdict]) -> None:
    verdict = verdicts[fault.id]
    assert (verdict.word, verdict.status) == ("DIFFERS", 1)
    found = verdict.difference
    assert found is not None and found.expected != found.got
    assert verdict.reason.startswith(f"case {found.case.id}, scan {found.scan} ({found.step}): ")
    assert entry(HEAD, row(fault, verdict)) in entries(PAGE), "run examples/faulty/awl.py --render"


@pytest.mark.parametrize("fault", [one for one in FAULTS if one.reason], ids=lambda one: one.id)
def test_long_times_or_no_dwell_show_what_no_suite_shows(fault: Fault, tmp_path: Path) -> None:
    command = [sys.executable, str(ADAPTER), "fplc", str(write(tmp_path, fault))]
    chosen = LONG | {"T_ON_ms": 50_000}
    early = [scan(0, LA=True), scan(50_000, LA=True)]  # a key that was in at power-up
    with Adapter(command, timeout_s=600.0) as running:
        late = [
            scan(0),
            scan(0, LA=True),
            scan(40_000, LA=True),
            scan(26_000, LA=True),
        ]  # 66,000 is 464 + 65,536
        tries = [early, late]
        assert any(
            answers(running, RESET | {"params": chosen}, way) != reference(chosen, way) for way in tries
        )
    line = f"| {fault.id} | {fault.mistake} | {fault.reason} |"
    assert entry(HEAD_PASSED, line) in entries(PAGE), "run examples/faulty/awl.py --render"


def test_what_a_fault_breaks_is_declared_in_the_registers() -> None:
    spec = ROOT / "spec/mode_selection"
    findings = tomllib.loads((spec / "findings.toml").read_text(encoding="utf-8"))["finding"]
    clauses = tomllib.loads((spec / "clauses.toml").read_text(encoding="utf-8"))["clause"]
    known = {*findings, *clauses}
    assert all(set(fault.breaks) <= known for fault in FAULTS)
    assert len(CAUGHT) >= 12


def test_every_clause_and_decision_that_a_program_cites_is_declared() -> None:
    spec = ROOT / "spec/mode_selection"
    findings = tomllib.loads((spec / "findings.toml").read_text(encoding="utf-8"))["finding"]
    clauses = tomllib.loads((spec / "clauses.toml").read_text(encoding="utf-8"))["clause"]
    known = {*findings, *clauses}
    for name in ("fplc.awl", "plc.awl", "symbols.csv"):
        text = (AWL / name).read_text(encoding="utf-8")
        cited = set(re.findall(r"\b(?:EKS-[A-Z0-9]+(?:-[A-Z0-9]+)*|E-\d\d[a-e]?)\b", text))
        assert cited and cited <= known, name


def test_the_command_tells_expected_from_not_and_from_unjudged(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["awl-error-bit-overwritten"]) == 0
    assert "ok  awl-error-bit-overwritten: DIFFERS" in capsys.readouterr().out
    assert main(["no-such-fault"]) == 2
    assert "no-such-fault" in capsys.readouterr().err


@LONG_ONE
def test_the_good_program_in_a_faulty_place_is_not_rejected(tmp_path: Path) -> None:
    fault = next(one for one in CAUGHT if one.suite == "words")
    same = replace(fault, new=fault.old)
    assert judge(write(tmp_path, same), suite_of(fault)).word == "CONFORMS"
    assert json.loads(json.dumps(suite_of(fault).header))["target"] == "fplc"

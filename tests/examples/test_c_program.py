"""The C program: its adapter speaks the protocol and refuses all else, and it follows the specification."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from examples.faulty.run import build, load_faults, vectors
from modeproof.kit.vectors import open_suite
from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import RE, SE, SW
from tests.any_machine import SHARED_FIXTURE
from tests.examples.protocol import BYE, DARK, HELLO, REFUSED, RESET, scan, talk

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "examples/c"
OUTPUTS = ("A", "B", "C", "D", "STR")


def made(folder: Path, *options: str) -> Path:
    """The program behind its adapter, by its own Makefile and its own strict options."""
    environment = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS", "OUT")}
    targets = [str(folder / "fplc"), str(folder / "fplc_boxes")]
    command = ["make", "--no-print-directory", "-C", str(SOURCE), f"OUT={folder}", *targets, *options]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    for option in ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"):
        assert done.stdout.count(option) == 5
    return folder / "fplc"


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("c"))


@pytest.fixture(scope="module")
def watched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same, ended by the compiler's sanitizers at the first access out of bounds or undefined result."""
    checks = "-O1 -fsanitize=address,undefined -fno-sanitize-recover=all"
    return made(tmp_path_factory.mktemp("watched"), f"CFLAGS={checks}")


def test_the_session_of_the_protocol_page(program: Path, tmp_path: Path) -> None:
    hello, reset, out, bye, *rest = talk(
        [str(program)], [HELLO, RESET, scan(on="B", LA=True), BYE, RESET], tmp_path
    )
    assert hello == {
        "ok": True,
        "name": "fplc.c",
        "version": "1",
        "time": "virtual",
        "relations": ["exact"],
        "max_latency_scans": 0,
        "unobserved": [],
    }
    assert (reset, out, bye, rest) == ({"ok": True}, {"out": DARK}, {"ok": True}, [])


def test_every_obligatory_refusal_is_one_line_and_changes_nothing(watched: Path, tmp_path: Path) -> None:
    lines: list[Any] = [RESET, scan(499), *[line for line, _ in REFUSED]]
    replies = talk([str(watched)], [*lines, scan(1), scan(1, LA=True, on="A B"), BYE], tmp_path)
    assert len(replies) == len(lines) + 3
    for (line, cause), reply in zip(REFUSED, replies[2:], strict=False):
        assert list(reply) == ["error"], line
        if cause.startswith(("MW", "T_", "PERMITS", "LA", "STR", "dt_ms", "protocol 1")):
            assert cause in reply["error"] or "not a JSON object of the protocol" in reply["error"], line
    assert replies[-3:] == [{"out": DARK}, {"out": DARK}, {"ok": True}]


TRICKY = [
    ('{"op":"scan","op":"bye"}', "twice"),
    ('{"op":"scan","dt_ms":01,"in":{}}', "JSON"),
    ('{"op":"scan","dt_ms":1.0,"in":{}}', "JSON"),
    ('{"op":"scan","dt_ms":1e3,"in":{}}', "JSON"),
    ('{"op":"scan","dt_ms":NaN,"in":{}}', "JSON"),
    (json.dumps(scan(dt_ms=4294967296)), "dt_ms"),
    (json.dumps(scan(dt_ms=10**30)), "dt_ms"),
    (json.dumps(scan()).replace('"in": {"LA"', '"in.LA": true, "in": {"A"'), "dot"),
    ('{"op":"bye","in":{"x":{}}}', "JSON"),
    ('{"op":"bye"} {}', "JSON"),
    ('{"op":"b\\u0079e"}', "JSON"),
    ('{"op":"bye"', "JSON"),
    ('{"op":"bye","params":{"T_ON_ms":1}}', "params"),
    ('{"op":"reset","params":3}', "params"),
    ('{"op":"reset","params":{"ON_ERROR":"hol"}}', "ON_ERROR"),
    ('{"op":"reset","params":{"PERMITS_4":[4,]}}', "JSON"),
    ('{"op":"reset","params":{"PERMITS_4":[44]}}', "PERMITS_4"),
    ('{"op":"reset","params":{"PERMITS_4":[-4]}}', "PERMITS_4"),
    ("{" + ",".join(f'"x{n}":1' for n in range(40)) + "}", "too many"),
    ('{"' + "x" * 50 + '":1}', "too long"),
    ("{" + " " * 5000 + "}", "too long"),
    ("[" * 4000, "JSON"),
    ("", "JSON"),
]


def test_lines_that_a_careless_reader_would_take_are_refused(watched: Path, tmp_path: Path) -> None:
    lines = [RESET, *[line + "\n" for line, _ in TRICKY], scan(), BYE]
    replies = talk([str(watched)], lines, tmp_path)
    for (line, cause), reply in zip(TRICKY, replies[1:], strict=False):
        assert list(reply) == ["error"], line
        assert cause in reply["error"], line
    assert replies[-2:] == [{"out": DARK}, {"ok": True}]


def test_a_scan_before_reset_is_refused(program: Path, tmp_path: Path) -> None:
    (reply,) = talk([str(program)], [scan()], tmp_path)
    assert "before reset" in reply["error"]


PIECES = r"""{ } " : , [ ] \ 0 -1 1.5 true null NaN
    "op": "scan" "reset" "params": "in": "LA": "MW03": "0FF0" "T_ON_ms": "dt_ms":"""
pieces = st.sampled_from([*PIECES.split(), " ", "\0", "\udcff", "x" * 60])


@pytest.mark.deep
@settings(max_examples=60, deadline=None, suppress_health_check=SHARED_FIXTURE)
@given(st.lists(st.lists(pieces, max_size=30).map("".join), min_size=1, max_size=40))
@example(['{"op":"reset"'])
def test_any_line_gets_one_answer_without_access_out_of_bounds(
    watched: Path, tmp_path: Path, lines: list[str]
) -> None:
    replies = talk([str(watched)], [RESET, *[line + "\n" for line in lines], scan(), BYE], tmp_path)
    assert len(replies) == len(lines) + 3
    assert all(list(reply) == ["error"] or reply == {"ok": True} for reply in replies[1:-2])
    assert replies[-2:] == [{"out": DARK}, {"ok": True}]


# ---------------------------------------------------------------------------------------------- the program

params = st.fixed_dictionaries(
    {
        "T_ON_ms": st.integers(1, 600),
        "T_SEQ_ms": st.integers(600, 1200),
        "T_DWELL_ms": st.integers(0, 300),
        "T_REM_ms": st.integers(301, 900),
        "T_SEQ_FROM": st.sampled_from(["LA", "ones"]),
        "ON_ERROR": st.sampled_from(["hold", "none"]),
        "SELECTIONS": st.sampled_from(["again", "once"]),
        "PERMITS_3": st.sampled_from([[3], [1, 3], [1, 2, 3], [0, 1, 2, 3]]),
    }
)
ways = st.lists(
    st.tuples(
        st.sampled_from(["key", "selection", "acknowledgment", "removal", "noise"]),
        st.integers(0, 4),
        st.integers(0, 4),
        st.sampled_from([0, 1, 49, 100, 299, 300]),
    ),
    max_size=12,
)


def scans_of(way: list[tuple[str, int, int, int]]) -> list[dict[str, Any]]:
    """Scans of a user who mostly does what the note has, with words of any mode, times near the limits."""
    found = [scan(300)]
    level = 0
    words = {"MW03": "0000", "MW07": "0000"}

    def add(dt_ms: int, on: str, LA: bool = True) -> None:
        found.append(scan(dt_ms, LA=LA, on=on, **words))

    for what, one, other, dt_ms in way:
        if what == "key":
            level = one
            for on in ("", " ".join(OUTPUTS), "", OUTPUTS[level], OUTPUTS[level]):
                add(dt_ms // 3, on)
        elif what == "selection":
            words = {"MW03": f"{SE[min(one, level)]:04X}", "MW07": "0000"}
        elif what == "acknowledgment":
            words["MW07"] = f"{SW[other]:04X}" if other == one else words["MW07"]
        elif what == "removal":
            words = {"MW03": "0000", "MW07": "0000"}
            add(dt_ms, "", LA=False)
            add(300, "", LA=False)
        else:
            words["MW07"] = f"{RE[one] ^ (1 << other):04X}" if one else "0000"
        add(dt_ms, OUTPUTS[level] if what != "removal" else "", LA=what != "removal")
        add(0, OUTPUTS[level] if what != "removal" else "", LA=what != "removal")
    return found


@pytest.mark.deep
@settings(max_examples=150, deadline=None, suppress_health_check=SHARED_FIXTURE)
@given(params, ways)
def test_with_any_times_it_does_what_the_reference_does(
    program: Path, tmp_path: Path, chosen: dict[str, Any], way: list[tuple[str, int, int, int]]
) -> None:
    scans = scans_of(way)
    replies = talk([str(program)], [RESET | {"params": chosen}, *scans], tmp_path)
    permitted = tuple(mode in chosen["PERMITS_3"] for mode in range(5))
    state = fplc.power_up(fplc.Params(**chosen | {"PERMITS_3": permitted}))
    for number, (entry, reply) in enumerate(zip(scans, replies[1:], strict=True), 1):
        words = {name: int(entry["in"][name], 16) for name in ("MW03", "MW07")}
        state, row = fplc.step(state, fplc.Inputs(entry["dt_ms"], **(entry["in"] | words)))
        wire = {name: getattr(row, name) for name in row.__slots__}
        assert reply == {"out": wire | {name: f"{wire[name]:04X}" for name in ("MW01", "MW05")}}, number


def test_the_longest_time_does_not_overflow(watched: Path, tmp_path: Path) -> None:
    longest = 4294967295
    lines = [
        RESET,
        scan(longest, LA=True),
        scan(longest, LA=True),
        scan(0),
        scan(LA=True),
        scan(longest, LA=True),
    ]
    replies = talk([str(watched)], lines, tmp_path)
    assert [reply["out"]["ERROR"] for reply in replies[1:]] == [False, False, False, False, True]


@pytest.mark.deep
def test_the_vectors_of_the_pack_are_what_the_reference_does() -> None:
    for name in ("brief", "tour", "words"):
        scans = 0
        for case in open_suite(vectors(name)).cases():
            own = {key: value for key, value in case.params.items() if not key.startswith("PERMITS_")}
            for key in set(case.params) - set(own):
                own[key] = tuple(mode in case.params[key] for mode in range(5))
            state = fplc.power_up(fplc.Params(**own))
            for one in case.scans:
                words = {key: int(one.inputs[key], 16) for key in ("MW03", "MW07")}
                state, row = fplc.step(state, fplc.Inputs(one.dt_ms, **(dict(one.inputs) | words)))
                wire = {key: getattr(row, key) for key in row.__slots__}
                assert wire | {key: f"{wire[key]:04X}" for key in ("MW01", "MW05")} == one.outputs, case.id
                scans += 1
        assert scans == open_suite(vectors(name)).scan_count > 20


def conform(program: Path) -> subprocess.CompletedProcess[str]:
    """Judge a program as a developer does, with the kit alone."""
    command = [sys.executable, "-m", "modeproof.kit", "conform", "fplc", "--quiet"]
    command += ["--vectors", str(vectors("brief")), "--adapter", f'"{program}"']
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)


@pytest.mark.deep
def test_it_conforms_and_one_edit_of_it_does_not(program: Path, tmp_path: Path) -> None:
    good = conform(program)
    assert (good.returncode, good.stdout.splitlines()[-1]) == (
        0,
        "CONFORMS(exact, brief; profile letter)",
    ), good.stdout
    (fault,) = [one for one in load_faults() if one.id == "figure-7-as-printed"]
    bad = conform(build(tmp_path / "bad", fault))
    assert (bad.returncode, bad.stdout.splitlines()[-1]) == (
        1,
        'DIFFERS: case fplc-db631db2e1d3, scan 103 (AcceptAcknowledgment): MW01 is "0000", expected "3333"; '
        'MW05 is "0000", expected "3333"; ERROR is true, expected false',
    ), bad.stdout
    assert "EKS-7-5" in bad.stdout and "E-01" in bad.stdout

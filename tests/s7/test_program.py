"""A program in a PLC over the S7 protocol: judged like any other; what cannot be judged is one line."""

from __future__ import annotations

import gzip
import importlib
import json
import os
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from snap7.connection import ISOTCPConnection

from examples.faulty.run import vectors
from modeproof.ground.places import root
from modeproof.kit.again import TEST_RIG
from modeproof.kit.errors import Unjudged
from modeproof.kit.relation import Options
from modeproof.kit.suite_judge import Plan, Verdict, run_suite
from modeproof.kit.vectors import EXACT, SETTLED, Suite, case_id, changes, open_suite
from modeproof.registers.load import load_interface
from modeproof.s7 import program as s7
from modeproof.s7.__main__ import main as adapter
from modeproof.suites.demands import declare_parameters
from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import RE, SE, SW
from tests.kit.clocks import Clock, set_clock
from tests.s7.server import FREE, MAP, STEPPED, Plc

ROOT = Path(__file__).resolve().parents[2]
SETTLING = 6
"""Scans after each change of inputs; no run of steps is longer."""
Event = tuple[int, dict[str, Any]]
NOTHING: dict[str, Any] = dict.fromkeys(("LA", "A", "B", "C", "D", "STR"), False) | {
    "MW03": "0000",
    "MW07": "0000",
}


def journey(wait_ms: int) -> list[Event]:
    """A key of level 1 comes, selects and confirms mode 1, takes back another selection, and goes."""
    ones = dict.fromkeys(("A", "B", "C", "D", "STR"), True)
    zeros = dict.fromkeys(("A", "B", "C", "D", "STR"), False)
    return [
        (0, {}),
        (wait_ms, {}),
        (0, {"LA": True}),
        (0, ones),
        (0, zeros),
        (0, {"B": True}),
        (0, {"MW03": f"{SE[1]:04X}"}),
        (0, {"MW07": f"{SW[1]:04X}"}),
        (0, {"MW03": "0000", "MW07": "0000"}),
        (wait_ms, {}),
        (0, {"MW03": f"{SE[0]:04X}"}),
        (0, {"MW03": "0000"}),
        (0, {"LA": False}),
    ]


def case_row(events: Sequence[Event], params: dict[str, Any]) -> dict[str, Any]:
    """A case in the form of a vector file, with what the reference answers."""
    own = {name: value for name, value in params.items() if not name.startswith("PERMITS_")}
    state, inputs, scans, before = fplc.power_up(fplc.Params(**own)), dict(NOTHING), [], {}
    for dt_ms, change in events:
        inputs |= change
        words = {name: int(inputs[name], 16) for name in ("MW03", "MW07")}
        for n in range(SETTLING):
            state, out = fplc.step(state, fplc.Inputs(0 if n else dt_ms, **(inputs | words)))
            wire = {name: getattr(out, name) for name in out.__slots__}
            wire |= {name: f"{wire[name]:04X}" for name in ("MW01", "MW05")}
            given = dict(inputs) if not scans else ({} if n else change)
            shown = {name: value for name, value in wire.items() if before.get(name) != value or not scans}
            before = wire
            row = {"dt_ms": 0 if n else dt_ms, "in": given, "out": shown, "step": 0, "to": 0, "column": 0}
            scans.append(row | ({"settling": True} if n + 1 < SETTLING else {}))
    going_in = [(one["dt_ms"], one["in"]) for one in scans]
    head = {
        "id": case_id("fplc", params, going_in),
        "clauses": ["EKS-2-29"],
        "basis": "document",
        "why": "a journey",
    }
    return head | {"timing": "coarse", "params": params, "graph": 0, "scans": scans}


def suite_of(folder: Path, *rows: dict[str, Any]) -> Suite:
    """A vector file of these cases; its header is that of the fast suite."""
    with gzip.open(vectors("brief"), "rt", encoding="utf-8") as stream:
        header = json.loads(stream.readline())
    interface = load_interface(root(), "mode_selection")
    modes = [int(mode) for mode in interface.constants["MODES"]]
    header |= {
        "suite": "journey",
        "relations": ["exact", "settled"],
        "parameters": declare_parameters(interface.devices["fplc"], modes),
        "cases": len(rows),
        "scans": sum(len(row["scans"]) for row in rows),
        "shrink": "prefix",
    }
    header.pop("demands", None)
    path = folder / "journey.jsonl"
    path.write_text("".join(json.dumps(row) + "\n" for row in (header, *rows)), encoding="utf-8")
    return open_suite(path)


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    """Two cases, the second with parameters of its own."""
    other = {
        "ON_ERROR": "none",
        "T_SEQ_FROM": "ones",
        "SELECTIONS": "once",
        "T_DWELL_ms": 70,
        "PERMITS_1": [1],
    }
    second = [*journey(70)[:7], (0, {"MW07": f"{RE[1]:04X}"})]
    return suite_of(tmp_path, case_row(journey(500), {}), case_row(second, other))


def judged(
    suite: Suite, plc: Plc, text: str, relation: str = SETTLED, timeout_s: float = 30.0, **options: int
) -> Verdict:
    path = suite.path.with_name("map.csv")
    path.write_text(text, encoding="utf-8")
    start = lambda: s7.connect(plc.address, path, suite, timeout_s)  # noqa: E731
    return run_suite(suite, start, plan=Plan(options=Options(relation=relation, **options)))


@pytest.fixture
def plc() -> Iterator[Plc]:
    with Plc() as running:
        yield running


# ------------------------------------------------------------------------------------------ verdicts


@pytest.mark.parametrize("relation", [SETTLED, EXACT])
def test_the_reference_in_a_plc_conforms(relation: str, suite: Suite, plc: Plc) -> None:
    verdict = judged(suite, plc, STEPPED, relation)
    assert (verdict.word, verdict.reason, verdict.cases) == ("CONFORMS", "", 2)
    assert verdict.relation == relation and plc.scans > 100


def test_words_lie_in_memory_high_byte_first(suite: Suite, plc: Plc, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with s7.connect(plc.address, path, suite) as program:
        program.reset({"T_ON_ms": 0x010203, "T_SEQ_ms": 0x010204, "ON_ERROR": "none"})
        assert plc.settings[:9] == bytes([0, 1, 2, 3, 0, 1, 2, 4, 0]) and plc.settings[16] == 7
        assert plc.settings[17:22] == bytes([0x01, 0x03, 0x07, 0x0F, 0x1F])
        plc.flags[0], plc.flags[15] = 0xAA, 0xBB
        program.scan(7, NOTHING | {"LA": True, "STR": True, "MW03": "0FF0", "MW07": "3C3D"})
        assert plc.inputs[0] == 0b100001 and plc.flags[3:5] == b"\x0f\xf0"
        assert plc.flags[7:9] == b"\x3c\x3d" and plc.control[0:4] == bytes([0, 0, 0, 7])
    assert (plc.flags[0], plc.flags[15]) == (0xAA, 0xBB)  # nothing beside the places was written


@pytest.mark.parametrize("relation", [SETTLED, EXACT])
def test_a_plc_that_takes_words_low_byte_first_differs(relation: str, tmp_path: Path) -> None:
    suite = suite_of(tmp_path, case_row(journey(500), {"SELECTIONS": "again"}))
    with Plc(order="<H") as plc:
        verdict = judged(suite, plc, STEPPED, relation)
    assert (verdict.word, verdict.status) == ("DIFFERS", 1)


def test_a_map_that_is_off_by_one_shows_a_difference(suite: Suite, plc: Plc) -> None:
    assert judged(suite, plc, STEPPED.replace("MW03,MW3", "MW03,MW9")).word == "DIFFERS"


def test_outputs_without_an_address_are_unobserved(suite: Suite, plc: Plc) -> None:
    verdict = judged(suite, plc, STEPPED.replace("ERROR,Q0.5", "ERROR,-"))
    assert (verdict.word, verdict.unobserved) == ("CONFORMS", ("ERROR",))


def test_a_free_plc_conforms_by_settled_and_exact_cannot_judge(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow = {"T_ON_ms": 60_000, "T_SEQ_ms": 60_000, "T_REM_ms": 60_000, "T_DWELL_ms": 900}
    suite = suite_of(tmp_path, case_row(journey(6000)[:9], slow))
    with Plc(cycle_ms=1) as plc:
        set_clock(monkeypatch, plc.clock, "modeproof.s7.program", "modeproof.kit.relation")
        verdict = judged(suite, plc, FREE)
        assert (verdict.word, verdict.reason) == ("CONFORMS", "")
        assert plc.scans > 6000, "it ran while it was waited for"
        exact = judged(suite, plc, FREE, EXACT)
    assert (exact.word, exact.status) == ("UNJUDGED", 2) and "exact" in exact.reason


# ------------------------------------------------------------------------------------------ cannot be judged


def test_nobody_there_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    verdict = run_suite(suite, lambda: s7.connect(f"127.0.0.1:{port}", path, suite))
    assert (verdict.word, verdict.status) == ("UNJUDGED", 2)
    assert f"no S7 server at 127.0.0.1:{port}" in verdict.reason and "\n" not in verdict.reason


@pytest.mark.parametrize("says", ["b'HTTP/1.1 400 Bad Request' + b' ' * 80", "b'\\3\\0\\0\\7'", "b''"])
def test_somebody_who_speaks_something_else_or_nothing_is_unjudged(
    says: str, suite: Suite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ISOTCPConnection.connect, "__defaults__", (0.3,))  # else 5 s, whatever one asks for
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    code = "import socket, time; s = socket.create_server(('127.0.0.1', 0))\n"
    code += f"print(s.getsockname()[1], flush=True)\nc, _ = s.accept(); c.sendall({says}); time.sleep(600)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        address = f"127.0.0.1:{int(other.stdout.readline())}"
        try:
            verdict = run_suite(suite, lambda: s7.connect(address, path, suite, 0.3))
            assert other.poll() is None, "it was waited for until it ended"
        finally:
            other.kill()
    assert verdict.word == "UNJUDGED" and address in verdict.reason


@pytest.mark.parametrize("most", [0, 1, 20])
def test_a_plc_dying_midway_is_unjudged_with_case_and_scan(most: int, suite: Suite) -> None:
    with Plc(most=most) as plc:
        verdict = judged(suite, plc, STEPPED, EXACT)
    assert (verdict.word, verdict.status) == ("UNJUDGED", 2)
    assert "scan" in verdict.reason and "S7 server 127.0.0.1" in verdict.reason and "\n" not in verdict.reason


def test_without_a_harness_a_plc_is_unjudged_in_time(suite: Suite, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(look_s=1.0)
    set_clock(monkeypatch, clock, "modeproof.s7.program")
    with Plc(dead=True) as plc:
        verdict = judged(suite, plc, STEPPED, timeout_s=30.0)
    assert verdict.word == "UNJUDGED" and "@reset was not cleared within 30 s" in verdict.reason
    assert 30 < clock.now_s < 40


def test_a_place_that_the_plc_does_not_have_is_unjudged(suite: Suite, plc: Plc) -> None:
    for old, new in (("MW03,MW3", "MW03,MW900"), ("T_ON_ms,DB1.DBD0", "T_ON_ms,DB7.DBD0"), ("Q0.5", "Q77.5")):
        verdict = judged(suite, plc, STEPPED.replace(old, new))
        assert verdict.word == "UNJUDGED" and "S7 server" in verdict.reason, new


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (MAP, "@cycle"),
        (STEPPED.replace("@magic,DB2.DBD12,DINT\n", ""), "no @magic, so nothing tells a test rig"),
        (MAP.replace("@reset,DB2.DBX10.0,BOOL\n", "@cycle,DB2.DBW8,WORD\n"), "no @reset"),
        (STEPPED.replace("@done,DB2.DBW6,WORD\n", ""), "@done"),
        (STEPPED.replace("T_DWELL_ms,DB1.DBD12,TIME\n", ""), "T_DWELL_ms is 70"),
        (STEPPED.replace("MW07,MW7", "MW07,MW4"), "overlap"),
    ],
)
def test_a_map_that_does_not_do_is_unjudged(text: str, said: str, suite: Suite, plc: Plc) -> None:
    plc.settings[12:16] = (500).to_bytes(4, "big")  # a dwell time that nobody sets is the program's own
    verdict = judged(suite, plc, text)
    assert (verdict.word, verdict.status) == ("UNJUDGED", 2) and said in verdict.reason


# --------------------------------------------------------------------------------------- no test rig


def memory_of(plc: Plc) -> list[bytes]:
    return [bytes(one) for one in (plc.inputs, plc.outputs, plc.flags, plc.settings, plc.control)]


@pytest.mark.parametrize("magic", [b"\0\0\0\0", b"RIG?", b"\xff\xff\xff\xff"])
def test_nothing_is_written_to_another_plc(magic: bytes, suite: Suite) -> None:
    with Plc(magic=magic) as plc:
        before = memory_of(plc)
        verdict = judged(suite, plc, STEPPED)
        assert (verdict.word, verdict.status, plc.scans) == ("UNJUDGED", 2, 0)
        assert f"@magic DB2.DBD12 holds 16#{magic.hex().upper()} and not 16#52494721" in verdict.reason
        assert "nothing was written" in verdict.reason and "\n" not in verdict.reason
        assert memory_of(plc) == before


def test_a_plc_that_stops_being_a_rig_is_left(suite: Suite, plc: Plc, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with s7.connect(plc.address, path, suite) as program:
        plc.control[12:16] = b"LIVE"
        before = memory_of(plc)
        with pytest.raises(Unjudged, match="this PLC is no test rig"):
            program.reset({})
    assert memory_of(plc) == before


def test_what_was_written_is_put_back_at_the_end(suite: Suite, plc: Plc, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    plc.settings[:] = bytes(range(32))
    plc.inputs[0], plc.control[10], plc.flags[3:5], plc.control[0:4] = (
        0b11000001,
        0b10100,
        b"\x12\x34",
        b"abcd",
    )
    kept = bytes(plc.settings), bytes([0b11000001]), bytes(plc.control[0:4]), b"\x12\x34"
    with s7.connect(plc.address, path, suite) as program:
        program.reset({})
        assert bytes(plc.settings) != kept[0]
        plc.inputs[0] |= 0b11000000  # the power-up of this program has cleared them
        program.scan(7, NOTHING | {"A": True, "MW03": "0FF0"})
        assert plc.inputs[0] == 0b11000010, "the bits without a name are as they were"
    assert (bytes(plc.settings), bytes(plc.inputs), bytes(plc.control[0:4]), bytes(plc.flags[3:5])) == kept
    assert plc.scans == 1, "to put it back starts no scan"


def test_a_case_is_left_when_the_rig_ends(
    suite: Suite, plc: Plc, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with s7.connect(plc.address, path, suite) as program:
        program.reset({})
        program.scan(7, NOTHING | {"A": True})
        plc.control[12:16] = b"LIVE"
        before = memory_of(plc)
        with pytest.raises(Unjudged, match="this PLC is no test rig; nothing more is written"):
            program.scan(7, NOTHING)
    assert memory_of(plc) == before
    assert "what was written is not put back: " in capsys.readouterr().err


def test_a_living_bit_in_a_mapped_byte_is_left(suite: Suite, plc: Plc, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with s7.connect(plc.address, path, suite) as program:
        program.reset({})
        program.scan(7, NOTHING | {"A": True})
        plc.inputs[0] |= 0b10000000
        with pytest.raises(Unjudged, match=r"a bit of DB3\.DBB0 that the map does not name has changed"):
            program.scan(7, NOTHING)
        assert plc.inputs[0] == 0b10000010
    assert plc.inputs[0] == 0b10000000, "put back, but for the bit that is somebody else's"


def test_without_the_option_for_rigs_nobody_is_called(
    suite: Suite, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["fplc", "--host", "127.0.0.1:1", "--map", "m.csv", "--vectors", str(suite.path)]
    assert adapter(arguments) == 2
    assert f"{TEST_RIG} is missing" in capsys.readouterr().err
    done = conform(suite, tmp_path / "m.csv", "127.0.0.1:1", without=TEST_RIG)
    assert done.returncode == 2 and f"{TEST_RIG} is missing" in done.stderr + done.stdout


def test_without_python_snap7_one_line_says_what_to_install(
    suite: Suite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "snap7", None)
    path = tmp_path / "map.csv"
    path.write_text(STEPPED, encoding="utf-8")
    with pytest.raises(Unjudged, match="needs python-snap7: pip install"):
        s7.connect("127.0.0.1", path, suite)
    assert importlib.import_module("modeproof.s7.program") is s7


# -------------------------------------------------------------------------------------- as a developer does


def conform(
    suite: Suite, map_file: Path, address: str, *options: str, without: str = ""
) -> subprocess.CompletedProcess[str]:
    command = [
        sys.executable,
        "-m",
        "modeproof.kit",
        "conform",
        "fplc",
        "--s7",
        address,
        "--map",
        str(map_file),
    ]
    command += ["--vectors", str(suite.path), "--quiet", TEST_RIG, *options]
    command = [word for word in command if word != without]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False, env={**os.environ})


def test_the_command_judges_the_statement_list_in_a_simulated_plc(suite: Suite) -> None:
    awl = ROOT / "examples/awl"
    with subprocess.Popen(
        [sys.executable, str(awl / "server.py"), "fplc"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as plc:
        assert plc.stdout is not None
        address = plc.stdout.readline().split()[-1]
        for relation in (SETTLED, EXACT):
            done = conform(suite, awl / "fplc.map.csv", address, "--relation", relation)
            assert done.returncode == 0, done.stdout + done.stderr
            assert done.stdout.splitlines()[-1].startswith(f"CONFORMS({relation}, journey, not published;")
        wrong = suite.path.with_name("wrong.csv")
        text = (awl / "fplc.map.csv").read_text(encoding="utf-8").replace("MW07,MW7", "MW07,MW11")
        wrong.write_text(text, encoding="utf-8")
        assert conform(suite, wrong, address, "--relation", SETTLED).returncode == 1
        plc.kill()
    gone = conform(suite, awl / "fplc.map.csv", address, "--relation", SETTLED)
    assert gone.returncode == 2
    said = (gone.stdout + gone.stderr).splitlines()
    assert len([line for line in said if "no S7 server" in line]) == 1


def test_fields_of_settings_are_packed_as_the_plc_unpacks_them() -> None:
    assert struct.calcsize(">iiii6B") == 22 and changes([]) == []

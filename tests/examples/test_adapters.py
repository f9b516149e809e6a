"""The two Python adapters speak protocol 1 line by line, refuse what is wrong in one line, and go on."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import RE, SE
from tests.examples import protocol
from tests.examples.protocol import BYE, DARK, HELLO, REFUSED, RESET, scan, wire

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/adapters/python_adapter.py"
GENERIC = ROOT / "examples/adapters/refimpl_adapter.py"
INTERFACE = tomllib.loads((ROOT / "spec/mode_selection/interface.toml").read_text(encoding="utf-8"))

BOTH = pytest.mark.parametrize("adapter", [EXAMPLE, GENERIC], ids=["example", "generic"])


def talk(adapter: Path, lines: list[Any], cwd: Path, target: str = "fplc") -> list[dict[str, Any]]:
    """Run one of the two on these lines."""
    return protocol.talk([sys.executable, str(adapter), target], lines, cwd)


@BOTH
def test_the_session_of_the_protocol_page_runs_from_any_directory(adapter: Path, tmp_path: Path) -> None:
    session = [HELLO, RESET | {"params": {"T_SEQ_ms": 1000, "T_REM_ms": 1000}}, scan(on="B", LA=True), BYE]
    hello, reset, out, bye = talk(adapter, session, tmp_path)
    assert hello["ok"] is True
    assert (hello["time"], hello["relations"], hello["unobserved"]) == ("virtual", ["exact"], [])
    assert hello["max_latency_scans"] == 0
    assert (reset, out, bye) == ({"ok": True}, {"out": DARK}, {"ok": True})


@BOTH
def test_an_insertion_publishes_the_level_as_four_hex_digits(adapter: Path, tmp_path: Path) -> None:
    scans = [
        scan(500),
        scan(LA=True),
        scan(LA=True, on="A B C D STR"),
        scan(LA=True),
        scan(LA=True, on="B"),
        scan(LA=True, on="B"),
        scan(LA=True, on="B", MW03="0FF0"),
        scan(LA=True, on="B", MW03="0FF0"),
        scan(LA=True, on="B", MW03="0FF0"),
    ]
    out = [reply["out"] for reply in talk(adapter, [HELLO, RESET, *scans], tmp_path)[2:]]
    assert [row["MW01"] for row in out] == ["0000"] * 5 + [f"{RE[1]:04X}"] * 4
    assert [row["MW05"] for row in out] == ["0000"] * 8 + ["3333"]


@BOTH
def test_the_list_form_answers_like_single_scans(adapter: Path, tmp_path: Path) -> None:
    scans = [scan(500), scan(LA=True), scan(LA=True, on="A B"), scan(dt_ms=1000, on="C D")]
    singles = talk(adapter, [RESET, *scans], tmp_path)[1:]
    entries = [{"dt_ms": entry["dt_ms"], "in": entry["in"]} for entry in scans]
    listed = talk(adapter, [RESET, {"op": "scans", "list": entries}], tmp_path)[1]
    assert listed == {"list": singles}


@BOTH
def test_reset_goes_back_to_power_up_and_takes_the_defaults(adapter: Path, tmp_path: Path) -> None:
    into_error = scan(LA=False, on="A B")
    replies = talk(adapter, [RESET, into_error, RESET, scan()], tmp_path)
    assert [reply.get("out", {}).get("ERROR") for reply in replies] == [None, True, None, False]


@BOTH
def test_every_declared_parameter_is_taken_and_changes_the_behaviour(adapter: Path, tmp_path: Path) -> None:
    to_selection = [
        scan(500),
        scan(LA=True),
        scan(LA=True, on="A B C D STR"),
        scan(LA=True),
        scan(LA=True, on="C"),
        scan(LA=True, on="C"),
        scan(LA=True, on="C", MW03=f"{SE[1]:04X}"),
        scan(LA=True, on="C", MW03=f"{SE[1]:04X}"),
    ]
    sequence = [scan(500), scan(LA=True), scan(900, LA=True, on="A B C D STR"), scan(900, LA=True)]

    def ends_in_error(scans: list[dict[str, Any]], **params: Any) -> bool:
        replies = talk(adapter, [RESET | {"params": params}, *scans], tmp_path)
        assert replies[0] == {"ok": True}
        error = replies[-1]["out"]["ERROR"]
        assert isinstance(error, bool)
        return error

    declared = {name: own["default"] for name, own in INTERFACE["devices"]["fplc"]["parameters"].items()}
    assert not ends_in_error(to_selection, **declared)
    assert ends_in_error(to_selection, **declared | {"PERMITS_2": [0, 2]})
    assert ends_in_error(sequence, **declared | {"T_SEQ_FROM": "LA"})
    assert not ends_in_error(sequence, **declared)


@BOTH
def test_a_wrong_line_gets_one_line_back_and_changes_nothing(adapter: Path, tmp_path: Path) -> None:
    lines: list[Any] = [RESET, scan(499)]
    for line, _ in REFUSED:
        lines += [line]
    replies = talk(adapter, [*lines, scan(1, LA=False), scan(1, LA=True, on="A B"), BYE], tmp_path)
    for (line, cause), reply in zip(REFUSED, replies[2:], strict=False):
        assert list(reply) == ["error"], line
        assert cause in json.dumps(reply), line
    assert replies[-3:] == [{"out": DARK}, {"out": DARK}, {"ok": True}]


@BOTH
def test_a_scan_before_reset_is_refused(adapter: Path, tmp_path: Path) -> None:
    replies = talk(adapter, [HELLO, scan(), {"op": "scans", "list": [{"dt_ms": 1, "in": wire()}]}], tmp_path)
    assert all("before reset" in reply["error"] for reply in replies[1:])


@BOTH
def test_one_wrong_scan_has_the_whole_list_refused(adapter: Path, tmp_path: Path) -> None:
    good = {"dt_ms": 10, "in": wire(on="A B")}
    replies = talk(
        adapter, [RESET, {"op": "scans", "list": [good, {"dt_ms": 10, "in": {}}]}, scan()], tmp_path
    )
    assert "error" in replies[1]
    assert replies[2] == {"out": DARK}


@BOTH
def test_the_adapter_ends_on_bye_and_answers_nothing_after_it(adapter: Path, tmp_path: Path) -> None:
    assert talk(adapter, [BYE, RESET, RESET], tmp_path) == [{"ok": True}]


@pytest.mark.parametrize(
    "target", [name for name, entry in INTERFACE["devices"].items() if entry["published"]]
)
def test_published_targets_are_served_with_the_names_of_the_register(target: str, tmp_path: Path) -> None:
    device = INTERFACE["devices"][target]
    values = {"bool": False, "word": "0000", "mode": None, "text": None}
    entry = {
        "op": "scan",
        "dt_ms": 0,
        "in": {name: values[s["type"]] for name, s in device["inputs"].items()},
    }
    hello, _, reply = talk(
        GENERIC, [{"op": "hello", "protocol": 1, "target": target}, RESET, entry], tmp_path, target
    )
    assert hello["ok"] is True
    assert list(reply["out"]) == list(device["outputs"])
    assert ("layout" in hello) == (target == "hmi")


def test_the_panel_speaks_the_wire_forms_of_modes_and_touches(tmp_path: Path) -> None:
    def panel(RA: str, touch: object, active: object = None) -> dict[str, Any]:
        inputs = {"ReadAuthorization": RA, "CheckMSO": "0000", "ActiveMSO": active, "touch": touch}
        return {"op": "scan", "dt_ms": 10, "in": inputs}

    _, select, waiting, *refused = talk(
        GENERIC,
        [
            RESET,
            panel("3333", None),
            panel("3333", "select:2", 4),
            panel("3333", "", 4),
            panel("3333", None, -1),
            panel("3333", "select:5"),
            panel("3333", None, 5),
        ],
        tmp_path,
        "hmi",
    )
    assert select["out"] | {"SelectMSO": "0000"} == {
        "SelectMSO": "0000",
        "SwitchMSO": "0000",
        "screen": "select",
        "enabled": [0, 1, 2],
        "shown": None,
        "active": None,
    }
    assert (waiting["out"]["SelectMSO"], waiting["out"]["active"]) == (f"{SE[2]:04X}", 4)
    assert [reply["error"].split(":")[1].strip() for reply in refused] == [
        "touch",
        "ActiveMSO",
        "touch",
        "ActiveMSO",
    ]


def test_the_eks_needs_its_checksum_and_takes_a_word(tmp_path: Path) -> None:
    reader = {
        "inserted": True,
        "operating_state": 6,
        "authorization_level": "3C3C",
        "access_code": "0001",
        "KEYCRC": "BEEF",
        "KeyID": 7,
        "registers_zero": True,
    }
    entry = {"op": "scan", "dt_ms": 200, "in": reader}
    lines = [RESET, RESET | {"params": {"checksum": "BEEF"}}, *[entry] * 8]
    refused, accepted, *scans = talk(GENERIC, lines, tmp_path, "eks")
    assert "checksum" in refused["error"]
    assert accepted == {"ok": True}
    assert scans[-1]["out"] == {"LA": True, "A": False, "B": False, "C": False, "D": False, "STR": True}


def test_an_unknown_target_is_named_before_the_first_line() -> None:
    for arguments in (["hm"], [], ["hmi", "plc"]):
        done = subprocess.run(
            [sys.executable, str(GENERIC), *arguments], capture_output=True, text=True, timeout=600
        )
        assert done.returncode != 0
        assert done.stdout == ""
        assert len(done.stderr.splitlines()) == 1


def test_both_adapters_give_what_the_implementation_gives(tmp_path: Path) -> None:
    entries = [
        scan(dt, LA=LA, on=on)
        for dt in (0, 500)
        for LA in (False, True)
        for on in ("", "A", "A B", "A B C D STR")
    ]
    replies = [talk(adapter, [RESET, *entries], tmp_path)[1:] for adapter in (EXAMPLE, GENERIC)]
    state, errors = fplc.power_up(fplc.Params()), []
    for entry in entries:
        words = {name: int(entry["in"][name], 16) for name in ("MW03", "MW07")}
        state, row = fplc.step(state, fplc.Inputs(entry["dt_ms"], **(entry["in"] | words)))
        errors.append(row.ERROR)
    assert replies[0] == replies[1]
    assert [reply["out"]["ERROR"] for reply in replies[0]] == errors

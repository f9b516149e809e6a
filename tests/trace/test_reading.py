"""What cannot be right in a log is refused in one line that names the file, the line and the column."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.trace.lines import read_lines
from modeproof.trace.log import LONGEST_MS, without_codes
from modeproof.trace.table import TableForm, read_table
from modeproof.trace.targets import find_target, targets_of
from tests.trace.judging import LOGS, example, record

FPLC = find_target(root(), "fplc")
SYSTEM = find_target(root(), "key_flows")
SCAN: dict[str, Any] = {
    "dt_ms": 10,
    "in": {"LA": False, "MW03": "0000"},
    "out": {"MW01": "0FF0", "ERROR": True},
}


def lines(folder: Path, *rows: Any, target: Any = FPLC) -> Any:
    path = folder / "log.jsonl"
    path.write_text("".join((row if isinstance(row, str) else json.dumps(row)) + "\n" for row in rows))
    return read_lines(path, target)


def table(folder: Path, text: str, form: TableForm | None = None) -> Any:
    path = folder / "log.csv"
    path.write_text(text)
    return read_table(path, FPLC, None, form)


def changed(**fields: Any) -> dict[str, Any]:
    return {**SCAN, **fields}


REFUSED_LINES = {
    "a negative time": (
        changed(dt_ms=-1),
        "line 2, dt_ms: a time of -1 ms since the scan before is impossible",
    ),
    "no number": (changed(dt_ms="10"), "line 2, dt_ms: '10' is no time in ms"),
    "a half ms": (changed(dt_ms=0.5), "line 2, dt_ms: 0.5 is no whole number of ms; round the times before"),
    "true as time": (changed(dt_ms=True), "line 2, dt_ms: True is no time in ms"),
    "NaN": ('{"dt_ms":NaN,"in":{},"out":{}}', "line 2: NaN is no number that a log may hold"),
    "infinity": ('{"dt_ms":1e999,"in":{},"out":{}}', "line 2, dt_ms: inf is no time in ms"),
    "an unknown input": (
        changed(**{"in": {"MW3": "0000"}}),
        "line 2, in: MW3: fplc has no input 'MW3'; did you mean 'MW03'?",
    ),
    "an output as input": (changed(**{"in": {"MW01": "0000"}}), "line 2, in: MW01: fplc has no input 'MW01'"),
    "an unknown key": (changed(inn={}), "line 2: unknown key 'inn'; did you mean 'in'?"),
    "a number for a boolean": (changed(**{"in": {"LA": 1}}), "line 2, in: LA: 1 is no value of type bool"),
    "a number for a word": (changed(**{"in": {"MW03": 0}}), "line 2, in: MW03: 0 is no value of type word"),
    "five digits": (changed(out={"MW01": "00000"}), "line 2, out: MW01: '00000' is no value of type word"),
    "a list": ("[1]", "line 2: an object was expected"),
    "no object of inputs": (changed(**{"in": []}), "line 2, in: an object was expected"),
    "a key twice": ('{"dt_ms":1,"dt_ms":2,"in":{}}', "line 2: 'dt_ms' is there twice"),
    "no JSON": ('{"dt_ms":1,,"in":{}}\n' + json.dumps(SCAN), "line 2, column 12: no JSON"),
    "another device": (
        changed(device="plc"),
        "line 2, device: 'plc' is no device of fplc; did you mean 'fplc'? allowed: fplc",
    ),
}


@pytest.mark.parametrize("name", REFUSED_LINES)
def test_a_line_that_cannot_be_right_is_refused(name: str, tmp_path: Path) -> None:
    row, wanted = REFUSED_LINES[name]
    with pytest.raises(Unjudged) as refused:
        lines(tmp_path, SCAN, row)
    assert refused.value.message.startswith(f"{tmp_path}/log.jsonl: {wanted}")
    assert "\n" not in refused.value.message


def test_a_last_line_that_was_cut_off_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=r"fplc_cut.jsonl: line 53, column \d+: the last line is cut off"):
        example("fplc", "fplc_cut.jsonl")
    text = (LOGS / "fplc_good.csv").read_text()
    with pytest.raises(Unjudged, match=r"line 59: the last line is cut off"):
        table(tmp_path, text[:-3])
    with pytest.raises(Unjudged, match=r"line 59: 9 cells where 17 were expected; the line is cut off"):
        table(tmp_path, text[: text.rindex(";", 0, -20)].rstrip("\n").rpartition(";")[0] + "\n")


@pytest.mark.parametrize("text", ["", "\n \n", '{"target":"fplc"}\n'])
def test_a_log_without_a_scan_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "log.jsonl").write_text(text)
    with pytest.raises(Unjudged, match=r"log.jsonl: no scan in it"):
        read_lines(tmp_path / "log.jsonl", FPLC)
    with pytest.raises(Unjudged, match=r"log.csv: no scan in it"):
        table(tmp_path, "t_ms;LA\n")


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "log.jsonl").write_bytes(b'{"dt_ms":1,"in":{}}\n\xff\xfe\n')
    with pytest.raises(Unjudged, match=r"log.jsonl: line 2: no UTF-8 text"):
        read_lines(tmp_path / "log.jsonl", FPLC)
    with pytest.raises(Unjudged, match=r"nothing: No such file"):
        read_lines(tmp_path / "nothing", FPLC)


def test_time_that_goes_back_is_refused_and_differences_are_taken(tmp_path: Path) -> None:
    rows = [{**SCAN, "t_ms": at} for at in (100, 100, 130, 10**12)]
    for row in rows:
        del row["dt_ms"]
    assert [row.dt_ms for row in lines(tmp_path, *rows).rows] == [None, 0, 30, LONGEST_MS]
    with pytest.raises(Unjudged, match=r"line 5, t_ms: time goes back, from 1000000000000 ms to 99 ms"):
        lines(tmp_path, *rows, {**rows[0], "t_ms": 99})


def test_parameters_come_from_the_header_and_the_rest_is_default(tmp_path: Path) -> None:
    log = lines(tmp_path, {"params": {"T_ON_ms": 7, "PERMITS_3": [1, 2, 3]}}, SCAN)
    assert log.params["fplc"]["T_ON_ms"] == 7 and log.params["fplc"]["PERMITS_3"] == [1, 2, 3]
    assert log.params["fplc"]["T_SEQ_ms"] == FPLC.only.device.parameters["T_SEQ_ms"].default
    for header, wanted in (
        (
            {"params": {"T_OM_ms": 7}},
            "line 1, params: fplc has no parameter 'T_OM_ms'; did you mean 'T_ON_ms'",
        ),
        ({"params": {"T_ON_ms": 0}}, "line 1, params: fplc: T_ON_ms: 0 is no value of type ms"),
        ({"params": []}, "line 1, params: a table of parameters was expected"),
        ({"target": "plc"}, "line 1, target: this log is of 'plc', not of fplc"),
        ({"parms": {}}, "line 1: unknown key 'parms'; did you mean 'params'"),
    ):
        with pytest.raises(Unjudged, match=wanted):
            lines(tmp_path, header, SCAN)


def test_a_system_needs_each_lines_device_and_the_checksum(tmp_path: Path) -> None:
    params = {"params": {"eks": {"checksum": "1234"}}}
    assert lines(tmp_path, params, {**SCAN, "device": "fplc"}, target=SYSTEM).rows[0].device == "fplc"
    for rows, wanted in (
        ([params, SCAN], "line 2: `device` is missing; a line is of one of eks, fplc, plc, hmi"),
        ([{**SCAN, "device": "fplc"}], "parameter checksum of eks is missing; .*--param eks.checksum=VALUE"),
        ([{"params": {"T_ON_ms": 1}}, SCAN], "line 1, params: 'T_ON_ms' is no device with parameters"),
    ):
        with pytest.raises(Unjudged, match=wanted):
            lines(tmp_path, *rows, target=SYSTEM)


# --------------------------------------------------------------------------------------------------- tables


def test_a_table_and_lines_of_one_log_say_the_same() -> None:
    by_lines, by_table = (example("fplc", f"fplc_good.{kind}") for kind in ("jsonl", "csv"))
    assert [(row.inputs, row.outputs) for row in by_lines.rows] == [
        (row.inputs, row.outputs) for row in by_table.rows
    ]
    assert [row.dt_ms for row in by_lines.rows][1:] == [row.dt_ms for row in by_table.rows][1:]
    assert by_lines.params == by_table.params


@pytest.mark.parametrize(
    ("text", "form"),
    [
        ("t_ms;LA;MW3\n0;1;16#0FF0\n", TableForm()),
        ("t_s,LA,MW03\n0,TRUE,0x0ff0\n", TableForm()),
        ("t_us\tFI1\tMW3\n0\ttrue\tff0\n", TableForm()),
        ("t_ms;LA;MW3\n0;1;W#16#FF0\n", TableForm()),
        ("t_ms;LA;MW3\n0;1;4080\n", TableForm(decimal_words=True)),
        ("# words = decimal\n# a remark\nt_ms;LA;MW3\n0;1;4080\n", TableForm()),
        (
            "clock|LA|MW3|other\n0|1|0FF0|x\n",
            TableForm(separator="|", time="clock", ignore=frozenset({"other"})),
        ),
        ('"t_ms";"LA";"MW3"\r\n"0";"1";"0FF0"\r\n', TableForm()),
    ],
)
def test_the_dialects_of_tables_are_understood(text: str, form: TableForm, tmp_path: Path) -> None:
    (row,) = table(tmp_path, text, form).rows
    assert (row.inputs, row.outputs, row.dt_ms) == ({"LA": True, "MW03": 0x0FF0}, {}, None)


def test_an_empty_cell_was_not_observed(tmp_path: Path) -> None:
    first, second = table(tmp_path, "dt_ms;LA;MW3\n5;;0FF0\n6;0;\n").rows
    assert (first.inputs, second.inputs) == ({"MW03": 0x0FF0}, {"LA": False})
    assert (first.dt_ms, second.dt_ms) == (5, 6)


REFUSED_TABLES = {
    "an unknown column": (
        "t_ms;LB\n",
        "line 1, column 2: 'LB' is no signal of fplc; did you mean 'B'? allowed: LA",
    ),
    "a column twice": ("t_ms;LA;LA\n", "line 1, column 3: 'LA' is there twice"),
    "name and tag of one signal": (
        "t_ms;LA;FI1\n0;0;1\n",
        "line 1: columns LA and FI1 are one signal of fplc; --ignore one",
    ),
    "a parameter with two values": (
        "# T_ON_ms = 5\n# T_ON_ms = 6\nt_ms;LA\n",
        "line 2: T_ON_ms is 5 above and 6 here",
    ),
    "a column without name": ("t_ms;;LA\n", "line 1, column 2: a column has no name"),
    "two times": ("t_ms;dt_ms;LA\n", "line 1: two columns of time: t_ms and dt_ms"),
    "no boolean": ("t_ms;LA\n0;2\n", "line 2, LA: '2' is no value of type bool"),
    "no word": ("t_ms;MW3\n0;16#0FG0\n", "line 2, MW3: '16#0FG0' is no value of type word"),
    "too many cells": ("t_ms;LA\n0;1;1\n", "line 2: 3 cells where 2 were expected"),
    "no time": ("t_ms;LA\nnoon;1\n", "line 2, t_ms: 'noon' is no time"),
    "NaN": ("t_ms;LA\nNaN;1\n", "line 2, t_ms: 'NaN' is no time"),
    "beyond all bounds": ("t_ms;LA\n1e999999999999;1\n", "line 2, t_ms: '1e999999999999' is no time"),
    "a missing time": ("t_ms;LA\n;1\n", "line 2, t_ms: the time is missing"),
    "time going back": ("t_s;LA\n2;1\n1.5;1\n", "line 3, t_ms: time goes back, from 2000 ms to 1500 ms"),
    "part of a ms": ("t_us;LA\n1500;1\n", "line 2, t_ms: 1.5 is no whole number of ms"),
    "an open quote": ('t_ms;LA\n"0;1\n', "line 2: no row of a table"),
    "an unknown parameter": ("# T_ONN_ms = 5\nt_ms;LA\n", "line 1: fplc has no parameter 'T_ONN_ms'"),
    "words of no kind": ("# words = octal\nt_ms;LA\n", "line 1: words are hex or decimal, not 'octal'"),
}


@pytest.mark.parametrize("name", REFUSED_TABLES)
def test_a_table_that_cannot_be_right_is_refused(name: str, tmp_path: Path) -> None:
    text, wanted = REFUSED_TABLES[name]
    with pytest.raises(Unjudged) as refused:
        table(tmp_path, text)
    assert refused.value.message.startswith(f"{tmp_path}/log.csv: {wanted}")


def test_the_recorder_writes_what_the_devices_read_and_wrote() -> None:
    recorder = record.one_switchover()
    assert len(recorder.lines) == 364 and len(recorder.of("fplc")) == 52
    assert {line["device"] for line in recorder.lines} == {"eks", "fplc", "plc", "hmi"}
    assert any(line["out"]["MSO_1"] for line in recorder.of("fplc"))


def test_an_output_without_documented_values_is_omitted_and_named(tmp_path: Path) -> None:
    log = lines(tmp_path, '{"target":"fplc"}', SCAN)
    assert without_codes(log, FPLC) is log
    part = FPLC.parts["fplc"]
    outputs = {**part.device.outputs, "MW01": structs.replace(part.device.outputs["MW01"], project=True)}
    target = replace(
        FPLC, parts={"fplc": replace(part, device=structs.replace(part.device, outputs=outputs))}
    )
    left = without_codes(log, target)
    assert left.not_compared == ("MW01",) and [dict(row.outputs) for row in left.rows] == [{"ERROR": True}]
    assert "MW01" in log.observed("fplc") and "MW01" not in left.observed("fplc")


COPIES = 'copies = { one = "33CC", other = "0001", compares = ["ReadAuthorization", "MW01"] }\n'


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            '["ReadAuthorization", "MW01"]',
            '["MW01", "MW01"]',
            "plc: copies: plc has no output that it remembers",
        ),
        ('["ReadAuthorization", "MW01"]', '["MW03", "MW03"]', "plc: copies: plc has no input 'MW03'"),
        ("[target.hmi]\n", f"[target.hmi]\n{COPIES}", "hmi: copies: hmi has no output that it remembers"),
        (
            "[target.key_flows]\n",
            f"[target.key_flows]\n{COPIES}",
            "key_flows: copies: belongs to a target of one",
        ),
    ],
)
def test_a_comparison_that_no_device_makes_is_refused(
    tmp_path: Path, old: str, new: str, expected: str
) -> None:
    shutil.copytree(root() / "spec" / "mode_selection", tmp_path / "spec" / "mode_selection")
    path = tmp_path / "spec" / "mode_selection" / "replay.toml"
    text = path.read_text()
    assert COPIES in text and old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(Unjudged, match=rf"target {expected}"):
        targets_of(tmp_path, "mode_selection")

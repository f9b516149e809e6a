"""The adapter that serves any function block in C, with a toy block; and every block of examples/c."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from examples.adapters.refimpl_adapter import Target, find_target
from examples.faulty.run import FOLDER, block, programs
from tests.examples.protocol import BYE, RESET, talk

BLOCKS = sorted(path.name.removesuffix("_adapter.c") for path in FOLDER.glob("*_adapter.c"))
WATCHED = "-O1 -fsanitize=address,undefined -fno-sanitize-recover=all"

LAMP = """
#include "block.h"
#include "cyclic_block.h"
static struct { bool on, before; uint32_t lit_ms; uint16_t code; uint8_t colour; } lamp;
static struct { uint32_t dt_ms; bool key; uint16_t code; uint8_t colour; } in;
static struct { uint32_t limit_ms; bool dim; } set, took;
static void defaults(void) { set.limit_ms = 100; set.dim = false; }
static const char *power_up(void)
{
    if (set.limit_ms > 1000) { return "limit_ms"; }
    took = set; lamp.on = lamp.before = false; lamp.lit_ms = 0; lamp.code = 0; lamp.colour = 0;
    return 0;
}
static void call(void)
{
    lamp.lit_ms = lamp.on ? counted(lamp.lit_ms, in.dt_ms, took.limit_ms) : 0;
    if (rises(in.key, lamp.before)) { lamp.on = !lamp.on; }
    lamp.before = in.key; lamp.code = in.code; lamp.colour = in.colour;
}
static const block_row inputs[] = {
    {.name = "key", .flag = &in.key}, {.name = "code", .word = &in.code},
    {.name = "colour", .choice = &in.colour, .values = {"red", "green"}}, {0}};
static const block_row outputs[] = {
    {.name = "on", .flag = &lamp.on}, {.name = "code", .word = &lamp.code},
    {.name = "lit_ms", .number = &lamp.lit_ms},
    {.name = "colour", .choice = &lamp.colour, .values = {"red", "green"}}, {0}};
static const block_row parameters[] = {
    {.name = "limit_ms", .number = &set.limit_ms}, {.name = "dim", .flag = &set.dim}, {0}};
const block served = {"lamp", &in.dt_ms, inputs, outputs, parameters, defaults, power_up, call};
"""


def compiled(folder: Path, target: str, *options: str) -> Path:
    """A block of examples/c behind its adapter, by the Makefile there."""
    environment = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS", "OUT")}
    command = ["make", "--no-print-directory", "-C", str(FOLDER), f"OUT={folder}", str(folder / target)]
    done = subprocess.run([*command, *options], capture_output=True, text=True, env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    for option in ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"):
        assert done.stdout.count(option) == 4
    return folder / target


# ---------------------------------------------------------------------------------------------- a toy block


@pytest.fixture(scope="module")
def lamp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("lamp")
    (folder / "lamp.c").write_text(LAMP, encoding="utf-8")
    sources = [str(FOLDER / "adapter_block.c"), str(FOLDER / "wire.c"), "lamp.c"]
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *WATCHED.split(), "-I", str(FOLDER)]
    subprocess.run(["gcc", *strict, "-o", "lamp", *sources], cwd=folder, check=True)
    return folder / "lamp"


def lit(key: bool, dt_ms: Any = 60, code: Any = "00AF", colour: Any = "green") -> dict[str, Any]:
    return {"op": "scan", "dt_ms": dt_ms, "in": {"key": key, "code": code, "colour": colour}}


def test_every_kind_of_value_comes_in_and_goes_out(lamp: Path, tmp_path: Path) -> None:
    hello = {"op": "hello", "protocol": 1, "target": "lamp"}
    lines = [hello, RESET, lit(True), lit(True), lit(True, colour="red"), BYE]
    about, ready, first, second, third, bye = talk([str(lamp)], lines, tmp_path)
    assert about["name"] == "lamp.c" and about["relations"] == ["exact"]
    assert (ready, bye) == ({"ok": True}, {"ok": True})
    assert first == {"out": {"on": True, "code": "00AF", "lit_ms": 0, "colour": "green"}}
    assert [second["out"]["lit_ms"], third["out"]["lit_ms"]] == [60, 100]
    assert third["out"]["colour"] == "red"


def test_parameters_left_out_have_their_defaults_in_every_reset(lamp: Path, tmp_path: Path) -> None:
    set_to_70 = {"op": "reset", "params": {"limit_ms": 70}}
    lines = [set_to_70, lit(True), lit(True), lit(True), RESET, lit(True), lit(True), lit(True)]
    replies = talk([str(lamp)], lines, tmp_path)
    assert [reply["out"]["lit_ms"] for reply in replies if "out" in reply] == [0, 60, 70, 0, 60, 100]


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"op": "hello", "protocol": 1, "target": "fplc"}, "lamp"),
    ({"op": "hello", "protocol": 2, "target": "lamp"}, "protocol 1"),
    ({"op": "reset", "params": {"limit_ms": 1001}}, "limit_ms"),
    ({"op": "reset", "params": {"limit_ms": "70"}}, "limit_ms"),
    ({"op": "reset", "params": {"dim": 1}}, "dim"),
    ({"op": "reset", "params": {"key": True}}, "key"),
    (lit(True, dt_ms=-1), "dt_ms"),
    (lit(True, code="0AF"), "code"),
    (lit(True, colour="blue"), "colour"),
    (lit(True, colour=1), "colour"),
    ({"op": "scan", "dt_ms": 1, "in": {"key": True, "code": "0000"}}, "colour"),
    ({"op": "scan", "dt_ms": 1, "in": {"key": True, "code": "0000", "colour": "red", "x": 1}}, "x"),
    ({"op": "scan", "in": {"key": True, "code": "0000", "colour": "red"}}, "dt_ms"),
    ({"op": "scan", "dt_ms": 1}, "key"),
    ({"op": "scans", "list": []}, "op"),
]


def test_what_is_wrong_is_refused_by_name_and_changes_nothing(lamp: Path, tmp_path: Path) -> None:
    lines = [RESET, lit(True), *[line for line, _ in WRONG], lit(True), BYE]
    replies = talk([str(lamp)], lines, tmp_path)
    for (line, cause), reply in zip(WRONG, replies[2:], strict=False):
        assert list(reply) == ["error"] and cause in reply["error"], line
    assert replies[-2] == {"out": {"on": True, "code": "00AF", "lit_ms": 60, "colour": "green"}}


def test_nothing_is_scanned_before_a_reset(lamp: Path, tmp_path: Path) -> None:
    (reply,) = talk([str(lamp)], [lit(True)], tmp_path)
    assert "before reset" in reply["error"]


# ---------------------------------------------------------------------------------------------- every block


@pytest.fixture(scope="module", params=BLOCKS)
def watched(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A block that is ended by the compiler's sanitizers at the first access out of bounds."""
    return compiled(tmp_path_factory.mktemp("block"), request.param, f"CFLAGS={WATCHED}")


def values(signal: dict[str, Any]) -> st.SearchStrategy[Any]:
    """Values of an input or parameter as the wire has them, near the edges of its range."""
    if signal["type"] == "bool":
        return st.booleans()
    if signal["type"] == "text":
        return st.sampled_from(signal["values"])
    least, most = signal["min"], signal["max"]
    return st.sampled_from(sorted({least, *(n for n in (1, 10, 100, 150, 151) if least < n < most), most}))


def mostly_held(inputs: dict[str, Any]) -> st.SearchStrategy[list[dict[str, Any]]]:
    """Scans in which few inputs change at a time, so that states are left one by one."""
    change = st.tuples(st.sampled_from(sorted(inputs)), st.integers(0, 1))
    one = st.tuples(st.lists(change, max_size=2), st.sampled_from([0, 1, 10, 50, 100, 2**32 - 1]))

    def as_scans(steps: list[tuple[list[tuple[str, int]], int]]) -> list[dict[str, Any]]:
        now = {name: name == "Activate" for name in inputs}
        found = []
        for changes, dt_ms in steps:
            now |= {name: bool(value) for name, value in changes}
            found.append({"op": "scan", "dt_ms": dt_ms, "in": dict(now)})
        return found

    return st.lists(one, max_size=40).map(as_scans)


@pytest.mark.deep
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_with_any_parameters_a_block_does_what_the_reference_does(
    watched: Path, tmp_path: Path, data: st.DataObject
) -> None:
    device, _ = find_target(watched.name)
    reference = Target(watched.name)
    params = {name: data.draw(values(signal)) for name, signal in device["parameters"].items()}
    lines = [{"op": "reset", "params": params}, *data.draw(mostly_held(device["inputs"]))]
    expected = [reference.answer(json.loads(json.dumps(line))) for line in lines]
    assert talk([str(watched)], lines, tmp_path) == expected


def test_a_block_refuses_a_missing_input_and_an_extra_parameter(watched: Path, tmp_path: Path) -> None:
    device, _ = find_target(watched.name)
    for name in device["inputs"]:
        entry = {other: False for other in device["inputs"] if other != name}
        _, reply = talk([str(watched)], [RESET, {"op": "scan", "dt_ms": 1, "in": entry}], tmp_path)
        assert name in reply["error"]
    (reply,) = talk([str(watched)], [{"op": "reset", "params": {"T_HUH_ms": 1}}], tmp_path)
    assert "T_HUH_ms" in reply["error"]


def test_every_block_has_a_pack_of_faults() -> None:
    assert {program.target for program in programs()} == {"fplc", *BLOCKS}
    for target in BLOCKS:
        assert all((FOLDER / name).is_file() for name in block(target).sources)

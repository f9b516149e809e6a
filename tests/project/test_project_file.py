"""A project file is read strictly: all that is wrong with it is said at once, each with its line."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import jsonschema
import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from modeproof.project.file import Project, Wrong, read, schema
from tests.project.foreign import TOML


def read_text(folder: Path, text: str) -> Project:
    path = folder / "modeproof.toml"
    path.write_bytes(text.encode())
    return read(path, "modeproof.toml")


def wrong(folder: Path, text: str) -> list[str]:
    with pytest.raises(Wrong) as found:
        read_text(folder, text)
    return found.value.lines


def commands(project: Project) -> list[str]:
    return [" ".join(entry.row.words(str)) for entry in project.entries]


def test_each_kind_of_entry_is_the_command_that_judges_it(tmp_path: Path) -> None:
    text = """version = 1
[program.edm]
files = ["plc/edm.st"]
target = "sf_edm"
unit = "Edm"
wrap = true
seconds = 60
[program.cell]
files = ["plc/cell.st", "plc/lib.st"]
property = "plc/cell.toml"
[machine.press]
wiring = "press.toml"
properties = "safety.toml"
source = ["press.st"]
[adapter.built]
target = "sf_edm"
command = "./edm --fast"
suite = ["tour", "words"]
param = { MonitoringTime_ms = 500, AFTER = "reset", X = true }
[log.monday]
file = "logs/monday.csv"
target = "fplc"
from = "anywhere"
decimal-words = true
ignore = ["A", "B"]
"""
    assert commands(read_text(tmp_path, text)) == [
        "prove-program plc/edm.st --target sf_edm --unit Edm --wrap --seconds 60",
        "prove-program plc/cell.st plc/lib.st --property plc/cell.toml",
        "machine press.toml --source press.st --properties safety.toml",
        "conform sf_edm --adapter ./edm --fast --suite tour --suite words --param MonitoringTime_ms=500 "
        "--param AFTER=reset --param X=true",
        "trace fplc logs/monday.csv --from anywhere --decimal-words --ignore A --ignore B",
    ]


def test_backslashes_and_ends_of_lines_of_windows_are_read(tmp_path: Path) -> None:
    text = (
        'version = 1\r\n[program.edm]\r\nfiles = [\'plc\\sub\\edm.st\', "a\\\\b.st"]\r\ntarget = "sf_edm"\r\n'
    )
    assert commands(read_text(tmp_path, "\ufeff" + text)) == [
        "prove-program plc/sub/edm.st a/b.st --target sf_edm"
    ]


def test_all_that_is_wrong_is_said_with_its_line(tmp_path: Path) -> None:
    text = """version = 1
[program.edm]
file = ["plc/edm.st"]
target = 3
[log.edm]
file = "a.csv"
from = "anywere"
[progam.x]
[machine.m]
wiring = "w.toml"
unit = "X"
[adapter.a]
target = "sf_edm"
command = "./a"
vectors = "v"
suite = ["tour"]
"""
    assert wrong(tmp_path, text) == [
        "modeproof.toml:2: program.edm: `files` is missing",
        "modeproof.toml:3: program.edm.file: unknown key; did you mean 'files'? allowed: files, target, "
        "property, unit, binding, profile, same, codes, latency, wrap, seconds",
        "modeproof.toml:4: program.edm.target: must be a text in quotes, not 3",
        "modeproof.toml:5: log.edm: [program.edm] in line 2 has this name too; give one of them another",
        "modeproof.toml:5: log.edm: `target` is missing",
        "modeproof.toml:7: log.edm.from: 'anywere' is not allowed; did you mean 'anywhere'? allowed: "
        "power-up, anywhere",
        "modeproof.toml:8: unknown key 'progam'; did you mean 'program'? allowed: version, program, machine, "
        "adapter, log",
        "modeproof.toml:9: machine.m: `unit` and `equal` belong to `source`",
        "modeproof.toml:12: adapter.a: `vectors` names files, and `suite` others; leave one out",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[program]\n", ":1: `version = 1` is missing; write it in the first line"),
        (
            "version = 2\nnew = 1\n",
            ":1: version 2 is of a newer modeproof; this one reads 1: update modeproof",
        ),
        ("version = 0\n", ":1: version 0 is an old form; this modeproof reads 1: rename the file, and"),
        ("version = true\n", ":1: version is a number, 1 here, not True"),
        ("version = 1\nprogram = 3\n", ":2: an entry is a table with a name: [program.NAME]"),
        (
            'version = 1\n[log."a b"]\nfile = "a"\ntarget = "b"\n',
            ": log.a b: a name has letters, digits, - and _",
        ),
        ("version = 1\nx = \n", ":2: invalid value"),
        (
            'version = 1\n[log.a]\nfile = "a"\n[log.b]\n[log.a]\n',
            ":5: log.a stands in line 2 too; give one of them another name, or take it out",
        ),
        (
            'version = 1\n[log.a]\nfile = "plc\\edm"\n',
            ":3: unescaped '\\' in a string; a path is written with /",
        ),
        ('version = 1\n[log.a]\nfile = "plc\\new"\ntarget = "b"\n', ":3: log.a.file: 'plc\\new' is no path"),
        (
            'version = 1\n[program.a]\nfiles = ["a"]\ntarget = "b"\n'
            "[program.a.binding]\nnams = {}\nleft_out = 3\n",
            ":6: program.a.binding.nams: unknown key; did you mean 'names'?",
        ),
        (
            'version = 1\n[adapter.a]\ntarget = "b"\ncommand = "python \'a"\n',
            ":2: adapter.a: `command`: --adapter: No closing quotation",
        ),
        (
            'version = 1\n[program.a]\nfiles = ["a"]\ntarget = "b"\nproperty = "c"\n',
            ":2: program.a: needs `target`, or `property` for a program of your own; one of the two",
        ),
        (
            'version = 1\n[program.a]\nfiles = ["a"]\ntarget = "b"\nbinding = "c"\nprofile = "letter"\n',
            ":2: program.a: `profile` stands in c, the file of the binding; leave it out here",
        ),
    ],
)
def test_what_is_wrong_has_its_line_and_what_to_do(tmp_path: Path, text: str, said: str) -> None:
    assert f"modeproof.toml{said}" in wrong(tmp_path, text)[0]


def test_an_unknown_entry_names_the_nearest(tmp_path: Path) -> None:
    project = read_text(tmp_path, 'version = 1\n[log.monday]\nfile = "a"\ntarget = "b"\n')
    with pytest.raises(Unjudged, match=r"modeproof.toml lists no 'munday'; did you mean 'monday'"):
        project.chosen(["munday"])


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "modeproof.toml").write_bytes(b"version = 1\n\xff")
    with pytest.raises(Unjudged, match=r"modeproof.toml: byte 12 is no UTF-8"):
        read(tmp_path / "modeproof.toml", "modeproof.toml")


def test_the_schema_is_that_of_the_entries(tmp_path: Path) -> None:
    shipped = json.loads((TREE / "modeproof/project/project.schema.json").read_text("utf-8"))
    assert shipped == schema()
    check = jsonschema.Draft202012Validator(shipped)
    table = tomllib.loads(TOML)
    assert check.is_valid(table) and not check.is_valid({**table, "version": 2})
    assert not check.is_valid({**table, "progam": {}})
    table["program"]["contactors"]["tarket"] = "x"
    assert not check.is_valid(table)

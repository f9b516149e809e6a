"""The files of TwinCAT as they are saved: POUs, types, lists of globals, tasks, projects and folders."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language.shared_memory import completed
from programs.language.subset import check
from programs.language.tree import Source
from programs.properties.property_file import interval_of
from programs.readers.sources import read_sources
from tests.programs.fuzz import difference_of_translator


def tc(kind: str, name: str, declared: str, body: str | None = None, more: str = "") -> str:
    """A file of TwinCAT."""
    code = "" if body is None else f"<Implementation><ST><![CDATA[{body}]]></ST></Implementation>"
    return (
        f'\ufeff<?xml version="1.0" encoding="utf-8"?>\n<TcPlcObject Version="1.1.0.1">\n'
        f'  <{kind} Name="{name}" Id="{{1}}" SpecialFunc="None">\n'
        f"    <Declaration><![CDATA[{declared}]]></Declaration>\n{code}{more}"
        f'    <LineIds Name="{name}"><LineId Id="3" Count="0" /></LineIds>\n  </{kind}>\n</TcPlcObject>'
    )


ACTION = (
    '<Action Name="Reset"><Implementation><ST><![CDATA[Wait := E_Step.Idle;]]></ST></Implementation></Action>'
)
FILES = {
    "E_Step.TcDUT": tc(
        "DUT", "E_Step", "{attribute 'strict'}\nTYPE E_Step :\n(Idle := 0, Open := 10);\nEND_TYPE"
    ),
    "GVL.TcGVL": tc(
        "GVL",
        "GVL",
        "{attribute 'qualified_only'}\nVAR_GLOBAL\n  Guard AT %I* : BOOL;\n"
        "  {attribute 'pytmc' := '\n  pv: S\n  io: i'} Steps: INT; Lamp AT %Q*: BOOL;\n"
        "END_VAR\n"
        "VAR_GLOBAL CONSTANT\n  LAST : INT := 3;\nEND_VAR",
    ),
    "FB_Lamp.TcPOU": tc(
        "POU",
        "FB_Lamp",
        "FUNCTION_BLOCK FB_Lamp\nVAR_INPUT\n  on : BOOL;\nEND_VAR\nVAR\n  Wait : E_Step;\n"
        "  Row : ARRAY [0..GVL.LAST] OF INT;\nEND_VAR",
        "IF on THEN Wait := E_Step.Open; ELSE Reset(); END_IF\n"
        "GVL.Lamp := Wait = E_Step.Open AND GVL.Guard;\nRow[GVL.LAST] := GVL.Steps;",
        ACTION + '<Method Name="Never"><Declaration><![CDATA[METHOD Never : BOOL]]></Declaration></Method>',
    ),
    "MAIN.TcPOU": tc(
        "POU",
        "MAIN",
        "PROGRAM MAIN\nVAR\n  lamp : FB_Lamp;\nEND_VAR",
        "lamp(on := GVL.Guard);\nIF GVL.Steps < GVL.LAST THEN GVL.Steps := GVL.Steps + 1; END_IF",
    ),
    "Task.TcTTO": '<TcPlcObject><Task Name="Task" Id="{2}"><CycleTime>10000</CycleTime>'
    "<Priority>20</Priority><PouCall><Name>MAIN</Name></PouCall></Task></TcPlcObject>",
}
PROJECT = (
    '<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003"><ItemGroup>{}</ItemGroup></Project>'
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project in a folder, with a file beside it that is not built."""
    for name, text in FILES.items():
        (tmp_path / "POUs").mkdir(exist_ok=True)
        (tmp_path / "POUs" / name).write_text(text, "utf-8")
    items = "".join(f'<Compile Include="POUs\\{name}"><SubType>Code</SubType></Compile>' for name in FILES)
    (tmp_path / "Press.plcproj").write_text(PROJECT.format(items), "utf-8")
    (tmp_path / "POUs" / "Old.TcPOU").write_text(
        tc("POU", "Old", "PROGRAM Old", "GVL.Lamp := TRUE;"), "utf-8"
    )
    return tmp_path


def read(path: Path) -> Source:
    """The sources, looked through and run beside the terms."""
    source = read_sources([path])
    unit = completed(source, source.chosen(None))
    check(source, unit)
    assert difference_of_translator(source, unit, 1, 40) == ""
    return source


@pytest.mark.parametrize("name", [".", "Press.plcproj"])
def test_a_project_is_read_as_it_is_built(name: str, folder: Path) -> None:
    source = read(folder / name)
    assert {*source.units} == {"FB_LAMP", "MAIN"} and not source.refused
    assert source.tasks[0].interval_ms == 10 and interval_of(source, source.chosen(None)) == 10
    assert completed(source, source.chosen(None)).variables["GUARD"].section == "input"


def test_lines_are_those_of_the_file(folder: Path) -> None:
    path = folder / "POUs" / "MAIN.TcPOU"
    path.write_text(path.read_text("utf-8").replace("GVL.Steps + 1", "GVL.Steps + TRUE"), "utf-8")
    source = read_sources([folder])
    with pytest.raises(Unjudged, match=r"MAIN\.TcPOU:9: "):
        check(source, completed(source, source.chosen(None)))


@pytest.mark.parametrize(("asked", "status"), [("GVL.Lamp AND NOT GVL.Guard", 0), ("GVL.Lamp", 1)])
def test_a_property_names_globals_by_their_list(asked: str, status: int, folder: Path) -> None:
    questions, out = folder / "q.toml", folder / "out.json"
    questions.write_text(f'[[property]]\nid = "x"\nsentence = "So."\nnever = "{asked}"\n', "utf-8")
    given = ["prove-program", str(folder), "--property", str(questions), "--json", str(out)]
    assert main([*given, "--certificate", str(folder / "c")]) == status
    record = json.loads(out.read_text("utf-8"))
    assert len(record["sources"]) == 6 and record["scan_time_ms"] == [10, 10]
    if status == 0:
        assert main(["prove-program", "--recheck", str(folder / "c")]) == 0


def changed(folder: Path, name: str, old: str, new: str) -> Unjudged:
    """The refusal after a change of one file."""
    path = folder / "POUs" / name
    assert old in path.read_text("utf-8")
    path.write_text(path.read_text("utf-8").replace(old, new), "utf-8")
    with pytest.raises(Unjudged) as caught:
        source = read_sources([folder])
        check(source, completed(source, source.chosen(None)))
    return caught.value


REFUSED = {
    "a method that is called": ("MAIN.TcPOU", "lamp(on := GVL.Guard)", "lamp.Never()", "has no Never"),
    "a method that runs by itself": (
        "FB_Lamp.TcPOU",
        'Method Name="Never"',
        'Method Name="FB_init"',
        "FB_init",
    ),
    "a pragma": (
        "GVL.TcGVL",
        "VAR_GLOBAL\n  Guard",
        "{attribute 'call_after_init'}\nVAR_GLOBAL\n  Guard",
        "call_after_init",
    ),
    "what a client writes": (
        "GVL.TcGVL",
        "VAR_GLOBAL\n  Guard",
        "VAR_GLOBAL\n  {attribute 'pytmc' := '\n  pv: G\n  io: io'}\n  Guard",
        "'pytmc' lets a client write the variable",
    ),
    "inheritance": ("FB_Lamp.TcPOU", "FB_Lamp\nVAR", "FB_Lamp EXTENDS FB_Base\nVAR", "FB_Lamp.TcPOU"),
    "another name": (
        "FB_Lamp.TcPOU",
        "FUNCTION_BLOCK FB_Lamp",
        "FUNCTION_BLOCK FB_Light",
        "FB_Lamp is expected",
    ),
    "a body in a diagram": ("FB_Lamp.TcPOU", "<ST>", "<CFC>", "not well-formed"),
    "a cycle of half a millisecond": ("Task.TcTTO", "10000", "500", "no whole number of ms"),
    "a document type": ("MAIN.TcPOU", "<TcPlcObject", "<!DOCTYPE x><TcPlcObject", "document type"),
    "a unit that might write": ("FB_Lamp.TcPOU", "  on : BOOL;", "  on : BOOL; r : REAL;", "REAL"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_read_is_refused(name: str, folder: Path) -> None:
    file, old, new, cause = REFUSED[name]
    assert cause in changed(folder, file, old, new).message


def test_a_block_with_methods_is_not_judged_alone(folder: Path) -> None:
    source = read_sources([folder])
    with pytest.raises(Unjudged, match=r"FB_Lamp has methods or properties \(Never\), which others call"):
        check(source, completed(source, source.chosen("FB_Lamp")))


@pytest.mark.parametrize(
    ("name", "text", "cause"),
    [
        ("a.L5X", "<RSLogix5000Content/>", ".L5X is not read: .*export the routine as Structured Text"),
        ("a.xml", "<RSLogix5000Content/>", "L5X of Rockwell is not read"),
        ("a.xml", "<Document><SW.Blocks.FB/></Document>", "SimaticML of TIA is not read"),
        ("a.export", "x", "export the project as PLCopen XML"),
        ("a.xef", "x", "export each section as Structured Text"),
        ("a.ap17", "x", "a TIA project is no source"),
    ],
)
def test_closed_forms_are_refused_with_what_to_do(name: str, text: str, cause: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text, "utf-8")
    with pytest.raises(Unjudged, match=cause):
        read_sources([tmp_path / name])


def test_a_folder_without_a_source_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=r"no project .* and no source"):
        read_sources([tmp_path])
    for name in "ab":
        (tmp_path / f"{name}.plcproj").write_text(PROJECT.format(""), "utf-8")
    with pytest.raises(Unjudged, match="2 projects in it; name one"):
        read_sources([tmp_path])


BY_NAME = {
    "a structure that extends": (
        "TYPE s EXTENDS g :\nSTRUCT a : BOOL; END_STRUCT END_TYPE\nFUNCTION_BLOCK f",
        "",
        "inheritance",
    ),
    "a block that extends another": (
        "FUNCTION_BLOCK f EXTENDS g",
        "VAR_INPUT a : BOOL; END_VAR",
        "inheritance",
    ),
    "a block that implements": (
        "FUNCTION_BLOCK f IMPLEMENTS g",
        "VAR_INPUT a : BOOL; END_VAR",
        "inheritance",
    ),
}


@pytest.mark.parametrize("name", BY_NAME)
def test_what_is_object_oriented_is_refused_by_name(name: str, tmp_path: Path) -> None:
    head, declared, cause = BY_NAME[name]
    path = tmp_path / "f.st"
    path.write_text(f"{head}\n{declared}\nEND_FUNCTION_BLOCK\n", "utf-8")
    with pytest.raises(Unjudged, match=cause):
        read_sources([path])


def test_an_attribute_for_naming_rules_changes_nothing(tmp_path: Path) -> None:
    path = tmp_path / "f.st"
    declared = "VAR_INPUT\n{attribute 'naming' := 'omit'}\na : BOOL;\nEND_VAR\n"
    path.write_text(f"FUNCTION_BLOCK f\n{declared}END_FUNCTION_BLOCK\n", "utf-8")
    assert set(read_sources([path]).units["F"].variables) == {"A"}

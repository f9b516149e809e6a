"""Sources of TIA Portal as they are saved: data blocks, instances, tags, names in quotation marks."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language.shared_memory import completed
from programs.language.subset import check
from programs.language.tree import Source, Unit
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine
from tests.programs.fuzz import difference_of_translator

TYPE = 'TYPE "typ Count"\nVERSION : 0.1\n   STRUCT\n      n : Int;\n   END_STRUCT;\n\nEND_TYPE\n'
DATA = """DATA_BLOCK "My Data"
{ DB_Accessible_From_OPC_UA := 'FALSE' ;
 S7_Optimized_Access := 'TRUE' }
VERSION : 0.1
NON_RETAIN
   VAR
      count : Int := 5;
      "is on" : Bool;
      part : "typ Count";
   END_VAR


BEGIN
   count := 7;
END_DATA_BLOCK
"""
FB = """FUNCTION_BLOCK "Steps"
{ S7_Optimized_Access := 'TRUE' }
VERSION : 0.1
   VAR_INPUT
      go : Bool;
   END_VAR
   VAR_OUTPUT
      "n-th" : Int;
   END_VAR
BEGIN
    IF #go THEN
        #"n-th" += 1; // a += b
        "My Data".count -= Int#2;
    END_IF;
    "My Data"."is on" := #go;
END_FUNCTION_BLOCK
"""
INSTANCE = 'DATA_BLOCK "Steps_DB"\nVERSION : 0.1\nNON_RETAIN\n"Steps"\n\nBEGIN\n\nEND_DATA_BLOCK\n'
MAIN = """ORGANIZATION_BLOCK "Main"
TITLE = "Main Program Sweep (Cycle)"
{ S7_Optimized_Access := 'TRUE' }
VERSION : 0.1
BEGIN
    "Steps_DB"(go := "Start-Button");
    "Lamp" := "My Data"."is on" AND ("Steps_DB"."n-th" < 3);
END_ORGANIZATION_BLOCK
"""
TAGS = """<?xml version="1.0"?>
<Tagtable name="Default tag table">
  <Tag type="Bool" hmiVisible="True" remark="" addr="%I0.0">Start-Button</Tag>
  <Tag type="Bool" hmiVisible="True" remark="" addr="%Q0.0">Lamp</Tag>
</Tagtable>
"""
OPENNESS = """<?xml version="1.0"?>
<Document><SW.Tags.PlcTagTable ID="0"><ObjectList>
<SW.Tags.PlcTag><AttributeList><DataTypeName>Bool</DataTypeName><LogicalAddress>%I0.0</LogicalAddress>
<Name>Start-Button</Name></AttributeList></SW.Tags.PlcTag>
<SW.Tags.PlcTag><AttributeList><DataTypeName>Bool</DataTypeName><LogicalAddress>%Q0.0</LogicalAddress>
<Name>Lamp</Name></AttributeList></SW.Tags.PlcTag>
</ObjectList></SW.Tags.PlcTagTable></Document>
"""


def saved(folder: Path, **files: str) -> Path:
    """The project in a folder; a file is replaced by its name with `_` for the dot."""
    every = {
        "type.udt": TYPE,
        "data.db": DATA,
        "steps.scl": FB,
        "instance.db": INSTANCE,
        "main.scl": MAIN,
        "tags.xml": TAGS,
    }
    every |= {name.replace("_", "."): text for name, text in files.items()}
    for name, text in every.items():
        (folder / name).write_text(f"\ufeff{text}", "utf-8")
    return folder


def judged(folder: Path) -> tuple[Source, Unit]:
    """The program with all globals, looked at."""
    source = read_sources([folder])
    unit = completed(source, source.main())
    check(source, unit)
    return source, unit


def refusal(folder: Path) -> str:
    """The line that refuses the project."""
    with pytest.raises(Unjudged) as caught:
        judged(folder)
    return caught.value.message.replace(f"{folder}/", "")


@pytest.mark.parametrize("tags", [TAGS, OPENNESS], ids=["by hand", "by Openness"])
def test_a_project_as_saved_is_one_program(tags: str, tmp_path: Path) -> None:
    source, unit = judged(saved(tmp_path, tags_xml=tags))
    assert unit.kind == "program" and set(unit.of("input")) == {"Start_Button"}
    machine = Machine(source, unit)
    shown = [machine.scan({"Start_Button": on}, 10) for on in (True, False, True, True)]
    assert [scan["Lamp"] for scan in shown] == [True, False, True, False]
    assert [scan["count"] for scan in shown] == [5, 5, 3, 1]


@pytest.mark.parametrize("wrong", [False, True])
def test_a_property_of_a_project_is_judged(wrong: bool, tmp_path: Path) -> None:
    saved(tmp_path, main_scl=MAIN.replace("AND (", "OR (") if wrong else MAIN)
    rule = tmp_path / "rule.toml"
    rule.write_text('[[property]]\nid = "lamp"\nsentence = "l"\nholds = "Lamp"\n', "utf-8")
    with rule.open("a", encoding="utf-8") as file:
        file.write('only_if = "Start_Button"\n')
    assert main(["prove-program", str(tmp_path), "--property", str(rule), "--wrap"]) == int(wrong)


def test_a_data_block_that_is_not_non_retain_keeps_values(tmp_path: Path) -> None:
    _, unit = judged(saved(tmp_path, data_db=DATA.replace("NON_RETAIN", "")))
    assert unit.variables["COUNT"].retained
    _, unit = judged(saved(tmp_path))
    assert not unit.variables["COUNT"].retained
    _, unit = judged(saved(tmp_path, data_db=DATA.replace("   VAR\n", "   VAR RETAIN\n")))
    assert unit.variables["COUNT"].retained


def test_a_data_block_of_a_type_is_one_global(tmp_path: Path) -> None:
    body = MAIN.replace('"My Data"."is on"', '("Counted".n = 0)')
    other = 'DATA_BLOCK "Counted"\nNON_RETAIN\n"typ Count"\nBEGIN\nEND_DATA_BLOCK\n'
    _, unit = judged(saved(tmp_path, main_scl=body, other_db=other))
    assert "COUNTED" in unit.variables


def test_first_values_behind_begin_are_read(tmp_path: Path) -> None:
    more = DATA.replace("   END_VAR", '      row : Array[0..2] of "typ Count";\n      w : Word;\n   END_VAR')
    given = 'part.n := 7; // one\n"is on" := TRUE;\n row[1].n := -3;\n w := W#16#F0;'
    body = MAIN.replace(
        "BEGIN\n", 'BEGIN\n    IF "My Data".row[1].n = -3 THEN "My Data".row[0].n := 1; END_IF;\n'
    )
    body = body.replace('"My Data"."is on" AND', '"My Data".part.n = 7 AND "My Data".w = 16#F0 AND')
    source, unit = judged(saved(tmp_path, main_scl=body, data_db=more.replace("count := 7;", given)))
    shown = Machine(source, unit).scan({"Start_Button": False, "part": {"N": 7}, "w": 0xF0}, 10)
    assert [one["N"] for one in shown["row"]] == [1, -3, 0]
    assert unit.variables["IS_ON"].initial is True and unit.variables["COUNT"].initial == 5
    assert source.units and unit.variables["PART"].initial == (("N", 7),)


STRUCTURE = DATA.replace("   VAR\n", "   STRUCT\n").replace("END_VAR", "END_STRUCT;")


def test_a_data_block_with_a_structure_is_read_alike(tmp_path: Path) -> None:
    source, unit = judged(saved(tmp_path, data_db=STRUCTURE))
    assert Machine(source, unit).scan({"Start_Button": True}, 10)["count"] == 5


REFUSED = {
    "an instance that keeps its values": (
        {"instance_db": INSTANCE.replace("NON_RETAIN\n", "")},
        "RETAIN: an instance of a block is not supported there",
    ),
    "a first value of an instance": (
        {"instance_db": INSTANCE.replace("BEGIN\n", "BEGIN\n   go := TRUE;\n")},
        "this first value is not read here: it is of",
    ),
    "a first value of nothing": (
        {"data_db": DATA.replace("count := 7", "part.m := 7")},
        "data.db:14: this first value is not read here: it is of typ_Count",
    ),
    "a first value of another type": (
        {"data_db": DATA.replace("count := 7", "count := 70_000")},
        "data.db:14: ",
    ),
    "a client that writes": ({"data_db": DATA.replace("FALSE", "TRUE", 1)}, "lets a client write the data"),
    "no data block": ({"data_db": ""}, "My_Data is not declared"),
    "no tags": ({"tags_xml": "<Tagtable/>"}, "Start_Button is not declared"),
    "two names that are one": (
        {"main_scl": MAIN.replace('"Lamp" :=', '"My-Data" :=')},
        "'MY-DATA' and 'MY DATA' are one name here",
    ),
    "a global with the name of a variable": (
        {"steps_scl": FB.replace('"My Data".count -= Int#2', '"go" := FALSE')},
        '"go" is a global name, and the block declares one of its own',
    ),
    "another program that writes": (
        {"startup_scl": MAIN.replace("Main", "Startup", 1).replace('"Steps_DB"(go := "Start-Button");', "")},
        "Lamp of Startup and Lamp share Q 0",
    ),
    "something outside of blocks": ({"main_scl": f"Lamp := TRUE;\n{MAIN}"}, "'Lamp' is in no block of SCL"),
    "a block that does not end": ({"main_scl": MAIN[:-20]}, "ORGANIZATION_BLOCK Main does not end"),
    "a written input": (
        {"main_scl": MAIN.replace('"Lamp" :=', '"Start-Button" :=')},
        "Start_Button is at %I0.0, an input, and is written",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_clear_in_a_project_is_refused(name: str, tmp_path: Path) -> None:
    files, cause = REFUSED[name]
    found = saved(tmp_path, **files)
    if name == "another program that writes":
        source = read_sources([found])
        with pytest.raises(Unjudged, match=cause):
            completed(source, source.units["MAIN"])
        return
    assert cause in refusal(found)


def test_a_block_that_cannot_be_read_is_refused_alone(tmp_path: Path) -> None:
    broken = 'FUNCTION "Other" : Void\n   VAR_INPUT\n      s : WString;\n   END_VAR\nBEGIN\nEND_FUNCTION\n'
    source = read_sources([saved(tmp_path, main_scl=broken + MAIN)])
    check(source, completed(source, source.units["MAIN"]))
    with pytest.raises(Unjudged, match=r"main\.scl:3: string type is not supported"):
        source.find("Other")


def test_a_refused_block_that_may_write_counts(tmp_path: Path) -> None:
    broken = (
        'FUNCTION "Other" : Void\nVAR_TEMP\n s : WString;\nEND_VAR\nBEGIN\n"Lamp" := TRUE;\nEND_FUNCTION\n'
    )
    source = read_sources([saved(tmp_path, main_scl=broken + MAIN)])
    with pytest.raises(Unjudged, match=r"and OTHER might write LAMP, as Main does"):
        completed(source, source.units["MAIN"])


def test_a_global_lent_to_a_function_of_it_is_refused(tmp_path: Path) -> None:
    function = """FUNCTION "Twice" : Void
   VAR_INPUT
      before : Int;
   END_VAR
BEGIN
    "My Data".count := 1;
    "My Data".part.n := #before;
END_FUNCTION
"""
    call = MAIN.replace("BEGIN\n", 'BEGIN\n    "Twice"(before := "My Data".count);\n')
    files = saved(tmp_path, twice_scl=function, main_scl=call)
    assert "Twice uses count, and this call hands it over" in refusal(files)
    source, unit = judged(saved(tmp_path, main_scl=call.replace('"My Data".count)', "3)")))
    assert difference_of_translator(source, unit, 1, 40) == ""


def test_values_of_updates_keep_their_brackets(tmp_path: Path) -> None:
    body = FB.replace('"My Data".count -= Int#2', '"My Data".count -= 3 - 1')
    source, unit = judged(saved(tmp_path, steps_scl=body))
    assert Machine(source, unit).scan({"Start_Button": True}, 10)["count"] == 5


LENDS = """FUNCTION "Step" : Void
   VAR_INPUT
      by : Int;
   END_VAR
   VAR_IN_OUT
      part : "typ Count";
      list : Array[0..2] of Int;
   END_VAR
BEGIN
    #part.n += #by;
    #list[1] := #part.n;
END_FUNCTION
FUNCTION_BLOCK "Lends"
   VAR_INPUT
      by, which : Int;
   END_VAR
   VAR_OUTPUT
      n, second : Int;
   END_VAR
   VAR
      parts : Array[0..1] of "typ Count";
      list : Array[0..2] of Int;
      pair : Struct
         n : Int;
         part : "typ Count";
      END_STRUCT;
   END_VAR
BEGIN
    IF #which < 0 OR #which > 1 THEN RETURN; END_IF;
    "Step"(by := #by, part := #parts[#which], list := #list);
    #n := #parts[0].n;
    #second := #list[1];
END_FUNCTION_BLOCK
"""


def lends(folder: Path, text: str = LENDS) -> tuple[Source, Unit]:
    """A block that lends a structure and an array to a FUNCTION."""
    (folder / "b.scl").write_text(TYPE + text, "utf-8")
    source = read_sources([folder / "b.scl"])
    unit = source.units["LENDS"]
    check(source, unit)
    return source, unit


def test_a_function_writes_the_structure_that_it_is_lent(tmp_path: Path) -> None:
    source, unit = lends(tmp_path)
    machine = Machine(source, unit)
    shown = [machine.scan({"by": by, "which": which}, 10) for by, which in ((3, 0), (4, 1), (1, 0))]
    assert [(scan["n"], scan["second"]) for scan in shown] == [(3, 3), (3, 4), (4, 4)]
    assert all(difference_of_translator(source, unit, seed, 30) == "" for seed in range(3))


def test_a_variable_that_goes_in_and_comes_out_is_refused(tmp_path: Path) -> None:
    lends(tmp_path, LENDS.replace("by := #by, part := #parts[#which]", "by := #pair.n, part := #pair.part"))
    for one in ("by := #list[0]", "by := #parts[0].n"):
        with pytest.raises(Unjudged, match="goes into Step and comes out of it: S7 may take"):
            lends(tmp_path, LENDS.replace("by := #by, part", f"{one}, part"))

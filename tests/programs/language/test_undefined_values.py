"""What a call in SCL begins without: temporaries, and what a function gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.tool_differences import assumed
from programs.language.tree import Source
from programs.readers.sources import read_sources
from programs.semantics.terms import slots

HEAD = """FUNCTION_BLOCK "B"
{ S7_Optimized_Access := 'FALSE' }
VAR_INPUT x : Bool; n : Int; END_VAR
VAR_OUTPUT q : Bool; END_VAR
VAR d : TON_TIME; END_VAR
VAR_TEMP t, u : Bool; i : Int; w : Word; a : ARRAY [0..3] OF Bool; END_VAR
BEGIN
"""
FUNCTION = """FUNCTION "Pick" : Bool
VAR_INPUT a : Bool; END_VAR
VAR_OUTPUT b : Bool; END_VAR
VAR_TEMP c : Bool; END_VAR
BEGIN
"""


def looked_at(folder: Path, body: str, before: str = "", head: str = HEAD) -> Source:
    """Read a block with this body, which begins in its eighth line. Raises Unjudged."""
    path = folder / "b.scl"
    path.write_text(f"{before}{head}{body}\nEND_FUNCTION_BLOCK\n", "utf-8")
    source = read_sources([path])
    check(source, source.units["B"])
    return source


@pytest.mark.parametrize(
    ("name", "body"),
    [
        ("t", "#q := #t;"),
        ("t", "#t := #t OR #x; #q := #t;"),
        ("t", "IF #x THEN #t := TRUE; END_IF; #q := #t;"),
        ("t", "IF #x THEN #t := TRUE; ELSIF #t THEN #q := #x; END_IF;"),
        ("t", "CASE #n OF 1: #t := TRUE; 2: #t := FALSE; END_CASE; #q := #t;"),
        ("i", "WHILE #x AND #i < 3 DO #i := #i + 1; END_WHILE;"),
        ("t", "WHILE #x DO #t := TRUE; EXIT; END_WHILE; #q := #t;"),
        ("t", "REPEAT IF #x THEN EXIT; END_IF; #t := TRUE; UNTIL #t END_REPEAT; #q := #t;"),
        ("t", "REPEAT IF #x THEN CONTINUE; END_IF; #t := TRUE; UNTIL #t END_REPEAT;"),
        ("a", "FOR #i := 0 TO 2 DO #a[#i] := #x; END_FOR; #q := #a[3];"),
        ("a", "FOR #i := 0 TO 2 DO #a[#i] := #a[#i + 1]; END_FOR;"),
        ("a", "FOR #i := 0 TO 3 DO IF #x THEN #a[#i] := #x; END_IF; END_FOR; #q := #a[0];"),
        ("a", "#a[0] := #x; #q := #a[#n];"),
        ("a", "#a[#n] := #x; #q := #a[#n];"),
        ("w", "#w.%X3 := #x; #q := #w.%X3;"),
        ("t", "#d(IN := #t, PT := T#1s);"),
        ("a", "IF #x THEN #t := TRUE; ELSE RETURN; END_IF; #u := #t; #q := #a[1];"),
    ],
)
def test_a_temporary_read_before_it_is_written_is_refused(name: str, body: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=rf"b\.scl:8: {name} may be read before it is written in this call"):
        looked_at(tmp_path, body)


@pytest.mark.parametrize(
    "body",
    [
        "#t := #x; #q := #t;",
        "IF #x THEN #t := TRUE; ELSIF #n > 1 THEN #t := FALSE; ELSE #t := #x; END_IF; #q := #t;",
        "IF #x THEN #t := TRUE; ELSE RETURN; END_IF; #q := #t;",
        "CASE #n OF 1: #t := TRUE; ELSE #t := FALSE; END_CASE; #q := #t;",
        "REPEAT #t := #x; IF #x THEN EXIT; END_IF; UNTIL #t END_REPEAT; #q := #t;",
        "FOR #i := 0 TO 3 DO #a[#i] := #x; END_FOR; #q := #a[#n] AND #i > 0;",
        "FOR #i := 0 TO 2 DO #a[#i + 1] := #x; END_FOR; #a[0] := #x; #q := #a[0];",
        "FOR #i := 0 TO 3 DO IF #x THEN CONTINUE; END_IF; #t := #x; #q := #t; END_FOR;",
        "#w := 16#0; #w.%X3 := #x; #q := #w.%X3;",
        "#d(IN := #x, PT := T#1s, Q => #t); #q := #t;",
    ],
)
def test_a_temporary_that_is_written_before_is_read(body: str, tmp_path: Path) -> None:
    looked_at(tmp_path, body)


@pytest.mark.parametrize(
    ("body", "cause"),
    [
        ("#b := #a; IF #a THEN #Pick := TRUE; END_IF;", "b.scl:1: Pick may end here without its result"),
        ("#b := #a; IF #a THEN RETURN; END_IF; #Pick := #a;", "b.scl:6: Pick may end here without its res"),
        ("#Pick := #a; IF #a THEN #b := TRUE; END_IF;", "b.scl:1: Pick may end here without its output b"),
        ("#Pick := #c; #b := #a;", "b.scl:6: c may be read before it is written"),
        ("#Pick := #Pick OR #a; #b := #a;", "b.scl:6: Pick may be read before it is written"),
    ],
)
def test_a_function_that_gives_nothing_on_some_way_is_refused(body: str, cause: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=cause):
        looked_at(tmp_path, "Pick(a := #x, b => #q);", f"{FUNCTION}{body}\nEND_FUNCTION\n")


def test_what_a_function_gives_is_written(tmp_path: Path) -> None:
    function = f"{FUNCTION}#b := #a; #Pick := NOT #b;\nEND_FUNCTION\n"
    looked_at(tmp_path, "#u := Pick(a := #x, b => #t); #q := #t AND #u;", function)


def test_structured_text_begins_with_first_values(tmp_path: Path) -> None:
    path = tmp_path / "b.st"
    text = HEAD[HEAD.index("VAR_INPUT") : HEAD.index("BEGIN")].replace("TON_TIME", "TON")
    path.write_text(
        f"FUNCTION_BLOCK B {text} IF x THEN t := TRUE; END_IF q := t; END_FUNCTION_BLOCK", "utf-8"
    )
    source = read_sources([path])
    check(source, source.units["B"])


@pytest.mark.parametrize(
    ("attribute", "cause"),
    [
        ("S7_server := 'alarm_archiv'", "attribute S7_server may change what the program does"),
        ("odd", "NAME := 'value' is understood in braces"),
    ],
)
def test_an_attribute_that_may_change_something_is_refused(
    attribute: str, cause: str, tmp_path: Path
) -> None:
    head = HEAD.replace("d : TON", f"k {{ {attribute} }} : Bool; d : TON")
    with pytest.raises(Unjudged, match=rf"b\.scl:5: .*{cause}"):
        looked_at(tmp_path, "#q := #x;", head=head)
    harmless = "S7_SetPoint := 'False'; ExternalWritable := 'False'; S7_m_c := 'true'"
    looked_at(tmp_path, "#q := #x;", head=head.replace(attribute, harmless))


def test_retention_that_the_source_leaves_open_is_said(tmp_path: Path) -> None:
    for access, doubtful in (("{ S7_Optimized_Access := 'TRUE' }", False), ("", True), ("// 'TRUE'", True)):
        head = HEAD.replace("{ S7_Optimized_Access := 'FALSE' }", access)
        source = looked_at(tmp_path, "#q := #x;", head=head)
        said = list(assumed(source, source.units["B"]))
        assert (
            said == ["the instance data block of B is not retentive, which the source leaves open"] * doubtful
        )


@pytest.mark.parametrize(
    "declared",
    ["RETAIN\n k : Bool", "k { S7_SetPoint := 'True'} : Bool", "\"k\"\n {S7_SetPoint:='TRUE'} : Bool"],
)
def test_what_is_kept_or_set_later_begins_anywhere(declared: str, tmp_path: Path) -> None:
    head = HEAD.replace("VAR d", f"VAR {declared}; END_VAR VAR d")
    source = looked_at(tmp_path, "#q := #k; #k := #x;", head=head)
    assert [slot.path for slot in slots(source, source.units["B"]) if slot.initial is None] == ["K"]


def test_an_input_that_is_set_later_is_refused(tmp_path: Path) -> None:
    head = HEAD.replace("n : Int", "n { S7_SetPoint := 'True'} : Int")
    with pytest.raises(Unjudged, match=r"b\.scl:3: this attribute retains one variable in VAR"):
        looked_at(tmp_path, "#q := #x;", head=head)

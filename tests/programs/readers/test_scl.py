"""Siemens SCL: what the pass over the text changes, what it leaves alone, what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from programs.equality.binding import read_binding
from programs.equality.comparison import make
from programs.equality.verdict import judge
from programs.language.subset import check
from programs.language.tree import Source, Unit
from programs.readers.scl import structured_text
from programs.readers.structured_text.units import read_text
from programs.semantics.interpreter import Machine

ROOT = Path(__file__).parents[3]
CAUTIOUS = read_binding(ROOT / "examples" / "cautious.toml")
HEAD = """FUNCTION_BLOCK "B"
TITLE = it's a block
{ S7_Optimized_Access := 'TRUE' }
VERSION : 0.1
   VAR_INPUT
      x { ExternalWritable := 'F}alse'} : Bool;   // "quoted { and it's open
   END_VAR
   VAR_OUTPUT
      y : Int;
      w : Word := W#16#F0;
   END_VAR
   VAR
      t {InstructionName := 'TON_TIME'; LibVersion := '1.0'} : TON_TIME;
   END_VAR
BEGIN
"""
END = "\nEND_FUNCTION_BLOCK\n"


def read_scl(text: str, file: str) -> list[Unit]:
    """The units of a text in SCL."""
    return read_text(structured_text(text, file), file)


def block(body: str) -> Machine:
    """The block with this body, which begins in line 16."""
    source = Source({unit.name.upper(): unit for unit in read_scl(HEAD + body + END, "b.scl")}, {})
    check(source, source.main())
    return Machine(source, source.main())


def refusal(text: str) -> str:
    """The line that refuses a text."""
    with pytest.raises(Unjudged) as caught:
        read_scl(text, "b.scl")
    return caught.value.message


def test_names_are_read_without_their_marks() -> None:
    of = block('#y := 3; IF #x THEN #"y" := 4; #"w" := 16#1; END_IF;')
    assert of.scan({"x": False}, 1) == {"y": 3, "w": 0xF0}
    assert of.scan({"x": True}, 1) == {"y": 4, "w": 1}


def test_timers_of_step_seven_are_those_of_the_standard() -> None:
    of = block("#t(IN := #x, PT := T#20ms); IF #t.Q THEN #y := 1; ELSE #y := 0; END_IF;")
    assert [of.scan({"x": True}, 10)["y"] for _ in range(4)] == [0, 0, 1, 1]


def test_regions_are_taken_away_and_their_content_stays() -> None:
    of = block('REGION it\'s "a" { region\n  #y := 5;\nEND_REGION')
    assert of.scan({"x": False}, 1)["y"] == 5


@pytest.mark.parametrize(
    "comment",
    ["(* #y := 9; { \" ' *)", "// #y := 9; { \" '", "/* #y := 9; REGION \" ' { */", "(* REGION\nBEGIN\n*)"],
)
def test_comments_may_hold_anything(comment: str) -> None:
    assert block(f"{comment}\n#y := 6;").scan({"x": False}, 1)["y"] == 6


def test_lines_stay_where_they_are() -> None:
    body = "REGION a\n(* two\nlines *)\n{ LibVersion :=\n'two' }\nEND_REGION\n#y := #ghost;"
    with pytest.raises(Unjudged, match=r"b\.scl:22: ghost is not declared"):
        block(body)
    assert structured_text(HEAD + body, "b.scl").count("\n") == (HEAD + body).count("\n")


def test_literals_with_a_hash_stay_as_they_are() -> None:
    text = "y := 16#FF; t := T#1s_5ms; i := INT#5; w := W#16#1F; d := DW#16#0; b := B#16#2; c := Colour#Red;"
    expected = text.replace("W#16#1F", "WORD#16#1F").replace("DW#", "DWORD#").replace(" B#", " BYTE#")
    assert structured_text(text, "b.scl") == expected


@pytest.mark.parametrize(
    ("body", "cause"),
    [
        ("#y := := 1;", "b.scl:16: syntax error"),
        ("REGION a #y := 1;\nEND_REGION", "b.scl:16: REGION: a statement in this line would be lost"),
        ("REGION a\nEND_REGION #y := 1;", "b.scl:17: END_REGION: a statement in this line would be lost"),
        ("VERSION : 1.0\n#y := 1;", "b.scl:16: VERSION is understood in the head of a block only"),
        ('#y := #"a;', "a name in quotation marks does not end"),
        ('#y := "y";', '"y" is a global name'),
        ('"y" := 1;', '"y" is a global name'),
        ('"y" += 1;', '"y" is a global name'),
        ('"t"(IN := TRUE, PT := T#1s);', '"t" is a global name'),
        ("(* open\n#y := 1;", "b.scl:16: (* begins something that does not end"),
        ("#y := 'open;", "' begins something that does not end"),
        ("{ open\n#y := 1;", "b.scl:16: '{' is not expected here"),
        ("#y := 1; # y := 2;", "'#' is not expected here"),
    ],
)
def test_what_cannot_be_read_is_refused(body: str, cause: str) -> None:
    assert cause in refusal(HEAD + body + END)


def test_a_variable_with_the_name_of_an_attribute_is_kept() -> None:
    text = HEAD.replace("      y : Int;", "      y : Int;\n      Family : Int;") + "#y := 1;" + END
    assert "understood in the head of a block only" in refusal(text)
    assert len(read_scl(text.replace("Family : Int", "Member, Family : Int"), "b.scl")[0].of("output")) == 4


@pytest.mark.deep
def test_the_example_in_scl_is_proved() -> None:
    product = make([ROOT / "examples" / "st" / "sf_edm.scl"], "sf_edm", binding=CAUTIOUS)
    assert judge(product, ROOT / "vectors" / "sf_edm", 120, lambda text: None).word == "PROVED"


def test_another_code_in_scl_is_refuted(tmp_path: Path) -> None:
    path = tmp_path / "sf_edm.scl"
    text = (ROOT / "examples" / "st" / "sf_edm.scl").read_text("utf-8")
    path.write_text(text.replace("#code := 16#C070", "#code := 16#C080"), "utf-8")
    found = judge(
        make([path], "sf_edm", binding=CAUTIOUS), ROOT / "vectors" / "sf_edm", 120, lambda text: None
    )
    assert found.word == "REFUTED" and found.difference is not None

"""What the reader refuses: with file, line and construct, and never by leaving it out."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.time_literals import time_ms
from programs.language.tree import Place, Source
from programs.readers.structured_text.units import read_text

HEAD = "FUNCTION_BLOCK B\nVAR_INPUT x : INT; END_VAR VAR_OUTPUT y : INT; END_VAR\n"
END = "\nEND_FUNCTION_BLOCK\n"
REFUSED = {
    "two structures that are compared": (
        "VAR s, t : STRUCT a : INT; END_STRUCT; END_VAR IF s = t THEN y := 1; END_IF",
        "a value of kind",
    ),
    "a bit beyond a word": ("VAR w : WORD; END_VAR w.%X16 := TRUE;", "bit 16 is outside WORD, 0..15"),
    "a bit of a number": ("IF y.0 THEN y := 1; END_IF", "a value of kind bits is needed here"),
    "a byte of a word": ("VAR w : WORD; END_VAR w.%B1 := BYTE#1;", "use SHR"),
    "a name like a bit": ("VAR w : WORD; END_VAR w.__BIT3 := TRUE;", "give this another name"),
    "an end of no loop": ("IF y = 1 THEN EXIT; END_IF", "EXIT without a loop around it"),
    "a turn of no loop": ("CONTINUE;", "CONTINUE without a loop around it"),
    "a pointer": ("VAR p : POINTER TO INT; END_VAR y := 1;", "is not supported"),
    "a real number": ("VAR r : REAL; END_VAR y := 1;", "type REAL is not supported"),
    "an address": ("VAR r AT %I0.0 : BOOL; END_VAR y := 1;", "AT: a variable in VAR of a PROGRAM"),
    "an in-out": ("VAR_IN_OUT z : INT; END_VAR y := 1;", "z is VAR_IN_OUT: take a program that calls B"),
    "an unknown function": ("y := SQRT(x);", "function SQRT is not supported"),
    "an unknown block": ("VAR t : TONE; END_VAR y := 1;", "did you mean 'TON'"),
    "an unknown name": ("y := z;", "z is not declared"),
    "an unknown pin": ("VAR t : TON; END_VAR t(INN := TRUE);", "TON has no INN; did you mean 'IN'"),
    "a written input": ("x := 1;", "x is an input and is written"),
    "an output to an input": (
        "VAR_INPUT b : BOOL; END_VAR VAR t : TON; END_VAR t(IN := TRUE, Q => b);",
        "b is an input and is written",
    ),
    "a counter": ("VAR t : CTU2; END_VAR t();", "no type or block 'CTU2'"),
    "a narrower value": ("VAR b : BYTE; w : WORD; END_VAR b := w;", "BYTE := WORD needs a conversion"),
    "a value of another kind": ("y := TRUE;", "INT := BOOL needs a conversion"),
    "a number that is too large": ("y := 40000;", "40000 is outside INT"),
    "a first value that is too large": ("VAR z : SINT := 200; END_VAR y := 1;", "no value of SINT"),
    "a time that is too long": ("VAR z : TIME := T#30d; END_VAR y := 1;", "outside TIME"),
    "two of one name": ("VAR Y : INT; END_VAR y := 1;", "Y is declared twice"),
    "a retained timer": ("VAR RETAIN t : TON; END_VAR y := 1;", "an instance of a block is not supported"),
    "a block in itself": ("VAR b : B; END_VAR y := 1;", "B calls B: a block must not contain itself"),
    "a syntax error": ("y := := 1;", "syntax error"),
    "a nested comment": ("(* (* inner *) y := 2; *) y := 1;", "a comment within a comment"),
    "a nested comment of another kind": ("(* /* inner */ *) y := 1;", "a comment within a comment"),
    "an open comment": ("y := 1; /* inner", "begins a comment that does not end"),
    "a write to the loop variable": ("FOR y := 1 TO 3 DO y := 5; END_FOR", "writes its control variable y"),
    "a loop from no number": (
        "FOR y := FALSE TO 3 DO ; END_FOR",
        "kind int is needed here, and this is BOOL",
    ),
    "a shift by all bits": ("VAR w : WORD; END_VAR w := SHR(w, 16);", "SHR of WORD by 16: compilers differ"),
    "a conversion of more": (
        "VAR d : DINT; END_VAR y := WORD_TO_INT(INT_TO_WORD(d));",
        "INT_TO_WORD of a DINT",
    ),
    "numbers with and without sign": (
        "VAR u : UINT; END_VAR y := x + u;",
        "+ of INT and UINT: compilers differ",
    ),
    "an input given twice": ("VAR t : TON; END_VAR t(IN := TRUE, in := FALSE);", "IN of TON is given twice"),
    "a timer for one scan": ("VAR_TEMP t : TON; END_VAR y := 1;", "t: an instance of a block belongs in VAR"),
    "a timer of another": ("VAR_INPUT t : TON; END_VAR y := 1;", "t: an instance of a block belongs in VAR"),
    "too many first values": (
        "VAR a : ARRAY [0..3] OF INT := [999999999(1)]; END_VAR y := 1;",
        "999999999 times: 1 to 1,000 are possible",
    ),
    "fewer than no first values": (
        "VAR a : ARRAY [0..3] OF INT := [0(1), 2]; END_VAR y := 1;",
        "0 times: 1 to 1,000 are possible",
    ),
    "a label of another enumeration": (
        "VAR s : (Red, Green); t : (Green, Red, Blue); END_VAR CASE t OF Green: y := 1; END_CASE",
        "Green: which enumeration is meant?",
    ),
    "a member that stands twice": (
        "VAR s : (Red, RED); END_VAR y := 1;",
        "two members of an enumeration with one name",
    ),
    "a missing end": ("y := x", "';' is missing"),
}
LENT = "FUNCTION_BLOCK L VAR_IN_OUT z : INT; END_VAR VAR_OUTPUT o : INT; END_VAR z := 9; END_FUNCTION_BLOCK "
TYPES = {
    "two types of one name": ("TYPE T : (Red, Green); END_TYPE TYPE t : INT; END_TYPE", "with the name t"),
    "a type named like ours": ("TYPE INT : (Red, Green); END_TYPE", "another type with the name INT"),
    "a type named like a block": ("TYPE TON : (Red, Green); END_TYPE", "another type with the name TON"),
}


def refusal(text: str) -> str:
    """The line that refuses a text."""
    with pytest.raises(Unjudged) as caught:
        source = Source({unit.name.upper(): unit for unit in read_text(text, "b.st")}, {"b.st": ""})
        check(source, source.units["B"])
    return caught.value.message


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_supported_is_refused(name: str) -> None:
    body, cause = REFUSED[name]
    said = refusal(HEAD + body + END)
    assert cause in said and said.startswith(("b.st:3:", "b.st:1: B calls"))


def test_a_type_and_an_instance_of_one_name_are_refused() -> None:
    types = "TYPE T : (Q1, R); END_TYPE "
    said = refusal(f"{types}{HEAD}VAR t : SR; z : T; END_VAR z := T.Q1;{END}")
    assert said == "b.st:3: T is a type and an instance; rename one"


@pytest.mark.parametrize("name", TYPES)
def test_a_type_that_would_be_read_wrongly_is_refused(name: str) -> None:
    text, cause = TYPES[name]
    said = refusal(f"{text}\n{HEAD}y := 1;{END}")
    assert cause in said and said.startswith("b.st:1:")


TWICE = (
    "FUNCTION_BLOCK B{0} VAR_OUTPUT o : INT; END_VAR VAR x, y : B{1}; END_VAR {2} END_FUNCTION_BLOCK "
    "FUNCTION F{0} : INT VAR_INPUT v : INT; END_VAR F{0} := F{1}(v) + F{1}(v); END_FUNCTION "
)
LAST = (
    "FUNCTION_BLOCK B18 VAR_OUTPUT o : INT; END_VAR o := 1; END_FUNCTION_BLOCK "
    "FUNCTION F18 : INT VAR_INPUT v : INT; END_VAR F18 := v; END_FUNCTION "
)


@pytest.mark.parametrize(
    ("body", "calls", "cause"),
    [
        ("WHILE x > 0 DO " * 6 + "y := 1;" + "END_WHILE " * 6, "", "statements in a scan"),
        ("FOR y := 0 TO 999 DO FOR z := 0 TO 999 DO ; END_FOR END_FOR", "", "1,002,001 statements in a scan"),
        ("b();", "x(); y();", "statements in a scan"),
        ("y := 1;", "o := 1;", "instances of blocks; at most 20,000"),
        ("y := F0(x);", "o := 1;", "statements in a scan"),
    ],
)
def test_a_scan_without_end_is_refused_at_once(body: str, calls: str, cause: str) -> None:
    below = "".join(TWICE.format(n, n + 1, calls) for n in range(18)) + LAST if calls else ""
    declared = "VAR z : INT; b : B0; END_VAR " if calls else "VAR z : INT; END_VAR "
    assert cause in refusal(below + HEAD + declared + body + END)


def test_comments_without_end_are_refused_at_once() -> None:
    assert refusal(HEAD + "y := 1;\n" + "(*" * 400_000) == "b.st:4: (* begins a comment that does not end"


def test_what_is_too_deep_is_refused_in_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "b.st"
    path.write_text(HEAD + "y := " + " + ".join(["x"] * 1500) + ";" + END, "utf-8")
    assert main(["prove-program", str(path), "--target", "sf_edm"]) == 2
    said = capsys.readouterr().err
    assert "b.st: an expression, or a list of ELSIF, CASE or RETURN, is too long" in said


def test_a_loop_that_lends_its_variable_is_refused() -> None:
    body = "VAR l : L; i : INT; END_VAR FOR i := 1 TO 3 DO l(z := i); END_FOR"
    assert "the loop writes its control variable i" in refusal(LENT + HEAD + body + END)


def test_a_skipped_statement_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    from programs.readers.structured_text import units as st

    monkeypatch.setattr(st._Reader, "body", lambda self, nodes: ())
    assert "0 of 1 statements were read" in refusal(HEAD + "y := x;" + END)


def test_times_are_exact_milliseconds() -> None:
    place = Place("b.st", 1)
    assert time_ms("T#1h2m3.5s", place) == 3_723_500
    assert time_ms("TIME#-4.35s", place) == -4350
    for text in ("T#1us", "T#0.5ms", "T#5", "T#s"):
        with pytest.raises(Unjudged):
            time_ms(text, place)


@pytest.mark.parametrize(
    ("arguments", "cause"),
    [
        (["nothing.st"], "nothing.st: cannot be read"),
        (["--target", "sf_emd"], "did you mean 'sf_edm'"),
        (["--unit", "SF_EMD"], "no unit 'SF_EMD'"),
        (["--binding", "no.toml"], "no.toml: cannot be read"),
    ],
)
def test_the_command_says_what_is_missing(
    arguments: list[str], cause: str, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [] if arguments[0].endswith(".st") else ["examples/st/sf_edm.st"]
    target = [] if "--target" in arguments else ["--target", "sf_edm"]
    place = Path(__file__).parents[3]
    paths = [str(place / one) if one.endswith(".st") else one for one in (*given, *arguments)]
    assert main(["prove-program", *paths, *target]) == 2
    said = capsys.readouterr()
    assert cause in said.err and said.err.count("\n") == 1 and said.out == ""

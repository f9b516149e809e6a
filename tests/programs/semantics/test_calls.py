"""FUNCTIONs of a program's own, and variables that are lent to a block."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.semantics.interpreter_expressions import Overflow
from tests.programs.semantics.test_semantics_edges import Scans, rows

ADD = """FUNCTION Add2 : INT
VAR_INPUT a, b : INT; END_VAR VAR t : INT := 3; END_VAR
IF a > 5 THEN Add2 := 7; RETURN; END_IF
t := t + a; Add2 := t + b;
END_FUNCTION"""
BUMP = """FUNCTION_BLOCK Bump
VAR_INPUT by : INT; END_VAR VAR_IN_OUT z : INT; END_VAR VAR_OUTPUT old : INT; END_VAR
old := z; z := z + by; END_FUNCTION_BLOCK"""


def test_a_function_begins_anew_in_each_call() -> None:
    declared, body = "VAR_OUTPUT y : INT; END_VAR", "y := Add2(x, 4) + Add2(b := Add2(1, 0), a := x / 2);"
    given: Scans = [(1, {"x": x}) for x in (2, 2, 20)]
    assert rows(declared, body, given, more=ADD) == [17, 17, 14]


def test_a_function_stops_where_it_leaves_its_type() -> None:
    with pytest.raises(Overflow, match="outside INT"):
        rows("VAR_OUTPUT y : INT; END_VAR", "y := Add2(1, x);", [(1, {"x": 32767})], more=ADD)


def test_a_lent_variable_is_changed() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR b, c : Bump; v : INT := 1; END_VAR"
    body = "b(z := v, by := 2); IF in THEN c(by := x, z := v); END_IF y := 10 * v + b.old;"
    assert rows(declared, body, [(1, {}), (1, {"in": True, "x": 4})], more=BUMP) == [31, 93]


@pytest.mark.parametrize(
    ("body", "cause"),
    [
        ("y := Add2(x);", "the arguments of Add2 are a, b"),
        ("y := Add2(a := x, c := x);", "the arguments of Add2 are a, b"),
        ("y := Add2(in, x);", "a of Add2 is of another type"),
        ("y := Loop(x);", "Loop calls Loop"),
        ("y := Kept(x);", "e: a FUNCTION has plain variables here"),
        ("b(by := 1);", "z of Bump is VAR_IN_OUT: give it a single variable"),
        ("b(z := x + 1);", "give it a single variable"),
        ("b(z := x);", "x is an input and is written"),
        ("b(z := d);", "z of Bump is of another type"),
        ("two(p := v, q := v);", "two VAR_IN_OUT of Two are the same variable"),
        ("y := b.z;", "Bump has no z"),
    ],
)
def test_what_is_lent_or_called_wrongly_is_refused(body: str, cause: str) -> None:
    more = f"""{ADD}
{BUMP}
FUNCTION Loop : INT VAR_INPUT a : INT; END_VAR Loop := Loop(a); END_FUNCTION
FUNCTION Kept : INT VAR_INPUT a : INT; END_VAR VAR e : R_TRIG; END_VAR Kept := a; END_FUNCTION
FUNCTION_BLOCK Two VAR_IN_OUT p, q : INT; END_VAR p := q; END_FUNCTION_BLOCK"""
    declared = "VAR_OUTPUT y : INT; END_VAR VAR b : Bump; two : Two; v : INT; d : DINT; END_VAR"
    with pytest.raises(Unjudged, match=cause.replace("(", r"\(")):
        rows(declared, body, [], more=more)


@pytest.mark.parametrize(
    ("write", "pin"),
    [
        ("IF in THEN T.q := FALSE; END_IF", "q"),
        ("t.Q := in;", "Q"),
        ("r.Q := in;", "Q"),
        ("rs.Q1 := in;", "Q1"),
        ("b.old := x;", "old"),
        ("w.rows[1] := x;", "rows"),
        ("r(CLK := in, Q => rs.Q1);", "Q1"),
    ],
)
def test_an_output_of_a_block_is_never_written_from_outside(write: str, pin: str) -> None:
    more = f"""{BUMP}
FUNCTION_BLOCK Wide VAR_OUTPUT rows : ARRAY [1..2] OF INT; END_VAR rows[1] := 1; END_FUNCTION_BLOCK"""
    declared = """VAR_OUTPUT y : INT; END_VAR
VAR b : Bump; w : Wide; r : R_TRIG; rs : RS; t : TON; END_VAR"""
    with pytest.raises(Unjudged, match=rf":\d+: {pin} is an output of a block and is written"):
        rows(declared, write, [], more=more)


@pytest.mark.parametrize(
    ("asked", "block", "pin"), [("--property", "SF_EDM", "Error"), ("--target", "R_TRIG", "Q")]
)
def test_no_proof_of_a_program_that_overwrites_an_output(
    asked: str, block: str, pin: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, question = tmp_path / "b.st", tmp_path / "q.toml"
    path.write_text(
        f"""PROGRAM M VAR_INPUT Start : BOOL; END_VAR VAR_OUTPUT S_Drive : BOOL; END_VAR
VAR edm : {block}; END_VAR
edm(); S_Drive := Start;
IF S_Drive THEN edm.{pin} := FALSE; END_IF;
END_PROGRAM""",
        "utf-8",
    )
    question.write_text(
        """scan_time_ms = [5, 50]
[[property]]
id = "stops"
sentence = "No drive with an error."
never = "S_Drive AND edm.Error"
""",
        "utf-8",
    )
    given = str(question) if asked == "--property" else "sf_edm"
    assert main(["prove-program", str(path), asked, given]) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert f"{path}:4: {pin} is an output of a block and is written" in said.err


def test_an_input_may_be_written_before_the_call() -> None:
    declared = "VAR_OUTPUT y : BOOL; END_VAR VAR r : R_TRIG; END_VAR"
    assert rows(declared, "r.CLK := in; r(); y := r.Q;", [(1, {}), (1, {"in": True})]) == [False, True]

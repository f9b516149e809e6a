"""The trial with a public collection: its specifications are read as they are meant."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.programs.composed import Specification, as_iec, judge, specifications

LIBRARY = """NAMESPACE LibX
FUNCTION_BLOCK SF_Hold
VAR_INPUT
  Activate : BOOL;
  S_In : SAFEBOOL;
END_VAR
VAR_OUTPUT S_Out : BOOL; END_VAR
VAR on : TONX; END_VAR
  on(IN := S_In, PT := T#10ms);
  S_Out := Activate AND on.Q;
END_FUNCTION_BLOCK
END_NAMESPACE"""
PROGRAM = """PROGRAM Two
USING LibX;
VAR_INPUT a, b : BOOL; END_VAR
VAR_OUTPUT both, late : BOOL; END_VAR
VAR SF_one : SF_HoldX; SF_two : SF_HoldX; END_VAR
  late := SF_two.S_Out;
  SF_one(TRUE, a);
  SF_two(b, a);
  both := SF_one.S_Out AND SF_two.S_Out;
END_PROGRAM"""


@pytest.mark.parametrize(
    ("formula", "word", "scans"),
    [
        ("AG (SF_two.S_Out => SF_one.S_Out)", "PROVED", 0),
        ("AG (SF_two.S_Out => b & a)", "PROVED", 0),
        ("AG (!late | SF_two.S_Out)", "REFUTED", 3),  # `late` is one scan old
        ("EF (both & !late)", "REFUTED", 2),
        ("EF (both & !a)", "PROVED", 0),
        ("AG (both + late <= 1)", "REFUTED", 3),
        ("AG (SF_one.S_Out & !SF_one.S_Out => a)", "EMPTY", 0),
    ],
)
def test_a_specification_gets_the_verdict_it_means(
    formula: str, word: str, scans: int, tmp_path: Path
) -> None:
    (tmp_path / "plcopen.st").write_text(LIBRARY, "utf-8")
    (tmp_path / "two.st").write_text(PROGRAM, "utf-8")
    (tmp_path / "one.spec").write_text(f"file:two.st\nmain:LibX.Two\nformula:{formula}\nbound:4\n", "utf-8")
    (of,) = specifications(tmp_path)
    assert of == Specification("two.st", "Two", formula, 4) and of.reachable == formula.startswith("EF")
    found, _ = judge(of, tmp_path, 20)
    assert (found.word, len(found.trace.scans) if found.trace else 0) == (word, scans)


def test_a_sum_of_flags_counts_them() -> None:
    assert as_iec("IF (a + b.c > 1) THEN") == "IF (BOOL_TO_INT(a) + BOOL_TO_INT(b.c) > 1) THEN"
    assert as_iec("x := y;") == "x := y;"

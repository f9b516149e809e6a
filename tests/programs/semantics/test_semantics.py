"""What one scan of a program does: by the interpreter, and by the translator against it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from tests.programs.fuzz import difference_of_text, source_of

KITCHEN = Path(__file__).with_name("kitchen.st")


def machine(declared: str, body: str, wrap: bool = False) -> Machine:
    """A block with the input `x : INT; in : BOOL` and these further variables."""
    text = (
        f"FUNCTION_BLOCK B\nVAR_INPUT x : INT; in : BOOL; END_VAR\n{declared}\n{body}\nEND_FUNCTION_BLOCK\n"
    )
    source = source_of(text)
    check(source, source.main())
    return Machine(source, source.main(), wrap)


def outputs_of(declared: str, body: str, scans: list[tuple[int, dict[str, Any]]]) -> list[Any]:
    """The output `y` after each scan."""
    of = machine(declared, body)
    return [of.scan(inputs, dt_ms)["y"] for dt_ms, inputs in scans]


def timed(block: str, pattern: str, pin: str = "Q") -> list[Any]:
    """The pin of a timer of 20 ms, called every 10 ms with IN by the pattern."""
    kind = "BOOL" if pin == "Q" else "TIME"
    declared = f"VAR_OUTPUT y : {kind}; END_VAR VAR t : {block}; END_VAR"
    body = f"t(IN := in, PT := T#20ms); y := t.{pin};"
    return outputs_of(declared, body, [(10, {"in": one == "1"}) for one in pattern])


def row(text: str) -> list[bool]:
    """A row of booleans."""
    return [one == "1" for one in text]


def test_a_ton_is_on_after_its_time() -> None:
    assert timed("TON", "0111101110") == row("0001100010")
    assert timed("TON", "0111101110", "ET") == [0, 0, 10, 20, 20, 0, 0, 10, 20, 0]


def test_a_tof_stays_on_for_its_time() -> None:
    assert timed("TOF", "0011000100110") == row("0011110111111")
    assert timed("TOF", "0011000", "ET") == [0, 0, 0, 0, 0, 10, 20]


def test_a_tp_gives_one_pulse_of_its_length() -> None:
    assert timed("TP", "0111110100") == row("0110000110")
    assert timed("TP", "0111110", "ET") == [0, 0, 10, 20, 20, 20, 0]


def test_time_stands_still_within_a_scan() -> None:
    declared = "VAR_OUTPUT y : TIME; END_VAR VAR t : TON; END_VAR"
    body = "t(IN := in, PT := T#1s); t(IN := in, PT := T#1s); y := t.ET;"
    assert outputs_of(declared, body, [(10, {"in": True})] * 3) == [0, 10, 20]


def test_division_rounds_towards_zero() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR"
    assert outputs_of(declared, "y := x / 2;", [(1, {"x": -7}), (1, {"x": 7})]) == [-3, 3]
    assert outputs_of(declared, "y := x MOD 2;", [(1, {"x": -7}), (1, {"x": 7})]) == [-1, 1]


@pytest.mark.parametrize(
    ("declared", "body", "cause"),
    [
        ("", "y := 1 / x;", "division by zero"),
        ("", "y := x - 32767 - 2;", "outside INT"),
        ("VAR a : ARRAY [1..3] OF INT; END_VAR", "y := a[x];", "index 0 is outside 1..3"),
        ("VAR d : DWORD := 16#FFFFFFFF; END_VAR", "y := DWORD_TO_INT(d);", "outside INT"),
    ],
)
def test_what_leaves_its_type_stops_the_run(declared: str, body: str, cause: str) -> None:
    of = machine(f"VAR_OUTPUT y : INT; END_VAR {declared}", body)
    with pytest.raises(Overflow, match=cause):
        of.scan({"x": 0, "in": False}, 1)


def test_numbers_wrap_where_they_may() -> None:
    of = machine("VAR_OUTPUT y : INT; END_VAR", "y := x + 1;", wrap=True)
    assert of.scan({"x": 32767, "in": False}, 1) == {"y": -32768}


def test_temporary_variables_begin_anew() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR_TEMP z : INT := 4; END_VAR"
    assert outputs_of(declared, "z := z + 1; y := z;", [(1, {})] * 2) == [5, 5]


def test_variables_without_a_value_begin_at_zero() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR z : INT; w : INT := 3; END_VAR"
    assert outputs_of(declared, "y := z + w; z := 1;", [(1, {})] * 2) == [3, 4]


def test_return_ends_the_call() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR"
    body = "y := 1; IF in THEN RETURN; END_IF y := 2;"
    assert outputs_of(declared, body, [(1, {"in": True}), (1, {"in": False})]) == [1, 2]


# ---------------------------------------------------------------- against the translator


def test_translator_agrees_with_the_interpreter() -> None:
    assert difference_of_text(KITCHEN.read_text("utf-8"), 1, 300) == ""


@pytest.mark.deep
@pytest.mark.parametrize("wrap", [pytest.param(False, marks=pytest.mark.long), True])
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_translator_agrees_over_many_random_scans(seed: int, wrap: bool) -> None:
    assert difference_of_text(KITCHEN.read_text("utf-8"), seed, 1500, wrap) == ""


def test_another_timer_edge_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    from programs.semantics import terms
    from programs.semantics import translator as symbolic

    right = terms.standard_call

    def wrong(block: str, path: str, env: dict[str, Any]) -> None:
        right(block, path, env)
        if block == "TON":
            env[f"{path}.Q"] = z3.And(env[f"{path}.IN"], env[f"{path}.age"] > env[f"{path}.PT"])

    monkeypatch.setattr(symbolic, "standard_call", wrong)
    assert " is True, the term gives False" in difference_of_text(KITCHEN.read_text("utf-8"), 1, 60)


def test_a_loop_that_leaves_its_type_is_refused() -> None:
    with pytest.raises(Unjudged, match="4: 256 is outside USINT"):
        machine("VAR_OUTPUT y : INT; END_VAR VAR i : USINT; END_VAR", "FOR i := 0 TO 255 DO y := 1; END_FOR")

"""A wiring with function blocks of a user: judged by their source, and refused where that does not do."""

from __future__ import annotations

from pathlib import Path

import pytest

from machines.wiring import read_wiring
from modeproof.cli import main
from modeproof.ground.errors import Unjudged

WIRING, BLOCKS, SAFETY, USE = FILES = [
    f"two_hand_{name}" for name in ("press.toml", "blocks.st", "safety.toml", "use.toml")
]
PRESS = [WIRING, "--properties", SAFETY, "--use", USE]


@pytest.fixture
def press(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The press with a two-hand control, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    assert main(["example", *FILES]) == 0
    return tmp_path


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text("utf-8")
    assert text.count(old) == 1, old
    path.write_text(text.replace(old, new), "utf-8")


def test_a_machine_with_own_blocks_is_proved(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", *PRESS]) == 0
    said = capsys.readouterr().out
    assert said.count("\nPROVED: ") == 6 and f"  program     {BLOCKS}\n" in said


WRONG = {
    "both-hands": ("S_BothHands := released AND Left AND Right;", "S_BothHands := released AND Left;"),
    "emergency-stop": ("IF NOT S_Channel1 OR NOT S_Channel2 THEN", "IF NOT S_Channel1 THEN"),
    "reset-after-stop": ("ELSIF edge.Q THEN", "ELSE"),
    "again-with-both-hands": (" OR (S_BothHands AND NOT (Left AND Right))", ""),
}


@pytest.mark.sampled
@pytest.mark.parametrize(
    "broken", [pytest.param(one, marks=[pytest.mark.long] * (at > 1)) for at, one in enumerate(WRONG)]
)
def test_a_fault_in_an_own_block_is_refuted(
    broken: str, press: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(press / BLOCKS, *WRONG[broken])
    assert main(["machine", *PRESS]) == 1
    said = capsys.readouterr().out
    assert f"\nREFUTED: {broken}: " in said and "scan 1" in said


@pytest.mark.deep
def test_the_program_that_is_written_is_read_again(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", *PRESS, "--program", "made.st"]) == 0
    asked = (press / SAFETY).read_text("utf-8")
    parts = [part for part in asked.split("[[property]]") if 'id = "stroke-ends"' not in part]
    (press / SAFETY).write_text("[[property]]".join(parts), "utf-8")  # it names a standard block
    assert main(["machine", *PRESS, "--source", "made.st", BLOCKS]) == 0
    assert capsys.readouterr().out.count("\nPROVED: ") == 5


BLOCK = "two_hand_blocks.st:TWO_HAND"
REFUSED = {
    "blocks.st has no function block TWO_HANDS; did you mean 'TWO_HAND'?": (
        WIRING,
        BLOCK,
        "two_hand_blocks.st:TWO_HANDS",
    ),
    "none.st: ": (WIRING, BLOCK, "none.st:TWO_HAND"),
    "SF_EDM is the name of a document's block": (BLOCKS, "BLOCK TWO_HAND", "BLOCK SF_EDM"),
    "has no input 'Left'": (BLOCKS, "Left : BOOL;", "Lefty : BOOL;"),
    "a block of a wiring has no VAR_IN_OUT": (
        BLOCKS,
        "VAR\n    alone",
        "VAR_IN_OUT x : BOOL; END_VAR VAR\n    alone",
    ),
    "parameters.Together: a parameter without a value": (WIRING, "parameters.Together = 300\n", ""),
    "parameters.Together: a time in whole ms, not True": (WIRING, "Together = 300", "Together = true"),
    "blocks.st:": (BLOCKS, "released := TRUE;", "released := ;"),
}


@pytest.mark.parametrize("said", REFUSED)
def test_an_own_block_that_does_not_fit_is_refused(said: str, press: Path) -> None:
    file, old, new = REFUSED[said]
    if "without a value" in said:
        change(press / BLOCKS, " := T#500ms", "")
    change(press / file, old, new)
    with pytest.raises(Unjudged) as refused:
        read_wiring(Path(WIRING))
    assert said in refused.value.message and "\n" not in refused.value.message


@pytest.mark.parametrize("option", ["--model", "--tlc", "--vectors", "--trial"])
def test_what_needs_the_reference_is_refused(
    option: str, press: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [option] if option in ("--trial", "--tlc") else [option, "made"]
    assert main(["machine", *PRESS, *words]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said[-1].startswith(f"modeproof: {WIRING}: ")
    assert said[-1].endswith("emergency, hands, stroke: known here by source alone")
    assert not (press / "made").exists()


def test_an_own_block_without_a_question_is_named(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", WIRING, "--use", USE]) == 2
    said = capsys.readouterr().out
    assert "NOT ASKED: block hands" in said and "NOT ASKED: block emergency" in said


def test_every_standard_block_may_be_used(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change(press / WIRING, 'of = "TP"', 'of = "CTU"')
    change(press / WIRING, "parameters.PT = 2000", 'inputs.R = "Reset"\nparameters.PV = 3')
    change(press / WIRING, 'inputs.IN = "safeguards_hold', 'inputs.CU = "safeguards_hold')
    assert main(["machine", *PRESS]) == 0
    assert "PROVED: stroke-ends" in capsys.readouterr().out
    change(press / WIRING, "PV = 3", "PV = 99999")
    assert main(["machine", *PRESS]) == 2
    assert "99999 is outside INT, -32768..32767" in capsys.readouterr().err

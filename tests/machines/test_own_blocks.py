"""A wiring with function blocks of a user: judged by their source, and refused where that does not do."""

from __future__ import annotations

from pathlib import Path

import pytest

from machines.wiring import read_wiring
from modeproof.cli import main
from modeproof.ground.errors import Unjudged

PRESS = ["press.toml", "--properties", "safety.toml", "--use", "use.toml"]


@pytest.fixture
def press(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The press with a two-hand control, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    files = ("press.toml", "blocks.st", "safety.toml", "use.toml")
    assert main(["example", *(f"two_hand_{name}" for name in files)]) == 0
    for name in files:
        text = (tmp_path / f"two_hand_{name}").read_text("utf-8")
        (tmp_path / name).write_text(text.replace("two_hand_blocks.st", "blocks.st"), "utf-8")
    return tmp_path


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text("utf-8")
    assert text.count(old) == 1, old
    path.write_text(text.replace(old, new), "utf-8")


def test_a_machine_with_own_blocks_is_proved(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", *PRESS]) == 0
    said = capsys.readouterr().out
    assert said.count("\nPROVED: ") == 6 and "  program     blocks.st\n" in said


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
    change(press / "blocks.st", *WRONG[broken])
    assert main(["machine", *PRESS]) == 1
    said = capsys.readouterr().out
    assert f"\nREFUTED: {broken}: " in said and "scan 1" in said


@pytest.mark.deep
def test_the_program_that_is_written_is_read_again(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", *PRESS, "--program", "made.st"]) == 0
    asked = (press / "safety.toml").read_text("utf-8")
    parts = [part for part in asked.split("[[property]]") if 'id = "stroke-ends"' not in part]
    (press / "safety.toml").write_text("[[property]]".join(parts), "utf-8")  # it names a standard block
    assert main(["machine", *PRESS, "--source", "made.st", "blocks.st"]) == 0
    assert capsys.readouterr().out.count("\nPROVED: ") == 5


BLOCK = "blocks.st:TWO_HAND"
REFUSED = {
    "blocks.st has no function block TWO_HANDS; did you mean 'TWO_HAND'?": (
        "press.toml",
        BLOCK,
        "blocks.st:TWO_HANDS",
    ),
    "none.st: ": ("press.toml", BLOCK, "none.st:TWO_HAND"),
    "SF_EDM is the name of a document's block": ("blocks.st", "BLOCK TWO_HAND", "BLOCK SF_EDM"),
    "has no input 'Left'": ("blocks.st", "Left : BOOL;", "Lefty : BOOL;"),
    "a block of a wiring has no VAR_IN_OUT": (
        "blocks.st",
        "VAR\n    alone",
        "VAR_IN_OUT x : BOOL; END_VAR VAR\n    alone",
    ),
    "parameters.Together: a parameter without a value": ("press.toml", "parameters.Together = 300\n", ""),
    "parameters.Together: a time in whole ms, not True": ("press.toml", "Together = 300", "Together = true"),
    "blocks.st:": ("blocks.st", "released := TRUE;", "released := ;"),
}


@pytest.mark.parametrize("said", REFUSED)
def test_an_own_block_that_does_not_fit_is_refused(said: str, press: Path) -> None:
    file, old, new = REFUSED[said]
    if "without a value" in said:
        change(press / "blocks.st", " := T#500ms", "")
    change(press / file, old, new)
    with pytest.raises(Unjudged) as refused:
        read_wiring(Path("press.toml"))
    assert said in refused.value.message and "\n" not in refused.value.message


@pytest.mark.parametrize("option", ["--model", "--vectors", "--trial"])
def test_what_needs_the_reference_is_refused(
    option: str, press: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [option] if option == "--trial" else [option, "made"]
    assert main(["machine", *PRESS, *words]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said[-1].startswith("modeproof: press.toml: ")
    assert said[-1].endswith("emergency, hands, stroke: known here by source alone")
    assert not (press / "made").exists()


def test_an_own_block_without_a_question_is_named(press: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "press.toml", "--use", "use.toml"]) == 2
    said = capsys.readouterr().out
    assert "NOT ASKED: block hands" in said and "NOT ASKED: block emergency" in said

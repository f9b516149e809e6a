"""A program against the one before a change: PROVED to give the same, or the scans that differ."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from programs.equality import two_programs

ROOT = Path(__file__).parents[3]
OLD = """FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
Twice := x * 2;
END_FUNCTION
FUNCTION_BLOCK Latch
VAR_INPUT set : BOOL; END_VAR
VAR_OUTPUT q : BOOL; END_VAR
q := q OR set; Seen := Seen OR q;
END_FUNCTION_BLOCK
PROGRAM Main
VAR_INPUT on, off : BOOL; n : SINT; END_VAR
VAR_OUTPUT lamp, run : BOOL; END_VAR
VAR l : Latch; t : TON; END_VAR
t(IN := on, PT := T#50ms); l(set := t.Q);
lamp := Seen; run := FALSE;
IF off THEN RETURN; END_IF
run := Twice(x := n) > 10 AND l.q;
END_PROGRAM
VAR_GLOBAL Seen : BOOL; END_VAR
"""
NEW = (
    OLD.replace("x * 2", "x + x")
    .replace("q := q OR set; Seen := Seen OR q;", "IF set THEN q := TRUE; Seen := TRUE; END_IF")
    .replace(
        "lamp := Seen; run := FALSE;\nIF off THEN RETURN; END_IF\nrun :=", "lamp := Seen;\nrun := NOT off AND"
    )
)


def judged(
    tmp_path: Path, new: str, old: str = OLD, binding: str = "", *more: str
) -> tuple[int, dict[str, Any]]:
    """The exit status, and the record."""
    out = tmp_path / "out.json"
    out.unlink(missing_ok=True)
    for name, text in (("new.st", new), ("old.st", old), ("b.toml", binding)):
        (tmp_path / name).write_text(text, "utf-8")
    given = ["prove-program", str(tmp_path / "new.st"), "--against", str(tmp_path / "old.st")]
    given += ["--json", str(out), *more] + (["--binding", str(tmp_path / "b.toml")] if binding else [])
    status = main(given)
    return status, json.loads(out.read_text("utf-8")) if out.exists() else {}


CHANGES = {
    "another form": ("", "", 0),
    "the bound of a number": ("> 10", ">= 10", 1),
    "the time": ("T#50ms", "T#60ms", 1),
    "the block below": ("Seen := TRUE", "Seen := NOT Seen", 1),
    "the function below": ("x + x", "x + x + 1", 1),
    "a global that is kept": ("VAR_GLOBAL", "VAR_GLOBAL RETAIN", 1),
    "a number that leaves its type": ("INT; END_VAR\nTwice := x", "SINT; END_VAR\nTwice := x", 1),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_proved_or_its_scans_are_shown(name: str, tmp_path: Path) -> None:
    old, new, status = CHANGES[name]
    found, record = judged(tmp_path, NEW.replace(old, new) if old else NEW)
    assert found == status and record["status"] == status
    if status:
        last = record["difference"]
        assert last["stopped"] or any(
            last["new"][-1][one] != last["old"][-1][one] for one in last["differing"]
        )
        assert all(new == old for new, old in zip(last["new"][:-1], last["old"][:-1], strict=True))


def test_a_program_that_stops_is_not_the_same(tmp_path: Path) -> None:
    status, record = judged(tmp_path, NEW.replace("n : SINT", "n : INT"), OLD.replace("n : SINT", "n : INT"))
    assert status == 1 and "outside INT" in record["difference"]["stopped"]
    changed = NEW.replace("n : SINT", "n : INT"), OLD.replace("n : SINT", "n : INT")
    assert judged(tmp_path, *changed, "", "--wrap")[0] == 0


def test_unless_names_the_scans_that_may_differ(tmp_path: Path) -> None:
    new = NEW.replace("lamp := Seen;", "lamp := Seen AND NOT off;")
    assert judged(tmp_path, new)[0] == 1
    status, record = judged(tmp_path, new, OLD, 'unless = "off"\n')
    assert status == 0 and record["unless"] == "off"
    assert judged(tmp_path, new, OLD, 'unless = "on"\n')[0] == 1
    assert judged(tmp_path, new, OLD, 'unless = "n"\n')[0] == 2


def test_an_input_may_be_taken_as_constant(tmp_path: Path) -> None:
    old = "FUNCTION_BLOCK B VAR_INPUT p : INT; END_VAR VAR_OUTPUT q : INT; END_VAR q := p; END_FUNCTION_BLOCK"
    new = old.replace("q := p;", "IF NOT s THEN q := p; s := TRUE; END_IF").replace(
        "VAR_OUTPUT", "VAR s : BOOL; END_VAR VAR_OUTPUT"
    )
    assert judged(tmp_path, new, old)[0] == 1
    assert judged(tmp_path, new, old, '[assume]\nconstant = ["p"]\n')[0] == 0


def test_all_names_that_do_not_fit_come_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    new = NEW.replace("off", "O_ff").replace("lamp", "Light").replace("n : SINT", "n : INT")
    assert judged(tmp_path, new)[0] == 2
    said = capsys.readouterr().err
    for part in ("no input off", "no input O_ff", "no output lamp", "n is INT, and SINT in the old program"):
        assert part in said
    binding = said[said.index("names = {") : said.index("}") + 1]
    assert binding == 'names = { O_ff = "off", Light = "lamp" }'
    assert judged(tmp_path, new.replace("n : INT", "n : SINT"), OLD, f"{binding}\n")[0] == 0


def test_an_output_is_left_out_only_if_that_is_said(tmp_path: Path) -> None:
    new = NEW.replace("lamp, run", "run").replace("lamp := Seen;", "")
    assert judged(tmp_path, new)[0] == 2
    status, record = judged(tmp_path, new, OLD, 'left_out = ["lamp"]\n')
    assert status == 0 and record["left_out"] == ["lamp (old)"]


def test_a_block_of_the_source_is_not_the_documents(tmp_path: Path) -> None:
    calls = "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR VAR e : SF_EDM; END_VAR\n"
    calls += "e(Activate := a, S_OutControl := TRUE, S_EDM1 := TRUE, S_EDM2 := TRUE, S_StartReset := TRUE);\n"
    calls += "q := e.S_EDM_Out;\nEND_PROGRAM\n"
    own = (ROOT / "examples" / "st" / "sf_edm.st").read_text("utf-8")
    wrong = own.replace("IF S_EDM1 AND S_EDM2 THEN", "IF FALSE THEN")
    assert judged(tmp_path, calls + wrong, calls)[0] == 1


def test_the_old_program_keeps_its_own_memory(tmp_path: Path) -> None:
    old = OLD.replace("lamp := Seen", "Seen := FALSE; lamp := Seen")
    assert judged(tmp_path, NEW, old)[0] == 1
    assert judged(tmp_path, old, old)[0] == 0


def test_a_shared_memory_would_be_noticed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(
        two_programs._Renamed, "name", lambda self, name: f"OLD_{name}" if name == "Main" else name
    )
    with pytest.raises(AssertionError):
        test_a_change_is_proved_or_its_scans_are_shown("the block below", tmp_path)


@pytest.mark.deep
def test_the_plc_is_the_same_in_two_languages() -> None:
    new, old = ROOT / "examples" / "st" / "plc.st", ROOT / "examples" / "awl" / "plc.awl"
    assert main(["prove-program", str(new), "--against", str(old)]) == 0
    wrong = ROOT / "examples" / "st" / "hmi.st"
    assert main(["prove-program", str(wrong), "--against", str(old)]) == 2

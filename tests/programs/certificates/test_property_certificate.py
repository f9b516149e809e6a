"""Certificates of properties: checked again without search, and each cheat is noticed."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.certificates.certificate_folder import NAME, digest, digest_of
from programs.certificates.recheck import recheck
from programs.invariants.induction import System, is_inductive

PROGRAM = """PROGRAM Lift
VAR_INPUT Up, Down, Stop : BOOL; END_VAR
VAR_OUTPUT Rise, Sink : BOOL; Late : BOOL; END_VAR
VAR Count : INT; Wait : TON; Step : INT; END_VAR
IF Stop THEN Rise := FALSE; Sink := FALSE;
ELSIF Up AND NOT Sink THEN Rise := TRUE;
ELSIF Down AND NOT Rise THEN Sink := TRUE;
END_IF;
IF Rise THEN Step := 2; ELSIF Sink THEN Step := 3; ELSE Step := 0; END_IF;
IF Count < 100 THEN Count := Count + 1; END_IF;
Wait(IN := Rise, PT := T#200ms);
Late := Wait.Q;
END_PROGRAM
"""
PROPERTIES = """scan_time_ms = [1, 50]

[[property]]
id = "one-way"
sentence = "It never rises and sinks together."
never = "Rise AND Sink"

[[property]]
id = "late"
sentence = "It is late after 250 ms."
after = "Rise"
within_ms = 250
holds = "Late OR NOT Rise"

[[property]]
id = "counted"
sentence = "The count stays small."
always = "Count <= 100"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A certificate of a program of three properties."""
    program, properties = tmp_path / "lift.st", tmp_path / "lift.toml"
    program.write_text(PROGRAM, "utf-8")
    properties.write_text(PROPERTIES.replace("Rise AND Sink", "Rise AND Step = 3"), "utf-8")
    given = ["prove-program", str(program), "--property", str(properties)]
    assert main([*given, "--certificate", str(tmp_path / "made")]) == 0
    return tmp_path / "made"


def record_of(folder: Path) -> Any:
    """certificate.json as it stands."""
    return json.loads((folder / NAME).read_text("utf-8"))


def keep(folder: Path, record: Any) -> None:
    """Put another record in its place."""
    (folder / NAME).write_text(json.dumps(record), "utf-8")


def test_both_solvers_show_it_again(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = recheck(folder)
    assert found.status == 0 and found.answers.files == 4 and set(found.answers.answers) == {"z3", "cvc5"}
    assert main(["prove-program", "--recheck", str(folder)]) == 0
    text = capsys.readouterr().out
    assert "PROVED, checked again: 4 properties of program Lift" in text
    assert "not empty   3 triggers; scans from power-up to each were run again" in text


def test_only_invariants_that_are_needed_are_kept(folder: Path) -> None:
    rows = {row["id"]: row["invariants"] for row in record_of(folder)["proofs"]}
    assert not any("Count" in text.upper() and "WAIT" in text.upper() for text in rows["late"])
    assert all(len(texts) <= 12 for texts in rows.values())


def test_no_certificate_unless_all_is_proved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, properties = tmp_path / "lift.st", tmp_path / "lift.toml"
    program.write_text(PROGRAM.replace("AND NOT Sink", ""), "utf-8")
    properties.write_text(PROPERTIES, "utf-8")
    given = ["prove-program", str(program), "--property", str(properties)]
    assert main([*given, "--certificate", str(tmp_path / "made")]) == 1
    assert "certificate none: not every property is PROVED" in capsys.readouterr().out
    assert not (tmp_path / "made").exists()


def drop_proof(record: Any) -> None:
    """One proof fewer."""
    record["proofs"].pop()


def other_order(record: Any) -> None:
    """A proof under the name of another property."""
    record["proofs"].reverse()


def other_invariant(record: Any) -> None:
    """An invariant that was not there."""
    record["proofs"][1]["invariants"].append("(= STEP 0)")


def no_formula(record: Any) -> None:
    """An invariant that is none."""
    record["proofs"][1]["invariants"] = ["(and"]


def unknown_symbol(record: Any) -> None:
    """An invariant over what is no memory."""
    record["proofs"][1]["invariants"] = ["(= NOTHING 0)"]


def too_deep(record: Any) -> None:
    """An induction over no scan."""
    record["proofs"][1]["scans"] = 0


def other_scans(record: Any) -> None:
    """Scans that do not lead to a trigger."""
    for way in record["proofs"][1]["reached_by"]:
        for scan in way["scans"]:
            scan["in"] = dict.fromkeys(scan["in"], False)


def too_slow(record: Any) -> None:
    """A way with a scan that is longer than any."""
    record["proofs"][1]["reached_by"][0]["scans"][0]["dt_ms"] = 51


def not_retained(record: Any) -> None:
    """A way that begins with another value than that at power-up."""
    record["proofs"][1]["reached_by"][0]["retained"] = {"RISE": True}


def no_input(record: Any) -> None:
    """A way that gives a value to an output."""
    record["proofs"][1]["reached_by"][0]["scans"][0]["in"]["RISE"] = True


def no_way(record: Any) -> None:
    """A trigger without scans."""
    record["proofs"][2]["reached_by"] = []


def other_times(record: Any) -> None:
    """Scan times that the properties do not name."""
    record["scan_time_ms"] = [1, 10]


def weaker(record: Any) -> None:
    """Another property under the same id."""
    record["asked"][1][2] = "never FALSE"


EDITS = {
    drop_proof: "not one proof for each property",
    other_order: "not the form of a certificate",
    other_invariant: "not the obligation that follows",
    no_formula: "not the form of a certificate",
    unknown_symbol: "not the form of a certificate",
    too_deep: "not the form of a certificate",
    other_scans: "do not lead there",
    too_slow: "a scan is too short or too long",
    not_retained: "is not RETAIN",
    no_input: "RISE is not, or cannot be",
    no_way: "not one way to each of its 1 triggers",
    other_times: "scan_time_ms is not what",
    weaker: "asked is not what",
}


@pytest.mark.parametrize(("edit", "cause"), EDITS.items(), ids=lambda case: getattr(case, "__name__", ""))
def test_an_edited_certificate_is_refused(edit: Callable[[Any], None], cause: str, folder: Path) -> None:
    record = record_of(folder)
    edit(record)
    keep(folder, record)
    with pytest.raises(Unjudged, match=cause):
        recheck(folder)


@pytest.mark.parametrize("name", ["lift.st", "lift.toml"])
def test_a_changed_file_is_refused(name: str, folder: Path) -> None:
    path = folder.parent / name
    path.write_text(path.read_text("utf-8") + "\n", "utf-8")
    with pytest.raises(Unjudged, match=f"{name} has changed since"):
        recheck(folder)


def test_a_wrong_program_is_not_shown(folder: Path) -> None:
    path, record = folder.parent / "lift.st", record_of(folder)
    path.write_text(path.read_text("utf-8").replace("AND NOT Sink", ""), "utf-8")
    record["sources"] = {str(path): digest(path)}
    keep(folder, record)
    with pytest.raises(Unjudged, match="not the obligation that follows"):
        recheck(folder)


def test_a_false_invariant_with_its_questions_is_not_shown(folder: Path) -> None:
    from programs.certificates import property_certificate

    record = record_of(folder)
    record["proofs"][1]["invariants"].append("(= STEP 0)")
    kept = property_certificate.Kept(folder, record)
    judgement = kept.judgement()
    owed = list(property_certificate.obligations(judgement, kept.proofs(judgement)))
    for path in folder.glob("*.smt2"):
        path.unlink()
    for part in owed:
        (folder / part.file).write_text(part.text, "utf-8")
    record["queries"] = {part.file: digest_of(part.text) for part in owed}
    keep(folder, record)
    found = recheck(folder)
    assert found.status == 1 and all("sat" in said.values() for said in found.answers.answers.values())
    assert next(iter(found.lines(0.0))).startswith("REFUSED")


def test_what_tools_do_differently_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, properties = tmp_path / "lift.st", tmp_path / "lift.toml"
    text = PROGRAM.replace("Wait : TON;", "Wait : TON; Edges : ARRAY [0..1] OF F_TRIG; Turns : CTU;")
    program.write_text(text, "utf-8")
    properties.write_text(PROPERTIES, "utf-8")
    given = ["prove-program", "--property", str(properties), "--json", str(tmp_path / "out.json")]
    main([*given, str(program)])
    assert "assumed     F_TRIG shows no edge in its first scan" in capsys.readouterr().out
    said = json.loads((tmp_path / "out.json").read_text("utf-8"))["not_shown"]
    assert sum("a tool for which this is not so" in line for line in said) == 2
    program.write_text(PROGRAM, "utf-8")
    main([*given, str(program)])
    assert "assumed" not in capsys.readouterr().out


@pytest.mark.parametrize(("start", "shown"), [(3, True), (4, False)])
def test_ranges_at_power_up_are_shown_and_not_assumed(start: int, shown: bool) -> None:
    x, true = z3.Int("X"), z3.BoolVal(True)
    system = System({"X": x}, {}, {"X": z3.IntVal(start)}, {"X": x}, true, true, x <= 3)
    assert is_inductive(system, []) is shown

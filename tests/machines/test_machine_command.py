"""`modeproof machine`: what a wiring lacks, what CI reads, and what is left where a run ends early."""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
import shlex
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

from machines.machine_command import CLAIM, DESIGN, OWN, lines_of, status, trace_lines
from machines.vectors import SUITES
from machines.verdicts import Machine, Verdict
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.kit.vectors import FILE_NAME
from programs.properties.transition_system import Asked

FOLDER = Path(__file__).parents[2] / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")


def without_the_beam() -> str:
    """The wiring of a machine that has no light beam."""
    text = re.sub(r"(?m)^(S_BeamFree|BeamTest|ResetBeam|beam|S_BeamTestOut) = \{.*\n", "", TEXT)
    text = re.sub(r"(?s)\[block\.beam\].*?(?=\[block\.enable\])", "", text)
    for old, new in (('"beam", ', ""), (', "beam"', ""), (" OR beam.Error", "")):
        text = text.replace(old, new)
    return text


def machine(tmp_path: Path, text: str, properties: Path | None = None, leave_out: bool = True) -> Machine:
    path = tmp_path / "my.toml"
    path.write_text(text, "utf-8")
    file = properties or FOLDER / "safety.toml"
    return Machine(text, str(path), file, FOLDER / "use.toml", leave_out=leave_out)


def test_a_wiring_without_a_beam_is_not_asked_about_it(tmp_path: Path) -> None:
    found = machine(tmp_path, without_the_beam())
    assert found.lacking == {}
    assert {*found.not_asked.values()} == {"no SF_TestableSafetySensor"}
    assert {*found.not_asked} == {
        *("beam-stops", "beam-stops-manual", "dark-stops-at-once", "beam-needs-reset"),
        *("sender-off-only-tested", "beam-error-stays", "reaching-is-slow", "letting-go-stops-reaching"),
    }
    assert {*found.not_asked, *(row["id"] for row in found.questions.rows)} == {
        row["id"] for row in found.every.rows
    }
    assert "beam_reset" not in found.watched.rows
    assert found.runner.cell


def test_an_observer_of_what_is_lacking_takes_its_properties_along(tmp_path: Path) -> None:
    text = TEXT.replace("ResetBeam", "ResetOpening")
    assert machine(tmp_path, text).lacking == {
        "beam-needs-reset": "ResetBeam",
        "beam-error-stays": "ResetBeam",
        "reaching-is-slow": "ResetBeam",
        "letting-go-stops-reaching": "ResetBeam",
    }


def test_the_shipped_wiring_lacks_nothing(tmp_path: Path) -> None:
    assert machine(tmp_path, TEXT).lacking == {}


PROPERTY = """[[property]]
id = "barrier"
sentence = "The barrier is shut."
hazard = "planted"
cites = ["A-02"]
holds = "Barrier"
only_if = "LA"
"""


def test_properties_without_their_signals_are_not_judged(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(PROPERTY, "utf-8")
    found = machine(tmp_path, TEXT, path)
    verdict = found.all(1)[0]
    assert (verdict.word, verdict.how) == ("NOT JUDGED", "the wiring has no 'Barrier'")
    said = "\n".join(lines_of(found, [verdict], 0.0))
    assert "NOT JUDGED: barrier: The barrier is shut." in said
    assert "0 PROVED, 0 REFUTED, 0 UNKNOWN, 1 NOT JUDGED" in said
    with pytest.raises(Unjudged, match="Barrier"):
        assert machine(tmp_path, TEXT, path, leave_out=False).asked


def verdict(word: str) -> Verdict:
    row = {"hazard": "planted <hazard>", "cites": ["A-02"]}
    return Verdict(Asked(f"is-{word.lower()}", "It is so.", "a text", None), row, word, "because", [3])


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["PROVED", "NOT JUDGED"], 2),
        (["REFUTED", "NOT JUDGED"], 1),
        (["PROVED", "PROVED"], 0),
        (["NOT JUDGED"], 2),
        ([], 2),
    ],
)
def test_what_is_not_judged_is_no_pass(words: list[str], expected: int) -> None:
    assert status([verdict(word) for word in words]) == expected


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Verdicts of each kind, without a proof."""
    found = [verdict(word) for word in ("PROVED", "REFUTED", "UNKNOWN", "NOT JUDGED")]
    monkeypatch.setattr(Machine, "all", lambda machine, *rest, **more: found)


def test_junit_has_a_case_for_each_property(
    judged: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "machine.xml"
    assert main(["machine", "--junit", str(path)]) == 1
    suites = ElementTree.parse(path).getroot()
    assert suites.get("name") == "modeproof machine"
    (suite,) = suites
    assert [suite.get(name) for name in ("tests", "failures", "errors", "skipped")] == ["4", "1", "2", "0"]
    kinds = {case.get("name"): case[-1].tag for case in suite}
    assert kinds == {
        "is-proved": "system-out",
        "is-refuted": "failure",
        "is-unknown": "error",
        "is-not judged": "error",
    }


def test_the_last_line_says_how_to_run_it_again(
    judged: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my cell.toml"
    mine.write_text(TEXT, "utf-8")
    used = shlex.quote(str(FOLDER / "use.toml"))
    main(["machine", str(mine), "--use", str(FOLDER / "use.toml"), "--recheck"])
    last = capsys.readouterr().out.splitlines()[-1]
    assert last == f"  again       modeproof machine '{mine}' --use {used} --recheck"


def test_progress_is_on_standard_error_and_can_be_left_out(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def slow(machine: Machine, *rest: object, **more: object) -> list[Verdict]:
        machine.tell("terms of the machine")
        return [verdict("PROVED")]

    monkeypatch.setattr(Machine, "all", slow)
    monkeypatch.setattr("modeproof.ground.progress.QUIET_SECONDS", 0.0)
    assert main(["machine"]) == 0
    said = capsys.readouterr()
    assert "machine 0 s, terms of the machine" in said.err
    assert "terms of the machine" not in said.out
    assert main(["machine", "--quiet"]) == 0
    assert "terms" not in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--json", "--junit"])
@pytest.mark.parametrize("place", ["/dev/full", "there/is/no/folder.json"])
def test_a_file_that_cannot_be_written_is_said(
    judged: None, option: str, place: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["machine", option, place, "--quiet"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"{place}: cannot be written" in said


def test_a_run_that_ends_early_keeps_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "verdicts.json"
    path.write_text("old", "utf-8")

    def killed(machine: Machine, *rest: object, **more: object) -> list[Verdict]:
        raise KeyboardInterrupt

    monkeypatch.setattr(Machine, "all", killed)
    with contextlib.suppress(KeyboardInterrupt, SystemExit):
        main(["machine", "--json", str(path), "--quiet"])
    assert path.read_text("utf-8") == "old"
    assert [one.name for one in tmp_path.iterdir()] == ["verdicts.json"]


def test_json_has_the_verdicts_of_all(judged: None, tmp_path: Path) -> None:
    path = tmp_path / "verdicts.json"
    assert main(["machine", "--json", str(path), "--quiet"]) == 1
    found = json.loads(path.read_text("utf-8"))
    assert [row["verdict"] for row in found["verdicts"]] == ["PROVED", "REFUTED", "UNKNOWN", "NOT JUDGED"]
    assert found["status"] == 1


def test_stories_of_use_leave_out_what_the_wiring_lacks(tmp_path: Path) -> None:
    told = machine(tmp_path, without_the_beam()).runner.stories()
    assert "ResetGuard" in told["begin"][0]
    assert all("S_BeamFree" not in row and "ResetBeam" not in row for rows in told.values() for row in rows)
    assert "reach through the beam" not in told
    assert len(told["begin"]) == len(machine(tmp_path, TEXT).runner.stories()["begin"])


@pytest.mark.parametrize("option", ["--evidence", "--killers"])
def test_records_of_the_project_are_made_from_its_own_files(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT, "utf-8")
    assert main(["machine", str(mine), option]) == 2
    assert "are about the project's own files" in capsys.readouterr().err


def test_scans_in_which_nothing_changes_stand_in_one_line() -> None:
    rows = [
        (5, "Start=1", ""),
        (5, "", ""),
        (5, "", ""),
        (9, "", ""),
        (9, "", "Lamp=1"),
        (9, "", ""),
        (9, "", ""),
    ]
    assert list(trace_lines(rows)) == [
        "  scan 1        after 5 ms: Start=1",
        "  scans 2-3     after 5 ms each: the same inputs",
        "  scan 4        after 9 ms: the same inputs",
        "  scan 5        after 9 ms: the same inputs",
        "                gives Lamp=1",
        "  scan 6        after 9 ms: the same inputs",
        "  wrong scan 7  after 9 ms: the same inputs",
    ]


@pytest.mark.parametrize(
    "words",
    [
        *(f"--source my.st {other}" for other in ("--model m", "--tlc unlock", "--killers", "--evidence")),
        *(f"--source my.st {other}" for other in ("--picture p", "--program p", "--vectors v")),
        *(f"--source my.st {other}" for other in ("--trial Reset", "--trial")),
        *(f"--json j {other}" for other in ("--program p", "--picture p", "--model m", "--vectors v")),
        *(f"--json j {other}" for other in ("--vectors v", "--tlc unlock", "--trial Reset", "--killers")),
        *(f"{judged} --model m" for judged in ("--junit x", "--recheck")),
        *("--evidence --json j", "--source my.st --equal --properties p.toml"),
        *("--picture p --trial Reset", "--model m --tlc unlock", "--tlc unlock --trial Reset"),
        *("--vectors v --tlc unlock", "--killers --trial Reset", "--killers --evidence"),
    ],
)
def test_an_option_without_effect_is_refused(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("machines.machine_command.run", lambda args: 0)
    monkeypatch.setattr("modeproof.lane.machine_tlc.run", lambda args: 0)
    monkeypatch.setattr("modeproof.lane.machine_command.machines", lambda place: ())
    assert main(["machine", *words.split()]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert all(f"--{name}" in said for name in re.findall(r"--(json|junit|recheck|equal)", words))
    assert list(tmp_path.iterdir()) == []


def test_files_and_vectors_of_a_wiring_go_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("machines.machine_command.run", lambda args: 0)
    words = ["--program", "a", "--picture", "b", "--model", "c", "--vectors", "d"]
    assert main(["machine", *words]) == 0
    monkeypatch.setattr("modeproof.lane.machine_command.carried_out", lambda args: SimpleNamespace(status=0))
    assert main(["machine", "--source", "my.st", "--equal", "--json", "j", "--junit", "x", "--recheck"]) == 0


@pytest.mark.parametrize(
    ("wiring", "properties", "basis"),
    [
        (False, False, OWN),
        (True, False, f"the wiring is yours; the properties are {OWN}"),
        (False, True, f"the wiring is {DESIGN}; the properties are yours; {CLAIM}"),
        (True, True, f"the wiring is yours; the properties are yours; {CLAIM}"),
    ],
)
def test_only_what_is_shipped_is_called_our_design(
    wiring: bool,
    properties: bool,
    basis: str,
    judged: None,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    mine, asked, target = (tmp_path / name for name in ("my.toml", "own.toml", "verdicts.json"))
    mine.write_text(TEXT, "utf-8")
    asked.write_text(PROPERTY.replace("Barrier", "LA"), "utf-8")
    words = [str(mine)] * wiring + ["--properties", str(asked)] * properties
    main(["machine", *words, "--json", str(target), "--quiet"])
    [said] = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  properties  ")]
    assert said.endswith(f"({'yours' if properties else DESIGN}; {CLAIM})")
    assert json.loads(target.read_text("utf-8"))["basis"] == basis


def test_json_names_the_files_that_were_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = {name: tmp_path / f"{name}.toml" for name in ("wiring", "safety", "use")}
    for name, path in files.items():
        path.write_bytes((FOLDER / f"{name}.toml").read_bytes())
    known = {str(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in files.values()}

    def written_to(machine: Machine, *rest: object, **more: object) -> list[Verdict]:
        for path in files.values():
            path.write_text("# another one\n", "utf-8")
        assert machine.every.rows
        assert machine.runner.use.story
        return [verdict("PROVED")]

    monkeypatch.setattr(Machine, "all", written_to)
    target = tmp_path / "verdicts.json"
    words = [str(files["wiring"]), "--properties", str(files["safety"]), "--use", str(files["use"])]
    assert main(["machine", *words, "--json", str(target), "--quiet"]) == 0
    found = json.loads(target.read_text("utf-8"))
    assert {**found["wiring"], **found["files"]} == known


def test_vectors_without_a_story_of_the_cell_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    use = tmp_path / "use.toml"
    use.write_text('[[story]]\nid = "other"\nfirst = true\nrow = [{ Elsewhere = true }]\n', "utf-8")
    folder = tmp_path / "vectors"
    folder.mkdir()
    for suite in SUITES:
        (folder / FILE_NAME.format(suite=suite)).write_text("kept", "utf-8")
    assert main(["machine", "--vectors", str(folder), "--use", str(use), "--quiet"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"no story of {use} concerns {FOLDER / 'wiring.toml'}" in said
    assert [path.read_text("utf-8") for path in folder.iterdir()] == ["kept"] * len(SUITES)

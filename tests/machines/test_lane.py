"""The machine in `verify`: evidence of its verdicts, what turns it red, and what is left behind."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from machines.evidence import looked_at
from machines.verdicts import Machine, Verdict
from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, machines
from modeproof.ground.progress import Progress
from modeproof.lane.machine_command import judge_machine, troubles_of_machine
from modeproof.lane.summary import machine_line
from modeproof.lane.verify import stages_of_verify, verify
from modeproof.report.evidence_judge import doubt_on_machine
from modeproof.report.verdicts import status_of, verdict_on_machine
from programs.properties.transition_system import Asked

ROOT = Path(__file__).parents[2]
NAME = "machine_cell"
KEPT = ("one-mode", "stop-stops", "unlock-held", "door-error-stays")


def proved(machine: Machine, words: dict[str, str] | None = None) -> list[Verdict]:
    """A verdict on each property, without the proof: PROVED, but for those that `words` has."""
    found = []
    for row in machine.every.rows:
        word = (words or {}).get(row["id"], "PROVED")
        scans = [(10, dict.fromkeys(machine.runner.cell.inputs, False))] * (word == "REFUTED")
        asked = Asked(row["id"], row["sentence"], "a text", None)
        found.append(Verdict(asked, row, word, "planted", [3], scans))
    return found


def judged_as(monkeypatch: pytest.MonkeyPatch, **words: str) -> None:
    """Let the proof say this; `_` in a name stands for `-`."""
    given = {name.replace("_", "-"): word for name, word in words.items()}
    monkeypatch.setattr(Machine, "all", lambda machine, *rest, **more: proved(machine, given))


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The repository with a copy of the machine and a few of its properties, so that they can be changed."""
    for folder in ("refimpl", "proofs", "programs", "machines"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    for path in (ROOT / "spec").iterdir():
        if path.name != NAME:
            (tmp_path / "spec").mkdir(exist_ok=True)
            (tmp_path / "spec" / path.name).symlink_to(path)
    shutil.copytree(ROOT / "spec" / NAME, tmp_path / "spec" / NAME)
    for file in ("safety.toml", "killers.toml"):
        path = tmp_path / "spec" / NAME / file
        head, *rows = re.split(r"(?m)^(?=\[\[(?:property\]\]|killer\.))", path.read_text("utf-8"))
        kept = [row for row in rows if any(f'= "{id}"\n' in row or f".{id}]]" in row for id in KEPT)]
        assert len(kept) == len(KEPT)
        path.write_text(head + "".join(kept), "utf-8")
    (tmp_path / "spec" / NAME / "tlc.toml").unlink()  # its runs ask for properties that are not kept
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    monkeypatch.setattr(
        "modeproof.lane.machine_command.evidence.hashes", lambda place, paths: {"x": "0" * 64}
    )
    return tmp_path


def edit(tree: Path, file: str, old: str, new: str) -> None:
    path = tree / "spec" / NAME / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), "utf-8")


def test_the_machine_is_no_document() -> None:
    assert machines(ROOT) == (NAME,)
    assert NAME not in documents(ROOT)
    assert len(documents(ROOT)) == 5


def test_the_evidence_has_verdicts_matrix_and_mistakes(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged_as(monkeypatch)
    record = judge_machine(tree, NAME)
    assert (record["verdict"], record["as_expected"], record["reason"]) == ("PROVED", True, "")
    again = evidence.read(evidence.evidence_path(tree, NAME, "machine"))
    assert again == record
    result = record["result"]
    assert next(row["mode"] for row in result["matrix"]["rows"]) == "manual"
    assert {box["id"] for box in result["picture"]["boxes"]} >= {"fplc", "guard", "beam", "enable", "edm"}
    assert {row["property"] for row in result["killers"]} == {row["id"] for row in result["verdicts"]}
    assert all(row["scans"] for row in result["killers"])
    assert machine_line(record).startswith(f"machine      {len(result['verdicts'])} of ")
    assert doubt_on_machine(record) == ""


TLC = (ROOT / "spec" / NAME / "tlc.toml").read_text("utf-8")
CONTRACT = f"""[run.keeps_contactors]
keeps = "SF_EDM"
counts = [61, 1753]
{TLC[TLC.index("[block.") :]}"""


@pytest.mark.deep
@pytest.mark.parametrize(
    ("old", "new", "verdict", "reason"),
    [
        ("61", "61", "PROVED", ""),
        ("61", "62", "DIFFERS", "run keeps_contactors: HOLDS: distinct states: 61, pinned 62"),
        ('keeps = "SF_EDM"', 'needs = "SF_EDM"', "PROVED", ""),  # it breaks its contract, as it should
        ('keeps = "SF_EDM"', 'needs = "SF_EDM"\npermits = "C!Assumes(Row, i)"', "DIFFERS", "run keeps_"),
    ],
)
def test_the_runs_of_tlc_are_part_of_the_verdict(
    tree: Path, monkeypatch: pytest.MonkeyPatch, old: str, new: str, verdict: str, reason: str
) -> None:
    judged_as(monkeypatch)
    (tree / "spec" / NAME / "tlc.toml").write_text(CONTRACT.replace(old, new), "utf-8")
    record = judge_machine(tree, NAME)
    assert (record["verdict"], record["as_expected"]) == (verdict, verdict == "PROVED")
    assert record["reason"].startswith(reason)
    assert [row["run"] for row in record["result"]["models"]] == ["keeps_contactors"]
    assert f"{int(verdict == 'PROVED')} of 1 runs of TLC as expected" in machine_line(record)
    assert record["result"]["jar_pinned"] and "2.15" in record["tools"]["tlc"]["version"]
    assert record["tools"].keys() >= {"tlc", "java", "z3", "cvc5"}


def test_a_file_that_declares_no_run_is_no_pass(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged_as(monkeypatch)
    (tree / "spec" / NAME / "tlc.toml").write_text("run = []\n", "utf-8")
    record = judge_machine(tree, NAME)
    assert (record["verdict"], record["as_expected"]) == ("UNJUDGED", False)
    assert record["reason"].endswith("tlc.toml: declares no run")


@pytest.mark.parametrize(
    ("word", "verdict", "status"),
    [("REFUTED", "REFUTED", 1), ("UNKNOWN", "UNKNOWN", 2), ("NOT JUDGED", "UNJUDGED", 2)],
)
def test_one_property_that_is_not_proved_turns_it_red(word: str, verdict: str, status: int) -> None:
    rows = [
        {"id": "a", "verdict": "PROVED", "how": "", "reached_in_scans": [1]},
        {"id": "b", "verdict": word, "how": "planted", "reached_in_scans": [1]},
    ]
    found, reason = verdict_on_machine({"verdicts": rows, "problems": []})
    assert (found, reason) == (verdict, f"b: {word}: planted")
    assert status_of({"as_expected": False, "verdict": found}) == status


@pytest.mark.parametrize(
    ("reached", "problems", "verdict"),
    [([None], [], "UNKNOWN"), ([1], ["a: it falls with nothing"], "SURVIVED")],
)
def test_a_proof_of_nothing_is_not_as_expected(
    reached: list[int | None], problems: list[str], verdict: str
) -> None:
    rows = [{"id": "a", "verdict": "PROVED", "how": "", "reached_in_scans": reached}]
    assert verdict_on_machine({"verdicts": rows, "problems": problems})[0] == verdict
    assert verdict_on_machine({"verdicts": [], "problems": []})[0] == "UNJUDGED"


def test_what_is_not_proved_always_has_a_reason() -> None:
    """Evidence without one cannot be written."""
    row = {"id": "doors", "verdict": "UNKNOWN", "how": "", "reached_in_scans": [1]}
    found = verdict_on_machine({"verdicts": [row], "problems": []})
    assert found == ("UNKNOWN", "doors: UNKNOWN: no reason is known")


@pytest.mark.deep
def test_an_edited_verdict_contradicts_its_rows(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged_as(monkeypatch, stop_stops="REFUTED")
    record = judge_machine(tree, NAME)
    assert (record["verdict"], status_of(record)) == ("REFUTED", 1)
    assert "stop-stops: REFUTED" in record["reason"]
    assert doubt_on_machine(record) == ""
    record |= {"verdict": "PROVED", "as_expected": True}
    assert "its verdicts give REFUTED" in doubt_on_machine(record)


def test_a_property_rewritten_to_true_falls_no_more(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(tree, "safety.toml", 'only_if = "NOT two_modes"', 'only_if = "NOT two_modes OR TRUE"')
    judged_as(monkeypatch)
    record = judge_machine(tree, NAME)
    assert (record["verdict"], record["as_expected"]) == ("SURVIVED", False)
    assert record["reason"].startswith("one-mode: ")
    assert "do not break the property of the edited wiring" in record["reason"]
    assert "one-mode" in troubles_of_machine(tree, NAME)


def test_a_mistake_that_breaks_the_property_is_seen_at_once(tree: Path) -> None:
    edit(tree, "wiring.toml", 'is = "fplc.MSO_0"', 'is = "fplc.MSO_0 OR fplc.MSO_1"')
    assert any(text.startswith("one-mode: ") for text in looked_at(tree / "spec" / NAME))


@pytest.mark.deep
def test_each_property_of_the_shipped_machine_falls_with_its_edit() -> None:
    assert looked_at(ROOT / "spec" / NAME) == []


def test_a_property_without_an_edit_that_breaks_it_is_named(tree: Path) -> None:
    assert troubles_of_machine(tree, NAME) == ""
    edit(tree, "killers.toml", "[[killer.stop-stops]]", "[[killer.stop-steps]]")
    found = looked_at(tree / "spec" / NAME)
    assert any(text.startswith("stop-stops: no edit of the wiring is known") for text in found)
    assert any(text.startswith("stop-steps: ") and "no such property" in text for text in found)


def test_a_wiring_that_is_refused_is_unjudged(tree: Path) -> None:
    edit(tree, "wiring.toml", 'CLK = "Start"', 'CLK = "Strat"')
    record = judge_machine(tree, NAME)
    assert (record["verdict"], status_of(record)) == ("UNJUDGED", 2)
    assert "no signal 'Strat'" in record["reason"]
    assert "no signal 'Strat'" in troubles_of_machine(tree, NAME)


def test_a_run_that_ends_early_leaves_no_evidence(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged_as(monkeypatch)
    path = evidence.write(tree, judge_machine(tree, NAME))

    def killed(machine: Machine, *rest: Any, **more: Any) -> list[Verdict]:
        raise KeyboardInterrupt

    monkeypatch.setattr(Machine, "all", killed)
    with pytest.raises(KeyboardInterrupt):
        judge_machine(tree, NAME)
    assert list(path.parent.iterdir()) == []


def test_the_command_writes_the_evidence_that_verify_writes(
    tree: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    judged_as(monkeypatch, stop_stops="UNKNOWN")
    assert main(["machine", "--evidence"]) == 2
    said = capsys.readouterr().out
    assert "NOT AS EXPECTED  stop-stops: UNKNOWN" in said
    assert evidence.read(evidence.evidence_path(tree, NAME, "machine"))["verdict"] == "UNKNOWN"


def record_of(verdict: str) -> dict[str, Any]:
    return evidence.make(
        kind="machine",
        id="machine",
        document=NAME,
        verdict=verdict,
        expected="PROVED",
        as_expected=verdict == "PROVED",
        command="modeproof machine --evidence",
        started=0.0,
        seconds=0.5,
        result={"verdicts": [{"verdict": verdict}], "killers": []},
        reason="" if verdict == "PROVED" else "planted",
    )


@pytest.mark.parametrize(("verdict", "status"), [("PROVED", 0), ("REFUTED", 1), ("UNKNOWN", 2), (None, 2)])
def test_verify_ends_with_the_verdict_on_the_machine(
    verdict: str | None, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = documents(ROOT)

    def stage(
        place: Path, names: Sequence[str], lane: str, progress: Progress
    ) -> tuple[list[dict[str, Any]], dict[str, str]]:
        made = [record_of("PROVED") | {"kind": "registers", "document": name} for name in names]
        return [*made, *([record_of(verdict)] if verdict else [])], {}

    monkeypatch.setattr("modeproof.lane.verify.property_rows", lambda place, document: [])
    monkeypatch.setattr("modeproof.lane.verify.declared_pairs", lambda place, document: {})
    found, _ = verify(ROOT, names, "full", [("proofs", stage)], Progress(quiet=True))
    said = capsys.readouterr().out
    assert found == status
    assert "== 5 documents" in said
    assert ("machine      " in said) == bool(verdict)
    assert (f"NOT AS EXPECTED  {NAME}" in said) == (verdict != "PROVED")


def test_the_machine_is_said_to_be_our_own_design() -> None:
    assert machine_line(record_of("PROVED")).endswith("machine_cell is our own design, no document")


def test_evidence_of_a_verdict_that_is_none_is_refused() -> None:
    with pytest.raises(Unjudged, match="not valid evidence"):
        evidence.write(Path("/nowhere"), record_of("PROVED") | {"verdict": "PROVEN"})


@pytest.mark.deep
def test_evidence_is_json_with_the_scans_of_each_mistake(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged_as(monkeypatch)
    judge_machine(tree, NAME)
    record = json.loads(evidence.evidence_path(tree, NAME, "machine").read_text("utf-8"))
    row = next(row for row in record["result"]["killers"] if row["property"] == "unlock-held")
    assert row["was"] == "UnlockButton"
    assert all(set(scan) == {"dt_ms", "in", "out"} for scan in row["scans"])


@pytest.mark.parametrize(
    ("lane", "names", "tasks", "troubles"),
    [
        ("full", documents(ROOT), 1, {}),
        ("full", ("edm",), 0, {}),
        ("smoke", documents(ROOT), 0, {NAME: "planted"}),
        ("smoke", ("edm",), 0, {}),
    ],
)
def test_the_full_lane_of_all_documents_has_the_machine(
    lane: str, names: Sequence[str], tasks: int, troubles: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    def prove(*_: Any, beside: list[Any], on_beside: Any, **__: Any) -> tuple[list[Any], dict[str, str]]:
        asked.extend(task for task in beside if task[0] is judge_machine)
        for _task in asked:
            on_beside(record_of("PROVED"))
        return [], {}

    monkeypatch.setattr("modeproof.lane.verify.comparisons", lambda *_: ([], {}, []))
    monkeypatch.setattr("modeproof.lane.verify.prove_documents", prove)
    monkeypatch.setattr("modeproof.lane.verify.troubles_of_machine", lambda *_: "planted")
    stage = dict(stages_of_verify())["proofs"]
    records, found = stage(ROOT, names, lane, Progress(quiet=True))
    assert asked == [(judge_machine, (ROOT, NAME, True))] * tasks
    assert [record["document"] for record in records] == [NAME] * tasks
    assert found == troubles

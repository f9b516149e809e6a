"""`verify` proves the demands of each page of our own reference; evidence that says less is no evidence."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, root
from modeproof.lane import demands as lane
from modeproof.lane.keep import NOTHING
from modeproof.lane.verify import stages_of_verify
from modeproof.registers.demands import load_demand_rows
from modeproof.report.demanded import doubt_on_demands, id_of, subjects
from modeproof.report.evidence_judge import contradiction
from programs.commands import reference_demands
from programs.semantics.reference import targets

Edit = Callable[[dict[str, Any]], Any]


def result() -> dict[str, Any]:
    """What evidence says where all is proved."""
    rows = load_demand_rows(root(), "edm").of["sf_edm"]
    return {
        "device": "sf_edm",
        "demands": [{"id": row.id, "word": "PROVED", "how": "induction over 1 scan"} for row in rows],
        "answers": {"files": len(rows), "other_than_unsat": {"z3": {}, "cvc5": {}}},
    }


def test_each_target_is_proved_in_each_of_its_profiles() -> None:
    named = [one for document in documents(root()) for one in subjects(root(), document)]
    assert {target for target, _ in named} == set(targets())
    assert ("sf_edm", "cautious") in named and ("plc", "letter") in named and ("plc", "cautious") not in named


def test_what_no_lane_proves_is_named_one_by_one(tmp_path: Path) -> None:
    unproved = load_demand_rows(root(), "mode_selection").unproved
    rows = load_demand_rows(root(), "mode_selection").of
    assert {*unproved} == {"fplc", "hmi"}
    assert all(0 < len(few) < len(rows[target]) / 2 for target, few in unproved.items())
    shutil.copytree(root() / "spec/edm", tmp_path / "spec/edm")
    path = tmp_path / "spec/edm/demands.toml"
    head, mark, rest = path.read_text().partition("[device.sf_edm.rules]")
    path.write_text(f'{head}[device.sf_edm.unproved]\nNoSuchDemand = "it takes long"\n\n{mark}{rest}')
    with pytest.raises(Unjudged, match="unproved: no demand 'NoSuchDemand'"):
        load_demand_rows(tmp_path, "edm")
    found = result()
    found["demands"] = [row for row in found["demands"] if row["id"] != "NoOutputInError"]
    path.write_text(f'{head}[device.sf_edm.unproved]\nNoOutputInError = "it takes long"\n\n{mark}{rest}')
    assert doubt_on_demands(tmp_path, "edm", found) == ""
    assert "it says nothing of NoOutputInError" in doubt_on_demands(root(), "edm", found)


def test_the_full_lane_has_a_task_for_each() -> None:
    tasks, kept = lane.proofs_of_demands(root(), documents(root()), NOTHING)
    assert len(tasks) == sum(len(list(subjects(root(), document))) for document in documents(root()))
    assert not kept and "proofs" in dict(stages_of_verify())


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (lambda found: None, ""),
        (lambda found: found["demands"].pop(), "it says nothing of"),
        (lambda found: found["demands"][0].update(word="UNKNOWN"), ": UNKNOWN"),
        (lambda found: found["answers"]["other_than_unsat"]["z3"].update({"001": "sat"}), "both solvers"),
        (lambda found: found["answers"]["other_than_unsat"].pop("cvc5"), "both solvers"),
        (lambda found: found["answers"].update(files=1), "both solvers"),
    ],
    ids=["whole", "one is missing", "one is open", "z3 denies", "without cvc5", "one file"],
)
def test_evidence_is_judged_by_its_figures(edit: Edit, said: str) -> None:
    found = result()
    edit(found)
    doubt = doubt_on_demands(root(), "edm", found)
    assert said in doubt and bool(said) == bool(doubt)
    record = {
        "kind": "demands",
        "as_expected": True,
        "verdict": "PROVED",
        "expected": "PROVED",
        "result": found,
    }
    document: Any = type("Document", (), {"name": "edm"})
    assert contradiction(root(), document, record) == doubt


@pytest.mark.parametrize(("status", "verdict"), [(0, "PROVED"), (1, "REFUTED"), (2, "UNKNOWN")])
def test_the_verdict_is_that_of_the_proofs(
    status: int, verdict: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    answers: Any = type(
        "A", (), {"files": 16, "answers": {"z3": {}, "cvc5": {}}, "lines": lambda self: ["no"]}
    )()
    shown: Any = type("S", (), {"status": status, "found": (), "answers": answers})()
    monkeypatch.setattr(reference_demands, "shown", lambda judgement: shown)
    monkeypatch.setattr(reference_demands, "judgement_of", lambda *given, **more: None)
    written: list[dict[str, Any]] = []
    write = evidence.write

    def elsewhere(place: Path, record: dict[str, Any]) -> None:
        write(tmp_path, record)  # which refuses what is no evidence
        written.append(record)

    monkeypatch.setattr(evidence, "write", elsewhere)
    record = lane.prove_demands(root(), "edm", "sf_edm", "letter")
    assert written == [record] and record["verdict"] == verdict and record["id"] == id_of("sf_edm", "letter")
    assert record["as_expected"] == (status == 0) and bool(record["reason"]) == bool(status)

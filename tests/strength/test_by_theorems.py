"""The campaign over shipped code, with a judge that reads the text alone: it goes on where it stopped."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.strength.by_theorems import ByTheorems
from modeproof.strength.campaign import Campaign, Judged, explanation_problems, unexplained
from modeproof.strength.code import Code
from modeproof.strength.register import load_code
from modeproof.strength.results import read_results

GATE = """
LIMIT = 2


def step(count: int) -> int:
    if count < LIMIT:
        return count + 1
    return 0
"""
REGISTER = """
[rule]
turns = [["LIMIT", "count"]]
"""
THEOREM = "from refimpl.toy import gate\n\nLIMIT = gate.LIMIT\n"


@dataclass
class Reader:
    """Stands for the room of proofs: a word in the mutated text decides what becomes of it."""

    place: Path
    verdicts: Mapping[str, str] = field(default_factory=dict)
    explored: int = 0

    def reached(self, document: str) -> Mapping[str, tuple[Path, frozenset[str]]]:
        return {"refimpl.toy.gate": (self.place / "refimpl/toy/gate.py", frozenset({"step"}))}

    def texts(self, document: str) -> Sequence[tuple[str, ...]]:
        return []

    def theorems(self, document: str) -> Mapping[str, str]:
        return {"counts": "proofs.toy.counts", "ends": "proofs.toy.ends"}

    def bench_of(self, document: str) -> Any:
        self.explored += 1
        return "bench"

    def judged(self, bench: Any, change: Mapping[str, Any], complete: bool) -> Mapping[str, Any]:
        assert bench == "bench"
        verdict = next((word for text, word in self.verdicts.items() if text in change["text"]), "KILLED")
        if verdict == "SLEEPS":
            time.sleep(600)
        if verdict == "DIES":
            os._exit(1)
        if verdict == "RAISES":
            raise ValueError("no idea")
        killed = verdict == "KILLED"
        answer = {"theorem": "counts", "result": "refuted", "where": "", "detail": "", "seconds": 0.0}
        return {
            "verdict": verdict,
            "killers": ["counts"] if killed else [],
            "reason": "",
            "witness": "",
            "answers": [answer] if killed else [],
        }


@pytest.fixture
def place(tmp_path: Path) -> Path:
    for file, text in (
        ("refimpl/toy/gate.py", GATE),
        ("proofs/toy/strength.toml", REGISTER),
        ("proofs/toy/counts.py", THEOREM),
        ("proofs/toy/ends.py", ""),
        ("proofs/toy/subjects.py", "from refimpl.toy import gate\n"),
        ("proofs/mutants/bench.py", ""),
    ):
        path = tmp_path / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def campaign_of(place: Path, reader: Reader) -> Campaign:
    return Campaign(ByTheorems(Code(place, "toy", reader)), read_results(place / "impl.jsonl"))


def run(place: Path, reader: Reader, limit_s: float = 600.0) -> tuple[Campaign, list[Judged]]:
    campaign = campaign_of(place, reader)
    campaign.judges.limit_s = limit_s
    return campaign, campaign.run(campaign.mutants, Progress(quiet=True), 2)


def test_every_mutant_is_judged_and_kept(place: Path) -> None:
    campaign, judged = run(place, Reader(place, {"count <= LIMIT": "SURVIVED", "False": "EQUIVALENT"}))
    words = {one.mutant.new: one.word for one in judged}
    assert words["count <= LIMIT"] == "SURVIVED"
    assert words["False"] == "EQUIVALENT"
    assert words["(count - 1)"] == "KILLED"
    assert len(judged) == len(campaign.mutants) == len(read_results(place / "impl.jsonl").records)
    assert [one.mutant.new for one in unexplained((), judged)] == ["count <= LIMIT"]


def test_the_whole_campaign_is_kept_as_evidence(place: Path) -> None:
    campaign, judged = run(place, Reader(place, {"count <= LIMIT": "SURVIVED"}))
    campaign.record(judged)
    found = evidence.read(evidence.evidence_path(place, "toy", "strength_impl"))
    assert (found["verdict"], found["as_expected"]) == ("SURVIVED", False)
    assert list(found["result"]["judges"])[:2] == ["counts", "ends"]
    assert "refimpl/toy/gate.py" in found["inputs"] and "proofs/toy/strength.toml" in found["inputs"]


def test_an_interrupted_campaign_goes_on_without_judging_known_mutants_again(place: Path) -> None:
    run(place, Reader(place))
    file = place / "impl.jsonl"
    lines = file.read_bytes().splitlines(keepends=True)
    file.write_bytes(b"".join(lines[:-2]) + lines[-2][:20])
    reader = Reader(place)
    campaign, judged = run(place, reader)
    assert reader.explored == 1
    assert "cut off" in campaign.results.remark
    assert len(judged) == len(lines)
    again = Reader(place)
    run(place, again)
    assert again.explored == 0


@pytest.mark.parametrize(
    ("verdict", "why"),
    [("RAISES", "ValueError: no idea"), ("DIES", "process died"), ("SLEEPS", "limit of 1 s")],
)
def test_what_cannot_be_judged_is_unmeasured_and_never_killed(place: Path, verdict: str, why: str) -> None:
    _, judged = run(place, Reader(place, {"False": verdict}), limit_s=1.0 if verdict == "SLEEPS" else 600.0)
    (one,) = [one for one in judged if one.mutant.new == "False"]
    assert one.word == "UNMEASURED"
    assert why in one.record["reason"]
    assert not one.killers


def stale(place: Path) -> set[str]:
    campaign = campaign_of(place, Reader(place))
    return {mutant.new for mutant in campaign.mutants if campaign.find(mutant) is None}


def test_a_changed_theorem_spoils_what_rests_on_it(place: Path) -> None:
    run(place, Reader(place, {"count <= LIMIT": "SURVIVED", "False": "EQUIVALENT"}))
    assert not stale(place)
    (place / "proofs/toy/ends.py").write_text("# a comment\n")
    assert not stale(place)
    (place / "proofs/toy/ends.py").write_text("X = 1\n")
    assert stale(place) == {"count <= LIMIT"}
    (place / "proofs/toy/counts.py").write_text(THEOREM + "Y = 1\n")
    assert "(count - 1)" in stale(place)
    assert "False" not in stale(place)


def test_a_changed_step_spoils_everything(place: Path) -> None:
    run(place, Reader(place))
    (place / "refimpl/toy/gate.py").write_text(GATE.replace("return 0", "return -1"))
    assert stale(place) == {mutant.new for mutant in campaign_of(place, Reader(place)).mutants}


def test_an_explanation_of_what_is_no_survivor_is_a_problem(place: Path) -> None:
    _, judged = run(place, Reader(place))
    row = f'[[survivor]]\njudge = "theorems"\nids = ["{judged[0].mutant.id}"]\n'
    row += 'kind = "harmless"\nwhy = "It does nothing."\n'
    (place / "proofs/toy/strength.toml").write_text(REGISTER + row)
    (explained,) = load_code(place, "toy").explained("theorems")
    assert explanation_problems([explained], judged, complete=True)
    assert not explanation_problems([], judged, complete=True)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("[rule]\nother = 1\n", "rule: unknown key 'other'"),
        ("x = 1\n", "unknown key 'x'"),
        ("[", "strength.toml"),
    ],
)
def test_a_register_that_is_not_understood_is_refused(place: Path, text: str, complaint: str) -> None:
    (place / "proofs/toy/strength.toml").write_text(text)
    with pytest.raises(Unjudged, match=complaint):
        load_code(place, "toy")

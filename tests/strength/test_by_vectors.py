"""The vectors judge mutants of a small program: each meets its fate, and a judge that cannot see is found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from modeproof.graph.implementation import Implementation as Implemented
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.kit.vectors import open_suite
from modeproof.strength import replay
from modeproof.strength.by_theorems import ByTheorems
from modeproof.strength.by_vectors import ByVectors
from modeproof.strength.campaign import Campaign, Judged, unexplained
from modeproof.strength.code import Code
from modeproof.strength.published import contents, published
from modeproof.strength.register import code_path, load_code
from modeproof.strength.replay import ReplayCase, Vectors
from modeproof.strength.results import Results, read_results
from proofs.mutants import copies
from tests.strength.toy_gates import GATE, PACKAGE, Room, build_place, unload, write_vectors

SHORT = [[True, False]]
LONG = [[False], [True, True, True, True, False, True]]


@pytest.fixture
def place(tmp_path: Path) -> Iterator[Path]:
    build_place(tmp_path)
    write_vectors(tmp_path / "short.jsonl", "short", SHORT)
    write_vectors(tmp_path / "long.jsonl", "long", LONG)
    yield tmp_path
    unload()


@dataclass
class Watcher:
    """Stands for the observer: nobody can tell a mutant whose text holds one of these."""

    same: tuple[str, ...] = ()
    said: str = "EQUIVALENT"
    asked: int = 0

    def bench_of(self, document: str) -> Any:
        self.asked += 1
        return "bench"

    def observe(self, bench: Any, change: Any, file: str) -> Any:
        assert bench == "bench" and Path(file).is_file()
        if any(text in change.text for text in self.same):
            return SimpleNamespace(verdict=self.said, witness="", reason="")
        return SimpleNamespace(verdict="DIFFERS", witness="somewhere", reason="")


WATCHER = Watcher()


def judges_of(
    place: Path,
    names: tuple[str, ...] = ("long", "short"),
    watcher: Watcher = WATCHER,
    limit_s: float = 600.0,
) -> ByVectors:
    suites = published([open_suite(place / f"{name}.jsonl") for name in names])
    proved = read_results(place / "impl.jsonl")
    theorems = ByTheorems(Code(place, "toy", Room(place)))
    return ByVectors(theorems, copies, watcher, suites, proved, lambda shipped: limit_s)


def campaign(
    place: Path,
    complete: bool = False,
    names: tuple[str, ...] = ("long", "short"),
    definitions: tuple[str, ...] = ("WORDS", "word"),
    limit_s: float = 600.0,
    watcher: Watcher = WATCHER,
) -> tuple[ByVectors, Results, list[Judged]]:
    judges = judges_of(place, names, watcher, limit_s)
    results = read_results(place / "vectors.jsonl")
    chosen = [one for one in judges.mutants if one.definition in definitions or not definitions]
    return judges, results, Campaign(judges, results).run(chosen, Progress(quiet=True), 2, complete)


def by_edit(judged: list[Judged], definition: str, old: str, new: str) -> Judged:
    (one,) = [
        one
        for one in judged
        if (one.mutant.definition, one.mutant.old, one.mutant.new) == (definition, old, new)
    ]
    return one


def test_each_mutant_meets_its_fate(place: Path) -> None:
    judges, _, judged = campaign(place)
    assert judges.names == ("short", "long"), "the shortest suite is asked first"
    assert len(judged) > 10

    first = by_edit(judged, "WORDS", "5", "6")
    assert (first.word, first.killers) == ("KILLED", ("short",))
    (answer,) = first.record["answers"]
    assert (answer["result"], answer["scan"], answer["scans"]) == ("differs", 1, 1)
    assert "expected Outputs(LAMP=False, MW=5)" in answer["detail"]

    later = by_edit(judged, "WORDS", "9", "10")
    assert later.killers == ("long",)
    assert [one["result"] for one in later.record["answers"]] == ["passes", "differs"]
    caught = later.record["answers"][1]
    assert (caught["scan"], caught["scans"]) == (2, 3), "the second scan of the second case"

    assert by_edit(judged, "word", "2", "3").word == "SURVIVED"


def test_a_scan_that_raises_is_a_difference(place: Path) -> None:
    _, _, judged = campaign(place)
    one = by_edit(judged, "word", "count - 1", "(count + 1)")
    assert (one.word, one.killers) == ("KILLED", ("short",))
    (answer,) = one.record["answers"]
    assert (answer["result"], answer["scan"]) == ("raises", 1)
    assert answer["detail"] == "IndexError: tuple index out of range"


def test_a_mutant_that_never_ends_is_ended_and_unmeasured(place: Path) -> None:
    build_place(place, GATE.replace("    if count >", "    while count >"))
    _, _, judged = campaign(place, definitions=("counted",), limit_s=1.0)
    endless = by_edit(judged, "counted", "count - 1", "(count + 1)")
    assert endless.word == "UNMEASURED"
    assert "limit of 1 s" in endless.record["reason"]
    assert not endless.killers


def test_a_wrong_refusal_kills_in_the_end_and_stands_apart(place: Path) -> None:
    _, _, judged = campaign(place)
    one = by_edit(judged, "word", "count <= 2", "count < 2")
    assert (one.word, one.killers) == ("KILLED", ("long",))
    assert one.record["reason"].startswith("only refuses what it must answer: ")
    assert "scan 2: GateError: count: cannot be" in one.record["reason"]
    passed, refused = one.record["answers"]
    assert (passed["result"], refused["result"], refused["refused"]) == ("passes", "refuses", 3)
    both = by_edit(judged, "word", "count <= 2", "False")
    assert [answer["suite"] for answer in both.record["answers"]] == ["short", "long"], "asked on"


class Refusal(ValueError):
    field = "press"


@pytest.mark.parametrize(
    ("presses", "result", "scan"),
    [([1, 0, 1], "refuses", 0), ([1, 0, 2], "differs", 3), ([0, 0], "refuses", 0), ([1, 1], "differs", 2)],
)
def test_a_refusal_leaves_the_memory_and_comparing_goes_on(
    presses: list[int], result: str, scan: int
) -> None:
    """The program adds what it is given, but refuses zero; it should add 1 in every scan that is not zero."""

    def step(state: int, given: int) -> tuple[int, int]:
        if given == 0:
            raise Refusal
        return state + given, state + given

    code = Implemented("adder", int, int, int, lambda params: 0, step)
    wanted = [1, 2, 2] if 0 in presses else [1, 3]
    case = ReplayCase("one", None, list(zip(presses, wanted, strict=False)))
    answer = replay.replay(Vectors("adder", "toy", [case], 0), code)
    assert (answer.result, answer.scan, answer.refused) == (result, scan, presses.count(0))


def test_what_no_suite_catches_survives_and_must_be_explained(place: Path) -> None:
    _, _, judged = campaign(place, names=("short",))
    survivor = by_edit(judged, "WORDS", "9", "10")
    assert survivor.word == "SURVIVED"
    assert survivor.mutant.id in {one.mutant.id for one in unexplained((), judged)}
    row = f'[[survivor]]\njudge = "vectors"\nids = ["{survivor.mutant.id}"]\n'
    row += 'kind = "harmless"\nwhy = "The suite is short."\n'
    code_path(place, "toy").write_text(row, encoding="utf-8")
    explained = load_code(place, "toy").explained("vectors")
    assert survivor.mutant.id not in {one.mutant.id for one in unexplained(explained, judged)}


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("x = 1\n", "unknown key 'x'"),
        ("[", "strength.toml"),
        ("survivor = 1\n", "survivor: must be a list"),
        ("suites = 'tour'\n", "suites: must be a list"),
    ],
)
def test_a_register_that_is_not_understood_is_refused(place: Path, text: str, complaint: str) -> None:
    code_path(place, "toy").write_text(text, encoding="utf-8")
    with pytest.raises(Unjudged, match=complaint):
        load_code(place, "toy")


def test_what_reaches_no_published_target_is_out_of_scope(place: Path) -> None:
    judges = judges_of(place)
    missing = set(judges.code.mutants) - set(judges.mutants)
    assert {one.module for one in missing} == {"valve"} and judges.out_of_scope == len(missing)
    assert {one.module for one in judges.mutants} == {"gate"}


# ---------------------------------------------------------------- a judge that cannot see


def test_a_judge_that_never_fails_is_found(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay, "_replay", lambda vectors, code: replay.Answer(replay.PASSES, 1))
    with pytest.raises(Unjudged, match="a fault that was planted in the last scan was not found"):
        campaign(place)


def test_a_judge_that_always_fails_is_found(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay, "_replay", lambda vectors, code: replay.Answer(replay.DIFFERS, 1))
    with pytest.raises(Unjudged, match="the shipped code itself does not pass"):
        campaign(place)


def test_vectors_that_the_shipped_code_does_not_pass_judge_nobody(tmp_path: Path) -> None:
    build_place(tmp_path, GATE.replace("WORDS = (5, 9)", "WORDS = (5, 8)"))
    write_vectors(tmp_path / "long.jsonl", "long", LONG)
    with pytest.raises(Unjudged, match="the shipped code itself does not pass"):
        campaign(tmp_path, names=("long",))
    unload()


def test_a_suite_that_compares_nothing_judges_nobody(place: Path) -> None:
    write_vectors(place / "short.jsonl", "short", SHORT, settling=True)
    with pytest.raises(Unjudged, match="no scan of the suite is compared"):
        campaign(place, names=("short",))


def test_a_scan_that_settles_is_not_compared(place: Path) -> None:
    write_vectors(place / "settling.jsonl", "settling", [[True, True], [False]], settling=True)
    text = (place / "settling.jsonl").read_text().rsplit(', "settling": true', 1)
    (place / "settling.jsonl").write_text("".join(text))
    _, _, judged = campaign(place, names=("settling",))
    assert by_edit(judged, "WORDS", "9", "10").word == "SURVIVED"


# ---------------------------------------------------------------- equivalents


def proved_equivalent(place: Path, mutant: Any) -> None:
    theorems = ByTheorems(Code(place, "toy", Room(place)))
    record = {
        "mutant": mutant.id,
        "module": mutant.module,
        "verdict": "EQUIVALENT",
        "killers": [],
        "reason": "",
        "answers": [],
        "complete": False,
        "witness": "",
        "seconds": 0.0,
    }
    record["inputs"] = theorems.stamp(record)
    read_results(place / "impl.jsonl").add(record)


def test_what_is_proved_equivalent_is_not_judged_again(place: Path) -> None:
    _, _, judged = campaign(place, names=("short",))
    survivor = by_edit(judged, "WORDS", "9", "10").mutant
    proved_equivalent(place, survivor)
    (place / "vectors.jsonl").unlink()
    _, results, judged = campaign(place, names=("short",))
    assert by_edit(judged, "WORDS", "9", "10").word == "EQUIVALENT"
    assert not results.of(survivor.id)


def test_a_proof_of_other_code_is_not_used(place: Path) -> None:
    _, _, judged = campaign(place, names=("short",))
    proved_equivalent(place, by_edit(judged, "WORDS", "9", "10").mutant)
    (place / "proofs/mutants/bench.py").write_text("X = 1\n")
    assert not judges_of(place).equivalent


def test_catching_what_is_proved_equivalent_is_a_contradiction(place: Path) -> None:
    judges = judges_of(place)
    (mutant,) = [one for one in judges.mutants if (one.definition, one.new) == ("WORDS", "10")]
    proved_equivalent(place, mutant)
    write_vectors(place / "longer.jsonl", "longer", [*LONG, *LONG[::-1]])
    with pytest.raises(Unjudged, match="one of the two judges is wrong"):
        campaign(place, complete=True, names=("short", "long", "longer"))


def test_the_longest_suite_is_not_asked_what_nobody_can_tell(place: Path) -> None:
    watcher = Watcher(same=("count <= 3",))
    _, _, judged = campaign(place, watcher=watcher)
    same = by_edit(judged, "word", "2", "3")
    assert (same.word, watcher.asked) == ("EQUIVALENT", 1)
    assert [one["suite"] for one in same.record["answers"]] == ["short"]
    told = by_edit(judged, "WORDS", "9", "10")
    assert (told.word, told.record["observed"]["witness"]) == ("KILLED", "somewhere")
    campaign(place, watcher=watcher)
    assert watcher.asked == 1, "what it said is kept"


def test_an_observer_that_is_wrong_is_found_by_a_suite(place: Path) -> None:
    watcher = Watcher(same=("WORDS = (5, 10)",))
    campaign(place, watcher=watcher)
    write_vectors(place / "longer.jsonl", "longer", [*LONG, *LONG[::-1]])
    with pytest.raises(Unjudged, match="one of the two judges is wrong"):
        campaign(place, watcher=watcher, names=("short", "long", "longer"), complete=True)


def test_what_the_observer_does_not_know_survives(place: Path) -> None:
    _, _, judged = campaign(place, watcher=Watcher(same=("count <= 3",), said="UNMEASURED"))
    assert by_edit(judged, "word", "2", "3").word == "SURVIVED"


# ---------------------------------------------------------------- going on


def test_a_cut_off_campaign_goes_on_and_known_answers_stay(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, _, before = campaign(place)
    file = place / "vectors.jsonl"
    lines = file.read_bytes().splitlines(keepends=True)
    file.write_bytes(b"".join(lines[:-3]) + lines[-3][:20])
    _, results, after = campaign(place)
    assert "cut off" in results.remark
    assert [(one.mutant.id, one.word) for one in after] == [(one.mutant.id, one.word) for one in before]

    def refuse(*anything: Any) -> Any:
        raise AssertionError("nothing is left to be judged")

    monkeypatch.setattr(replay, "replay", refuse)
    campaign(place)


def test_a_new_suite_is_asked_of_what_is_left_alone(place: Path) -> None:
    _, _, before = campaign(place, names=("short",))
    killed = {one.mutant.id for one in before if one.word == "KILLED" and not one.record["reason"]}
    assert 0 < len(killed) < len(before)
    _, results, _ = campaign(place)
    for (id, _), record in results.records.items():
        asked = [one["suite"] for one in record["answers"]]
        assert asked == (["short"] if id in killed else ["short", "long"])


def test_a_new_suite_shorter_than_the_killer_is_asked_first(place: Path) -> None:
    _, _, before = campaign(place, names=("long",))
    assert by_edit(before, "WORDS", "5", "6").killers == ("long",)
    _, _, after = campaign(place)
    assert by_edit(after, "WORDS", "5", "6").killers == ("short", "long")
    assert by_edit(after, "WORDS", "9", "10").killers == ("long",)


def test_an_answer_of_vectors_that_changed_is_not_used(place: Path) -> None:
    campaign(place)
    judges = judges_of(place)
    results = read_results(place / "vectors.jsonl")
    (mutant,) = [one for one in judges.mutants if (one.definition, one.new) == ("WORDS", "10")]
    assert [one["suite"] for one in judges.answers(results.of(mutant.id))] == ["short", "long"]
    write_vectors(place / "long.jsonl", "long", [*LONG, [True]])
    other = judges_of(place)
    assert [one["suite"] for one in other.answers(results.of(mutant.id))] == ["short"]
    assert other.find(mutant, False, results.of(mutant.id)) is None


def test_what_a_case_cites_is_not_what_it_demands(place: Path) -> None:
    path = place / "short.jsonl"
    text = path.read_text(encoding="utf-8")
    before = contents(path)
    path.write_text(text.replace('"it counts"', '"otherwise"').replace('"clauses": []', '"clauses": ["A-1"]'))
    assert contents(path) == before
    for old, new in (('"LAMP": false', '"LAMP": true'), ('"dt_ms": 10', '"dt_ms": 11'), ('"word"', '"int"')):
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")
        assert contents(path) != before
    path.write_text("", encoding="utf-8")
    with pytest.raises(Unjudged, match="cannot be read"):
        contents(path)


def test_answers_about_other_code_are_not_used(place: Path) -> None:
    campaign(place)
    (place / "toyimpl/toy/gate.py").write_text(GATE + "\nMORE = 1\n")
    results = read_results(place / "vectors.jsonl")
    assert not Campaign(judges_of(place), results).known
    (place / "toyimpl/toy/gate.py").write_text(GATE + "\n# a comment\n")
    assert Campaign(judges_of(place), results).known


def test_complete_asks_every_suite_of_every_mutant(place: Path) -> None:
    _, results, _ = campaign(place)
    assert not all(record["complete"] for record in results.records.values())
    _, results, judged = campaign(place, complete=True)
    assert all(record["complete"] for record in results.records.values())
    for one in judged:
        assert {answer["suite"] for answer in one.record["answers"]} == {"short", "long"}
    assert by_edit(judged, "WORDS", "5", "6").killers == ("short", "long")


# ---------------------------------------------------------------- the evidence


def test_the_whole_campaign_is_kept_as_evidence(place: Path) -> None:
    judges, results, judged = campaign(place, names=("short",), definitions=())
    Campaign(judges, results).record(judged)
    found = evidence.read(evidence.evidence_path(place, "toy", "strength_vectors"))
    assert (found["verdict"], found["as_expected"]) == ("SURVIVED", False), "survivors are not explained"
    assert set(found["result"]["judges"]) == {"short"} and found["result"]["judges"]["short"] > 0
    assert found["result"]["out_of_scope"] == judges.out_of_scope > 0
    assert {"short.jsonl", f"{PACKAGE}/toy/gate.py"} <= set(found["inputs"])

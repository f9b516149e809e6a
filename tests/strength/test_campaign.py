"""A campaign is taken up where it stopped, and a damaged result never passes for one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import modeproof.strength.by_properties as by_properties
from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.strength.by_properties import GRAPHS, ByProperties, rests_on
from modeproof.strength.campaign import Campaign, Judged, explanation_problems, summary, unexplained
from modeproof.strength.mutant import Mutant
from modeproof.strength.mutant_judge import Answer, Bench, Verdict
from modeproof.strength.register import Explained, Strength
from modeproof.strength.results import read_results, without_comments
from tests.strength.toy import lamp

QUIET = Progress(quiet=True)


class Judge:
    """Stands in for TLC: survivors all, and a count of who was judged; stops after so many."""

    def __init__(self, stop_after: int = 10_000) -> None:
        self.judged: list[str] = []
        self._stop_after = stop_after

    def __call__(self, bench: Bench, mutant: Mutant, complete: bool) -> Verdict:
        if len(self.judged) == self._stop_after:
            raise KeyboardInterrupt
        self.judged.append(mutant.id)
        return Verdict("SURVIVED", (Answer("alone", "clean"),), reason="differs")


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> Callable[[Judge], Judge]:
    monkeypatch.setattr(ByProperties, "prepare", lambda self, waiting, complete, jobs, tell: None)

    def use(judge: Judge) -> Judge:
        monkeypatch.setattr(by_properties, "judge", judge)
        return judge

    return use


def run(bench: Bench, chosen: tuple[Mutant, ...], path: Path, complete: bool = False) -> list[Judged]:
    return Campaign(ByProperties(bench), read_results(path)).run(chosen, QUIET, 1, complete)


def test_what_was_judged_before_an_interruption_is_not_judged_again(
    bench: Bench, every: tuple[Mutant, ...], tmp_path: Path, stand_in: Callable[[Judge], Judge]
) -> None:
    path = tmp_path / "spec.jsonl"
    first = stand_in(Judge(stop_after=3))
    with pytest.raises(KeyboardInterrupt):
        run(bench, every, path)
    second = stand_in(Judge())
    judged = run(bench, every, path)
    assert len(judged) == len(every) and len(first.judged) == 3
    assert set(first.judged).isdisjoint(second.judged)
    assert len(first.judged) + len(second.judged) == len(every)


def test_a_cut_line_is_remarked_and_its_mutant_judged_again(
    bench: Bench, every: tuple[Mutant, ...], tmp_path: Path, stand_in: Callable[[Judge], Judge]
) -> None:
    path = tmp_path / "spec.jsonl"
    last = stand_in(Judge())
    run(bench, every, path)
    path.write_bytes(path.read_bytes()[:-7])
    results = read_results(path)
    assert "the last line was cut off" in results.remark and len(results.records) == len(every) - 1
    again = stand_in(Judge())
    Campaign(ByProperties(bench), results).run(every, QUIET, 1)
    assert again.judged == last.judged[-1:]
    assert len(read_results(path).records) == len(every)


@pytest.mark.parametrize("damage", [b'{"mutant": 3\n', b"{}\n", b"[]\n", b"\xff\n"])
def test_any_other_damage_is_an_error(damage: bytes, tmp_path: Path) -> None:
    path = tmp_path / "spec.jsonl"
    path.write_bytes(damage + b"{}\n")
    with pytest.raises(Unjudged, match="line 1 is"):
        read_results(path)


def test_fewer_tiers_do_not_do_when_all_are_asked(
    bench: Bench, every: tuple[Mutant, ...], tmp_path: Path, stand_in: Callable[[Judge], Judge]
) -> None:
    path = tmp_path / "spec.jsonl"
    stand_in(Judge())
    run(bench, every[:2], path)
    whole = stand_in(Judge())
    run(bench, every[:2], path, complete=True)
    assert len(whole.judged) == 2
    less = stand_in(Judge())
    run(bench, every[:2], path)
    assert less.judged == []


def test_results_hold_for_their_texts_and_comments_do_not_matter(tmp_path: Path) -> None:
    now = ByProperties(lamp(tmp_path / "a")).stamps
    commented = lamp(tmp_path / "b")
    path = commented.folder / "Lamp.tla"
    path.write_text(path.read_text().replace("a comment", "another comment"))
    changed = lamp(tmp_path / "c")
    path = changed.folder / "LampOpen.tla"
    path.write_text(path.read_text().replace("count # 0", "count = 3"))
    assert ByProperties(commented).stamps == now != ByProperties(changed).stamps


def test_a_killed_mutant_stays_judged_when_a_later_tier_changes(tmp_path: Path) -> None:
    bench = lamp(tmp_path)
    tiers = bench.strength.tiers_of("Lamp")
    first = next(tier for tier in tiers if tier.when == "always")
    killed = {"module": "Lamp", "verdict": "KILLED", "complete": False, "answers": [{"tier": first.id}]}
    last_always = [tier.id for tier in tiers if tier.when == "always"][-1]
    assert rests_on(tiers, killed) == last_always
    assert rests_on(tiers, killed | {"verdict": "EQUIVALENT"}) == GRAPHS
    for other in ({"verdict": "SURVIVED"}, {"complete": True}):
        assert rests_on(tiers, killed | other) == tiers[-1].id
    before = ByProperties(bench)
    changed = replace(
        bench.strength,
        tiers=tuple(
            replace(tier, timeout_s=7) if tier is tiers[-1] else tier for tier in bench.strength.tiers
        ),
    )
    after = ByProperties(replace(bench, strength=changed))
    assert tiers[-1].id != last_always
    assert before.stamp(killed) == after.stamp(killed)
    assert before.stamp(killed | {"verdict": "SURVIVED"}) != after.stamp(killed | {"verdict": "SURVIVED"})
    assert before.stamp(killed | {"answers": [{"tier": "gone"}]}) == ""


def test_a_string_that_looks_like_a_comment_is_none() -> None:
    assert without_comments('A == "\\* (* x *)" \\* B\n(* C\n*) D') == 'A == "\\* (* x *)"\n D'


def survivor(every: tuple[Mutant, ...], number: int, word: str = "SURVIVED") -> Judged:
    return Judged(every[number], {"verdict": word, "killers": [], "reason": "", "answers": []})


def test_a_survivor_is_explained_or_counted_as_unexplained(every: tuple[Mutant, ...]) -> None:
    one, two = survivor(every, 0), survivor(every, 1)
    assert unexplained((Explained((every[0].id,), "harmless", "because"),), [one, two]) == [two]


def test_an_explanation_that_explains_nothing_is_an_error(every: tuple[Mutant, ...]) -> None:
    killed, left = survivor(every, 0, "KILLED"), survivor(every, 1)
    stale = Explained((every[0].id, "Lamp-00000000"), "harmless", "because")
    twice = (Explained((every[1].id,), "harmless", "a"), Explained(("Lamp-*",), "harmless", "b"))
    assert explanation_problems((stale,), [killed, left], complete=True) == [
        f"{every[0].id} is explained as a survivor and is KILLED",
        "Lamp-00000000 is explained and is no mutant",
    ]
    assert f"{every[1].id} is explained twice" in explanation_problems(twice, [left], complete=True)
    assert explanation_problems((stale,), [left], complete=False) == []


def test_a_module_without_mutants_is_refused(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(by_properties, "mutants", lambda *_: ())
    with pytest.raises(Unjudged, match="module Lamp has no mutants"):
        _ = ByProperties(bench).mutants


def test_the_register_as_read_names_the_tiers_of_a_module(bench: Bench) -> None:
    strength: Strength = bench.strength
    assert [tier.id for tier in strength.tiers_of("Lamp")] == ["alone", "graph"]


def test_the_summary_counts_what_is_no_mutant_apart(every: tuple[Mutant, ...]) -> None:
    words = ("KILLED", "KILLED", "SURVIVED", "EQUIVALENT", "INVALID")
    line = summary([survivor(every, number, word) for number, word in enumerate(words)], 1)
    assert line.startswith(
        "5 mutants: 2 KILLED, 1 EQUIVALENT, 1 SURVIVED, 1 INVALID, 0 UNMEASURED; score 2 of 3"
    )


def test_a_time_out_counts_against_the_score(every: tuple[Mutant, ...]) -> None:
    judged = [survivor(every, 0, "KILLED"), survivor(every, 1, "UNMEASURED")]
    assert "score 1 of 2 (50.0 %)" in summary(judged, 0)

"""A whole campaign becomes one piece of evidence and one row of scores.toml, and says what is missing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, root
from modeproof.registers.scores import load_scores, scores_path
from modeproof.strength.by_properties import ByProperties
from modeproof.strength.campaign import Answers, Campaign, Judged, Judges
from modeproof.strength.mutant import Edit, Mutant
from modeproof.strength.mutant_judge import Bench
from modeproof.strength.register import Explained
from modeproof.strength.results import Results
from modeproof.strength.scores import record_score, stale
from modeproof.tlc.parse_tree import Place

EXPLAINED = (Explained(("toy-3",), "harmless", "Nobody sees it."),)


def mutant(number: int) -> Mutant:
    edit = Edit(Place("toy", 1, 1, 1, 1), "b")
    return Mutant(f"toy-{number}", "toy", "step", "swap", number, "a", "b", edit)


def judged(number: int, verdict: str, *killers: str) -> Judged:
    answers = [{"suite": "brief"}, {"suite": "brief"}, {"suite": "tour"}]
    fields = {"verdict": verdict, "killers": list(killers), "reason": "", "seconds": 1.5, "answers": answers}
    return Judged(mutant(number), fields)


class Suites(Judges):
    """Two suites that have judged already."""

    what = "vectors"
    suffix = "py"
    command = "modeproof mutate impl --judge vectors --document toy"
    document = "toy"
    names = ("brief", "wp")
    tools: Mapping[str, Any] = {}
    mutants: tuple[Mutant, ...] = ()
    rests_on: Sequence[Path] = ()
    texts: Sequence[str] = ()

    def __init__(self, place: Path, every: int, explained: Sequence[Explained] = EXPLAINED) -> None:
        self.place, self.explained = place, explained
        self.register = place / "spec" / "toy" / "strength.toml"
        self.register.parent.mkdir(parents=True, exist_ok=True)
        self.register.write_text("x = 1\n")
        self.rests_on = [self.register]
        self.texts = ["spec/toy/strength.toml"]
        self.mutants = tuple(mutant(n) for n in range(every))

    def asked(self, record: Answers) -> Iterable[str]:
        return (answer["suite"] for answer in record["answers"])

    def refuse(self, *_: Any) -> Any:
        raise AssertionError("nobody is asked")

    lines_of = prepare = judge = stamp = shown = refuse


def kept(root: Path, *ones: Judged, every: int = 0, explained: tuple[Explained, ...] = EXPLAINED) -> Any:
    judges = Suites(root, every or len(ones), explained)
    Campaign(judges, Results(root / "none")).record(ones)
    return evidence.read(evidence.evidence_path(root, "toy", "strength_vectors"))


ALL = (judged(1, "KILLED", "brief"), judged(2, "EQUIVALENT"), judged(3, "SURVIVED"))


def test_a_complete_campaign_is_expected_and_names_mutants_and_judges(tmp_path: Path) -> None:
    found = kept(tmp_path, *ALL)
    assert (found["verdict"], found["as_expected"], found["seconds"]) == ("KILLED", True, 4.5)
    assert found["result"]["judges"] == {"brief": 3, "wp": 0, "tour": 3}
    assert [one["id"] for one in found["result"]["mutants"]] == ["toy-1", "toy-2", "toy-3"]
    assert found["result"]["mutants"][0]["killers"] == ["brief"]
    assert found["result"]["mutants"][2]["why"] == "Nobody sees it."


def test_a_survivor_without_an_explanation_is_not_as_expected(tmp_path: Path) -> None:
    found = kept(tmp_path, *ALL, explained=())
    assert (found["verdict"], found["as_expected"]) == ("SURVIVED", False)
    assert found["reason"] == "toy-3 survives without an explanation (1 in all)"


def test_explaining_a_killed_mutant_is_not_as_expected(tmp_path: Path) -> None:
    found = kept(tmp_path, ALL[0], judged(3, "KILLED", "brief"))
    assert (found["verdict"], found["as_expected"]) == ("KILLED", False)
    assert "toy-3 is explained as a survivor and is KILLED" in found["reason"]


def test_what_is_not_judged_is_never_a_kill(tmp_path: Path) -> None:
    found = kept(tmp_path, *ALL, every=5)
    assert (found["verdict"], found["as_expected"]) == ("UNMEASURED", False)
    assert found["reason"] == "2 of 5 mutants are not judged"
    found = kept(tmp_path, *ALL, judged(4, "UNMEASURED"))
    assert (found["verdict"], found["as_expected"]) == ("UNMEASURED", False)


def test_the_campaign_over_a_specification_says_what_it_rests_on(
    bench: Bench, every: tuple[Mutant, ...]
) -> None:
    Campaign(ByProperties(bench), Results(bench.place / "none")).record([])
    found = evidence.read(evidence.evidence_path(bench.place, bench.strength.document, "strength_spec"))
    assert (found["verdict"], found["result"]["every"]) == ("UNMEASURED", len(every))
    assert f"spec/{bench.strength.document}/strength.toml" in found["inputs"]
    assert set(found["result"]["judges"]) == {
        name for tier in bench.strength.tiers for name in tier.run.properties
    }


# ---------------------------------------------------------------- scores.toml


def recorded(root: Path, *judged: Judged, every: int = 0) -> Campaign:
    campaign = Campaign(Suites(root, every or len(judged)), Results(root / "none"))
    record_score(campaign, judged)
    return campaign


def test_a_row_of_scores_holds_the_counts_and_the_texts(tmp_path: Path) -> None:
    recorded(tmp_path, *ALL)
    (row,) = load_scores(tmp_path, "toy")
    assert (row.what, row.killed, row.equivalent, row.survived, row.survived_explained) == (
        "vectors",
        1,
        1,
        1,
        1,
    )
    assert (row.unmeasured, row.different, list(row.files)) == (0, 2, ["spec/toy/strength.toml"])
    assert stale(tmp_path, "toy") == []
    recorded(tmp_path, *ALL, judged(4, "KILLED", "wp"))
    (row,) = load_scores(tmp_path, "toy")
    assert row.killed == 2, "the row before is gone"


def test_a_part_of_a_campaign_is_no_score(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="2 mutants are not judged, so nothing is recorded"):
        recorded(tmp_path, *ALL, every=5)
    assert not scores_path(tmp_path, "toy").exists()


def test_a_row_falsely_claiming_the_present_text_is_found(tmp_path: Path) -> None:
    campaign = recorded(tmp_path, *ALL)
    register = campaign.judges.register
    register.write_text("x = 1 # a comment\n[[survivor]]\nwhy = 'only told to people'\n")
    assert stale(tmp_path, "toy") == []
    register.write_text("x = 2\n")
    (problem,) = stale(tmp_path, "toy")
    assert "campaign vectors: spec/toy/strength.toml is not what was judged; run" in problem
    place = scores_path(tmp_path, "toy")
    place.write_text(place.read_text().replace("earlier_text = false", "earlier_text = true"))
    assert stale(tmp_path, "toy") == []
    (row,) = load_scores(tmp_path, "toy")
    assert row.earlier_text
    recorded(tmp_path, *ALL)
    register.unlink()
    assert stale(tmp_path, "toy")


@pytest.mark.parametrize("text", ["[", "[[campaign]]\nwhat = 1\n", "campaign = 3\n"])
def test_a_record_that_is_not_understood_is_refused(text: str, tmp_path: Path) -> None:
    scores_path(tmp_path, "toy").parent.mkdir(parents=True)
    scores_path(tmp_path, "toy").write_text(text)
    with pytest.raises(Unjudged, match=r"scores\.toml"):
        load_scores(tmp_path, "toy")


@pytest.mark.parametrize("document", documents(root()))
def test_recorded_scores_fit_the_text_or_say_otherwise(document: str) -> None:
    rows = load_scores(root(), document)
    assert [row.what for row in rows] == ["spec", "impl", "vectors"]
    assert stale(root(), document) == []
    for row in rows:
        assert row.survived_explained == row.survived and row.killed and row.files

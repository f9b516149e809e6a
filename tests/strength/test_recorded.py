"""A whole campaign becomes one piece of evidence, and says what is missing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.strength.by_properties import ByProperties
from modeproof.strength.campaign import Answers, Campaign, Judged, Judges
from modeproof.strength.mutant import Edit, Mutant
from modeproof.strength.mutant_judge import Bench
from modeproof.strength.register import Explained
from modeproof.strength.results import Results
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

    def __init__(self, place: Path, every: int, explained: Sequence[Explained] = EXPLAINED) -> None:
        self.place, self.explained = place, explained
        self.register = place / "spec" / "toy" / "strength.toml"
        self.register.parent.mkdir(parents=True, exist_ok=True)
        self.register.write_text("x = 1\n")
        self.rests_on = [self.register]
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

"""The comparisons share the queue of the theorems. Each is made once, also where no theorem can be asked, and
one that got lost is never a pass.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress
from modeproof.lane import conformance, verify
from tests.toy_tree import toy_tree

NAMES = ["toy"]


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, list[str]]:
    """A document with one graph and no theorem; the comparisons that were made."""
    made: list[str] = []
    compare_one = conformance._one

    def counted(place: Path, run: Any, *more: Any) -> dict[str, Any]:
        made.append(run.id)
        return compare_one(place, run, *more)

    monkeypatch.setattr(conformance, "_targets", lambda place, document, lane: [])
    monkeypatch.setattr(conformance, "_one", counted)
    root = toy_tree(tmp_path, "OPEN_toy")
    (root / "spec/toy/interface.toml").write_text("")
    return root, made


def outcome(root: Path) -> dict[str, tuple[list[dict[str, Any]], dict[str, str]]]:
    """What the last two stages of verify give, by title; an error as a trouble."""
    found = {}
    for title, stage in verify.stages_of_verify()[2:]:
        try:
            found[title] = stage(root, NAMES, "smoke", Progress(quiet=True))
        except Unjudged as error:
            found[title] = [], {"toy": error.message}
    return found


def refused(why: str) -> Callable[..., Any]:
    def instead(*_: Any, **__: Any) -> Any:
        raise Unjudged(why)

    return instead


def test_the_models_are_checked_before_their_graphs_are_compared() -> None:
    assert [title for title, _ in verify.stages_of_verify()] == ["registers", "TLC", "proofs", "conformance"]


def test_a_comparison_is_made_once_in_its_own_stage(toy: tuple[Path, list[str]]) -> None:
    root, made = toy
    found = outcome(root)
    proofs, troubles = found["proofs"]
    assert proofs == [] and "toy" in troubles
    ((record,), missing) = found["conformance"]
    assert (record["kind"], record["id"], missing) == ("conformance", "refimpl_OPEN_toy", {})
    assert made == ["OPEN_toy"]


def test_comparisons_are_made_even_where_no_theorem_can_be_asked(
    toy: tuple[Path, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    root, made = toy
    monkeypatch.setattr(verify, "prove_documents", refused("planted: a process died"))
    found = outcome(root)
    assert found["proofs"] == ([], {"toy": "planted: a process died"})
    assert [record["id"] for record in found["conformance"][0]] == ["refimpl_OPEN_toy"]
    assert made == ["OPEN_toy"]


def test_a_comparison_that_the_queue_loses_is_no_pass(
    toy: tuple[Path, list[str]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    root, made = toy
    monkeypatch.setattr(verify, "prove_documents", lambda *_, **__: ([], {}))
    status, records = verify.verify(root, NAMES, "smoke", verify.stages_of_verify()[2:], Progress(quiet=True))
    assert (status, records, made) == (2, [], [])
    assert "toy, conformance: UNJUDGED: nothing was done" in capsys.readouterr().out

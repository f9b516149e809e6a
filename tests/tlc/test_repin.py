"""Pins move only with a reason, by a person, and only when nothing but the pins is wrong."""

from __future__ import annotations

import subprocess
import tomllib
from pathlib import Path

import pytest
from msgspec.structs import replace as with_values

from modeproof.ground.errors import Unjudged
from modeproof.ground.reason import ask_reason, refuse_in_ci
from modeproof.registers.runs import Run, load_runs, reasons_of
from modeproof.tlc.check import Checked
from modeproof.tlc.process import Outcome
from modeproof.tlc.repin import apply, cfg_diff, moves
from tests.tlc.outcomes import judged, outcome
from tests.toy_tree import CFGS, sha256, toy_tree


def checked(root: Path, run_id: str, found: Outcome) -> Checked:
    run: Run = next(run for run in load_runs(root, "toy") if run.id == run_id)
    text = (root / "spec/toy" / run.cfg).read_text()
    return Checked(run, judged(run, found, text), found, sha256(text), {})


def test_a_grown_count_is_shown_old_to_new_and_moved(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy", distinct=12, generated=20)
    moved = moves(root, checked(root, "MC_toy", outcome("MC_toy")))
    assert [str(move) for move in moved] == ["distinct: 12 -> 16", "generated: 20 -> 33"]
    apply(root, {"toy": {"MC_toy": moved}}, "one more state a floor")
    (run,) = load_runs(root, "toy")
    assert (run.distinct, run.generated) == (16, 33)
    text = (root / "spec/toy/runs.toml").read_text()
    assert text.startswith("# runs of the toy\n") and text.count("one more state a floor") == 1
    assert reasons_of(root, "toy")[-1].endswith(": one more state a floor")
    assert moves(root, checked(root, "MC_toy", outcome("MC_toy"))) == ()


@pytest.mark.parametrize("before", ["[]", '["one", "two"]', '[\n    "one",\n    "two",\n]'])
def test_a_reason_goes_to_the_end_of_its_list(tmp_path: Path, before: str) -> None:
    root = toy_tree(tmp_path, "MC_toy", distinct=12, generated=20)
    path = root / "spec/toy/runs.toml"
    path.write_text(f"moved = {before}\n{path.read_text()}")
    apply(root, {"toy": {"MC_toy": moves(root, checked(root, "MC_toy", outcome("MC_toy")))}}, "three")
    told = tomllib.loads(path.read_text())["moved"]
    assert told[:-1] == tomllib.loads(f"a = {before}")["a"] and told[-1].endswith(": three")


def test_missing_pins_are_added_and_nothing_else_changes(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy", "OPEN_toy")
    path = root / "spec/toy/runs.toml"
    whole = load_runs(root, "toy")
    lines = path.read_text().splitlines(keepends=True)
    kept = [
        one for one in lines if not one.startswith(("distinct", "generated", "cfg_sha256", "states", "edges"))
    ]
    path.write_text("".join(kept))
    found = outcome("MC_toy")
    found.log.tags = {"STATE": 16, "EDGE": 32}
    changes = {name: moves(root, checked(root, name, found)) for name in ("MC_toy", "OPEN_toy")}
    apply(root, {"toy": changes}, "first pins")
    now = load_runs(root, "toy")
    graph = whole[1].graph
    assert graph is not None
    assert now[0] == whole[0]
    assert now[1] == with_values(
        whole[1], distinct=16, generated=33, graph=with_values(graph, states=16, edges=32)
    )


def test_counts_of_a_further_run_go_into_its_row(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    (root / "spec/toy/ToyAsPrinted.tla").write_text(
        "---- MODULE ToyAsPrinted ----\nEXTENDS Toy\nUp_Slow == FALSE\n====\n"
    )
    path = root / "spec/toy/runs.toml"
    path.write_text(
        f'{path.read_text()}\n[[run]]\nid = "MC_slow"\nbase = "MC_toy"\n'
        'reading = "Slow"\n[run.also]\nMC_toy = []\n'
    )
    moved = moves(root, checked(root, "MC_toy_with_Slow", outcome("MC_toy")))
    assert [str(move) for move in moved] == ["also.MC_toy: none -> 16 of 33"]
    apply(root, {"toy": {"MC_slow": moved}}, "first counts")
    assert "MC_toy = [16, 33]\n" in path.read_text()
    assert moves(root, checked(root, "MC_toy_with_Slow", outcome("MC_toy"))) == ()


def test_a_wrong_verdict_is_never_pinned(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy", "NEG_small", distinct=12)
    with pytest.raises(Unjudged, match="VIOLATED is not what the run must show"):
        moves(root, checked(root, "MC_toy", outcome("NEG_small")))
    with pytest.raises(Unjudged, match="HOLDS is not what the run must show"):
        moves(root, checked(root, "NEG_small", outcome("MC_toy")))
    with pytest.raises(Unjudged, match="nothing to pin"):
        moves(root, checked(root, "MC_toy", outcome("MC_toy", status=-9)))


def test_a_changed_property_set_cannot_hide_behind_a_repin(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    cfg = root / "spec/toy/models/MC_toy.cfg"
    cfg.write_text(cfg.read_text().replace("TypeOK", "Small"))
    with pytest.raises(Unjudged, match=r"not a matter of pins: .* does not check TypeOK"):
        moves(root, checked(root, "MC_toy", outcome("MC_toy")))


def test_an_incomplete_graph_cannot_hide_behind_a_repin(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "OPEN_toy")
    found = outcome("MC_toy")
    found.log.tags = {"STATE": 16, "EDGE": 31}
    with pytest.raises(Unjudged, match="not a matter of pins: 31 edges were printed"):
        moves(root, checked(root, "OPEN_toy", found))


def test_what_changed_in_the_cfg_is_shown_from_the_history(tmp_path: Path) -> None:
    root = toy_tree(tmp_path)

    def git(*arguments: str) -> None:
        subprocess.run(
            ["git", "-c", "user.name=t", "-c", "user.email=t@t", "-C", str(root), *arguments],
            check=True,
            capture_output=True,
        )

    one = checked(root, "MC_toy", outcome("MC_toy"))
    assert cfg_diff(root, one).endswith("unchanged")
    git("init", "-q")
    git("add", ".")
    git("commit", "-qm", "pinned")
    cfg = root / "spec/toy/models/MC_toy.cfg"
    cfg.write_text(CFGS["MC_toy"].replace("N = 4", "N = 5"))
    diff = cfg_diff(root, checked(root, "MC_toy", outcome("MC_toy")))
    assert "-CONSTANTS N = 4" in diff and "+CONSTANTS N = 5" in diff
    git("commit", "-qam", "changed since")
    assert "-CONSTANTS N = 4" in cfg_diff(root, checked(root, "MC_toy", outcome("MC_toy")))


def test_a_repin_without_a_reason_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    assert ask_reason("  because\n of it ") == "because of it"
    with pytest.raises(Unjudged, match="needs a reason"):
        ask_reason("   ")
    monkeypatch.setattr("sys.stdin.isatty", lambda: False, raising=False)
    with pytest.raises(Unjudged, match="give --reason TEXT"):
        ask_reason(None)


def test_a_repin_in_ci_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)
    refuse_in_ci()
    monkeypatch.setenv("CI", "true")
    with pytest.raises(Unjudged, match="refused in CI"):
        refuse_in_ci()

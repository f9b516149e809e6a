"""runs.toml is read strictly: every mistake is one line with place and cause."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.runs import load_runs
from modeproof.tlc.check import register_problems, select
from tests.toy_tree import CFGS, declaration, toy_tree


def with_runs(root: Path, text: str) -> Path:
    toy_tree(root)
    (root / "spec" / "toy" / "runs.toml").write_text(text)
    return root


def test_every_kind_of_run_is_read(tmp_path: Path) -> None:
    runs = {run.id: run for run in load_runs(toy_tree(tmp_path, *CFGS), "toy")}
    assert set(runs) == set(CFGS)
    assert runs["NEG_small"].property == "Small" and runs["NEG_small"].expect == "VIOLATED"
    assert runs["WIT_toy"].witnesses == ("top", "down") and runs["WIT_toy"].expect == "REACHED"
    graph = runs["OPEN_toy"].graph
    assert graph is not None and (graph.states, graph.edges, graph.tick_ms) == (9, 18, 250)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "there is no [run.ID]"),
        ("run = 3", "`run` must be tables"),
        ("[[run]\n", "runs.toml: "),
        (declaration("MC_toy") * 2, "MC_toy: declared twice (rows 1 and 2)"),
        (
            declaration("MC_toy").replace('"MC_toy"', '"MX_toy"'),
            "id: 'MX_toy' is not the id of a run such as MC_Door",
        ),
        (declaration("MC_toy", kind="LIVE"), "unknown key 'kind'"),
        (declaration("MC_toy", workers=0), "workers: 0 is too small; it must be at least 1"),
        (declaration("MC_toy", timeout_s=0), "timeout_s"),
        (declaration("MC_toy", distinct="many"), "distinct: must be an integer, not 'many'"),
        (declaration("MC_toy", wokers=2), "unknown key 'wokers'; did you mean 'workers'?"),
        (declaration("NEG_small").replace('property = "Small"\n', ""), "must name what is violated"),
        (declaration("NEG_small", workers=2), "trace_length is exact with workers = 1"),
        (declaration("WIT_toy").replace('["top", "down"]', "[]"), "witnesses is empty"),
        (declaration("OPEN_toy", workers=2), "needs workers = 1"),
        (declaration("OPEN_toy").split("[run.graph]")[0], "[run.graph] belongs to"),
        (declaration("MC_toy").replace('"full"', '"fulll"'), "lanes[1]: 'fulll' is not allowed; did you"),
    ],
)
def test_a_mistake_in_runs_toml_names_place_and_cause(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(Unjudged) as caught:
        load_runs(with_runs(tmp_path, text), "toy")
    assert caught.value.message.startswith("spec/toy/runs.toml") and words in caught.value.message
    assert "\n" not in caught.value.message


def test_a_register_without_a_fault_has_no_problem(tmp_path: Path) -> None:
    assert register_problems(toy_tree(tmp_path, *CFGS), "toy") == ()


def test_an_unlisted_cfg_is_a_problem(tmp_path: Path) -> None:
    root = toy_tree(tmp_path)
    (root / "spec/toy/models/MC_forgotten.cfg").write_text("INVARIANT TypeOK\n")
    assert register_problems(root, "toy") == ("models/MC_forgotten.cfg is in no run",)


def test_a_listed_run_without_its_cfg_is_a_problem(tmp_path: Path) -> None:
    root = toy_tree(tmp_path)
    (root / "spec/toy/models/MC_toy.cfg").unlink()
    assert register_problems(root, "toy") == ("run MC_toy: models/MC_toy.cfg is missing",)


def test_a_main_run_outside_the_full_lane_is_noticed(tmp_path: Path) -> None:
    root = with_runs(tmp_path, declaration("MC_toy").replace('["smoke", "full"]', '["exhaustive"]'))
    words = "run MC_toy: the main run of the environment honest is not in the lane full"
    assert register_problems(root, "toy") == (words,)


def test_an_emptied_property_list_is_a_problem(tmp_path: Path) -> None:
    root = with_runs(tmp_path, declaration("MC_toy").replace('properties = ["TypeOK"]', "properties = []"))
    assert register_problems(root, "toy") == ("run MC_toy: the property list is empty",)


def test_a_selection_that_matches_nothing_is_refused(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy", "NEG_small")
    assert [run.id for run in select(root, ["NEG_*"])] == ["NEG_small"]
    assert [run.id for run in select(root, ["toy/MC_toy"], "smoke")] == ["MC_toy"]
    for arguments in (["MC_tyo"], ["MC_toy", "nothing*"]):
        with pytest.raises(Unjudged, match="no run "):
            select(root, arguments)
    with pytest.raises(Unjudged, match="no run to check in the lane exhaustive"):
        select(root, lane="exhaustive")
    with pytest.raises(Unjudged, match="no document 'tyo'"):
        select(root, document="tyo")


DERIVED = '[[run]]\nid = "{id}"\nbase = "{base}"\nreading = "{reading}"\n{more}\n'


def derived(id: str = "NEG_sinks", base: str = "MC_toy", reading: str = "Sinks", more: str = "") -> str:
    return DERIVED.format(id=id, base=base, reading=reading, more=more or 'property = "TypeOK"')


def test_a_run_takes_what_it_lacks_from_its_base(tmp_path: Path) -> None:
    text = declaration("MC_toy") + derived(more='property = "TypeOK"\nheap_mb = 300\nconstants = { N = "3" }')
    base, run = load_runs(with_runs(tmp_path, text), "toy")
    assert (run.kind, run.expect, run.lanes, run.readings) == ("NEG", "VIOLATED", ("full",), ("Sinks",))
    assert (run.module, run.cfg, run.environment, run.strength) == (
        base.module,
        base.cfg,
        base.environment,
        base.strength,
    )
    assert (run.heap_mb, base.heap_mb, run.timeout_s) == (300, 256, base.timeout_s)
    assert (run.properties, run.distinct, run.cfg_sha256) == (("TypeOK",), None, None)


def test_all_properties_of_the_base_check_a_harmless_reading(tmp_path: Path) -> None:
    text = declaration("WIT_toy") + derived("MC_sinks", "WIT_toy", more="workers = 1")
    _, run = load_runs(with_runs(tmp_path, text), "toy")
    assert run.properties == ("TypeOK", "Witness") and run.witnesses == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (derived(base="MC_tyo"), "run NEG_sinks: unknown base 'MC_tyo'; did you mean 'MC_toy'?"),
        (derived(base="x").replace('"x"', "[3]"), "run NEG_sinks: unknown base [3]; allowed: MC_toy"),
        (derived(base="NEG_first") + derived("NEG_first"), "its base NEG_first has a base itself"),
        (derived(more='property = "Small"'), "its base MC_toy does not check Small"),
        (derived(more='properties = ["TypeOK", "Small"]\nproperty = "TypeOK"'), "does not check Small"),
        (derived(more='cfg = "models/NEG_sinks.cfg"\nproperty = "TypeOK"'), "cfg belongs to a run by hand"),
        (derived(more="workers = 1"), "`property` must name what is violated"),
        (
            derived(more='property = "TypeOK"\nconstants = { N = 3 }'),
            "constants.N: must be a text in quotes, not 3",
        ),
        ('[[run]]\nid = "MC_same"\nbase = "MC_toy"\n', "nothing differs from its base MC_toy"),
        (declaration("WIT_toy", reading="Sinks"), "belong to a run with a base"),
    ],
)
def test_a_mistake_in_a_based_run_names_place_and_cause(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(Unjudged) as caught:
        load_runs(with_runs(tmp_path, declaration("MC_toy") + text), "toy")
    assert caught.value.message.startswith("spec/toy/runs.toml: run ") and words in caught.value.message

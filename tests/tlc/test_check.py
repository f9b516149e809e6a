"""Real TLC on a small model: every kind of run is as expected, and each planted fault turns the verdict."""

from __future__ import annotations

import os
import re
import signal
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec.structs import replace as with_values

from modeproof.ground import evidence
from modeproof.ground.meaning import meaning_of
from modeproof.ground.progress import Progress
from modeproof.tlc import children, process
from modeproof.tlc.check import SMALL_SHARE, Checked, check_all, check_one, select
from modeproof.tlc.process import SMALL_HEAP_MB
from modeproof.tlc.repin import apply, moves
from modeproof.tlc.schedule import Job
from modeproof.tlc.toolchain import find_toolchain
from tests.any_machine import until
from tests.toy_tree import CFGS, declaration, sha256, toy_tree

ALL = [name for name in CFGS if name != "MC_big"]


def check(root: Path, *names: str) -> dict[str, Checked]:
    done = check_all(root, select(root, names), find_toolchain(), Progress(quiet=True))
    return {one.run.id: one for one in done}


def test_a_small_run_leaves_part_of_its_core_to_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    (small,) = select(root, ["MC_toy"])
    big, wide = (with_values(small, heap_mb=SMALL_HEAP_MB + 1), with_values(small, workers=2))
    asked: list[float] = []

    def jobs_only(jobs: Sequence[Job], *others: object) -> list[Checked]:
        asked.extend(job.cores for job in jobs)
        return []

    monkeypatch.setattr("modeproof.tlc.check.run_all", jobs_only)
    check_all(
        root, [with_values(small, heap_mb=SMALL_HEAP_MB), big, wide], find_toolchain(), Progress(quiet=True)
    )
    assert asked == [SMALL_SHARE, 1, 2]


def edit(root: Path, old: str, new: str) -> None:
    path = root / "spec/toy/Toy.tla"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Checked]]:
    root = toy_tree(tmp_path_factory.mktemp("a root with spaces"), *ALL)
    return root, check(root)


def test_each_kind_of_run_is_as_expected(good: tuple[Path, dict[str, Checked]]) -> None:
    _, done = good
    assert {name: one.judgement.reason for name, one in done.items()} == dict.fromkeys(ALL, "")
    assert done["OPEN_toy"].judgement.verdict == "HOLDS"
    assert done["WIT_toy"].judgement.reached == ("down", "top")


@pytest.mark.parametrize(("name", "violated"), [("NEG_risen", "Risen"), ("NEG_starts", "StartsTop")])
def test_a_violation_in_the_first_state_has_length_1(
    good: tuple[Path, dict[str, Checked]], name: str, violated: str
) -> None:
    one = good[1][name]
    assert (one.judgement.verdict, one.judgement.violated) == ("VIOLATED", violated)
    (state,) = one.record["result"]["trace"]
    assert (state["number"], state["action"]) == (1, "Initial predicate")
    assert state["variables"] | {"count": "0", "top": "FALSE"} == state["variables"]
    assert one.record["result"]["distinct"] is None, "TLC says no counts then"


def test_what_the_first_state_violates_can_be_pinned(good: tuple[Path, dict[str, Checked]]) -> None:
    root, done = good
    one = done["NEG_risen"]
    assert moves(root, one) == ()
    (move,) = moves(root, replace(one, run=with_values(one.run, trace_length=2)))
    assert str(move) == "trace_length: 2 -> 1"


def test_the_evidence_names_inputs_and_tools(good: tuple[Path, dict[str, Checked]]) -> None:
    root, done = good
    records = {record["id"]: record for record in evidence.read_document(root, "toy")}
    assert set(records) == set(ALL)
    record = records["NEG_small"]
    assert record == done["NEG_small"].record
    assert set(record["inputs"]) == {
        "spec/toy/Toy.tla",
        "spec/toy/models/NEG_small.cfg",
    }
    cfg = "spec/toy/models/NEG_small.cfg"
    assert record["inputs"][cfg] == meaning_of(cfg, CFGS["NEG_small"].encode())
    assert record["tools"]["tlc"]["sha256"] and "2.15" in record["tools"]["tlc"]["version"]
    assert record["result"]["trace"][-1]["variables"]["count"] == "3"
    assert str(root) not in str(record["result"])


def test_the_graph_of_an_open_run_is_complete_and_unquoted(good: tuple[Path, dict[str, Checked]]) -> None:
    root, done = good
    lines = (root / "build/graphs/toy/OPEN_toy.txt").read_text().splitlines()
    assert [
        sum(line.startswith(f'<<"{tag}"') for line in lines) for tag in ("INPUT", "INIT", "STATE", "EDGE")
    ] == [2, 1, 9, 18]
    assert '<<"EDGE", <<3, FALSE>>, "Up", 1, <<4, TRUE>>>>' in lines
    assert done["OPEN_toy"].record["result"]["graph"]["file"] == "build/graphs/toy/OPEN_toy.txt"


def test_no_working_files_are_left(good: tuple[Path, dict[str, Checked]]) -> None:
    root, _ = good
    assert sorted(path.name for path in (root / "build/tlc/toy").iterdir()) == sorted(f"{n}.log" for n in ALL)
    assert not list((root / "build").rglob("*.part"))


# ------------------------------------------------------------------ planted faults


def hide_variable(root: Path) -> None:
    edit(root, "View == <<count, top>>", "View == <<count>>")


def lose_an_edge(root: Path) -> None:
    edit(root, "PrintEdge == PRINT =>", "PrintEdge == (PRINT /\\ count # 2) =>")


@pytest.mark.parametrize(
    ("plant", "words"),
    [
        (hide_variable, r"distinct states: \d, pinned 9"),
        (lose_an_edge, "edges were printed, but TLC took 18 transitions"),
    ],
)
def test_a_fault_in_a_printed_graph_is_noticed(
    tmp_path: Path, plant: Callable[[Path], None], words: str
) -> None:
    root = toy_tree(tmp_path, "OPEN_toy")
    plant(root)
    judgement = check(root)["OPEN_toy"].judgement
    assert not judgement.as_expected and re.search(words, judgement.reason)


def test_a_deleted_action_turns_its_witness_red(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "WIT_toy")
    edit(root, "Next == Up \\/ Stay \\/ Down", "Next == Up \\/ Stay")
    judgement = check(root)["WIT_toy"].judgement
    assert (judgement.verdict, judgement.reason) == ("UNREACHED", "not reached: down")


def test_a_shrunk_constant_changes_the_counts(tmp_path: Path) -> None:
    text = CFGS["MC_toy"].replace("N = 4", "N = 3")
    root = toy_tree(tmp_path, "MC_toy", cfg_sha256=sha256(text))
    (root / "spec/toy/models/MC_toy.cfg").write_text(text)
    judgement = check(root)["MC_toy"].judgement
    assert judgement.verdict == "HOLDS" and not judgement.as_expected
    assert re.fullmatch(r"distinct states: \d+, pinned 16", judgement.reason)


def test_an_emptied_environment_changes_the_counts(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    edit(root, "Next == Up \\/ Stay \\/ Down", "Next == Stay \\/ (Down /\\ FALSE)")
    judgement = check(root)["MC_toy"].judgement
    assert judgement.verdict == "HOLDS" and judgement.reason == "distinct states: 1, pinned 16"


def test_a_model_that_tlc_refuses_is_unjudged_with_its_words(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    edit(root, "TypeOK ==", "TypeOk ==")
    judgement = check(root)["MC_toy"].judgement
    assert judgement.verdict == "UNJUDGED" and "TypeOK" in judgement.reason


def test_a_missing_module_is_unjudged_and_leaves_evidence(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    (root / "spec/toy/Toy.tla").unlink()
    one = check(root)["MC_toy"]
    assert (one.status, one.outcome) == (2, None) and "Toy.tla is missing" in one.judgement.reason
    assert evidence.read(evidence.evidence_path(root, "toy", "MC_toy"))["verdict"] == "UNJUDGED"


def test_a_tlc_killed_halfway_is_unjudged(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_big")

    def kill() -> None:
        log = root / "build/tlc/toy/MC_big.log"
        until(lambda: log.is_file() and "2185" in log.read_text(), "TLC at work")
        os.killpg(children.running()[0], signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    judgement = check(root)["MC_big"].judgement
    killer.join()
    assert (judgement.verdict, judgement.reason) == ("UNJUDGED", "TLC was killed by signal 9")


def test_a_time_limit_ends_tlc_and_is_inconclusive(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_big", timeout_s=1)
    one = check(root)["MC_big"]
    assert one.judgement.verdict == "INCONCLUSIVE" and one.status == 2
    assert one.judgement.reason == "time limit of 1 s reached"
    assert not children.running()


def test_a_heap_that_java_refuses_is_inconclusive(tmp_path: Path) -> None:
    judgement = check(toy_tree(tmp_path, "MC_toy", heap_mb=1))["MC_toy"].judgement
    assert judgement.verdict == "INCONCLUSIVE" and "heap_mb = 1" in judgement.reason


def test_old_evidence_is_gone_before_a_run_begins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    path = evidence.evidence_path(root, "toy", "MC_toy")
    path.parent.mkdir(parents=True)
    path.write_text("{}")

    def crash(*_: object) -> None:
        assert not path.exists()
        raise RuntimeError("crash")

    monkeypatch.setattr("modeproof.tlc.check.run_tlc", crash)
    (run,) = select(root)
    with pytest.raises(RuntimeError):
        check_one(root, run, find_toolchain(), Progress(quiet=True))
    assert not path.exists()


def test_a_full_disk_while_writing_the_graph_leaves_no_graph(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = toy_tree(tmp_path, "OPEN_toy")

    def full(self: process._Sink, line: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(process._Sink, "take", full)
    one = check(root)["OPEN_toy"]
    assert one.judgement.verdict == "UNJUDGED" and "No space left on device" in one.judgement.reason
    assert list((root / "build/graphs/toy").iterdir()) == [] and not children.running()


def test_declaration_and_tree_agree() -> None:
    assert sha256(CFGS["MC_toy"]) in declaration("MC_toy")


AS_PRINTED = """---- MODULE ToyAsPrinted ----
EXTENDS Toy
Up_Overflows == in' = 1 /\\ count' = count + 1 /\\ step' = "Up" /\\ UNCHANGED top
LOCAL Waits == in' = 1 /\\ count = N /\\ step' = "Stay" /\\ UNCHANGED <<count, top>>
Stay_Waits == Waits
====
"""


def with_reading(root: Path, name: str, reading: str, more: str) -> Path:
    """The toy with MC_toy and one run that is MC_toy with a reading."""
    toy_tree(root, "MC_toy")
    (root / "spec/toy/ToyAsPrinted.tla").write_text(AS_PRINTED)
    with (root / "spec/toy/runs.toml").open("a") as register:
        register.write(f'\n[[run]]\nid = "{name}"\nbase = "MC_toy"\nreading = "{reading}"\n{more}')
    return root


def test_a_reading_takes_the_place_of_what_was_decided(tmp_path: Path) -> None:
    root = with_reading(tmp_path, "NEG_over", "Overflows", 'property = "TypeOK"\ntrace_length = 6\n')
    one = check(root, "NEG_over")["NEG_over"]
    assert (one.judgement.words, one.judgement.reason) == ("VIOLATED, as expected", "")
    assert {"spec/toy/ToyAsPrinted.tla", "spec/toy/models/MC_toy.cfg"} < set(one.record["inputs"])
    made = {name for name in one.record["inputs"] if name.startswith("build/")}
    assert made == {f"build/tlc/toy/made/NEG_over/NEG_over.{end}" for end in ("cfg", "tla")}
    assert moves(root, one) == ()


def test_a_run_with_a_base_has_pins_in_its_row(tmp_path: Path) -> None:
    root = with_reading(tmp_path, "NEG_over", "Overflows", 'property = "TypeOK"\ndistinct = 3\n')
    one = check(root, "NEG_over")["NEG_over"]
    assert one.judgement.reason == "not pinned yet: trace_length"
    found = {move.key: move.new for move in moves(root, one)}
    assert found.keys() == {"trace_length", "distinct"} and found["trace_length"] == 6
    apply(root, {"toy": {"NEG_over": moves(root, one)}}, "first run")
    one = check(root, "NEG_over")["NEG_over"]
    assert one.judgement.as_expected and moves(root, one) == ()
    assert one.record["result"]["pins"]["distinct"] == found["distinct"]


def test_a_reading_that_harms_nothing_is_checked_by_all_properties(tmp_path: Path) -> None:
    root = with_reading(tmp_path, "MC_waits", "Waits", "distinct = 16\ngenerated = 33\n")
    one = check(root, "MC_waits")["MC_waits"]
    assert (one.judgement.words, one.judgement.reason) == ("HOLDS", "")

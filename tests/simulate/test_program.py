"""What the page's program does, in Python: stories, names of steps, logs, faults, verdicts of suites."""

from __future__ import annotations

import copy
import gzip
import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.simulate.program.block import Block, spelt
from modeproof.simulate.program.device import Device, Disagreement
from modeproof.simulate.program.play import actions, whole
from modeproof.simulate.program.suites import judge
from modeproof.simulate.step_marks import labelled
from modeproof.trace.lines import read_lines
from modeproof.trace.targets import find_target
from proofs.mode_selection.code_tables import SW_AS_PRINTED_IN_FIGURE_7
from proofs.mode_selection.figures import figure_7_falling_through
from refimpl.edm import sf_edm
from refimpl.mode_selection import eks, fplc, key_flows
from refimpl.mode_selection.code_tables import RE, SE, SW, encode
from scenes.mode_selection.faults import KINDS
from scenes.mode_selection.scene import CHECKSUM, DIP_SWITCHES, ROUND, Scene
from tests.simulate.conftest import ROOT, RUN, SCENE, scenes_of

STORIES = (
    "normal_change", "key_pulled", "stale_confirmation", "figure_7",
    "repeated_acknowledgment", "welded_contactor",
)  # fmt: skip
CHANGE = (
    "round 30",
    "insert 2",
    "round 31",
    "touch select:1",
    "round 6",
    "touch confirm",
    "round 12",
    "remove",
    "round 34",
)


def play(scene: Any, story: dict[str, Any]) -> None:
    for row in story["step"]:
        for action in actions(row):
            scene.do(action)


def wrong_ends(scene: Any, ends: dict[str, Any]) -> list[str]:
    shown = scene.show()
    now = {**shown["text"], **shown["on"], **shown["devices"].get("fplc", {})}
    return [name for name, value in ends.items() if now[name] != value]


def test_the_six_stories_are_there(told: dict[str, Any]) -> None:
    assert tuple(told) == STORIES


@pytest.mark.parametrize("id", STORIES)
def test_a_story_ends_as_it_says(id: str, told: dict[str, Any], known: dict[str, Any]) -> None:
    story = told[id]
    played = scenes_of(story, known)
    assert len(played) == len(story["ends"])
    for scene, ends in zip(played, story["ends"], strict=True):
        assert wrong_ends(scene, ends), "the end stands there before anything was played"
        play(scene, story)
        assert not wrong_ends(scene, ends)


def test_without_dwell_time_both_cells_end_alike(told: dict[str, Any], known: dict[str, Any]) -> None:
    story = copy.deepcopy(told["stale_confirmation"])
    story["cell"][1]["params"]["fplc"] = {}
    right = scenes_of(story, known)[1]
    play(right, story)
    assert wrong_ends(right, story["ends"][1])
    assert not wrong_ends(right, story["ends"][0])


def figure_7(known: dict[str, Any], **ticks: Any) -> Device:
    reading = known[SCENE]["readings"]["Figure7"]
    return Device("refimpl.mode_selection.fplc", reading["labelled"], dict(ticks), reading["source"])


def test_figure_7_runs_as_it_is_printed(known: dict[str, Any]) -> None:
    code = figure_7(known).code
    for selected in SE:
        for word in (*SW, 0, 1):
            expected = figure_7_falling_through(selected, word, SW_AS_PRINTED_IN_FIGURE_7)
            assert code.matches(selected, word) == expected
    assert not code.matches(SE[2], SW[2]) and fplc.matches(SE[2], SW[2])


def test_figure_7_does_what_the_model_checker_recorded(known: dict[str, Any]) -> None:
    run = next(run for run in known[SCENE]["recorded"] if run["run"] == RUN)
    rows = whole(json.loads(run["rows"]))[1:]
    kinds = known[SCENE]["devices"]["fplc"]

    def outputs(device: Device) -> list[Any]:
        found = []
        for row in rows:
            read = {name: row["wires"][name] for name in kinds["inputs"]}
            device.scan(device.code.Inputs(row["ticks"], **read))
            found.append(({name: getattr(device.out, name) for name in kinds["outputs"]}, device.step))
        return found

    recorded = [({name: row["wires"][name] for name in kinds["outputs"]}, row["step"]) for row in rows]
    times = {"T_ON_ms": 1, "T_SEQ_ms": 1, "T_REM_ms": 2, "T_DWELL_ms": 1}
    ticks = {**times, "T_SEQ_FROM": "LA", "SELECTIONS": "again"}
    assert outputs(figure_7(known, **ticks)) == recorded
    assert recorded[-1][0]["MSO_3"]
    shipped = Device("refimpl.mode_selection.fplc", known[SCENE]["labelled"]["fplc"], dict(ticks))
    assert outputs(shipped) != recorded


def test_a_played_change_is_the_composition_itself(known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    params = eks.Params(checksum=lambda data: CHECKSUM, dip_switches=DIP_SWITCHES)
    system, lines = key_flows.power_up(params, fplc.Params()), []
    for action in CHANGE:
        scene.do(action)
        word, _, rest = action.partition(" ")
        if word == "insert":
            key = eks.KeyMemory(6, encode(RE, int(rest)), DIP_SWITCHES, CHECKSUM, 1 + int(rest))
            system = key_flows.insert_key(system, key)
        elif word == "remove":
            system = key_flows.remove_key(system)
        elif word == "touch":
            system = key_flows.touch(system, rest)
        for device, dt_ms in ROUND * int(rest) if word == "round" else ():
            lines.append(key_flows.log_line(system, device, dt_ms))
            system = key_flows.scan(system, device, dt_ms)
    assert scene.log().splitlines()[1:] == lines
    assert scene.system.fplc_out.MSO_1


def test_trace_reads_a_log_of_the_cell(tmp_path: Path, known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {"fplc": {"T_DWELL_ms": 100}})
    for action in CHANGE:
        scene.do(action)
    log, target = tmp_path / "played.jsonl", find_target(ROOT, "key_flows")
    log.write_text(scene.log(), encoding="utf-8")
    read = read_lines(log, target)
    assert (len(read.rows), read.params["fplc"]["T_DWELL_ms"]) == (scene.scans, 100)
    log.write_text(scene.log().replace('"MW01":"3333"', '"MW01":13107', 1), encoding="utf-8")
    with pytest.raises(Unjudged, match="MW01"):
        read_lines(log, target)


@pytest.mark.deep
@pytest.mark.parametrize(
    ("target", "story", "cell", "true"),
    [
        ("sf_edm", "welded_contactor", 0, '"Error":true'),
        pytest.param("key_flows", "stale_confirmation", 1, '"ERROR":true', marks=pytest.mark.long),
    ],
)
def test_a_played_log_is_accepted_by_trace(
    target: str, story: str, cell: int, true: str, tmp_path: Path, known: dict[str, Any], told: dict[str, Any]
) -> None:
    scene = scenes_of(told[story], known)[cell]
    play(scene, told[story])
    log = tmp_path / "played.jsonl"
    log.write_text(scene.log(), encoding="utf-8")
    assert main(["trace", target, str(log)]) == 0
    log.write_text(scene.log().replace(true, true.replace("true", "false"), 1), encoding="utf-8")
    assert main(["trace", target, str(log)]) == 1


def test_a_saved_log_plays_to_the_same_end(known: dict[str, Any]) -> None:
    scene, again = Scene(known[SCENE], {"fplc": {"T_DWELL_ms": 100}}), Scene(known[SCENE], {})
    for action in CHANGE:
        scene.do(action)
    head, *lines = (json.loads(line) for line in scene.log().splitlines())
    again.begin_log(head)
    for line in lines:
        again.play(line)
    assert (again.log(), again.differs) == (scene.log(), "")
    lines[7]["out"]["LA"] = True
    again.begin_log(head)
    for line in lines:
        again.play(line)
    assert "LA is False, the log has True" in again.differs


@pytest.mark.parametrize("dwell", [0, 500])
def test_a_settled_cell_takes_a_key_at_once(dwell: int, known: dict[str, Any]) -> None:
    for first, error in (("settle", False), ("scan fplc", dwell > 0)):
        scene = Scene(known[SCENE], {"fplc": {"T_DWELL_ms": dwell}})
        for action in (first, "insert 2", "round 31"):
            scene.do(action)
        assert scene.show()["on"]["ERROR"] == error
        assert scene.show()["open"]["select:1"] != error


def test_a_cell_that_never_settles_says_so(known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    for action in ("output LA", "fault la_stuck_at_1"):
        scene.do(action)
    with pytest.raises(ValueError, match="does not become ready for a key"):
        scene.do("settle")


def test_a_log_of_another_target_is_refused(known: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="a log of 'fplc' cannot be played here"):
        Scene(known[SCENE], {}).begin_log({"target": "fplc", "params": {}})


@pytest.mark.parametrize("text", ["dance", "fault none", "round x", "word MW99"])
def test_what_is_no_action_is_refused(text: str, known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    with pytest.raises(ValueError):
        scene.do(text)


def test_a_device_that_is_not_there_is_refused(known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    with pytest.raises(ValueError, match="'scan robot' is no action"):
        scene.do("scan robot")


def test_every_class_of_faults_can_be_put_in(known: dict[str, Any]) -> None:
    assert {fault["id"] for fault in known[SCENE]["faults"]} == set(KINDS)


WHERE = {
    "straddled_read": ("word MW03",), "register_check": (), "stuck_at_0": ("output C",),
    "crossed_wires": ("output B",),
         "extra_wire": ("output C",), "la_stuck_at_1": (),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_fault_changes_what_is_read_until_mended(kind: str, known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {"fplc": {"SELECTIONS": "again", "T_DWELL_ms": 500}})
    for action in (
        "round 30",
        "insert 2",
        "round 31",
        "touch select:1",
        "round 6",
        "touch confirm",
        "scan hmi plc 5",
    ):
        scene.do(action)
    for action in (*WHERE.get(kind, ()), "mode 4", f"fault {kind}"):
        scene.do(action)
    if kind in ("delay", "insertion", "la_stuck_at_1", "register_check"):
        scene.do("remove")
    seen = set()
    for _ in range(12):
        scene.do("round 1")
        seen |= set(scene.show()["misread"])
    assert seen
    scene.do("mend")
    assert not scene.show()["misread"]
    scene.do("round 1")
    assert not scene.show()["misread"]


@pytest.mark.parametrize(
    "id", ["sf_edm", "sf_guard_locking", "sf_enable_switch", "sf_testable_safety_sensor"]
)
def test_a_block_starts_up_and_names_its_step(id: str, known: dict[str, Any]) -> None:
    about = next(about for about in known.values() if id in about["devices"])
    block = Block(id, about, {})
    assert block.show()["on"]["Ready"] is False
    block.do("set Activate 1")
    block.do("call 20")
    shown = block.show()
    assert shown["on"]["Ready"] is True
    assert shown["devices"][id]["step"] in about["devices"][id]["steps"]


def test_states_are_spelt_as_words() -> None:
    assert spelt("WaitForReset1") == "wait for reset 1"
    assert spelt("EDMError21") == "EDM error 21"


def test_a_copy_that_disagrees_is_noticed(known: dict[str, Any]) -> None:
    text = known["edm"]["labelled"]["sf_edm"]
    assert "Step.INIT" in text
    planted = Device("refimpl.edm.sf_edm", text.replace("Step.INIT)", "Step.OUTPUT_ENABLE)"), {})
    with pytest.raises(Disagreement):
        planted.scan(sf_edm.Inputs(20, True, False, True, True, False, False))


def test_a_step_that_no_line_marks_is_not_reported() -> None:
    source = (ROOT / "refimpl/edm/sf_edm.py").read_text(encoding="utf-8")
    assert "Initialize" in labelled(source, ["Initialize"])[1]
    assert "Initialize" not in labelled(source.replace("# Initialize", "# Begin"), ["Initialize"])[1]


def rows_of(path: str) -> list[dict[str, Any]]:
    with gzip.open(ROOT / "vectors" / path, "rt", encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def test_the_judge_of_suites_names_the_first_difference() -> None:
    header, *cases = rows_of("sf_edm/sequences.jsonl.gz")
    *_, verdict = judge(sf_edm, header, cases)
    assert (verdict.word, verdict.done_scans) == ("CONFORMS", header["scans"])
    cases[3]["scans"][0]["out"]["Ready"] = not cases[3]["scans"][0]["out"]["Ready"]
    *_, verdict = judge(sf_edm, header, cases)
    assert verdict.word == "DIFFERS"
    assert verdict.difference.startswith(f"{cases[3]['id']}, scan 1: Ready is ")


def test_a_suite_that_is_cut_off_is_unjudged() -> None:
    header, *cases = rows_of("sf_edm/sequences.jsonl.gz")
    *_, verdict = judge(sf_edm, header, cases[:-1])
    assert verdict.word == "UNJUDGED"

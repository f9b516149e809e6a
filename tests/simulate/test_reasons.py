"""Every way of a device into an error, and every refusal, has its sentence; found by walking its program."""

from __future__ import annotations

import copy
import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.load import load_document
from modeproof.registers.rows import Document
from modeproof.simulate import reasons
from modeproof.simulate.program.block import Block
from modeproof.simulate.program.device import Device, take
from modeproof.simulate.program.reasons import ANYWHERE, why
from scenes.mode_selection.scene import Scene
from tests.simulate.conftest import ROOT, SCENE

SHORT: dict[str, list[dict[str, Any]]] = {
    "fplc": [{"T_ON_ms": 2, "T_SEQ_ms": 4, "T_REM_ms": 3}],
    "sf_edm": [{"MonitoringTime_ms": 2}],
    "sf_enable_switch": [{"DiscrepancyTimeCh1_Ch3_ms": 2}],
    "sf_guard_locking": [{}],
    "sf_testable_safety_sensor": [{"TestTime_ms": 2}, {"TestTime_ms": 200}],
}
"""Times of some scans, and one that a block refuses."""
DWELL = "T_DWELL_ms"
OUTPUTS = ("", "A", "C", "AC", "all")
MW03, MW07 = (0, 0x3333, 0x0F0F, 0x0001), (0, 0x3C3C, 0x0FF0, 0x0001)
BACK = ("Error", "Clear", "Settle")
"""Where the F-PLC goes when it gives up what was begun; the step that switches goes to Settle, too."""
SWITCHES = "SwitchMode"
TIMES = (1, 5)
"""A scan within all times, and one that is longer than each."""


class Way(NamedTuple):
    """One step from a state to a state; `held`: with a key in."""

    before: str
    step: str
    after: str
    error: bool
    held: bool


def inputs(device: Device, rows: dict[str, Any], times: Iterable[int]) -> Iterator[tuple[Any, bool]]:
    """What a scan may read, and whether that is a key that is in."""
    make = device.code.Inputs
    if "MW03" not in rows:
        for dt, values in itertools.product(times, itertools.product((False, True), repeat=len(rows))):
            yield make(dt, *values), True
        return
    wires = ("A", "B", "C", "D", "STR")
    for dt, LA, lit, one, other in itertools.product(times, (False, True), OUTPUTS, MW03, MW07):
        yield make(dt, LA, *[lit == "all" or name in lit for name in wires], one, other), LA


def params_of(row: dict[str, Any], id: str) -> Iterator[dict[str, Any]]:
    """The parameters of both profiles, with short times."""
    for profile, short in itertools.product(row["profiles"].values() or [{}], SHORT[id]):
        own = {name: take(row["parameters"][name], value) for name, value in profile.items()}
        yield {**own, **short, **({DWELL: 2} if own.get(DWELL) else {})}


def walk(known: dict[str, Any], id: str) -> frozenset[Way]:
    """Every way that the program can take in both profiles, from power-up on."""
    about = next(about for about in known.values() if id in about["devices"])
    found: set[Way] = set()
    for params in params_of(about["devices"][id], id):
        device = Device(about["module"] + id, about["labelled"][id], params)
        given = list(inputs(device, about["devices"][id]["inputs"], TIMES))
        seen, todo = {device.state}, [device.state]
        while todo:
            state = todo.pop()
            for read, held in given:
                device.state = state
                before = device.control()
                out = device.scan(read)
                error = bool(getattr(out, "ERROR", False) or getattr(out, "Error", False))
                found.add(Way(before, device.step, device.control(), error, held))
                if device.state not in seen:
                    seen.add(device.state)
                    todo.append(device.state)
    return frozenset(found)


@pytest.fixture(scope="module")
def ways(known: dict[str, Any]) -> Any:
    @cache
    def of(id: str) -> frozenset[Way]:
        return walk(known, id)

    return of


def told(known: dict[str, Any], id: str) -> dict[str, Any]:
    about = next(about for about in known.values() if id in about["devices"])
    own: dict[str, Any] = about["reasons"][id]
    return own


def refuses(id: str, way: Way, errors: set[str]) -> bool:
    """Whether a way gives up what was begun: for a block, whether it leads into an error."""
    if id == "fplc":
        return way.before != way.after and way.after in BACK and way.step not in (SWITCHES, "ClearWords")
    return way.after in errors and way.before not in errors


def unsaid(id: str, ways: frozenset[Way], told: dict[str, Any]) -> set[str]:
    """What has no sentence: ways that refuse, errors, and states that a key which stays in never leaves."""
    errors = {way.after for way in ways if way.error}
    found = {
        f"{way.before} {way.step}"
        for way in ways
        if refuses(id, way, errors) and not why(told, way.before, way.step)
    }
    states = errors
    if id == "fplc":
        states = {way.before for way in ways} - leads_to(ways, {"AwaitSelection"}) | {"Settle"}
    return found | {f"no way out of {state}" for state in states if state not in told["stands"]}


def leads_to(ways: frozenset[Way], goals: set[str]) -> set[str]:
    """The states from which a goal can be reached while the key stays in."""
    found = set(goals)
    while more := {way.before for way in ways if way.held and way.after in found} - found:
        found |= more
    return found


def idle(id: str, ways: frozenset[Way], told: dict[str, Any]) -> set[str]:
    """Sentences that no way asks for."""
    errors = {way.after for way in ways if way.error}
    taken = {(way.step, way.before) for way in ways if refuses(id, way, errors)}
    found = set()
    for step, rows in told["why"].items():
        for state in rows:
            froms = {before for of, before in taken if of == step and (state == before or before not in rows)}
            if not (froms if state == ANYWHERE else state in froms):
                found.add(f"{state} {step}")
    return found


@pytest.mark.parametrize("id", SHORT)
def test_no_error_and_no_refusal_is_without_a_sentence(id: str, ways: Any, known: dict[str, Any]) -> None:
    assert unsaid(id, ways(id), told(known, id)) == set()
    assert idle(id, ways(id), told(known, id)) == set()


@pytest.mark.parametrize("id", SHORT)
def test_a_missing_sentence_is_found(id: str, ways: Any, known: dict[str, Any]) -> None:
    whole = told(known, id)
    for kind in ("why", "stands"):
        for key in whole[kind]:
            less = copy.deepcopy(whole)
            del less[kind][key]
            assert any(key in line for line in unsaid(id, ways(id), less)), key
            assert unsaid(id, ways(id), whole) == set()


def test_a_sentence_for_one_state_alone_is_missed(ways: Any, known: dict[str, Any]) -> None:
    less = copy.deepcopy(told(known, "fplc"))
    del less["why"]["DeadlineExpired"]["OneOutput"]
    assert unsaid("fplc", ways("fplc"), less) == {"OneOutput DeadlineExpired"}
    less["why"]["AwaitKey"] = {ANYWHERE: {"say": "", "by": []}}
    assert idle("fplc", ways("fplc"), less) == {"* AwaitKey"}


def test_the_walk_finds_what_source_and_specification_refuse(ways: Any) -> None:
    """The marks on the lines that enter a state, and the operators of Fplc.tla that do."""
    code = (ROOT / "refimpl/mode_selection/fplc.py").read_text(encoding="utf-8")
    marked = set(re.findall(r"return _enter_(?:error|clear|settle)\(s\)\s+# (\w+)", code))
    spec = (ROOT / "spec/mode_selection/Fplc.tla").read_text(encoding="utf-8")
    written = set(re.findall(r"/\\ Enter(?:Error|Clear|Settle)\n    /\\ Did\(\"(\w+)\"\)", spec))
    written |= set(re.findall(r"/\\ Enter(?:Error|Clear|Settle) /\\ Did\(\"(\w+)\"\)", spec))
    walked = {way.step for way in ways("fplc") if refuses("fplc", way, set())}
    assert marked == written == walked and len(walked) > 8


def said(scene: Any, id: str) -> tuple[str, str, str, str]:
    """What stands in the box: kind, reason, way out, what is waited for."""
    of = scene.show()["why"][id]
    return of["kind"], *[part[0] if part else "" for part in (of["say"], of["way"])], of["waits"]


def do(scene: Any, actions: str) -> None:
    for action in actions.split("; "):
        scene.do(action)


def test_a_key_that_comes_too_early_is_explained(known: dict[str, Any]) -> None:
    cautious = known[SCENE]["devices"]["fplc"]["profiles"]["cautious"]
    scene = Scene(known[SCENE], {"fplc": cautious})
    do(scene, "scan fplc; insert 2; round 8")
    kind, reason, way, waits = said(scene, "fplc")
    assert kind == "error" and scene.show()["on"]["ERROR"]
    assert reason.endswith(
        "waits 500 ms for zeros, and only a key that comes later may show it the test pulse."
    )
    assert way.startswith("Pull the key out.")
    assert waits == "Now it waits for the key to be pulled out and 460 ms to pass."
    do(scene, "remove; round 30")
    assert said(scene, "fplc")[::2] == ("over", "") and said(scene, "fplc")[1] == reason
    do(scene, "insert 2; round 31")
    assert said(scene, "fplc") == ("", "", "", "")


def test_what_the_letter_waits_for_is_said(known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    do(scene, "settle; insert 2; round 31; touch select:1; round 6; touch confirm; round 8")
    kind, reason, way, waits = said(scene, "fplc")
    assert (kind, reason, scene.show()["on"]["MSO_1"]) == ("waits", "", True)
    assert "pull the key out and insert it again" in way
    assert waits == "Now it waits for the key to be pulled out."


def test_a_word_that_a_fault_makes_is_waited_for(known: dict[str, Any]) -> None:
    scene = Scene(known[SCENE], {})
    do(scene, "settle; insert 2; word MW03; fault masquerade; round 40; remove; round 3")
    kind, reason, _, waits = said(scene, "fplc")
    assert (kind, reason[:26]) == ("error", "MW03 or MW07 holds a word ")
    assert waits == "Now it waits for the fault to be taken out and MW03 to be zero."


def test_an_error_of_a_block_is_explained_with_its_time(known: dict[str, Any]) -> None:
    block = Block("sf_edm", known["edm"], {"MonitoringTime_ms": 40})
    do(block, "set Activate 1; set S_StartReset 1; set S_EDM1 1; set S_EDM2 1; round 2")
    assert said(block, "sf_edm") == ("", "", "", "")
    do(block, "set S_OutControl 1; round 4")
    kind, reason, way, _ = said(block, "sf_edm")
    assert (kind, way[:8]) == ("error", "Let both")
    assert reason.startswith("The output is on, but a contactor has not picked up within 40 ms")
    do(block, "set Reset 1; round 1; set S_OutControl 0")
    assert said(block, "sf_edm") == ("", "", "", "")


@pytest.fixture(scope="module")
def note() -> Document:
    return load_document(ROOT, SCENE)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('step = "RefuseMatch"', 'step = "RefuseMach"', "fplc has no such step"),
        ('device = "fplc"', 'device = "robot"', "there is no device robot"),
        ('"EKS-2-27", "EKS-7-12"', '"EKS-2-29"', "by EKS-2-29, which the specification does not cite"),
        ("{T_ON_ms}", "{T_OFF_ms}", "fplc has no parameter T_OFF_ms"),
        ('state = ["Error"]', 'state = ["Fault"]', "fplc has no state Fault"),
        ('from = ["PulseZeros"]', 'from = ["PulseOnes"]', "PulseOnes has two sentences"),
        ('by = ["E-54"]', "by = []", "by is missing"),
        ('by = ["E-54"]', 'by = ["E-54"]\nbe = 1', "be is not known"),
    ],
)
def test_a_sentence_that_fits_nothing_makes_no_page(
    old: str, new: str, message: str, tmp_path: Path, note: Document, known: dict[str, Any]
) -> None:
    text = (ROOT / "scenes" / SCENE / "reasons.toml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "scenes" / SCENE / "reasons.toml"
    path.parent.mkdir(parents=True)
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    steps = {id: row["steps"] for id, row in known[SCENE]["devices"].items()}
    with pytest.raises(Unjudged, match=message):
        reasons.of_document(replace(note, root=tmp_path), steps)

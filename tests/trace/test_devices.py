"""Random walks of each device are accepted by both judges; one wrong output is found in its scan."""

from __future__ import annotations

import random
from array import array
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modeproof.graph.classes import Members
from modeproof.graph.device import DeviceGraph
from modeproof.graph.implementation import load_implementation
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.follow import Followed, NotFollowed, follow
from modeproof.trace.log import Log, Row, Rows
from modeproof.trace.log_judge import Graphs, Judgement, check
from modeproof.trace.targets import Target, find_target
from tests.any_machine import SHARED_FIXTURE
from tests.trace.judging import judge, log_of

RUN = {"fplc": "OPEN_Fplc", "plc": "OPEN_Plc", "hmi": "OPEN_Hmi", "eks": "OPEN_Eks6"}
SCANS, WALKS = 50, 6
Lines = list[dict[str, Any]]


def walk(graph: DeviceGraph, seed: int, scans: int = SCANS) -> Lines:
    """A run of refimpl: inputs of the alphabet and members of their classes, drawn towards other states."""
    chance = random.Random(seed)
    device, forms, states = graph.device, graph.forms, graph.graph
    code = load_implementation("refimpl", graph.document, device.id)
    state = code.start(device, forms, graph.params)
    members = Members(graph.classes, graph.alphabet)
    at, lines = states.initial, []
    for _ in range(scans):
        leading = [n for n, after in enumerate(states.next_of[at]) if after != at]
        # by what the states are: their numbers are the order in which TLC printed them
        goals = sorted({states.next_of[at][n] for n in leading}, key=states.views.__getitem__)
        goal = chance.choice(goals) if goals and chance.random() < 0.8 else at
        letter = chance.choice([n for n, after in enumerate(states.next_of[at]) if after == goal] or [0])
        values = members.another(letter) if members.any_of(letter) else dict(graph.alphabet[letter])
        if device.id == "plc":  # it copies any word
            values |= {name: chance.choice((0, 1, 0x0FF0, 0x3333, 0x33CC, 0xFFFF)) for name in device.inputs}
        at = states.next_of[at][letter]
        inputs = {signal.python: values[name] for name, signal in device.inputs.items()}
        state, outputs = code.step(state, code.inputs(dt_ms=values["dt_ms"], **inputs))
        wrote = {name: getattr(outputs, signal.python) for name, signal in device.outputs.items()}
        lines.append(
            {"dt_ms": values["dt_ms"], "in": graph.wire_inputs(values), "out": graph.wire_outputs(wrote)}
        )
    return lines


def renumbered(graph: DeviceGraph) -> DeviceGraph:
    """The same graph with the states numbered the other way round."""
    states, last = graph.graph, len(graph.graph.views) - 1
    turned = replace(
        states,
        views=states.views[::-1],
        outputs=states.outputs[::-1],
        step_of=states.step_of[::-1],
        next_of=tuple(array("i", (last - n for n in row)) for row in states.next_of[::-1]),
        initial=last - states.initial,
    )
    return replace(graph, graph=turned, rows=graph.rows[::-1])


def test_a_walk_is_the_same_however_states_are_numbered(alphabets: dict[str, Alphabet]) -> None:
    graph = alphabets["OPEN_Hmi"].graph
    assert walk(renumbered(graph), 3) == walk(graph, 3)


def corrupted(graph: DeviceGraph, lines: Lines, seed: int) -> tuple[Lines, int]:
    """One output of one scan is another value; the scans before it are as they were."""
    chance = random.Random(seed)
    at = chance.randrange(len(lines))
    out: Mapping[str, Any] = lines[at]["out"]
    name = chance.choice([one for one in out if graph.device.outputs[one].type in ("bool", "word")])
    value = out[name]
    wrong = (
        (not value)
        if isinstance(value, bool)
        else chance.choice(
            [word for word in ("0000", "0F0F", "0FF0", "3333", "33CC", "3C3C", "1234") if word != value]
        )
    )
    return [*lines[:at], {**lines[at], "out": {**out, name: wrong}}, *lines[at + 1 :]], at


def target_of(device: str) -> Target:
    return find_target(root(), device)


def extra(device: str, graph: DeviceGraph) -> dict[str, Lines]:
    """Logs of a device that only it can have."""
    lines = walk(graph, 3)
    if device == "hmi":
        at = next(n for n, line in enumerate(lines) if line["out"]["screen"] == "confirm")
        out = lines[at]["out"]
        shows_another = [*lines]
        shows_another[at] = {**lines[at], "out": {**out, "shown": (out["shown"] + 1) % 5}}
        displays_another = [*lines]
        mode = 4 if lines[7]["in"]["ActiveMSO"] != 4 else 3
        displays_another[7] = {**lines[7], "out": {**lines[7]["out"], "active": mode}}
        return {
            "shows another": shows_another,
            "shown and touch not observed": without(shows_another, "shown", "touch"),
            "displays another": displays_another,
        }
    if device == "plc":
        rest = {"MW05": "0000", "SelectMSO": "5555", "SwitchMSO": "0000"}
        zeros = {"MW03": "0000", "CheckMSO": "0000", "MW07": "0000"}
        first = {"dt_ms": 1, "in": {"MW01": "1111", **rest}, "out": {**zeros, "ReadAuthorization": "1111"}}
        checks = {"dt_ms": 1, "in": {"MW01": "2222", **rest}, "out": {**zeros, "ReadAuthorization": "2222"}}
        only_copies = {**checks, "out": {**first["out"], "MW03": "5555"}}
        return {"checks": [first, checks], "only copies": [first, only_copies]}
    if device == "eks":
        other_key = [
            {**line, "in": {**line["in"], "KeyID": 2**64 - 1}} if line["in"]["inserted"] else line
            for line in lines
        ]
        return {"a long KeyID": other_key}
    return {}


def without(lines: Lines, *names: str) -> Lines:
    """The same as seen by somebody who does not observe these signals."""
    return [
        {
            side: {key: value for key, value in values.items() if key not in names}
            if isinstance(values, dict)
            else values
            for side, values in line.items()
        }
        for line in lines
    ]


@dataclass(frozen=True)
class Batch:
    """Logs of one device that were judged in one run of TLC."""

    good: tuple[Judgement, ...]
    bad: tuple[tuple[int, Judgement], ...]
    extra: Mapping[str, Judgement]


@pytest.fixture(scope="module")
def batches(
    graphs: Graphs, alphabets: dict[str, Alphabet], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Batch]:
    folder = tmp_path_factory.mktemp("logs")
    found = {}
    for device, run in RUN.items():
        graph = alphabets[run].graph
        good = [walk(graph, seed) for seed in range(WALKS)]
        bad = [corrupted(graph, lines, seed) for seed, lines in enumerate(good)]
        more = extra(device, graph)
        lines = [*good, *(one for one, _ in bad), *more.values()]
        judged = judge(device, [log_of(folder, device, one, graph.params) for one in lines], graphs)
        found[device] = Batch(
            judged[:WALKS],
            tuple(zip((at for _, at in bad), judged[WALKS : 2 * WALKS], strict=True)),
            dict(zip(more, judged[2 * WALKS :], strict=True)),
        )
    return found


@pytest.mark.deep
@pytest.mark.parametrize("device", RUN)
def test_random_walks_are_accepted_by_both(device: str, batches: dict[str, Batch]) -> None:
    for one in batches[device].good:
        assert (one.verdict, one.accepted) == ("CONFORMS", SCANS)
        assert isinstance(one.followed, Followed) and one.followed.accepted == SCANS
        if device != "plc":  # the walk has the times and parameters of the graph
            assert one.followed.open == ()


@pytest.mark.deep
@pytest.mark.parametrize("device", RUN)
def test_one_wrong_output_is_found_in_its_scan(device: str, batches: dict[str, Batch]) -> None:
    for at, one in batches[device].bad:
        assert (one.verdict, one.accepted) == ("DIFFERS", at)
        assert isinstance(one.followed, Followed) and one.followed.accepted == at


@pytest.mark.deep
def test_what_was_not_observed_is_not_held_against_a_log(batches: dict[str, Batch]) -> None:
    seeing, blind = (batches["hmi"].extra[name] for name in ("shows another", "shown and touch not observed"))
    assert (seeing.verdict, blind.verdict) == ("DIFFERS", "CONFORMS")
    assert blind.log.observed("hmi").isdisjoint({"shown", "touch"})


@pytest.mark.deep
def test_an_output_that_repeats_an_input_must_do_so(batches: dict[str, Batch]) -> None:
    assert batches["hmi"].extra["displays another"].accepted == 7


@pytest.mark.deep
def test_two_words_that_the_plc_compares_are_told_apart(batches: dict[str, Batch]) -> None:
    checks, only_copies = (batches["plc"].extra[name] for name in ("checks", "only copies"))
    assert (checks.verdict, only_copies.verdict, only_copies.accepted) == ("CONFORMS", "DIFFERS", 1)
    assert isinstance(only_copies.followed, Followed) and only_copies.followed.accepted == 1


@pytest.mark.deep
def test_tlc_alone_judges_a_key_that_no_graph_has(batches: dict[str, Batch]) -> None:
    found = batches["eks"].extra["a long KeyID"]
    assert "stands for KeyID = 18446744073709551615" in str(found.followed)
    assert isinstance(found.followed, NotFollowed) and found.accepted > 0


@pytest.mark.deep
def test_judges_that_contradict_each_other_are_no_verdict(batches: dict[str, Batch]) -> None:
    one = batches["hmi"].good[0]
    assert isinstance(one.followed, Followed)
    check(one)
    less = replace(one, followed=replace(one.followed, accepted=SCANS - 1))
    more = replace(one, matched=replace(one.matched, accepted=SCANS - 1))
    for wrong in (less, more):
        with pytest.raises(
            Unjudged, match=r"contradict each other: the graph OPEN_Hmi follows \d+ scans, TLC \d+"
        ):
            check(wrong)
    check(replace(more, followed=replace(one.followed, open=("the time",))))
    with pytest.raises(Unjudged, match="contradict"):
        check(replace(less, followed=replace(one.followed, accepted=1, open=("the time",))))


@pytest.mark.deep
@settings(max_examples=25, deadline=None, suppress_health_check=SHARED_FIXTURE)
@given(device=st.sampled_from(("plc", "hmi", "eks")), seed=st.integers(0, 2**32), data=st.data())
def test_the_graph_accepts_any_walk_even_if_partly_shown(
    device: str, seed: int, data: st.DataObject, alphabets: dict[str, Alphabet], tmp_path: Path
) -> None:
    alphabet = alphabets[RUN[device]]
    target = target_of(device)
    log = log_of(tmp_path, device, walk(alphabet.graph, seed, 25), alphabet.graph.params)
    names = [*target.only.device.inputs, *target.only.device.outputs]
    hidden = data.draw(st.sets(st.sampled_from(names)))

    def seen(row: Row) -> Row:
        inputs = {name: value for name, value in row.inputs.items() if name not in hidden}
        outputs = {name: value for name, value in row.outputs.items() if name not in hidden}
        return Row(row.line, row.device, row.dt_ms, inputs, outputs)

    partial = Log(log.name, Rows(seen(row) for row in log.rows), log.params)
    for anywhere, samples in ((False, False), (True, False), (False, True)):
        found = follow(target, partial, {device: alphabet}, anywhere, samples)
        assert isinstance(found, Followed) and found.accepted == 25

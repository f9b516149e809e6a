"""What holds for the F-PLC after any sequence of inputs: any LA, any outputs, any words, any times."""

from __future__ import annotations

import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import CH, NONE, RE, SE, SW, decode
from refimpl.mode_selection.fplc import Inputs, Outputs, Params, State, Step

PARAMS = Params(T_SEQ_FROM="LA", T_DWELL_ms=500, SELECTIONS="again")

CHECKED = settings(max_examples=120, deadline=None, derandomize=True)

OFF = (False,) * 5
ON = (True,) * 5


def one(level: int) -> tuple[bool, ...]:
    return tuple(output == level for output in range(5))


VECTORS = st.one_of(
    st.sampled_from([OFF, ON, *[one(level) for level in range(5)]]), st.tuples(*[st.booleans()] * 5)
)
WORDS = st.one_of(st.sampled_from([0, *RE]), st.integers(0, 0xFFFF))
TIMES = st.sampled_from([0, 1, 10, 499, 500, 501, 999, 1000, 5000])
ANY_SCAN = st.builds(
    lambda dt, LA, vector, MW03, MW07: Inputs(dt, LA, *vector, MW03, MW07),
    TIMES,
    st.booleans(),
    VECTORS,
    WORDS,
    WORDS,
)


@st.composite
def transactions(draw: st.DrawFn) -> list[Inputs]:
    """An insertion, a selection and its acknowledgment, each word right most of the time, held for scans."""
    level = draw(st.integers(0, 4))
    mode = draw(st.integers(0, 4))
    vector = one(level)
    MW03 = draw(st.sampled_from([SE[mode]] * 6 + [SE[(mode + 1) % 5], 1]))
    MW07 = draw(st.sampled_from([SW[mode]] * 6 + [SW[(mode + 1) % 5], 1]))
    held = [
        Inputs(500, False, *OFF, 0, 0),
        Inputs(10, True, *OFF, 0, 0),
        Inputs(10, True, *ON, 0, 0),
        Inputs(10, True, *OFF, 0, 0),
        *[Inputs(10, True, *vector, 0, 0)] * 2,
        *[Inputs(10, True, *vector, MW03, 0)] * 4,
        *[Inputs(10, True, *vector, MW03, MW07)] * 4,
        Inputs(500, True, *vector, 0, 0),
    ]
    if draw(st.booleans()):
        held.insert(draw(st.integers(0, len(held))), draw(ANY_SCAN))
    return held


SEQUENCES = st.lists(st.one_of(transactions(), st.lists(ANY_SCAN, max_size=6)), max_size=6).map(
    lambda parts: [scan for part in parts for scan in part]
)


def active(row: Outputs) -> list[int]:
    return [mode for mode in range(5) if (row.MSO_0, row.MSO_1, row.MSO_2, row.MSO_3, row.MSO_4)[mode]]


def run(scans: list[Inputs], params: Params = PARAMS) -> list[tuple[State, Inputs, State, Outputs]]:
    """Each scan as state before, inputs, state after, outputs."""
    steps, state = [], fplc.power_up(params)
    for i in scans:
        after, row = fplc.step(state, i)
        steps.append((state, i, after, row))
        state = after
    return steps


def test_the_sequences_drawn_below_do_switch_modes() -> None:
    """Without this the invariants could hold because nothing ever happens."""
    found = find(
        SEQUENCES, lambda scans: any(before.mode != after.mode for before, _, after, _ in run(scans))
    )
    assert found


@pytest.mark.parametrize("selections", ["again", "once"])
@pytest.mark.parametrize("on_error", ["hold", "none"])
@CHECKED
@given(scans=SEQUENCES)
def test_never_two_mode_outputs_and_none_before_the_first_switchover(
    on_error: str, selections: str, scans: list[Inputs]
) -> None:
    switched = False
    for before, _, after, row in run(scans, Params(ON_ERROR=on_error, SELECTIONS=selections)):
        switched = switched or (before.state == Step.SWITCH and after.state in (Step.COMPLETE, Step.SETTLE))
        assert len(active(row)) <= 1
        assert switched or active(row) == []
        if on_error == "hold" and switched:
            assert len(active(row)) == 1


@CHECKED
@given(SEQUENCES)
def test_the_mode_changes_only_in_switch_on_this_scans_inputs(scans: list[Inputs]) -> None:
    """The key, its level, the selection and the acknowledgment are those of this scan."""
    for before, i, after, row in run(scans):
        if before.mode != after.mode:
            mode = after.mode
            assert before.state == Step.SWITCH
            assert i.LA
            assert one(before.authority) == (i.A, i.B, i.C, i.D, i.STR)
            assert (SE[mode], SW[mode]) == (i.MW03, i.MW07)
            assert mode <= before.authority
            assert active(row) == [mode]


@CHECKED
@given(SEQUENCES)
def test_words_are_zero_outside_their_states(scans: list[Inputs]) -> None:
    for _, _, after, row in run(scans):
        publishing = after.state in (
            Step.AWAIT_SELECTION,
            Step.CHECK_SELECTION,
            Step.ECHO_SELECTION,
            Step.AWAIT_ACKNOWLEDGMENT,
            Step.CHECK_ACKNOWLEDGMENT,
            Step.MATCH,
            Step.SWITCH,
        )
        echoing = after.state in (
            Step.AWAIT_ACKNOWLEDGMENT,
            Step.CHECK_ACKNOWLEDGMENT,
            Step.MATCH,
            Step.SWITCH,
        )
        assert (RE[after.authority] if publishing else 0) == row.MW01
        assert (CH[after.selection] if echoing else 0) == row.MW05


@CHECKED
@given(SEQUENCES)
def test_memory_has_only_what_the_state_needs(scans: list[Inputs]) -> None:
    timed = ("Start", "PulseOnes", "PulseZeros", "OneOutput", "Settle", "Clear", "AwaitZeros", "Error")
    for _, _, after, _ in run(scans):
        name = after.state.value
        before_authority = name in (
            "Start",
            "Idle",
            "PulseOnes",
            "PulseZeros",
            "OneOutput",
            "Clear",
            "AwaitZeros",
            "Error",
        )
        latched = name in ("EchoSelection", "AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch")
        assert (after.accepted == NONE) == before_authority
        assert after.authority == (NONE if before_authority or name == "Authorize" else after.accepted)
        assert (after.selection != NONE) == latched
        assert after.selection <= after.authority
        assert after.elapsed_ms == 0 or name in timed


@CHECKED
@given(SEQUENCES)
def test_two_outputs_outside_the_pulse_window_are_an_error(scans: list[Inputs]) -> None:
    for before, i, after, row in run(scans):
        in_window = before.state in (Step.PULSE_ONES, Step.PULSE_ZEROS) or (
            before.state == Step.IDLE and i.LA
        )
        if sum((i.A, i.B, i.C, i.D, i.STR)) >= 2 and not in_window:
            assert row.ERROR
            assert before.mode == after.mode


@CHECKED
@given(SEQUENCES)
def test_only_a_selection_read_as_permitted_is_echoed(scans: list[Inputs]) -> None:
    for before, i, after, _ in run(scans):
        if after.selection != before.selection and after.selection != NONE:
            assert decode(SE, i.MW03) == after.selection
            assert i.MW07 == 0


@CHECKED
@given(SEQUENCES, ANY_SCAN)
def test_key_out_and_zeros_lead_from_anywhere_to_idle(scans: list[Inputs], last: Inputs) -> None:
    quiet = Inputs(250, False, *OFF, 0, 0)
    steps = run([*scans, last, *[quiet] * 12])
    assert steps[-1][2].state == Step.IDLE
    assert steps[-1][2].mode == steps[-13][2].mode

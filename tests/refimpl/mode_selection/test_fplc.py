"""The F-PLC's scans: every step from every state, priorities, timers at their exact boundaries, outputs."""

from __future__ import annotations

import tomllib
from dataclasses import fields, replace
from pathlib import Path

import pytest

from refimpl.errors import InputError, ParameterError, StateError, checked
from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import CH, RE, SE, SW, decode
from refimpl.mode_selection.fplc import Inputs, Params, State, Step

ROOT = Path(__file__).resolve().parents[3]
INTERFACE = tomllib.loads((ROOT / "spec/mode_selection/interface.toml").read_text(encoding="utf-8"))
FPLC = INTERFACE["devices"]["fplc"]

PARAMS = Params(800, 900, "LA", T_REM_ms=700, T_DWELL_ms=400, SELECTIONS="again")
FROM_ONES = replace(PARAMS, T_ON_ms=900, T_SEQ_ms=800, T_SEQ_FROM="ones")
# A machine where no level permits a mode that the text does not say to be contained in it. E-47
TEXT_ORDER = replace(
    PARAMS,
    PERMITS_1=(False, True, False, False, False),
    PERMITS_2=(False, False, True, False, False),
    PERMITS_3=(False, True, True, True, False),
    PERMITS_4=(False, False, False, False, True),
)
OUTPUTS = ("A", "B", "C", "D", "STR")
ALL = "A B C D STR"
NOT_A_CODE = 0x0F0E

IN_FLOW = (
    Step.AUTHORIZE,
    Step.AWAIT_SELECTION,
    Step.CHECK_SELECTION,
    Step.ECHO_SELECTION,
    Step.AWAIT_ACKNOWLEDGMENT,
    Step.CHECK_ACKNOWLEDGMENT,
    Step.MATCH,
    Step.SWITCH,
    Step.COMPLETE,
    Step.SETTLE,
)
WITH_SELECTION = IN_FLOW[3:8]
LATCHED = IN_FLOW[3:9]
WITH_ACKNOWLEDGMENT = IN_FLOW[5:8]


def at(step: Step, elapsed_ms: int = 0, level: int = 3, selection: int = 2, mode: int = 1) -> State:
    """The state of an insertion of ``level`` that has come as far as ``step``, with ``selection`` latched."""
    accepted = level if step in IN_FLOW else -1
    authority = level if step in IN_FLOW[1:] else -1
    latched = selection if step in LATCHED else -1
    return State(PARAMS, step, accepted, authority, latched, mode, elapsed_ms)


def inputs(LA: bool = True, on: str = "D", MW03: int = 0, MW07: int = 0, dt_ms: int = 10) -> Inputs:
    """One scan's inputs; ``on`` names the EKS outputs that are set."""
    names = on.split()
    assert all(name in OUTPUTS for name in names)
    return Inputs(dt_ms, LA, *(name in names for name in OUTPUTS), MW03, MW07)


def after(state: State, i: Inputs) -> State:
    return fplc.step(state, i)[0]


# Every step of interface.toml: name, state before, inputs, control state after.
ROWS = [
    ("AwaitPowerUpZeros", at(Step.START), inputs(False, ""), Step.START),
    ("AwaitPowerUpZeros", at(Step.START, 400), inputs(True, ""), Step.START),
    ("AwaitPowerUpZeros", at(Step.START, 400), inputs(False, "STR"), Step.START),
    ("AwaitPowerUpZeros", at(Step.START, 400), inputs(False, "", MW03=SE[0]), Step.START),
    ("AwaitPowerUpZeros", at(Step.START, 400), inputs(False, "", MW07=1), Step.START),
    ("LeaveStart", at(Step.START, 400), inputs(False, ""), Step.IDLE),
    ("AwaitKey", at(Step.IDLE), inputs(False, ""), Step.IDLE),
    ("AwaitKey", at(Step.IDLE), inputs(False, "C", MW03=1, MW07=1), Step.IDLE),
    ("DetectKey", at(Step.IDLE), inputs(True, ""), Step.PULSE_ONES),
    ("DetectKey", at(Step.IDLE), inputs(True, "A STR"), Step.PULSE_ONES),
    ("AwaitOnes", at(Step.PULSE_ONES), inputs(True, ""), Step.PULSE_ONES),
    ("AwaitOnes", at(Step.PULSE_ONES), inputs(True, "A B C D"), Step.PULSE_ONES),
    ("SeeOnes", at(Step.PULSE_ONES), inputs(True, ALL), Step.PULSE_ZEROS),
    ("AwaitPulseZeros", at(Step.PULSE_ZEROS), inputs(True, ALL), Step.PULSE_ZEROS),
    ("AwaitPulseZeros", at(Step.PULSE_ZEROS), inputs(True, "B"), Step.PULSE_ZEROS),
    ("SeePulseZeros", at(Step.PULSE_ZEROS), inputs(True, ""), Step.ONE_OUTPUT),
    ("AwaitOneOutput", at(Step.ONE_OUTPUT), inputs(True, ""), Step.ONE_OUTPUT),
    ("AcceptOutput", at(Step.ONE_OUTPUT), inputs(True, "STR"), Step.AUTHORIZE),
    ("PublishAuthority", at(Step.AUTHORIZE), inputs(), Step.AWAIT_SELECTION),
    ("RefuseEarlyWord", at(Step.AUTHORIZE), inputs(MW03=SE[2]), Step.ERROR),
    ("RefuseEarlyWord", at(Step.AUTHORIZE), inputs(MW07=SW[2]), Step.ERROR),
    ("AwaitMW03", at(Step.AWAIT_SELECTION), inputs(), Step.AWAIT_SELECTION),
    ("SeeSelection", at(Step.AWAIT_SELECTION), inputs(MW03=NOT_A_CODE), Step.CHECK_SELECTION),
    ("AcceptSelection", at(Step.CHECK_SELECTION), inputs(MW03=SE[3]), Step.ECHO_SELECTION),
    ("RefuseSelection", at(Step.CHECK_SELECTION), inputs(MW03=SE[4]), Step.ERROR),
    ("RefuseSelection", at(Step.CHECK_SELECTION), inputs(MW03=NOT_A_CODE), Step.ERROR),
    ("PublishEcho", at(Step.ECHO_SELECTION), inputs(MW03=SE[2]), Step.AWAIT_ACKNOWLEDGMENT),
    ("AwaitMW07", at(Step.AWAIT_ACKNOWLEDGMENT), inputs(MW03=SE[2]), Step.AWAIT_ACKNOWLEDGMENT),
    (
        "SeeAcknowledgment",
        at(Step.AWAIT_ACKNOWLEDGMENT),
        inputs(MW03=SE[2], MW07=1),
        Step.CHECK_ACKNOWLEDGMENT,
    ),
    ("AcceptAcknowledgment", at(Step.CHECK_ACKNOWLEDGMENT), inputs(MW03=SE[2], MW07=SW[4]), Step.MATCH),
    ("RefuseAcknowledgment", at(Step.CHECK_ACKNOWLEDGMENT), inputs(MW03=SE[2], MW07=NOT_A_CODE), Step.ERROR),
    ("MatchWords", at(Step.MATCH), inputs(MW03=SE[2], MW07=SW[2]), Step.SWITCH),
    ("RefuseMatch", at(Step.MATCH), inputs(MW03=SE[2], MW07=SW[3]), Step.ERROR),
    ("RefuseMatch", at(Step.SWITCH), inputs(MW03=SE[2], MW07=SW[3]), Step.ERROR),
    ("RefuseMatch", at(Step.SWITCH), inputs(MW03=SE[2], MW07=NOT_A_CODE), Step.ERROR),
    ("SwitchMode", at(Step.SWITCH), inputs(MW03=SE[2], MW07=SW[2]), Step.SETTLE),
    *[
        ("AwaitRemoval", at(Step.COMPLETE), inputs(MW03=MW03, MW07=MW07, dt_ms=10**9), Step.COMPLETE)
        for MW03 in (0, SE[1], SE[2], NOT_A_CODE)
        for MW07 in (0, SW[2], NOT_A_CODE)
    ],
    ("WithdrawSelection", at(Step.CHECK_SELECTION), inputs(), Step.SETTLE),
    *[
        ("WithdrawSelection", at(s), inputs(MW03=w, MW07=SW[2]), Step.SETTLE)
        for s in WITH_SELECTION
        for w in (0, SE[1])
    ],
    *[("RefuseSelection", at(s), inputs(MW03=NOT_A_CODE, MW07=SW[2]), Step.ERROR) for s in WITH_SELECTION],
    *[("WithdrawAcknowledgment", at(s), inputs(MW03=SE[2]), Step.SETTLE) for s in WITH_ACKNOWLEDGMENT],
    ("UnexpectedAcknowledgment", at(Step.AWAIT_SELECTION), inputs(MW03=SE[2], MW07=SW[2]), Step.ERROR),
    ("UnexpectedAcknowledgment", at(Step.CHECK_SELECTION), inputs(MW03=0, MW07=SW[2]), Step.ERROR),
    ("UnexpectedAcknowledgment", at(Step.ECHO_SELECTION), inputs(MW03=SE[2], MW07=SW[2]), Step.ERROR),
    ("AwaitSettled", at(Step.SETTLE), inputs(), Step.SETTLE),
    ("AwaitSettled", at(Step.SETTLE, 400), inputs(MW03=SE[2]), Step.SETTLE),
    ("AwaitSettled", at(Step.SETTLE, 400), inputs(MW07=NOT_A_CODE), Step.SETTLE),
    ("LeaveSettle", at(Step.SETTLE, 400), inputs(), Step.AWAIT_SELECTION),
    ("ClearWords", at(Step.CLEAR), inputs(True, "D", MW03=1), Step.AWAIT_ZEROS),
    ("AwaitReturnedZeros", at(Step.AWAIT_ZEROS), inputs(False, ""), Step.AWAIT_ZEROS),
    ("AwaitReturnedZeros", at(Step.AWAIT_ZEROS, 400), inputs(True, ""), Step.AWAIT_ZEROS),
    ("AwaitReturnedZeros", at(Step.AWAIT_ZEROS, 400), inputs(False, "STR"), Step.AWAIT_ZEROS),
    ("AwaitReturnedZeros", at(Step.AWAIT_ZEROS, 400), inputs(False, "", MW03=SE[1]), Step.AWAIT_ZEROS),
    ("AwaitReturnedZeros", at(Step.AWAIT_ZEROS, 400), inputs(False, "", MW07=1), Step.AWAIT_ZEROS),
    ("LeaveAwaitZeros", at(Step.AWAIT_ZEROS, 400), inputs(False, ""), Step.IDLE),
    ("StayInError", at(Step.ERROR, 400), inputs(True, ""), Step.ERROR),
    ("StayInError", at(Step.ERROR, 400), inputs(False, ALL), Step.ERROR),
    ("StayInError", at(Step.ERROR, 400), inputs(False, "", MW03=1), Step.ERROR),
    ("StayInError", at(Step.ERROR, 400), inputs(False, "", MW07=1), Step.ERROR),
    ("StayInError", at(Step.ERROR), inputs(False, ""), Step.ERROR),
    ("LeaveError", at(Step.ERROR, 400), inputs(False, ""), Step.IDLE),
    *[
        ("TooManyOutputs", at(s), inputs(False, on), Step.ERROR)
        for s in Step
        if s not in (Step.PULSE_ONES, Step.PULSE_ZEROS, Step.ERROR)
        for on in ("A B", "B C", "C D", "D STR", "A STR", ALL)
    ],
    *[
        ("KeyGone", at(s), inputs(False, "D", MW03=SE[2], MW07=SW[2]), Step.CLEAR)
        for s in (Step.PULSE_ONES, Step.PULSE_ZEROS, Step.ONE_OUTPUT, *IN_FLOW)
    ],
    *[
        ("VectorChanged", at(s), inputs(True, on, MW03=SE[2], MW07=SW[2]), Step.CLEAR)
        for s in IN_FLOW
        for on in ("", "C", "STR")
    ],
    ("DeadlineExpired", at(Step.PULSE_ONES, 790), inputs(True, ALL), Step.ERROR),
    ("DeadlineExpired", at(Step.PULSE_ZEROS, 890), inputs(True, ""), Step.ERROR),
    ("DeadlineExpired", at(Step.ONE_OUTPUT, 890), inputs(True, "D"), Step.ERROR),
    ("DeadlineExpired", at(Step.SETTLE, 690), inputs(), Step.ERROR),
    ("DeadlineExpired", at(Step.CLEAR, 690), inputs(False, ""), Step.ERROR),
    ("DeadlineExpired", at(Step.AWAIT_ZEROS, 690), inputs(False, ""), Step.ERROR),
]


ROW_IDS = [f"{name}-{before.state.value}" for name, before, _, _ in ROWS]
TIMED = (
    Step.START,
    Step.PULSE_ONES,
    Step.PULSE_ZEROS,
    Step.ONE_OUTPUT,
    Step.SETTLE,
    Step.CLEAR,
    Step.AWAIT_ZEROS,
    Step.ERROR,
)


@pytest.mark.parametrize(("name", "before", "i", "expected"), ROWS, ids=ROW_IDS)
def test_step_leads_to_the_state_that_the_procedure_names(
    name: str, before: State, i: Inputs, expected: Step
) -> None:
    assert after(before, i).state == expected


def test_the_rows_cover_every_registered_step_and_state() -> None:
    assert {name for name, *_ in ROWS} == set(FPLC["steps"])
    assert {state.state.value for _, state, *_ in ROWS} == set(FPLC["states"])


# ---------------------------------------------------------------- timers: reached at >=, not beyond


@pytest.mark.parametrize(
    ("step", "limit", "i", "expected"),
    [
        (Step.PULSE_ONES, 800, inputs(True, ALL, dt_ms=1), Step.PULSE_ZEROS),
        (Step.PULSE_ONES, 800, inputs(True, "", dt_ms=1), Step.PULSE_ONES),
        (Step.PULSE_ZEROS, 900, inputs(True, "", dt_ms=1), Step.ONE_OUTPUT),
        (Step.ONE_OUTPUT, 900, inputs(True, "A", dt_ms=1), Step.AUTHORIZE),
        (Step.CLEAR, 700, inputs(False, "", dt_ms=1), Step.AWAIT_ZEROS),
        (Step.AWAIT_ZEROS, 700, inputs(False, "", dt_ms=1), Step.IDLE),
    ],
)
def test_a_deadline_expires_at_the_exact_millisecond(
    step: Step, limit: int, i: Inputs, expected: Step
) -> None:
    assert after(at(step, limit - 2), i).state == expected
    assert after(at(step, limit - 1), i).state == Step.ERROR


@pytest.mark.parametrize(
    ("step", "LA", "on", "left_to"),
    [
        (Step.START, False, "", Step.IDLE),
        (Step.SETTLE, True, "D", Step.AWAIT_SELECTION),
        (Step.AWAIT_ZEROS, False, "", Step.IDLE),
        (Step.ERROR, False, "", Step.IDLE),
    ],
)
def test_zeros_have_returned_at_the_exact_millisecond_of_the_dwell(
    step: Step, LA: bool, on: str, left_to: Step
) -> None:
    assert after(at(step, 398), inputs(LA, on, dt_ms=1)).state == step
    assert after(at(step, 399), inputs(LA, on, dt_ms=1)).state == left_to


def test_the_time_of_the_first_scan_after_power_up_counts() -> None:
    assert after(fplc.power_up(PARAMS), inputs(False, "", dt_ms=400)).state == Step.IDLE


@pytest.mark.parametrize(("params", "at_ones"), [(PARAMS, 510), (FROM_ONES, 0)], ids=["LA", "ones"])
def test_the_sequence_timer_starts_at_la_or_ones_and_continues(params: Params, at_ones: int) -> None:
    ones = after(replace(at(Step.PULSE_ONES, 500), params=params), inputs(True, ALL))
    assert (ones.state, ones.elapsed_ms) == (Step.PULSE_ZEROS, at_ones)
    zeros = after(after(ones, inputs(True, ALL, dt_ms=200)), inputs(True, "", dt_ms=100))
    assert (zeros.state, zeros.elapsed_ms) == (Step.ONE_OUTPUT, at_ones + 300)


def sequence(params: Params, ones_ms: int, zeros_ms: int, output_ms: int) -> list[Step]:
    """The states after the scans that see LA, all ones, zeros, one output, so long after the one before."""
    state, states = State(params, Step.IDLE, -1, -1, -1, 1, 0), []
    for on, dt_ms in (("", 77), (ALL, ones_ms), ("", zeros_ms), ("D", output_ms)):
        state = after(state, inputs(True, on, dt_ms=dt_ms))
        states.append(state.state)
    return states


COMPLETE = [Step.PULSE_ONES, Step.PULSE_ZEROS, Step.ONE_OUTPUT, Step.AUTHORIZE]


@pytest.mark.parametrize(
    ("params", "in_time", "late", "reached"),
    [
        (PARAMS, (799, 50, 50), (800, 50, 50), 1),
        (PARAMS, (799, 100, 0), (799, 101, 0), 2),
        (PARAMS, (799, 50, 50), (799, 50, 51), 3),
        (PARAMS, (0, 0, 899), (0, 0, 900), 3),
        (FROM_ONES, (899, 50, 50), (900, 50, 50), 1),
        (FROM_ONES, (899, 799, 0), (899, 800, 0), 2),
        (FROM_ONES, (899, 400, 399), (899, 400, 400), 3),
    ],
)
def test_the_sequence_has_one_window_from_la_two_from_ones(
    params: Params, in_time: tuple[int, int, int], late: tuple[int, int, int], reached: int
) -> None:
    assert sequence(params, *in_time) == COMPLETE
    stopped = sequence(params, *late)
    assert stopped[:reached] == COMPLETE[:reached]
    assert stopped[reached] == Step.ERROR


def test_with_one_window_ones_may_take_all_of_it() -> None:
    same = replace(PARAMS, T_ON_ms=900)
    assert sequence(same, 899, 0, 0) == COMPLETE
    assert sequence(same, 899, 1, 0)[2] == Step.ERROR


def test_the_removal_timer_runs_from_clear_through_await_zeros() -> None:
    clear = after(at(Step.AWAIT_SELECTION), inputs(False, "D", dt_ms=77))
    assert (clear.state, clear.elapsed_ms) == (Step.CLEAR, 0)
    assert after(clear, inputs(False, "", dt_ms=77)).elapsed_ms == 77


@pytest.mark.parametrize("step", [Step.START, Step.ERROR])
def test_a_timer_without_a_deadline_stops_at_the_dwell(step: Step) -> None:
    assert after(at(step, 100), inputs(MW03=1, dt_ms=100)).elapsed_ms == 200
    assert after(at(step, 100), inputs(MW03=1, dt_ms=10**9)).elapsed_ms == 400


@pytest.mark.parametrize("step", [Step.IDLE, Step.AWAIT_SELECTION, Step.AWAIT_ACKNOWLEDGMENT])
def test_no_timer_runs_while_a_person_is_awaited(step: Step) -> None:
    on = "" if step == Step.IDLE else "D"
    waiting = after(
        at(step),
        inputs(step != Step.IDLE, on, MW03=0 if step != Step.AWAIT_ACKNOWLEDGMENT else SE[2], dt_ms=10**9),
    )
    assert (waiting.state, waiting.elapsed_ms) == (step, 0)


# ---------------------------------------------------------------- Figures 5, 6 and 7


@pytest.mark.parametrize("level", range(5))
@pytest.mark.parametrize("mode", range(5))
def test_figure_5_permits_only_modes_up_to_the_level(level: int, mode: int) -> None:
    assert fplc.permitted(RE[level], SE[mode]) == (mode <= level)
    expected = Step.ECHO_SELECTION if mode <= level else Step.ERROR
    output = OUTPUTS[level]
    assert after(at(Step.CHECK_SELECTION, level=level), inputs(on=output, MW03=SE[mode])).state == expected


@pytest.mark.parametrize("level", range(-1, 5))
def test_by_default_step_18_is_figure_5_for_every_word(level: int) -> None:
    RE_word = RE[level] if level >= 0 else 0
    for MW03 in range(0x10000):
        assert fplc.within_authority(Params(), level, MW03) == fplc.permitted(RE_word, MW03)


def test_figure_5_permits_no_word_that_is_no_mode() -> None:
    for MW03 in set(range(0x10000)) - set(SE):
        assert not any(fplc.permitted(MW01, MW03) for MW01 in (*RE, 0))


@pytest.mark.parametrize("level", range(5))
@pytest.mark.parametrize("mode", range(5))
def test_a_machine_may_permit_less_and_answers_more_with_error(level: int, mode: int) -> None:
    permits = ([0], [1], [2], [1, 2, 3], [4])
    before = replace(at(Step.CHECK_SELECTION, level=level), params=TEXT_ORDER)
    reached = after(before, inputs(on=OUTPUTS[level], MW03=SE[mode]))
    if mode in permits[level]:
        assert (reached.state, reached.selection) == (Step.ECHO_SELECTION, mode)
    else:
        assert (reached.state, reached.selection) == (Step.ERROR, -1)


def test_a_word_that_is_no_code_passes_on_no_machine() -> None:
    for level in range(5):
        for MW03 in set(range(0x10000)) - set(SE):
            assert not fplc.within_authority(TEXT_ORDER, level, MW03)


def test_figure_5_permits_nothing_to_words_without_a_level() -> None:
    for MW01 in set(range(0x10000)) - set(RE):
        assert not any(fplc.permitted(MW01, MW03) for MW03 in (*SE, 0))


def test_figure_6_answers_only_the_five_selection_words() -> None:
    answered = {word: fplc.echo(word) for word in range(0x10000) if fplc.echo(word) != 0}
    assert answered == {0x0FF0: 0x3333, 0x3333: 0x33CC, 0x33CC: 0x3C3C, 0x3C3C: 0x0F0F, 0x0F0F: 0x0FF0}


def test_figure_7_accepts_only_the_five_matching_pairs() -> None:
    selections = (*SE, 0, NOT_A_CODE)
    accepted = {(a, b) for a in selections for b in range(0x10000) if fplc.matches(a, b)}
    assert accepted == set(zip(SE, SW, strict=True))


def test_figure_7_row_5_follows_table_2_despite_its_misprint() -> None:
    assert fplc.matches(0x33CC, 0x0F0F)
    assert not fplc.matches(0x33CC, 0x0FF0)


def test_step_27_lets_any_acknowledgment_word_pass_and_no_other() -> None:
    assert {word for word in range(0x10000) if fplc.permissible_acknowledgment(word)} == set(SW)


# ---------------------------------------------------------------- outputs


@pytest.mark.parametrize("step", list(Step))
def test_outputs_are_the_row_of_the_state(step: Step) -> None:
    row = fplc.outputs(at(step, level=3, selection=2, mode=1))
    assert (RE[3] if step in IN_FLOW[1:9] else 0) == row.MW01
    assert (CH[2] if step in LATCHED[1:] else 0) == row.MW05
    assert (row.MSO_0, row.MSO_1, row.MSO_2, row.MSO_3, row.MSO_4) == (False, True, False, False, False)
    assert (step == Step.ERROR) == row.ERROR


def test_outputs_of_a_scan_are_of_the_state_after() -> None:
    for _, before, i, _ in ROWS:
        state, row = fplc.step(before, i)
        assert row == fplc.outputs(state)


@pytest.mark.parametrize("step", [*IN_FLOW[1:]])
def test_both_words_drop_in_the_scan_without_the_key(step: Step) -> None:
    _, row = fplc.step(at(step), inputs(False, "", MW03=SE[2], MW07=SW[2]))
    assert (row.MW01, row.MW05) == (0, 0)


@pytest.mark.parametrize("mode", range(5))
def test_the_mode_that_becomes_active_is_the_latched_selection(mode: int) -> None:
    state, row = fplc.step(
        at(Step.SWITCH, level=4, selection=mode, mode=(mode + 1) % 5),
        inputs(on="STR", MW03=SE[mode], MW07=SW[mode]),
    )
    assert state.mode == mode
    assert [m == mode for m in range(5)] == [row.MSO_0, row.MSO_1, row.MSO_2, row.MSO_3, row.MSO_4]


def test_with_one_selection_the_words_stay_until_the_key_goes() -> None:
    once = replace(at(Step.SWITCH), params=replace(PARAMS, SELECTIONS="once"))
    state, row = fplc.step(once, inputs(MW03=SE[2], MW07=SW[2]))
    assert (state.state, state.selection, state.mode) == (Step.COMPLETE, 2, 2)
    assert (RE[3], CH[2], True) == (row.MW01, row.MW05, row.MSO_2)
    for i in (inputs(), inputs(MW03=SE[1]), inputs(MW03=SE[1], MW07=SW[1]), inputs(MW03=NOT_A_CODE)):
        assert fplc.step(state, i) == (state, row)
    state, row = fplc.step(state, inputs(False, ""))
    assert (state.state, row.MW01, row.MW05, row.MSO_2) == (Step.CLEAR, 0, 0, True)


def test_power_up_is_start_without_memory_or_active_mode() -> None:
    assert fplc.power_up(PARAMS) == State(PARAMS, Step.START, -1, -1, -1, -1, 0)
    row = fplc.outputs(fplc.power_up(PARAMS))
    assert not any((row.MSO_0, row.MSO_1, row.MSO_2, row.MSO_3, row.MSO_4, row.ERROR, row.MW01, row.MW05))


# ---------------------------------------------------------------- memory


def test_an_accepted_level_becomes_the_authority_when_it_is_published() -> None:
    for level, name in enumerate(OUTPUTS):
        accepted = after(at(Step.ONE_OUTPUT), inputs(on=name))
        assert (accepted.accepted, accepted.authority) == (level, -1)
        published, row = fplc.step(accepted, inputs(on=name))
        assert (published.authority, row.MW01) == (level, RE[level])


@pytest.mark.parametrize(("name", "before", "i", "to"), ROWS, ids=ROW_IDS)
def test_a_step_changes_only_the_memory_that_belongs_to_it(
    name: str, before: State, i: Inputs, to: Step
) -> None:
    """What the step is about changes; what the new state does not need is dropped; all else stays."""
    state = after(before, i)
    accepted = fplc.output_signalled(i) if name == "AcceptOutput" else before.accepted
    authority = before.accepted if name == "PublishAuthority" else before.authority
    selection = decode(SE, i.MW03) if name == "AcceptSelection" else before.selection
    assert state.accepted == (accepted if to in IN_FLOW else -1)
    assert state.authority == (authority if to in IN_FLOW[1:] else -1)
    assert state.selection == (selection if to in LATCHED else -1)
    assert state.mode == (before.selection if name == "SwitchMode" else before.mode)
    assert state.params == PARAMS


@pytest.mark.parametrize(("name", "before", "i", "to"), ROWS, ids=ROW_IDS)
def test_timers_restart_in_new_states_or_stop_where_not_needed(
    name: str, before: State, i: Inputs, to: Step
) -> None:
    elapsed = 0
    if name in ("SeeOnes", "SeePulseZeros", "ClearWords") or (to == before.state and to in TIMED):
        elapsed = before.elapsed_ms + i.dt_ms
    if to in (Step.START, Step.ERROR):
        elapsed = min(elapsed, 400)
    assert after(before, i).elapsed_ms == elapsed


@pytest.mark.parametrize("step", WITH_SELECTION)
def test_settle_forgets_the_selection_and_keeps_the_authority(step: Step) -> None:
    settled = after(at(step, mode=1), inputs())
    assert (settled.state, settled.selection, settled.authority, settled.mode) == (Step.SETTLE, -1, 3, 1)


@pytest.mark.parametrize("step", IN_FLOW)
@pytest.mark.parametrize("i", [inputs(False, ""), inputs(True, ALL)], ids=["Clear", "Error"])
def test_removal_and_error_forget_the_insertion_and_hold_the_mode(step: Step, i: Inputs) -> None:
    forgotten = after(at(step, mode=1), i)
    assert (forgotten.accepted, forgotten.authority, forgotten.selection) == (-1, -1, -1)
    assert forgotten.mode == 1


def test_the_parameter_drops_the_mode_in_error_not_in_removal() -> None:
    dropping = replace(PARAMS, ON_ERROR="none")
    state = replace(at(Step.AWAIT_SELECTION, mode=1), params=dropping)
    assert after(state, inputs(True, ALL)) == State(dropping, Step.ERROR, -1, -1, -1, -1, 0)
    assert after(state, inputs(False, "")).mode == 1


def test_a_mode_that_is_selected_again_needs_a_new_acknowledgment() -> None:
    state = after(at(Step.SWITCH), inputs(MW03=SE[2], MW07=SW[2]))
    for _ in range(6):
        state = after(state, inputs(MW03=SE[2], MW07=SW[2], dt_ms=100))
        assert state.state == Step.SETTLE
    assert after(state, inputs(MW03=SE[2], MW07=SW[2], dt_ms=100)).state == Step.ERROR


# ---------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("MW03", 65536),
        ("MW03", -1),
        ("MW07", True),
        ("MW07", "0FF0"),
        ("MW07", 1.0),
        ("MW03", None),
        ("LA", 1),
        ("STR", None),
        ("A", "true"),
        ("dt_ms", -1),
        ("dt_ms", 0.5),
        ("dt_ms", False),
    ],
)
def test_a_wrong_input_is_refused_by_name_and_never_coerced(field: str, value: object) -> None:
    with pytest.raises(InputError, match=rf"^{field}: expected ") as caught:
        replace(inputs(), **{field: value})
    assert caught.value.field == field


def test_a_missing_and_an_extra_input_are_refused_by_name() -> None:
    good = {field.name: getattr(inputs(), field.name) for field in fields(Inputs)}
    assert checked(Inputs, good) == inputs()
    with pytest.raises(InputError, match=r"^MW07: expected a value"):
        checked(Inputs, {name: value for name, value in good.items() if name != "MW07"})
    with pytest.raises(InputError, match=r"^MW09: expected nothing"):
        checked(Inputs, good | {"MW09": 0})


# What no level can permit: its own mode left out, one above it, or no five booleans.
WRONG_PERMITS = [
    ("PERMITS_0", (False, False, False, False, False)),
    ("PERMITS_0", (True, True, False, False, False)),
    ("PERMITS_1", (True, False, False, False, False)),
    ("PERMITS_2", (True, True, True, False, True)),
    ("PERMITS_3", (True, True, True, True, True)),
    ("PERMITS_4", (True, True, True, True, False)),
    ("PERMITS_2", (True, True, True, False)),
    ("PERMITS_2", (True, True, True, False, False, False)),
    ("PERMITS_2", [True, True, True, False, False]),
    ("PERMITS_2", (1, 1, 1, 0, 0)),
    ("PERMITS_2", [2]),
    ("PERMITS_2", None),
]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("T_ON_ms", 0),
        ("T_SEQ_ms", 3_600_001),
        ("T_REM_ms", True),
        ("T_DWELL_ms", -1),
        ("T_DWELL_ms", 700),
        ("T_SEQ_FROM", "zeros"),
        ("T_SEQ_FROM", "la"),
        ("T_SEQ_FROM", None),
        *WRONG_PERMITS,
        ("ON_ERROR", "drop"),
        ("ON_ERROR", None),
        ("SELECTIONS", "twice"),
        ("SELECTIONS", None),
    ],
)
def test_a_wrong_parameter_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=rf"^{field}: expected "):
        replace(PARAMS, **{field: value})


def test_the_dwell_must_be_shorter_than_the_removal() -> None:
    assert Params(T_REM_ms=501, T_DWELL_ms=500).T_DWELL_ms == 500
    with pytest.raises(ParameterError, match="T_DWELL_ms: expected less than T_REM_ms"):
        Params(T_REM_ms=500, T_DWELL_ms=500)


def test_one_window_cannot_be_shorter_than_the_wait_for_ones() -> None:
    assert Params(T_ON_ms=900, T_SEQ_ms=900, T_SEQ_FROM="LA").T_SEQ_ms == 900
    assert Params(T_ON_ms=900, T_SEQ_ms=1, T_SEQ_FROM="ones").T_SEQ_ms == 1
    with pytest.raises(ParameterError, match=r"^T_SEQ_ms: expected at least T_ON_ms \(900\)"):
        Params(T_ON_ms=900, T_SEQ_ms=899, T_SEQ_FROM="LA")


def test_a_control_state_that_does_not_exist_never_switches() -> None:
    forged = replace(at(Step.SWITCH), state="Switch")
    with pytest.raises(StateError, match="state"):
        fplc.step(forged, inputs(MW03=SE[2], MW07=SW[2]))

"""The touchscreen: every step, what is shown and sent in each state, and where the fields may lie."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError, LayoutError, ParameterError, StateError
from refimpl.mode_selection import hmi
from refimpl.mode_selection.code_tables import CH, RE, SE, SW
from refimpl.mode_selection.hmi import DEFAULT_LAYOUT, Inputs, Layout, Params, Rectangle, State, Step

ROOT = Path(__file__).resolve().parents[3]
INTERFACE = tomllib.loads((ROOT / "spec/mode_selection/interface.toml").read_text(encoding="utf-8"))
HMI = INTERFACE["devices"]["hmi"]

NOT_A_CODE = 0x0F0E
WITH_SELECTION = (Step.AWAIT_ECHO, Step.CONFIRM, Step.AWAIT_SWITCH)


def at(step: Step, offered: int = 3, selection: int = 2) -> State:
    """The panel in ``step``, opened for level ``offered``, ``selection`` touched where the step has one."""
    return State(
        Params(), step, -1 if step == Step.INHIBITED else offered, selection if step in WITH_SELECTION else -1
    )


def inputs(RA: int = RE[3], CM: int = 0, touch: str = "", ActiveMSO: int = -1) -> Inputs:
    return Inputs(10, RA, CM, ActiveMSO, touch)


# Every step of interface.toml: name, state before, inputs, state after.
ROWS = [
    ("StayInhibited", at(Step.INHIBITED), inputs(0), at(Step.INHIBITED)),
    ("StayInhibited", at(Step.INHIBITED), inputs(NOT_A_CODE), at(Step.INHIBITED)),
    ("StayInhibited", at(Step.INHIBITED), inputs(RE[3], CM=CH[0]), at(Step.INHIBITED)),
    ("StayInhibited", at(Step.INHIBITED), inputs(RE[3], CM=NOT_A_CODE), at(Step.INHIBITED)),
    ("StayInhibited", at(Step.INHIBITED), inputs(0, touch="select:0"), at(Step.INHIBITED)),
    ("EnableScreen", at(Step.INHIBITED), inputs(RE[3], touch="select:0"), at(Step.SELECT)),
    *[
        ("InhibitScreen", at(step), inputs(RA, CM=CM, touch=touch), at(Step.INHIBITED))
        for step in Step
        if step != Step.INHIBITED
        for RA in (0, NOT_A_CODE, RE[2], RE[4])
        for CM in (0, CH[2])
        for touch in ("", "select:1", "confirm", "reject")
    ],
    ("InhibitScreen", at(Step.SELECT), inputs(CM=CH[2]), at(Step.INHIBITED)),
    ("InhibitScreen", at(Step.SELECT), inputs(CM=NOT_A_CODE, touch="select:1"), at(Step.INHIBITED)),
    ("OfferModes", at(Step.SELECT), inputs(), at(Step.SELECT)),
    ("OfferModes", at(Step.SELECT), inputs(touch="select:4"), at(Step.SELECT)),
    ("OfferModes", at(Step.SELECT), inputs(touch="confirm"), at(Step.SELECT)),
    ("OfferModes", at(Step.SELECT), inputs(touch="reject"), at(Step.SELECT)),
    *[
        ("TouchSelection", at(Step.SELECT), inputs(touch=f"select:{m}"), at(Step.AWAIT_ECHO, selection=m))
        for m in range(4)
    ],
    *[
        ("AwaitCheckMSO", at(Step.AWAIT_ECHO), inputs(touch=touch), at(Step.AWAIT_ECHO))
        for touch in ("", "select:1", "confirm", "reject")
    ],
    ("ShowEcho", at(Step.AWAIT_ECHO), inputs(CM=CH[2]), at(Step.CONFIRM)),
    ("ShowEcho", at(Step.AWAIT_ECHO), inputs(CM=CH[2], touch="confirm"), at(Step.CONFIRM)),
    ("AbandonSelection", at(Step.AWAIT_ECHO), inputs(CM=CH[1]), at(Step.WITHDRAWN)),
    ("AbandonSelection", at(Step.AWAIT_ECHO), inputs(CM=NOT_A_CODE), at(Step.WITHDRAWN)),
    ("AbandonSelection", at(Step.CONFIRM), inputs(CM=0, touch="confirm"), at(Step.WITHDRAWN)),
    ("AbandonSelection", at(Step.CONFIRM), inputs(CM=CH[1], touch="confirm"), at(Step.WITHDRAWN)),
    ("AskConfirmation", at(Step.CONFIRM), inputs(CM=CH[2]), at(Step.CONFIRM)),
    ("AskConfirmation", at(Step.CONFIRM), inputs(CM=CH[2], touch="select:2"), at(Step.CONFIRM)),
    ("TouchConfirm", at(Step.CONFIRM), inputs(CM=CH[2], touch="confirm"), at(Step.AWAIT_SWITCH)),
    ("TouchReject", at(Step.CONFIRM), inputs(CM=CH[2], touch="reject"), at(Step.WITHDRAWN)),
    *[
        ("AwaitCleared", at(Step.AWAIT_SWITCH), inputs(CM=CH[2], touch=touch), at(Step.AWAIT_SWITCH))
        for touch in ("", "reject", "select:1")
    ],
    ("FinishSelection", at(Step.AWAIT_SWITCH), inputs(touch="select:1"), at(Step.SELECT)),
    ("FinishSelection", at(Step.WITHDRAWN), inputs(touch="select:1"), at(Step.SELECT)),
    ("AbandonSelection", at(Step.AWAIT_SWITCH), inputs(CM=CH[1]), at(Step.WITHDRAWN)),
    ("AwaitWithdrawn", at(Step.WITHDRAWN), inputs(CM=CH[2], touch="confirm"), at(Step.WITHDRAWN)),
]


@pytest.mark.parametrize(
    ("name", "before", "i", "expected"),
    ROWS,
    ids=[f"{name}-{before.state.value}" for name, before, *_ in ROWS],
)
def test_step_leads_where_the_procedure_says(name: str, before: State, i: Inputs, expected: State) -> None:
    assert hmi.step(before, i)[0] == expected


def test_power_up_is_inhibited_with_nothing_remembered() -> None:
    assert hmi.power_up(Params()) == State(Params(), Step.INHIBITED, -1, -1)


def test_the_rows_cover_every_registered_step_and_state() -> None:
    assert {name for name, *_ in ROWS} == set(HMI["steps"])
    assert {before.state.value for _, before, *_ in ROWS} == set(HMI["states"])


def test_touches_are_those_of_the_register() -> None:
    assert list(hmi.TOUCHES) == HMI["inputs"]["touch"]["values"]


# ---------------------------------------------------------------- outputs


@pytest.mark.parametrize("step", list(Step))
def test_words_and_screen_are_the_row_of_the_state(step: Step) -> None:
    row = hmi.outputs(at(step), active=1)
    assert row.SelectMSO == (SE[2] if step in WITH_SELECTION else 0)
    assert row.SwitchMSO == (SW[2] if step == Step.AWAIT_SWITCH else 0)
    screens = {Step.INHIBITED: "inhibited", Step.SELECT: "select", Step.CONFIRM: "confirm"}
    assert row.screen == screens.get(step, "waiting")
    assert row.shown == (2 if step == Step.CONFIRM else -1)
    assert row.enabled == ((True, True, True, True, False) if step == Step.SELECT else (False,) * 5)
    assert row.active == 1


@pytest.mark.parametrize("level", range(5))
def test_the_screen_offers_only_modes_up_to_the_level(level: int) -> None:
    opened, row = hmi.step(hmi.power_up(Params()), inputs(RE[level]))
    assert [mode for mode in range(5) if row.enabled[mode]] == list(range(level + 1))
    for mode in range(5):
        touched, _ = hmi.step(opened, inputs(RE[level], touch=f"select:{mode}"))
        assert (touched.state == Step.AWAIT_ECHO) == (mode <= level)


def modes(*members: int) -> tuple[bool, ...]:
    return tuple(mode in members for mode in range(5))


TEXT_ORDER = Params(PERMITS_1=modes(1), PERMITS_2=modes(2), PERMITS_3=modes(1, 2, 3), PERMITS_4=modes(4))  # type: ignore[arg-type]


@pytest.mark.parametrize(("level", "permits"), list(enumerate([[0], [1], [2], [1, 2, 3], [4]])))
def test_the_panel_offers_and_takes_what_the_machine_permits(level: int, permits: list[int]) -> None:
    opened, row = hmi.step(hmi.power_up(TEXT_ORDER), inputs(RE[level]))
    assert (opened.state, row.enabled) == (Step.SELECT, modes(*permits))
    for mode in range(5):
        touched, row = hmi.step(opened, inputs(RE[level], touch=f"select:{mode}"))
        if mode in permits:
            assert (touched.state, touched.selection, row.SelectMSO) == (Step.AWAIT_ECHO, mode, SE[mode])
        else:
            assert touched == opened
            assert (row.SelectMSO, row.screen) == (0, "select")


@pytest.mark.parametrize("level", range(5))
def test_a_finger_on_a_forbidden_field_is_no_touch(level: int) -> None:
    _, row = hmi.step(hmi.power_up(TEXT_ORDER), inputs(RE[level]))
    for mode, field in enumerate(DEFAULT_LAYOUT.selection):
        meant = hmi.touch_at(DEFAULT_LAYOUT, row, field.x, field.y)
        assert meant == (f"select:{mode}" if row.enabled[mode] else "")


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("PERMITS_0", modes()),
        ("PERMITS_0", modes(0, 1)),
        ("PERMITS_1", modes(0)),
        ("PERMITS_2", modes(2, 4)),
        ("PERMITS_3", modes(0, 1, 2, 3, 4)),
        ("PERMITS_4", modes(0, 1, 2, 3)),
        ("PERMITS_4", (True, True, True, True)),
        ("PERMITS_4", [True] * 5),
        ("PERMITS_4", (1, 1, 1, 1, 1)),
        ("PERMITS_4", None),
    ],
)
def test_a_wrong_parameter_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=rf"^{field}: expected "):
        replace(Params(), **{field: value})


@pytest.mark.parametrize("active", range(-1, 5))
def test_the_active_mode_shows_on_an_inhibited_screen_too(active: int) -> None:
    _, row = hmi.step(hmi.power_up(Params()), inputs(0, ActiveMSO=active))
    assert (row.screen, row.active) == ("inhibited", active)


SCAN = st.builds(
    Inputs,
    st.just(10),
    st.sampled_from([0, NOT_A_CODE, *RE]),
    st.sampled_from([0, NOT_A_CODE, *CH]),
    st.integers(-1, 4),
    st.sampled_from(hmi.TOUCHES),
)


@given(st.lists(SCAN, max_size=60))
def test_only_a_mode_touched_shown_and_confirmed_is_acknowledged(scans: list[Inputs]) -> None:
    state, row = hmi.power_up(Params()), hmi.outputs(hmi.power_up(Params()))
    touched = confirmed = -1
    for i in scans:
        before = row
        state, row = hmi.step(state, i)
        if before.screen == "select" and i.touch.startswith("select:") and row.SelectMSO != 0:
            touched, confirmed = int(i.touch[-1]), -1
        if before.screen == "confirm" and i.touch == "confirm" and i.CheckMSO == CH[touched]:
            assert before.shown == touched
            confirmed = touched
        if row.SelectMSO != 0:
            assert row.SelectMSO == SE[touched]
        if row.SwitchMSO != 0:
            assert row.SwitchMSO == SW[touched]
            assert touched == confirmed
        if row.screen == "inhibited":
            assert (row.SelectMSO, row.SwitchMSO) == (0, 0)


# ---------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("ReadAuthorization", 65536),
        ("CheckMSO", -1),
        ("CheckMSO", True),
        ("ActiveMSO", 5),
        ("ActiveMSO", -2),
        ("ActiveMSO", None),
        ("touch", "select:5"),
        ("touch", None),
        ("touch", "Confirm"),
        ("dt_ms", -1),
    ],
)
def test_a_wrong_input_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(InputError, match=rf"^{field}: expected "):
        replace(inputs(), **{field: value})


def test_a_control_state_that_does_not_exist_is_refused() -> None:
    with pytest.raises(StateError, match=r"^state:"):
        hmi.step(replace(at(Step.CONFIRM), state="Confirm"), inputs(CM=CH[2], touch="confirm"))


# ---------------------------------------------------------------- layout


def test_the_default_layout_keeps_the_rule() -> None:
    hmi.check_layout(DEFAULT_LAYOUT)
    assert hmi.layout_record(DEFAULT_LAYOUT)["confirm"] == [560, 380, 220, 80]


def test_fields_may_touch_each_other_without_sharing_a_coordinate() -> None:
    fields_in_column = tuple(Rectangle(300, 100 + 50 * mode, 200, 50) for mode in range(5))
    for confirm in (Rectangle(500, 350, 100, 50), Rectangle(200, 50, 100, 50)):
        layout = replace(
            DEFAULT_LAYOUT, selection=fields_in_column, confirm=confirm, reject=Rectangle(0, 0, 9, 9)
        )
        hmi.check_layout(layout)


SAME_COLUMN = replace(
    DEFAULT_LAYOUT, confirm=Rectangle(319, 380, 220, 80), reject=Rectangle(560, 380, 200, 80)
)
SAME_ROW = replace(DEFAULT_LAYOUT, confirm=Rectangle(560, 309, 220, 60))
LAYOUT_FAULTS = [
    (SAME_COLUMN, "confirm", "X coordinate in common with selection"),
    (SAME_ROW, "confirm", r"Y coordinate in common with selection\[4\]"),
    (replace(DEFAULT_LAYOUT, confirm=DEFAULT_LAYOUT.selection[2]), "confirm", "in common with selection"),
    (replace(DEFAULT_LAYOUT, confirm=Rectangle(0, 0, 800, 480)), "confirm", "in common with selection"),
    (replace(DEFAULT_LAYOUT, confirm=Rectangle(560, 401, 220, 80)), "confirm", "on the screen"),
    (replace(DEFAULT_LAYOUT, confirm=Rectangle(560, 380, 0, 80)), "confirm.width", "integer >= 1"),
    (replace(DEFAULT_LAYOUT, confirm=Rectangle(560, 380, 220, True)), "confirm.height", "integer >= 1"),
    (replace(DEFAULT_LAYOUT, confirm=Rectangle(-1, 380, 220, 80)), "confirm.x", "integer >= 0"),
    (replace(DEFAULT_LAYOUT, reject=Rectangle(560, 380, 220, 80)), "reject", "in common with confirm"),
    (
        replace(DEFAULT_LAYOUT, selection=(Rectangle(20, 20, 300, 60), *DEFAULT_LAYOUT.selection[1:])),
        None,
        None,
    ),
    (
        replace(DEFAULT_LAYOUT, selection=(Rectangle(20, 20, 300, 61), *DEFAULT_LAYOUT.selection[1:])),
        r"selection\[0\]",
        r"in common with selection\[1\]",
    ),
    (replace(DEFAULT_LAYOUT, selection=DEFAULT_LAYOUT.selection[:4]), "selection", "five fields"),
]


@pytest.mark.parametrize(("layout", "field", "reason"), LAYOUT_FAULTS)
def test_a_wrong_layout_is_refused_with_place_and_cause(
    layout: Layout, field: str | None, reason: str | None
) -> None:
    if field is None:
        hmi.check_layout(layout)
        return
    with pytest.raises(LayoutError, match=rf"^{field}: expected .*{reason}"):
        hmi.check_layout(layout)


@given(st.integers(-5, 805), st.integers(-5, 485), st.integers(-5, 485), st.integers(-5, 805))
def test_no_finger_in_one_row_or_column_selects_and_confirms(
    x: int, y: int, other_y: int, other_x: int
) -> None:
    choosing = hmi.outputs(at(Step.SELECT, offered=4))
    asking = hmi.outputs(at(Step.CONFIRM))
    if hmi.touch_at(DEFAULT_LAYOUT, choosing, x, y) != "":
        assert hmi.touch_at(DEFAULT_LAYOUT, asking, x, other_y) != "confirm"
        assert hmi.touch_at(DEFAULT_LAYOUT, asking, other_x, y) != "confirm"


def test_a_finger_touches_only_the_fields_that_are_open() -> None:
    centres = [
        (field.x + field.width // 2, field.y + field.height // 2) for field in DEFAULT_LAYOUT.selection
    ]
    choosing = hmi.outputs(at(Step.SELECT, offered=3))
    touches = [hmi.touch_at(DEFAULT_LAYOUT, choosing, x, y) for x, y in centres]
    assert touches == ["select:0", "select:1", "select:2", "select:3", ""]
    asking = hmi.outputs(at(Step.CONFIRM))
    assert [hmi.touch_at(DEFAULT_LAYOUT, asking, x, y) for x, y in centres] == [""] * 5
    assert hmi.touch_at(DEFAULT_LAYOUT, asking, 560, 380) == "confirm"
    assert hmi.touch_at(DEFAULT_LAYOUT, asking, 780, 380) == ""
    assert hmi.touch_at(DEFAULT_LAYOUT, asking, 330, 459) == "reject"
    for step in (Step.INHIBITED, Step.AWAIT_ECHO, Step.AWAIT_SWITCH, Step.WITHDRAWN):
        assert hmi.touch_at(DEFAULT_LAYOUT, hmi.outputs(at(step)), 600, 400) == ""

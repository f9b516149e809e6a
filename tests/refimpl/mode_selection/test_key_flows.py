"""Whole insert and remove flows of the four devices together, with an honest panel and a user."""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from refimpl.errors import InputError
from refimpl.mode_selection import eks, fplc, hmi, key_flows
from refimpl.mode_selection.code_tables import CH, RE, SE, SW
from refimpl.mode_selection.eks import KeyMemory
from refimpl.mode_selection.key_flows import System, insert_key, remove_key, touch


def stand_in(data: bytes) -> int:
    """A checksum for these tests; it is not the maker's."""
    return zlib.crc32(data) & 0xFFFF


EKS_PARAMS = eks.Params(stand_in, operating_state=7, dip_switches=0x001)
FPLC_PARAMS = fplc.Params(T_SEQ_FROM="LA", T_DWELL_ms=500, SELECTIONS="again")  # the profile cautious


PERMITTED = [(level, mode) for level in range(5) for mode in range(level + 1)]


def key_of(level: int, number: int = 1) -> KeyMemory:
    return eks.written_key(7, RE[level], 0x3FF, number, stand_in)


def round_of_scans(system: System, dt_ms: int = 10) -> System:
    """Each device scans once, the F-PLC first."""
    for device in ("fplc", "plc", "hmi", "eks"):
        system = key_flows.scan(system, device, dt_ms)
    return system


def until(system: System, reached: Callable[[System], bool], rounds: int = 300) -> System:
    """Rounds of scans until the condition holds; fails if it never does."""
    for _ in range(rounds):
        if reached(system):
            return system
        system = round_of_scans(system)
    raise AssertionError(f"not reached; F-PLC {system.fplc_state.state}, panel {system.hmi_state.state}")


def rounds(system: System, number: int) -> System:
    for _ in range(number):
        system = round_of_scans(system)
    return system


def idle(system: System) -> bool:
    """The F-PLC waits for a key."""
    return system.fplc_state.state == fplc.Step.IDLE


def screen(name: str) -> Callable[[System], bool]:
    return lambda system: system.hmi_out.screen == name


def ready() -> System:
    """Powered up, no key, the F-PLC in Idle."""
    return until(key_flows.power_up(EKS_PARAMS, FPLC_PARAMS), idle)


def opened(level: int) -> System:
    """A key of this level is in and the panel offers its modes."""
    return until(insert_key(ready(), key_of(level)), screen("select"))


def asked(level: int, mode: int) -> System:
    """The mode was touched and the panel asks for the confirmation."""
    return until(touch(opened(level), f"select:{mode}"), screen("confirm"))


def settled(system: System) -> bool:
    """The F-PLC and the panel are both ready for a selection."""
    return system.fplc_state.state == fplc.Step.AWAIT_SELECTION and system.hmi_out.screen == "select"


def switched(level: int, mode: int) -> System:
    """The mode was confirmed and is active, and the next selection can be made."""
    return until(touch(asked(level, mode), "confirm"), lambda s: s.fplc_state.mode == mode and settled(s))


# ---------------------------------------------------------------- insert


def test_the_panel_and_the_f_plc_take_the_same_permissions() -> None:
    only_own = replace(FPLC_PARAMS, PERMITS_2=(False, False, True, False, False))
    system = until(key_flows.power_up(EKS_PARAMS, only_own), idle)
    system = until(insert_key(system, key_of(2)), screen("select"))
    assert system.hmi_out.enabled == (False, False, True, False, False)
    refused = rounds(touch(system, "select:1"), 20)
    assert (refused.fplc_state, refused.hmi_state) == (system.fplc_state, system.hmi_state)
    asked_for = until(touch(system, "select:2"), screen("confirm"))
    assert until(touch(asked_for, "confirm"), settled).fplc_state.mode == 2


@pytest.mark.parametrize("level", range(5))
def test_a_key_opens_the_modes_up_to_its_level(level: int) -> None:
    system = opened(level)
    assert system.fplc_out.MW01 == system.plc_out.ReadAuthorization == RE[level]
    assert [mode for mode in range(5) if system.hmi_out.enabled[mode]] == list(range(level + 1))


@pytest.mark.parametrize(
    ("level", "mode"), [(level, mode) for level in range(5) for mode in range(level + 1)]
)
def test_each_permitted_mode_can_be_selected_confirmed_and_activated(level: int, mode: int) -> None:
    system = asked(level, mode)
    assert (system.plc_out.MW03, system.fplc_out.MW05, system.plc_out.CheckMSO) == (
        SE[mode],
        CH[mode],
        CH[mode],
    )
    assert system.hmi_out.shown == mode
    assert key_flows.active_mode(system) == -1
    system = until(touch(system, "confirm"), lambda s: key_flows.active_mode(s) == mode)
    assert (SE[mode], SW[mode]) == (system.plc_out.MW03, system.plc_out.MW07)
    assert until(system, settled).hmi_out.active == mode


def test_nothing_is_switched_before_the_user_confirms() -> None:
    assert key_flows.active_mode(rounds(asked(3, 2), 500)) == -1


def test_a_mode_above_the_level_cannot_be_touched() -> None:
    system = rounds(touch(opened(1), "select:2"), 20)
    assert (system.hmi_out.screen, system.plc_out.MW03) == ("select", 0)


def test_the_user_can_reject_the_echo_and_choose_again() -> None:
    system = until(touch(asked(3, 2), "reject"), settled)
    assert key_flows.active_mode(system) == -1
    system = until(touch(until(touch(system, "select:1"), screen("confirm")), "confirm"), settled)
    assert key_flows.active_mode(system) == 1


def test_one_insertion_selects_several_modes_and_a_mode_again() -> None:
    system = switched(4, 0)
    for mode in (4, 2, 2, 0):
        system = until(touch(system, f"select:{mode}"), screen("confirm"))
        system = until(
            touch(system, "confirm"), lambda s, mode=mode: key_flows.active_mode(s) == mode and settled(s)
        )


@pytest.mark.parametrize(
    "bad",
    [
        replace(key_of(3), KEYCRC=key_of(3).KEYCRC ^ 1),
        replace(key_of(3), authorization_level=0),
        replace(key_of(3), operating_state=6),
    ],
)
def test_a_bad_key_opens_nothing_and_disturbs_nothing(bad: KeyMemory) -> None:
    system = rounds(insert_key(ready(), bad), 200)
    assert system.fplc_state.state == fplc.Step.IDLE
    assert system.hmi_out.screen == "inhibited"
    assert opened_after(remove_key(system))


def opened_after(system: System) -> bool:
    """Whether a good key then opens the panel."""
    return until(insert_key(rounds(system, 5), key_of(3)), screen("select")).hmi_out.enabled[3]


def test_a_key_from_before_power_up_must_be_reinserted() -> None:
    system = insert_key(key_flows.power_up(EKS_PARAMS, FPLC_PARAMS), key_of(3))
    system = rounds(system, 300)
    assert system.fplc_out.MW01 == 0
    assert opened_after(until(remove_key(system), idle))


# ---------------------------------------------------------------- remove


def all_words(system: System) -> set[int]:
    p, f, h = system.plc_out, system.fplc_out, system.hmi_out
    return {f.MW01, f.MW05, p.ReadAuthorization, p.CheckMSO, p.MW03, p.MW07, h.SelectMSO, h.SwitchMSO}


def test_removal_clears_all_words_and_keeps_mode_and_display() -> None:
    system = until(remove_key(switched(3, 2)), idle)
    assert all_words(system) == {0}
    assert system.hmi_out.screen == "inhibited"
    assert key_flows.active_mode(system) == system.hmi_out.active == 2


@pytest.mark.parametrize("moment", range(20))
def test_a_key_pulled_anytime_leads_to_idle_without_mode_change(moment: int) -> None:
    system = rounds(touch(asked(3, 2), "confirm"), moment)
    system = key_flows.scan_eks(remove_key(system), 10)
    before = key_flows.active_mode(system)
    system = until(system, lambda s: idle(s) and s.eks_state.state == eks.Step.EMPTY)
    assert key_flows.active_mode(system) == before
    assert opened_after(system)


def test_the_moments_above_lie_on_both_sides_of_the_switchover() -> None:
    system = touch(asked(3, 2), "confirm")
    assert key_flows.active_mode(rounds(system, 1)) == -1
    assert key_flows.active_mode(rounds(system, 19)) == 2


def test_the_removal_waits_while_the_panel_still_returns_a_selection() -> None:
    system = remove_key(asked(3, 2))
    for _ in range(20):
        system = key_flows.scan_eks(key_flows.scan_fplc(system, 10), 10)
    assert system.fplc_state.state == fplc.Step.AWAIT_ZEROS
    assert SE[2] == system.plc_out.MW03
    for _ in range(100):
        system = key_flows.scan_fplc(system, 10)
    assert system.fplc_state.state == fplc.Step.ERROR
    assert until(system, idle).fplc_state.mode == -1


def test_a_key_of_another_user_never_inherits_a_selection() -> None:
    system = key_flows.scan_eks(insert_key(asked(4, 4), key_of(1, number=2)), 10)
    for _ in range(400):
        system = round_of_scans(system)
        assert (system.fplc_out.MW05, key_flows.active_mode(system)) == (0, -1)
    system = until(remove_key(system), idle)
    system = until(insert_key(system, key_of(1, number=2)), screen("select"))
    assert (RE[1], 0, 0) == (system.fplc_out.MW01, system.fplc_out.MW05, system.plc_out.MW03)


def test_nonzero_registers_keep_the_eks_dark_and_the_mode_active() -> None:
    system = replace(switched(3, 2), registers_zero=False)
    system = until(remove_key(system), idle)
    system = rounds(insert_key(replace(system, registers_zero=True), key_of(3)), 200)
    assert system.eks_state.state == eks.Step.FAULT
    assert (system.fplc_out.MW01, key_flows.active_mode(system)) == (0, 2)


# ---------------------------------------------------------------- any interleaving

EVENTS = st.one_of(
    st.sampled_from(key_flows.DEVICES),
    st.sampled_from(key_flows.DEVICES),
    st.sampled_from(key_flows.DEVICES),
    st.sampled_from([*hmi.TOUCHES[1:], "insert:1", "insert:4", "remove"]),
)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.sampled_from([(4, 0), (3, 3), (1, 0)]), st.lists(EVENTS, max_size=120))
def test_in_any_interleaving_active_modes_were_touched_shown_and_confirmed(
    start: tuple[int, int], events: list[str]
) -> None:
    system = asked(*start)
    touched, confirmed, mode = start[1], set[int](), -1
    for event in events:
        if event.startswith("insert"):
            system = insert_key(system, key_of(int(event[-1]), number=int(event[-1])))
        elif event == "remove":
            system = remove_key(system)
        elif event in key_flows.DEVICES:
            before = system
            system = key_flows.scan(system, event, 50 if event == "fplc" else 10)
            if event == "hmi" and before.hmi_out.screen == "select" and system.hmi_out.SelectMSO != 0:
                touched = int(before.touch[-1])
            if event == "hmi" and before.hmi_out.screen == "confirm" and before.touch == "confirm":
                confirmed.add(before.hmi_out.shown)
                assert before.hmi_out.shown == touched
        else:
            system = touch(system, event)
        if system.fplc_state.mode != mode:
            mode = system.fplc_state.mode
            assert mode in confirmed


def test_a_scan_of_one_device_leaves_the_other_three_alone() -> None:
    system = asked(3, 2)
    for device in key_flows.DEVICES:
        after = key_flows.scan(system, device, 10)
        for other in key_flows.DEVICES:
            if other != device:
                assert getattr(after, f"{other}_state") == getattr(system, f"{other}_state")
                assert getattr(after, f"{other}_out") == getattr(system, f"{other}_out")


def test_a_touch_is_seen_by_one_scan_of_the_panel() -> None:
    system = touch(opened(3), "select:4")
    assert system.touch == "select:4"
    assert key_flows.scan_plc(system, 10).touch == "select:4"
    assert key_flows.scan_hmi(system, 10).touch == ""


# ---------------------------------------------------------------- logs


def test_log_lines_have_the_wire_form_of_the_protocol() -> None:
    system = touch(opened(1), "select:1")
    line = key_flows.log_line(system, "hmi", 10)
    assert "\n" not in line
    assert json.loads(line) == {
        "device": "hmi",
        "dt_ms": 10,
        "in": {"ReadAuthorization": "0FF0", "CheckMSO": "0000", "ActiveMSO": None, "touch": "select:1"},
        "out": {
            "SelectMSO": "3333",
            "SwitchMSO": "0000",
            "screen": "waiting",
            "enabled": [],
            "shown": None,
            "active": None,
        },
    }
    record = json.loads(key_flows.log_line(system, "fplc", 0))
    assert (record["in"]["MW03"], record["out"]["MW01"], record["out"]["MSO_0"]) == ("0000", "0FF0", False)
    assert json.loads(key_flows.log_line(opened(1), "hmi", 0))["out"]["enabled"] == [0, 1]
    assert json.loads(key_flows.log_line(opened(1), "plc", 0))["out"]["ReadAuthorization"] == "0FF0"
    assert json.loads(key_flows.log_line(opened(1), "eks", 0))["in"]["authorization_level"] == "0FF0"


def test_an_unknown_device_field_or_time_is_refused_by_name() -> None:
    for wrong in (lambda: key_flows.scan(ready(), "hm", 1), lambda: key_flows.log_line(ready(), "hm", 1)):
        with pytest.raises(InputError, match=r"^device:"):
            wrong()
    with pytest.raises(InputError, match=r"^touch:"):
        touch(ready(), "select:5")
    for scan in (key_flows.scan_eks, key_flows.scan_fplc, key_flows.scan_plc, key_flows.scan_hmi):
        with pytest.raises(InputError, match=r"^dt_ms:"):
            scan(ready(), -1)

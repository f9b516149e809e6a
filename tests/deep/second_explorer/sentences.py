"""A sentence on a step of each device, as plain Python that CrossHair explores.

Nothing of `proofs/` is used: states and inputs are built here by hand, by the constructors of the shipped
code, from numbers and flags that may have any value. A function gives TRUE where its sentence holds for that
scan; `pre` and `post` in its docstring are its contract. Texts among the parameters and the permissions of a
level have their defaults; the theorems in proofs/ leave those free too.
"""

from __future__ import annotations

from enum import Enum
from typing import TypeVar

from refimpl.edm import sf_edm
from refimpl.enable_switch import sf_enable_switch
from refimpl.guard_locking import sf_guard_locking
from refimpl.mode_selection import eks, fplc, hmi, plc
from refimpl.mode_selection.code_tables import SE, SW
from refimpl.testable_safety_sensor import sf_testable_safety_sensor

Step = TypeVar("Step", bound=Enum)


def chosen(steps: type[Step], number: int) -> Step:
    """The control state of this number; every number has one."""
    every = list(steps)
    for place, step in enumerate(every):
        if place == number:
            return step
    return every[-1]


def fplc_switches_on_the_pair(
    *,
    state: int,
    accepted: int,
    authority: int,
    selection: int,
    mode: int,
    elapsed: int,
    t_on: int,
    t_seq: int,
    t_rem: int,
    t_dwell: int,
    hold: bool,
    dt: int,
    la: bool,
    a: bool,
    b: bool,
    c: bool,
    d: bool,
    setup: bool,
    mw03: int,
    mw07: int,
) -> bool:
    """A scan of the F-PLC that writes a mode finds that mode's word in MW03 and in MW07.

    pre: -1 <= accepted <= 4 and -1 <= authority <= 4 and -1 <= selection <= 4 and -1 <= mode <= 4
    pre: 1 <= t_on <= t_seq <= 3600000 and 0 <= t_dwell < t_rem <= 3600000
    pre: elapsed >= 0 and dt >= 0 and 0 <= mw03 <= 65535 and 0 <= mw07 <= 65535
    post: _
    """
    params = fplc.Params(t_on, t_seq, "LA", t_rem, t_dwell, "hold" if hold else "none")
    before = fplc.State(params, chosen(fplc.Step, state), accepted, authority, selection, mode, elapsed)
    after, _ = fplc.step(before, fplc.Inputs(dt, la, a, b, c, d, setup, mw03, mw07))
    if after.mode == mode or after.mode == -1:
        return True
    return any(after.mode == one and mw03 == SE[one] and mw07 == SW[one] for one in range(5))


def plc_copies_its_sources(
    *,
    turn: int,
    ra: int,
    mw03: int,
    check: int,
    mw07: int,
    dt: int,
    mw01: int,
    mw05: int,
    select: int,
    switch: int,
) -> bool:
    """Each word that the PLC sends is what it was, or what its source shows in this scan.

    pre: 0 <= ra <= 65535 and 0 <= mw03 <= 65535 and 0 <= check <= 65535 and 0 <= mw07 <= 65535
    pre: 0 <= mw01 <= 65535 and 0 <= mw05 <= 65535 and 0 <= select <= 65535 and 0 <= switch <= 65535
    pre: dt >= 0
    post: _
    """
    before = plc.State(plc.Params(), chosen(plc.Step, turn), ra, mw03, check, mw07)
    _, sends = plc.step(before, plc.Inputs(dt, mw01, mw05, select, switch))
    return (
        (sends.ReadAuthorization == ra or sends.ReadAuthorization == mw01)
        and (sends.CheckMSO == check or sends.CheckMSO == mw05)
        and (mw03 == sends.MW03 or select == sends.MW03)
        and (mw07 == sends.MW07 or switch == sends.MW07)
    )


def panel_without_authorization_sends_zeros(
    *, state: int, offered: int, selection: int, dt: int, check: int, active: int, field: int
) -> bool:
    """In a scan in which no word of a level is on the bus the panel sends zeros.

    pre: -1 <= offered <= 4 and -1 <= selection <= 4 and -1 <= active <= 4
    pre: dt >= 0 and 0 <= check <= 65535
    post: _
    """
    touch = "confirm" if field == 0 else "reject" if field == 1 else ""
    before = hmi.State(hmi.Params(), chosen(hmi.Step, state), offered, selection)
    _, sends = hmi.step(before, hmi.Inputs(dt, 0, check, active, touch))
    return sends.SelectMSO == 0 and sends.SwitchMSO == 0


def reader_without_a_key_signals_none(
    *,
    state: int,
    kept_state: int,
    kept_level: int,
    kept_code: int,
    kept_crc: int,
    kept_id: int,
    elapsed: int,
    crc: int,
    switches: int,
    pulse: int,
    dt: int,
    on_key: int,
    level: int,
    code: int,
    key_crc: int,
    key_id: int,
    zero: bool,
) -> bool:
    """In a scan without a key in the reader LA is off.

    pre: 0 <= kept_state <= 255 and 0 <= kept_level <= 65535 and 0 <= kept_code <= 65535
    pre: 0 <= kept_crc <= 65535 and 0 <= kept_id and kept_id <= 65535 and 0 <= crc <= 65535
    pre: 0 <= switches <= 15 and 1 <= pulse <= 60000 and elapsed >= 0 and dt >= 0
    pre: 0 <= on_key <= 255 and 0 <= level <= 65535 and 0 <= code <= 65535
    pre: 0 <= key_crc <= 65535 and 0 <= key_id <= 65535
    post: _
    """
    params = eks.Params(lambda data: crc, 6, switches, pulse)
    kept = eks.KeyMemory(kept_state, kept_level, kept_code, kept_crc, kept_id)
    before = eks.State(params, chosen(eks.Step, state), kept, elapsed)
    _, sends = eks.step(before, eks.Inputs(dt, False, on_key, level, code, key_crc, key_id, zero))
    return not sends.LA


def contactors_stop_at_once(
    *,
    state: int,
    reset_was: bool,
    control_was: bool,
    seen: bool,
    elapsed: int,
    limit: int,
    at_once: bool,
    dt: int,
    activate: bool,
    control: bool,
    first: bool,
    second: bool,
    start: bool,
    reset: bool,
) -> bool:
    """SF_EDM: in a call without Activate, or with S_OutControl FALSE, the output is off.

    pre: 0 <= limit <= 3600000 and elapsed >= 0 and dt >= 0
    post: _
    """
    params = sf_edm.Params(limit, "at_once" if at_once else "stop_first")
    before = sf_edm.State(params, chosen(sf_edm.Step, state), reset_was, control_was, seen, elapsed)
    _, sends = sf_edm.step(before, sf_edm.Inputs(dt, activate, control, first, second, start, reset))
    return not sends.S_EDM_Out or (activate and control)


def switch_enables_at_stage_1_alone(
    *,
    state: int,
    reset_was: bool,
    elapsed: int,
    limit: int,
    ends: bool,
    dt: int,
    activate: bool,
    safe: bool,
    ch1: bool,
    ch2: bool,
    ch3: bool,
    auto: bool,
    reset: bool,
) -> bool:
    """SF_EnableSwitch: the enable needs Activate, the mode, and the three channels of stage 1 in that call.

    pre: 0 <= limit <= 3600000 and elapsed >= 0 and dt >= 0
    post: _
    """
    params = sf_enable_switch.Params(limit, ends)
    before = sf_enable_switch.State(params, chosen(sf_enable_switch.Step, state), reset_was, elapsed)
    inputs = sf_enable_switch.Inputs(dt, activate, safe, ch1, ch2, ch3, auto, reset)
    _, sends = sf_enable_switch.step(before, inputs)
    return not sends.S_EnableSwitchOut or (activate and safe and ch1 and not ch2 and ch3)


def guard_is_closed_and_locked(
    *,
    state: int,
    reset_was: bool,
    request_was: bool,
    pending: bool,
    inhibit: bool,
    lost: bool,
    dt: int,
    activate: bool,
    closed: bool,
    safe: bool,
    locked: bool,
    request: bool,
    start: bool,
    auto: bool,
    reset: bool,
) -> bool:
    """SF_GuardLocking: the enable needs Activate, a closed and a locked guard in that call.

    pre: dt >= 0
    post: _
    """
    before = sf_guard_locking.State(
        sf_guard_locking.Params(),
        chosen(sf_guard_locking.Step, state),
        reset_was,
        request_was,
        pending,
        inhibit,
        lost,
    )
    inputs = sf_guard_locking.Inputs(dt, activate, closed, safe, locked, request, start, auto, reset)
    _, sends = sf_guard_locking.step(before, inputs)
    return not sends.S_GuardLocked or (activate and closed and locked)


def sensor_enables_over_a_free_sensor(
    *,
    state: int,
    reset_was: bool,
    test_was: bool,
    sensor_was: bool,
    inhibit: bool,
    elapsed: int,
    limit: int,
    errors: bool,
    dt: int,
    activate: bool,
    free: bool,
    test: bool,
    without: bool,
    start: bool,
    auto: bool,
    reset: bool,
) -> bool:
    """SF_TestableSafetySensor: over a dark sensor it enables in the second phase of a test alone.

    pre: 1 <= limit <= 150 and elapsed >= 0 and dt >= 0
    post: _
    """
    params = sf_testable_safety_sensor.Params(limit, errors)
    steps = sf_testable_safety_sensor.Step
    before = sf_testable_safety_sensor.State(
        params, chosen(steps, state), reset_was, test_was, sensor_was, inhibit, elapsed
    )
    inputs = sf_testable_safety_sensor.Inputs(dt, activate, free, test, without, start, auto, reset)
    after, sends = sf_testable_safety_sensor.step(before, inputs)
    return (free and activate) or not sends.S_OSSD_Out or after.state == steps.TEST_ACTIVE

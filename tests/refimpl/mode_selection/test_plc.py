"""The PLC copies one word a scan, in its order, unchanged, and begins anew where MW01 has changed."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError, StateError
from refimpl.mode_selection import plc
from refimpl.mode_selection.plc import Inputs, Outputs, Params, Step

ROOT = Path(__file__).resolve().parents[3]
INTERFACE = tomllib.loads((ROOT / "spec/mode_selection/interface.toml").read_text(encoding="utf-8"))
PLC = INTERFACE["devices"]["plc"]

WORDS = st.integers(0, 0xFFFF)


def test_after_power_up_all_words_are_zero() -> None:
    assert plc.outputs(plc.power_up(Params())) == Outputs(0, 0, 0, 0)


def test_the_copies_come_one_a_scan_and_in_their_order() -> None:
    state = plc.power_up(Params())
    seen = []
    for scan in range(1, 9):
        i = Inputs(10, 0x101 if scan < 5 else 0x105, 0x200 + scan, 0x300 + scan, 0x400 + scan)
        state, row = plc.step(state, i)
        seen.append((row.ReadAuthorization, row.MW03, row.CheckMSO, row.MW07))
    assert seen == [
        (0x101, 0, 0, 0),
        (0x101, 0x302, 0, 0),
        (0x101, 0x302, 0x203, 0),
        (0x101, 0x302, 0x203, 0x404),
        (0x105, 0x302, 0x203, 0x404),
        (0x105, 0x306, 0x203, 0x404),
        (0x105, 0x306, 0x207, 0x404),
        (0x105, 0x306, 0x207, 0x408),
    ]


@given(st.lists(st.builds(Inputs, st.integers(0, 1000), WORDS, WORDS, WORDS, WORDS), min_size=4, max_size=12))
def test_words_pass_unchanged_and_only_one_changes_a_scan(scans: list[Inputs]) -> None:
    state = plc.power_up(Params())
    row = plc.outputs(state)
    for i in scans:
        turn, before = state.turn, row
        state, row = plc.step(state, i)
        assert row == plc.outputs(state)
        copied = {
            Step.COPY_READ_AUTHORIZATION: replace(before, ReadAuthorization=i.MW01),
            Step.COPY_MW03: replace(before, MW03=i.SelectMSO),
            Step.COPY_CHECK_MSO: replace(before, CheckMSO=i.MW05),
            Step.COPY_MW07: replace(before, MW07=i.SwitchMSO),
        }
        same = before.ReadAuthorization == i.MW01
        assert row == copied[turn if same else Step.COPY_READ_AUTHORIZATION]


def test_a_new_level_is_copied_before_anything_else() -> None:
    state = plc.power_up(Params())
    for _ in range(2):
        state, _ = plc.step(state, Inputs(10, 0, 0x205, 0x305, 0x405))
    state, row = plc.step(state, Inputs(10, 0x105, 0x206, 0x306, 0x406))
    assert row == Outputs(0x105, 0, 0x305, 0) and state.turn == Step.COPY_MW03


@given(st.lists(WORDS, min_size=2, max_size=12))
def test_a_level_that_never_rests_holds_up_the_others(levels: list[int]) -> None:
    state = plc.power_up(Params())
    for level in levels:
        changed = level ^ 1 if level == state.ReadAuthorization else level
        state, row = plc.step(state, Inputs(10, changed, 1, 2, 3))
        assert row == Outputs(changed, 0, 0, 0) and state.turn == Step.COPY_MW03


def test_a_wrong_input_or_state_is_refused_by_name() -> None:
    for name in ("MW01", "MW05", "SelectMSO", "SwitchMSO"):
        for value in (65536, -1, True, "0000", None):
            with pytest.raises(InputError, match=rf"^{name}: expected a word"):
                replace(Inputs(0, 0, 0, 0, 0), **{name: value})
    with pytest.raises(InputError, match=r"^dt_ms:"):
        Inputs(-1, 0, 0, 0, 0)
    with pytest.raises(StateError, match=r"^turn:"):
        plc.step(replace(plc.power_up(Params()), turn="CopyMW07"), Inputs(0, 0, 0, 0, 0))

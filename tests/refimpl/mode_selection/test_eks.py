"""The EKS Light FSA: the key memory byte by byte, every check of a key, the test pulse, and the removal."""

from __future__ import annotations

import tomllib
import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError, KeyDataError, ParameterError, StateError
from refimpl.mode_selection import eks
from refimpl.mode_selection.code_tables import RE
from refimpl.mode_selection.eks import NO_KEY, Inputs, KeyMemory, Outputs, Params, State, Step

ROOT = Path(__file__).resolve().parents[3]
INTERFACE = tomllib.loads((ROOT / "spec/mode_selection/interface.toml").read_text(encoding="utf-8"))
EKS = INTERFACE["devices"]["eks"]


def stand_in(data: bytes) -> int:
    """A checksum for these tests; it is not the maker's."""
    return zlib.crc32(data) & 0xFFFF


PARAMS = Params(stand_in, operating_state=6, dip_switches=0x155, T_PULSE_ms=200)
KEY = eks.written_key(6, RE[3], 0x155, 0x0123456789ABCDEF, stand_in)
DARK = Outputs(False, False, False, False, False, False)
ALL_ON = Outputs(True, True, True, True, True, True)
ONLY_D = Outputs(False, False, False, False, True, False)
READING = (
    Step.READ,
    Step.CHECK_CHECKSUM,
    Step.CHECK_LEVEL,
    Step.SET_LA,
    Step.START_TEST,
    Step.TEST_ONES,
    Step.TEST_ZEROS,
    Step.REJECTED,
)
WITH_KEY = (*READING, Step.SIGNAL, Step.CLEAR_OUTPUTS)


def at(step: Step, elapsed_ms: int = 0, key: KeyMemory = KEY, params: Params = PARAMS) -> State:
    return State(params, step, key if step in WITH_KEY else NO_KEY, elapsed_ms)


def inputs(key: KeyMemory | None = KEY, registers_zero: bool = True, dt_ms: int = 10) -> Inputs:
    seen = NO_KEY if key is None else key
    return Inputs(
        dt_ms,
        key is not None,
        seen.operating_state,
        seen.authorization_level,
        seen.access_code,
        seen.KEYCRC,
        seen.KeyID,
        registers_zero,
    )


ROWS = [
    ("AwaitInsertion", at(Step.EMPTY), inputs(None), Step.EMPTY),
    ("SeeInsertion", at(Step.EMPTY), inputs(), Step.READ),
    ("ReadKey", at(Step.READ), inputs(), Step.CHECK_CHECKSUM),
    ("AcceptChecksum", at(Step.CHECK_CHECKSUM), inputs(), Step.CHECK_LEVEL),
    ("AcceptLevel", at(Step.CHECK_LEVEL), inputs(), Step.SET_LA),
    ("RaiseLA", at(Step.SET_LA), inputs(), Step.START_TEST),
    ("StartOnes", at(Step.START_TEST), inputs(), Step.TEST_ONES),
    ("HoldOnes", at(Step.TEST_ONES, 189), inputs(), Step.TEST_ONES),
    ("StartZeros", at(Step.TEST_ONES, 190), inputs(), Step.TEST_ZEROS),
    ("HoldZeros", at(Step.TEST_ZEROS, 189), inputs(), Step.TEST_ZEROS),
    ("SetOneOutput", at(Step.TEST_ZEROS, 190), inputs(), Step.SIGNAL),
    ("HoldOneOutput", at(Step.SIGNAL), inputs(), Step.SIGNAL),
    ("StayRejected", at(Step.REJECTED), inputs(), Step.REJECTED),
    *[("SeeRemoval", at(step), inputs(None), Step.CHECK_REGISTERS) for step in READING],
    ("SeeRemoval", at(Step.SIGNAL), inputs(None), Step.CLEAR_OUTPUTS),
    ("ResetOutputs", at(Step.CLEAR_OUTPUTS), inputs(), Step.CHECK_REGISTERS),
    ("PassRegisterCheck", at(Step.CHECK_REGISTERS), inputs(), Step.EMPTY),
    ("LatchFault", at(Step.CHECK_REGISTERS), inputs(None, registers_zero=False), Step.FAULT),
    ("StayInFault", at(Step.FAULT), inputs(), Step.FAULT),
]
OTHER_STEPS = {"RefuseChecksum", "RefuseLevel"}


@pytest.mark.parametrize(
    ("name", "before", "i", "expected"),
    ROWS,
    ids=[f"{name}-{before.state.value}" for name, before, *_ in ROWS],
)
def test_step_leads_to_the_state_that_the_procedure_names(
    name: str, before: State, i: Inputs, expected: Step
) -> None:
    after, row = eks.step(before, i)
    assert after.state == expected
    assert row == eks.outputs(after)
    if expected not in WITH_KEY:
        assert after.key == NO_KEY
    if expected not in (Step.TEST_ONES, Step.TEST_ZEROS):
        assert after.elapsed_ms == 0


def test_the_rows_cover_every_registered_step_and_state() -> None:
    assert {name for name, *_ in ROWS} | OTHER_STEPS == set(EKS["steps"])
    assert {before.state.value for _, before, *_ in ROWS} == set(EKS["states"])


# ---------------------------------------------------------------- which key is accepted


def verdict(key: KeyMemory, params: Params = PARAMS) -> Step:
    """Where a key ends that is put in and left in: Signal or Rejected."""
    state, row = eks.power_up(params), DARK
    lit = False
    for _ in range(100):
        state, row = eks.step(state, inputs(key, dt_ms=50))
        lit = lit or row != DARK
    assert lit == (state.state == Step.SIGNAL)
    return state.state


def signed(key: KeyMemory) -> KeyMemory:
    """The key with the checksum that its content needs, so that only what is under test can refuse it."""
    return replace(key, KEYCRC=stand_in(eks.checksum_data(key)))


@pytest.mark.parametrize("level", range(5))
def test_a_good_key_sets_la_and_its_levels_output(level: int) -> None:
    key = signed(replace(KEY, authorization_level=RE[level]))
    assert verdict(key) == Step.SIGNAL
    row = eks.outputs(at(Step.SIGNAL, key=key))
    assert row.LA
    assert [output == level for output in range(5)] == [row.A, row.B, row.C, row.D, row.STR]


def test_every_single_wrong_bit_of_the_checksum_refuses_the_key() -> None:
    for bit in range(16):
        assert verdict(replace(KEY, KEYCRC=KEY.KEYCRC ^ 1 << bit)) == Step.REJECTED


def test_a_copy_on_a_key_with_another_number_is_refused() -> None:
    assert verdict(replace(KEY, KeyID=KEY.KeyID + 1)) == Step.REJECTED


@pytest.mark.parametrize("level", [0, 0x0F0E, 0xF0F0, 0xFFFF, 0xCCCC])
def test_a_level_outside_table_1_refuses_the_key(level: int) -> None:
    assert verdict(signed(replace(KEY, authorization_level=level))) == Step.REJECTED


def test_no_level_but_the_five_is_accepted() -> None:
    for level in range(0x10000):
        key = replace(KEY, authorization_level=level)
        accepted = eks.step(at(Step.CHECK_LEVEL, key=key), inputs(key))[0].state == Step.SET_LA
        assert accepted == (level in RE)


@pytest.mark.parametrize("on_device", [6, 7])
@pytest.mark.parametrize("on_key", [0, 5, 6, 7, 8, 255])
def test_key_and_device_must_have_the_same_operating_state(on_device: int, on_key: int) -> None:
    params = replace(PARAMS, operating_state=on_device)
    expected = Step.SIGNAL if on_key == on_device else Step.REJECTED
    assert verdict(signed(replace(KEY, operating_state=on_key)), params) == expected


@given(st.integers(0, 1023), st.integers(0, 0xFFFF))
def test_operating_state_6_wants_equal_access_codes(dip: int, code: int) -> None:
    assert eks.access_code_accepted(6, dip, code) == (dip == code)
    assert eks.access_code_accepted(6, dip, dip)


@given(st.integers(0, 1023), st.integers(0, 0xFFFF))
def test_operating_state_7_wants_a_common_one_bit(dip: int, code: int) -> None:
    common = any(dip >> bit & 1 and code >> bit & 1 for bit in range(10))
    assert eks.access_code_accepted(7, dip, code) == (common and code < 1024)


def test_an_access_code_above_ten_bits_refuses_the_key() -> None:
    for operating_state in (6, 7):
        params = replace(PARAMS, operating_state=operating_state)
        key = replace(KEY, operating_state=operating_state, access_code=KEY.access_code | 0x400)
        assert verdict(signed(key), params) == Step.REJECTED


# ---------------------------------------------------------------- outputs over time


def test_the_output_follows_200_ms_ones_and_200_ms_zeros() -> None:
    state, seen = eks.power_up(PARAMS), []
    for _ in range(60):
        state, row = eks.step(state, inputs())
        seen.append("".join("01"[on] for on in (row.LA, row.A, row.B, row.C, row.D, row.STR)))
    dark, LA, ones, one = "000000", "100000", "111111", "100010"
    assert seen == [dark] * 4 + [LA] + [ones] * 20 + [LA] * 20 + [one] * 15


def test_la_drops_then_the_output_then_registers_are_checked() -> None:
    first, row = eks.step(at(Step.SIGNAL), inputs(None))
    assert row == ONLY_D
    second, row = eks.step(first, inputs(None, registers_zero=False))
    assert (second.state, row) == (Step.CHECK_REGISTERS, DARK)
    assert eks.step(second, inputs(None))[0] == eks.power_up(PARAMS)


@pytest.mark.parametrize(
    "field", ["operating_state", "authorization_level", "access_code", "KEYCRC", "KeyID"]
)
@pytest.mark.parametrize("step", [*READING, Step.SIGNAL])
def test_a_key_exchanged_between_two_scans_is_a_removal(field: str, step: Step) -> None:
    other = replace(KEY, **{field: getattr(KEY, field) ^ 1})
    after, row = eks.step(at(step), inputs(other))
    assert after.state == (Step.CLEAR_OUTPUTS if step == Step.SIGNAL else Step.CHECK_REGISTERS)
    assert not row.LA


def test_a_fault_stays_dark_whatever_is_put_in() -> None:
    state = at(Step.FAULT)
    for key in (KEY, None, KEY):
        state, row = eks.step(state, inputs(key, dt_ms=10**6))
        assert (state, row) == (at(Step.FAULT), DARK)


@given(
    st.lists(
        st.tuples(st.sampled_from([None, 0, 1, 2, 3]), st.sampled_from([0, 10, 200]), st.booleans()),
        max_size=80,
    )
)
def test_outside_the_test_pulse_at_most_one_output_is_set(scans: list[tuple[int | None, int, bool]]) -> None:
    keys = [signed(replace(KEY, authorization_level=level)) for level in (RE[0], RE[4], 0)] + [KEY]
    state = eks.power_up(PARAMS)
    for number, dt_ms, registers_zero in scans:
        state, row = eks.step(state, inputs(None if number is None else keys[number], registers_zero, dt_ms))
        count = sum((row.A, row.B, row.C, row.D, row.STR))
        assert row == ALL_ON if state.state == Step.TEST_ONES else count <= 1
        if number is None:
            assert not row.LA


# ---------------------------------------------------------------- the key memory


def test_each_field_of_the_key_lies_at_its_bytes() -> None:
    data = bytes.fromhex("06 0F0F 0155 BEEF 0123456789ABCDEF")
    key = eks.key_from_bytes(data)
    assert key == KeyMemory(6, 0x0F0F, 0x0155, 0xBEEF, 0x0123456789ABCDEF)
    assert eks.key_to_bytes(key) == data
    assert eks.checksum_data(key) == data[:5] + data[7:]


@given(st.binary(min_size=15, max_size=15))
def test_any_fifteen_bytes_of_key_memory_come_back_unchanged(data: bytes) -> None:
    assert eks.key_to_bytes(eks.key_from_bytes(data)) == data


@pytest.mark.parametrize("data", [b"", bytes(14), bytes(16), "0" * 15, [0] * 15, bytearray(15), None])
def test_anything_but_fifteen_bytes_is_refused(data: object) -> None:
    with pytest.raises(KeyDataError, match=r"^key bytes 109 to 123: expected 15 bytes"):
        eks.key_from_bytes(data)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("operating_state", 256),
        ("authorization_level", 65536),
        ("access_code", -1),
        ("KEYCRC", True),
        ("KeyID", 1 << 64),
    ],
)
def test_a_field_too_big_for_its_bytes_is_named(field: str, value: int) -> None:
    with pytest.raises(KeyDataError, match=rf"^{field}: expected "):
        eks.key_to_bytes(replace(KEY, **{field: value}))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("operating_state", 5),
        ("operating_state", 8),
        ("authorization_level", 0),
        ("authorization_level", 0x0F0E),
        ("authorization_level", 65536),
        ("access_code", 1024),
        ("KeyID", -1),
    ],
)
def test_data_that_no_key_may_hold_are_not_written(field: str, value: int) -> None:
    good = {"operating_state": 6, "authorization_level": RE[0], "access_code": 1, "KeyID": 1}
    eks.written_key(**good, checksum=stand_in)
    with pytest.raises(KeyDataError, match=rf"^{field}: expected "):
        eks.written_key(**(good | {field: value}), checksum=stand_in)


# ---------------------------------------------------------------- parameters and bad input


def test_the_checksum_is_a_required_parameter() -> None:
    with pytest.raises(TypeError, match="checksum"):
        Params()  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match=r"^checksum: expected a function"):
        Params(0x1234)  # type: ignore[arg-type]


def test_a_checksum_that_is_no_word_is_an_error() -> None:
    for wrong in (65536, -1, None, True):
        params = replace(PARAMS, checksum=lambda _data, wrong=wrong: wrong)
        with pytest.raises(ParameterError, match=r"^checksum: expected a word"):
            eks.step(at(Step.CHECK_CHECKSUM, params=params), inputs())


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("operating_state", 5),
        ("operating_state", 8),
        ("dip_switches", 1024),
        ("dip_switches", True),
        ("T_PULSE_ms", 0),
    ],
)
def test_a_wrong_parameter_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=rf"^{field}: expected "):
        replace(PARAMS, **{field: value})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("inserted", 1),
        ("operating_state", 256),
        ("authorization_level", -1),
        ("access_code", 65536),
        ("KEYCRC", True),
        ("KeyID", 1 << 64),
        ("registers_zero", None),
        ("dt_ms", 1.5),
    ],
)
def test_a_wrong_input_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(InputError, match=rf"^{field}: expected "):
        replace(inputs(), **{field: value})


def test_a_control_state_that_does_not_exist_is_refused() -> None:
    with pytest.raises(StateError, match=r"^state:"):
        eks.step(replace(at(Step.SIGNAL), state="Signal"), inputs())

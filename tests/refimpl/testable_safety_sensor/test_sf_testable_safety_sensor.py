"""The block call by call: activation, interruption, the phases of a test, errors, the manual test."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError, ParameterError
from refimpl.testable_safety_sensor import sf_testable_safety_sensor as block
from refimpl.testable_safety_sensor.sf_testable_safety_sensor import Inputs, Params, Step

QUIET = {
    "dt_ms": 1,
    "Activate": True,
    "S_OSSD_In": True,
    "StartTest": False,
    "NoExternalTest": True,
    "S_StartReset": True,
    "S_AutoReset": False,
    "Reset": False,
}


class Machine:
    """A block and its last outputs; inputs that are not named stay quiet."""

    def __init__(self, **params: Any) -> None:
        self.state = block.power_up(Params(**params))
        self.out = block.outputs(self.state)

    def call(self, times: int = 1, **inputs: Any) -> str:
        """Some calls with the same inputs; the code after the last one."""
        for _ in range(times):
            self.state, self.out = block.step(self.state, Inputs(**{**QUIET, **inputs}))
        return f"{self.out.DiagCode:04X}"

    def enabled(self) -> Machine:
        """Activated with the start-up inhibit switched off."""
        assert [self.call(), self.call()] == ["8401", "8010"]
        return self

    def failed(self, **inputs: Any) -> Machine:
        """A test without reaction has failed."""
        self.enabled().call(StartTest=True, **inputs)
        self.call(dt_ms=150, **inputs)
        return self


def test_inactive_it_is_idle_and_the_sender_is_on() -> None:
    one = Machine()
    assert (one.call(Activate=False), one.out.S_TestOut, one.out.Ready) == ("0000", True, False)


def test_the_start_up_inhibit_needs_an_edge_of_reset() -> None:
    one = Machine()
    assert one.call(S_StartReset=False) == "8401"
    assert one.call(S_StartReset=False) == "8401"
    assert one.call(S_StartReset=False, Reset=True) == "8010"


def test_a_reset_held_from_the_start_is_a_reset_error() -> None:
    one = Machine()
    held = {"S_StartReset": False, "Reset": True}
    assert [one.call(**held), one.call(**held), one.call(**held)] == ["8401", "C001", "C001"]
    assert [one.call(S_StartReset=False), one.call(**held)] == ["8401", "8010"]


def test_the_start_up_inhibit_outlives_an_interruption() -> None:
    one = Machine()
    kept = {"S_StartReset": False, "S_AutoReset": True}
    assert [one.call(**kept), one.call(S_OSSD_In=False, **kept)] == ["8401", "8802"]
    assert [one.call(**kept), one.call(**kept), one.call(Reset=True, **kept)] == ["8402", "8402", "8010"]
    assert [one.call(S_OSSD_In=False, **kept), one.call(**kept)] == ["8802", "8010"]


@pytest.mark.parametrize(("automatic", "codes"), [(True, ["8802", "8010"]), (False, ["8802", "8402"])])
def test_s_auto_reset_switches_the_restart_inhibit_off(automatic: bool, codes: list[str]) -> None:
    one = Machine().enabled()
    assert [one.call(S_OSSD_In=False, S_AutoReset=automatic), one.call(S_AutoReset=automatic)] == codes


def test_a_lost_sensor_beats_the_reset_of_the_same_call() -> None:
    one = Machine().enabled()
    one.call(S_OSSD_In=False)
    assert one.call() == "8402"
    assert one.call(S_OSSD_In=False, Reset=True) == "8802"


def test_each_phase_of_a_test_has_the_whole_test_time() -> None:
    one = Machine(TestTime_ms=10).enabled()
    assert one.call(StartTest=True) == "8020"
    assert (one.out.S_TestOut, one.out.S_OSSD_Out, one.out.TestPossible) == (False, True, False)
    assert one.call(dt_ms=9) == "8020"
    assert one.call(dt_ms=0, S_OSSD_In=False) == "8030"
    assert (one.out.S_TestOut, one.out.S_OSSD_Out) == (True, True)
    assert one.call(dt_ms=9, S_OSSD_In=False) == "8030"
    assert (one.call(dt_ms=0), one.out.TestExecuted) == ("8000", True)


@pytest.mark.parametrize("test_time", [1, 10, 149, 150])
def test_at_test_time_a_phase_fails_whatever_the_sensor_shows(test_time: int) -> None:
    for dark in (False, True):
        one = Machine(TestTime_ms=test_time).enabled()
        one.call(StartTest=True)
        assert one.call(dt_ms=test_time, S_OSSD_In=dark) in ("C410", "C010")
        one = Machine(TestTime_ms=test_time).enabled()
        one.call(StartTest=True)
        one.call(dt_ms=0, S_OSSD_In=False)
        assert one.call(dt_ms=test_time, S_OSSD_In=dark) in ("C410", "C010")
        assert not one.out.S_OSSD_Out and one.out.Error


def test_with_test_time_0_every_test_fails() -> None:
    one = Machine(TestTime_ms=0).enabled()
    assert [one.call(StartTest=True), one.call(dt_ms=0, S_OSSD_In=False)] == ["8020", "C010"]


@pytest.mark.parametrize("test_time", [-(2**31), -1, 151, 2**31 - 1])
def test_outside_its_range_test_time_is_the_blocks_own_error(test_time: int) -> None:
    one = Machine(TestTime_ms=test_time)
    assert [one.call(), one.call(), one.call(Reset=True), one.call(Reset=True)] == [
        "8401",
        "C000",
        "C000",
        "C041",
    ]
    assert [one.call(), one.call(Reset=True), one.call(Activate=False)] == ["C000", "C000", "0000"]


def test_an_early_edge_of_start_test_is_not_remembered() -> None:
    one = Machine()
    assert one.call() == "8401"
    assert [one.call(StartTest=True), one.call(5, StartTest=True)] == ["8010", "8010"]
    assert [one.call(), one.call(StartTest=True)] == ["8010", "8020"]


def test_test_executed_outlives_interruptions_and_ends_with_the_next_test() -> None:
    one = Machine().enabled()
    one.call(StartTest=True)
    one.call(S_OSSD_In=False)
    assert one.call() == "8000"
    held = {"Reset": True}
    codes = [one.call(S_OSSD_In=False), one.call(), one.call(**held), one.call(S_OSSD_In=False)]
    assert codes == ["8806", "8406", "8000", "8806"]
    codes = [one.call(**held), one.call(**held), one.call(), one.call(**held)]
    assert codes == ["8406", "C051", "8406", "8000"]
    assert one.out.TestExecuted
    assert (one.call(StartTest=True), one.out.TestExecuted) == ("8020", False)


def test_x_follows_the_sensor_and_reset_needs_x_4() -> None:
    one = Machine().failed()
    codes = [
        one.call(S_OSSD_In=False),
        one.call(S_OSSD_In=False, Reset=True),
        one.call(Reset=True),
        one.call(),
    ]
    assert codes == ["C010", "C010", "C021", "C410"]
    assert one.call(S_OSSD_In=False) == "C010"
    assert [one.call(Reset=True), one.call(), one.call(Reset=True)] == ["C410", "C410", "8010"]


def test_the_manual_test_after_failure_needs_free_dark_free() -> None:
    no = {"NoExternalTest": False}
    one = Machine().failed(**no)
    assert f"{one.out.DiagCode:04X}" == "C010"
    dark = {"S_OSSD_In": False, **no}
    assert [one.call(**dark), one.call(Reset=True, **dark), one.call(**dark)] == ["C010", "8002", "8002"]
    assert [one.call(**no), one.call(**dark), one.call(**no), one.call(**dark)] == [
        "8002",
        "8804",
        "8404",
        "8804",
    ]
    assert [one.call(**no), one.call(Reset=True, **no)] == ["8404", "8010"]


def test_a_static_reset_ending_the_manual_test_is_an_error() -> None:
    no = {"NoExternalTest": False}
    one = Machine().failed(**no)
    one.call(Reset=True, **no)
    one.call(S_OSSD_In=False, Reset=True, **no)
    codes = [
        one.call(Reset=True, **no),
        one.call(Reset=True, **no),
        one.call(**no),
        one.call(Reset=True, **no),
    ]
    assert codes == ["8404", "C031", "8404", "8010"]


@pytest.mark.parametrize(("automatic", "code"), [(False, "C410"), (True, "8010")])
def test_s_auto_reset_ends_test_errors_only_where_permitted(automatic: bool, code: str) -> None:
    one = Machine(AUTO_RESET_ERRORS=automatic).failed(S_AutoReset=True)
    assert one.call(S_AutoReset=True) == code


BOOLEANS = [name for name in QUIET if name != "dt_ms"]
CALLS = st.lists(
    st.fixed_dictionaries({"dt_ms": st.integers(0, 200), **{name: st.booleans() for name in BOOLEANS}}),
    max_size=40,
)


@given(st.integers(-1, 151), st.booleans(), CALLS)
def test_no_output_stands_over_a_dark_sensor_for_test_time(
    test_time: int, automatic: bool, calls: list[dict[str, Any]]
) -> None:
    one = Machine(TestTime_ms=test_time, AUTO_RESET_ERRORS=automatic)
    dark = -1
    for call in calls:
        one.call(**call)
        masked = one.out.S_OSSD_Out and not call["S_OSSD_In"]
        dark = -1 if not masked else 0 if dark < 0 else dark + call["dt_ms"]
        assert dark < 0 or (one.state.state == Step.TEST_ACTIVE and dark < test_time)
        assert not (one.out.S_OSSD_Out and one.out.Error)


@pytest.mark.parametrize("name", [*BOOLEANS, "dt_ms"])
def test_an_input_of_another_type_is_refused_by_its_name(name: str) -> None:
    with pytest.raises(InputError, match=name):
        Inputs(**{**QUIET, name: "TRUE"})


@pytest.mark.parametrize("wrong", [{"TestTime_ms": 2**31}, {"TestTime_ms": True}, {"AUTO_RESET_ERRORS": 1}])
def test_a_parameter_that_no_time_can_hold_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        Params(**wrong)

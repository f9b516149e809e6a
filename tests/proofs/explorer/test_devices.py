"""On the four devices explorer and interpreter agree, and no valid input is outside the premises."""

import random
from functools import cache
from typing import Any

import pytest
import z3
from hypothesis import given, settings
from hypothesis import strategies as st

from proofs.explorer.device import Device, Scan, scans
from proofs.explorer.explore import Path
from proofs.explorer.records import evaluated, filled, symbols
from proofs.explorer.values import Opaque
from proofs.mode_selection.devices import CHECKSUM_AGREES, DEVICES, EKS, FPLC, PLC
from refimpl.errors import ParameterError
from refimpl.mode_selection import eks, fplc, plc

CHECKSUM = Opaque("set.checksum")


def _example(device: Device, scan: Scan, model: z3.ModelRef) -> tuple[Any, Any]:
    """State and inputs of a model, from the shipped constructors; the checksum says what the model says."""
    if device is EKS:
        agrees = z3.is_true(model.eval(CHECKSUM_AGREES.term, model_completion=True))
        crc = filled(scan.state.key, model).KEYCRC
        checksum = lambda data: crc if agrees else crc ^ 1  # noqa: E731
        params = scan.state.params
        made = eks.Params(
            checksum,
            filled(params.operating_state, model),
            filled(params.dip_switches, model),
            filled(params.T_PULSE_ms, model),
        )
        state = eks.State(
            made, scan.control, filled(scan.state.key, model), filled(scan.state.elapsed_ms, model)
        )
        return state, filled(scan.inputs, model)
    return filled(scan.state, model), filled(scan.inputs, model)


def _expected(device: Device, path: Path, model: z3.ModelRef, state: Any) -> tuple[Any, Any]:
    after, outputs = path.result
    if device is EKS:
        made = eks.State(
            state.params, after.state, evaluated(after.key, model), evaluated(after.elapsed_ms, model)
        )
        return made, evaluated(outputs, model)
    return evaluated(after, model), evaluated(outputs, model)


def _other_member(scan: Scan, path: Path, random_: random.Random) -> z3.ModelRef:
    """A member of the path with a few random values, as far as the path has such a member."""
    solver = z3.SimpleSolver()
    solver.add(scan.premise, path.condition)
    free = [*symbols(scan.inputs), *symbols(scan.state)]
    for symbol in random_.sample(free, min(4, len(free))):
        solver.push()
        value: Any = (
            random_.randrange(0x10000) if symbol.term.sort() != z3.BoolSort() else random_.random() < 0.5
        )
        if symbol.term.sort() == z3.IntSort():
            value = random_.choice((-1, 0, 1, 2, 3, 4, 500, 100_000))
        solver.add(symbol.term == value)
        if solver.check() != z3.sat:
            solver.pop()
    assert solver.check() == z3.sat
    return solver.model()


@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_a_member_of_every_path_gives_the_same_in_the_plain_interpreter(device: Device) -> None:
    for scan in scans(device):
        for path in scan.paths:
            state, inputs = _example(device, scan, path.example)
            assert device.module.step(state, inputs) == _expected(device, path, path.example, state)


@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_random_members_of_paths_give_the_same_in_the_plain_interpreter(device: Device) -> None:
    random_ = random.Random(4)
    for scan in scans(device):
        for path in random_.sample(scan.paths, min(12, len(scan.paths))):
            model = _other_member(scan, path, random_)
            state, inputs = _example(device, scan, model)
            assert device.module.step(state, inputs) == _expected(device, path, model, state)


@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_no_path_of_a_step_raises_and_every_control_state_has_one(device: Device) -> None:
    found = scans(device)
    assert [scan.control for scan in found] == list(device.module.Step)
    assert {scan.control.value for scan in found} == set(device.register.states)
    assert all(scan.paths for scan in found)
    assert not [path for scan in found for path in scan.paths if path.raised]


@given(
    st.tuples(*[st.sampled_from((1, 2, 500, 999, 1000, 1001, 3_600_000))] * 3),
    st.sampled_from((0, 1, 499, 500, 999, 1000, 3_600_000)),
    st.sampled_from(("LA", "ones")),
    st.sampled_from(("hold", "none")),
    st.tuples(*[st.tuples(*[st.booleans()] * 5)] * 5),
    st.booleans(),
)
@settings(deadline=None, max_examples=150)
def test_the_premise_is_what_the_constructor_of_the_parameters_accepts(
    times: tuple[int, int, int],
    dwell: int,
    seq_from: str,
    on_error: str,
    rows: tuple[tuple[bool, ...], ...],
    mend: bool,
) -> None:
    if mend:  # most random rows are refused for one reason; these are right
        rows = tuple(tuple(m == n or (m < n and row[m]) for m in range(5)) for n, row in enumerate(rows))
    values = dict(
        T_ON_ms=times[0], T_SEQ_ms=times[1], T_SEQ_FROM=seq_from, T_REM_ms=times[2], T_DWELL_ms=dwell,
        ON_ERROR=on_error, **{f"PERMITS_{n}": row for n, row in enumerate(rows)},
    )  # fmt: skip
    try:
        fplc.Params(**values)
        accepted = True
    except ParameterError:
        accepted = False
    params = FPLC.params()
    solver = z3.SimpleSolver()
    solver.add(FPLC.parameters_fit(params), *[one.premise for one in symbols(params)])
    for name, value in values.items():
        symbol = getattr(params, name)
        if isinstance(value, tuple):
            solver.add(*[one.term == flag for one, flag in zip(symbol, value, strict=True)])
        else:
            solver.add(symbol.term == (symbol.values.index(value) if isinstance(value, str) else value))
    assert (solver.check() == z3.sat) == accepted


def test_a_device_whose_code_changes_is_explored_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    before = scans(PLC)
    assert scans(PLC) is before
    monkeypatch.setattr(plc, "_copy_mw03", plc._copy_mw07)
    assert scans(PLC) is not before


@cache
def _paths() -> int:
    return sum(len(scan.paths) for device in DEVICES for scan in scans(device))


def test_there_are_thousands_of_paths() -> None:
    assert _paths() > 4000

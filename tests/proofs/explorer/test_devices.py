"""On the four devices explorer and interpreter agree, and no valid input is outside the premises."""

import operator
import random
from collections.abc import Callable
from functools import cache, reduce
from typing import Any

import pytest
import z3
from hypothesis import given, settings
from hypothesis import strategies as st

from proofs.explorer.device import Device, Scan, scans
from proofs.explorer.explore import Path
from proofs.explorer.records import evaluated, filled, symbols
from proofs.explorer.values import Flag, Opaque, Symbol, Text, Word
from proofs.mode_selection.devices import CHECKSUM_AGREES, DEVICES, EKS, FPLC, PLC
from refimpl.errors import ParameterError
from refimpl.mode_selection import eks, fplc, plc
from refimpl.mode_selection.code_tables import CH, RE, SE, SW

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


def _values(symbol: Symbol, random_: random.Random) -> Any:
    """A random value in the symbol's range, often one that the code compares with."""
    if isinstance(symbol, Flag):
        return random_.random() < 0.5
    if isinstance(symbol, Text):
        return random_.randrange(len(symbol.values))
    if isinstance(symbol, Word):
        codes = (0, *RE, *SE, *CH, *SW, random_.randrange(symbol.high + 1))
        return min(max(random_.choice(codes), symbol.low), symbol.high)
    high = 3_600_000 if symbol.high is None else symbol.high
    near = (symbol.low, symbol.low + 1, 1, 500, 1000, high, random_.randint(symbol.low, high))
    return min(max(random_.choice(near), symbol.low), high)


class _Members:
    """Other members of the paths of a scan: the example of a path with a few values of its own."""

    def __init__(self, device: Device, scan: Scan, random_: random.Random) -> None:
        self.random = random_
        stand_ins = [one.answer for one in device.stand_ins]
        self.free = [
            *{one.term.get_id(): one for one in (*symbols(scan.inputs), *symbols(scan.state))}.values()
        ]
        self.free += stand_ins
        self.premise = scan.premise
        self.known: dict[int, Callable[[dict[str, Any]], Any]] = {}

    def of(self, path: Path) -> dict[str, Any] | None:
        """Values by the name of their symbol, at least one of them another than in the example; None when no
        attempt finds any.
        """
        model = path.example
        example = {str(one.term): _number(model.eval(one.term, model_completion=True)) for one in self.free}
        for attempt in range(40):
            found = dict(example)
            for one in self.random.sample(self.free, 1 + attempt % 3):
                found[str(one.term)] = _values(one, self.random)
            if found != example and self.fits(path, found):
                return found
        return None

    def fits(self, path: Path, values: dict[str, Any]) -> bool:
        """All that is asked on the path has its answer, and all ranges are kept; judged without a solver."""
        return all(bool(self.judged(one.question, values)) == one.answer for one in path.decisions) and bool(
            self.judged(self.premise, values)
        )

    def judged(self, term: z3.ExprRef, values: dict[str, Any]) -> Any:
        """The value of a term, by Python alone."""
        if term.get_id() not in self.known:
            self.known[term.get_id()] = _compiled(term)
        return self.known[term.get_id()](values)


def _number(value: z3.ExprRef) -> Any:
    return z3.is_true(value) if z3.is_bool(value) else value.as_long()


def _compiled(term: z3.ExprRef) -> Callable[[dict[str, Any]], Any]:
    """A term as a Python function of the values of its symbols."""
    kind, parts = term.decl().kind(), [_compiled(part) for part in term.children()]
    if z3.is_bv_value(term) or z3.is_int_value(term) or z3.is_true(term) or z3.is_false(term):
        constant = _number(term)
        return lambda values: constant
    if kind == z3.Z3_OP_UNINTERPRETED:
        name = str(term)
        return lambda values: values[name]
    if kind == z3.Z3_OP_EXTRACT:
        high, low = term.params()
        return lambda values: (parts[0](values) >> low) & ((2 << (high - low)) - 1)
    if kind == z3.Z3_OP_BNOT:
        mask = (1 << term.size()) - 1
        return lambda values: parts[0](values) ^ mask
    if kind == z3.Z3_OP_CONCAT:
        sizes = [part.size() for part in term.children()]
        return lambda values: reduce(
            lambda whole, one: (whole << one[0]) | one[1](values), zip(sizes, parts, strict=True), 0
        )
    if kind in (z3.Z3_OP_AND, z3.Z3_OP_OR):
        any_or_all = all if kind == z3.Z3_OP_AND else any
        return lambda values: any_or_all(part(values) for part in parts)
    operation = OPERATIONS[kind]
    return lambda values: operation(*[part(values) for part in parts])


OPERATIONS: dict[int, Callable[..., Any]] = {
    z3.Z3_OP_NOT: operator.not_,
    z3.Z3_OP_IMPLIES: lambda one, other: not one or other,
    z3.Z3_OP_EQ: operator.eq,
    z3.Z3_OP_ITE: lambda condition, one, other: one if condition else other,
    z3.Z3_OP_LE: operator.le,
    z3.Z3_OP_GE: operator.ge,
    z3.Z3_OP_LT: operator.lt,
    z3.Z3_OP_GT: operator.gt,
    z3.Z3_OP_ULEQ: operator.le,
    z3.Z3_OP_UGEQ: operator.ge,
    z3.Z3_OP_ULT: operator.lt,
    z3.Z3_OP_UGT: operator.gt,
    z3.Z3_OP_ADD: lambda *parts: sum(parts),
    z3.Z3_OP_SUB: operator.sub,
    z3.Z3_OP_MUL: operator.mul,
    z3.Z3_OP_UMINUS: operator.neg,
    z3.Z3_OP_BAND: operator.and_,
    z3.Z3_OP_BOR: operator.or_,
    z3.Z3_OP_BXOR: operator.xor,
}


class _Model:
    """Values in the place of a model of the solver."""

    def __init__(self, members: _Members, values: dict[str, Any]) -> None:
        self.members = members
        self.values = values

    def eval(self, term: z3.ExprRef, model_completion: bool = True) -> z3.ExprRef:
        """The value of a term, as the solver would write it."""
        value = self.members.judged(term, self.values)
        if z3.is_bool(term):
            return z3.BoolVal(value)
        return z3.BitVecVal(value, term.size()) if z3.is_bv(term) else z3.IntVal(value)


@pytest.mark.deep
@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_a_member_of_every_path_agrees_with_the_plain_interpreter(device: Device) -> None:
    for scan in scans(device):
        for path in scan.paths:
            state, inputs = _example(device, scan, path.example)
            assert device.module.step(state, inputs) == _expected(device, path, path.example, state)


@pytest.mark.deep
@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_random_members_of_paths_agree_with_the_plain_interpreter(device: Device) -> None:
    """Of every path, or of 60 from a control state with more. Members are found and judged without a solver;
    where chance finds none, the example of the test above has to do.
    """
    random_, found, paths = random.Random(4), 0, 0
    for scan in scans(device):
        members = _Members(device, scan, random_)
        for path in random_.sample(scan.paths, min(60, len(scan.paths))):
            paths += 1
            values = members.of(path)
            if values is not None:
                found += 1
                model: Any = _Model(members, values)
                state, inputs = _example(device, scan, model)
                assert device.module.step(state, inputs) == _expected(device, path, model, state)
    assert found >= 0.97 * paths


def test_a_value_outside_of_a_path_is_no_member() -> None:
    (scan,) = [one for one in scans(PLC) if one.control == plc.Step.COPY_MW03]
    fplc_scan = scans(FPLC)[1]
    members = _Members(FPLC, fplc_scan, random.Random(1))
    for path in fplc_scan.paths[::8]:
        values = members.of(path)
        assert values is not None
        others = [other for other in fplc_scan.paths if other is not path and members.fits(other, values)]
        assert others == []
    assert _Members(PLC, scan, random.Random(1)).of(scan.paths[0]) is not None


@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_no_path_raises_and_every_control_state_has_one(device: Device) -> None:
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

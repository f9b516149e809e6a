"""One scan of a device as a reader of properties sees it: before, inputs, after, and what was sent.

Every field is a solver term with the name that interface.toml gives it, so that a property can be written
like the one of the specification: `one.after.selection`, `one.sends.MW05`. Only the control state is a plain
text, for a run of the explorer begins in one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import z3

from proofs.explorer.device import Device, Scan, judged, scans
from proofs.explorer.ends import FALSE, Tree, always, ends, in_terms, some, tree, value
from proofs.explorer.errors import ConcretizationError
from proofs.explorer.explore import Exploration, explore
from proofs.explorer.records import terms, unvalidated
from proofs.mode_selection.ranges import codes
from proofs.theorem import TheoremError
from proofs.words import constant

LEVELS: Final = range(5)
NONE: Final = -1


@dataclass(frozen=True, eq=False)
class Scanned:
    """One way through a scan. `sent` are the outputs of the state before it, `sends` those of this scan."""

    device: Device
    params: Any
    before: Any
    inputs: Any
    """None at power-up."""
    sent: Any
    after: Any
    sends: Any
    result: Any
    """The State after the scan as it came, with its parameters."""

    def was(self, *names: str) -> bool:
        """The control state before the scan is one of these."""
        return control(self.device, self.before) in names

    def becomes(self, *names: str) -> bool:
        """The control state after the scan is one of these."""
        return control(self.device, self.after) in names

    def kept(self, name: str) -> bool:
        """The scan does not write this field of memory."""
        return bool(getattr(self.before, name).eq(getattr(self.after, name)))


Property = Callable[[Scanned], z3.BoolRef]
"""What a scan must fulfil; the constant TRUE where it does not speak of the path."""


def control(device: Device, state: Any) -> str:
    """The control state of a State record, as the interface register writes it."""
    name: str = getattr(state, device.control).value
    return name


def memory(device: Device, state: Any) -> Any:
    """A State record in terms, with the records in it."""
    return in_terms(state, {**device.register.inputs, **device.register.memory})


def parameters(device: Device, state: Any) -> Any:
    """The parameters of a State record in terms."""
    return in_terms(state.params, device.register.parameters)


def scanned(device: Device, state: Any, inputs: Any, result: Any, sent: Any) -> Scanned:
    """The scan from `state` with `inputs` to `result`, from records with symbols or with plain values.

    Raises ConcretizationError when the scan changes the parameters.
    """
    after, sends = result
    if not _equal(parameters(device, state), parameters(device, after)):
        raise ConcretizationError(f"{device.name}: step changes its parameters")
    return Scanned(
        device,
        parameters(device, state),
        memory(device, state),
        None if inputs is None else in_terms(inputs, device.register.inputs),
        sent,
        memory(device, after),
        in_terms(sends, device.register.outputs),
        after,
    )


def _equal(one: Any, other: Any) -> bool:
    pairs = zip(terms(one), terms(other), strict=True)
    return all(
        first.eq(second) if isinstance(first, z3.ExprRef) else first == second
        for (_, first), (_, second) in pairs
    )


@dataclass(frozen=True, eq=False)
class Scans:
    """All scans from one control state: where their paths end, and each end as a reader sees it."""

    device: Device
    scan: Scan
    root: Tree
    read: Mapping[int, Scanned]

    @property
    def control(self) -> str:
        """The control state that they begin in."""
        return control(self.device, self.scan.state)

    def always(self, then: Property) -> z3.BoolRef:
        """After every scan `then` is true."""
        return always(self.root, lambda end: then(self.read[id(end)]))

    def some(self, then: Property) -> z3.BoolRef:
        """The scan goes on one of the paths after which `then` is true."""
        return some(self.root, lambda end: then(self.read[id(end)]))


def scans_of(device: Device, explored: Sequence[Scan] = ()) -> tuple[Scans, ...]:
    """The scans of a device from each control state. explored: these instead of the shipped ones.

    Raises TheoremError when a path of the step raises, ConcretizationError when one changes the parameters.
    """
    return tuple(_scans_from(device, scan) for scan in explored or scans(device))


def _scans_from(device: Device, scan: Scan) -> Scans:
    for path in scan.paths:
        if path.raised is not None:
            raise TheoremError(f"from {control(device, scan.state)} step raises: {path.raised}")
    if id(scan) not in _KNOWN:
        root = tree(scan.paths)
        sent = outputs_of(device, scan.state)
        read = {id(end): scanned(device, scan.state, scan.inputs, end.result, sent) for end in ends(root)}
        _KNOWN[id(scan)] = Scans(device, scan, root, read)
    return _KNOWN[id(scan)]


_KNOWN: dict[int, Scans] = {}


def outputs_of(device: Device, state: Any) -> Any:
    """The row of outputs that the shipped `outputs` gives to a state with symbols, in terms.

    Raises ConcretizationError when a text depends on more than the control state.
    """
    code = judged(device)
    found = explore(code.module.outputs, (state,), code.parameters_fit(state.params), code.stand_ins)
    rows = {id(path.result): in_terms(path.result, device.register.outputs) for path in found.paths}
    first = rows[id(found.paths[0].result)]
    values = {name: _joined(found, rows, name) for name in first.__dataclass_fields__}
    return unvalidated(type(first), values)


def _joined(found: Exploration, rows: Mapping[int, Any], name: str) -> Any:
    """A field of the row as one term, or one for each of its parts."""
    columns = [getattr(row, name) for row in rows.values()]
    if isinstance(columns[0], tuple):
        return tuple(value(found, _part(rows, name, number)) for number in range(len(columns[0])))
    if isinstance(columns[0], z3.ExprRef):
        return value(found, _part(rows, name))
    if any(one != columns[0] for one in columns):
        raise ConcretizationError(f"the output {name} is a text and depends on memory: {columns}")
    return columns[0]


def _part(rows: Mapping[int, Any], name: str, number: int | None = None) -> Callable[[Any], z3.ExprRef]:
    if number is None:
        return lambda result: getattr(rows[id(result)], name)
    return lambda result: getattr(rows[id(result)], name)[number]


# ---------------------------------------------------------------- words and modes


def code(name: str, mode: z3.ArithRef) -> z3.BitVecRef:
    """The word of the mode in a range of Table 2; zero for none."""
    if z3.is_int_value(mode):
        known = mode.as_long()
        return constant(codes(name)[known] if known in LEVELS else 0)
    term: z3.BitVecRef = constant(0)
    for number, word in enumerate(codes(name)):
        term = z3.If(mode == number, constant(word), term)
    return term


def mode(name: str, word: z3.BitVecRef) -> z3.ArithRef:
    """The mode that the word means in a range of Table 2; -1 for none."""
    if z3.is_bv_value(word):
        known, listed = word.as_long(), codes(name)
        return z3.IntVal(listed.index(known) if known in listed else NONE)
    term: z3.ArithRef = z3.IntVal(NONE)
    for number, known in enumerate(codes(name)):
        term = z3.If(word == constant(known), z3.IntVal(number), term)
    return term


def permits(params: Any, level: z3.ArithRef, selected: z3.ArithRef) -> z3.BoolRef:
    """This machine permits the mode to the level; none permits nothing. EKS-T2-2, E-47"""
    if z3.is_int_value(level):
        return _permits_own(params, level.as_long(), selected)
    return z3.Or(*[z3.And(level == own, _permits_own(params, own, selected)) for own in LEVELS])


def _permits_own(params: Any, level: int, selected: z3.ArithRef) -> z3.BoolRef:
    if level not in LEVELS:
        return FALSE
    row = getattr(params, f"PERMITS_{level}")
    if z3.is_int_value(selected):
        known = selected.as_long()
        return row[known] if known in LEVELS else FALSE
    return z3.Or(*[z3.And(selected == number, row[number]) for number in range(level + 1)])


def is_mode(term: z3.ArithRef) -> z3.BoolRef:
    """One of the five modes or levels."""
    return z3.And(term >= 0, term <= LEVELS[-1])


# ---------------------------------------------------------------- the five outputs of the EKS


def vector(record: Any) -> tuple[z3.BoolRef, ...]:
    """The outputs of the EKS by level."""
    return record.A, record.B, record.C, record.D, record.STR


def only(flags: tuple[z3.BoolRef, ...], level: int) -> z3.BoolRef:
    """This output is set and no other."""
    return z3.And(*[flag if number == level else z3.Not(flag) for number, flag in enumerate(flags)])


def only_of(flags: tuple[z3.BoolRef, ...], level: z3.ArithRef) -> z3.BoolRef:
    """The output of the level is set and no other."""
    return z3.Or(*[z3.And(level == number, only(flags, number)) for number in LEVELS])


def one_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """Exactly one output is set."""
    return z3.Or(*[only(flags, level) for level in LEVELS])


def none_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """No output is set."""
    return z3.Not(z3.Or(*flags))


def all_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """All five outputs are set."""
    return z3.And(*flags)


def several_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """Two outputs or more are set."""
    return z3.Or(*[z3.And(flags[a], flags[b]) for a in LEVELS for b in LEVELS if a < b])

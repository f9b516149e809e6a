"""One scan of a device as a reader of properties sees it: before, inputs, after, and what was sent.

Every field is a solver term with the name that interface.toml gives it, so that a property can be written
like the one of the specification: `one.after.selection`, `one.sends.MW05`. Only the control state is a plain
text, for a run of the explorer begins in one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

from proofs.explorer.device import Device, Scan, judged, scans
from proofs.explorer.ends import Tree, always, ends, in_terms, some, tree, value
from proofs.explorer.errors import ConcretizationError
from proofs.explorer.explore import Exploration, explore
from proofs.explorer.records import terms, unvalidated
from proofs.theorem import TheoremError


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


def _equal(record: Any, other: Any) -> bool:
    pairs = zip(terms(record), terms(other), strict=True)
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
    if any(column != columns[0] for column in columns):
        raise ConcretizationError(f"the output {name} is a text and depends on memory: {columns}")
    return columns[0]


def _part(rows: Mapping[int, Any], name: str, number: int | None = None) -> Callable[[Any], z3.ExprRef]:
    if number is None:
        return lambda result: getattr(rows[id(result)], name)
    return lambda result: getattr(rows[id(result)], name)[number]

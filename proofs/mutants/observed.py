"""Changed copies that nobody can tell from the shipped code: they differ in memory that nothing reads again.

A field of the memory is *seen* in a control state when some path from there asks it, writes it to an output,
or hands it on to a field that is seen in the control state that follows. What is not seen there may be
anything: with the same inputs the same path is taken, with the same outputs, to memory that again differs
only in what is not seen. This is read off the paths of the shipped code, from any memory in its ranges.

So a copy is told from the shipped code by nobody if its step gives the same outputs and the same seen memory
wherever its memory may be: everywhere the invariant holds once what is not seen is given its right value. One
query for each path that passes the edit, as in differences.py; the memory that is not seen must stay in its
ranges. By induction over scans the outputs are then the same from power-up on, for all inputs, times and
parameters.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Final

import z3

from modeproof.kit.by_name import module_named
from proofs.explorer.device import Device, symbol_of
from proofs.explorer.errors import ExplorationError
from proofs.explorer.explore import Path, conjunction, disjunction, explore
from proofs.explorer.records import plain, symbols, terms, unvalidated
from proofs.mutants.copies import Change, CopyError, copied
from proofs.mutants.differences import LIMIT_MS, NoAnswer
from proofs.mutants.differences import _term as as_term
from proofs.mutants.shipped import Shipped, Subject, Way, entry, run, shipped

EQUIVALENT, DIFFERS, UNMEASURED = "EQUIVALENT", "DIFFERS", "UNMEASURED"
PARAMS: Final = "params"


@dataclass(frozen=True)
class Sight:
    """Which fields of a device's memory are seen in each control state; the control state always is."""

    device: Device
    seen: Mapping[str, frozenset[str]]

    def hidden(self, control: str) -> tuple[str, ...]:
        """The fields that are not seen there."""
        names = (field.name for field in fields(self.device.module.State))
        return tuple(
            name
            for name in names
            if name not in (PARAMS, self.device.control) and name not in self.seen[control]
        )


def sight_of(device: Device) -> Sight:
    """Read off every path what is seen. Raises ExplorationError."""
    direct: dict[str, set[str]] = {}
    handed: dict[str, list[tuple[str, str, frozenset[str]]]] = {}
    names = _Names()
    params = device.params()
    for control in device.module.Step:
        state = device.state(control, params)
        found = explore(
            device.module.step,
            (state, device.inputs()),
            device.parameters_fit(params),
            device.stand_ins,
            twice=False,
        )
        owner = {
            str(symbol.term.decl().name()): field.name
            for field in fields(type(state))
            if field.name != PARAMS
            for symbol in symbols(getattr(state, field.name))
        }

        def fields_in(values: Iterable[object], owner: Mapping[str, str] = owner) -> set[str]:
            return {owner[name] for value in values for name in names.of(value) if name in owner}

        asked = direct.setdefault(control.value, set(_always(device)))
        rows = handed.setdefault(control.value, [])
        for path in found.paths:
            asked |= fields_in(decision.question for decision in path.decisions if not decision.forced)
            if path.raised is not None:
                continue
            after, outputs = path.result
            asked |= fields_in(leaf for _, leaf in terms(outputs))
            then = getattr(after, device.control).value
            for field in fields(type(after)):
                if field.name not in (PARAMS, device.control):
                    read = fields_in(leaf for _, leaf in terms(getattr(after, field.name)))
                    rows.append((then, field.name, frozenset(read)))
    while True:
        before = {control: frozenset(found) for control, found in direct.items()}
        for control, rows in handed.items():
            for then, name, sources in rows:
                if name in before[then]:
                    direct[control] |= sources
        if before == {control: frozenset(found) for control, found in direct.items()}:
            return Sight(device, before)


def _always(device: Device) -> frozenset[str]:
    """Fields that count as seen wherever they are: those that no single symbol can stand for."""
    declared = {signal.python for signal in device.register.memory.values()}
    names = {field.name for field in fields(device.module.State)}
    return frozenset(name for name in names if name in device.memory or name not in declared)


class _Names:
    """The names of the symbols in a term; each term is looked through once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[z3.ExprRef, frozenset[str]]] = {}

    def of(self, value: object) -> frozenset[str]:
        if not isinstance(value, z3.ExprRef):
            return frozenset()
        known = self._known.get(value.get_id())
        if known is None:
            found = frozenset().union(*(self.of(child) for child in value.children()))
            if z3.is_const(value) and value.decl().kind() == z3.Z3_OP_UNINTERPRETED:
                found = frozenset({str(value.decl().name())})
            known = self._known[value.get_id()] = (value, found)
        return known[1]


@dataclass(frozen=True, eq=False)
class Bench:
    """The devices of a package, each with what is seen of it and its ways from all memory that a copy that is
    like it may have.
    """

    package: str
    devices: Mapping[str, tuple[Sight, Shipped]]


def bench_of(document: str) -> Bench:
    """Explore every device of a document. Raises ExplorationError."""
    subjects: Sequence[Subject] = module_named(f"proofs.{document}.subjects").SUBJECTS
    return Bench(f"refimpl.{document}", {subject.device.name: explored(subject) for subject in subjects})


def explored(subject: Subject) -> tuple[Sight, Shipped]:
    """What is seen of a device, and its ways."""
    sight = sight_of(subject.device)

    def known(state: Any) -> z3.BoolRef:
        return subject.known(_right(sight, state))

    return sight, shipped(Subject(subject.device, known, subject.answered))


def _right(sight: Sight, state: Any) -> Any:
    """The memory with other symbols for what is not seen: its right values."""
    device = sight.device
    signals = {signal.python: signal for signal in device.register.memory.values()}
    hidden = sight.hidden(getattr(state, device.control).value)
    values = {field.name: getattr(state, field.name) for field in fields(type(state))}
    for name in hidden:
        values[name] = symbol_of(signals[name], f"right.{name}")
    return unvalidated(type(state), values)


@dataclass(frozen=True)
class Observed:
    """EQUIVALENT, DIFFERS with a witness, or UNMEASURED with the reason."""

    verdict: str
    witness: str = ""
    reason: str = ""


def observe(bench: Bench, change: Change, file: str) -> Observed:
    """Whether anybody could tell the changed copy from the shipped code; `file` is that of the module."""
    try:
        copy = copied(bench.package, change)
        for sight, ours in bench.devices.values():
            device = copy.of(sight.device)
            for way in ours.passing(file, change.lines):
                found = _told(sight, device, way)
                if found:
                    return Observed(DIFFERS, found)
    except (CopyError, ExplorationError, NoAnswer) as error:
        return Observed(UNMEASURED, reason=" ".join(str(error).split()))
    return Observed(EQUIVALENT)


def _told(sight: Sight, device: Device, way: Way) -> str:
    """A member of the way that tells the copy from the shipped code; empty when there is none."""
    fit = conjunction([way.premise, way.path.condition])
    found = explore(entry(device, way.control), way.arguments, fit, device.stand_ins, twice=False)
    for path in found.paths:
        model = _apart(sight, found.premise, path, way.path)
        if model is not None:
            member = tuple(plain(argument, model) for argument in way.arguments)
            right, other = run(sight.device, way, model), run(device, way, model)
            return f"{device.name}, {way.control}: {member!r}: {right!r}; now {other!r}"
    return ""


def _apart(sight: Sight, premise: z3.BoolRef, path: Path, ours: Path) -> z3.ModelRef | None:
    if path.raised is not None or ours.raised is not None:
        return None if type(path.raised) is type(ours.raised) else path.example
    control = sight.device.control
    then, now = (getattr(scan.result[0], control) for scan in (ours, path))
    if then is not now:
        return path.example
    hidden = {f"[0].{name}" for name in sight.hidden(then.value)}
    wrong: list[z3.BoolRef] = []
    left, right = list(terms(ours.result)), list(terms(path.result))
    if [place for place, _ in left] != [place for place, _ in right]:
        return path.example
    for (place, our), (_, other) in zip(left, right, strict=True):
        is_hidden = any(place == name or place.startswith((f"{name}.", f"{name}[")) for name in hidden)
        if not isinstance(our, z3.ExprRef) and not isinstance(other, z3.ExprRef):
            if is_hidden:
                if type(our) is not type(other):
                    return path.example
            elif type(our) is not type(other) or our != other:
                return path.example
            continue
        if is_hidden:
            continue
        first, second = as_term(our, other, place), as_term(other, our, place)
        if not first.eq(second):
            wrong.append(first != second)
    wrong += _out_of_range(sight, hidden, path.result[0])
    if not wrong:
        return None
    solver = z3.SimpleSolver()
    solver.set("timeout", LIMIT_MS)
    solver.add(premise, path.condition, disjunction(wrong))
    answer = solver.check()
    if answer == z3.unknown:
        raise NoAnswer(f"whether the copy can be told: {solver.reason_unknown()}")
    return solver.model() if answer == z3.sat else None


def _out_of_range(sight: Sight, hidden: Iterable[str], after: Any) -> Iterator[z3.BoolRef]:
    """For each field that is not seen, that it leaves the range in which the shipped code was explored."""
    device = sight.device
    signals = {signal.python: signal for signal in device.register.memory.values()}
    for name in (place.rpartition(".")[2] for place in hidden):
        allowed = symbol_of(signals[name], "any")
        for value, (place, leaf) in zip(symbols(allowed), terms(getattr(after, name), name), strict=True):
            if not z3.is_true(value.premise):
                term = as_term(leaf, value.term, place)
                yield z3.Not(z3.substitute(value.premise, (value.term, term)))

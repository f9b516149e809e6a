"""Where a changed copy ends otherwise than the shipped code does.

The copy is explored anew on each shipped path that passes the edit, under the condition of that path. What it
returns on each of its own paths there is compared with what the shipped path returns: leaf by leaf as it is
written, and by a query where it is written otherwise.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import z3

from proofs.explorer.device import Device, Scan
from proofs.explorer.explore import Exploration, Path, conjunction, disjunction, explore
from proofs.explorer.records import plain, terms
from proofs.mutants.shipped import Way, entry, run

LIMIT_MS = 20_000


class NoAnswer(Exception):
    """The solver could not say."""


@dataclass(frozen=True, eq=False)
class Difference:
    """A shipped path on which the copy ends otherwise, and a member of it on which it does."""

    way: Way
    found: Exploration
    """The paths of the copy under the condition of the shipped one."""
    member: tuple[Any, ...]
    shipped: Any
    """What the shipped code returns for the member."""
    other: Any
    """What the copy returns, or the exception that it raises."""

    @property
    def raises(self) -> Path | None:
        """A path of the copy that raises."""
        return next((path for path in self.found.paths if path.raised is not None), None)


def difference(device: Device, shipped: Device, way: Way) -> Difference | None:
    """The difference between the copied and the shipped device on a path of the latter; None: there is none.

    Raises ExplorationError when the copy cannot be followed, NoAnswer when the solver gives none.
    """
    fit = conjunction([way.premise, way.path.condition])
    found = explore(entry(device, way.control), way.arguments, fit, device.stand_ins, twice=False)
    for path in found.paths:
        model = _apart(found.premise, path, way.path)
        if model is not None:
            member = tuple(plain(argument, model) for argument in way.arguments)
            return Difference(way, found, member, run(shipped, way, model), run(device, way, model))
    return None


def _apart(premise: z3.BoolRef, path: Path, shipped: Path) -> z3.ModelRef | None:
    """A member of the path of the copy that the shipped path gives another result; None: there is none."""
    if path.raised is not None:
        return path.example
    ours, others = list(terms(shipped.result)), list(terms(path.result))
    if [place for place, _ in ours] != [place for place, _ in others]:
        return path.example
    unlike: list[z3.BoolRef] = []
    for (place, left), (_, other) in zip(ours, others, strict=True):
        if not isinstance(left, z3.ExprRef) and not isinstance(other, z3.ExprRef):
            if type(left) is not type(other) or left != other:
                return path.example
            continue
        first, second = _term(left, other, place), _term(other, left, place)
        if not first.eq(second):
            unlike.append(first != second)
    if not unlike:
        return None
    solver = z3.SimpleSolver()
    solver.set("timeout", LIMIT_MS)
    solver.add(premise, path.condition, disjunction(unlike))
    answer = solver.check()
    if answer == z3.unknown:
        raise NoAnswer(f"whether the results differ: {solver.reason_unknown()}")
    return solver.model() if answer == z3.sat else None


def _term(value: Any, beside: Any, place: str) -> z3.ExprRef:
    """A leaf as a term of the same kind as the one beside it. Raises NoAnswer when it is of no such kind."""
    if isinstance(value, z3.ExprRef):
        return value
    if type(value) is bool and z3.is_bool(beside):
        return z3.BoolVal(value)
    if type(value) is int and z3.is_bv(beside):
        return z3.BitVecVal(value, beside.size())
    if type(value) is int and z3.is_int(beside):
        return z3.IntVal(value)
    raise NoAnswer(f"{place}: {value!r} cannot be compared with {beside}")


# ---------------------------------------------------------------- as scans that theorems can judge


def as_scans(differences: list[Difference]) -> tuple[Scan, ...]:
    """For each control state the scans of the copy where it differs; those at power-up are left out.

    The paths of the copy hang below the shipped path on which they were found, so that all of them together
    are again the leaves of one tree of questions.
    """
    by_control: dict[str, list[Difference]] = {}
    for difference in differences:
        if difference.way.scan is not None:
            by_control.setdefault(difference.way.control, []).append(difference)
    return tuple(_scan(found, lambda scan: scan.found.paths) for found in by_control.values())


def as_shipped_scans(differences: list[Difference]) -> tuple[Scan, ...]:
    """The same control states with the shipped paths."""
    by_control: dict[str, list[Difference]] = {}
    for difference in differences:
        if difference.way.scan is not None:
            by_control.setdefault(difference.way.control, []).append(difference)
    return tuple(_scan(found, lambda scan: (scan.way.path,)) for found in by_control.values())


def _scan(found: list[Difference], paths: Callable[[Difference], tuple[Path, ...]]) -> Scan:
    way = found[0].way
    assert way.scan is not None
    made = []
    for place in found:
        for path in paths(place):
            below = () if path is place.way.path else place.way.path.decisions
            made.append(Path((*below, *path.decisions), path.result, path.raised, path.example, path.asked))
    exploration = Exploration(way.premise, tuple(made), 0, 0)
    return Scan(way.scan.control, way.scan.state, way.scan.inputs, exploration)

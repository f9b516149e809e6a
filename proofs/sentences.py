"""How a property becomes queries: judged after every scan from every state of the invariant.

An `Always` speaks of states, a `Sentence` of scans. The premises of a query are what is known of the state
before the scan; `it is spoken of` is what the sentence itself supposes, so that the twin shows that this
occurs. A control is a query that must find an example: the same without the part of the invariant that the
sentence rests on, or with a stronger sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import z3

from modeproof.registers import Signal
from proofs.explorer.device import LOGIC, MODES, WORD_MAX, Device, Scan, judged, no_two_paths, some_path
from proofs.explorer.device import scans as scans_from
from proofs.explorer.ends import FALSE, TRUE, in_terms
from proofs.explorer.explore import conjunction, explore
from proofs.explorer.invariant import Conjunct, conjuncts
from proofs.explorer.scanned import Property, Scanned, Scans, scanned, scans_of
from proofs.explorer.scanned import control as control_of
from proofs.explorer.values import Opaque
from proofs.theorem import NotJudged, Queries, Query, TheoremError, claim, control

Obligation = tuple[z3.BoolRef, z3.BoolRef] | None
"""What is supposed of a scan, and what is then demanded; None where a path is not spoken of."""
Sentence = Callable[[Scanned], Obligation]
Always = Callable[[Scanned, Any], z3.BoolRef]
"""What is demanded of the state after a scan, of its outputs, and of what the observer has seen by then."""
Known = Mapping[str, z3.BoolRef]


def supposed(sentence: Sentence) -> Property:
    """The sentence speaks of the scan."""

    def of(scan: Scanned) -> z3.BoolRef:
        obligation = sentence(scan)
        return FALSE if obligation is None else obligation[0]

    return of


def demanded(sentence: Sentence) -> Property:
    """Where the sentence speaks of the scan, what it demands is so."""

    def of(scan: Scanned) -> z3.BoolRef:
        obligation = sentence(scan)
        return TRUE if obligation is None else z3.Implies(*obligation)

    return of


@dataclass(frozen=True)
class Judge:
    """A device, the invariant that its sentences may rest on, and the observer that goes with it.

    seen: the observer's memory before a scan, as symbols; sees: after it; nothing: at power-up. explored:
    scans to be judged instead of those of the shipped step.
    """

    device: Device
    invariant: tuple[Conjunct, ...]
    seen: Any = None
    sees: Callable[[Scanned], Any] = lambda scan: None
    nothing: Any = None
    explored: tuple[Scan, ...] = ()

    def scans(self) -> tuple[Scans, ...]:
        """The scans from each control state."""
        return scans_of(self.device, self.explored)

    def begin(self, name: str) -> Scans:
        """The scans from this control state. Raises NotJudged when only others are judged."""
        for scans in self.scans():
            if scans.control == name:
                return scans
        raise NotJudged(f"no scan from {name} is judged")

    def premises(self, scans: Scans, without: tuple[str, ...] = ()) -> dict[str, z3.BoolRef]:
        """All values in their ranges, and the invariant of the state before the scan."""
        known = conjuncts(self.invariant, self.device, scans.scan.state, self.seen)
        kept = {f"before: {name}": formula for name, formula in known.items() if name not in without}
        return {"memory, inputs and parameters in their ranges": scans.scan.premise, **kept}

    def known(self, state: Any) -> z3.BoolRef:
        """The invariant of this state (a State record) as one formula."""
        return z3.And(*conjuncts(self.invariant, self.device, state, self.seen).values())

    # ---- the invariant

    def initiation(self) -> Queries:
        """Each conjunct is true at power-up."""
        scan, premise = self._power_up()
        for name, formula in conjuncts(self.invariant, self.device, scan.result, self.nothing).items():
            yield from claim(name, {"parameters in their ranges": premise}, formula, LOGIC)

    def consecution(self) -> Queries:
        """Every scan keeps the invariant: a claim for each control state and each one that follows it."""
        for scans in self.scans():
            for end in dict.fromkeys(control_of(self.device, scan.after) for scan in scans.read.values()):
                given = {**self.premises(scans), f"it leads to {end}": scans.some(_leads_to(end))}
                yield from claim(f"{scans.control} to {end}", given, scans.always(self.kept(end)), LOGIC)

    def kept(self, end: str = "") -> Property:
        """The invariant after a scan, or after one that leads to the control state `end`."""

        def after(scan: Scanned) -> z3.BoolRef:
            if end and not scan.becomes(end):
                return TRUE
            return conjunction([*self.after(scan).values()])

        return after

    def after(self, scan: Scanned) -> dict[str, z3.BoolRef]:
        """The conjuncts of the state after a scan, by name."""
        return conjuncts(self.invariant, self.device, scan.result, self.sees(scan))

    # ---- what follows from it

    def in_every_scan(self, sentence: Sentence, also: Known | None = None) -> Queries:
        """The claim for each control state that the sentence speaks of; `also`: further premises."""
        sentence = cache(sentence)
        for scans in self.scans():
            if any(sentence(scan) is not None for scan in scans.read.values()):
                spoken = {"it is spoken of": scans.some(supposed(sentence))}
                given = {**self.premises(scans), **(also or {}), **spoken}
                yield from claim(f"from {scans.control}", given, scans.always(demanded(sentence)), LOGIC)

    def after_every_scan(self, always: Always) -> Queries:
        """The claim on the state after a scan, for each control state before it; and at power-up."""
        yield from self.at_power_up(always)
        for scans in self.scans():
            then = scans.always(lambda scan: always(scan, self.sees(scan)))
            yield from claim(f"from {scans.control}", self.premises(scans), then, LOGIC)

    def at_power_up(self, always: Always) -> Queries:
        """The claim on the state after power-up and the outputs that belong to it."""
        scan, premise = self._power_up()
        given = {"parameters in their ranges": premise}
        yield from claim(f"{self.device.name} at power-up", given, always(scan, self.nothing), LOGIC)

    def _power_up(self) -> tuple[Scanned, z3.BoolRef]:
        """Power-up in the form of a scan whose state before equals its state after, and the premise."""
        module, params = judged(self.device).module, self.device.params()
        found = explore(
            lambda given: (module.power_up(given), module.outputs(module.power_up(given))),
            (params,),
            self.device.parameters_fit(params),
        )
        (path,) = found.paths
        state, outputs = path.result
        sends = in_terms(outputs, self.device.register.outputs)
        return scanned(self.device, state, None, (state, outputs), sends), found.premise

    # ---- controls

    def without(self, sentence: Sentence, start: str, *names: str) -> Query:
        """A control: without these conjuncts of the invariant a scan from this control state breaks it."""
        scans = self.begin(start)
        what = f"without {' and '.join(names)}"
        return self._broken(what, scans, self.premises(scans, without=names), sentence)

    def too_strong(self, what: str, sentence: Sentence, start: str) -> Query:
        """A control: a scan from this control state breaks this stronger sentence."""
        scans = self.begin(start)
        return self._broken(what, scans, self.premises(scans), sentence)

    def after_a_scan(self, always: Always) -> Sentence:
        """What is said of a state, as a sentence on the scan that leads there."""
        return lambda scan: (TRUE, always(scan, self.sees(scan)))

    def _broken(self, what: str, scans: Scans, given: Known, sentence: Sentence) -> Query:
        broken = z3.Not(scans.always(demanded(sentence)))
        return control(f"control: {what}, from {scans.control}", {**given, "broken": broken}, LOGIC)


def _leads_to(end: str) -> Property:
    return lambda scan: TRUE if scan.becomes(end) else FALSE


LONG: Final = 10**12
"""Elapsed time in ms, some thirty years: where the register has no greatest time there is none."""


def _ends(device: Device, scan: Scan, end: int) -> dict[str, z3.BoolRef]:
    """Each input, and each memory but records and the control state, at one end of its range: 0 or 1."""
    inputs = [(f"in.{one.python}", one, scan.inputs) for one in device.register.inputs.values()]
    own = [one for one in device.register.memory.values() if one.python in scan.state.__dataclass_fields__]
    plain = [one for one in own if one.python not in (device.control, *device.memory)]
    memory = [(f"before.{one.python}", one, scan.state) for one in plain]
    found = {"in.dt_ms": scan.inputs.dt_ms.term == (0, LONG)[end]}
    for name, signal, record in (*inputs, *memory):
        symbol = getattr(record, signal.python)
        for number, part in enumerate(symbol if isinstance(symbol, tuple) else (symbol,)):
            if not isinstance(part, Opaque):
                found[f"{name}.{number}"] = part.term == _range(signal)[end]
    return found


def _range(signal: Signal) -> tuple[Any, Any]:
    """The least and the greatest value of a signal of the register, for the solver."""
    if signal.type in ("bool", "modes"):
        return False, True
    if signal.type == "text":
        return 0, len(signal.values) - 1
    low, high = {"word": (0, WORD_MAX), "mode": (-1, MODES - 1)}.get(signal.type, (0, LONG))
    return (
        low if signal.minimum is None else signal.minimum,
        high if signal.maximum is None else signal.maximum,
    )


def exactly_one_path(device: Device) -> Queries:
    """For each control state: some path of `step` applies, no two do, and none raises.

    The control states are all that the interface register has, and both ends of each range of the register,
    and any time, are among the values that the paths were looked for with.
    """
    found = scans_from(device)
    states = [scan.control.value for scan in found]
    if sorted(states) != sorted(device.register.states):
        raise TheoremError(f"explored from {states}; the interface has {list(device.register.states)}")
    for scan in found:
        for path in scan.paths:
            if path.raised is not None:
                raise TheoremError(f"from {scan.control.value} step raises: {path.raised}")
        given = {"memory, inputs and parameters in their ranges": scan.premise}
        conditions = [path.condition for path in scan.paths]
        name = f"{scan.control.value}, {len(conditions)} paths"
        for number, end in enumerate(("least", "greatest")):
            ends = {f"{key}: {end}": formula for key, formula in _ends(device, scan, number).items()}
            yield control(f"{name}: every value at its {end}", {**given, **ends}, LOGIC)
        yield from claim(f"{name}: one applies", given, some_path(conditions), LOGIC)
        if len(conditions) > 1:
            yield from claim(f"{name}: no two apply", given, no_two_paths(conditions), LOGIC)

"""Which signal of the document each input and output of a program is.

Names are compared without regard to case; `_ms` may be left out, and a set of modes such as PERMITS_0 is an
ARRAY [0..4] OF BOOL, or a WORD whose bit i is mode i. A parameter that is no input of the program has one
value, its default or that of the binding. Texts such as AFTER_RESET are an INT or an enumeration that counts
them as interface.toml lists them; if there are two, a BOOL will do.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import z3

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers import Signal
from modeproof.registers.files import read_own_toml
from modeproof.registers.profiles import LETTER, PROFILES, value_in
from programs.equality import misfits
from programs.language.tree import BOOL, Array, Scalar, Source, Unit
from programs.semantics.reference import Reference
from programs.semantics.terms import Slot, slots
from programs.semantics.value_paths import steps, type_at, value_at, whole

DT = "dt_ms"
SCAN_TIME = Signal(name=DT, type="ms", clauses=(), why="", python=DT, tla="", minimum=0)
"""The time since the scan before, which a program may take as an input."""


@dataclass(frozen=True)
class Binding:
    """A program and the reference, with what the binding file says.

    names: a signal of the document to a name of the program. fixed: values of parameters (by their names in
    the document). left_out: outputs that are not compared. profile: whose values the other parameters have.
    """

    reference: Reference
    source: Source
    unit: Unit
    names: Mapping[str, str] = field(default_factory=dict)
    fixed: Mapping[str, Any] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    profile: str = LETTER

    def __post_init__(self) -> None:
        groups = ("inputs", "outputs", "parameters")
        known = [DT, *(name for group in groups for name in self.reference.signals(group))]
        for name in (*self.names, *self.fixed, *self.left_out):
            if name not in known:
                raise Unjudged(
                    f"binding: {self.reference.device.name} has no {name}; {suggestion(name, known)}"
                )
        for name in self.left_out:
            if name not in self.reference.signals("outputs"):
                raise Unjudged(f"binding: {name} is no output, so it cannot be left out")
            if name in self.names:
                raise Unjudged(f"binding: {name} is under [names] and under left_out")
        misfits.refuse(self.reference, self.unit, self.left_out, self._path)
        if not self.compared:
            raise Unjudged("binding: no output is compared")
        try:
            self.reference.start(self.reference.with_defaults(self.fixed_parameters()))
        except (ValueError, TypeError) as error:
            raise Unjudged(f"binding: {error}") from None
        unused = set(self._inputs) - set(self.bound_paths)
        if unused:
            name = sorted(unused)[0]
            signals = [*self.reference.signals("inputs"), *self.reference.signals("parameters")]
            raise self.unit.place.refuse(
                f"input {name} is no signal of {self.reference.device.name}; {suggestion(name, signals)}"
            )

    @cached_property
    def _inputs(self) -> dict[str, Slot]:
        return {slot.path: slot for slot in slots(self.source, self.unit) if slot.given}

    def _path(self, name: str, section: str) -> str | None:
        """The program's variable for a signal, in upper case; None: it has none."""
        known = [key for key, variable in self.unit.variables.items() if variable.section == section]
        if name in self.names:
            wanted = "".join(self.names[name].upper().split())
            if (steps(wanted) or [""])[0] not in known or type_at(self.unit, wanted) is None:
                raise self.unit.place.refuse(
                    f"the binding names {self.names[name]!r}, which is no {section}; "
                    + suggestion(wanted, known)
                )
            return wanted
        for loose in (False, True):
            words = {_plain_name(word, loose) for word in (name, re.sub(r"_ms$", "", name))}
            found = [key for key in known if _plain_name(key, loose) in words]
            if len(found) > 1:
                raise self.unit.place.refuse(f"{name} could be {' or '.join(found)}; bind it")
            if found:
                return found[0]
        return None

    @cached_property
    def _given(self) -> dict[str, tuple[str, Signal]]:
        """For each input path of the program the place of the reference's term, and the signal."""
        found: dict[str, tuple[str, Signal]] = {}
        taken: dict[str, str] = {}
        for group in ("inputs", "parameters"):
            for name, signal in self.reference.signals(group).items():
                path = self._path(name, "input")
                if path is None:
                    if group == "inputs":
                        raise self.unit.place.refuse(f"{self.unit.name} has no input {name}")
                    continue
                if path in taken:
                    raise self.unit.place.refuse(f"{taken[path]} and {name} are both bound to {path}")
                taken[path] = name
                kind = type_at(self.unit, path)
                if signal.type == "modes" and not (isinstance(kind, Scalar) and kind.kind == "bits"):
                    for number, element in enumerate(self._elements(name, path)):
                        found[element] = (f"{name}[{number}]", signal)
                else:
                    self._check(name, signal, kind)
                    found[path] = (name, signal)
        path = self._path(DT, "input")
        if path is not None:
            if path in taken:
                raise self.unit.place.refuse(f"{taken[path]} and {DT} are both bound to {path}")
            self._check(DT, SCAN_TIME, type_at(self.unit, path))
            found[path] = (DT, SCAN_TIME)
        return found

    def _elements(self, name: str, path: str) -> list[str]:
        """The paths of the five elements of a set of modes."""
        kind = type_at(self.unit, path)
        if not isinstance(kind, Array) or kind.high - kind.low != 4 or kind.element != BOOL:
            raise self.unit.variables[steps(path)[0]].place.refuse(f"{name} is an ARRAY [0..4] OF BOOL")
        return [f"{path}[{kind.low + number}]" for number in range(5)]

    def _check(self, name: str, signal: Signal, kind: object, inward: bool = True) -> None:
        """Refuse a variable that cannot hold the values of a signal, or is of another type."""
        fitting = {
            "bool": ("bool",),
            "word": ("bits",),
            "mode": ("int",),
            "int": ("int", "bits"),
            "ms": ("time", "int"),
            "text": ("int", "enum", "bool") if inward and len(signal.values) == 2 else ("int", "enum"),
            "modes": ("bits",) if inward else (),
        }.get(signal.type, ())
        if not isinstance(kind, Scalar) or kind.kind not in fitting:
            shown = kind.name if isinstance(kind, Scalar) else "no single value"
            advice = "" if fitting or inward else "; list it under left_out"
            raise self.unit.place.refuse(
                f"{name} is of type {signal.type}, and the program's is {shown}{advice}"
            )
        if kind.numbers or (kind.base is not None and inward):
            raise self.unit.place.refuse(f"{name}: {kind.name} has a range or numbers of its own")
        if kind.kind == "bits" and kind.width != 16:
            raise self.unit.place.refuse(f"{name} has 16 bits, and {kind.name} has {kind.width}")
        low, high = {"mode": (-1, 4), "text": (0, len(signal.values) - 1)}.get(signal.type, (0, 0))
        if inward and not kind.low <= low <= high <= kind.high:
            raise self.unit.place.refuse(f"{name} is {low}..{high}, and {kind.name} {kind.low}..{kind.high}")
        if kind.kind == "enum" and kind.high != high:
            raise self.unit.place.refuse(f"{name} has {high + 1} values, and {kind.name} has {kind.high + 1}")
        ours, own = [value.upper() for value in signal.values], [value.upper() for value in kind.names]
        if ours != own and sorted(ours) == sorted(own):
            raise self.unit.place.refuse(
                f"{name} counts {', '.join(signal.values)}, and {kind.name} otherwise"
            )

    @property
    def bound_paths(self) -> tuple[str, ...]:
        """The input paths of the program that the document gives."""
        return tuple(self._given)

    def term(self, path: str) -> Any:
        """What the document gives to an input of the program, as a term."""
        place, signal = self._given[path]
        terms = {**self.reference.input_terms, **self.reference.parameter_terms}
        slot = self._inputs[path]
        if place not in terms and signal.type == "modes":
            zero = z3.BitVecVal(0, slot.type.width)
            bits = [z3.If(terms[f"{place}[{mode}]"], zero + (1 << mode), zero) for mode in range(5)]
            return bits[0] | bits[1] | bits[2] | bits[3] | bits[4]
        term = terms[place]
        if slot.type.kind == "bool" and z3.is_int(term):
            return term == 1
        if slot.type.kind == "int" and z3.is_bv(term):
            return z3.BV2Int(term)
        if slot.type.kind == "bits" and z3.is_int(term):
            return z3.Int2BV(term, slot.type.width)
        return term

    @cached_property
    def words(self) -> dict[str, Any]:
        """The sets of modes that the program takes as words, by the names of the document."""
        known = {**self.reference.input_terms, **self.reference.parameter_terms}
        return {place: self.term(path) for path, (place, _) in self._given.items() if place not in known}

    @cached_property
    def free_parameters(self) -> tuple[str, ...]:
        """The parameters that the program takes as inputs, so that the verdict is for all their values."""
        places = {place.partition("[")[0] for place, _ in self._given.values()}
        return tuple(name for name in self.reference.signals("parameters") if name in places)

    @cached_property
    def steady(self) -> frozenset[str]:
        """The inputs of the program that are parameters: they keep their values as long as it runs."""
        known = self.reference.signals("parameters")
        return frozenset(path for path, (place, _) in self._given.items() if place.partition("[")[0] in known)

    @cached_property
    def values(self) -> dict[str, Any]:
        """The value of each other parameter. Raises Unjudged: it has no default and no value is given."""
        found = {}
        for name, signal in self.reference.signals("parameters").items():
            if name in self.free_parameters:
                if name in self.fixed:
                    raise Unjudged(
                        f"binding: {name} is an input of {self.unit.name}, so it has no single value"
                    )
                continue
            value = self.fixed.get(name, value_in(signal, self.profile))
            if value is None:
                raise Unjudged(f"binding: {name} has no default; give it a value under [parameters]")
            found[name] = value
        return found

    @property
    def chosen(self) -> dict[str, Any]:
        """The values that are given, and those of the profile that are not the default."""
        of = self.reference.signals("parameters")
        return {n: value for n, value in self.values.items() if n in self.fixed or value != of[n].default}

    @cached_property
    def conditions(self) -> tuple[z3.BoolRef, ...]:
        """The fixed parameters as formulas, and the ranges of the program's own types for its inputs."""
        found = self.fixing(self.values)
        for path, slot in self._inputs.items():
            term = self.term(path)
            if slot.type.kind in ("int", "time") and z3.is_int(term):
                found.append(z3.And(term >= slot.type.low, term <= slot.type.high))
        return tuple(found)

    def fixing(self, values: Mapping[str, Any]) -> list[z3.BoolRef]:
        """Parameters with these values, as formulas."""
        terms, found = self.reference.parameter_terms, []
        for name, value in values.items():
            signal = self.reference.signals("parameters")[name]
            if signal.type == "modes":
                found += [terms[f"{name}[{mode}]"] == (mode in value) for mode in range(5)]
            elif signal.type == "text":
                found.append(terms[name] == signal.values.index(value))
            elif z3.is_bool(terms[name]):
                found.append(terms[name] == bool(value))
            else:
                found.append(terms[name] == int(value))
        return found

    @cached_property
    def compared(self) -> tuple[str, ...]:
        """The outputs of the document that the program has and that are not left out."""
        found = []
        taken: dict[str, str] = {}
        for name in self.reference.signals("outputs"):
            if name in self.left_out:
                continue
            path = self._path(name, "output")
            if path is None:
                raise self.unit.place.refuse(
                    f"{self.unit.name} has no output {name}; bind it, or list it under left_out"
                )
            if path in taken:
                raise self.unit.place.refuse(f"{taken[path]} and {name} are both bound to {path}")
            taken[path] = name
            signal = self.reference.signals("outputs")[name]
            if signal.type == "modes":
                self._elements(name, path)
            else:
                self._check(name, signal, type_at(self.unit, path), inward=False)
            found.append(name)
        return tuple(found)

    @cached_property
    def unasked(self) -> tuple[str, ...]:
        """The outputs of the program that are none of the target, so that nothing is said of them."""
        asked = {self._path(name, "output") for name in self.compared}
        asked |= {name.upper() for name in self.left_out}
        return tuple(name for name in self.unit.of("output") if name.upper() not in asked)

    def outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """The program's outputs by the names of the document, in the sorts of the reference."""
        found: dict[str, Any] = {}
        for name in self.compared:
            path = self._path(name, "output")
            assert path is not None
            signal = self.reference.signals("outputs")[name]
            if signal.type == "modes":
                elements = enumerate(self._elements(name, path))
                found |= {f"{name}[{number}]": own[element] for number, element in elements}
                continue
            term = own[path]
            if signal.type == "word" and z3.is_expr(term) and z3.is_int(term):
                term = z3.Int2BV(term, 16)
            found[name] = term
        return found

    def plain_inputs(
        self, inputs: Mapping[str, Any], parameters: Mapping[str, Any], dt_ms: int
    ) -> dict[str, Any]:
        """Plain values for the interpreter, by the names of the program; texts as their numbers."""
        given = {**inputs, **parameters, DT: dt_ms}
        found: dict[str, Any] = {}
        for path, (place, signal) in self._given.items():
            name, _, index = place.partition("[")
            if index:
                found[path] = given[name][int(index.rstrip("]"))]
            elif signal.type == "modes":
                found[path] = sum(1 << mode for mode, there in enumerate(given[name]) if there)
            elif signal.type == "text":
                number = signal.values.index(given[name])
                found[path] = bool(number) if self._inputs[path].type.kind == "bool" else number
            else:
                found[path] = given[name]
        return whole(self.unit, found)

    @cached_property
    def _taken(self) -> dict[str, tuple[str, Signal]]:
        """For each output that is compared the program's variable, and the signal."""
        signals = self.reference.signals("outputs")
        return {name: (self._path(name, "output") or "", signals[name]) for name in self.compared}

    def variable_of(self, output: str) -> str:
        """The program's variable for an output that is compared, in upper case."""
        return self._taken[output][0]

    def plain_outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """The interpreter's outputs by the names of the document."""
        by_key = {name.upper(): value for name, value in own.items()}
        found = {}
        for name, (path, signal) in self._taken.items():
            value = value_at(self.unit, path, by_key)
            if signal.type == "modes":
                found[name] = tuple(value)
            elif signal.type == "text" and 0 <= value < len(signal.values):
                found[name] = signal.values[value]
            else:
                found[name] = value
        return found

    # ------------------------------------------------------------ parameters

    def fixed_parameters(self) -> dict[str, Any]:
        """The value of each parameter that the program does not take, as the code of the reference has it."""
        return {name: self.reference.in_code(name, value) for name, value in self.values.items()}

    def allows(self, parameters: Mapping[str, Any]) -> bool:
        """Whether the verdict is about these parameters."""
        if any(parameters[name] != value for name, value in self.fixed_parameters().items()):
            return False
        return all(
            slot.type.low <= parameters[self._given[path][0]] <= slot.type.high
            for path, slot in self._inputs.items()
            if type(parameters.get(self._given[path][0])) is int
        )

    @property
    def longest_scan(self) -> int | None:
        """The longest elapsed time that the program's own input for it can hold, in ms; None: no limit."""
        tops = [self._inputs[path].type.high for path, (name, _) in self._given.items() if name == DT]
        return tops[0] if tops else None

    def narrowed(self) -> list[str]:
        """The parameters whose range the program's own type makes smaller, in words."""
        found = []
        for path, slot in self._inputs.items():
            name, signal = self._given[path]
            if signal.type in ("ms", "int"):
                low, high = signal.minimum or 0, signal.maximum
                if high is None or not slot.type.low <= low <= high <= slot.type.high:
                    bottom, top = max(low, slot.type.low), min(high or slot.type.high, slot.type.high)
                    found.append(f"{name} {bottom}..{top}")
        return found


def _plain_name(name: str, loose: bool) -> str:
    return name.upper().replace("_", "") if loose else name.upper()


def read_assumed(path: Path) -> dict[str, Any]:
    """The table [assume] of the file of a binding; see `programs.demands.assumptions`. Raises Unjudged."""
    return dict(read_own_toml(path)[1].get("assume", {}))


def read_binding(path: Path) -> dict[str, Any]:
    """The arguments of a Binding that a TOML file gives. Raises Unjudged."""
    table = read_own_toml(path)[1]
    keys = {"names": dict, "parameters": dict, "left_out": list, "profile": str, "assume": dict}
    words: dict[type, str] = {dict: "table", list: "list of names", str: "text"}
    for key, value in table.items():
        if key not in keys:
            raise Unjudged(f"{path}: unknown key {key!r}; {suggestion(key, keys)}")
        if not isinstance(value, keys[key]):
            raise Unjudged(f"{path}: {key}: a {words[keys[key]]} is needed")
    names, left_out = table.get("names", {}), table.get("left_out", [])
    if not all(isinstance(value, str) for value in (*names.values(), *left_out)):
        raise Unjudged(f"{path}: [names] and left_out hold names in quotation marks")
    if (profile := table.get("profile", LETTER)) not in PROFILES:
        raise Unjudged(f"{path}: no profile {profile!r}; {suggestion(profile, PROFILES)}")
    fixed = table.get("parameters", {})
    return {"names": names, "fixed": fixed, "left_out": tuple(left_out), "profile": profile}

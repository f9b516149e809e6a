"""Which signal of the document each input and output of a program is.

Names are compared without regard to case; `_ms` may be left out, and a set of modes such as PERMITS_0 is an
ARRAY [0..4] OF BOOL. A parameter that is no input of the program has one value, its default or that of the
binding. Texts such as AFTER_RESET are an INT or an enumeration that counts them as interface.toml lists them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers import Signal
from programs.reference import Reference
from programs.symbolic import Slot, slots
from programs.tree import Array, Scalar, Source, Unit

DT = "dt_ms"


@dataclass(frozen=True)
class Binding:
    """A program and the reference, with what the binding file says.

    names: a signal of the document to a name of the program. fixed: values of parameters (by their names in
    the document). left_out: outputs that are not compared.
    """

    reference: Reference
    source: Source
    unit: Unit
    names: Mapping[str, str] = field(default_factory=dict)
    fixed: Mapping[str, Any] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        groups = ("inputs", "outputs", "parameters")
        known = [name for group in groups for name in self.reference.signals(group)]
        for name in (*self.names, *self.fixed, *self.left_out):
            if name not in known:
                raise Unjudged(f"binding: {self.reference.device.name} has no {name}; {suggestion(name, known)}")
        for name in self.left_out:
            if name not in self.reference.signals("outputs"):
                raise Unjudged(f"binding: {name} is no output, so it cannot be left out")
        if not self.compared:
            raise Unjudged("binding: no output is compared")
        unused = set(self._inputs) - set(self.bound_paths)
        if unused:
            name = sorted(unused)[0]
            signals = [*self.reference.signals("inputs"), *self.reference.signals("parameters")]
            raise self.unit.place.refuse(
                f"input {name} is no signal of {self.reference.device.name}; {suggestion(name, signals)}"
            )

    @cached_property
    def _inputs(self) -> dict[str, Slot]:
        return {
            slot.path: slot
            for slot in slots(self.source, self.unit)
            if slot.section == "input" and "." not in slot.path
        }

    def _path(self, name: str, section: str) -> str | None:
        """The program's variable for a signal, in upper case; None: it has none."""
        if name in self.names:
            wanted = [self.names[name]]
        else:
            wanted = [name, re.sub(r"_ms$", "", name), name.replace("_", "")]
        known = {key: variable for key, variable in self.unit.variables.items() if variable.section == section}
        for word in wanted:
            for key in known:
                if key == word.upper() or key.replace("_", "") == word.upper().replace("_", ""):
                    return key
        if name in self.names:
            raise self.unit.place.refuse(f"the binding names {self.names[name]!r}, which is no {section} of it")
        return None

    @cached_property
    def _given(self) -> dict[str, tuple[str, Signal]]:
        """For each input path of the program the place of the reference's term, and the signal."""
        found: dict[str, tuple[str, Signal]] = {}
        for group in ("inputs", "parameters"):
            for name, signal in self.reference.signals(group).items():
                path = self._path(name, "input")
                if path is None:
                    if group == "inputs":
                        raise self.unit.place.refuse(f"{self.unit.name} has no input {name}")
                    continue
                kind = self.unit.variables[path].type
                if signal.type == "modes":
                    if not isinstance(kind, Array) or kind.high - kind.low != 4:
                        raise self.unit.variables[path].place.refuse(f"{name} is an ARRAY [0..4] OF BOOL")
                    for number in range(5):
                        found[f"{path}[{kind.low + number}]"] = (f"{name}[{number}]", signal)
                else:
                    self._check(name, signal, kind)
                    found[path] = (name, signal)
        return found

    def _check(self, name: str, signal: Signal, kind: object) -> None:
        fitting = {
            "bool": ("bool",), "word": ("bits",), "mode": ("int",), "int": ("int", "bits"), "ms": ("time", "int"),
            "text": ("int", "enum"),
        }[signal.type]  # fmt: skip
        if not isinstance(kind, Scalar) or kind.kind not in fitting:
            shown = kind.name if isinstance(kind, Scalar) else "no single value"
            raise self.unit.place.refuse(f"{name} is of type {signal.type}, and the program's is {shown}")

    @property
    def bound_paths(self) -> tuple[str, ...]:
        """The input paths of the program that the document gives."""
        return tuple(self._given)

    def term(self, path: str) -> Any:
        """What the document gives to an input of the program, as a term."""
        place, _ = self._given[path]
        terms = {**self.reference.input_terms, **self.reference.parameter_terms}
        term, slot = terms[place], self._inputs[path]
        if slot.type.kind == "int" and z3.is_bv(term):
            return z3.BV2Int(term)
        if slot.type.kind == "bits" and z3.is_int(term):
            return z3.Int2BV(term, slot.type.width)
        return term

    @cached_property
    def free_parameters(self) -> tuple[str, ...]:
        """The parameters that the program takes as inputs, so that the verdict is for all their values."""
        places = {place.partition("[")[0] for place, _ in self._given.values()}
        return tuple(name for name in self.reference.signals("parameters") if name in places)

    @cached_property
    def values(self) -> dict[str, Any]:
        """The value of each other parameter. Raises Unjudged: it has no default and no value is given."""
        found = {}
        for name, signal in self.reference.signals("parameters").items():
            if name in self.free_parameters:
                if name in self.fixed:
                    raise Unjudged(f"binding: {name} is an input of {self.unit.name}, so it has no single value")
                continue
            value = self.fixed.get(name, signal.default)
            if value is None:
                raise Unjudged(f"binding: {name} has no default; give it a value under [parameters]")
            found[name] = value
        return found

    @cached_property
    def conditions(self) -> tuple[z3.BoolRef, ...]:
        """The fixed parameters as formulas, and the ranges of the program's own types for its inputs."""
        terms, found = self.reference.parameter_terms, []
        for name, value in self.values.items():
            signal = self.reference.signals("parameters")[name]
            if signal.type == "modes":
                found += [terms[f"{name}[{mode}]"] == (mode in value) for mode in range(5)]
            elif signal.type == "text":
                found.append(terms[name] == signal.values.index(value))
            elif z3.is_bool(terms[name]):
                found.append(terms[name] == bool(value))
            else:
                found.append(terms[name] == int(value))
        for path, slot in self._inputs.items():
            term = self.term(path)
            if slot.type.kind in ("int", "time") and z3.is_int(term) and self._given[path][0] in terms:
                found.append(z3.And(term >= slot.type.low, term <= slot.type.high))
        return tuple(found)

    @cached_property
    def compared(self) -> tuple[str, ...]:
        """The outputs of the document that the program has and that are not left out."""
        found = []
        for name in self.reference.signals("outputs"):
            if name in self.left_out:
                continue
            if self._path(name, "output") is None:
                raise self.unit.place.refuse(
                    f"{self.unit.name} has no output {name}; bind it, or list it under left_out"
                )
            found.append(name)
        return tuple(found)

    def outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """The program's outputs by the names of the document, in the sorts of the reference."""
        by_key = {name.upper(): term for name, term in own.items()}
        found = {}
        for name in self.compared:
            path = self._path(name, "output")
            assert path is not None
            term, signal = by_key[path], self.reference.signals("outputs")[name]
            if signal.type == "word" and z3.is_expr(term) and z3.is_int(term):
                term = z3.Int2BV(term, 16)
            found[name] = term
        return found

    def plain_inputs(self, inputs: Mapping[str, Any], parameters: Mapping[str, Any]) -> dict[str, Any]:
        """Plain values for the interpreter, by the names of the program; texts as their numbers."""
        given = {**inputs, **parameters}
        found: dict[str, Any] = {}
        for path, (place, signal) in self._given.items():
            name, _, index = place.partition("[")
            if index:
                key = path.partition("[")[0]
                array = found.setdefault(key, [False] * 5)
                array[int(index.rstrip("]"))] = int(index.rstrip("]")) in given[name]
            elif signal.type == "text":
                found[path] = signal.values.index(given[name])
            else:
                found[path] = given[name]
        return found

    def plain_outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """The interpreter's outputs by the names of the document."""
        by_key = {name.upper(): value for name, value in own.items()}
        found = {}
        for name in self.compared:
            value, signal = by_key[self._path(name, "output") or ""], self.reference.signals("outputs")[name]
            found[name] = signal.values[value] if signal.type == "text" else value
        return found

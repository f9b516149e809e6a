"""Which inputs of a device's graph a line of a log can stand for, and what its unobserved inputs can be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.graph.classes import InputClass
from modeproof.graph.device import DeviceGraph
from modeproof.registers.rows import Signal

MOST_KNOWN = 50_000
"""So many inputs are remembered with what they can be."""
_OTHER = object()
"""Stands for any value that no input of the graph names: they are all alike to it."""
_Values = tuple[tuple[str, Any], ...]


class Alphabet:
    """The inputs of one OPEN_ graph as a log meets them: exactly, or as a member of a class.

    `values` of a log are in Python form and may lack inputs.
    """

    def __init__(self, graph: DeviceGraph) -> None:
        self.graph = graph
        self._known: dict[tuple[_Values, int | None], tuple[int, ...]] = {}
        self._named = {
            name: frozenset(letter[name] for letter in graph.alphabet) for name in graph.device.inputs
        }

        self._told_apart = {
            name: named.union(
                member[name]
                for one in graph.classes
                if len(one.representative) > 1 and name in one.representative
                for member in one.members
            )
            for name, named in self._named.items()
        }

    def letters(self, values: Mapping[str, Any], dt_ms: int | None = None) -> tuple[int, ...]:
        """The inputs of the graph that `values` can be; with `dt_ms` only those with exactly this time."""
        key = (
            tuple(
                (name, values[name] if values[name] in self._told_apart[name] else _OTHER)
                for name in sorted(values)
            ),
            dt_ms,
        )
        if len(self._known) > MOST_KNOWN:
            self._known.clear()
        if key not in self._known:
            self._known[key] = tuple(
                n
                for n, letter in enumerate(self.graph.alphabet)
                if (dt_ms is None or letter["dt_ms"] == dt_ms) and self._stands_for(letter, values)
            )
        return self._known[key]

    def _stands_for(self, letter: Mapping[str, Any], values: Mapping[str, Any]) -> bool:
        odd = {name for name, value in values.items() if letter[name] != value}
        if not odd:
            return True
        for class_ in self.graph.classes:
            if not odd & class_.representative.keys() or not class_.representative.items() <= letter.items():
                continue
            if self._is_member(class_, values):
                odd -= class_.representative.keys()
        return not odd

    def _is_member(self, input_class: InputClass, values: Mapping[str, Any]) -> bool:
        seen = {name: values[name] for name in input_class.representative if name in values}
        if len(input_class.representative) == 1:
            ((name, value),) = seen.items()
            return type(value) is int and value not in self._named[name]
        return any(
            all(member[name] == value for name, value in seen.items()) for member in input_class.members
        )

    def nearest(self, values: Mapping[str, Any]) -> list[tuple[int, int]]:
        """All inputs of the graph with the number of signals in which they differ, the closest first."""
        found = []
        for n, letter in enumerate(self.graph.alphabet):
            odd = sum(letter[name] != value for name, value in values.items())
            found.append((0 if odd and self._stands_for(letter, values) else odd, n))
        return sorted(found)

    def completions(
        self, values: Mapping[str, Any], words: frozenset[int] | None = None
    ) -> list[Mapping[str, Any]]:
        """`values` with every input that was not observed put to each value that it can have.

        `words`: a device that only copies; its words are any of these.
        """
        inputs = self.graph.device.inputs
        missing = [name for name in inputs if name not in values]
        if not missing:
            return [values]
        if words is not None:
            return _product(values, {name: inputs[name] for name in missing}, words)
        found: dict[_Values, Mapping[str, Any]] = {}
        for n in self.letters(values):
            letter = self.graph.alphabet[n]
            whole = {name: values.get(name, letter[name]) for name in inputs}
            found[tuple(whole.items())] = whole
        return list(found.values())


def _product(
    values: Mapping[str, Any], missing: Mapping[str, Signal], words: frozenset[int]
) -> list[Mapping[str, Any]]:
    found: list[Mapping[str, Any]] = [values]
    for name in missing:
        found = [{**one, name: word} for one in found for word in sorted(words)]
    return found

"""A program that is a Python package in this process: NAME.<document>.<target>, as the reference is built.

The module has `power_up(Params) -> state` and `step(state, Inputs) -> (state, Outputs)`; words are numbers,
modes -1 for none, sets of modes tuples of booleans.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import sys
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, Protocol, TypeVar

from modeproof.kit.by_name import module_named
from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal
from modeproof.kit.vectors import EXACT, Case, Suite

REFERENCE = "refimpl"
"""The package of the reference implementations: beside ours, in a checkout and in the packed kit."""
_REMEMBERED = 20_000


class _Loaded(Protocol):
    code: Any


P = TypeVar("P", bound=_Loaded)


class Builtin:
    """A `Program`. Raises Unjudged where the package has no such module, or what it raises itself."""

    keeps_answers = True

    def __init__(self, package: str, suite: Suite) -> None:
        name = f"{package}.{suite.document}.{suite.target}"
        try:
            self.code = module_named(name)
            self._params, self._inputs = self.code.Params, self.code.Inputs
            self._power_up, self._step = self.code.power_up, self.code.step
        except Exception as error:  # whatever the package does when it is imported
            raise Unjudged(f"--builtin {package}: {error}") from None
        self._name, self._suite = package, suite
        self._state: Any = None
        self._taken = [(name, _taker(of)) for name, of in suite.inputs.items()]
        self._given = [(name, _giver(of)) for name, of in suite.outputs.items()]
        self._known: dict[tuple[Any, ...], Any] = {}
        self._rows: dict[Any, dict[str, Any]] = {}

    def hello(self, target: str) -> Mapping[str, Any]:
        """As of an adapter."""
        return {"ok": True, "name": self._name, "version": "", "relations": [EXACT]}

    def reset(self, params: Mapping[str, Any]) -> None:
        """Power-up."""
        kinds = self._suite.parameters
        values = {}
        for name, value in params.items():
            modes = kinds.get(name, {}).get("type") == "modes"
            values[name] = tuple(mode in value for mode in range(5)) if modes else value
        try:
            self._state = self._power_up(self._params(**values))
        except (TypeError, ValueError) as error:
            raise Unjudged(f"reset was refused: {error}") from None

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """One call of `step`."""
        key = (dt_ms, *inputs.values())
        given = self._known.get(key)
        try:
            if given is None:
                given = self._inputs(dt_ms, **{name: take(inputs[name]) for name, take in self._taken})
                if len(self._known) < _REMEMBERED:
                    self._known[key] = given
            self._state, out = self._step(self._state, given)
        except (TypeError, ValueError, AttributeError) as error:
            raise Unjudged(f"refused: {error}") from None
        row = self._rows.get(out)
        if row is None:
            row = {
                name: give(getattr(out, name))
                for name, give in self._given
                if not self._suite.outputs[name].project or hasattr(out, name)
            }
            if len(self._rows) < _REMEMBERED:
                self._rows[out] = row
        return row

    def at_rest(self, inputs: Mapping[str, Any]) -> bool:
        """Whether a scan with these inputs and no time would leave everything as it is."""
        state = self._state
        try:
            self.scan(0, inputs)
            return bool(self._state == state)
        finally:
            self._state = state

    def pieces(self, dt_ms: int, inputs: Mapping[str, Any]) -> tuple[int, ...]:
        """The time of a scan in pieces: where time alone makes something happen, a piece ends a millisecond
        before it does, and one when it does.
        """
        state = self._state

        def after(ms: int) -> tuple[Any, ...]:
            self._state = state
            out = self.scan(ms, inputs)
            names = (field.name for field in fields(self._state) if not field.name.endswith("_ms"))
            return out, *(getattr(self._state, name) for name in names)

        try:
            same, other = 0, dt_ms
            at_once = after(0)
            if after(dt_ms) == at_once:
                return (dt_ms,)
            while other - same > 1:
                middle = (same + other) // 2
                same, other = (middle, other) if after(middle) == at_once else (same, middle)
            return tuple(ms for ms in (same, 1, dt_ms - other) if ms)
        finally:
            self._state = state

    def close(self) -> None:
        """Nothing is held."""


def reference(suite: Suite) -> Callable[[Case], bool] | None:
    """What says whether the reference implementation gives all outputs that a case expects.

    None where there is no reference implementation of the target.
    """
    try:
        program = own_reference(suite)
    except Unjudged:
        return None

    def gives(case: Case) -> bool:
        try:
            program.reset(case.params)
            for scan in case.scans:
                if scan.request is None:
                    out = program.scan(scan.dt_ms, scan.inputs)
                    if any(value != scan.outputs[name] for name, value in out.items()):
                        return False
        except Unjudged:
            return False
        return True

    return gives


def package_files(package: str | None) -> dict[str, str]:
    """Hashes of the files of a package, by name; nothing where it is none or cannot be found."""
    with contextlib.suppress(ImportError, ValueError, AttributeError):
        spec = importlib.util.find_spec(package) if package else None
        folders = spec.submodule_search_locations if spec is not None else None
        return {
            str(path): hashlib.sha256(path.read_bytes()).hexdigest()
            for folder in folders or ()
            for path in sorted(Path(folder).rglob("*.py"))
        }
    return {}


def own_reference(suite: Suite) -> Builtin:
    """The reference implementation of a target. Raises Unjudged where there is none beside the kit."""
    return beside_kit(lambda: Builtin(REFERENCE, suite))


def beside_kit(start: Callable[[], P]) -> P:
    """A program of the package beside the kit. Raises Unjudged where it comes from elsewhere."""
    beside = str(Path(__file__).parents[2])
    if beside not in sys.path:
        sys.path.append(beside)
    program = start()
    if not str(getattr(program.code, "__file__", "")).startswith(beside):
        raise Unjudged(f"the package {REFERENCE} beside the kit was expected, not {program.code.__file__}")
    return program


def _taker(of: Signal) -> Callable[[Any], Any]:
    if of.type == "word":
        return lambda value: int(value, 16)
    if of.type == "mode":
        return lambda value: -1 if value is None else value
    if of.type == "modes":
        return lambda value: tuple(mode in value for mode in of.modes)
    if of.type == "text":
        return lambda value: value or ""
    return lambda value: value


def _giver(of: Signal) -> Callable[[Any], Any]:
    if of.type == "word":
        return lambda value: f"{value:04X}"
    if of.type == "mode":
        return lambda value: None if value == -1 else value
    if of.type == "modes":
        return lambda value: [mode for mode, there in zip(of.modes, value, strict=True) if there]
    if of.type == "text" and "" in of.values:
        return lambda value: value or None
    return lambda value: value

"""A copy of a whole package of code in which one definition has other text.

The copy lives in module objects of its own, which are in no table of modules: each function of the package is
made anew with the names of its copied module, so that a call anywhere in the copy reaches the copy, and
nothing reaches back. Classes are shared, so that records and control states of both can be compared. The
files of the package are not touched.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import CodeType, FunctionType, ModuleType
from typing import Any

from proofs.explorer.device import Device


class CopyError(Exception):
    """The text cannot be taken: it does not compile, or lacks the definition."""


@dataclass(frozen=True)
class Change:
    """Other text for a module: `text` is the whole of it, `definition` the function or constant that differs.

    lines: the first and the last line of what differs, as the lines are in the shipped text; None for a
    constant, which any function may read.
    """

    module: str
    definition: str
    text: str
    lines: tuple[int, int] | None


@dataclass(frozen=True)
class Copy:
    """The modules of a copy by their names."""

    modules: Mapping[str, ModuleType]

    def of(self, device: Device) -> Device:
        """The device with the copied code, its stand-ins put into the copy."""
        stand_ins = tuple(
            replace(stand_in, module=self.modules.get(stand_in.module.__name__, stand_in.module))
            for stand_in in device.stand_ins
        )
        return replace(device, module=self.modules[device.module.__name__], stand_ins=stand_ins)


def copied(package: str, change: Change | None = None) -> Copy:
    """A copy of every loaded module of the package, and of a changed one beside it, with the change made.

    Raises CopyError.
    """
    changed = None if change is None else change.module
    shipped = {
        name: module
        for name, module in sys.modules.items()
        if name in (package, changed) or name.startswith(f"{package}.")
    }
    copies = {name: ModuleType(name, module.__doc__) for name, module in shipped.items()}
    if change is not None and change.module not in shipped:
        raise CopyError(f"{change.module} is not loaded")
    code = None if change is None else _code(change)
    functions: dict[int, FunctionType] = {}

    def function(function_type: FunctionType) -> FunctionType:
        if id(function_type) not in functions:
            own = (
                change is not None
                and function_type.__module__ == change.module
                and function_type.__name__ == change.definition
            )
            made = FunctionType(
                code if own and code is not None else function_type.__code__,
                vars(copies[function_type.__module__]),
                function_type.__name__,
                function_type.__defaults__,
                function_type.__closure__,
            )
            made.__kwdefaults__, made.__module__ = function_type.__kwdefaults__, function_type.__module__
            made.__qualname__ = function_type.__qualname__
            functions[id(function_type)] = made
        return functions[id(function_type)]

    for name, module in shipped.items():
        for key, value in vars(module).items():
            if isinstance(value, FunctionType) and value.__module__ in copies:
                value = function(value)
            elif isinstance(value, ModuleType) and value.__name__ in copies:
                value = copies[value.__name__]
            vars(copies[name])[key] = value
    if change is not None and code is None:
        _rebind(shipped, copies, change)
    return Copy(copies)


def _code(change: Change) -> CodeType | None:
    """The compiled function that differs; None for a constant."""
    try:
        whole = compile(change.text, f"<changed {change.module}>", "exec", dont_inherit=True)
    except (SyntaxError, ValueError) as error:
        raise CopyError(f"{change.module}: {error}") from None
    found = [
        co_const
        for co_const in whole.co_consts
        if isinstance(co_const, CodeType)
        and co_const.co_name == change.definition
        and not co_const.co_name.startswith("<")
    ]
    return found[-1] if found else None


def _rebind(shipped: Mapping[str, ModuleType], copies: Mapping[str, ModuleType], change: Change) -> None:
    """A constant that differs, in its module and wherever it was imported from there."""
    names: dict[str, Any] = dict(vars(shipped[change.module]))
    try:
        exec(compile(change.text, f"<changed {change.module}>", "exec", dont_inherit=True), names)
    except Exception as error:  # whatever the changed text does when it is run
        raise CopyError(f"{change.module}: {type(error).__name__}: {error}") from None
    before = vars(shipped[change.module]).get(change.definition)
    if change.definition not in names or before is None:
        raise CopyError(f"{change.module} does not define {change.definition}")
    for name, module in shipped.items():
        if vars(module).get(change.definition) is before:
            vars(copies[name])[change.definition] = names[change.definition]

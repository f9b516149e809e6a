"""One name everywhere: interface.toml against the specification and against the reference implementation."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from modeproof.registers.citations import Sources
from modeproof.registers.python_source import PythonModule
from modeproof.registers.rows import Device, Document, Problem, Signal
from modeproof.registers.tla import Module, closure

ANNOTATIONS = {"word": "int", "int": "int", "ms": "int", "mode": "int", "bool": "bool"}
"""The Python type of each declared type that has only one."""


def check_names(document: Document, sources: Sources) -> list[Problem]:
    """Every name of the interface that is missing, or extra, in the specification or the implementation."""
    problems: list[Problem] = []
    for device in document.interface.devices.values():
        problems += _in_spec(document, device, sources)
        module = next((source for source in sources.refimpl if source.name == device.id), None)
        if module is None:
            problems.append(Problem(f"refimpl/{document.name}/{device.id}.py", "", "not found"))
        else:
            problems += _in_python(device, module)
    return problems


def _in_spec(document: Document, device: Device, sources: Sources) -> Iterator[Problem]:
    modules = closure(sources.modules, device.module)
    own = next((module for module in modules if module.name == device.module), None)
    if own is None:
        yield Problem(f"spec/{document.name}/{device.module}.tla", "", f"not found; {device.id} declares it")
        return
    defined = frozenset().union(*(module.defined for module in modules))
    strings = frozenset().union(*(module.strings for module in modules))
    for step in device.steps:
        if step not in defined:
            yield Problem(own.file, step, "declared as a step, but not defined")
    for state in device.states:
        if state not in strings:
            yield Problem(own.file, state, "declared as a state, but the string does not occur")
    variables = frozenset().union(*(module.variables for module in modules))
    for signal in device.memory.values():
        allowed = (signal.tla, device.id + signal.tla[:1].upper() + signal.tla[1:])
        if signal.tla and not variables.intersection(allowed):
            yield Problem(
                own.file, signal.name, f"declared as memory, but no VARIABLE {' or '.join(allowed)}"
            )
    constants = frozenset().union(*(module.constants for module in modules))
    for signal in device.parameters.values():
        name = _constant(signal)
        if name and name not in constants:
            yield Problem(own.file, name, f"declared as the parameter {signal.name}, but not a CONSTANT")
    users = [module for module in sources.modules.values() if _uses(module, device.module, sources)]
    words = frozenset().union(*(module.words | module.strings for module in (*modules, *users)))
    passed = {output for run in document.runs if run.graph is not None for output in run.graph.passed}
    for signal in (*device.inputs.values(), *device.outputs.values()):
        if signal.tla and signal.tla not in words and signal.name not in passed:
            text = "declared as an input or output, but nothing in the specification has that name"
            yield Problem(own.file, signal.tla, text)


def _constant(signal: Signal) -> str:
    """The CONSTANT of a parameter: time in ticks, so without the unit; upper case as constants are."""
    if signal.tla != signal.name or not signal.tla:
        return signal.tla
    return signal.name.removesuffix("_ms").upper()


def _uses(module: Module, name: str, sources: Sources) -> bool:
    return name in {extended.name for extended in closure(sources.modules, module.name)}


def _in_python(device: Device, module: PythonModule) -> Iterator[Problem]:
    classes = {node.name: node for node in module.tree.body if isinstance(node, ast.ClassDef)}
    yield from _states(device, module, classes)
    expected: dict[str, dict[str, str]] = {
        "Params": _fields(device.parameters),
        "State": {"params": "Params", **_fields(device.memory)},
        "Inputs": {"dt_ms": "int", **_fields(device.inputs)},
        "Outputs": _fields(device.outputs),
    }
    for label, fields in expected.items():
        node = classes.get(label)
        if node is None:
            yield Problem(module.file, label, "the class is missing")
            continue
        found = {
            statement.target.id: ast.unparse(statement.annotation)
            for statement in node.body
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
        }
        for name in fields.keys() - found.keys():
            yield Problem(module.file, f"{label}.{name}", "declared in interface.toml, but no field here")
        for name in found.keys() - fields.keys():
            yield Problem(module.file, f"{label}.{name}", "a field here, but not declared in interface.toml")
        for name in fields.keys() & found.keys():
            if fields[name] and fields[name] != found[name]:
                yield Problem(module.file, f"{label}.{name}", f"must be {fields[name]}, not {found[name]}")
    functions = {node.name for node in module.tree.body if isinstance(node, ast.FunctionDef)}
    for name in ("power_up", "step"):
        if name not in functions:
            yield Problem(module.file, name, "the function is missing")


def _fields(signals: Mapping[str, Signal]) -> dict[str, str]:
    """The fields of a dataclass with their annotation, empty where more than one is right.

    An integer without a range is a number that stands for something; the implementation may hold the thing.
    """
    fields = {}
    for signal in signals.values():
        stands_for = signal.type == "int" and signal.maximum is None
        fields[signal.python] = "" if stands_for else ANNOTATIONS.get(signal.type, "")
    return fields


def _states(device: Device, module: PythonModule, classes: Mapping[str, ast.ClassDef]) -> Iterator[Problem]:
    """The enumeration that shares a value with the declared states must have exactly their values."""
    declared = set(device.states)
    for node in classes.values():
        if not any(isinstance(base, ast.Name) and base.id.endswith("Enum") for base in node.bases):
            continue
        values = {
            statement.value.value
            for statement in node.body
            if isinstance(statement, ast.Assign)
            and isinstance(statement.value, ast.Constant)
            and isinstance(statement.value.value, str)
        }
        if values & declared:
            for value in sorted(declared - values):
                yield Problem(module.file, node.name, f"the state {value!r} is declared, but no value here")
            for value in sorted(values - declared):
                yield Problem(module.file, node.name, f"the value {value!r} is not a declared state")
            return
    yield Problem(module.file, "", "no enumeration holds the declared states")

"""What the register says of a device and its check of names does not compare: defaults, marks of steps."""

from __future__ import annotations

import re
from dataclasses import MISSING, fields
from importlib import import_module

import pytest

from modeproof.ground.places import documents, root
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device, Signal

DEVICES = [
    (document, device)
    for document in documents(root())
    for device in load_interface(root(), document).devices.values()
]
MARKED = [device.id for document, device in DEVICES if document == "mode_selection"]


def declared(signal: Signal) -> object:
    """A default as the code holds it."""
    if signal.type == "modes" and isinstance(signal.default, list):
        return tuple(mode in signal.default for mode in range(5))
    return signal.default


@pytest.mark.parametrize(("document", "device"), DEVICES, ids=[device.id for _, device in DEVICES])
def test_defaults_are_those_of_the_register(document: str, device: Device) -> None:
    params = import_module(f"refimpl.{document}.{device.id}").Params
    found = {field.name: field.default for field in fields(params) if field.default is not MISSING}
    known = device.parameters.items()
    assert found == {name: declared(signal) for name, signal in known if signal.default is not None}


@pytest.mark.parametrize("name", MARKED)
def test_every_step_of_the_register_is_named_in_the_code(name: str) -> None:
    source = (root() / f"refimpl/mode_selection/{name}.py").read_text(encoding="utf-8")
    (steps,) = [device.steps for _, device in DEVICES if device.id == name]
    assert steps and [step for step in steps if not re.search(rf"# {step}\b", source)] == []

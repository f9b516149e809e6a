"""An implementation that runs in this process: a module with Params, Inputs, Outputs, power_up and step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from modeproof.graph.values import ValueForms
from modeproof.ground.errors import Unjudged
from modeproof.kit.by_name import module_named
from modeproof.registers.rows import Device

Step = Callable[[Any, Any], tuple[Any, Any]]
REFERENCE = "refimpl"
"""The package of our own implementation of each document."""


@dataclass(frozen=True)
class Implementation:
    """Build `params` and `inputs` from named values, then `power_up(params)` and `step(state, inputs)`."""

    name: str
    params: Callable[..., Any]
    inputs: Callable[..., Any]
    outputs: Callable[..., Any]
    power_up: Callable[[Any], Any]
    step: Step

    def start(self, device: Device, forms: ValueForms, params: Mapping[str, Any]) -> Any:
        """The state after power-up with wire parameters. Raises Unjudged for parameters that do not fit."""
        values = {}
        for name, value in params.items():
            if name not in device.parameters:
                raise Unjudged(f"{self.name}: {device.id} has no parameter {name!r}")
            values[device.parameters[name].python] = forms.from_wire(
                device.parameters[name], value, f"{self.name}: parameter"
            )
        try:
            return self.power_up(self.params(**values))
        except Exception as error:
            raise Unjudged(f"{self.name}: power-up refused: {type(error).__name__}: {error}") from None


def load_implementation(package: str, document: str, device: str) -> Implementation:
    """The module `<package>.<document>.<device>`. Raises Unjudged when it cannot be used."""
    name = f"{package}.{document}.{device}"
    try:
        module = module_named(name)
    except ImportError as error:
        raise Unjudged(f"{name} cannot be imported: {error}") from None
    return from_module(module, name)


def from_module(module: Any, name: str) -> Implementation:
    """Take the five names out of a module or any other object that has them."""
    for wanted in ("Params", "Inputs", "Outputs", "power_up", "step"):
        if not callable(getattr(module, wanted, None)):
            raise Unjudged(f"{name}: {wanted} is missing")
    return Implementation(
        name=name,
        params=module.Params,
        inputs=module.Inputs,
        outputs=module.Outputs,
        power_up=module.power_up,
        step=module.step,
    )

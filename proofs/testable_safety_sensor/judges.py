"""Which theorems judge the mutants of the block, in the order in which they are asked; invariants last."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType, ModuleType
from typing import Final

from proofs.testable_safety_sensor import (
    rows,
    sensor_errors,
    sensor_response,
    sensor_safety,
    sensor_test,
)
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.theorem import Theorem


def _theorems(*modules: ModuleType) -> tuple[Theorem, ...]:
    found = [
        var
        for module in modules
        for var in vars(module).values()
        if isinstance(var, Theorem) and var.build.__module__ == module.__name__
    ]
    return tuple(sorted(found, key=lambda scan: "invariant" in scan.name))


JUDGES: Final[Mapping[str, tuple[Theorem, ...]]] = MappingProxyType(
    {SENSOR.name: _theorems(rows, sensor_safety, sensor_test, sensor_errors, sensor_response)}
)

"""Which theorems judge the mutants of the block, in the order in which they are asked."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType, ModuleType
from typing import Final

from proofs.enable_switch import switch_answers, switch_outputs, switch_safety
from proofs.enable_switch.devices import SWITCH
from proofs.theorem import Theorem


def _theorems(*modules: ModuleType) -> tuple[Theorem, ...]:
    """The theorems of these modules in the order of the text, the invariant last."""
    found = [var for module in modules for var in vars(module).values() if isinstance(var, Theorem)]
    found.sort(key=lambda scan: "invariant" in scan.name)
    return tuple(found)


JUDGES: Final[Mapping[str, tuple[Theorem, ...]]] = MappingProxyType(
    {SWITCH.name: _theorems(switch_answers, switch_safety, switch_outputs)}
)

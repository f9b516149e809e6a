"""Which theorems judge the mutants of the block, in the order in which they are asked: the invariant last."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from proofs.edm import block_resets, block_response, block_safety, invariant, rows
from proofs.edm.devices import BLOCK
from proofs.theorem import Theorem

_MODULES: Final = (rows, block_safety, block_resets, block_response, invariant)

JUDGES: Final[Mapping[str, tuple[Theorem, ...]]] = MappingProxyType(
    {
        BLOCK.name: tuple(
            var
            for module in _MODULES
            for var in vars(module).values()
            if isinstance(var, Theorem) and var.build.__module__ == module.__name__
        )
    }
)

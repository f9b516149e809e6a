"""Which theorems judge the mutants of the block, in the order in which they are asked: all but the
invariant's first.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from proofs.guard_locking import (
    block_locks,
    block_losses,
    block_memory,
    block_response,
    block_safety,
    invariant,
)
from proofs.guard_locking.devices import BLOCK
from proofs.theorem import Theorem

_MODULES: Final = (block_safety, block_losses, block_locks, block_memory, block_response, invariant)

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

"""The way to the room `proofs`: its modules are imported when they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from modeproof.ground.errors import Unjudged


def code_under_proof() -> Any:
    """What says of a document's code which of it is to be changed, and judges changed copies of it.

    Raises Unjudged when the proofs cannot be imported.
    """
    return proofs_module("proofs.mutants.bench")


def copies_of_code() -> Any:
    """What makes a copy of a package of code with one definition changed. Raises Unjudged."""
    return proofs_module("proofs.mutants.copies")


def observer_of_code() -> Any:
    """What proves that nobody can tell a changed copy by inputs and outputs. Raises Unjudged."""
    return proofs_module("proofs.mutants.observed")


def proofs_module(name: str) -> Any:
    """A module of the room `proofs`. Raises Unjudged when it, or a solver, cannot be imported."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Unjudged(f"proofs cannot be run: {error}") from None

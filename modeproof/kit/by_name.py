"""The one place that imports a module by a name which a file or a user gives: a document's, a package's."""

from __future__ import annotations

import importlib
from typing import Any


def module_named(name: str) -> Any:
    """The module of this dotted name. Raises what importing it raises."""
    return importlib.import_module(name)

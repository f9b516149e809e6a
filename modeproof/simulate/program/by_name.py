"""The one place in the page that imports a module by a name which its facts give; it has no `importlib`."""

from __future__ import annotations

from typing import Any


def module_named(name: str) -> Any:
    """The module of this dotted name. Raises what importing it raises."""
    return __import__(name, fromlist=["step"])

"""Takes from the tool what Python on Windows does not have, and adds `msvcrt`, which it has.

Python imports this module before all others. Modules of POSIX cannot be imported by anybody: libraries are
made for that. Attributes of `os`, `signal` and `select`, and the name of the system, are hidden from files
below the folders in NO_POSIX_BELOW alone: Python's own library takes the way of the system that it is on.
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess  # noqa: F401  before msvcrt is there, by which it tells where it is
import sys
from collections.abc import Iterable
from fcntl import LOCK_EX, LOCK_NB, lockf
from types import ModuleType
from typing import Any

from not_on_windows import ATTRIBUTES, MODULES

TOOL = tuple(os.environ["NO_POSIX_BELOW"].split(os.pathsep))


def hide(module: Any, names: Iterable[str], **instead: str) -> None:
    """Hide these attributes of a module from the tool; all others still find them."""
    kept = {name: vars(module).pop(name) for name in names if name in vars(module)}

    def __getattr__(name: str) -> Any:
        of_the_tool = sys._getframe(1).f_code.co_filename.startswith(TOOL)
        found = instead if of_the_tool else kept
        if name not in found:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        return found[name]

    module.__getattr__ = __getattr__


msvcrt = ModuleType("msvcrt")
vars(msvcrt).update(LK_NBLCK=2, locking=lambda handle, mode, count: lockf(handle, LOCK_EX | LOCK_NB, count))
sys.modules["msvcrt"] = msvcrt
for name in set(MODULES) - {"posix"}:  # of which Python's own library is made
    sys.modules[name] = None  # type: ignore[assignment]
for name, attributes in ATTRIBUTES.items():
    hide(__import__(name), attributes)
hide(sys, ["platform"], platform="win32")
multiprocessing.set_start_method("spawn")
multiprocessing.context._concrete_contexts = {"spawn": multiprocessing.get_context("spawn")}  # type: ignore[attr-defined]

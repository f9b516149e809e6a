"""The way to the room `proofs`: its modules are imported when they are needed."""

from __future__ import annotations

import functools
import importlib
import os
import signal
import sys
import threading
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
        module = importlib.import_module(name)
        if "z3" in sys.modules:
            _hear_interrupts(sys.modules["z3"])
        return module
    except ImportError as error:
        raise Unjudged(f"proofs cannot be run: {error}") from None


@functools.cache
def _hear_interrupts(z3: Any) -> None:
    """Let Ctrl-C reach Python, and end the query at which z3 works.

    Else z3 takes it for itself: it answers `unknown`, and all goes on. Python acts on a signal only when z3
    has returned, but tells a pipe at once.
    """
    z3.set_param("ctrl_c", False)
    if threading.current_thread() is not threading.main_thread():
        return
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    # A copy of this process would write into the same pipe, and what ends the copy would end our query
    os.register_at_fork(after_in_child=lambda: signal.set_wakeup_fd(-1))

    ends = {getattr(signal, name, signal.SIGINT) for name in ("SIGINT", "SIGTERM", "SIGHUP")}

    def listen() -> None:
        while heard := os.read(read, 64):
            if ends & set(heard):  # not a timer, or the end of a child
                z3.main_ctx().interrupt()

    threading.Thread(target=listen, daemon=True).start()

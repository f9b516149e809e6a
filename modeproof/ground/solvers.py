"""Importing what needs a solver: a clear line when there is none, and Ctrl-C that reaches Python."""

from __future__ import annotations

import contextlib
import functools
import os
import signal
import socket
import sys
import threading
from collections.abc import Iterator
from typing import Any

from modeproof.ground.errors import Unjudged


@contextlib.contextmanager
def needing_solvers() -> Iterator[None]:
    """Around imports of what cannot run without a solver. Raises Unjudged when one of them is missing."""
    try:
        yield
    except ImportError as error:
        raise Unjudged(f"proofs cannot be run: {error}") from None
    if "z3" in sys.modules:
        _hear_interrupts(sys.modules["z3"])


@functools.cache
def _hear_interrupts(z3: Any) -> None:
    """Let Ctrl-C reach Python, and end the query at which z3 works.

    Else z3 takes it for itself: it answers `unknown`, and all goes on. Python acts on a signal only when z3
    has returned, but tells a socket at once.
    """
    z3.set_param("ctrl_c", False)
    if threading.current_thread() is not threading.main_thread():
        return
    heard_at, told_at = socket.socketpair()  # no pipe: on Windows a pipe cannot be told not to wait
    told_at.setblocking(False)
    signal.set_wakeup_fd(told_at.fileno(), warn_on_full_buffer=False)
    if hasattr(os, "register_at_fork"):
        # A copy of this process would write to the same place, and what ends the copy would end our query
        os.register_at_fork(after_in_child=lambda: signal.set_wakeup_fd(-1))

    ends = {getattr(signal, name, signal.SIGINT) for name in ("SIGINT", "SIGTERM", "SIGHUP")}

    def listen() -> None:
        _ = told_at  # open for as long as somebody listens
        while heard := heard_at.recv(64):
            if ends & set(heard):  # not a timer, or the end of a child
                z3.main_ctx().interrupt()

    threading.Thread(target=listen, daemon=True).start()

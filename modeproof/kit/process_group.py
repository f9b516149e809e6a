"""A process and all that it starts, on any system: how it is set apart, and how all of it is ended."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from typing import Any

WINDOWS = sys.platform == "win32"
APART: dict[str, Any] = {} if WINDOWS else {"start_new_session": True}
"""Options of subprocess.Popen for a process that `end_all` can end."""


def end_all(pid: int) -> None:
    """Kill a process that was started with `APART`, with what it started; not an error when it has ended."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":
            subprocess.run(["taskkill", "/T", "/F", "/PID", str(pid)], capture_output=True, check=False)
        else:
            os.killpg(pid, signal.SIGKILL)

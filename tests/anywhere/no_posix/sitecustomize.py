"""Takes from the tool what Python on Windows does not have, and adds `msvcrt`, which it has.

Python imports this module before all others.

Modules of POSIX cannot be imported by anybody: libraries are made for that. Attributes of `os`, `signal`,
`select` and `sys` are hidden from files below the folders in NO_POSIX_BELOW alone: Python's own library takes
the way of the system that it is on, and that is this one.
"""

from __future__ import annotations

import multiprocessing
import os
import select
import signal
import subprocess  # noqa: F401  before msvcrt is there, by which it tells where it is
import sys
from fcntl import LOCK_EX, LOCK_NB, lockf
from types import ModuleType
from typing import Any

MODULES = ("fcntl", "termios", "tty", "pty", "resource", "pwd", "grp", "syslog", "readline", "curses")
HIDDEN = {
    os: (
        *("fork", "forkpty", "register_at_fork", "killpg", "setsid", "setpgid", "getpgid", "setpgrp", "wait"),
        *("wait3", "wait4", "waitid", "WNOHANG", "WIFEXITED", "WIFSIGNALED", "WEXITSTATUS", "WTERMSIG"),
        *("mkfifo", "openpty", "posix_spawn", "getuid", "geteuid", "getgid", "getegid", "chown", "fchown"),
        *("nice", "uname", "sysconf", "set_blocking", "pread", "pwrite", "sched_getaffinity", "statvfs"),
        *("getloadavg", "O_NONBLOCK", "O_DIRECTORY", "O_NOFOLLOW", "fchmod", "getpriority", "ctermid"),
    ),
    signal: (
        *("SIGKILL", "SIGALRM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGCHLD", "SIGQUIT", "SIGPIPE", "SIGSTOP"),
        *("SIGCONT", "SIGTSTP", "alarm", "setitimer", "getitimer", "ITIMER_REAL", "pause", "pthread_kill"),
        *("pthread_sigmask", "sigwait", "sigtimedwait", "siginterrupt"),
    ),
    select: ("poll", "epoll", "POLLIN", "POLLHUP"),
    sys: ("platform",),
}
INSTEAD = {"platform": "win32"}


def hide(module: Any, names: tuple[str, ...]) -> None:
    """Hide these attributes of a module from the tool; all others still find them."""
    kept = {name: vars(module).pop(name) for name in names if name in vars(module)}

    def __getattr__(name: str) -> Any:
        asking = sys._getframe(1).f_code.co_filename
        of_the_tool = asking.startswith(tuple(os.environ["NO_POSIX_BELOW"].split(os.pathsep)))
        if of_the_tool and name in INSTEAD:
            return INSTEAD[name]
        if of_the_tool or name not in kept:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        return kept[name]

    module.__getattr__ = __getattr__


msvcrt = ModuleType("msvcrt")
vars(msvcrt).update(LK_NBLCK=2, locking=lambda handle, mode, count: lockf(handle, LOCK_EX | LOCK_NB, count))
sys.modules["msvcrt"] = msvcrt
for name in MODULES:
    sys.modules[name] = None  # type: ignore[assignment]
multiprocessing.set_start_method("spawn")
multiprocessing.context._concrete_contexts = {"spawn": multiprocessing.get_context("spawn")}  # type: ignore[attr-defined]
for module, names in HIDDEN.items():
    hide(module, names)

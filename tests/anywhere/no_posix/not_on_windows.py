"""What Python has on POSIX and not on Windows, as far as somebody could think of using it."""

MODULES = (
    "fcntl",
    "termios",
    "tty",
    "pty",
    "resource",
    "pwd",
    "grp",
    "posix",
    "syslog",
    "readline",
    "curses",
)

ATTRIBUTES = {
    "os": (
        *("fork", "forkpty", "register_at_fork", "killpg", "setsid", "setpgid", "getpgid", "setpgrp", "wait"),
        *("wait3", "wait4", "waitid", "WNOHANG", "WIFEXITED", "WIFSIGNALED", "WEXITSTATUS", "WTERMSIG"),
        *("mkfifo", "openpty", "posix_spawn", "getuid", "geteuid", "getgid", "getegid", "chown", "fchown"),
        *("nice", "uname", "sysconf", "set_blocking", "pread", "pwrite", "sched_getaffinity", "statvfs"),
        *("getloadavg", "O_NONBLOCK", "O_DIRECTORY", "O_NOFOLLOW", "fchmod", "getpriority", "ctermid"),
    ),
    "signal": (
        *("SIGKILL", "SIGALRM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGCHLD", "SIGQUIT", "SIGPIPE", "SIGSTOP"),
        *("SIGCONT", "SIGTSTP", "alarm", "setitimer", "getitimer", "ITIMER_REAL", "pause", "pthread_kill"),
        *("pthread_sigmask", "sigwait", "sigtimedwait", "siginterrupt"),
    ),
    "select": ("poll", "epoll", "kqueue", "POLLIN", "POLLHUP"),
}

IN_PART = {"os": ("waitpid",), "select": ("select",)}
"""These exist there, and do less: `waitpid` knows no other processes, `select` takes no pipes."""

ARGUMENTS = ("preexec_fn", "start_new_session", "process_group", "pass_fds")
"""Of subprocess.Popen."""

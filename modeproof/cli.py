"""The command line: a table of commands, and what they have in common.

Exit status 0: as expected; 1: not as expected; 2: could not be judged (and then one line says why).
"""

from __future__ import annotations

import _thread
import argparse
import contextlib
import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any, NoReturn

from modeproof.ground.errors import EXIT_UNJUDGED, Unjudged, suggestion
from modeproof.ground.places import TREE, root
from modeproof.kit.by_name import module_named
from modeproof.kit.files import to_standard_output
from modeproof.kit.parser import Parser

GROUPS = {
    "commands": {
        "verify": ("modeproof.lane.verify", "registers, TLC, conformance and proofs; ends with a summary"),
        "conform": (
            "modeproof.suites.conform_command",
            "judge a program by the specification: your own behind an adapter, or a built-in one",
        ),
        "prove-program": (
            "modeproof.lane.prove_program_command",
            "prove a PLC program equal to a target, or show where it differs",
        ),
        "machine": (
            "modeproof.lane.machine_command",
            "judge how the documents' blocks are wired to a machine",
        ),
        "trace": (
            "modeproof.trace.trace_command",
            "judge a recorded log of a device, or of the whole system, by the specification",
        ),
        "simulate": (
            "modeproof.simulate.simulate_command",
            "a page to play with: the reference implementation runs in the browser, offline",
        ),
        "init": (
            "modeproof.project.init_command",
            "write modeproof.toml from the programs, wirings and logs of this folder",
        ),
        "judge": (
            "modeproof.project.judge_command",
            "judge all that modeproof.toml lists: programs, machines, adapters, logs",
        ),
        "report": (
            "modeproof.dossier.report_command",
            "the dossier about your project; in the tool's checkout the assessor's report",
        ),
        "explain": (
            "modeproof.explain.explain_command",
            "what an id or a word is, where it is, and what was shown",
        ),
        "example": (
            "modeproof.lane.example_command",
            "copy a program, a log or a wiring to begin with to this folder",
        ),
        "completion": ("modeproof.lane.completion", "let your shell complete commands and options"),
        "doctor": ("modeproof.lane.doctor", "tell what this machine lacks, and how to mend it"),
    },
    "commands for maintainers": {
        "renew": (
            "modeproof.lane.renew",
            "after a change: make everything anew that was made from the text before it",
        ),
        "check": ("modeproof.tlc.check_command", "run TLC on declared runs and judge them"),
        "prove": (
            "modeproof.lane.prove_command",
            "prove the theorems of a document with Z3, re-checked by cvc5",
        ),
        "registers": (
            "modeproof.registers.registers_command",
            "judge the registers and the matrix from clause to vector",
        ),
        "render": ("modeproof.lane.render", "make docs/<document>.md and the blocks in README.md anew"),
        "walks": (
            "modeproof.lane.walks",
            "follow every recorded counterexample once more: what was on the wires, for the report",
        ),
        "vectors": ("modeproof.suites.vectors_command", "build, check and show the test suites"),
        "map": (
            "modeproof.suites.map_command",
            "write or check a map: where the signals of a target are in the memory of a PLC",
        ),
        "mutate": (
            "modeproof.strength.mutate_command",
            "one-edit mutants of the specification or of the code, and what each of them breaks",
        ),
    },
}
"""The commands as the help groups them: the module that has the `add_parser` of each, and what it is for."""

COMMANDS = {name: module for group in GROUPS.values() for name, (module, _) in group.items()}
"""The modules without groups; only that of the command given is imported."""
SUMMARIES = {name: summary for group in GROUPS.values() for name, (_, summary) in group.items()}

JUDGES = ("verify", "check", "prove", "conform", "trace", "registers", "report", "mutate", "renew")
"""Commands that end in a verdict: their first line names the tree that it is about."""


_COMPLETION = "_ARGCOMPLETE"
"""Set by a shell that asks what may come next."""

_HEARD: list[int] = []
"""The signals that told this run of `main` to stop."""


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit status. Expected errors end in one line on standard error and 2."""
    # An editable install knows the package alone; of a tree that is named, its rooms come first
    first = [place for place in (os.environ.get("MODEPROOF_ROOT"), str(TREE)) if place]
    sys.path[:] = [*first, *(path for path in sys.path if path not in first)]
    if _COMPLETION in os.environ:
        _complete()
    given = sys.argv[1:] if argv is None else argv
    args = argparse.Namespace(debug=given[:1] == ["--debug"])
    hook = sys.unraisablehook
    _HEARD.clear()
    if isinstance(sys.stdout, io.TextIOWrapper):  # escapes for what the code page of a console does not have
        sys.stdout.reconfigure(errors="backslashreplace")
    previous = _stop_on_signals()
    try:
        args = make_parser(given).parse_args(given)
        place = root()
        sys.path[:] = [str(place), *(path for path in sys.path if path != str(place))]
        run: Callable[[argparse.Namespace], int] = args.run
        with to_standard_output(vars(args).values()):
            if args.command in JUDGES:
                print(f"{'tree':<12} {place}", flush=True)
            status = int(run(args))
        if _HEARD:  # a library has caught it and gone on
            raise KeyboardInterrupt
        return status
    except Unjudged as error:
        if args.debug:
            raise
        _complain(error.message)
    except KeyboardInterrupt:
        if signal.SIGTERM in previous:  # the main thread; a second Ctrl-C would only spoil the end
            previous.setdefault(signal.SIGINT, signal.signal(signal.SIGINT, signal.SIG_IGN))
        exec("")  # else Python, interrupted inside another exec, ends itself by the signal and not with 2
        _stop_tools()
        _complain("interrupted: no verdict; what was finished before is kept")
        if hook is sys.__unraisablehook__:  # objects that were cut off half made complain as they go
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    except BrokenPipeError:
        # Whoever read our output has gone; Python would complain once more while flushing at exit.
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        if args.debug:
            raise
        _complain(f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}")
    except Exception as error:  # a defect of ours: still one line, and never a pass
        if args.debug:
            raise
        if type(error).__module__ == "modeproof.kit.errors":  # the kit has an Unjudged of its own
            _complain(" ".join(str(error).split()))
            return EXIT_UNJUDGED
        text = " ".join(str(error).split())[:300]
        _complain(f"internal error: {type(error).__name__}: {text} (--debug shows where)")
    finally:
        sys.unraisablehook = hook
        for number, handler in previous.items():
            signal.signal(number, handler)
    return EXIT_UNJUDGED


class _Commands(argparse._SubParsersAction):  # type: ignore[type-arg]
    """The commands, each with its summary from the table above."""

    def add_parser(self, name: str, **options: Any) -> argparse.ArgumentParser:
        summary = SUMMARIES[name]
        options.setdefault("description", summary[0].upper() + summary[1:] + ".")
        parser: argparse.ArgumentParser = super().add_parser(name, help=summary, **options)
        return parser


class _Grouped(argparse.HelpFormatter):
    """Lists the commands by their groups."""

    def _format_action(self, action: argparse.Action) -> str:
        shown = super()._format_action
        if not isinstance(action, argparse._SubParsersAction):
            return shown(action)
        listed = {choice.dest: choice for choice in action._choices_actions}
        text = ""
        for title, names in GROUPS.items():
            text += f"\n{title}:\n" if text else ""
            text += "".join(shown(listed[name]) for name in names if name in listed)
        return text


def make_parser(argv: Sequence[str]) -> argparse.ArgumentParser:
    """The command that the arguments name, with its options; all commands where they name none.

    Raises Unjudged for a word that is no command.
    """
    command = next((word for word in argv if not word.startswith("-")), None)
    if command is not None and command not in COMMANDS:
        raise Unjudged(f"no command {command!r}; {suggestion(command, COMMANDS)}")
    parser = Parser(
        prog="modeproof",
        description="Checks published safety procedures by TLA+ models and proofs. It certifies nothing.",
        epilog="exit status: 0 as expected, 1 not as expected, 2 could not be judged",
        formatter_class=_Grouped,
    )
    parser.add_argument("--debug", action="store_true", help="show where an error comes from")
    parser.add_argument("--version", action=_Version, nargs=0, help="show version and SHA-256 of the tool")
    commands = parser.add_subparsers(
        action=_Commands, dest="command", required=True, metavar="COMMAND", title=next(iter(GROUPS))
    )
    for name in COMMANDS if command is None else ():  # the help lists them; no module is needed for that
        commands.add_parser(name)
    if command is not None:
        _add(commands, command)
    return parser


class _Version(argparse.Action):
    """Ends with a line that names the tool as evidence does."""

    def __call__(self, parser: argparse.ArgumentParser, *given: Any) -> NoReturn:
        from modeproof.ground.evidence import own_tools

        tools = own_tools()
        own, python = tools["modeproof"], tools["python"]
        print(f"modeproof {own['version']}, sha256 {str(own['sha256'])[:12]}, Python {python['version']}")
        parser.exit()


def _add(commands: Any, name: str) -> None:
    """One command with its options. Raises Unjudged where its packages are missing."""
    try:
        module_named(COMMANDS[name]).add_parser(commands)
    except ImportError as error:
        mend = "`modeproof doctor` tells how to mend it"
        raise Unjudged(f"{name} cannot be loaded: {error}; {mend}") from error


def _complete() -> None:
    """Answer the shell what may come next in its line, and end. See `completion`."""
    from modeproof.lane.completion import answer

    line = os.environ.get("COMP_LINE", "")[: int(os.environ.get("COMP_POINT", "0"))]
    words = line.split()[1:]
    typed = words if line[-1:].isspace() else words[:-1]
    known = next((word for word in typed if word in COMMANDS), None)
    with contextlib.suppress(Unjudged):  # a command whose packages are missing has nothing to offer
        answer(make_parser([known] if known else []))


def _complain(line: str) -> None:
    erase = "\r\x1b[K" if sys.stderr.isatty() else ""  # a line of progress may stand there
    with contextlib.suppress(OSError):
        print(f"{erase}modeproof: {line}", file=sys.stderr, flush=True)


def _stop_tools() -> None:
    loaded = sys.modules.get("modeproof.tlc.children")
    if loaded is not None:
        loaded.stop_all()


def _stop_on_signals() -> dict[int, Any]:
    """Treat SIGTERM and SIGHUP like Ctrl-C, so that Java never outlives us.

    Where Ctrl-C meets us while an object is being deleted (z3 has many), Python drops it: it comes again,
    until `main` has heard it.
    """

    def again() -> None:
        time.sleep(0.02)
        while sys.unraisablehook is dropped and signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
            _thread.interrupt_main()
            time.sleep(0.02)

    def dropped(unraisable: sys.UnraisableHookArgs) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            threading.Thread(target=again, daemon=True).start()
        else:
            hook(unraisable)

    hook = sys.unraisablehook
    if threading.current_thread() is threading.main_thread():
        sys.unraisablehook = dropped

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        if number == signal.SIGINT and os.getpid() != pid:  # a fork that was made while it came
            os._exit(EXIT_UNJUDGED)
        _HEARD.append(number)
        raise KeyboardInterrupt

    pid, previous = os.getpid(), dict[int, Any]()
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler  # not ignored, as under nohup
    others = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    for number in (*others, *([signal.SIGINT] if ours else [])):
        with contextlib.suppress(ValueError):  # not the main thread
            previous[number] = signal.signal(number, stop)
    return previous

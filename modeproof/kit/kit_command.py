"""The command `conform`, as far as it needs nothing but vectors and a program."""

from __future__ import annotations

import argparse
import contextlib
import signal
import sys
import threading
import time
from collections.abc import Callable, Container, Iterator, Sequence
from pathlib import Path
from typing import Any

from modeproof.kit.adapter import Adapter, Program, split_command
from modeproof.kit.again import TEST_RIG, again, program_words
from modeproof.kit.builtin import package_files
from modeproof.kit.bundle import Bundle, not_published
from modeproof.kit.errors import Unjudged
from modeproof.kit.hello import read_hello
from modeproof.kit.machine_parameters import with_parameters
from modeproof.kit.machine_reference import program_of
from modeproof.kit.profile import ALL, LETTER, PROFILES, OfProfile, of_profile
from modeproof.kit.resume import Resume, identity
from modeproof.kit.suite_judge import Difference, Options, Plan, Verdict
from modeproof.kit.text import (
    as_junit,
    as_record,
    as_text,
    difference_lines,
    joined,
    joint,
    left,
    say,
    together,
    write_json,
    write_text,
)
from modeproof.kit.two_answers import judge_both
from modeproof.kit.vectors import EXACT, FILE_NAME, MONITOR, SETTLED, Suite, open_suite

EXIT_UNJUDGED = 2
FAST = "fast"
"""Stands for every fast suite that can be judged by the relation."""


def add_parser(
    commands: Any, run: Callable[[argparse.Namespace], int] | None = None
) -> argparse.ArgumentParser:
    """Add `conform`. `run` takes its place where more is at hand than vectors."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "conform",
        epilog="exit status: 0 FOLLOWS, CONFORMS or EQUAL, 1 BREAKS or DIFFERS, 2 UNJUDGED",
    )
    parser.add_argument(
        "target", metavar="TARGET", help="what the program claims to be: a device of the interface register"
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--adapter", metavar="CMD", help="command that speaks adapter protocol 1")
    which.add_argument(
        "--s7", metavar="HOST[:PORT]", help="a PLC: starts the adapter modeproof.s7; needs --map"
    )
    which.add_argument(
        "--builtin", metavar="NAME", help="Python package (refimpl): every transition, both ways; or --suite"
    )
    parser.add_argument("--map", type=Path, metavar="FILE", help="addresses of the signals in the PLC, CSV")
    parser.add_argument(
        TEST_RIG, dest="test_rig", action="store_true", help="of --s7: no machine hangs on it"
    )
    parser.add_argument("--document", metavar="NAME", help="the document of the target, where two have one")
    parser.add_argument(
        "--suite",
        action="append",
        metavar="NAME",
        help=f"test suite, may be repeated; {FAST}: all that end soon",
    )
    parser.add_argument(
        "--vectors", type=Path, metavar="FILE", help="vector file, or a folder of them, instead of --suite"
    )
    parser.add_argument("--case", metavar="ID", help="only this case")
    parser.add_argument("--scans", metavar="LIST", help="only these scans of it, as a verdict names them")
    parser.add_argument(
        "--relation",
        choices=(EXACT, SETTLED, MONITOR),
        default=EXACT,
        help="besides what the document demands: outputs scan by scan (default), once settled, or nothing",
    )
    parser.add_argument(
        "--same",
        action="store_true",
        help="the exit status asks for equality with the reference, too, and not only for what is demanded",
    )
    parser.add_argument(
        "--flips", action="store_true", help="by the page, too, inputs that it calls constant may change"
    )
    parser.add_argument(
        "--latency", type=_count, metavar="N", help="scans that an input may need (default: as hello says)"
    )
    parser.add_argument(
        "--hold", type=_count, default=0, metavar="MS", help="time of a scan that holds inputs (default 0)"
    )
    parser.add_argument(
        "--slow", type=_factor, default=1, metavar="K", help="make all times of the suite K times as long"
    )
    parser.add_argument(
        "--param",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of your machine, in all cases; the reference implementation says what to expect",
    )
    parser.add_argument(
        "--profile",
        choices=PROFILES,
        help="whose choices count where the document leaves some: letter (default, what its words say), "
        "cautious (what we recommend), all (a program that takes them as parameters)",
    )
    parser.add_argument(
        "--codes", action="store_true", help="compare outputs too whose values the document does not give"
    )
    parser.add_argument(
        "--jobs", type=_factor, default=1, metavar="N", help="so many programs at once (default 1)"
    )
    parser.add_argument(
        "--timeout", type=_seconds, default=10.0, metavar="S", help="limit for an answer (default 10 s)"
    )
    parser.add_argument(
        "--differences",
        type=_factor,
        default=20,
        metavar="N",
        help="end after so many differing cases (default 20)",
    )
    parser.add_argument(
        "--resume", type=Path, metavar="FILE", help="note there what passed, and go on from there"
    )
    if run is not None:
        parser.add_argument(
            "--name", metavar="NAME", help="the name of your run in the report (default: as the program says)"
        )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result as JSON as well")
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write the result as JUnit XML as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run or run_kit)
    return parser


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 < value <= 3600:
        raise argparse.ArgumentTypeError("more than 0 and at most 3600 seconds expected")
    return value


def _count(text: str) -> int:
    value = int(text)
    if not 0 <= value <= 100_000:
        raise argparse.ArgumentTypeError("0 to 100000 expected")
    return value


def _factor(text: str) -> int:
    value = int(text)
    if not 1 <= value <= 100_000:
        raise argparse.ArgumentTypeError("1 to 100000 expected")
    return value


def run_kit(args: argparse.Namespace) -> int:
    """Run `conform` with the kit alone: by a file, or by the vectors that are in the kit."""
    try:
        if args.vectors is not None:
            suites = open_vectors(args)
            with contextlib.suppress(Unjudged):  # vectors alone have no demands
                suites = Bundle.own().demanding(suites)
        else:
            suites = Bundle.own().suites(args.target, args.suite or [FAST], args.relation)
        return joint(judge(args, in_profile(args, suites)))[1]
    except (Unjudged, KeyboardInterrupt) as error:
        with contextlib.suppress(Unjudged):
            say(f"UNJUDGED: {str(error) or 'interrupted'}", sys.stderr)
        return EXIT_UNJUDGED


def greet(args: argparse.Namespace, outputs: Container[str]) -> None:
    """Start the adapter, say hello and end it, before anything slow begins; without one do nothing.

    `outputs` are those of the target. Raises Unjudged as a run would.
    """
    if args.adapter is None:
        return
    with Adapter(args.adapter, args.timeout) as adapter:
        try:
            read_hello(adapter.hello(args.target), outputs, args.relation)
        except Unjudged as error:
            raise Unjudged(f"hello: {error}") from None


def open_vectors(args: argparse.Namespace) -> list[Suite]:
    """The file that --vectors names, or all of a folder. Raises Unjudged where one is of another target."""
    files = [args.vectors]
    if args.vectors.is_dir() and not (files := sorted(args.vectors.glob(FILE_NAME.format(suite="*")))):
        raise Unjudged(f"{args.vectors}: no vector file in this folder")
    suites = [open_suite(file) for file in files]
    for suite in suites:
        if suite.target != args.target:
            raise Unjudged(f"{suite.path}: vectors of {suite.target}, not of {args.target}")
    return suites


def judge(args: argparse.Namespace, suites: Sequence[Suite]) -> list[Verdict]:
    """Run the suites as the arguments say, print the verdicts and write --json and --junit.

    Raises Unjudged for arguments that do not go together.
    """
    if args.scans is not None and args.case is None:
        raise Unjudged("--scans belongs to --case")
    if args.resume is not None and (args.case is not None or len(suites) > 1):
        raise Unjudged("--resume is for one suite at a time, and all its cases")
    given = {word.partition("=")[0] for word in args.param}
    profiles = {
        suite.name: suite.profile
        for suite in suites
        if isinstance(suite, OfProfile) and not given & suite.values.keys()
    }
    if args.param:
        greet(args, suites[0].outputs)
        suites = [with_parameters(suite, args.param, args.relation) for suite in suites]
    verdicts: list[Verdict] = []
    with _ended_alike():
        for suite in suites:
            verdict = _judge(args, suite)
            doubt = not_published(suite) if args.vectors is not None else ""
            for one in (verdict, verdict.page):
                if one is not None:
                    one.params, one.profile = tuple(args.param), profiles.get(suite.name, "")
                    one.suite = f"{one.suite}, {doubt}" if doubt else one.suite
            verdicts.append(verdict)
            last = suite is suites[-1] or verdict.interrupted
            say(as_text(verdict, again(args, suite, verdict), suite, last))
            if verdict.interrupted:
                break
    if len(verdicts) > 1:
        say(together(verdicts))
    if args.json is not None:
        record = as_record(verdicts[0])
        if len(verdicts) > 1:
            word, status = joint(verdicts)
            record = {
                "verdict": word,
                "status": status,
                "suites": list(map(as_record, verdicts)),
            }
        write_json(args.json, record)
    if args.junit is not None:
        write_text(args.junit, as_junit(verdicts))
    return verdicts


def profile_of(args: argparse.Namespace) -> str:
    """The profile that a run is for: the letter, unless another is named, or a single case is."""
    return args.profile or (LETTER if args.case is None else ALL)


def in_profile(args: argparse.Namespace, suites: Sequence[Suite]) -> list[Suite]:
    """The cases of the suites that speak of the profile. Raises Unjudged where there are none, and where one
    is asked for of a target that has no profiles.

    A suite that was not asked for by its name is left out where it has none.
    """
    profile = profile_of(args)
    if args.profile not in (None, ALL) and not any(suite.header.get("profiles") for suite in suites):
        target = suites[0].target if suites else args.target
        raise Unjudged(f"{target} has no profiles, so it has none that is {profile}; leave --profile out")
    found = []
    for suite in suites:
        part = of_profile(suite, profile)
        if part is not None:
            found.append(part)
        elif args.vectors is not None or suite.name in (args.suite or ()):
            raise Unjudged(f"{suite.path.name}: no case of {suite.name} is for the profile {profile}")
    if not found:
        raise Unjudged(f"no case of these suites is for the profile {profile}")
    return found


@contextlib.contextmanager
def _ended_alike() -> Iterator[None]:
    """What asks a process to end does so as Ctrl-C does: adapters are ended, and the verdict is UNJUDGED."""

    def interrupt(number: int, frame: Any) -> None:
        raise KeyboardInterrupt

    kinds = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {}
    if threading.current_thread() is threading.main_thread():
        before = {kind: signal.getsignal(kind) for kind in kinds}
    for kind, handler in before.items():
        if handler is signal.SIG_DFL:  # under nohup it stays ignored
            signal.signal(kind, interrupt)
    try:
        yield
    finally:
        for kind, handler in before.items():
            if handler is signal.SIG_DFL:
                signal.signal(kind, handler)


def _judge(args: argparse.Namespace, suite: Suite) -> Verdict:
    resume = Resume(args.resume, suite, _identity(args)) if args.resume else None
    plan = Plan(
        options=Options(args.relation, args.latency, args.hold, args.slow, args.codes),
        only=args.case,
        part=args.scans,
        jobs=args.jobs,
        most=args.differences,
        effort=60,
        skip=resume.done if resume is not None else (),
    )

    def tell(text: str) -> None:
        if not args.quiet:
            with contextlib.suppress(Unjudged):  # nobody need read it
                say(text, sys.stderr)

    began = time.monotonic()

    def progress(done: int, total: int) -> None:
        rest = left(time.monotonic() - began, done / total if total else 0)
        tell(f"{suite.target} {suite.name}: {done:,} of {total:,} scans{rest}")

    def first(found: Difference) -> None:
        tell(joined(["first difference:", *difference_lines(found, suite, way=False)]))

    verdict = judge_both(
        suite,
        starter(args, suite),
        plan,
        args.same,
        flips=args.flips,
        page={"on_progress": _now_and_then(progress), "on_difference": first},
        on_progress=_now_and_then(progress),
        on_difference=first,
        on_passed=resume.note if resume is not None else None,
        on_hello=resume.hello if resume is not None else None,
    )
    if resume is not None and (verdict.cases or verdict.differences):
        resume.write()
    return verdict


def _identity(args: argparse.Namespace) -> dict[str, Any]:
    """What a note of passed cases is true of: the program, as far as it can be known, and every option."""
    words = split_command(args.adapter) if args.adapter else []
    return {
        "program": program_words(args),
        "files": identity([*words, *([str(args.map)] if args.map else [])]) | package_files(args.builtin),
        **{
            name: getattr(args, name)
            for name in ("relation", "latency", "hold", "slow", "codes", "param", "flips")
        },
        "profile": profile_of(args),
    }


def starter(args: argparse.Namespace, suite: Suite) -> Callable[[], Program]:
    """What starts the program that the arguments name. Raises Unjudged where something is missing."""
    if args.adapter is not None:
        return lambda: Adapter(args.adapter, args.timeout)
    if args.s7 is not None:
        if args.map is None:
            raise Unjudged("--s7 needs --map FILE with the addresses of the signals")
        if not args.test_rig:
            raise Unjudged(f"--s7 writes into the memory of a PLC: {TEST_RIG} is missing (docs/s7.md)")
        if args.jobs > 1:
            raise Unjudged("--s7: a PLC is one program; --jobs is for adapters")
        # The adapter gives up first, with better words than "no answer".
        return lambda: Adapter(s7_adapter(args, suite), 3 * args.timeout + 5)
    return lambda: program_of(args.builtin, suite)


def s7_adapter(args: argparse.Namespace, suite: Suite) -> list[str]:
    """The command that starts the adapter of --s7, in a checkout and in the packed kit alike."""
    here = str(Path(__file__).parents[2])
    start = "import runpy, sys; sys.path.insert(0, sys.argv.pop(1)); "
    start += "runpy.run_module('modeproof.s7', None, '__main__')"
    command = [sys.executable, "-c", start, here, suite.target, "--host", args.s7, "--map", str(args.map)]
    command += ["--vectors", str(suite.path), "--member", suite.member, "--timeout", f"{args.timeout:g}"]
    command.append(TEST_RIG)
    return command


def _now_and_then(report: Callable[[int, int], None]) -> Callable[[int, int], None]:
    calls = 0
    lock = threading.Lock()

    def sometimes(done: int, total: int) -> None:
        nonlocal calls
        with lock:
            calls += 1
            if calls % 4 == 1:
                report(done, total)

    return sometimes

"""The command `conform`, as far as it needs nothing but vectors and an adapter."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from modeproof.kit.adapter import Adapter
from modeproof.kit.errors import Unjudged
from modeproof.kit.judge import Verdict, run_suite
from modeproof.kit.text import as_record, as_text, write_json
from modeproof.kit.vectors import Suite, open_suite

EXIT_UNJUDGED = 2


def add_parser(
    commands: Any, run: Callable[[argparse.Namespace], int] | None = None
) -> argparse.ArgumentParser:
    """Add `conform`. `run` takes its place where more is at hand; the kit's own needs --vectors."""
    text = "judge a program by the specification: your own behind an adapter, or a built-in one"
    parser: argparse.ArgumentParser = commands.add_parser(
        "conform",
        help=text,
        description=text[0].upper() + text[1:] + ".",
        epilog="exit status: 0 CONFORMS or EQUAL, 1 DIFFERS, 2 UNJUDGED",
    )
    parser.add_argument(
        "target", metavar="TARGET", help="what the program claims to be: a device of the interface register"
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--adapter", metavar="CMD", help="command that speaks adapter protocol 1")
    which.add_argument(
        "--builtin", metavar="NAME", help="package in this repository (refimpl): every transition, both ways"
    )
    parser.add_argument("--document", metavar="NAME", help="the document of the target, where two have one")
    parser.add_argument("--suite", default="tour", metavar="NAME", help="test suite (default: tour)")
    parser.add_argument("--vectors", type=Path, metavar="FILE", help="vector file instead of --suite")
    parser.add_argument("--case", metavar="ID", help="only this case")
    parser.add_argument("--relation", choices=("exact",), default="exact", help="how outputs are compared")
    parser.add_argument(
        "--timeout", type=_seconds, default=10.0, metavar="S", help="limit for an answer (default 10 s)"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run or run_kit)
    return parser


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 < value <= 3600:
        raise argparse.ArgumentTypeError("more than 0 and at most 3600 seconds expected")
    return value


def run_kit(args: argparse.Namespace) -> int:
    """Run `conform` with the kit alone."""
    try:
        if args.vectors is None or args.adapter is None:
            raise Unjudged("the kit alone needs --vectors FILE and --adapter CMD")
        suite = open_suite(args.vectors)
        if suite.target != args.target:
            raise Unjudged(f"{args.vectors}: vectors of {suite.target}, not of {args.target}")
        return judge(args, suite).status
    except Unjudged as error:
        print(f"UNJUDGED: {error}", file=sys.stderr)
        return EXIT_UNJUDGED


def judge(args: argparse.Namespace, suite: Suite) -> Verdict:
    """Run the suite as the arguments say, print the verdict and write --json. Raises kit.errors.Unjudged."""

    def progress(done: int, total: int) -> None:
        print(f"{suite.target} {suite.name}: {done:,} of {total:,} scans", file=sys.stderr, flush=True)

    verdict = run_suite(
        suite,
        lambda: Adapter(args.adapter, args.timeout),
        only=args.case,
        on_progress=None if args.quiet else _now_and_then(progress),
    )
    print(as_text(verdict, again(args, verdict)))
    if args.json is not None:
        write_json(args.json, as_record(verdict))
    return verdict


def again(args: argparse.Namespace, verdict: Verdict) -> str:
    """The command that runs the case of the difference again."""
    if verdict.difference is None:
        return ""
    vectors = f"--vectors {quoted(str(args.vectors))}" if args.vectors else f"--suite {args.suite}"
    document = f" --document {args.document}" if args.document else ""
    return (
        f"modeproof conform {args.target} --adapter {quoted(args.adapter)}{document} {vectors} "
        f"--case {verdict.difference.case.id}"
    )


def quoted(text: str) -> str:
    """A word of a command line for sh and for Windows alike: in double quotes where it needs them."""
    plain = text and all(one.isalnum() or one in "_-./:=+@%,\\" for one in text)
    return text if plain else '"' + text.replace('"', '\\"') + '"'


def _now_and_then(report: Callable[[int, int], None]) -> Callable[[int, int], None]:
    calls = 0

    def sometimes(done: int, total: int) -> None:
        nonlocal calls
        calls += 1
        if calls % 4 == 1:
            report(done, total)

    return sometimes

"""The command `prove-program`: its options. The room `programs` does the work."""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import adding
from modeproof.ground.solvers import needing_solvers
from modeproof.kit.again import quoted
from modeproof.output.options import About, add_options, carried_out
from modeproof.output.outcome import Outcome, shown_path

MOST_LATENCY = 8
SECONDS = 300
"""Limit of a search, of CPU time, where --seconds names no other."""


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `prove-program` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "prove-program",
        description="With --target: FOLLOWS the page (0): all its demands hold in every scan from power-up. "
        "BREAKS one (1): the scans that show it. UNKNOWN (2): neither. Then whether it is the same as the "
        "reference, which --same asks for too.",
    )
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="ST, SCL, PLCopen XML or AWL")
    parser.add_argument("--target", metavar="T", help="a published target, as in vectors/")
    parser.add_argument(
        "--same", action="store_true", help="equal outputs to the reference are asked for, too"
    )
    parser.add_argument(
        "--codes", action="store_true", help="with outputs that no page prints (codes of ours); means --same"
    )
    parser.add_argument(
        "--flips", action="store_true", help="inputs that the page calls constant may change during a run"
    )
    parser.add_argument("--latency", type=int, metavar="N", help="scans that a reaction may take (1)")
    parser.add_argument("--unit", metavar="NAME", help="the block or program meant, if there are several")
    parser.add_argument("--binding", type=Path, metavar="TOML", help="names that do not agree; see the docs")
    parser.add_argument(
        "--wrap", action="store_true", help="integers wrap; without it they must not overflow"
    )
    parser.add_argument(
        "--certificate", type=Path, metavar="FOLDER", help="of a proof, write there what others can check"
    )
    parser.add_argument(
        "--recheck", type=Path, metavar="FOLDER", help="check a certificate with z3 and cvc5; no search"
    )
    parser.add_argument(
        "--vector", type=Path, metavar="FILE", help="keep the scans of a difference there (build/programs/)"
    )
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write the verdict as JUnit XML as well")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the verdict there as well")
    parser.add_argument(
        "--seconds", type=float, metavar="S", help=f"limit of the search for pairs ({SECONDS})"
    )
    parser.add_argument(
        "--property",
        type=Path,
        metavar="TOML",
        help="in the place of --target: properties of your own program",
    )
    parser.add_argument(
        "--against",
        type=Path,
        metavar="OLD",
        help="in the place of --target: another program, such as the one before a change; any language",
    )
    parser.add_argument("--old-unit", metavar="NAME", help="with --against: the unit of OLD that is meant")
    add_options(parser, judge, about)
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Run it; the exit status is that of the verdict. Raises Unjudged."""
    _look(args)
    if args.recheck is None:
        return carried_out(args).status
    with needing_solvers():
        from programs.commands import prove_program
    with _not_too_deep([args.recheck]):
        return prove_program.run_recheck(args)


def judge(args: argparse.Namespace) -> Outcome:
    """Judge the program, print the verdict, and return what was found. Raises Unjudged."""
    _look(args)
    with needing_solvers():
        from programs.commands import prove_against, prove_program, prove_properties
    with _not_too_deep(args.files):
        if args.against is not None:
            return prove_against.judge_against(args)
        if args.property is not None:
            return prove_properties.judge_properties(args)
        return prove_program.judge_program(args)


def about(args: argparse.Namespace) -> About:
    """What the arguments ask for."""
    words: list[object] = ["modeproof", "prove-program", *args.files]
    for name in ("target", "property", "against", "unit", "old_unit", "binding"):
        if (given := getattr(args, name)) is not None:
            words += [f"--{name.replace('_', '-')}", given]
    if args.latency is not None:
        words += ["--latency", args.latency]
    words += ["--same"] * (args.same and not args.codes) + ["--codes"] * args.codes + ["--wrap"] * args.wrap
    words += ["--flips"] * args.flips
    return About(
        command="prove-program",
        subject=", ".join(map(shown_path, args.files)),
        target=args.target or shown_path(args.property or args.against or ""),
        again=" ".join(quoted(str(word)) for word in words),
        files={
            "program": args.files,
            "binding": [args.binding],
            "properties": [args.property],
            "old": [args.against],
        },
        part=args.unit or "",
    )


@contextlib.contextmanager
def _not_too_deep(files: Sequence[Path]) -> Iterator[None]:
    """Refuses what is too deep for Python: an expression, or a list of statements in one another."""
    try:
        yield
    except (RecursionError, ctypes.ArgumentError) as error:  # the latter is how z3 passes it on
        if "recursion" not in f"{type(error).__name__} {error}".lower():
            raise
        raise Unjudged(
            f"{', '.join(map(str, files))}: an expression, or a list of ELSIF, CASE or RETURN, is too long "
            "or too deep for this reader; split it"
        ) from None


def _look(args: argparse.Namespace) -> None:
    """Raises Unjudged for options that do not go together, or where a package is missing."""
    asked = [name for name in ("target", "property", "against", "recheck") if getattr(args, name) is not None]
    if len(asked) != 1 or (args.recheck is None) != bool(args.files):
        raise Unjudged(
            "prove-program: name the program's files and --target T, or --property TOML for a program of "
            "your own, or --against OLD for two programs; or a certificate alone, with --recheck"
        )
    beside = {
        "recheck": (
            "binding",
            "unit",
            "wrap",
            "certificate",
            "vector",
            "junit",
            "json",
            "seconds",
            "record",
            "same",
            "codes",
            "latency",
            "old_unit",
            "flips",
        ),
        "target": ("old_unit",),
        "against": ("vector", "same", "codes", "latency", "flips"),
        "property": ("vector", "same", "codes", "latency", "old_unit", "flips"),
    }
    for name in beside.get(asked[0], ()):
        if getattr(args, name) not in (None, False):
            raise Unjudged(f"--{name.replace('_', '-')} has no effect with --{asked[0]}; leave it out")
    args.same = args.same or args.codes
    if not 0 <= (args.latency or 0) <= MOST_LATENCY:
        raise Unjudged(f"--latency {args.latency}: 0 to {MOST_LATENCY} scans")
    args.seconds = SECONDS if args.seconds is None else args.seconds
    if not 0 < args.seconds < math.inf:
        raise Unjudged(f"--seconds {args.seconds:g}: a time above 0 is needed")
    try:
        import tree_sitter_iec61131_3_st  # noqa: F401
    except ImportError as error:
        raise Unjudged(f"programs cannot be read: {error}; {adding('', str(error.name))}") from None

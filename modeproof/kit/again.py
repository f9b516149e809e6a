"""The command line that runs a difference again."""

from __future__ import annotations

import argparse
import shlex
import sys

from modeproof.kit.profile import LETTER
from modeproof.kit.vectors import EXACT, Suite
from modeproof.kit.verdict import Verdict

TEST_RIG = "--i-know-this-is-a-test-rig"


def program_words(args: argparse.Namespace) -> str:
    """The options that name the program."""
    if args.adapter is not None:
        return f"--adapter {quoted(args.adapter)}"
    if args.s7 is not None:
        return f"--s7 {args.s7} --map {quoted(str(args.map))} {TEST_RIG}"
    return f"--builtin {args.builtin}"


def again(args: argparse.Namespace, suite: Suite, verdict: Verdict) -> str:
    """The command that runs the shortest case of the difference again."""
    found = verdict.difference
    if found is None:
        return ""
    packed = sys.argv[0].endswith(".pyz")
    words = [f"python3 {quoted(sys.argv[0])}" if packed else "modeproof", "conform", args.target]
    words.append(program_words(args))
    if args.document:
        words.append(f"--document {args.document}")
    words.append(f"--vectors {quoted(str(suite.path))}" if args.vectors else f"--suite {suite.name}")
    for name, value, usual in (
        ("relation", args.relation, EXACT),
        ("latency", args.latency, None),
        ("hold", args.hold, 0),
        ("slow", args.slow, 1),
    ):
        if value != usual:
            words.append(f"--{name} {value}")
    words += ["--same"] * bool(args.same) + ["--flips"] * bool(args.flips)
    words += [f"--param {quoted(text)}" for text in args.param]
    if args.profile not in (None, LETTER):
        words.append(f"--profile {args.profile}")
    if args.codes:
        words.append("--codes")
    # A part of a case has another id than the case, which no file knows.
    words.append(f"--case {args.case or found.case.id}")
    if args.scans is not None:
        words.append(f"--scans {quoted(args.scans)}")
    elif found.confirmed and len(found.shortest.scans) < len(found.case.scans):
        words.append(f"--scans {quoted(found.part)}")
    return " ".join(words)


def quoted(text: str) -> str:
    """A word of a command line for sh and for Windows alike: in double quotes where it needs them.

    In single quotes where sh would read something into it.
    """
    simple = text and all(char.isalnum() or char in "_-./:=+@%,\\" for char in text)
    if any(char in text for char in "$`!"):
        return shlex.quote(text)
    return text if simple else '"' + text.replace('"', '\\"') + '"'

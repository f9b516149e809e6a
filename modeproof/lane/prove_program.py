"""The command `prove-program`: its options. The room `programs` does the work."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.proofs import proofs_module


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `prove-program` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "prove-program",
        help="prove a PLC program equal to a target, or show where it differs",
        description="PROVED (0): equal outputs in every scan from power-up. REFUTED (1): the scans after "
        "which they differ. UNKNOWN (2): neither.",
    )
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help="ST, SCL, PLCopen XML or AWL")
    parser.add_argument("--target", metavar="T", help="a published target, as in vectors/")
    parser.add_argument("--unit", metavar="NAME", help="the block or program meant, if there are several")
    parser.add_argument("--binding", type=Path, metavar="TOML", help="names that do not agree; see the docs")
    parser.add_argument(
        "--wrap", action="store_true", help="integers wrap; without it they must not overflow"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the verdict there as well")
    parser.add_argument(
        "--seconds", type=float, default=300, metavar="S", help="limit of the search for pairs (300)"
    )
    parser.add_argument(
        "--property",
        type=Path,
        metavar="TOML",
        help="in the place of --target: properties of your own program",
    )
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Run it; the exit status is that of the verdict. Raises Unjudged."""
    try:
        importlib.import_module("tree_sitter_iec61131_3_st")
    except ImportError as error:
        raise Unjudged(f"programs cannot be read: {error}; `make venv` installs what is missing") from None
    if (args.target is None) == (args.property is None):
        raise Unjudged("prove-program: either --target T, or --property TOML for a program of your own")
    room = "command" if args.property is None else "property_command"
    return int(proofs_module(f"programs.{room}").run(args))

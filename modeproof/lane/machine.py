"""The command `machine`: its options. The room `programs` does the work."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.proofs import proofs_module
from modeproof.lane import machine_tlc


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `machine` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "machine",
        help="judge how the documents' blocks are wired to a machine",
        description="PROVED (0): each property is true after every scan, for every input. REFUTED (1): scans "
        "from power-up that break one. UNKNOWN (2): neither, or the file was refused. See "
        "docs/wire-your-machine.md.",
    )
    parser.add_argument(
        "file", nargs="?", type=Path, metavar="WIRING", help="yours; spec/machine_cell/wiring.toml without it"
    )
    parser.add_argument("--properties", type=Path, metavar="TOML", help="in the place of safety.toml there")
    parser.add_argument("--use", type=Path, metavar="TOML", help="in the place of use.toml there")
    parser.add_argument(
        "--seconds", type=float, default=120, metavar="S", help="limit of the proof, of CPU (120)"
    )
    parser.add_argument("--recheck", action="store_true", help="z3 and cvc5 judge the proof again")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the verdicts there as well")
    parser.add_argument(
        "--program", type=Path, metavar="FILE", help="write the machine as Structured Text there"
    )
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw the wiring there, as Mermaid")
    parser.add_argument("--model", type=Path, metavar="FILE", help="write the wiring as a TLA+ module there")
    parser.add_argument(
        "--tlc",
        nargs="?",
        const="",
        metavar="PART",
        help="TLC judges the blocks' contracts, and the wiring over them: runs with PART in their name",
    )
    parser.add_argument(
        "--trial",
        nargs="?",
        const="",
        metavar="PART",
        help="judge edits of the wiring whose name has PART in it",
    )
    parser.add_argument("--record", action="store_true", help="with --trial: write trial.toml")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Run it; the exit status is that of the verdicts. Raises Unjudged."""
    if args.record and args.trial != "":
        raise Unjudged("machine: --record goes with --trial and no PART: the record has every edit")
    try:
        importlib.import_module("tree_sitter_iec61131_3_st")
    except ImportError as error:
        raise Unjudged(f"a wiring cannot be read: {error}; `make venv` installs what is missing") from None
    if args.tlc is not None:
        return machine_tlc.run(args)
    return int(proofs_module("programs.machine_command").run(args))

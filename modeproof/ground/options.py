"""What commands have in common: the options --json and --quiet, and the result as JSON."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import root


def add_command(
    commands: Any, name: str, run: Callable[[argparse.Namespace], int]
) -> argparse.ArgumentParser:
    """Add a command with --json and --quiet."""
    parser: argparse.ArgumentParser = commands.add_parser(name)
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def write_json(args: argparse.Namespace, status: int, **content: Any) -> None:
    """Write the result where --json says. Raises Unjudged when it cannot be written."""
    if args.json is None:
        return
    text = json.dumps(
        {"command": args.command, "status": status, "tree": str(root()), **content},
        indent=1,
        ensure_ascii=False,
    )
    write_whole(args.json, (text + "\n").encode("utf-8"))

"""`python -m modeproof.kit conform ...`: the kit without the rest."""

from __future__ import annotations

import argparse
import sys

from modeproof.kit.kit_command import add_parser


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit status."""
    parser = argparse.ArgumentParser(prog="modeproof-kit")
    add_parser(parser.add_subparsers(dest="command", required=True, metavar="COMMAND"))
    args = parser.parse_args(argv)
    return int(args.run(args))


if __name__ == "__main__":
    sys.exit(main())

"""`python -m modeproof.kit conform ...`: the kit without the rest."""

from __future__ import annotations

import sys

from modeproof.kit.errors import Unjudged
from modeproof.kit.files import to_standard_output
from modeproof.kit.kit_command import EXIT_UNJUDGED, add_parser
from modeproof.kit.parser import Parser


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit status."""
    parser = Parser(prog="modeproof-kit", description="Judges a program by the vectors that are packed here.")
    add_parser(parser.add_subparsers(dest="command", required=True, metavar="conform"))
    try:
        args = parser.parse_args(argv)
        with to_standard_output(vars(args).values()):
            return int(args.run(args))
    except Unjudged as error:
        print(f"modeproof-kit: {error}", file=sys.stderr)
        return EXIT_UNJUDGED


if __name__ == "__main__":
    sys.exit(main())

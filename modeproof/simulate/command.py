"""The command `modeproof simulate`: a page in which the devices run and can be played with."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from modeproof.ground.errors import EXIT_AS_EXPECTED
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build
from modeproof.ground.places import root as repository_root
from modeproof.simulate.build import make

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """Add the command; `args.run(args)` returns 0 and raises Unjudged where the page cannot be made."""
    parser = subparsers.add_parser(
        "simulate",
        help="a page to play with: the reference implementation runs in the browser, offline",
        description="Writes one HTML file; a double click opens it. It runs the files of refimpl/ and shows "
        "recorded counterexamples as far as build/evidence/ and build/walks/ hold them. It proves nothing.",
    )
    parser.add_argument("--out", type=Path, metavar="FILE", help="where to (default: build/simulate.html)")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    html = make(place).encode("utf-8")
    file = args.out or build(place) / "simulate.html"
    write_whole(file, html)
    shown = html.count(b'data-recorded="')
    print(f"{file}: {len(html):,} bytes, {shown} recorded counterexamples; open it with a double click")
    return EXIT_AS_EXPECTED

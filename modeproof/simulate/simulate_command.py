"""The command `modeproof simulate`: a page in which the devices run and can be played with."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from modeproof.ground.errors import EXIT_AS_EXPECTED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build
from modeproof.ground.places import root as repository_root
from modeproof.simulate.build import make
from modeproof.simulate.picture import png, svg

STORY, STEP = "stale_confirmation", 9
"""What is shown where nothing else is asked for."""

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """Add the command; `args.run(args)` returns 0 and raises Unjudged where the page cannot be made."""
    parser = subparsers.add_parser(
        "simulate",
        description="Writes one HTML file; a double click opens it. It runs the files of refimpl/ and plays "
        "the recorded counterexample of each finding (simulate.html#finding=E-52). It proves nothing.",
    )
    parser.add_argument("--out", type=Path, metavar="FILE", help="where to (default: build/simulate.html)")
    parser.add_argument(
        "--picture",
        type=Path,
        metavar="FILE",
        help="a picture of a story as well: .svg shows all of it, .png the page at one step, by Chromium",
    )
    parser.add_argument("--story", default=STORY, metavar="ID", help=f"for --picture (default: {STORY})")
    parser.add_argument("--step", type=int, default=STEP, metavar="N", help=f"for a .png (default: {STEP})")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    if args.picture and args.picture.suffix not in (".png", ".svg"):
        raise Unjudged(f"{args.picture}: a picture is a .png or a .svg")
    html = make(place).encode("utf-8")
    file = args.out or build(place) / "simulate.html"
    write_whole(file, html)
    plays = len(set(re.findall(rb'data-play="([^"]*)"', html)))
    print(f"{file}: {len(html):,} bytes, {plays} recorded counterexamples; open it with a double click")
    if args.picture:
        moving = args.picture.suffix == ".svg"
        drawn = svg(place, args.story).encode() if moving else png(place, file, args.story, args.step)
        write_whole(args.picture, drawn)
        print(f"{args.picture}: {len(drawn):,} bytes, story {args.story}")
    return EXIT_AS_EXPECTED

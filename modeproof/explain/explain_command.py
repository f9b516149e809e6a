"""The command `explain`."""

from __future__ import annotations

import argparse
import shutil
import sys
import textwrap
from pathlib import Path
from typing import Any

from modeproof.explain.cards import card, head
from modeproof.explain.things import Thing, find, names
from modeproof.ground.errors import EXIT_AS_EXPECTED, Unjudged
from modeproof.ground.places import root
from modeproof.kit.errors import nearest

LABEL = 17
"""Columns of the labels."""
WIDTH = 100
NEAREST = 5
WHOLE = 3
"""So many things of one name are shown whole; of more there is a list."""


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0 and raises Unjudged for a word that nobody knows."""
    parser = commands.add_parser(
        "explain",
        description="Says of a clause, finding, property, assumption, run, theorem, target, signal, state, "
        "step, diagnostic code, verdict or word of the field what it is, where it is, and what was shown.",
        epilog="ids are in spec/ and in all pages; docs/reference.md has the words of verdicts",
    )
    parser.add_argument(
        "word", nargs="+", metavar="WORD", help="an id or a word; DOCUMENT/ID where two have it"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    word = " ".join(args.word)
    found = find(place, word)
    if not found:
        close = nearest(word.rpartition("/")[2], names(place), NEAREST)
        means = f"; nearest: {', '.join(close)}" if close else ""
        raise Unjudged(f"nothing here is called {word!r}{means}")
    if len(found) > WHOLE:
        print(f"{len(found)} things have this name; `modeproof explain DOCUMENT/{word}` shows one of them")
        for thing in found:
            print(head(thing))
        return _ended(place)
    width = min(shutil.get_terminal_size().columns, WIDTH) if sys.stdout.isatty() else WIDTH
    for number, thing in enumerate(found):
        print(("\n" if number else "") + text_of(thing, card(place, thing), max(width, 2 * LABEL)))
    return _ended(place)


def _ended(place: Path) -> int:
    """Say where the files are, to whoever is not in their tree."""
    here = Path.cwd()
    if place != here and place not in here.parents:
        print(f"\nfiles are below {place}")
    return EXIT_AS_EXPECTED


def text_of(thing: Thing, lines: list[tuple[str, str]], width: int) -> str:
    """The card as text: a head, then label and text; a label that is as before is not said again."""
    shown = [head(thing)]
    before = ""
    for label, text in lines:
        if not text:
            continue
        first = f"  {'' if label == before else label:<{LABEL}}"
        shown += textwrap.wrap(
            " ".join(text.split()),
            width,
            initial_indent=first,
            subsequent_indent=" " * len(first),
            break_on_hyphens=False,
            break_long_words=False,
        )
        before = label or before
    return "\n".join(shown)

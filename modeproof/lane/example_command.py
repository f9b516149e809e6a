"""The command `example`: copies a file of examples/ to the current folder, so that one can begin with it."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_AS_EXPECTED, Unjudged, suggestion
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import machines, root

FOLDERS = ("st", "logs", "machines")
KINDS = {".st", ".scl", ".csv", ".jsonl", ".toml"}
MACHINE = ("wiring.toml", "safety.toml", "use.toml")


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0 and raises Unjudged."""
    parser = commands.add_parser("example", epilog="nothing is overwritten")
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="a file of the list; without a name: the list"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """List the examples, or copy those that are named: all or none."""
    place = root()
    known = {path.name: path for path in _files(place)}
    if not args.names:
        print("\n".join(f"{name:<28} {path.relative_to(place).as_posix()}" for name, path in known.items()))
    for name in args.names:
        if name not in known:
            raise Unjudged(f"no example {name!r}; {suggestion(name, known)}")
        if Path(name).exists():
            raise Unjudged(f"{name} is here already; it was left alone")
    for name in args.names:
        write_whole(Path(name), known[name].read_bytes())
        print(f"wrote {name}")
    return EXIT_AS_EXPECTED


def _files(place: Path) -> Iterator[Path]:
    for folder in FOLDERS:
        yield from sorted(path for path in (place / "examples" / folder).glob("*") if path.suffix in KINDS)
    for machine in machines(place):
        yield from (place / "spec" / machine / name for name in MACHINE)

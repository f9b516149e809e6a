"""The command `init`: writes a project file from what a folder holds, and says what it could not list."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import PROJECT_FILE
from modeproof.ground.solvers import needing_solvers
from modeproof.kit.errors import plain
from modeproof.project.file import VERSION
from modeproof.project.found import look

if TYPE_CHECKING:
    from modeproof.project.blocks import Fit
    from modeproof.project.proposals import Proposal

HEAD = f"""\
# What is ours, and by what each is judged. `modeproof judge` judges all of it; docs/your-project.md says what
# else it may have. Paths are from the folder of this file.
version = {VERSION}
"""
LINE = 160
"""Characters of a line that is printed."""


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `init` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "init",
        description="Look through this folder for programs (ST, SCL, AWL, PLCopen XML), wirings, properties "
        f"and logs, and write {PROJECT_FILE}: an entry for each that fits. An existing one is left alone.",
        epilog="exit status: 0 it is written, 2 it is not",
    )
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Write the file, and say what was found. Raises Unjudged; then nothing is written."""
    folder = Path.cwd()
    path = folder / PROJECT_FILE
    if path.exists() or path.is_symlink():
        raise Unjudged(
            f"{PROJECT_FILE} is here already, and it is left as it is: `modeproof judge` judges what it "
            "lists; to see what `init` would write now, rename it first"
        )
    found = look(folder)
    with needing_solvers():
        from modeproof.project.proposals import Proposals
    terminal = sys.stderr.isatty() and not args.quiet

    def tell(name: str) -> None:
        if terminal:
            print(f"\r{name[:100]:<100}", end="", file=sys.stderr, flush=True)

    made = Proposals(found, tell)
    made.make()
    if terminal:
        print(f"\r{'':<100}\r", end="", file=sys.stderr, flush=True)
    if not made.entries:
        for line in _not_listed(made.others):
            print(line)
        raise Unjudged(
            f"nothing here fits a target, so no {PROJECT_FILE} was written; docs/your-project.md says how "
            "one is written by hand"
        )
    write_whole(path, "\n".join([HEAD, *(text_of(entry) for entry in made.entries)]).encode())
    count = len(made.entries)
    print(f"{PROJECT_FILE} is written, with {count} {'entry' if count == 1 else 'entries'}:")
    width = max(len(f"{entry.kind}.{entry.name}") for entry in made.entries)
    for entry in made.entries:
        print(f"  {f'{entry.kind}.{entry.name}':<{width}}  {plain(entry.said, 1000)}")
    for line in _not_listed(made.others):
        print(line)
    if any(entry.fit is not None and entry.fit.empty for entry in made.entries):
        print(f"next: write the empty names in {PROJECT_FILE}, then `modeproof judge`")
    else:
        print("next: modeproof judge")
    return 0


def _not_listed(others: Mapping[str, str]) -> Iterator[str]:
    if others:
        yield "found, and not listed:"
    for name, why in sorted(others.items()):
        said = why.removeprefix(f"{name}: ")
        yield f"  {plain(f'{name}: {said}', LINE)}"


def text_of(entry: Proposal) -> str:
    """An entry as TOML."""
    lines = [
        f"[{entry.kind}.{entry.name}]",
        *(f"{key} = {_toml(value)}" for key, value in entry.keys.items()),
    ]
    if entry.fit is not None:
        lines += _binding(f"{entry.kind}.{entry.name}", entry.fit)
    return "\n".join([*lines, ""])


def _binding(head: str, fit: Fit) -> Iterator[str]:
    """The names that are bound, and those that are still to be written."""
    if fit.why:
        yield f"# as it is it will be refused: {plain(fit.why)}"
    if fit.spare:
        yield f"# inputs of {fit.unit.name} that no signal of {fit.target} took: {', '.join(fit.spare)}"
    yield ""
    yield f"[{head}.binding.names]  # {fit.target} = {fit.unit.name}: look whether each pair is meant"
    for signal, name in fit.names.items():
        yield f"{signal} = {_toml(name)}"
    for signal, could in fit.empty.items():
        which = f"one of {', '.join(could)}" if could else f"{fit.unit.name} has none left"
        instead = ""
        if signal in fit.outputs:
            instead = f'; or take it out here, and write [{head}.binding] left_out = ["{signal}"] above'
        yield f'{signal} = ""  # {which}{instead}'


def _toml(value: str | list[str]) -> str:
    return json.dumps(value, ensure_ascii=False)

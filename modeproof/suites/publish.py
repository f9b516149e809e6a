"""The room vectors/: the fast suites of every published target, as files that are kept with the project.

A developer needs neither TLC nor this tool to read them: JSON Lines, packed by gzip, and the schema beside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meaning
from modeproof.kit.vectors import FILE_NAME
from modeproof.registers.vector_files import ROOM, of_machine, seal
from modeproof.suites.build import suite_file
from modeproof.suites.kinds import SUITES
from modeproof.suites.lint import lint

SCHEMA = "vectors.schema.json"


@dataclass(frozen=True)
class Published:
    """What happened to the files of the room, by their paths relative to the root."""

    written: tuple[str, ...]
    kept: tuple[str, ...]
    removed: tuple[str, ...]


def publish(place: Path, targets: Mapping[str, str], whole: bool = True) -> Published:
    """Bring the room up to date with the suites of `targets` (target to document), which have been built.

    A file with the same lines is left as it is: what packs them may pack otherwise on another machine. With
    `whole` these are all targets that there are, so that files of others are removed. Raises Unjudged where a
    file cannot be written.
    """
    wanted: dict[Path, Path] = {Path(__file__).with_name(SCHEMA): place / ROOM / SCHEMA}
    for target, document in sorted(targets.items()):
        for name, about in SUITES.items():
            source = suite_file(place, document, target, name)
            if about.published and source.is_file():
                wanted[source] = place / ROOM / target / FILE_NAME.format(suite=name)
    written, kept = [], []
    for source, path in wanted.items():
        shown = path.relative_to(place).as_posix()
        if path.suffix == ".gz" and (problems := lint(source)):
            raise Unjudged(f"{shown} is not published: {problems[0]}; delete {source} and try again")
        if path.is_file() and _same(source, path):
            kept.append(shown)
        else:
            write_whole(path, source.read_bytes())
            written.append(shown)
    removed = []
    for path in sorted((place / ROOM).rglob(FILE_NAME.format(suite="*"))):
        if path not in wanted.values() and (whole or path.parent.name in targets) and not of_machine(path):
            path.unlink()
            removed.append(path.relative_to(place).as_posix())
    seal(place, targets)
    return Published(tuple(written), tuple(kept), tuple(removed))


def _same(path: Path, other: Path) -> bool:
    if path.name == SCHEMA:
        return path.read_bytes() == other.read_bytes()
    return meaning(path) == meaning(other)

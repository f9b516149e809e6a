"""What a project file names outside of itself: files that are there, and targets that exist."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from modeproof.ground.errors import suggestion
from modeproof.ground.places import documents, machines, root
from modeproof.project.entries import Adapter, Log, Program
from modeproof.project.file import Listed, Project
from modeproof.registers.load import load_interface
from modeproof.trace.targets import targets_of


def problems_of(project: Project, entries: Sequence[Listed]) -> Iterator[str]:
    """Each file that is gone and each target that there is none of, with its place."""
    for entry in entries:
        row = entry.row
        for key, path in row.paths():
            whole = project.folder / path
            if key == "vectors" and whole.is_dir():
                continue
            if not whole.is_file():
                what = (
                    "is a folder; name its files"
                    if whole.is_dir()
                    else f"is not in {project.folder}; correct the path"
                )
                yield f"{project.at(entry, key)}: {path} {what}"
        if isinstance(row, Program | Adapter | Log) and row.target is not None:
            known = targets()[row.KIND]
            if row.target not in known:
                cause = f"no target {row.target!r}; {suggestion(row.target, known)}"
                yield f"{project.at(entry, 'target')}: {cause}"
            elif isinstance(row, Log) and row.wiring is not None and row.target not in machines(root()):
                cause = f"belongs to a log of a machine ({', '.join(machines(root()))})"
                yield f"{project.at(entry, 'wiring')}: {cause}, and {row.target} is none"


@cache
def targets() -> dict[str, tuple[str, ...]]:
    """The targets of each kind of entry."""
    place = root()
    published = [
        name
        for document in documents(place)
        if (place / "spec" / document / "interface.toml").is_file()
        for name, device in load_interface(place, document).devices.items()
        if device.published
    ]
    logs = [target.id for document in documents(place) for target in targets_of(place, document)]
    return {
        Program.KIND: tuple(published),
        Adapter.KIND: (*published, *machines(place)),
        Log.KIND: (*logs, *machines(place)),
    }

"""What the page carries: Brython from its package, and the Python modules that it runs, unchanged."""

from __future__ import annotations

from importlib import metadata, resources
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import adding

HERE = Path(__file__).parent


def brython() -> tuple[str, str]:
    """The script of Brython, and its notice. Raises Unjudged where it is not installed."""
    try:
        text = resources.files("brython").joinpath("data", "brython.js").read_text(encoding="utf-8")
        version = metadata.version("brython")
    except (ModuleNotFoundError, OSError) as error:
        raise Unjudged(f"Brython cannot be read: {error}; {adding('simulate', 'brython')}") from None
    return text, f"Brython {version}, BSD-3-Clause, Copyright (c) 2012 Pierre Quentel, https://brython.info"


def modules(place: Path) -> dict[str, list[object]]:
    """Every module that the page can import, as Brython wants it: kind, text, imports, and 1 for a package.

    Raises Unjudged where a folder of them holds none.
    """
    found: dict[str, list[object]] = {name: _module("", True) for name in ("modeproof", "modeproof.simulate")}
    rooms = ((place / "refimpl", place), (place / "scenes", place), (HERE / "program", HERE.parents[1]))
    for folder, base in (*rooms, (HERE / "standard_library", HERE / "standard_library")):
        files = sorted(folder.rglob("*.py"))
        if not files:
            raise Unjudged(f"{folder}: no Python here; the page runs it")
        for path in files:
            name, package = path.relative_to(base).with_suffix("").as_posix(), path.stem == "__init__"
            name = name.removesuffix("/__init__").replace("/", ".")
            if name != "__init__":
                found[name] = _module(path.read_text(encoding="utf-8"), package)
    return found


def _module(text: str, package: bool) -> list[object]:
    return [".py", text, [], 1] if package else [".py", text, []]

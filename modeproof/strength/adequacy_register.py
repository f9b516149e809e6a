"""The register adequacy.toml: why a mutant that every suite lets pass does so, given by a person."""

from __future__ import annotations

import tomllib
from pathlib import Path

from modeproof.errors import Unjudged
from modeproof.strength.register import Explained, read_explained, refuse_unknown


def register_path(place: Path, document: str) -> Path:
    """Where the register lies."""
    return place / "refimpl" / document / "adequacy.toml"


def read_explanations(place: Path, document: str) -> tuple[Explained, ...]:
    """Read the register; none where there is no file. Raises Unjudged for whatever is not understood."""
    path = register_path(place, document)
    source = path.relative_to(place).as_posix()
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise Unjudged(f"{source}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None
    refuse_unknown(source, data, {"survivor"})
    rows = data.get("survivor", [])
    if not isinstance(rows, list) or not all(isinstance(one, dict) for one in rows):
        raise Unjudged(f"{source}: `survivor` must be a list of tables ([[survivor]])")
    return tuple(read_explained(source, values) for values in rows)

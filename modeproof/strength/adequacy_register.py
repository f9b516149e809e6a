"""The register adequacy.toml: which suites judge, and why what they all let pass does so, by a person."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from modeproof.errors import Unjudged
from modeproof.strength.register import Explained, read_explained, refuse_unknown


def register_path(place: Path, document: str) -> Path:
    """Where the register lies."""
    return place / "refimpl" / document / "adequacy.toml"


@dataclass(frozen=True)
class Register:
    """The suites that judge (empty: every suite that there is), and the explanations."""

    suites: tuple[str, ...] = ()
    explained: tuple[Explained, ...] = ()


def read_register(place: Path, document: str) -> Register:
    """Read the register; empty where there is no file. Raises Unjudged for whatever is not understood."""
    path = register_path(place, document)
    source = path.relative_to(place).as_posix()
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return Register()
    except OSError as error:
        raise Unjudged(f"{source}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None
    refuse_unknown(source, data, {"suites", "survivor"})
    suites, rows = data.get("suites", []), data.get("survivor", [])
    if not isinstance(suites, list) or not all(isinstance(one, str) for one in suites):
        raise Unjudged(f"{source}: `suites` must be a list of names")
    if not isinstance(rows, list) or not all(isinstance(one, dict) for one in rows):
        raise Unjudged(f"{source}: `survivor` must be a list of tables ([[survivor]])")
    return Register(tuple(suites), tuple(read_explained(source, values) for values in rows))

"""What a TLC configuration file checks.

Only the part of the syntax that a judgement needs is read: which invariants and properties are checked, and
whether the text holds a keyword that TLC 2.15 does not know (such a file would be judged on words that TLC
never saw).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from modeproof.errors import Unjudged

_INVARIANT = {"INVARIANT", "INVARIANTS"}
_PROPERTY = {"PROPERTY", "PROPERTIES"}
_OTHER = {
    "CONSTANT",
    "CONSTANTS",
    "INIT",
    "NEXT",
    "SPECIFICATION",
    "SYMMETRY",
    "VIEW",
    "CONSTRAINT",
    "CONSTRAINTS",
    "ACTION_CONSTRAINT",
    "ACTION_CONSTRAINTS",
    "ACTION-CONSTRAINT",
    "ACTION-CONSTRAINTS",
    "TYPE",
    "TYPE_CONSTRAINT",
}
_UNKNOWN = {"CHECK_DEADLOCK", "ALIAS", "POSTCONDITION", "_POSSIBLE", "_PERIODIC"}
_KEYWORDS = _INVARIANT | _PROPERTY | _OTHER
COMMENT = re.compile(r"\\\*[^\n]*|\(\*.*?\*\)", re.DOTALL)
_TOKEN = re.compile(r'"[^"\n]*"|<-|[^\s]+')


@dataclass(frozen=True)
class Cfg:
    """The checked names of one configuration file, in the order of the file."""

    invariants: tuple[str, ...]
    properties: tuple[str, ...]
    view: bool
    symmetry: bool

    @property
    def checked(self) -> tuple[str, ...]:
        """All checked names: invariants first, then properties."""
        return self.invariants + self.properties


def parse_cfg(text: str, name: str) -> Cfg:
    """Read the text of a cfg; `name` is used in errors only.

    Raises Unjudged for a keyword that TLC 2.15 does not know.
    """
    invariants: list[str] = []
    properties: list[str] = []
    seen: set[str] = set()
    section = ""
    for match in _TOKEN.finditer(COMMENT.sub(" ", text)):
        token = match.group()
        if token in _UNKNOWN:
            raise Unjudged(f"{name}: {token} is not understood by TLC 2.15")
        if token in _KEYWORDS:
            section = token
            seen.add(token)
        elif section in _INVARIANT:
            invariants.append(token)
        elif section in _PROPERTY:
            properties.append(token)
    return Cfg(
        invariants=tuple(invariants),
        properties=tuple(properties),
        view="VIEW" in seen,
        symmetry="SYMMETRY" in seen,
    )

"""The constants that a TLC configuration file gives to its model; in particular the readings that it
restores.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.registers.files import read_text

_COMMENT = re.compile(r"\\\*[^\n]*|\(\*.*?\*\)", re.DOTALL)
_SECTION = re.compile(
    r"^[ \t]*(CONSTANTS?|INIT|NEXT|SPECIFICATION|SYMMETRY|VIEW|INVARIANTS?|PROPERT(?:Y|IES)|"
    r"(?:ACTION[_-])?CONSTRAINTS?)\b",
    re.MULTILINE,
)
_VIEW = re.compile(r"^[ \t]*VIEW\s+([A-Za-z_]\w*)", re.MULTILINE)
_GIVEN = re.compile(r"([A-Za-z_]\w*)\s*(=|<-)\s*")
_TEXT = re.compile(r'"([^"\n]*)"')


@dataclass(frozen=True)
class Constant:
    """What a constant is given: an expression, or (`named`) the name of a definition of the model."""

    text: str
    named: bool


def constants_of(text: str) -> Mapping[str, Constant]:
    """The constants of the text of a cfg, by name, in its order."""
    bare = _COMMENT.sub(" ", text)
    marks = list(_SECTION.finditer(bare))
    found: dict[str, Constant] = {}
    for mark, after in zip(marks, [*marks[1:], None], strict=True):
        if mark.group(1).startswith("CONSTANT") and not mark.group(1).startswith("CONSTRAINT"):
            section = bare[mark.end() : after.start() if after else len(bare)]
            starts = list(_GIVEN.finditer(section))
            for one, follower in zip(starts, [*starts[1:], None], strict=True):
                value = section[one.end() : follower.start() if follower else len(section)]
                found[one.group(1)] = Constant(" ".join(value.split()), one.group(2) == "<-")
    return found


def view_of(text: str) -> str:
    """The name of the view that a cfg gives; "" where it gives none."""
    found = _VIEW.search(_COMMENT.sub(" ", text))
    return found.group(1) if found is not None else ""


def read_constants(root: Path, document: str, cfg: str) -> Mapping[str, Constant]:
    """The constants of spec/<document>/<cfg>. Raises Unjudged when the file cannot be read."""
    return constants_of(read_text(root, root / "spec" / document / cfg))


def restored(constants: Mapping[str, Constant], literal: str) -> frozenset[str]:
    """The readings that a cfg restores: the texts in its constant `literal`."""
    given = constants.get(literal)
    return frozenset(_TEXT.findall(given.text)) if given is not None else frozenset()

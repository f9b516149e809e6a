"""The configuration files of TLC: read, changed, and written."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from modeproof.ground.errors import Unjudged

_SECTIONS = {
    "CONSTANT": "constants",
    "CONSTANTS": "constants",
    "INVARIANT": "invariants",
    "INVARIANTS": "invariants",
    "PROPERTY": "properties",
    "PROPERTIES": "properties",
    "CONSTRAINT": "constraints",
    "CONSTRAINTS": "constraints",
    "ACTION_CONSTRAINT": "action_constraints",
    "ACTION_CONSTRAINTS": "action_constraints",
    "ACTION-CONSTRAINT": "action_constraints",
    "ACTION-CONSTRAINTS": "action_constraints",
    "INIT": "init",
    "NEXT": "next",
    "SPECIFICATION": "specification",
    "SYMMETRY": "symmetry",
    "VIEW": "view",
    "TYPE": "other",
    "TYPE_CONSTRAINT": "other",
}
_UNKNOWN = {"CHECK_DEADLOCK", "ALIAS", "POSTCONDITION", "_POSSIBLE", "_PERIODIC"}
COMMENT = re.compile(r"\\\*[^\n]*|\(\*.*?\*\)", re.DOTALL)
_TOKEN = re.compile(r'"[^"\n]*"|<-|[^\s]+')
_GIVEN = re.compile(r"([A-Za-z_]\w*)\s*(=|<-)\s*")


@dataclass(frozen=True)
class Constant:
    """What a constant is given: an expression, or (`named`) the name of a definition of the model."""

    text: str
    named: bool

    @property
    def sign(self) -> str:
        """What is between the name and the text."""
        return "<-" if self.named else "="


@dataclass(frozen=True)
class Cfg:
    """What one configuration file says; names are in the order of the file."""

    constants: Mapping[str, Constant] = field(default_factory=dict)
    invariants: tuple[str, ...] = ()
    properties: tuple[str, ...] = ()
    constraints: tuple[str, ...] = ()
    action_constraints: tuple[str, ...] = ()
    init: str = ""
    next: str = ""
    specification: str = ""
    symmetry: str = ""
    view: str = ""

    @property
    def checked(self) -> tuple[str, ...]:
        """All checked names: invariants first, then properties."""
        return self.invariants + self.properties

    def text(self) -> str:
        """The text of such a file."""
        given = [f"    {name} {constant.sign} {constant.text}" for name, constant in self.constants.items()]
        lines = ["CONSTANTS", *given] if given else []
        for word in ("INIT", "NEXT", "SPECIFICATION", "SYMMETRY", "VIEW"):
            if value := getattr(self, word.lower()):
                lines.append(f"{word} {value}")
        for word in ("CONSTRAINTS", "ACTION_CONSTRAINTS", "INVARIANTS", "PROPERTIES"):
            if names := getattr(self, word.lower()):
                lines.append(f"{word} {' '.join(names)}")
        return "\n".join(lines) + "\n"


def parse_cfg(text: str, name: str) -> Cfg:
    """Read the text of a cfg; `name` is used in errors only.

    Raises Unjudged for a keyword that TLC 2.15 does not know: such a file would be judged on words that TLC
    never saw.
    """
    bare = COMMENT.sub(" ", text)
    lists: dict[str, list[str]] = {key: [] for key in _SECTIONS.values()}
    constants = ""
    section = ""
    end = 0
    for match in _TOKEN.finditer(bare):
        token = match.group()
        if token in _UNKNOWN:
            raise Unjudged(f"{name}: {token} is not understood by TLC 2.15")
        if token in _SECTIONS:
            section = _SECTIONS[token]
            constants += " "
        elif section == "constants":
            constants += bare[end : match.start()] + token
        elif section:
            lists[section].append(token)
        end = match.end()
    single = {key: " ".join(lists[key]) for key in ("init", "next", "specification", "symmetry", "view")}
    return Cfg(
        constants=_constants(constants),
        invariants=tuple(lists["invariants"]),
        properties=tuple(lists["properties"]),
        constraints=tuple(lists["constraints"]),
        action_constraints=tuple(lists["action_constraints"]),
        **single,
    )


def _constants(section: str) -> dict[str, Constant]:
    starts = list(_GIVEN.finditer(section))
    found = {}
    for start, follower in zip(starts, [*starts[1:], None], strict=False):
        value = section[start.end() : follower.start() if follower else len(section)]
        found[start.group(1)] = Constant(" ".join(value.split()), start.group(2) == "<-")
    return found

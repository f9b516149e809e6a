"""The suites that judge, in the order of asking, each with a hash of what it demands of a program."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import Suite, read_lines

_HEADER = ("target", "inputs", "outputs")
"""What of a header says how cases are to be read; the rest says where they come from and what they cite."""
_DEMANDS = b'"params":'
"""In the line of a case all from here on is sent or compared; before it stands what it cites."""


@dataclass(frozen=True)
class Published:
    """A suite of one target as it is published; `contents` is a hash of what it demands."""

    suite: Suite
    contents: str

    @property
    def name(self) -> str:
        """The suite's name."""
        return self.suite.name

    @property
    def target(self) -> str:
        """Its target."""
        return self.suite.target


def published(suites: Sequence[Suite]) -> tuple[Published, ...]:
    """The suites, those of the same name together, the shortest name first. Raises Unjudged."""
    cost: dict[str, int] = {}
    for suite in suites:
        cost[suite.name] = cost.get(suite.name, 0) + suite.scan_count
    ordered = sorted(suites, key=lambda suite: (cost[suite.name], suite.name))
    return tuple(Published(suite, contents(suite.path)) for suite in ordered)


def contents(path: Path) -> str:
    """A hash of what the cases of a vector file send and demand. Raises Unjudged."""
    found = hashlib.sha256()
    try:
        lines = read_lines(path)
        header = json.loads(next(lines))
        found.update(json.dumps([header[key] for key in _HEADER], sort_keys=True).encode())
        for line in lines:
            _, mark, demands = line.partition(_DEMANDS)
            found.update(demands if mark else line)
    except (KitUnjudged, StopIteration, ValueError, KeyError, TypeError) as error:
        raise Unjudged(f"{path.name}: cannot be read: {type(error).__name__}: {error}") from None
    return found.hexdigest()[:16]

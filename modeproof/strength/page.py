"""Renders docs/strength.md from the results."""

from __future__ import annotations

from collections.abc import Sequence

from modeproof.errors import Unjudged
from modeproof.strength.judge import Bench
from modeproof.strength.mutant import Mutant
from modeproof.strength.results import Results


def render(bench: Bench, every: Sequence[Mutant], results: Results) -> int:
    """Not yet there."""
    raise Unjudged("the page is not rendered yet")

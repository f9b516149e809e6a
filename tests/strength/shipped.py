"""What is asked of the documents of this repository, parsed once for all tests of the room."""

from __future__ import annotations

from functools import cache

from modeproof.ground.places import root
from modeproof.strength.by_properties import ByProperties
from modeproof.strength.mutant import Mutant
from modeproof.strength.mutant_judge import Bench
from modeproof.strength.register import load_strength
from modeproof.tlc.toolchain import find_toolchain


@cache
def bench_of(document: str) -> Bench:
    """The bench of a document; it keeps the parse trees of its modules."""
    return Bench(root(), load_strength(root(), document), find_toolchain())


@cache
def mutants_of(document: str) -> tuple[Mutant, ...]:
    """All its mutants."""
    return ByProperties(bench_of(document)).mutants

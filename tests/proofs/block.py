"""Theorems about a function block on trial: by faults that are planted in copies of its code."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from types import ModuleType

from modeproof.ground.places import root
from modeproof.registers import load_document
from modeproof.registers.demands import MODULE
from proofs.sentences import Judge, Sentence
from proofs.solvers import ask_z3
from proofs.theorem import Query, Theorem
from tests.any_machine import LONG_MS
from tests.proofs.planted_steps import begun_in, planted, refuted


@dataclass(frozen=True)
class Planted:
    """A fault that a theorem refutes: `name` is the property that it proves, or what it speaks of; scans from
    `control` break the sentence in a copy of the code with the edits.
    """

    name: str
    judge: Judge
    control: str
    sentence: Sentence
    edits: list[tuple[str, str]]

    def refuted(self) -> bool:
        """The sentence is false in the copy, with an example that happens."""
        with planted(self.judge.device, *self.edits) as device:
            scan = begun_in(device, self.control)
            judge = replace(self.judge, device=device, explored=(scan,))
            return refuted(judge, self.sentence, self.control)

    def refuted_unplanted(self) -> bool:
        """The sentence is false in the shipped code."""
        return refuted(self.judge, self.sentence, self.control)


def named(*modules: ModuleType) -> set[str]:
    """The properties that the theorems of these modules prove."""
    found = [one for module in modules for one in vars(module).values() if isinstance(one, Theorem)]
    return {name for one in found for name in one.properties}


def decided(document: str) -> set[str]:
    """The properties of what we decided, without the demands of the page that TLC judges beside them."""
    return {one.id for one in load_document(root(), document).properties if not one.module.endswith(MODULE)}


def wrong_answers(queries: Iterable[Query]) -> list[str]:
    """Those questions that are not answered as expected."""
    return [one.name for one in queries if ask_z3(one, "", LONG_MS).answer != one.expected]

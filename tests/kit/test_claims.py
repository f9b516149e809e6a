"""The kit's judge does what tests/kit/claims.py says, and each of its mutants breaks a claim."""

from __future__ import annotations

import ast
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from modeproof.strength.mutant import Mutant, applied
from modeproof.strength.python_module import Module
from modeproof.strength.python_operators import PythonRule, python_mutants
from tests.kit.claims import CLAIMS, Kit, judge_with

KIT = Path(__file__).resolve().parents[2] / "modeproof" / "kit"
FILES = {"judge": "suite_judge", "relation": "relation", "verdict": "verdict"}
"""The files that are edited, by the names that their mutants have."""
LONGEST_S = 8
"""An edit that makes the judge wait for ever is noticed by this; all claims take a third of a second."""


class WithMethods(Module):
    """A module of which methods are edited too."""

    @property
    def functions(self) -> dict[str, ast.FunctionDef]:
        found = dict(super().functions)
        for statement in self.tree.body:
            if isinstance(statement, ast.ClassDef):
                methods = [part for part in statement.body if isinstance(part, ast.FunctionDef)]
                found |= {f"{statement.name}.{method.name}": method for method in methods}
        return found


def mutants(name: str) -> list[Mutant]:
    """The mutants by rule of a module of the kit, but for what only has to do with types."""
    module = WithMethods(name, (KIT / f"{FILES[name]}.py").read_text(encoding="utf-8"))
    found = python_mutants(module, module.functions, frozenset(), PythonRule())
    return [
        one.mutant
        for one in found
        if "None" not in one.mutant.old or one.mutant.operator != "operator swapped"
    ]


class TooLong(BaseException):
    """The claims did not come to an end."""


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    def stop(*_: Any) -> None:
        raise TooLong

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def broken(name: str, text: str) -> str:
    """The first claim that a judge with this text breaks; nothing where it breaks none."""
    try:
        with at_most(LONGEST_S), judge_with({FILES[name]: text}) as kit:
            for claim in CLAIMS:
                try:
                    claim(kit)
                except Exception:
                    return claim.__name__
    except TooLong:
        return "it does not end"
    except Exception:
        return "it cannot be read"
    return ""


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.__name__)
def test_the_judge_keeps(claim: Callable[[Kit], None]) -> None:
    with judge_with({}) as kit:
        claim(kit)


EXPLAINED: dict[str, str] = {
    "times by the clock, and how long something waits": """
        judge-51393391 judge-bab97deb judge-04bb6755 judge-8e095e5a judge-ad9faa06 judge-ccc32c17
        judge-1fbaf871
        relation-4bbeee97 relation-34d841e7 relation-3f948da3 relation-faeec462 relation-098fba2c""",
    "patience without a budget: more scans than is needed, and no verdict is weaker": """
        relation-8667e43e""",
    "a verdict that is not DIFFERS has a reason, or no difference": """
        judge-31ae0bf1 judge-57a299fa judge-0fa96af2 judge-0e372bdf""",
    "two questions that are not both answered with yes, in the other order": """
        judge-4c8a10ee judge-e4e856fa judge-b3c53dba judge-321d362f judge-0aa40231 judge-32236298
        judge-62b8dade""",
    "the first scan of a case always shows, so at least one transition does": """
        judge-67d562b3 judge-3110d602 judge-3bf9771d judge-13bcc697""",
    "a way round that saves time and gives the same": """
        judge-a6cbaa63 judge-3d2572a6
        relation-390f382c relation-acf0ce47 relation-799728df relation-01166de2 relation-911dcd1c
        relation-14ce80a2 relation-b2184386 relation-177d0f58 relation-9869fb3f relation-c2f377b6
        relation-f312b4ca""",
    "an earlier line has refused what is refused here": """
        relation-2f1e4733 relation-583612d5 relation-95dd6238 relation-8d1ce505
        relation-08623fe1
        relation-eeff641a""",
    "it stands in no message and no verdict": """
        relation-cd0b4e00 relation-78915529 relation-5d547c50 relation-5910364b relation-00dad8c3
        relation-07c1c148 judge-a44b9cdd judge-05709487 judge-11ce6320""",
    "a machine's own vectors (tests/kit/test_machine_parameters.py), real time, and rules over the past": """
        judge-014c99c6 judge-92022dd9 judge-42122110 judge-f01247d5""",
}
"""The mutants that break no claim, by the reason."""


# A mutant may let a thread of the judge die
@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.deep
@pytest.mark.parametrize("name", ["judge", "relation", "verdict"])
def test_each_mutant_of_the_judge_breaks_a_claim(name: str) -> None:
    lines = (KIT / f"{FILES[name]}.py").read_text(encoding="utf-8").splitlines()
    ids = {id for those in EXPLAINED.values() for id in those.split() if id.startswith(name)}
    every = {one.id: one for one in mutants(name)}
    assert ids <= set(every), "an explanation of a mutant that is gone"
    left = [
        str(one) for id, one in every.items() if id not in ids and not broken(name, applied(lines, one.edit))
    ]
    assert left == [], "these break no claim"


def test_a_step_too_few_is_noticed() -> None:
    """The fault that all tests of the kit once let pass: of several scans the last one is not looked at."""
    text = (KIT / "suite_judge.py").read_text(encoding="utf-8")
    right, short = "range(failure.first, failure.at + 1):", "range(failure.first, failure.at):"
    assert right in text
    assert broken("judge", text) == ""
    assert broken("judge", text.replace(right, short)) == "settled_names_the_steps_over_several_scans"

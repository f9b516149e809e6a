"""The kit's judge does what tests/kit/claims.py says, and each of its mutants breaks a claim."""

from __future__ import annotations

import ast
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from modeproof.strength.mutant import Mutant
from modeproof.strength.python_module import Module
from modeproof.strength.python_operators import PythonRule, python_mutants
from tests.kit.claims import CLAIMS, Kit, judge_with

KIT = Path(__file__).resolve().parents[2] / "modeproof" / "kit"
LONGEST_S = 20
"""An edit that makes the judge wait for ever is noticed by this; the claims together take two seconds."""


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
    module = WithMethods(name, (KIT / f"{name}.py").read_text(encoding="utf-8"))
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
        with at_most(LONGEST_S), judge_with({name: text}) as kit:
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

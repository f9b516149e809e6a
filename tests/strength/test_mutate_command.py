"""Which mutants a campaign is asked for: whoever names one that is not there is told so."""

from __future__ import annotations

from argparse import Namespace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutate_command import chosen_of

MUTANTS = [
    SimpleNamespace(id=f"{module}-{n}", module=module) for module in ("Lamp", "Bell") for n in range(2)
]


def chosen(modules: list[str], *only: str) -> list[str]:
    args = Namespace(what="spec", modules=modules, show=None, only=list(only) or None)
    return [mutant.id for mutant in chosen_of(cast(Any, SimpleNamespace(mutants=MUTANTS)), args)]


def test_modules_and_patterns_choose_together() -> None:
    assert chosen([]) == ["Lamp-0", "Lamp-1", "Bell-0", "Bell-1"]
    assert chosen(["Lamp", "Bell"], "*-1") == ["Lamp-1", "Bell-1"]
    assert chosen(["Lamp"], "Lamp-*") == ["Lamp-0", "Lamp-1"]


@pytest.mark.parametrize(
    "modules, only, said",
    [
        (["Lamp", "Gong"], [], "Gong is not mutated"),
        (["Lamp"], ["Bell-*"], "no mutant has the id Bell-"),
        (["Lamp", "Bell"], ["Lamp-*"], "no mutant of Bell has the id Lamp-"),
    ],
)
def test_a_name_without_mutants_is_refused(modules: list[str], only: list[str], said: str) -> None:
    with pytest.raises(Unjudged, match=said):
        chosen(modules, *only)

"""One toy document for all tests of this room that need TLC."""

from __future__ import annotations

import pytest

from modeproof.strength.by_properties import ByProperties
from modeproof.strength.mutant import Mutant
from modeproof.strength.mutant_judge import Bench
from tests.strength.toy import lamp


@pytest.fixture(scope="session")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return lamp(tmp_path_factory.mktemp("lamp"))


@pytest.fixture(scope="session")
def every(bench: Bench) -> tuple[Mutant, ...]:
    return ByProperties(bench).mutants

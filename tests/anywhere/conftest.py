"""What the tests of an installed tool share."""

from __future__ import annotations

import pytest

from tests.anywhere.installed import Installed, install


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The tool, installed once for all of them."""
    return install(tmp_path_factory.mktemp("installed"))

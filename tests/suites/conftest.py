"""Short suites `soak`: the long one has a test of its own."""

from __future__ import annotations

import pytest

from modeproof.suites import soak


@pytest.fixture(autouse=True)
def short_soak(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(soak, "MOST", 400)
    monkeypatch.setattr(soak, "MIXED", 500)

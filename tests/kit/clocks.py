"""Time that passes only when somebody sleeps: what rests on it comes out alike on every machine."""

from __future__ import annotations

from typing import Any

import pytest


class Clock:
    """Stands for the module `time`. Each look at it takes `look_s` seconds."""

    def __init__(self, look_s: float = 0.0) -> None:
        self.now_s = 0.0
        self.look_s = look_s

    def monotonic(self) -> float:
        """Seconds since the clock was made."""
        self.now_s += self.look_s
        return self.now_s

    def sleep(self, seconds: float) -> None:
        """Time goes on by so much."""
        self.now_s += seconds


def set_clock(monkeypatch: pytest.MonkeyPatch, clock: Any, *modules: str) -> None:
    """Let these modules have this clock instead of the module `time`."""
    for module in modules:
        monkeypatch.setattr(f"{module}.time", clock)

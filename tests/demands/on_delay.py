"""The on-delay timer of IEC 61131-3, as programs of another hand call it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Ton:
    """Runs while its input is TRUE. over: it is over only once more than its time has passed."""

    over: bool = False
    running: bool = False
    elapsed_ms: int = 0

    def scan(self, on: bool, time_ms: int, dt_ms: int) -> bool:
        """Whether the time is over in this call; it starts with 0 in the first call with the input TRUE."""
        self.elapsed_ms = self.elapsed_ms + dt_ms if on and self.running else 0
        self.running = on
        return on and (self.elapsed_ms > time_ms or (self.elapsed_ms == time_ms and not self.over))

"""A program for the enable switch, written from the page alone: flags, timers, no states."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tests.demands.on_delay import Ton


@dataclass
class Switch:
    """What the page leaves to the programmer, and faults.

    auto: S_AutoReset ends an error. agree: an error can be reset once channels 1 and 3 agree, else in stage
    0. mode_ends: so does the end of the mode. gap: all FALSE after stage 0 is stage 2 only after the time.
    refuses: stage 1 after stage 2 is an error. in_mode: stage 0 counts only in the mode. watches: the
    channels are compared without the mode too. at_the_top: the timer is called before all else, with what
    the call before left. over: exactly the time is in time. late_outputs: they show a call later. fault: the
    name of a fault.
    """

    DiscrepancyTimeCh1_Ch3_ms: int
    auto: bool = False
    agree: bool = False
    mode_ends: bool = False
    gap: bool = False
    refuses: bool = False
    in_mode: bool = False
    watches: bool = False
    at_the_top: bool = False
    over: bool = False
    late_outputs: bool = False
    fault: str = ""

    enabled: bool = False
    error: bool = False
    released: bool = False
    last_stage: int = -1
    last_reset: bool = False
    apart: bool = False
    shown: tuple[bool, bool] = (False, False)
    timer: Ton = field(default_factory=Ton)
    gap_timer: Ton = field(default_factory=Ton)

    def scan(self, dt_ms: int, i: Mapping[str, bool]) -> dict[str, Any]:
        """One call."""
        before = self.shown
        self._call(dt_ms, i)
        self.shown = (False, False) if self.fault == "nothing" else (self.enabled, self.error)
        enabled, error = before if self.late_outputs else self.shown
        return {"S_EnableSwitchOut": enabled or self.fault == "always", "Error": error}

    def _call(self, dt_ms: int, i: Mapping[str, bool]) -> None:
        self.timer.over = self.over
        pressed = i["Reset"] and (not self.last_reset or self.fault == "level")
        self.last_reset = i["Reset"]
        mode = i["S_SafetyActive"] or self.fault == "no mode"
        if not i["Activate"] and self.fault != "no activation":
            self.enabled = self.error = self.released = self.apart = False
            self.last_stage = -1
            self.timer.scan(False, 0, dt_ms)
            return
        one, two, three = (i[f"S_EnableSwitchCh{n}"] for n in (1, 2, 3))
        three = one if self.fault == "no channel 3" else three
        two = not one if self.fault == "no channel 2" else two
        stage = {(0, 1, 0): 0, (1, 0, 1): 1, (0, 0, 0): 2}.get((int(one), int(two), int(three)), -1)
        self._compare(dt_ms, one != three, mode)
        gone = stage == 0 or (self.agree and one == three) or self.fault == "any stage"
        if self.error and gone and (pressed or (self.auto and i["S_AutoReset"])):
            self.error = False
        if self.error and self.fault == "error goes" and one == three:
            self.error = False
        if self.mode_ends and not mode:
            self.error = False
        self._order(dt_ms, stage, mode)
        stays = self.enabled and self.fault == "stays on" and stage in (1, 2)
        right = (stage == 1 and self.released) or stays or (self.enabled and self.fault == "latched")
        self.enabled = mode and right and (not self.error or self.fault == "error stays on")

    def _compare(self, dt_ms: int, apart: bool, mode: bool) -> None:
        late = self._late(dt_ms) if self.at_the_top else False
        self.apart = apart and (mode or self.watches)
        late = late if self.at_the_top else self._late(dt_ms)
        if late and self.fault != "no error":
            self.error = True

    def _late(self, dt_ms: int) -> bool:
        time_ms = self.DiscrepancyTimeCh1_Ch3_ms
        return self.timer.scan(
            self.apart, {"thrice": 3 * time_ms, "at once": 0}.get(self.fault, time_ms), dt_ms
        )

    def _order(self, dt_ms: int, stage: int, mode: bool) -> None:
        lasts = self.gap_timer.scan(stage == 2, self.DiscrepancyTimeCh1_Ch3_ms, dt_ms)
        if stage == 0:
            self.released = True
        elif stage == 2 and not (self.gap and self.last_stage == 0 and not lasts):
            self.released = self.released and self.fault == "any order"
        if self.refuses and stage == 1 and self.last_stage == 2 and mode:
            self.error = True
        if stage >= 0 and not (stage == 2 and self.gap and self.last_stage == 0 and not lasts):
            self.last_stage = stage
        if self.error and self.fault not in ("any order", "reset enables"):
            self.released = False
        if self.in_mode and not mode:
            self.released = False
        if self.fault == "no order":
            self.released = True

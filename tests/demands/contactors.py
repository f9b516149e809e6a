"""A program for external device monitoring, written from the sentences of the page alone: flags, timers, no
states.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tests.demands.on_delay import Ton


@dataclass
class Contactors:
    """What the page leaves to the programmer, and faults.

    refuses: a request over a contactor that is not dropped out is an error, else it waits. stop_first: after
    a reset S_OutControl must be FALSE before it counts. takes_a_call: the activation does. at_the_top: the
    timers are called before all else, with what the call before left. apart: each contactor has its time,
    which starts with its own fault. over: exactly MonitoringTime is in time. latched: S_StartReset counts
    in the call of the activation alone. late_outputs: they show a call later. fault: the name of a fault.
    """

    MonitoringTime_ms: int
    refuses: bool = False
    stop_first: bool = False
    takes_a_call: bool = False
    at_the_top: bool = False
    apart: bool = False
    over: bool = False
    latched: bool = False
    late_outputs: bool = False
    fault: str = ""

    active: bool = False
    inhibit: bool = True
    on: bool = False
    error: bool = False
    spent: bool = False
    last_reset: bool = False
    shown: tuple[bool, bool, bool] = (False, False, False)
    timed: list[bool] = field(default_factory=lambda: [False] * 4)
    timers: list[Ton] = field(default_factory=list)

    def scan(self, dt_ms: int, i: Mapping[str, bool]) -> dict[str, Any]:
        """One call."""
        before = self.shown
        self._call(dt_ms, i)
        self.shown = (self.active, self.on, self.error)
        if self.fault == "nothing":
            self.shown = (False, False, False)
        ready, on, error = before if self.late_outputs else self.shown
        if self.fault == "always":
            on = True
        return {"Ready": ready, "S_EDM_Out": on, "Error": error}

    def _call(self, dt_ms: int, i: Mapping[str, bool]) -> None:
        self.timers = self.timers or [Ton(self.over) for _ in range(4)]
        rises, falls = i["Reset"] and not self.last_reset, self.last_reset and not i["Reset"]
        pressed = {"level": i["Reset"], "falling": falls}.get(self.fault, rises)
        self.last_reset = i["Reset"]
        one, two = i["S_EDM1"], i["S_EDM1"] if self.fault == "one feedback" else i["S_EDM2"]
        dropped = one and two
        if not i["Activate"] and self.fault != "no activation":
            self.active = self.on = self.error = self.spent = False
            self._time(dt_ms, [False] * 4)
            return
        if not self.active:
            self.active, self.inhibit = True, not i["S_StartReset"]
            if self.takes_a_call:
                return
        late = self._time(dt_ms, self.timed) if self.at_the_top else []
        if i["S_StartReset"] and not self.latched:
            self.inhibit = False
        if (pressed and self.fault != "inhibit stays") or self.fault == "no inhibit":
            self.inhibit = False
        if self.error and (pressed or self.fault == "error goes") and (dropped or self.fault == "any reset"):
            self.error, self.spent = False, self.stop_first and i["S_OutControl"]
        self.spent = self.spent and i["S_OutControl"]
        wanted = i["S_OutControl"] and not (self.inhibit or self.error or self.spent)
        if self.fault == "no stop":
            wanted = wanted or self.on
        if wanted and not self.on and not dropped and self.refuses:
            self.error = True
        self.on = wanted and (self.on or dropped or self.fault == "no initial state")
        self._monitor(dt_ms, one, two, late)

    def _monitor(self, dt_ms: int, one: bool, two: bool, late: list[bool]) -> None:
        idle = not (self.on or self.inhibit or self.error)
        wrong = [self.on and one, self.on and two, idle and not one, idle and not two]
        self.timed = wrong if self.apart else [self.on, self.on, idle, idle]
        if not self.at_the_top:
            late = self._time(dt_ms, self.timed)
        judged = {"no pick-up": wrong[2:], "no drop-out": wrong[:2]}.get(self.fault, wrong)
        over = late[2:] if self.fault == "no pick-up" else late
        if any(a and b for a, b in zip(judged, over, strict=False)):
            self.error = self.fault != "no error"
            self.on = self.fault == "error stays on" and self.on

    def _time(self, dt_ms: int, on: list[bool]) -> list[bool]:
        time_ms = {"twice": 2 * self.MonitoringTime_ms, "half": self.MonitoringTime_ms // 2}
        limit = time_ms.get(self.fault, self.MonitoringTime_ms)
        return [timer.scan(one, limit, dt_ms) for timer, one in zip(self.timers, on, strict=True)]

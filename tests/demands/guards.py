"""A program for guard locking, written from the sentences of the page alone, with flags and no states."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass
class Guard:
    """What the page leaves to the programmer, and faults.

    held_reset: a Reset that is held is an error. zone_lost: what an unsafe zone does to an unlocked guard.
    loss: a guard that opens although nobody asked is an error. two_edges: an error and the inhibit need one
    each. reset_first: the edge is looked at before the guard. fault: the name of a fault.
    """

    held_reset: bool = False
    zone_lost: str = "tolerated"
    loss: bool = False
    two_edges: bool = False
    reset_first: bool = False
    fault: str = ""

    active: bool = False
    start_inhibit: bool = True
    inhibit: bool = False
    unguarded: bool = False
    error: bool = False
    enabled: bool = False
    unlocked: bool = False
    asked: bool = False
    last_reset: bool = False
    last_request: bool = False

    def scan(self, dt_ms: int, i: Mapping[str, bool]) -> dict[str, Any]:
        """One call."""
        rises = i["Reset"] if self.fault == "level" else i["Reset"] and not self.last_reset
        if self.fault == "falling":
            rises = self.last_reset and not i["Reset"]
        held = i["Reset"] and self.last_reset
        asks = i["UnlockRequest"] and not self.last_request
        self.last_reset, self.last_request = i["Reset"], i["UnlockRequest"]
        if self.fault == "nothing":
            return _outputs(False, False, False, False)
        if self.fault == "always":
            return _outputs(True, True, False, False)
        if not i["Activate"]:
            self.active = self.enabled = self.unlocked = self.error = False
            return _outputs(False, False, False, False)
        if not self.active:
            self.active, self.start_inhibit, self.unguarded = True, not i["S_StartReset"], False
            self.inhibit = self.asked = False
        if i["S_StartReset"]:
            self.start_inhibit = False
        if self.reset_first and rises:
            self.acknowledge(i)
        self.look_at_the_guard(i)
        if not self.reset_first and rises:
            self.acknowledge(i)
        if self.held_reset and held and (self.start_inhibit or self.inhibit) and not i["S_AutoReset"]:
            self.error = True
        self.look_at_the_request(i, asks)
        self.enabled = (
            (self.secured(i) or (self.fault == "open" and i["S_GuardLock"]))
            and not self.start_inhibit
            and not self.inhibit
            and not self.error
            and not self.unlocked
        )
        return _outputs(True, self.enabled, self.unlocked and not self.error, self.error)

    def secured(self, i: Mapping[str, bool]) -> bool:
        """The guard is closed and locked."""
        return i["S_GuardMonitoring"] and (i["S_GuardLock"] or self.fault == "unlocked")

    def look_at_the_guard(self, i: Mapping[str, bool]) -> None:
        """The restart inhibit comes when the guard is closed and locked again."""
        if not self.secured(i):
            if self.enabled and self.loss:
                self.error = True
            self.unguarded = True
        elif self.unguarded:
            self.unguarded = False
            self.inhibit = self.fault != "restarts"
        if i["S_AutoReset"]:
            self.inhibit = False

    def acknowledge(self, i: Mapping[str, bool]) -> None:
        """An edge of Reset: the error first, where its cause is gone, and the inhibits."""
        if self.error:
            if not (self.secured(i) and i["S_SafetyActive"]):
                return
            self.error = False
            if self.two_edges:
                return
        self.start_inhibit = False
        if self.secured(i):
            self.inhibit = False

    def look_at_the_request(self, i: Mapping[str, bool], asks: bool) -> None:
        """Unlocked from a request in a safe zone until the request goes."""
        self.asked = i["UnlockRequest"] and (asks or self.asked)
        safe = i["S_SafetyActive"] or self.fault == "no zone"
        if self.unlocked:
            if not i["S_SafetyActive"] and self.zone_lost == "error":
                self.error, self.unlocked = True, False
            elif (not i["S_SafetyActive"] and self.zone_lost == "locks") or (
                not i["UnlockRequest"] and self.fault != "stays unlocked"
            ):
                self.unlocked = False
        elif self.enabled and self.asked and safe and self.fault != "never unlocks":
            self.unlocked = not self.error


def _outputs(ready: bool, locked: bool, unlock: bool, error: bool) -> dict[str, Any]:
    return {
        "Ready": ready,
        "S_GuardLocked": locked,
        "S_UnlockGuard": unlock,
        "Error": error,
        "DiagCode": 0,
    }

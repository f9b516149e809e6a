"""The standard blocks with plain values: timers, edges, bistables, counters."""

from __future__ import annotations

from typing import Any

from programs.language.standard_blocks import BLOCKS


class Standard:
    """An instance of a standard block: its pins, and what it remembers."""

    def __init__(self, block: str) -> None:
        self.block = block
        self.values: dict[str, Any] = {
            "IN": False, "CLK": False, "S": False, "S1": False, "R": False, "R1": False,
            "PT": 0, "ET": 0, "Q": False, "Q1": False,
        }  # fmt: skip
        if block.startswith("CT"):
            self.values = {
                name: False if kind.kind == "bool" else 0
                for side in BLOCKS[block]
                for name, kind in side.items()
            }
            self.highest = BLOCKS[block][0]["PV"].high
            self.lowest = BLOCKS[block][0]["PV"].low
        self.up = self.down = False
        self.before = False
        self.since = 0
        self.running = False

    def call(self, now: int) -> None:
        """One call at this time, in ms since power-up."""
        own = self.values
        if self.block.startswith("CT"):
            self.count(own)
            return
        match self.block:
            case "TON":
                if not own["IN"]:
                    own["ET"], own["Q"] = 0, False
                else:
                    if not self.before:
                        self.since = now
                    own["ET"] = max(0, min(now - self.since, own["PT"]))
                    own["Q"] = now - self.since >= own["PT"]
            case "TOF":
                if own["IN"]:
                    own["ET"], own["Q"], self.running = 0, True, False
                else:
                    if self.before:
                        self.since, self.running = now, True
                    if self.running:
                        own["ET"] = max(0, min(now - self.since, own["PT"]))
                        own["Q"] = now - self.since < own["PT"]
                        self.running = bool(own["Q"])
            case "TP":
                if not self.running and own["IN"] and not self.before:
                    self.since, self.running = now, True
                if self.running:
                    own["ET"] = max(0, min(now - self.since, own["PT"]))
                    own["Q"] = now - self.since < own["PT"]
                    self.running = bool(own["Q"])
                if not self.running and not own["IN"]:
                    own["ET"] = 0
            case "R_TRIG":
                own["Q"] = own["CLK"] and not self.before
            case "F_TRIG":
                own["Q"] = not own["CLK"] and self.before
            case "SR":
                own["Q1"] = own["S1"] or (not own["R"] and own["Q1"])
            case "RS":
                own["Q1"] = not own["R1"] and (own["S"] or own["Q1"])
        self.before = own["IN"] or own["CLK"]

    def count(self, own: dict[str, Any]) -> None:
        """One call of a counter: an edge of CU counts up, one of CD down, both together do nothing."""
        up = own.get("CU", False) and not self.up
        down = own.get("CD", False) and not self.down
        if own.get("R", False):
            own["CV"] = 0
        elif own.get("LD", False):
            own["CV"] = own["PV"]
        elif up and not down and own["CV"] < self.highest:
            own["CV"] += 1
        elif down and not up and own["CV"] > self.lowest:
            own["CV"] -= 1
        reached, empty = own["CV"] >= own["PV"], own["CV"] <= 0
        match self.block.partition("_")[0]:
            case "CTU":
                own["Q"] = reached
            case "CTD":
                own["Q"] = empty
            case _:
                own["QU"], own["QD"] = reached, empty
        self.up, self.down = own.get("CU", False), own.get("CD", False)

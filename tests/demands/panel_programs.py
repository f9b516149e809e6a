"""PLCs and panels written from the sentences of the note alone, and what is wrong with some of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tests.demands.fplc_programs import CH, RE, SE, SW

COPIES = (("ReadAuthorization", "MW01"), ("MW03", "SelectMSO"), ("CheckMSO", "MW05"), ("MW07", "SwitchMSO"))


@dataclass
class Plc:
    """A PLC that copies all words in one scan, one a scan in turn, or in the order of Figures 2 and 8."""

    way: str = "all"
    fault: str = ""

    def reset(self) -> None:
        """Power-up."""
        self.out = dict.fromkeys((name for name, _ in COPIES), "0000")
        self.turn = 0

    def copy(self, turn: int, inputs: Mapping[str, Any]) -> None:
        """One of the four copies."""
        to, source = COPIES[turn]
        if self.fault == f"{to} is never written":
            return
        if self.fault == "zeros of the panel are not sent on" and turn % 2 and inputs[source] == "0000":
            return
        if self.fault == "a word that is no code is left out" and int(inputs[source], 16) not in (0, *RE):
            return
        word = int(inputs[source], 16)
        changed = word and self.fault == f"{to} is changed on the way"
        self.out[to] = f"{word ^ 0x8000 if changed else word:04X}"

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """One scan."""
        if self.way == "all":
            for turn in range(4):
                self.copy(turn, inputs)
        elif self.way == "in turn":
            self.copy(self.turn, inputs)
            self.turn = (self.turn + 1) % 4
        elif self.out["ReadAuthorization"] != inputs["MW01"]:
            # the check of Figure 3 or 9: the other routine begins, with its first copy
            self.copy(0, inputs)
            self.turn = 1
        elif inputs["MW01"] == "0000":
            self.copy(self.turn or 1, inputs)
            self.turn = (self.turn or 1) % 3 + 1
        elif self.turn and (inputs[COPIES[self.turn][1]] != "0000"):
            self.copy(self.turn, inputs)
            self.turn = (self.turn + 1) % 4
        return dict(self.out)


@dataclass
class Hmi:
    """A panel with one step in each scan, or all that it can do in one.

    echo_rules: the acknowledgment is made from the echo, and not from what was touched.
    """

    steps: bool = True
    echo_rules: bool = False
    fault: str = ""

    def reset(self) -> None:
        """Power-up: the screen is inhibited."""
        self.close()
        self.late, self.enabled = 0, list[int]()

    def close(self) -> None:
        """Inhibit the screen and take both words back."""
        self.screen, self.select, self.switch, self.shown, self.chosen = "inhibited", 0, 0, -1, -1
        self.level, self.touched = -1, ""

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """One scan: the check of Figure 3 or 9, then the steps."""
        authorization, self.check = int(inputs["ReadAuthorization"], 16), int(inputs["CheckMSO"], 16)
        self.touch = inputs["touch"] or ""
        if self.late > 0:
            self.late -= 1
            authorization = authorization or RE[4]
        if authorization == 0 and self.screen != "inhibited" and not self.late:
            kept = self.select if self.fault == "the selection stays after the removal" else 0
            sent = self.switch if self.fault == "the acknowledgment stays after the removal" else 0
            if self.fault != "the screen stays open":
                self.close()
            self.select, self.switch = kept, sent
        else:
            for _ in range(1 if self.steps else 9):
                if not self.step(authorization):
                    break
        fields = list(range(self.level + 1)) if self.screen == "select" else []
        if self.fault == "every field is enabled" and fields:
            fields = [0, 1, 2, 3, 4]
        if self.fault == "the field of the level alone is enabled" and fields:
            fields = [self.level]
        self.enabled = fields
        dark = self.fault == "the active mode is not displayed"
        return {
            "SelectMSO": f"{self.select:04X}",
            "SwitchMSO": f"{self.switch:04X}",
            "screen": self.screen,
            "enabled": fields,
            "shown": self.shown if self.shown >= 0 else None,
            "active": None if dark else inputs["ActiveMSO"],
        }

    def step(self, authorization: int) -> bool:
        """One step of Figure 2; whether it was taken."""
        if self.screen == "inhibited":
            return self.open(authorization)
        if self.screen == "select":
            return self.choose()
        if self.screen == "waiting" and not self.select:
            if self.late:
                return False
            self.select = (CH if self.fault == "the selection comes from another range" else SE)[self.chosen]
            if self.fault == "nothing is sent":
                self.select = 0
                return False
            return True
        if self.screen == "waiting" and self.check in CH and not self.switch:
            self.screen, self.shown = "confirm", CH.index(self.check)
            if self.fault == "what was touched is displayed instead of the echo":
                self.shown = self.chosen
            if self.fault == "the echo is not displayed":
                self.screen, self.shown = "waiting", -1
            return False
        if self.screen == "confirm":
            return self.confirm()
        return False

    def open(self, authorization: int) -> bool:
        """Step 14: the screen opens."""
        if self.fault == "the screen opens without a level":
            authorization = authorization or RE[1]
        if authorization not in RE or self.fault == "the screen never opens":
            return False
        self.screen, self.level, self.enabled = "select", RE.index(authorization), []
        return False

    def choose(self) -> bool:
        """Steps 14 and 15: a field is touched."""
        if self.fault == "a mode is selected that nobody touched":
            self.touch = "select:0"
        fields = range(5) if self.fault == "a touch of a closed field counts" else self.enabled
        if not self.touch.startswith("select:") or int(self.touch[7:]) not in fields:
            return False
        self.screen, self.chosen = "waiting", int(self.touch[7:])
        if self.fault == "a selection is sent late, and no check comes before it":
            self.late = 4
        return True

    def confirm(self) -> bool:
        """Steps 23 to 25."""
        if self.touch == "reject" and self.fault != "a rejection counts as a confirmation":
            self.screen, self.select, self.shown = "select", 0, -1
            return False
        if self.touch not in ("confirm", "reject") and self.fault != "the echo is confirmed by nobody":
            return False
        if self.fault == "nothing is acknowledged":
            return False
        mode = self.shown if self.echo_rules else self.chosen
        if self.fault == "another mode is acknowledged":
            mode = (mode + 1) % 5
        self.screen, self.switch, self.shown = "waiting", SW[mode], -1
        return False

"""F-PLCs written from the sentences of the note alone, and what is wrong with some of them.

None of them knows the reference implementation. They differ in what the note leaves to a programmer: how many
rows of the figures one scan takes, what happens to MW01 and MW05 after step 29, whether another selection
follows, whether words are read again. A fault is the name of the sentence that a program does not follow.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

RE = (0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C)
SE = (0x0FF0, 0x3333, 0x33CC, 0x3C3C, 0x0F0F)
CH = (0x3333, 0x33CC, 0x3C3C, 0x0F0F, 0x0FF0)
SW = (0x33CC, 0x3C3C, 0x0F0F, 0x0FF0, 0x3333)
ROW, WAIT = "row", "wait"


class FailureFound(Exception):
    """A check of the sequence failed: the error mode follows."""


@dataclass
class Fplc:
    """One F-PLC.

    rows: each row takes a scan of its own; else a scan goes on until it has to wait. check_apart: the check
    before a row takes a scan too. keep: MW01 and MW05 stay after step 29. again: another selection may
    follow. latched: the selection is read once, in step 17. late: inputs are those of the scan before.
    """

    rows: bool = True
    check_apart: bool = False
    keep: bool = True
    again: bool = False
    latched: bool = True
    late: bool = False
    fault: str = ""

    def reset(self) -> None:
        """Power-up."""
        self.out = {"MW01": 0, "MW05": 0, "ERROR": False}
        self.mode = -1
        self.ms = self.accepted = 0
        self.inserted = False
        self.checking = self.stuck = self.deaf = False
        self.flow: Iterator[str] = self.removal()
        self.before: Mapping[str, Any] | None = None

    # ---------------------------------------------------------------- one scan

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """The check of Figure 3 or 9, and one row, or all rows up to the next wait."""
        self.i = self.before if self.late and self.before is not None else inputs
        self.before = dict(inputs)
        self.ms += dt_ms
        self.checking = self.check_apart and not self.checking
        self.check()
        if not self.checking:
            for _ in range(200):
                try:
                    done = next(self.flow)
                except FailureFound:
                    self.flow = self.error()
                    break
                if self.rows or done == WAIT:
                    break
        return {
            **{name: f"{word:04X}" for name, word in self.out.items() if name != "ERROR"},
            **{f"MSO_{n}": self.mode == n or (n == 0 and self.both) for n in range(5)},
            "ERROR": self.out["ERROR"],
        }

    @property
    def both(self) -> bool:
        """Whether manual mode stays on beside the active one."""
        return self.mode > 0 and self.fault == "manual mode is never switched off"

    @property
    def vector(self) -> list[int]:
        """The levels whose output is set."""
        return [n for n, name in enumerate(("A", "B", "C", "D", "STR")) if self.i[name]]

    def word(self, name: str) -> int:
        """A flag word as it stands now."""
        return int(self.i[name], 16)

    def check(self) -> None:
        """EKS-3-1-FPLC, EKS-9-1-FPLC, EKS-KS-6; until step 12 a key is there while LA is."""
        if self.deaf or (self.fault == "no key is needed" and self.out["MW01"]):
            return
        published = (self.inserted and self.out["MW01"] != 0) or self.stage > 12
        present = self.i["LA"] and (bool(self.vector) or not published)
        several = self.inserted and present and published and 1 < len(self.vector) < 5
        if several and self.fault != "two outputs are ignored" and not self.out["ERROR"]:
            self.flow = self.error()
            return
        if self.inserted and not present:
            self.flow, self.inserted = self.removal(), False
        elif not self.inserted and self.i["LA"]:
            self.flow, self.inserted = self.insertion(), True

    stage = 0

    def start(self) -> None:
        """Start the one timer of the sequence."""
        self.ms = 0

    # ---------------------------------------------------------------- Figure 2

    def insertion(self) -> Iterator[str]:
        """Steps 6 to 29."""
        self.stage, self.out["ERROR"] = 6, self.stuck
        if self.fault == "nothing is done":
            while True:
                yield WAIT
        self.start()
        yield ROW
        yield from self.test_pulse()
        level = self.accepted
        if self.fault == "output C is level 3":
            level = (0, 1, 3, 2, 4)[level]
        yield ROW
        if len(self.vector) > 1 and self.fault != "two outputs are ignored":
            raise FailureFound
        yield ROW
        if self.fault != "no level is published":
            self.out["MW01"] = RE[level]
        self.stage, self.deaf = 13, False
        yield ROW
        while True:
            yield from self.selection(level)
            if not self.again:
                break
            if not self.keep:
                self.out["MW05"] = 0
            while self.word("MW03") or self.word("MW07"):
                yield WAIT
            self.out["MW05"] = 0
        if not self.keep:
            self.out["MW01"] = self.out["MW05"] = 0
        while True:
            yield WAIT

    def test_pulse(self) -> Iterator[str]:
        """Figure 4, with the one timer from all ones on."""
        if self.fault != "no test pulse is needed":
            while len(self.vector) < 5:
                if self.ms >= 1000 and self.fault != "no time is watched":
                    raise FailureFound
                yield WAIT
            self.start()
            yield ROW
            while self.vector:
                if self.ms >= 1000 and self.fault != "no time is watched":
                    raise FailureFound
                yield WAIT
            yield ROW
        while len(self.vector) != 1:
            if self.ms >= 1000 and self.fault != "no time is watched":
                raise FailureFound
            yield WAIT
        self.accepted = self.vector[0]
        self.deaf = self.fault == "there is no check before steps 11 and 12"
        yield ROW

    def selection(self, level: int) -> Iterator[str]:
        """Steps 17 to 29."""
        while not self.word("MW03"):
            yield WAIT
        read = self.word("MW03")

        def selected() -> int:
            return read if self.latched else self.word("MW03")

        yield ROW
        if self.fault != "no level limits the selection":
            for mode in (4, 3, 2, 1):
                yield ROW
                if level >= mode:
                    break
                yield ROW
                if selected() == SE[mode]:
                    if self.fault == "a selection above the level is waited out":
                        while True:
                            yield WAIT
                    raise FailureFound
        yield ROW
        echo = None
        for mode in (4, 3, 2, 1, 0):
            yield ROW
            if selected() == SE[mode]:
                echo = mode
                break
        if echo is None:
            if self.fault == "a word that is no code is waited out":
                while True:
                    yield WAIT
            if self.fault != "any word is a selection":
                raise FailureFound
            echo = 0
        shown = SW if self.fault == "the echo is taken from another range" else CH
        if self.fault != "no echo is given":
            self.out["MW05"] = shown[echo]
        yield ROW
        while not self.word("MW07") and self.fault != "no acknowledgment is awaited":
            yield WAIT
        yield from self.comparison(read if self.latched else 0, echo)

    def comparison(self, latched: int, echo: int) -> Iterator[str]:
        """Figure 7 and step 29."""
        found = None
        table = list(SW)
        if self.fault == "Figure 7 as printed":
            table[2] = SW[3]
        if self.fault == "a row of the code table is wrong":
            table[1], table[2] = table[2], table[1]
        for mode in (4, 3, 2, 1, 0):
            yield ROW
            if self.fault == "no acknowledgment is awaited":
                found = echo
                break
            if self.word("MW07") == table[mode]:
                yield ROW
                selected = latched or self.word("MW03")
                if selected == SE[mode] or self.fault == "the acknowledged mode is not compared":
                    found = mode
                    break
                if self.fault == "another acknowledgment is waited out":
                    while True:
                        yield WAIT
                if self.fault != "Figure 7 as printed":
                    raise FailureFound
        if found is None:
            if self.fault == "an acknowledgment that is no code is waited out":
                while True:
                    yield WAIT
            raise FailureFound
        yield ROW
        if self.fault == "the acknowledged mode never comes":
            return
        self.mode = found

    # ---------------------------------------------------------------- Figure 8, error mode

    def removal(self) -> Iterator[str]:
        """Steps 3 to 18."""
        self.stage, self.out["ERROR"] = 3, self.stuck
        self.start()
        yield ROW
        if self.fault != "the level stays after the removal":
            self.out["MW01"] = 0
        self.out["MW05"] = 0
        if self.fault == "the mode ends with the key":
            self.mode = -1
        yield ROW
        while self.word("MW03") or self.word("MW07") or self.vector:
            yield WAIT
        while True:
            yield WAIT

    def error(self) -> Iterator[str]:
        """The error routine: until the check before it finds the key gone."""
        self.stuck = self.fault == "the error mode is never left"
        while True:
            self.out["ERROR"] = self.fault != "no error is ever reported"
            yield WAIT

"""Each class of the table of faults (spec/mode_selection/assumptions.toml), as what a device reads instead.

A fault stands from the moment at which it is put in until it is taken out. It changes what is read, never
what was written. Each function gets the inputs of a scan and returns those that are read.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from refimpl.mode_selection.code_tables import CH, RE, SE, SW, encode

OUTPUTS = ("A", "B", "C", "D", "STR")
RANGE_OF = {
    "MW01": RE, "ReadAuthorization": RE, "MW03": SE, "SelectMSO": SE,
    "MW05": CH, "CheckMSO": CH, "MW07": SW, "SwitchMSO": SW,
}  # fmt: skip
READER = {
    "MW03": "fplc", "MW07": "fplc", "MW01": "plc", "MW05": "plc",
    "SelectMSO": "plc", "SwitchMSO": "plc", "ReadAuthorization": "hmi", "CheckMSO": "hmi",
}  # fmt: skip
EXCHANGED = (
    ("MW03", "MW07"), ("MW01", "MW05"), ("SelectMSO", "SwitchMSO"), ("ReadAuthorization", "CheckMSO"),
)  # fmt: skip
FLAG_WORDS = ("MW01", "MW03", "MW05", "MW07")


class Faults:
    """What is broken at the moment, and where: a word or an output, a mode where a word is made up."""

    def __init__(self) -> None:
        self.active = ""
        self.word, self.other, self.mode, self.output = "MW07", "MW01", 0, "A"
        self._held: dict[str, int] = {}
        self._before: dict[str, int] = {}

    def begin(self, id: str, stood: dict[str, int]) -> None:
        """Put the fault in; `stood` are the words as they stand on all places now."""
        self.active, self._held = id, dict(stood)

    def end(self) -> None:
        """Take it out."""
        self.active = ""

    def written(self, name: str, old: int, new: int) -> None:
        """A word was written anew: remember the one before it."""
        if old != new:
            self._before[name] = old

    def read(self, device: str, inputs: Any, words: dict[str, int]) -> Any:
        """What the device reads; `words` are all words as they were written."""
        kind = self.active
        if not kind:
            return inputs
        if device == "eks":
            return replace(inputs, registers_zero=False) if kind == "register_check" else inputs
        changes: dict[str, Any] = {}
        if device == "fplc":
            changes = self._wires(kind, inputs)
        if READER.get(self.word) == device or kind in ("wrong_sequence", "two_words"):
            changes |= self._words(kind, device, words)
        return replace(inputs, **changes) if changes else inputs

    def _words(self, kind: str, device: str, words: dict[str, int]) -> dict[str, int]:
        name, word = self.word, words[self.word]
        if kind == "corruption":
            return {name: word ^ 0x0001}
        if kind == "torn_word":
            return {name: (word & 0xFF00) | (self._before.get(name, 0) & 0x00FF)}
        if kind == "repetition":
            return {name: self._before.get(name, 0)}
        if kind == "loss":
            return {name: 0}
        if kind == "delay":
            return {name: self._held.get(name, 0)}
        if kind == "insertion":
            return {name: self.made_up(name)} if word == 0 else {}
        if kind == "masquerade":
            return {name: self.made_up(name)}
        if kind == "wrong_address":
            return {name: words[self.other]}
        if kind == "straddled_read" and name in FLAG_WORDS:
            return {name: _straddled(name, words)}
        if kind == "wrong_sequence":
            for one, other in EXCHANGED:
                if name in (one, other) and READER[one] == device:
                    return {one: words[other], other: words[one]}
        if kind == "two_words":
            return {
                place: encode(RANGE_OF[place], self.mode)
                for place in (self.word, self.other)
                if READER[place] == device
            }
        return {}

    def made_up(self, name: str) -> int:
        """The word that means the chosen mode where it stands."""
        return encode(RANGE_OF[name], self.mode)

    def _wires(self, kind: str, i: Any) -> dict[str, bool]:
        chosen = self.output
        following = OUTPUTS[(OUTPUTS.index(chosen) + 1) % 5] if chosen in OUTPUTS else OUTPUTS[0]
        if kind == "stuck_at_1":
            return {chosen: True}
        if kind == "la_stuck_at_1":
            return {"LA": True}
        if kind == "stuck_at_0":
            return {chosen: False}
        if kind == "extra_wire":
            return {following: True} if getattr(i, chosen) else {}
        if kind == "two_wires":
            return {chosen: False, following: True}
        if kind == "crossed_wires":
            return {chosen: getattr(i, following), following: getattr(i, chosen)}
        return {}


KINDS = (
    "corruption", "torn_word", "repetition", "wrong_sequence", "loss", "delay", "insertion", "masquerade",
    "wrong_address", "straddled_read", "stuck_at_1", "la_stuck_at_1", "stuck_at_0", "extra_wire", "two_wires",
    "two_words", "crossed_wires", "register_check",
)  # fmt: skip
"""The rows of the table that can be put in."""


def _straddled(name: str, words: dict[str, int]) -> int:
    """The word at the even address that overlaps this one: its low byte, then the next high byte."""
    after = FLAG_WORDS.index(name) + 1
    following = words[FLAG_WORDS[after]] if after < len(FLAG_WORDS) else 0
    return (words[name] & 0x00FF) << 8 | following >> 8

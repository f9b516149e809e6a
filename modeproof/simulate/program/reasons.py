"""Why a device went to its error mode or gave up what was begun, and how to get out, in sentences."""

from __future__ import annotations

from typing import Any

ANYWHERE = "*"
"""The state of origin of a sentence that is true of every state without its own."""

NOTHING: dict[str, Any] = {"why": {}, "stands": {}}
"""For a device without sentences."""
HEADS = {"error": "Error mode", "waits": "Waiting", "over": "That is over", "": ""}


def why(told: dict[str, Any], before: str, step: str) -> dict[str, Any] | None:
    """The sentence for a step out of a state, if it refuses anything; `told` are those of the device."""
    rows: dict[str, Any] = told["why"].get(step, {})
    row: dict[str, Any] | None = rows.get(before) or rows.get(ANYWHERE)
    return row


class Reasons:
    """What is to be said of one device in the run that is played."""

    def __init__(self, told: dict[str, Any], params: dict[str, Any]) -> None:
        self.told, self.params = told, params
        self.why: dict[str, Any] | None = None
        self.latest = ""

    def scanned(self, before: str, step: str, after: str) -> None:
        """A scan was taken; what refused in it is remembered until another step does, or the user acts."""
        found = why(self.told, before, step) if before != after else None
        if found:
            self.why = found
            self.latest = self._said(found)[0]

    def acted(self, state: str) -> None:
        """The user did something: what is over is not told any longer."""
        if state not in self.told["stands"]:
            self.why = None

    def show(self, state: str, error: bool, waits_for: list[str]) -> dict[str, Any]:
        """What stands in the box: nothing, or a heading, sentences with their ids, and what is waited for."""
        stands = self.told["stands"].get(state)
        kind = "error" if error else "waits" if stands else "over" if self.why else ""
        waits = f"Now it waits for {_listed(waits_for)}." if stands and waits_for else ""
        return {
            "kind": kind,
            "head": HEADS[kind],
            "say": self._said(self.why),
            "way": self._said(stands),
            "waits": waits,
        }

    def _said(self, row: dict[str, Any] | None) -> list[Any]:
        if row is None:
            return []
        text = row["say"]
        for name, value in self.params.items():
            text = text.replace("{" + name + "}", str(value))
        return [text, row["by"]]


def _listed(things: list[str]) -> str:
    return things[0] if len(things) == 1 else ", ".join(things[:-1]) + " and " + things[-1]

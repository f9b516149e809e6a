"""What is told step by step: a story, a log, or a recorded counterexample."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Player:
    """Steps to be taken one after the other: each is a function that returns what is to be read."""

    def __init__(self, intro: str, steps: list[Callable[[], str]], end: str) -> None:
        self.intro, self.steps, self.end = intro, steps, end
        self.at = 0

    @property
    def ended(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.steps)

    def next(self) -> str:
        """Take the next step; the text to read, with its number."""
        if self.ended:
            return self.end
        text = self.steps[self.at]()
        self.at += 1
        end = f" {self.end}" if self.ended else ""
        return f"{self.at} of {len(self.steps)}: {text}{end}"


def of_story(story: dict[str, Any], do: Callable[[str], None]) -> Player:
    """A story: every step says something and has actions, `; ` between them."""

    def step(row: dict[str, Any]) -> Callable[[], str]:
        def take() -> str:
            for action in actions(row):
                do(action)
            return str(row["say"])

        return take

    return Player(f"{story['intro']} Press Next.", [step(row) for row in story["step"]], story["end"])


def actions(row: dict[str, Any]) -> list[str]:
    """The actions of a step."""
    return [text for text in row.get("do", "").split("; ") if text]


def of_recorded(run: dict[str, Any], draw: Callable[[dict[str, Any]], None]) -> Player:
    """A recorded counterexample: nothing runs, every row shows what the evidence has."""

    def step(row: dict[str, Any]) -> Callable[[], str]:
        def take() -> str:
            draw(row)
            by = f" ({row['who']})" if row["who"] else ""
            return f"{row['step'] or 'power-up'}{by}."

        return take

    told = "; ".join([f"{id}, {title}. {text}" for id, title, text in run["findings"][:1]])
    intro = f"Recorded by the model checker, not run here. {told} Press Next."
    end = f"Here {run['property']} fails: {run['says']}"
    return Player(intro, [step(row) for row in run["rows"]], end)


def of_log(rows: list[dict[str, Any]], play: Callable[[dict[str, Any]], str]) -> Player:
    """A log: each line is one scan with the inputs of the line."""

    def step(row: dict[str, Any]) -> Callable[[], str]:
        def take() -> str:
            differs = play(row)
            return f"First difference: {differs}." if differs else "as logged."

        return take

    end = "The log is at its end."
    return Player(f"A log of {len(rows)} scans. Press Next or Play.", [step(row) for row in rows], end)

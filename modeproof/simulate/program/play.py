"""What is told step by step: a story, a log, or a recorded counterexample."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

GROUPS = ("wires", "states", "also")
"""What a recorded row has by name: signals, the state of each device, and what else the model remembers."""


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


def of_recorded(
    run: dict[str, Any],
    changes: list[dict[str, Any]],
    finding: dict[str, Any],
    draw: Callable[[list[dict[str, Any]]], None],
) -> Player:
    """A recorded counterexample; nothing runs. Of each row `changes` has what is not as in the row before.

    `draw` gets all rows up to the one that is to be seen.
    """
    rows = whole(changes)

    def step(number: int) -> Callable[[], str]:
        def take() -> str:
            draw(rows[: number + 1])
            return told(rows[number])

        return take

    old = "" if run["fresh"] else " The specification has changed since."
    intro = f"{finding['id']}: {finding['title']}. {finding['story']}"
    source = f"The model checker recorded this in {run['run']}; nothing runs here.{old}"
    loop = {"": "", "stuttering": " Then nothing happens any more."}.get(run["loop"], f" Then {run['loop']}.")
    end = f"Here {run['property']} fails: {run['says']}{loop}"
    return Player(f"{intro} {source} Press Next.", [step(number) for number in range(len(rows))], end)


def whole(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows that have only what changed, with all that stands."""
    found: list[dict[str, Any]] = []
    stands: dict[str, dict[str, Any]] = {group: {} for group in GROUPS}
    for row in rows:
        stands = {group: {**of, **row.get(group, {})} for group, of in stands.items()}
        found.append({"instead": [], "ticks": 0, **row, **stands})
    return found


def told(row: dict[str, Any]) -> str:
    """One row in words: the step, who takes it and when, what else stands, what was decided instead."""
    by = f" ({row['by']})" if row["by"] else ""
    later = f", {row['ticks']} tick{'s' if row['ticks'] > 1 else ''} later" if row["ticks"] else ""
    also = "; ".join([f"{name} {value}" for name, value in row["also"].items()])
    sentences = [f"{row['step'] or 'power-up'}{by}{later}", also, *row["instead"]]
    return " ".join([f"{text}." for text in sentences if text])


def of_log(rows: list[dict[str, Any]], play: Callable[[dict[str, Any]], str]) -> Player:
    """A log: each line is one scan with the inputs of the line."""

    def step(row: dict[str, Any]) -> Callable[[], str]:
        def take() -> str:
            differs = play(row)
            return f"First difference: {differs}." if differs else "as logged."

        return take

    end = "The log is at its end."
    return Player(f"A log of {len(rows)} scans. Press Next or Play.", [step(row) for row in rows], end)


def log_of_case(header: dict[str, Any], case: dict[str, Any], device: str = "") -> list[dict[str, Any]]:
    """A case of a vector file as a log: every scan whole, what is expected as what was written.

    `device` is named in each line of a log of several. Raises ValueError for a case that asks for a refusal.
    """
    rows: list[dict[str, Any]] = [{"target": header["target"], "params": case["params"]}]
    named = {"device": device} if device else {}
    inputs: dict[str, Any] = {}
    outputs: dict[str, Any] = {}
    for scan in case["scans"]:
        if "refuse" in scan:
            raise ValueError("this case asks for a refusal, which nothing here can give")
        inputs, outputs = {**inputs, **scan["in"]}, {**outputs, **scan["out"]}
        rows.append({**named, "dt_ms": scan["dt_ms"], "in": inputs, "out": outputs})
    return rows

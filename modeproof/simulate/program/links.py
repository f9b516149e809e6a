"""A play as a text that fits into an address: its actions, short enough to be played anew."""

from __future__ import annotations

from collections.abc import Callable

PARTS = "; "
COUNTED = ("round", "scan", "call")
"""Actions whose last number says how often."""
LONGEST = 4_000
"""Characters of the actions; what is longer is for a log."""
MOST_ROUNDS = 1_000
"""Rounds, scans and calls in all."""


class NoPlay(ValueError):
    """What cannot be a link, or is none."""


def added(done: list[str], text: str) -> list[str]:
    """What was done, and one action more; the same thing done again is counted.

    Power off and on begins anew: before it only parameters count, which stay.
    """
    text = text.strip()
    if text.startswith(("reset", "param ")):
        return [*[of for of in done if of.startswith("param ")], text]
    word, times = counted(text)
    if done and times:
        before, so_often = counted(done[-1])
        if so_often and before == word:
            return [*done[:-1], f"{word} {so_often + times}"]
    return [*done, f"{word} {times}" if times else text]


def counted(text: str) -> tuple[str, int]:
    """An action without its number of times, and that number; 0 for an action that is done once."""
    words = text.split(" ")
    if words[0] not in COUNTED:
        return text, 0
    first = 2 if words[0] == "call" else 1
    if len(words) > first and words[-1].isdigit():
        return " ".join(words[:-1]), int(words[-1])
    return text, 1


def written(part: str, profile: str, done: list[str], encode: Callable[[str], str]) -> str:
    """The fragment of an address that carries a play. Raises NoPlay where it is too long."""
    text = PARTS.join(done)
    if not done:
        raise NoPlay("nothing has been played yet")
    if len(text) > LONGEST or rounds(done) > MOST_ROUNDS:
        raise NoPlay("this play is too long for an address; save the log instead")
    return f"play={part}&profile={profile}&do={encode(text)}"


def read(text: str) -> list[str]:
    """The actions of a fragment. Raises NoPlay where they are too many; what they are, the scene judges."""
    done = [part.strip() for part in text.split(PARTS.strip()) if part.strip()]
    if not done or len(text) > LONGEST or rounds(done) > MOST_ROUNDS:
        raise NoPlay("it has no actions, or too many")
    return done


def rounds(done: list[str]) -> int:
    """How often something is called in all; of one action no more counts than is too much."""
    times = [counted(text)[1] for text in done]
    return sum([min(number, MOST_ROUNDS + 1) for number in times])

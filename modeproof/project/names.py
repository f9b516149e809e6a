"""Which name of a program may stand for a signal of a target where the two do not agree."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping, Sequence

SURE, NEAR = 1.0, 0.9
ALIKE = 0.85
"""The part of the letters of two names that are the same, in the same order."""
LEAST = 3
"""Characters of a name that may be the end or the beginning of another one."""


def likeness(ours: str, yours: str) -> float:
    """From 0, nothing alike, to 1: alike but for case, underscores and `_ms`.

    The same words in another order, a prefix or an ending more, or few letters, are near. Names with
    different digits are never alike: they are two channels.
    """
    one, other = _bare(ours), _bare(yours)
    if one == other:
        return SURE
    if re.findall(r"\d+", one) != re.findall(r"\d+", other):
        return 0.0
    if _words(ours) == _words(yours):
        return NEAR
    short, long = sorted((one, other), key=len)
    if len(short) >= LEAST and (long.startswith(short) or long.endswith(short)):
        return NEAR * (0.9 + 0.1 * len(short) / len(long))
    if len(short) > LEAST and _one_letter(short, long):
        return NEAR
    ratio = difflib.SequenceMatcher(None, one, other).ratio()
    return NEAR * ratio if ratio >= ALIKE else 0.0


def matched(
    signals: Sequence[str], variables: Sequence[str], fits: Callable[[str, str], bool]
) -> tuple[dict[str, str], dict[str, list[str]]]:
    """For each signal the one variable that is most like it; and where several are as much so, which.

    The surest pairs come first, and a variable stands for one signal. fits: whether types allow a pair.
    """
    pairs = sorted(
        (
            (-likeness(signal, name), number, signal, name)
            for number, signal in enumerate(signals)
            for name in variables
            if likeness(signal, name) and fits(signal, name)
        ),
    )
    found: dict[str, str] = {}
    doubtful: dict[str, list[str]] = {}
    taken: set[str] = set()
    for score, _, signal, name in pairs:
        if signal in found or signal in doubtful or name in taken:
            continue
        rivals = [
            other
            for rank, _, of, other in pairs
            if of == signal and rank == score and other not in taken and other != name
        ]
        if rivals:
            doubtful[signal] = [name, *rivals]
        else:
            found[signal] = name
            taken.add(name)
    return found, doubtful


def weights(targets: Mapping[str, Iterable[str]]) -> dict[str, float]:
    """How much a name says about which target is meant: less, the more targets have it."""
    counts: dict[str, int] = {}
    for names in targets.values():
        for name in {_bare(name) for name in names}:
            counts[name] = counts.get(name, 0) + 1
    return {name: 1 / count for name, count in counts.items()}


def weight(name: str, known: Mapping[str, float]) -> float:
    """The weight of a signal."""
    return known.get(_bare(name), 1.0)


def _bare(name: str) -> str:
    return re.sub(r"_ms$", "", name.casefold()).replace("_", "")


def _words(name: str) -> list[str]:
    """The words of a name, which capitals or underscores divide, in any order."""
    return sorted(word.casefold() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", name))


def _one_letter(short: str, long: str) -> bool:
    """Whether one letter more, another one, or two that changed places make one of the other."""
    if len(long) - len(short) > 1:
        return False
    at = next((n for n, (a, b) in enumerate(zip(short, long, strict=False)) if a != b), len(short))
    if len(short) < len(long):
        return short[at:] == long[at + 1 :]
    swapped = short[:at] + short[at + 1 : at + 2] + short[at : at + 1] + short[at + 2 :]
    return short[at + 1 :] == long[at + 1 :] or swapped == long

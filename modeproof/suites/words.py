"""Suite `words`: wrong words wherever a word decides; a program that looks at part of a word is caught.

A word decides in a state, with the other inputs as they are, when a code in it leads to another state than a
word that is no code, and outputs can tell the two states apart. Which words are no code, the document's
interface.toml says. For each code that decides, the wrong words are

- in every control state: the code with one bit inverted, its bytes swapped, its complement, the code shifted
  by one bit either way, and the boundaries 7FFF, 8000, FFFE and FFFF;
- shared out over the control states: every word that agrees with the code in the low byte only, and every
  word that agrees with it in the high byte only.

A case goes a shortest way to such a state, sends the wrong word, and then what tells apart the state that
must come from the one that the code would lead to. States and other inputs take turns.

A device that passes words on and at most compares them has no wrong words (rule `copied` of interface.toml).
There each case is a walk in which single bits of a word, and words beside codes, pass through every field.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from modeproof.graph.classes import Copied, InputClass
from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.suites.apart import Apart
from modeproof.suites.script import Alphabet, Script, Scripts, Shot, control_state, ways_from_power_up

BOUNDARIES = (0x7FFF, 0x8000, 0xFFFE, 0xFFFF)
WORD = 0xFFFF
STATES = 8
"""So many states of a control state take turns at most; those near power-up come first."""


@dataclass(frozen=True)
class _Place:
    """A state and a letter with a word that is no code in it, and the letter with the code instead."""

    state: int
    wrong: int
    code: int


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph; `notes` count the wrong words by field, control state and code."""
    counts: dict[str, dict[str, dict[str, int]]] = {}
    cases = [*_wrong_words(device, columns, counts), *_passed_words(device, counts)]
    return Scripts(cases, {"words": counts})


def _wrong_words(
    device: DeviceGraph, columns: Columns, counts: dict[str, dict[str, dict[str, int]]]
) -> Iterator[Script]:
    classes = [input_class for input_class in device.classes if _of_words(device, input_class)]
    if not classes:
        return
    apart = Apart(columns, device.seen)
    ways = ways_from_power_up(device)
    graph = device.graph
    for input_class in classes:
        ((field, representative),) = input_class.representative.items()
        named = sorted({letter[field] for letter in device.alphabet} - {representative})
        places = _places(device, field, representative, named, apart, ways)
        for code in named:
            controls = [control for control, of in places if of == code]
            for n, control in enumerate(controls):
                found = places[control, code]
                words = wrong_words(code, named, n, len(controls))
                counts.setdefault(field, {}).setdefault(control, {})[f"{code:04X}"] = len(words)
                for turn, word in enumerate(words):
                    place = found[turn % len(found)]
                    good, bad = (
                        graph.next_of[place.state][place.wrong],
                        graph.next_of[place.state][place.code],
                    )
                    way = ways[place.state] or ()
                    after = apart.sequence(good, bad) or ()
                    step = graph.steps[graph.step_of[place.state][place.wrong]]
                    other = graph.steps[graph.step_of[place.state][place.code]]
                    yield Script(
                        why=(
                            f"in {control}, {field} = {word:04X} is no code: {step}; "
                            f"a program that takes it for {code:04X} would do as {other}"
                        ),
                        shots=(
                            *(Shot(letter) for letter in way),
                            Shot(place.wrong, {field: word}),
                            *(Shot(columns.members[column][0]) for column in after),
                        ),
                        about=(len(way),),
                    )


def _of_words(device: DeviceGraph, input_class: InputClass) -> bool:
    return len(input_class.representative) == 1 and all(
        device.device.inputs[field].type == "word" for field in input_class.representative
    )


def _places(
    device: DeviceGraph,
    field: str,
    representative: int,
    named: list[int],
    apart: Apart,
    ways: list[tuple[int, ...] | None],
) -> dict[tuple[str, int], list[_Place]]:
    """By control state and code the places where the code decides; the states take turns in each list."""
    graph, alphabet = device.graph, Alphabet(device)
    families: dict[int, list[tuple[int, int]]] = {code: [] for code in named}
    for n, letter in enumerate(device.alphabet):
        if letter[field] == representative:
            for code in named:
                other = alphabet.changed(n, **{field: code})
                if other is not None:
                    families[code].append((n, other))
    last = apart.rounds[-1]
    states = [state for state in range(len(graph.views)) if ways[state] is not None]
    states.sort(key=lambda state: (len(ways[state] or ()), state))
    by_state: dict[tuple[str, int], list[list[_Place]]] = {}
    for state in states:
        control = control_state(device, state)
        row = [last[after] for after in graph.next_of[state]]
        for code, pairs in families.items():
            if len(by_state.get((control, code), ())) == STATES:
                continue
            found = [_Place(state, n, other) for n, other in pairs if row[n] != row[other]]
            if found:
                by_state.setdefault((control, code), []).append(found)
    return {key: _in_turns(found) for key, found in by_state.items()}


def _in_turns(groups: list[list[_Place]]) -> list[_Place]:
    """So many places that every group had its turn with each of its places, or at most 64 times."""
    length = min(64, max(map(len, groups)))
    return [group[(turn * 5) % len(group)] for turn in range(length) for group in groups]


def wrong_words(code: int, named: list[int], part: int, parts: int) -> list[int]:
    """The wrong words of a code (0..65535) for one of `parts` control states; none of them is in `named`."""
    low = [code ^ (high << 8) for high in range(1, 256)]
    high = [code ^ low_byte for low_byte in range(1, 256)]
    swapped = (code >> 8) | (code & 0xFF) << 8
    words = [
        *(code ^ (1 << bit) for bit in range(16)),
        swapped,
        code ^ WORD,
        code << 1 & WORD,
        code >> 1,
        *BOUNDARIES,
        *low[part::parts],
        *high[part::parts],
    ]
    return [word for word in dict.fromkeys(words) if word not in named]


# ------------------------------------------------------------------------------------- words passed on


def _passed_words(device: DeviceGraph, counts: dict[str, dict[str, dict[str, int]]]) -> Iterator[Script]:
    copied = device.copied
    if copied is None:
        return
    for field in copied.fields:
        counts[field] = {"every": {"copied": len(_passed(copied))}}
    for word, other in _passed(copied):
        shots = []
        for turn in range(len(copied.fields) + 1):
            letter = _turned(device, copied, turn)
            shots += [Shot(letter)] * len(copied.fields)
        names: Mapping[int, int] = dict(zip(copied.words, (word, other), strict=True))
        yield Script(
            why=f"the words {word:04X} and {other:04X} pass through every field unchanged",
            shots=shots,
            renamed=names,
        )


def _passed(copied: Copied) -> list[tuple[int, int]]:
    """Pairs of words: every bit alone and its complement, words beside codes, bytes of every value."""
    pairs = [(1 << bit, WORD ^ (1 << bit)) for bit in range(16)]
    pairs += [(code, code ^ (1 << bit)) for code in copied.codes for bit in range(16)]
    pairs += [(value << 8 | (value ^ 0xFF), value) for value in range(1, 256)]
    return [(word, other) for word, other in dict.fromkeys(pairs) if word != other and 0 not in (word, other)]


def _turned(device: DeviceGraph, copied: Copied, turn: int) -> int:
    """The letter with the two words and zero in the fields, each field with another in the next turn."""
    order = (*copied.words, 0)
    values: dict[str, Any] = {field: order[(n + turn) % 3] for n, field in enumerate(copied.fields)}
    for letter, have in enumerate(device.alphabet):
        if values.items() <= have.items():
            return letter
    raise AssertionError(f"{device.name}: no input {values}")

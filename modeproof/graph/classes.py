"""Which other values an input of the alphabet stands for, and a sample of them.

An OPEN_ model tries one representative of a class of inputs, such as one word for all words that are no code.
spec/<document>/interface.toml says which letters are representatives:

    [[class]]
    device = "latch"
    rule = "words"                      every word that the alphabet does not name for this field
    field = "W1"
    representative = "0001"

    [[class]]
    device = "latch"
    rule = "count"                      every combination with so many of the fields set
    fields = ["A", "B", "C"]
    representative = ["A", "B"]
    at_least = 2
    at_most = 3

In an alphabet without the representative of a `count`, the first other member in it stands for the class.
A third rule is no class: the device passes the fields on and decides nothing by them, so that two words of
the alphabet stand for any two words other than zero, in inputs and outputs alike; `codes` are those in use.

    [[class]]
    device = "relay"
    rule = "copied"
    fields = ["W1", "W2"]
    words = ["0FF0", "0001"]
    codes = ["0FF0", "33CC"]

Members of `words`: all one-bit neighbours of the words that the alphabet names for the field, and 64 random
words (seeded, so always the same). A document without the file has no classes.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_toml

RANDOM_WORDS = 64
_FIELDS = {
    "words": {"device", "rule", "field", "representative"},
    "count": {"device", "rule", "fields", "representative", "at_least", "at_most"},
    "copied": {"device", "rule", "fields", "words", "codes"},
}


@dataclass(frozen=True)
class InputClass:
    """One class: an input whose values include `representative` stands for those with each of `members`."""

    name: str
    representative: Mapping[str, Any]
    members: tuple[Mapping[str, Any], ...]


@dataclass(frozen=True)
class Copied:
    """The two `words` of the alphabet are in the `fields` for any two words other than zero."""

    fields: tuple[str, ...]
    words: tuple[int, int]
    codes: tuple[int, ...]


def load_classes(
    place: Path, document: str, device: str, alphabet: Sequence[Mapping[str, Any]]
) -> tuple[InputClass, ...]:
    """The classes of one device; `alphabet` holds the inputs in Python form.

    Raises Unjudged with file and row for a row that is not of one of the forms above, that names an input
    which does not exist, or whose representative does not occur in the alphabet.
    """
    return tuple(
        _class(where, row, alphabet)
        for where, row in _rows(place, document, device, alphabet)
        if row["rule"] != "copied"
    )


def load_copied(
    place: Path, document: str, device: str, alphabet: Sequence[Mapping[str, Any]]
) -> Copied | None:
    """What a device passes on unread; None when interface.toml has no row of the rule `copied` for it.

    Raises Unjudged as `load_classes`, and where the alphabet lacks one of the words in one of the fields.
    """
    found = [row for row in _rows(place, document, device, alphabet) if row[1]["rule"] == "copied"]
    if not found:
        return None
    if len(found) > 1:
        raise Unjudged(f"{found[1][0]}: a second row of the rule copied for {device}")
    where, row = found[0]
    try:
        words, codes = (tuple(int(word, 16) for word in row[name]) for name in ("words", "codes"))
    except (ValueError, TypeError):
        raise Unjudged(f"{where}: words and codes must list words of four hex digits") from None
    if len(set(words)) != 2 or 0 in words:
        raise Unjudged(f"{where}: words must be two words other than 0000")
    for field in row["fields"]:
        if not {0, *words} <= {letter[field] for letter in alphabet}:
            raise Unjudged(f"{where}: the alphabet lacks 0000 or one of the words in {field}")
    return Copied(tuple(row["fields"]), (words[0], words[1]), codes)


def _rows(
    place: Path, document: str, device: str, alphabet: Sequence[Mapping[str, Any]]
) -> list[tuple[str, Mapping[str, Any]]]:
    """The rows of a device with their places, checked for what all rules have in common."""
    path = place / "spec" / document / "interface.toml"
    if not path.is_file():
        return []
    rows = read_toml(place, path).get("class", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise Unjudged(f"{path.name} of {document}: [[class]] tables were expected")
    found = [
        (f"spec/{document}/interface.toml: class {n + 1}", row)
        for n, row in enumerate(rows)
        if row.get("device") == device
    ]
    for where, row in found:
        _check(where, row, alphabet)
    return found


def _check(place: str, row: Mapping[str, Any], alphabet: Sequence[Mapping[str, Any]]) -> None:
    rule = row.get("rule")
    if rule not in _FIELDS:
        raise Unjudged(f"{place}: rule must be words, count or copied, not {rule!r}")
    if set(row) != _FIELDS[rule]:
        odd = sorted(set(row) ^ _FIELDS[rule])[0]
        raise Unjudged(f"{place}: field {odd!r} is missing or unknown for the rule {rule}")
    fields = [row["field"]] if rule == "words" else row["fields"]
    for field in fields:
        if not isinstance(field, str) or field not in alphabet[0]:
            raise Unjudged(f"{place}: {field!r} is no input")


def _class(place: str, row: Mapping[str, Any], alphabet: Sequence[Mapping[str, Any]]) -> InputClass:
    rule = row["rule"]
    made = _words(place, row, alphabet) if rule == "words" else _count(place, row, alphabet)
    if not any(made.representative.items() <= letter.items() for letter in alphabet):
        raise Unjudged(f"{place}: the representative {row['representative']!r} is not in the alphabet")
    if not made.members:
        raise Unjudged(f"{place}: the class has no other member")
    return made


def _words(place: str, row: Mapping[str, Any], alphabet: Sequence[Mapping[str, Any]]) -> InputClass:
    field = row["field"]
    try:
        representative = int(row["representative"], 16)
    except (ValueError, TypeError):
        raise Unjudged(f"{place}: representative must be four hex digits") from None
    named = sorted({letter[field] for letter in alphabet})
    found = [word ^ (1 << bit) for word in named if word != representative for bit in range(16)]
    source = random.Random(f"{field} {representative}")
    found += [source.randrange(1 << 16) for _ in range(RANDOM_WORDS)]
    members = [word for word in dict.fromkeys(found) if word not in named]
    return InputClass(f"{field} other", {field: representative}, tuple({field: word} for word in members))


def _count(place: str, row: Mapping[str, Any], alphabet: Sequence[Mapping[str, Any]]) -> InputClass:
    fields, chosen = row["fields"], row["representative"]
    low, high = row["at_least"], row["at_most"]
    if not isinstance(chosen, list) or not set(chosen) <= set(fields):
        raise Unjudged(f"{place}: representative must list some of the fields")
    if type(low) is not int or type(high) is not int or not low <= len(chosen) <= high:
        raise Unjudged(f"{place}: the representative must have at_least to at_most fields set")
    members = [
        dict(zip(fields, values, strict=True))
        for values in itertools.product((False, True), repeat=len(fields))
        if low <= sum(values) <= high
    ]
    representative = {field: field in chosen for field in fields}
    if not any(representative.items() <= letter.items() for letter in alphabet):
        in_alphabet = [
            member for member in members if any(member.items() <= letter.items() for letter in alphabet)
        ]
        representative = in_alphabet[0] if in_alphabet else representative
    members.remove(representative)
    return InputClass(f"{low}..{high} of {' '.join(fields)}", representative, tuple(members))


class Members:
    """Hands out other members of an input's classes, each in turn, so that all are used sooner or later."""

    def __init__(self, classes: Sequence[InputClass], alphabet: Sequence[Mapping[str, Any]]) -> None:
        self._alphabet = alphabet
        self._of = [
            [n for n, one in enumerate(classes) if one.representative.items() <= letter.items()]
            for letter in alphabet
        ]
        self._classes = classes
        self._next = [0] * len(classes)

    def any_of(self, letter: int) -> bool:
        """Whether this letter of the alphabet stands for others."""
        return bool(self._of[letter])

    def another(self, letter: int) -> dict[str, Any]:
        """The inputs of the letter, with the next member of each of its classes in place."""
        values = dict(self._alphabet[letter])
        for n in self._of[letter]:
            members = self._classes[n].members
            values.update(members[self._next[n] % len(members)])
            self._next[n] += 1
        return values

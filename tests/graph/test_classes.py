"""A letter that stands for a class: the one that interface.toml names, or another member that is there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.graph.classes import InputClass, load_classes
from modeproof.ground.errors import Unjudged

SEVERAL = """
[[class]]
device = "latch"
rule = "count"
fields = ["A", "B", "C"]
representative = ["A", "B"]
at_least = 2
at_most = 3
"""


def letter(on: str) -> dict[str, Any]:
    return {"dt_ms": 0, **{field: field in on for field in "ABC"}}


def the_class(folder: Path, *alphabet: str) -> InputClass:
    """The class of several fields set, as seen by a graph with these letters."""
    room = folder / "spec" / "toy"
    room.mkdir(parents=True, exist_ok=True)
    (room / "interface.toml").write_text(SEVERAL, encoding="utf-8")
    [found] = load_classes(folder, "toy", "latch", [letter(on) for on in alphabet])
    return found


def on(values: Any) -> str:
    return "".join(field for field in "ABC" if values[field])


@pytest.mark.parametrize(
    ("alphabet", "stands_for_all"),
    [(("", "A", "BC", "AB"), "AB"), (("", "A", "BC"), "BC"), (("", "ABC"), "ABC")],
)
def test_the_named_letter_or_another_member_represents_a_count(
    tmp_path: Path, alphabet: tuple[str, ...], stands_for_all: str
) -> None:
    found = the_class(tmp_path, *alphabet)
    assert on(found.representative) == stands_for_all
    assert sorted(on(member) for member in found.members) == sorted(
        {"AB", "AC", "BC", "ABC"} - {stands_for_all}
    )


def test_an_alphabet_without_any_member_of_a_class_is_unjudged(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="not in the alphabet"):
        the_class(tmp_path, "", "A", "C")

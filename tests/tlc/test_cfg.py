"""What a cfg checks is read from its text, and nothing that TLC 2.15 would ignore is let through."""

from __future__ import annotations

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import parse_cfg


@pytest.mark.parametrize(
    ("text", "checked"),
    [
        ("INVARIANT A\nINVARIANT B", ("A", "B")),
        ("INVARIANTS A B\n  C\nPROPERTIES P\nCONSTANT N = 3", ("A", "B", "C", "P")),
        ("PROPERTY P \\* Q\n(* INVARIANT R *)\nINVARIANT A", ("A", "P")),
        ("CONSTANTS A = {1, 2} B <- C\nSPECIFICATION Spec", ()),
        ("CONSTANT INVARIANTNAME = 1\nSPECIFICATION INVARIANT_X", ()),
        ("INVARIANT A VIEW View SYMMETRY Sym ACTION_CONSTRAINT C", ("A",)),
    ],
)
def test_the_checked_names_are_those_after_the_keywords(text: str, checked: tuple[str, ...]) -> None:
    assert parse_cfg(text, "x.cfg").checked == checked


def test_view_and_symmetry_are_seen() -> None:
    cfg = parse_cfg("VIEW View\nSYMMETRY Perms\nINVARIANT A", "x.cfg")
    assert cfg.view and cfg.symmetry
    assert not parse_cfg("INVARIANT A", "x.cfg").view


@pytest.mark.parametrize("word", ["CHECK_DEADLOCK", "ALIAS", "POSTCONDITION", "_PERIODIC"])
def test_a_keyword_of_a_newer_tlc_is_refused(word: str) -> None:
    with pytest.raises(Unjudged, match=f"x.cfg: {word}"):
        parse_cfg(f"INVARIANT A\n{word} FALSE", "x.cfg")


def test_constants_are_read_with_their_kind_and_without_comments() -> None:
    first = 'CONSTANT A <- Table  B = {"x", "y"}\n\\* C = 3\nINVARIANT I\n(* D = 4 *)\n'
    found = parse_cfg(first + "CONSTANTS E = 5\n F = [a |-> 1]\nVIEW V\n", "x.cfg")
    assert {name: (one.text, one.named) for name, one in found.constants.items()} == {
        "A": ("Table", True),
        "B": ('{"x", "y"}', False),
        "E": ("5", False),
        "F": ("[a |-> 1]", False),
    }
    assert parse_cfg(found.text(), "x.cfg") == found

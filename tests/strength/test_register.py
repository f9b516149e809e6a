"""strength.toml: what is not understood is refused, with place and cause."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.strength.register import load_strength
from modeproof.strength.trial import with_constants
from tests.strength.toy import STRENGTH, lamp


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('run = "OPEN_Lamp"', 'run = "OPEN_Gone"', "tier alone: run OPEN_Gone is not in runs.toml"),
        ('asks = "graph"', 'asks = "luck"', r"tier\[1\]\.asks: 'luck' is not allowed"),
        ('when = "left"', 'when = "never"', r"tier\[1\]\.when: 'never' is not allowed"),
        ('modules = ["Lamp"]', 'modules = ["Gone"]', "tier alone: module Gone is not declared"),
        ('id = "graph"', 'id = "alone"', "tier alone is declared twice"),
        ("heap_mb = 256", "heap = 256", "unknown key 'heap'"),
        ('behaviour = ["Init", "Scan", "Name"]', "", "key 'behaviour' is missing"),
        ('leave = ["Did"]', "leave = 3", "rule.leave: must be a list"),
        ('leave = ["Did"]', 'off = ["Literal"]', "rule: unknown key 'off'"),
        ('name = "Lamp"', 'name = "LampAsPrinted"', "a module of readings is not mutated"),
        (
            "[rule]",
            "[rule]\n[[survivor]]\nids = ['x']\nkind = 'luck'\nwhy = 'y'",
            "kind: 'luck' is not allowed",
        ),
    ],
)
def test_a_fault_of_the_register_is_named(old: str, new: str, complaint: str, tmp_path: Path) -> None:
    text = STRENGTH.replace(old, new, 1)
    if "survivor" in new:
        text = STRENGTH + new.replace("[rule]\n", "")
    with pytest.raises(Unjudged, match=complaint):
        lamp(tmp_path, text)


def test_a_document_without_the_register_says_so(tmp_path: Path) -> None:
    bench = lamp(tmp_path)
    (bench.folder / "strength.toml").unlink()
    with pytest.raises(Unjudged, match=r"strength\.toml: not found"):
        load_strength(tmp_path, "lamp")


def test_constants_of_a_cfg_are_replaced_or_added() -> None:
    text = 'CONSTANTS\n    A = 1  B <- C  D = "x"  E = {1, 2}\nSPECIFICATION S\n'
    changed = with_constants(text, {"A": "2", "B": "<- F", "D": '"y"', "E": "{}", "G": "<- H"}, "x.cfg")
    assert changed == (
        'CONSTANTS\n    A = 2  B <- F  D = "y"  E = {}\nSPECIFICATION S\nCONSTANTS\n    G <- H\n'
    )


def test_a_constant_that_is_set_twice_is_refused() -> None:
    with pytest.raises(Unjudged, match="A is set 2 times"):
        with_constants("CONSTANTS A = 1\nCONSTANTS A = 2\n", {"A": "3"}, "x.cfg")

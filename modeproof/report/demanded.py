"""Which demands are to be proved of our own reference implementation, and what evidence of it must say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.registers.demands import FILE, load_demand_rows
from modeproof.registers.load import load_interface
from modeproof.registers.profiles import LETTER, PROFILES, profiles_of

KIND = "demands"
SOLVERS = ("z3", "cvc5")


def subjects(place: Path, document: str) -> Iterator[tuple[str, str]]:
    """Each published target of a document of which something is demanded, with each of its profiles; without
    those of which the register says of every demand why it is not proved.
    """
    if not (place / "spec" / document / f"{FILE}.toml").is_file():
        return
    demands = load_demand_rows(place, document)
    for target, device in load_interface(place, document).devices.items():
        ids = {row.id for row in demands.of.get(target, ())}
        if device.published and ids - demands.unproved.get(target, {}).keys():
            for profile in PROFILES if profiles_of(device) else (LETTER,):
                yield target, profile


def id_of(target: str, profile: str) -> str:
    """The name of the evidence."""
    return f"{KIND}_{target}_{profile}"


def doubt_on_demands(place: Path, document: str, result: Mapping[str, Any]) -> str:
    """What speaks against evidence that says that all demands of a target are proved; empty: nothing."""
    demands = load_demand_rows(place, document)
    known = {row.id for row in demands.of.get(result["device"], ())}
    known -= demands.unproved.get(result["device"], {}).keys()
    words = {row["id"]: row["word"] for row in result["demands"]}
    if lost := sorted(known - words.keys()):
        return f"it says nothing of {lost[0]}"
    if bad := [f"{id}: {word}" for id, word in words.items() if word != "PROVED"]:
        return bad[0]
    other = result["answers"]["other_than_unsat"]
    if {*other} != {*SOLVERS} or any(other.values()) or result["answers"]["files"] < len(words):
        return "a proof was not checked by both solvers"
    return ""

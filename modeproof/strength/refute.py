"""Judges whether each edit of `[refuted]` refutes its theorems (modeproof/registers/refuting.py)."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.processes import cores, in_forks
from modeproof.kit.by_name import module_named
from modeproof.registers.citations import read_sources
from modeproof.registers.edits import write_stamps
from modeproof.registers.load import load_document
from modeproof.registers.pins import load_pins
from modeproof.registers.refuting import Edit, edited, load_refuting, stamps_of

LIMIT_S = 900.0
"""Wall-clock time for one edit; what takes longer is not judged."""
REFUTED = "refuted"


@dataclass(frozen=True)
class _Asked:
    place: Path
    document: str
    file: str
    text: str
    theorems: tuple[str, ...]


def _answers(asked: _Asked) -> Mapping[str, str]:
    """In a process of its own: forget what is loaded of code and proofs, then ask the theorems anew."""
    os.chdir(asked.place)
    sys.path.insert(0, str(asked.place))
    for name in [*sys.modules]:
        if name.partition(".")[0] in ("refimpl", "proofs"):
            del sys.modules[name]
    found: Mapping[str, str] = module_named("proofs.mutants.refuting").main(
        asked.document, asked.file, asked.text, asked.theorems
    )
    return found


def refutations(
    place: Path, document: str, edits: Mapping[str, Edit], say: Callable[[str], None]
) -> dict[str, Mapping[str, str]]:
    """For each edit, by its name, what its theorems say of the edited code.

    Raises Unjudged: a row that cannot be used, an edit that takes too long.
    """
    asked = [
        _Asked(place, document, edit.file, edited(place, document, edit), edit.theorems)
        for edit in edits.values()
    ]
    found: dict[str, Mapping[str, str]] = {}
    keys = [*edits]
    for outcome in in_forks(_answers, asked, cores(), LIMIT_S):
        if outcome is None:
            continue
        name = keys[outcome.number]
        if outcome.result is None:
            raise Unjudged(f"{document}: edit {name} was not judged: {outcome.why}")
        found[name] = outcome.result
        lost = sum(answer != REFUTED for answer in outcome.result.values())
        count = len(outcome.result)
        say(f"{document}: {name}: refutes {count - lost} of {count}")
    return found


def judge_refuting(place: Path, name: str, everything: bool, say: Callable[[str], None]) -> list[str]:
    """Judge the edits of a document whose stamps are not of the present text, or `everything`; stamp them.

    One line for each theorem that its edit does not refute; such an edit gets no stamp. Raises Unjudged.
    """
    document = load_document(place, name)
    refuting = load_refuting(place, name)
    stamps = stamps_of(document, read_sources(document), refuting)
    for edit, stamp in stamps.items():
        if isinstance(stamp, Unjudged):
            raise Unjudged(f"{name}: {edit}: {stamp.message}")
    known = load_pins(document).refuted
    good = {edit: str(stamp) for edit, stamp in stamps.items() if known.get(edit) == stamp}
    waiting = {edit: row for edit, row in refuting.edits.items() if everything or edit not in good}
    lost: list[str] = []
    for edit, answers in refutations(place, name, waiting, say).items():
        wrong = [f"{theorem} ({edit}): {said}" for theorem, said in answers.items() if said != REFUTED]
        good.pop(edit, None)
        if not wrong:
            good[edit] = str(stamps[edit])
        lost += wrong
    if good != known:
        write_stamps(document, "refuted", {edit: good[edit] for edit in stamps if edit in good})
    return sorted(lost)

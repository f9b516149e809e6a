"""The bench on which changed copies of a document's code are judged, and what of the code is to be changed.

The room of a document says in `subjects.py` which devices are judged (`SUBJECTS`) and in `judges.py` which
theorems judge them (`JUDGES`, by device).
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from modeproof.kit.by_name import module_named
from proofs.mutants.copies import Change
from proofs.mutants.copy_judge import Bench
from proofs.mutants.shipped import Subject, functions_of, shipped
from proofs.theorem import Theorem


def bench_of(document: str) -> Bench:
    """The bench of a document, with every device of it: what one module does may matter to another device.

    Raises ExplorationError when the shipped code cannot be explored.
    """
    return Bench(
        f"refimpl.{document}",
        {subject.device.name: shipped(subject) for subject in _subjects(document)},
        _judges(document),
    )


def _subjects(document: str) -> Sequence[Subject]:
    found: Sequence[Subject] = module_named(f"proofs.{document}.subjects").SUBJECTS
    return found


def _judges(document: str) -> Mapping[str, Sequence[Theorem]]:
    found: Mapping[str, Sequence[Theorem]] = module_named(f"proofs.{document}.judges").JUDGES
    return found


def judged(bench: Bench, change: Mapping[str, Any], complete: bool) -> dict[str, Any]:
    """What becomes of a change: module, definition, text, lines and file. As JSON, for the results."""
    told = Change(change["module"], change["definition"], change["text"], change["lines"])
    found = bench.judge(told, change["file"], complete)
    return {
        "verdict": found.verdict,
        "killers": list(found.killers),
        "reason": found.reason,
        "witness": found.witness,
        "answers": [asdict(answer) for answer in found.asked],
    }


def theorems(document: str) -> dict[str, str]:
    """Every theorem that judges, in order, and the module in which it is written."""
    asked = {query.name: query.build.__module__ for found in _judges(document).values() for query in found}
    answered = {subject.answered: "proofs.mutants.copy_judge" for subject in _subjects(document)}
    return {**asked, **answered}


def texts(document: str) -> list[tuple[str, ...]]:
    """The lists of texts that the interface of the devices declares."""
    found: dict[tuple[str, ...], Any] = {}
    for subject in _subjects(document):
        register = subject.device.register
        for group in (register.inputs, register.outputs, register.parameters):
            found.update({tuple(signal.values): None for signal in group.values() if signal.type == "text"})
    return list(found)


def reached(document: str) -> dict[str, tuple[Path, frozenset[str]]]:
    """The modules that some step or power-up of the document reaches: files, and functions reached."""
    found: dict[str, set[str]] = {}
    for subject in _subjects(document):
        for module, function in functions_of(subject.device):
            found.setdefault(module, set()).add(function)
    return {
        name: (Path(inspect.getfile(module_named(name))), frozenset(functions))
        for name, functions in found.items()
    }

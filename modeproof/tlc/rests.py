"""What a run of TLC rests on, and whether its evidence, and the graph that it printed, still fit it.

TLC's own checkpoints are not used (docs/decisions.md).
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import msgspec

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import meaning_of, meanings, reached
from modeproof.registers.made import cfg_text, module_text, replaced_by
from modeproof.registers.runs import Run
from modeproof.registers.tla import read_modules
from modeproof.tlc.start_up import entries
from modeproof.tlc.toolchain import Toolchain

CODE = ("modeproof/tlc/check.py",)
"""The module that runs TLC and judges what it says."""


def declaration_sha256(run: Run) -> str:
    """SHA-256 of all that runs.toml says of a run, pins included; another run's pins do not matter."""
    text = json.dumps(msgspec.to_builtins(run), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def inputs_of(place: Path, run: Run) -> dict[str, str]:
    """The meanings of the modules and the cfg that TLC reads for a run, by hand or made, by path; of those
    that are there.

    Raises Unjudged when what is to be made cannot be made.
    """
    folder = place / "spec" / run.document
    modules = [folder / f"{run.module}.tla"]
    made: dict[str, str] = {}
    if run.base or not run.cfg:
        known = read_modules(place, run.document)
        modules += [place / known[one.module].file for one in replaced_by(known, run)]
        texts = {run.config: cfg_text(place, run)}
        texts[Path(run.config).with_suffix(".tla").as_posix()] = module_text(place, run)
        made = {name: meaning_of(name, text.encode()) for name, text in texts.items()}
    paths = reached(place, *(path for path in modules if path.is_file()))
    cfg = [folder / run.cfg] if run.cfg and (folder / run.cfg).is_file() else []
    return dict(sorted((meanings(place, [*paths, *cfg]) | made).items()))


def rests_of(place: Path, run: Run, tools: Toolchain) -> evidence.Rests:
    """All that the result of a run rests on. Raises Unjudged as `inputs_of` does."""
    return evidence.Rests(inputs_of(place, run), CODE, entries(tools), row_of(run))


def row_of(run: Run) -> dict[str, str]:
    """What a result says of the row of its run."""
    return {"declaration": declaration_sha256(run)}


def why_stale(place: Path, run: Run) -> str:
    """Why the evidence of a run, and the graph that it printed, fit no longer; empty when they do.

    Who reads a graph asks this, so the tools that made it are no matter.
    """
    path = evidence.evidence_path(place, run.document, run.id)
    if not path.is_file():
        return "no evidence"
    try:
        record = evidence.read(path)
        rests = evidence.Rests(inputs_of(place, run), said=row_of(run))
    except Unjudged as error:
        return error.message
    if run.graph is not None and "sha256" not in record["result"].get("graph", {}):
        return "its evidence names no graph"
    return evidence.why_again(place, record, rests, alone=True)

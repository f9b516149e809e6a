"""Runs TLC on copies of the specification, with one edit planted or none.

The copy lies in a folder of the test. Its configuration is a declared one, with its bounds made smaller.
Nothing of the repository is changed.
"""

from __future__ import annotations

import hashlib
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import msgspec

from modeproof.ground.places import build, root
from modeproof.registers.cfg import Cfg, parse_cfg
from modeproof.registers.made import cfg_text
from modeproof.registers.runs import Run, load_runs
from modeproof.tlc.process import Outcome, run_tlc
from modeproof.tlc.run_judge import Judgement, judge
from modeproof.tlc.toolchain import find_toolchain

DOCUMENT = "mode_selection"
SPEC = root() / "spec" / DOCUMENT
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}

_CHECKED = re.compile(r"^(INVARIANTS?|PROPERTY|PROPERTIES|ACTION_CONSTRAINT)\b.*\n?", re.MULTILINE)

Edit = tuple[str, str]


@dataclass(frozen=True)
class Base:
    """A declared run whose bounds are made small: `run` is its id, `edits` are applied to its cfg.

    `module` is checked in the place of the declared one; it extends that one and lies beside this file.
    """

    run: str
    edits: tuple[Edit, ...] = ()
    module: str = ""

    @property
    def declared(self) -> Run:
        """The run as runs.toml declares it, with the module of the base and a cfg by hand."""
        run = RUNS[self.run]
        assert not run.readings, f"{self.run} has a reading, so its root module would have to be made"
        return msgspec.structs.replace(
            run, module=self.module or run.module, cfg=f"models/{run.id}.cfg", base=""
        )

    @property
    def checks(self) -> str:
        """The module of the repository that is checked."""
        return RUNS[self.run].module

    @property
    def cfg_text(self) -> str:
        """The cfg of the run with the edits of the base."""
        return change(cfg_text(root(), RUNS[self.run]), self.edits, self.run)


@dataclass(frozen=True)
class Fault:
    """One edit of one module. `old` must occur in `file` exactly once."""

    name: str
    file: str
    old: str
    new: str


@dataclass(frozen=True)
class Finding:
    """What came of a TLC run on a copy."""

    run: Run
    cfg: Cfg
    judgement: Judgement
    outcome: Outcome
    log: str


@dataclass(frozen=True)
class Trial:
    """TLC on a copy of the specification in which `fault` is planted (None: nothing is).

    With `invariants` or `properties`, only these are checked and nothing is printed; without, the cfg of the
    base stays as it is.
    """

    base: Base
    fault: Fault | None = None
    invariants: tuple[str, ...] = ()
    properties: tuple[str, ...] = ()

    def __str__(self) -> str:
        names = " ".join((*self.invariants, *self.properties)) or self.base.run
        module = self.base.declared.module
        return f"{names} of {module}: {self.fault.name if self.fault else 'nothing planted'}"

    def run(self, place: Path) -> Finding:
        """Copy, plant, run and judge below `place`."""
        copy(place)
        if self.fault is not None:
            plant(place, self.fault)
        run, text = self.base.declared, self.base.cfg_text
        if self.invariants or self.properties:
            names = (*self.invariants, *self.properties)
            run = msgspec.structs.replace(
                run, kind="LIVE" if run.kind == "LIVE" else "MC", properties=names, property="", graph=None
            )
            text = _CHECKED.sub("", text)
            text += f"INVARIANTS {' '.join(self.invariants)}\n" if self.invariants else ""
            text += f"PROPERTIES {' '.join(self.properties)}\n" if self.properties else ""
        return run_copy(place, run, text)


def change(text: str, edits: tuple[Edit, ...], where: str) -> str:
    """Apply edits, each of which must match exactly once."""
    for old, new in edits:
        assert text.count(old) == 1, f"{where}: {old!r} occurs {text.count(old)} times, not once"
        text = text.replace(old, new)
    return text


def copy(place: Path) -> None:
    """Copy the specification below `place`, what all documents share, and the modules of these tests."""
    folder = place / "spec" / DOCUMENT
    shutil.copytree(SPEC, folder)
    shutil.copytree(SPEC.parent / "common", place / "spec/common")
    for module in Path(__file__).parent.glob("*.tla"):
        shutil.copy(module, folder)


def plant(place: Path, fault: Fault) -> None:
    """Apply a fault to the copy below `place`."""
    path = place / "spec" / DOCUMENT / fault.file
    path.write_text(change(path.read_text(), ((fault.old, fault.new),), fault.file))


def run_copy(place: Path, run: Run, text: str) -> Finding:
    """Run TLC on the copy below `place` with this text as the cfg of the run, one worker; judge the outcome.

    The cfg counts as the pinned one.
    """
    path = place / "spec" / DOCUMENT / run.cfg
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    digest = hashlib.sha256(text.encode()).hexdigest()
    run = msgspec.structs.replace(run, workers=1, heap_mb=1024, timeout_s=1800.0, cfg_sha256=digest)
    outcome = run_tlc(place, run, find_toolchain())
    cfg = parse_cfg(text, run.cfg)
    found = judge(run, cfg, digest, outcome)
    log = (build(place) / "tlc" / DOCUMENT / f"{run.id}.log").read_text()
    return Finding(run, cfg, found, outcome, log)


def pinned(control: Finding) -> Run:
    """The run of a control with the counts that TLC found in it as pins, and the names met as witnesses."""
    counts = control.outcome.log.counts
    assert counts is not None
    tags, graph = control.outcome.log.tags, control.run.graph
    if graph is not None:
        graph = msgspec.structs.replace(graph, states=tags.get("STATE", 0), edges=tags.get("EDGE", 0))
    witnesses = control.judgement.reached or control.run.witnesses
    return msgspec.structs.replace(
        control.run, distinct=counts.distinct, generated=counts.generated, graph=graph, witnesses=witnesses
    )


KEY_FLOWS = Base("MC_KeyFlows_smoke")
CONTRACT_ANYWHERE = Base("MC_ModeSelection_anywhere")

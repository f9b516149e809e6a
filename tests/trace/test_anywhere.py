"""A log may begin in exactly the states that power-up reaches, no more and no fewer."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.ground.places import root
from modeproof.registers.made import cfg_text
from modeproof.registers.runs import load_runs
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import find_toolchain
from modeproof.trace.exact import trace_run
from modeproof.trace.targets import find_target

OBSERVER = ["resetSeen", "requestSeen", "asked", "starting", "lost", "unguarded"]
NOTHING_SEEN = " /\\ in = 0 /\\ beat = FALSE" + "".join(f" /\\ {name} = FALSE" for name in OBSERVER)
GUARD = "GuardLockingOpen, GuardLockingTrace"
_CHECKS = re.compile(
    r"^(SPECIFICATION|VIEW|ACTION_CONSTRAINT|INVARIANTS|PROPERTIES|\\\*).*\n(?: .*\n)*", re.MULTILINE
)


@pytest.mark.sampled
@pytest.mark.parametrize(
    ("device", "run", "module", "extra"),
    [
        ("fplc", "OPEN_Fplc", "FplcTrace", ""),
        ("fplc", "OPEN_Fplc_letter", "FplcTrace", ""),
        ("hmi", "OPEN_Hmi", "HmiTrace", ""),
        ("eks", "OPEN_Eks6", "EksOpen, EksTrace", " /\\ in = 0 /\\ beat = FALSE /\\ lasted = 0"),
        ("sf_guard_locking", "OPEN_SF_GuardLocking", GUARD, NOTHING_SEEN),
        ("sf_guard_locking", "OPEN_SF_GuardLocking_cautious", GUARD, NOTHING_SEEN),
    ],
)
def test_as_many_as_the_graph_has(device: str, run: str, module: str, extra: str, tmp_path: Path) -> None:
    target = find_target(root(), device)
    declared_run = next(one for one in load_runs(root(), target.document) if one.id == run)
    text = f"---- MODULE Any ----\nEXTENDS {module}\nAnyInit == {target.anywhere}{extra}\n"
    (tmp_path / "Any.tla").write_text(text + "AnyNext == FALSE /\\ UNCHANGED step\n====\n")
    declared = cfg_text(root(), declared_run)
    cfg = _CHECKS.sub("", declared).replace("PRINT_GRAPH = TRUE", "PRINT_GRAPH = FALSE" if extra else "")
    cfg = cfg.replace('VECTORS = "classes"', "")
    cfg += "CONSTANTS SEEN = 0 DEVICE_CHECKSUM = 0\n" if device == "eks" else ""
    (tmp_path / "Any.cfg").write_text(cfg + "INIT AnyInit\nNEXT AnyNext\n")
    place = tmp_path / "root"
    (place / "spec").mkdir(parents=True)
    for room in (target.document, "common"):
        (place / "spec" / room).symlink_to(root() / "spec" / room)
    log = run_tlc(place, trace_run(target, "Any", 512), find_toolchain(), made_in=tmp_path).log
    assert log.errors == [] and log.counts is not None
    graph = declared_run.graph
    assert graph is not None and log.counts.distinct == graph.states

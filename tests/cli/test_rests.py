"""What a result is said to rest on is all that is read for it: each file that is opened is known."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from modeproof.ground.meaning import reached
from modeproof.ground.places import TREE
from modeproof.lane.machine_command import machine_rests
from modeproof.lane.theorem import rests_of, theorems_of

READ = """
import json, sys
from pathlib import Path
from tests.watching import reads
with reads(Path.cwd()) as found:
    {work}
print(json.dumps(sorted(found)))
"""
THEOREM = """
    from modeproof.lane.theorem import theorems_of
    (one,) = [one for one in theorems_of("{document}") if one.name == "{name}"]
    one.queries()
"""
MACHINE = """
    import machines.evidence as machine
    import machines.tlc_runs as models
    machine.looked_at(Path.cwd() / "spec/machine_cell")
    list(models.tasks(None, Path.cwd() / "spec/machine_cell"))
"""


def read_by(work: str) -> set[str]:
    """The files of ours that are read in a new process, the tests and what was made left out."""
    env = {**os.environ, "PYTHONPATH": str(TREE)}
    command = [sys.executable, "-c", READ.format(work=work.strip())]
    done = subprocess.run(command, cwd=TREE, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found: list[str] = json.loads(done.stdout.splitlines()[-1])
    return {name for name in found if not name.startswith((".", "build/", "tests/"))}


def known(code: tuple[str, ...]) -> set[str]:
    return {path.relative_to(TREE).as_posix() for path in reached(TREE, *code)}


THEOREMS = [
    ("edm", "a_call_takes_one_transition_at_most"),
    ("edm", "the_output_is_on_again_within_four_calls"),
    ("mode_selection", "the_specification_and_the_implementation_have_the_same_tables"),
    pytest.param(
        "mode_selection", "the_panel_cannot_tell_the_words_of_one_class_apart", marks=pytest.mark.deep
    ),
]


@pytest.mark.parametrize("document, name", THEOREMS)
def test_every_file_that_a_theorem_reads_is_known(document: str, name: str) -> None:
    (one,) = [one for one in theorems_of(document) if one.name == name]
    rests = rests_of(TREE, document, one.build.__module__)
    found = read_by(THEOREM.format(document=document, name=name))
    assert f"spec/{document}/interface.toml" in found and f"proofs/{document}/devices.py" in found
    unknown = found - rests.inputs.keys() - known(rests.code)
    others = {file for file in known((f"proofs/{document}",)) if file.startswith("proofs/")}
    assert unknown <= others, "modules of other theorems are loaded as well, and they read nothing"


def test_every_file_that_the_machine_reads_is_known() -> None:
    rests = machine_rests(TREE, "machine_cell")
    found = read_by(MACHINE)
    assert {"spec/machine_cell/wiring.toml", "proofs/edm/devices.py", "refimpl/edm/sf_edm.py"} <= found
    assert found - rests.inputs.keys() - known(rests.code) == set()
    shorter = tuple(module for module in rests.code if not module.startswith("proofs."))
    assert "proofs/edm/devices.py" in found - rests.inputs.keys() - known(shorter)

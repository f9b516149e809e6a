"""A document that is checked, walked and rendered in a few seconds: a box with one door."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

import pytest

from modeproof.cli import main

BOX = r"""------------------------------- MODULE Box -------------------------------
(* The box: it shuts when the door is there; BX-1-1. *)
EXTENDS Integers, TLC
CONSTANTS RECORD
VARIABLES boxState, shut, step
Did(name) == step' = IF RECORD THEN name ELSE ""
CODE == TLCEval([m \in 0..1 |-> 3855 + m])
BoxInit == boxState = "Open" /\ shut = 0
Out == [WORD |-> IF shut = 1 THEN CODE[1] ELSE 0, LAMP |-> boxState = "Shut", SPARE |-> FALSE]
Needed == TRUE
NotNeeded == FALSE
Ready(i) == i.door \/ ~Needed
\* BX-1-1, E-01
Close(i) == boxState = "Open" /\ Ready(i) /\ boxState' = "Shut" /\ shut' = 1 /\ Did("Close")
\* BX-1-1
Wait(i) == boxState = "Open" /\ ~Ready(i) /\ UNCHANGED <<boxState, shut>> /\ Did("Wait")
\* BX-1-1
Stay(i) == boxState = "Shut" /\ UNCHANGED <<boxState, shut>> /\ Did("Stay")
BoxScan(i) == Close(i) \/ Wait(i) \/ Stay(i)
============================================================================
"""
BOX_OPEN = r"""----------------------------- MODULE BoxOpen -----------------------------
(* The box alone. *)
EXTENDS Box
CONSTANT START
VARIABLES door
Nothing == FALSE
Init == BoxInit /\ step = "" /\ door = START
Next == door' \in BOOLEAN /\ BoxScan([door |-> door', dt |-> 1])
Spec == Init /\ [][Next]_<<boxState, shut, step, door>>
Scanned == [door |-> door', dt |-> 1]
Wires == [door |-> door, dt |-> 1] @@ Out
(* BX-1-2 *)
ShutsOverDoor == [][boxState' # boxState => door']_<<boxState, shut>>
============================================================================
"""
BOX_AS_PRINTED = r"""-------------------------- MODULE BoxAsPrinted --------------------------
(* What the paper could be taken to say. *)
EXTENDS Box
\* BX-1-1, E-01: it shuts at once
Ready_Eager(i) == TRUE
\* BX-1-1, E-01: nobody says what it does when it is shut
Stay_Lazy(i) == FALSE
============================================================================
"""
CFG = "CONSTANTS RECORD = %s START <- Nothing\nSPECIFICATION Spec\nPROPERTY ShutsOverDoor\n"
CFGS = {"MC_Box": CFG % "TRUE", "NEG_Box_hasty": "CONSTANT Needed <- NotNeeded\n" + CFG % "FALSE"}
RUN = """
[[run]]
id = "{id}"
module = "BoxOpen"
cfg = "models/{id}.cfg"
lanes = ["full"]
environment = "arbitrary"
strength = "{strength}"
workers = 1
heap_mb = 256
timeout_s = 600
properties = ["ShutsOverDoor"]
cfg_sha256 = "{hash}"
{pins}
"""
REGISTERS = {
    "clauses": """
[paper]
title = "A box"
number = "BX 1"
edition = "first"
publisher = "nobody"
prefix = "BX"
seed = "none"
sha256 = "0000000000000000000000000000000000000000000000000000000000000000"
available = ["text"]
not_available = ["drawings"]
not_endorsed = "by nobody"
[[clause]]
id = "BX-1-1"
title = "the box shuts"
text = "It shuts."
kind = "behaviour"
device = ["box"]

[[clause]]
id = "BX-1-2"
title = "over the door"
text = "It shuts over the door."
kind = "property"
device = ["box"]
""",
    "interface": """
document = "box"
[devices.box]
title = "a box: it shuts"
module = "Box"
published = false
states = ["Open", "Shut"]
steps = ["Close", "Wait", "Stay"]
[devices.box.memory]
state = { type = "text", clauses = ["BX-1-1"], why = "what it does" }
[devices.box.inputs]
door = { type = "bool", clauses = ["BX-1-1"], why = "the door is there" }
[devices.box.outputs]
WORD = { type = "word", clauses = ["BX-1-1"], why = "a word" }
LAMP = { type = "bool", clauses = ["BX-1-1"], why = "it is shut" }
SPARE = { type = "bool", clauses = ["BX-1-1"], why = "nothing" }
[devices.box.parameters]
T_HOLD_ms = { type = "ms", min = 1, max = 10, default = 1, clauses = ["BX-1-1"], why = "time" }
""",
    "properties": """
[[property]]
id = "ShutsOverDoor"
title = "it shuts over the door"
sentence = "It shuts only over the door."
hazard = "It shuts on a hand."
clauses = ["BX-1-2", "BX-1-1"]
tla = "ShutsOverDoor"
module = "BoxOpen"
kind = "action"
environments = ["arbitrary"]
antecedent = ""
reason = "a toy"
""",
    "findings": """
[[finding]]
id = "E-01"
title = "does it wait for the door"
clauses = ["BX-1-1"]
says = "It shuts."
readings = ["at once", "when the door is there"]
consequence = "It shuts on a hand."
decision = "It waits for the door. And more."
drawing_could_settle = true
tries = ["Eager", "Lazy"]
evidence = ["NEG_Box_eager", "MC_Box_lazy", "NEG_Box_hasty"]
[finding.telling]
run = "NEG_Box_eager"
story = "Nothing is in the door, and the box shuts."

[[finding]]
id = "E-02"
title = "a slip of the pen"
clauses = []
says = "nothing"
readings = ["none", "some"]
consequence = "none"
decision = "none"
drawing_could_settle = false
evidence = []
evidence_open = "no model can show a slip of the pen"
""",
    "assumptions": """
[[assumption]]
id = "A-01"
title = "one door"
text = "There is one door."
kind = "assumption"
clauses = ["BX-1-1"]
who = "the builder"
check = "count"
breaks = ["NEG_Box_hasty"]
""",
    "replay": """
document = "box"
step = "step"
recorded = "RECORD"
[[word]]
table = "CODE"
says = "code"
signals = ["WORD"]
[[vector]]
id = "lamps"
signals = ["LAMP", "SPARE"]
labels = ["lamp", "spare"]
[devices.box]
init = "BoxInit"
scan = "BoxScan"
outputs = "Out"
short = "box"
[tops.BoxOpen]
next = "Next"
wires = "Wires"
columns = ["door", "box", "WORD", "lamps", "SPARE"]
[tops.BoxOpen.inputs]
box = "Scanned"
""",
}


def declared(name: str, strength: str, pins: str, cfg: str = "") -> str:
    """The [[run]] table of one run, of a cfg in `CFGS` or of this one."""
    digest = hashlib.sha256((cfg or CFGS[name]).encode()).hexdigest()
    return RUN.format(id=name, strength=strength, hash=digest, pins=pins)


def tried(name: str, reading: str, pins: str) -> str:
    """The [[run]] table of MC_Box with a reading."""
    head = f'\n[[run]]\nid = "{name}"\nbase = "MC_Box"\nlanes = ["full"]\n'
    return f'{head}reading = "{reading}"\n{pins}'


def make_box(root: Path) -> Path:
    """The root of a repository with the document."""
    folder = root / "spec" / "box"
    (folder / "models").mkdir(parents=True)
    (folder / "Box.tla").write_text(BOX)
    (folder / "BoxOpen.tla").write_text(BOX_OPEN)
    (folder / "BoxAsPrinted.tla").write_text(BOX_AS_PRINTED)
    for name, text in CFGS.items():
        (folder / "models" / f"{name}.cfg").write_text(text)
    for name, text in REGISTERS.items():
        (folder / f"{name}.toml").write_text(text.lstrip())
    runs = declared("MC_Box", "any door", "distinct = 5\ngenerated = 11\n")
    runs += tried("MC_Box_lazy", "Lazy", "distinct = 3\ngenerated = 5\n")
    negative = 'property = "ShutsOverDoor"\ntrace_length = 2\n'
    runs += tried("NEG_Box_eager", "Eager", negative)
    runs += declared("NEG_Box_hasty", "the bounds of MC_Box", negative)
    (folder / "runs.toml").write_text(runs)
    return root


@pytest.fixture(scope="session")
def evidence_of_the_box(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The box with its evidence and its rendered pages; to be copied, not changed."""
    root = make_box(tmp_path_factory.mktemp("checked"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MODEPROOF_ROOT", str(root))
        assert main(["check", "--quiet", "MC_Box_lazy", "NEG_Box_eager", "NEG_Box_hasty"]) == 0
        assert main(["walks", "--quiet"]) == 0
        assert main(["render"]) == 0
    return root


@pytest.fixture
def checked(evidence_of_the_box: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the box with evidence, walks and pages; the command line works on it."""
    root = tmp_path / "box"
    shutil.copytree(evidence_of_the_box, root)
    monkeypatch.setenv("MODEPROOF_ROOT", str(root))
    return root

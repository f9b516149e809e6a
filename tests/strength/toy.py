"""A small document whose mutants have known fates, and a module with a place for every operator."""

from __future__ import annotations

import hashlib
from pathlib import Path

from modeproof.strength.mutant_judge import Bench
from modeproof.strength.register import load_strength
from modeproof.tlc.toolchain import find_toolchain

LAMP = r"""
---- MODULE Lamp ----
EXTENDS Integers
VARIABLES count, lamp
lampVars == <<count, lamp>>
TypeOK == count \in 0..3 /\ lamp \in {"off", "on"}
Init == count = 0 /\ lamp = "off"
\* a comment with a guard: count < 3
Up(i) == i.up /\ count < 3 /\ count # 3 /\ count' = count + 1 /\ UNCHANGED lamp
Light(i) ==
    /\ i.up
    /\ count = 3
    /\ lamp' = "on"
    /\ UNCHANGED count
Down(i) == ~i.up /\ count' = 0 /\ lamp' = "off"
Scan(i) == Up(i) \/ Light(i) \/ Down(i)
Name == <<"zero", "one", "two", "three">>[count + 1]
====
"""

OPEN = r"""
---- MODULE LampOpen ----
EXTENDS Sequences, TLC, Lamp
CONSTANT PRINT
VARIABLES in, beat
View == <<count, lamp>>
Inputs == <<[up |-> FALSE], [up |-> TRUE]>>
OpenInit == Init /\ in = 1 /\ beat = FALSE /\ (PRINT => PrintT(ToString(<<"INIT", View>>)))
OpenNext == \E n \in 1..2 : Scan(Inputs[n]) /\ in' = n /\ beat' = ~beat
OpenSpec == OpenInit /\ [][OpenNext]_<<View, in, beat>>
PrintState == PRINT => PrintT(ToString(<<"STATE", View, Name>>))
PrintEdge == PRINT => PrintT(ToString(<<"EDGE", View, in', View'>>))
LitOnlyWhenFull ==
    [][lamp' = "on" =>
        \/ count = 3
        \/ lamp = "on"]_beat
OffAtOnce == [][Inputs[in'].up \/ lamp' = "off"]_beat
StartsDark == lamp = "on" => count # 0
====
"""

CFG = """CONSTANT PRINT = TRUE
SPECIFICATION OpenSpec
VIEW View
ACTION_CONSTRAINT PrintEdge
INVARIANTS PrintState StartsDark
PROPERTIES LitOnlyWhenFull OffAtOnce
"""

RUNS = """
[[run]]
id = "OPEN_Lamp"
module = "LampOpen"
cfg = "models/OPEN_Lamp.cfg"
lanes = ["smoke"]
environment = "arbitrary"
workers = 1
heap_mb = 256
timeout_s = 600
properties = ["PrintState", "StartsDark", "LitOnlyWhenFull", "OffAtOnce"]
cfg_sha256 = "{sha}"
[run.graph]
device = "lamp"
tick_ms = 10
"""

STRENGTH = """
[rule]
leave = ["Did"]

[[module]]
name = "Lamp"
behaviour = ["Init", "Scan", "Name"]

[[tier]]
id = "alone"
modules = ["Lamp"]
run = "OPEN_Lamp"
asks = "properties"
constants = { PRINT = "FALSE" }
timeout_s = 500
heap_mb = 256

[[tier]]
id = "graph"
modules = ["Lamp"]
run = "OPEN_Lamp"
asks = "graph"
when = "left"
timeout_s = 600
heap_mb = 256
"""


def lamp(root: Path, strength: str = STRENGTH) -> Bench:
    """A root with the document `lamp`, ready to judge."""
    folder = root / "spec" / "lamp"
    (folder / "models").mkdir(parents=True)
    (folder / "Lamp.tla").write_text(LAMP.lstrip())
    (folder / "LampOpen.tla").write_text(OPEN.lstrip())
    (folder / "models" / "OPEN_Lamp.cfg").write_text(CFG)
    (folder / "runs.toml").write_text(RUNS.format(sha=hashlib.sha256(CFG.encode()).hexdigest()))
    (folder / "strength.toml").write_text(strength)
    return Bench(root, load_strength(root, "lamp"), find_toolchain())


EVERY_OPERATOR = r"""
---- MODULE Every ----
EXTENDS Integers
CONSTANTS LONG, SHORT
VARIABLES x, y
both == <<x, y>>
Table == {1}
Other == {2}
Init == x = 0 /\ y = "red"
Stay == UNCHANGED both
Guard(i) ==
    \/ i.a
    \/ /\ ~i.b
       /\ i.c >= LONG
Pick(i) == IF i.a THEN 1 ELSE 2
Colour == CASE y = "red" -> "green" [] OTHER -> "red"
Sets == Table \cup Other
All == \A n \in Sets : n < 5
Set(i) == y = "red" /\ Guard(i) /\ x' = Pick(i) - 1 /\ y' = "green"
Wait(i) ==
    /\ y = Colour /\ i.d
    /\ UNCHANGED x
    /\ UNCHANGED y
Group(i) == (y = "red" /\ (Set(i) \/ Wait(i))) \/ (All /\ Stay)
Unused == x = 3
====
"""

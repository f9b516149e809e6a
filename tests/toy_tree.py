"""A small repository root with one document, for tests that start TLC or the command line on it."""

from __future__ import annotations

import hashlib
from pathlib import Path

TOY_TLA = r"""
------------------------------- MODULE Toy -------------------------------
EXTENDS Naturals, Sequences, TLC
CONSTANTS N, SLEEP, PRINT
VARIABLES count, top, in, step
vars == <<count, top, in, step>>
View == <<count, top>>

ASSUME N \in 1..1000000
ASSUME PRINT => \A n \in 0..1 : PrintT(ToString(<<"INPUT", n, [up |-> n = 1]>>))

Init == count = 0 /\ top = FALSE /\ in = 0 /\ step = ""
        /\ (PRINT => PrintT(ToString(<<"INIT", View>>)))
Up   == in' = 1 /\ count < N /\ count' = count + 1 /\ step' = "Up" /\ top' = (top \/ count' = N)
Stay == in' = 1 /\ count = N /\ step' = "Stay" /\ UNCHANGED <<count, top>>
Down == in' = 0 /\ count' = (IF count = 0 THEN 0 ELSE count - 1) /\ step' = "Down" /\ UNCHANGED top
Next == Up \/ Stay \/ Down
Spec == Init /\ [][Next]_vars
FairSpec == Spec /\ WF_vars(Up)

TypeOK == count \in 0..N /\ (SLEEP => \A n \in 1..2000 : n > 0)
Small == count < 3
NeverDown == [][count' >= count]_View
Reaches == <>(count = N)
Risen == count > 0
StartsTop == count = N /\ [][Next]_vars
Witness == /\ (top => PrintT(ToString(<<"REACHED", "top">>)))
           /\ (step = "Down" => PrintT(ToString(<<"REACHED", "down">>)))
PrintState == PRINT => PrintT(ToString(<<"STATE", View, [full |-> count = N]>>))
PrintEdge == PRINT => PrintT(ToString(<<"EDGE", View, step', in', View'>>))
==========================================================================
"""

CFGS = {
    "MC_toy": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\nINVARIANTS TypeOK\n",
    "NEG_small": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\nINVARIANTS TypeOK Small\n",
    "NEG_down": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\n"
    "INVARIANT TypeOK\nPROPERTY NeverDown\n",
    "NEG_reaches": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\nPROPERTY Reaches\n",
    "NEG_risen": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\nINVARIANTS TypeOK Risen\n",
    "NEG_starts": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\n"
    "INVARIANT TypeOK\nPROPERTY StartsTop\n",
    "WIT_toy": "CONSTANTS N = 4 SLEEP = FALSE PRINT = FALSE\nSPECIFICATION Spec\nINVARIANTS TypeOK Witness\n",
    "OPEN_toy": "CONSTANTS N = 4 SLEEP = FALSE PRINT = TRUE\nSPECIFICATION Spec\nVIEW View\n"
    "ACTION_CONSTRAINT PrintEdge\nINVARIANTS TypeOK PrintState\n",
    "MC_big": "CONSTANTS N = 900000 SLEEP = TRUE PRINT = FALSE\nSPECIFICATION Spec\nINVARIANTS TypeOK\n",
}

_DECLARED = {
    "MC_toy": 'properties = ["TypeOK"]\ndistinct = {distinct}\ngenerated = {generated}\n',
    "NEG_small": 'properties = ["TypeOK", "Small"]\nproperty = "Small"\ntrace_length = 4\n',
    "NEG_down": 'properties = ["TypeOK", "NeverDown"]\nproperty = "NeverDown"\ntrace_length = 3\n',
    "NEG_reaches": 'properties = ["Reaches"]\nproperty = "Reaches"\ntrace_length = 2\n',
    "NEG_risen": 'properties = ["TypeOK", "Risen"]\nproperty = "Risen"\ntrace_length = 1\n',
    "NEG_starts": 'properties = ["TypeOK", "StartsTop"]\nproperty = "StartsTop"\ntrace_length = 1\n',
    "WIT_toy": 'properties = ["TypeOK", "Witness"]\nwitnesses = ["top", "down"]\n'
    "distinct = {distinct}\ngenerated = {generated}\n",
    "OPEN_toy": 'properties = ["TypeOK", "PrintState"]\ndistinct = 9\ngenerated = 19\n'
    '[run.graph]\ndevice = "toy"\ntick_ms = 250\nstates = 9\nedges = 18\n',
    "MC_big": 'properties = ["TypeOK"]\ndistinct = 1\ngenerated = 1\n',
}

DISTINCT, GENERATED = 16, 33
"""Of MC_toy and WIT_toy, as TLC counts them."""


def sha256(text: str) -> str:
    """SHA-256 of a text as it lies in the file."""
    return hashlib.sha256(text.encode()).hexdigest()


def declaration(name: str, **changes: str | int) -> str:
    """The [[run]] table of one toy run; keyword arguments replace or add plain fields."""
    fields: dict[str, str | int] = {
        "module": "Toy",
        "cfg": f"models/{name}.cfg",
        "environment": "honest",
        "strength": "a counter up to 4",
        "workers": 1,
        "heap_mb": 256,
        "timeout_s": 600,
        "cfg_sha256": sha256(CFGS[name]),
    }
    fields.update(changes)
    lines = [f'[[run]]\nid = "{name}"', 'lanes = ["smoke", "full"]']
    lines += [
        f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}"
        for key, value in fields.items()
    ]
    own = _DECLARED[name].format(distinct=DISTINCT, generated=GENERATED)
    kept = [line for line in own.splitlines() if line.split(" = ")[0] not in changes]
    return "\n".join(lines + kept) + "\n"


def toy_tree(root: Path, *names: str, **changes: str | int) -> Path:
    """Make a root with the document `toy` and the named runs (default: MC_toy); returns the root."""
    chosen = names or ("MC_toy",)
    folder = root / "spec" / "toy"
    (folder / "models").mkdir(parents=True)
    (folder / "Toy.tla").write_text(TOY_TLA)
    for name in chosen:
        (folder / "models" / f"{name}.cfg").write_text(CFGS[name])
    (folder / "runs.toml").write_text(
        "# runs of the toy\n" + "\n".join(declaration(n, **changes) for n in chosen)
    )
    return root

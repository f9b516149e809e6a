"""The toy document `box` with evidence written by hand, so that faults can be planted without any run."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from tests.report.conftest import declared, make_box

THEOREM = '''"""Theorems about the box."""


@theorem(clauses=["BX-1-2"], findings=["E-01"], properties=["ShutsOverDoor"])
def it_shuts_over_the_door_only():
    """It shuts only over the door, whatever happens."""
'''
REFIMPL = '''"""The box in Python."""


def step(state, door):
    """One scan (BX-1-1)."""
    return state
'''
TOOLS = {
    "tlc": {"version": "TLC2 Version 2.15 of Day Month 20?? (rev: d5b5a7f)", "sha256": "5" * 64},
    "z3": {"version": "5.4.0.0", "sha256": None},
}
TRACE = [
    {"number": 1, "action": "", "variables": {"boxState": '"Open"', "shut": "FALSE"}},
    {"number": 2, "action": "Close", "variables": {"boxState": '"Shut"', "shut": "TRUE"}},
]
RESULT: dict[str, dict[str, Any]] = {
    "MC_Box": {"run": "MC", "properties": ["ShutsOverDoor"], "distinct": 5, "generated": 11},
    "MC_Box_lazy": {"run": "MC", "properties": ["ShutsOverDoor"], "distinct": 3, "generated": 5},
    "NEG_Box_eager": {"run": "NEG", "violated": "ShutsOverDoor", "trace_length": 2, "trace": TRACE},
    "NEG_Box_hasty": {"run": "NEG", "violated": "ShutsOverDoor", "trace_length": 2, "trace": TRACE},
    "WIT_Box": {"run": "WIT", "reached": ["Close"], "witnesses": ["Close"]},
    "it_shuts_over_the_door_only": {
        "sentence": "It shuts only over the door, whatever happens.",
        "clauses": ["BX-1-2"],
        "findings": ["E-01"],
        "properties": ["ShutsOverDoor"],
        "premises": ["there is one door"],
        "unused": [],
        "shared": 0.5,
        "queries": [
            {"name": "claim", "expected": "unsat", "z3": "unsat", "cvc5": "unsat", "twin_of": "", "core": []},
            {"name": "twin", "expected": "sat", "z3": "sat", "cvc5": "sat", "twin_of": "claim", "core": None},
        ],
    },
}
WORD = {"MC": "HOLDS", "OPEN": "HOLDS", "NEG": "VIOLATED", "WIT": "REACHED", "it": "PROVED"}


def make_paper(root: Path) -> Path:
    """The root of a repository with the box, its theorem, and all evidence as expected."""
    make_box(root)
    folder = root / "spec" / "box"
    (folder / "models" / "WIT_Box.cfg").write_text("SPECIFICATION Spec\n")
    witness = 'witnesses = ["Close"]'
    with (folder / "runs.toml").open("a") as runs:
        digest = hashlib.sha256(b"SPECIFICATION Spec\n").hexdigest()
        text = declared("MC_Box", "the bounds of MC_Box", witness).replace("MC_Box", "WIT_Box")
        runs.write(
            "".join(
                f'cfg_sha256 = "{digest}"\n' if "cfg_sha256" in one else f"{one}\n"
                for one in text.splitlines()
            )
        )
    change(folder / "properties.toml", 'antecedent = ""\nreason = "a toy"', 'antecedent = "Close"')
    for room, name, text in (("proofs", "box_safety", THEOREM), ("refimpl", "box", REFIMPL)):
        (root / room / "box").mkdir(parents=True)
        (root / room / "box" / f"{name}.py").write_text(text)
    for name in RESULT:
        put(root, name)
    return root


def declare_graph(root: Path, counts: str = "") -> None:
    """Declare the run OPEN_Box, which prints the graph of the box; `counts` are the pins of the graph."""
    graph = f'[run.graph]\ndevice = "box"\ntick_ms = 10\n{counts}'
    text = declared("MC_Box", "any door", graph).replace("MC_Box", "OPEN_Box")
    with (root / "spec" / "box" / "runs.toml").open("a") as runs:
        runs.write(text)


def change(path: Path, old: str, new: str) -> None:
    """Replace a text that the file holds once."""
    text = path.read_text()
    assert text.count(old) == 1, (path, old, text.count(old))
    path.write_text(text.replace(old, new))


def put(
    root: Path, name: str, *, kind: str = "", result: dict[str, Any] | None = None, **changes: Any
) -> None:
    """Write one piece of evidence: as expected, but for the changes."""
    known = {**RESULT.get(name, {}), **(result or {})}
    head = name.split("_")[0]
    fields: dict[str, Any] = {
        "kind": kind or ("proof" if head == "it" else "tlc"),
        "id": name,
        "document": "box",
        "verdict": WORD.get(head, "EQUAL"),
        "expected": WORD.get(head, "EQUAL"),
        "as_expected": True,
        "environment": "arbitrary",
        "strength": "any door",
        "command": f"modeproof check box/{name}",
        "started": 0.0,
        "seconds": 1.5,
        "inputs": evidence.hashes(root, [root / "spec" / "box" / "Box.tla"]),
        "tools": TOOLS,
        **changes,
    }
    evidence.write(root, evidence.make(**fields, result=known))


def without(root: Path, name: str) -> None:
    """Remove a piece of evidence."""
    (root / "build" / "evidence" / "box" / f"{name}.json").unlink()

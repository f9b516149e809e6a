"""The toy document `box` with evidence written by hand, so that faults can be planted without any run."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.registers.runs import load_runs
from modeproof.report.sources import gather
from modeproof.tlc.run_judge_again import declared as declared_in
from tests.report.conftest import CFGS, declared, make_box

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
            {
                "name": "claim",
                "expected": "unsat",
                "z3": "unsat",
                "cvc5": "unsat",
                "twin_of": "",
                "core": [],
                "detail": "",
            },
            {
                "name": "twin",
                "expected": "sat",
                "z3": "sat",
                "cvc5": "sat",
                "twin_of": "claim",
                "core": None,
                "detail": "",
            },
        ],
    },
}
WORD = {
    "MC": "HOLDS",
    "OPEN": "HOLDS",
    "NEG": "VIOLATED",
    "WIT": "REACHED",
    "it": "PROVED",
    "adapter": "CONFORMS",
}

LIMITS = "# What this does not show\n\n**Boxes only.** Not a `door`, see [the box](box.md).\n"
GLOSSARY = '[[term]]\nword = "door"\nforms = ["doors"]\nsays = "What a box shuts over <b>."\n'


def make_paper(root: Path) -> Path:
    """The root of a repository with the box, its theorem, and all evidence as expected."""
    make_box(root)
    folder = root / "spec" / "box"
    cfg = "SPECIFICATION Spec\nPROPERTY ShutsOverDoor\n"
    (folder / "models" / "WIT_Box.cfg").write_text(cfg)
    witness = 'witnesses = ["Close"]\ndistinct = 1\ngenerated = 1'
    with (folder / "runs.toml").open("a") as runs:
        runs.write(declared("WIT_Box", "the bounds of WIT_Box", witness, cfg) + "\n")
    change(folder / "properties.toml", 'antecedent = ""\nreason = "a toy"', 'antecedent = "Close"')
    for room, name, text in (("proofs", "box_safety", THEOREM), ("refimpl", "box", REFIMPL)):
        (root / room / "box").mkdir(parents=True)
        (root / room / "box" / f"{name}.py").write_text(text)
    for name in RESULT:
        put(root, name)
    return root


def declare_graph(root: Path, counts: str = "") -> None:
    """Declare the run OPEN_Box, which prints the graph of the box; `counts` are the pins of the graph."""
    (root / "spec/box/models/OPEN_Box.cfg").write_text(CFGS["MC_Box"])
    states, edges = (int(word) for word in re.findall(r"\d+", counts) or (4, 7))
    pins = f"states = {states}\nedges = {edges}\n"
    graph = f"distinct = {states}\ngenerated = {edges + 1}\n"
    graph += f'[run.graph]\ndevice = "box"\ntick_ms = 10\n{pins}'
    with (root / "spec" / "box" / "runs.toml").open("a") as runs:
        runs.write(declared("OPEN_Box", "any door", graph, CFGS["MC_Box"]))


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
    kind = kind or ("proof" if head == "it" else "tlc")
    if "transitions" in known:
        known.setdefault("replayed", known["transitions"])
    known = {**_figures(root, name, kind, changes.get("verdict", WORD.get(head, "EQUAL"))), **known}
    fields: dict[str, Any] = {
        "kind": kind,
        "id": name,
        "document": "box",
        "verdict": WORD.get(head, "EQUAL"),
        "expected": WORD.get(head, "EQUAL"),
        "as_expected": True,
        "environment": "arbitrary",
        "strength": next((run.strength for run in load_runs(root, "box") if run.id == name), "any door"),
        "command": f"modeproof check box/{name}",
        "started": 0.0,
        "seconds": 1.5,
        "inputs": evidence.hashes(root, [root / "spec" / "box" / "Box.tla"]),
        "tools": TOOLS,
        **changes,
    }
    evidence.write(root, evidence.make(**fields, result=known))


def _figures(root: Path, name: str, kind: str, verdict: str) -> dict[str, Any]:
    """What evidence of this kind holds besides, where all is as it should be."""
    if kind == "tlc":
        runs = [run for run in load_runs(root, "box") if run.id == name]
        status = 12 if verdict == "VIOLATED" else 0
        about = declared_in(runs[0]) if runs else {}
        about |= {"exit_status": status, "distinct": 1, "generated": 1, "queue": 0, "initial": 1}
        if runs and runs[0].graph is not None:
            states, edges = runs[0].graph.states or 0, runs[0].graph.edges or 0
            counts = {"distinct": states, "generated": edges + 1}
            about |= {**counts, "printed": {"STATE": states, "EDGE": edges}}
        return about
    if name.startswith("adapter_"):
        return {"verdict": verdict, "cases": 1, "cases_total": 1, "scans": 9, "difference": None}
    if kind == "conformance":
        counts = dict.fromkeys(("states", "inputs", "transitions", "replayed", "scans"), 1)
        counts |= dict.fromkeys(("implementation_states", "class_scans", "difference_count"), 0)
        empty = {"covered": {}, "classes": {}, "differences": []}
        return {**counts, **empty, "run": "box/OPEN_Box", "implementation": "refimpl"}
    return {"problems": [], "rows": [], "devices": {}, "clauses": 2}


def second(root: Path, **changes: Any) -> str:
    """Another run of the decided box, with its evidence; returns its id."""
    runs = root / "spec" / "box" / "runs.toml"
    row = '[[run]]\nid = "MC_Box_second"\nbase = "MC_Box"\nspecification = "OpenSpec"\n'
    runs.write_text(f"{runs.read_text()}\n{row}distinct = 5\ngenerated = 11\n")
    put(root, "MC_Box_second", **{**changes, "result": {**RESULT["MC_Box"], **changes.get("result", {})}})
    return "MC_Box_second"


def without(root: Path, name: str) -> None:
    """Remove a piece of evidence."""
    (root / "build" / "evidence" / "box" / f"{name}.json").unlink()


def make_whole(root: Path) -> Path:
    """The paper, its registers judged, its page of limits and its glossary."""
    make_paper(root)
    (root / "docs").mkdir(exist_ok=True)
    (root / "docs" / "limits.md").write_text(LIMITS)
    (root / "docs" / "report.toml").write_text(GLOSSARY)
    put(root, "registers", kind="registers", result={"clauses": 2, "citations": 9})
    return root


def put_graph(root: Path, states: int, compared: int, **changes: Any) -> None:
    """A run that printed a graph of so many states, and a comparison with a program of so many."""
    declare_graph(root, f"{states} 7")
    graph = {"device": "box", "states": states, "edges": 7, "file": "build/graphs/box/OPEN_Box.txt"}
    put(root, "OPEN_Box", verdict="HOLDS", result={"graph": graph})
    result = {"run": "box/OPEN_Box", "device": "box", "states": compared, "transitions": 7}
    put(root, "refimpl_OPEN_Box", kind="conformance", result=result, **changes)


def stale(root: Path, name: str) -> None:
    """Make one piece of evidence that of another text of the box."""
    path = evidence.evidence_path(root, "box", name)
    record = evidence.read(path)
    record["inputs"]["spec/box/Box.tla"] = "1" * 64
    evidence.write(root, record)


def entry(part: Any, root: Path) -> dict[str, Any]:
    """The data that a part has of the only document."""
    found: dict[str, Any] = part.part(gather(root)).data["documents"][0]
    return found

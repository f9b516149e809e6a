"""The box with everything that a report needs, so that a report of it is complete and as expected."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from tests.report.paper import declare_graph, make_paper, put

LIMITS = "# What this does not show\n\n**Boxes only.** Not a `door`, see [the box](box.md).\n"
GLOSSARY = '[[term]]\nword = "door"\nforms = ["doors"]\nsays = "What a box shuts over <b>."\n'


def make_whole(root: Path) -> Path:
    """The paper, its registers judged, its page of limits and its glossary."""
    make_paper(root)
    (root / "docs").mkdir(exist_ok=True)
    (root / "docs" / "limits.md").write_text(LIMITS)
    (root / "docs" / "glossary.toml").write_text(GLOSSARY)
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

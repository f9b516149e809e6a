"""A small machine beside the toy document, with evidence written by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from modeproof.ground import evidence

PAGE = "# Wiring\n\n## What this does not show\n\n- No person is in the model.\n\n## More\n\nother words\n"
ROW: dict[str, Any] = {
    "id": "shut-first",
    "sentence": "It is shut before it moves.",
    "property": "move only if shut",
    "hazard": "A <b>hand</b> is caught.",
    "cites": ["BX-1-2", "E-01", "XX-9"],
    "verdict": "PROVED",
    "how": "",
    "reached_in_scans": [4],
    "wires": [],
    "trace": [],
}
RESULT: dict[str, Any] = {
    "basis": "our own design",
    "title": "a box that moves",
    "scan_ms": [5, 50],
    "cycle_ms": 10,
    "trusted": ["the reader of wirings"],
    "verdicts": [ROW],
    "problems": [],
    "order": ["box"],
    "picture": {
        "boxes": [
            {"id": "from_desk", "title": "desk", "outside": True},
            {"id": "box", "title": "SF_Box", "outside": False},
        ],
        "wires": [{"source": "from_desk", "target": "box", "names": ["Start", "Stop"]}],
    },
    "matrix": {"safeguards": ["lid"], "rows": [{"mode": "slow", "sets": ["1"], "why": "by hand"}]},
    "killers": [
        {
            "property": "shut-first",
            "kind": "bridged",
            "row": "block.box.inputs.Lid",
            "text": "TRUE",
            "was": "Lid",
            "scans": [{"dt_ms": 5, "in": "Start=1", "out": "move=1"}],
        }
    ],
    "trial": {
        "edits": 9,
        "judged": 7,
        "counts": {"KILLED": 6, "SURVIVED": 1},
        "falls": {"shut-first": 6},
        "left": [{"edit": "order = box last", "kind": "order", "verdict": "SURVIVED", "why": ""}],
    },
    "work": {"cpu_s": 1.5},
}


def put_machine(root: Path, result: dict[str, Any] = RESULT, **changes: Any) -> None:
    record = evidence.make(
        kind="machine",
        id="machine",
        document="cell",
        verdict="PROVED",
        expected="PROVED",
        as_expected=True,
        command="modeproof machine --evidence",
        started=0.0,
        seconds=2.0,
        inputs=evidence.hashes(root, [root / "spec/cell/wiring.toml"]),
        result=result,
    )
    evidence.write(root, record | changes)


def add_machine(root: Path) -> None:
    """The machine, its page and its evidence."""
    (root / "spec/cell").mkdir()
    (root / "spec/cell/wiring.toml").write_text("title = 'a box that moves'\n")
    (root / "docs").mkdir(exist_ok=True)
    (root / "docs/wire-your-machine.md").write_text(PAGE)
    put_machine(root)

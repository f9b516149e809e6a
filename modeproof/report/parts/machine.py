"""The machine: the project's own wiring of the documents' blocks, its properties, and what breaks them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from modeproof.report.drawing.system_picture import Box, Cable, Wire, system_picture
from modeproof.report.part import Part, Picture
from modeproof.report.snapshot import as_it_counts, machine_rows
from modeproof.report.sources import HOLE, Evidence, Figure, Sources, Trouble, few
from modeproof.report.text import blocks
from modeproof.report.verdicts import status_of

ID = "machine"
REMEDY = "modeproof machine --evidence"
PAGE = "docs/wire-your-machine.md"
NOT_SHOWN = "## What this does not show"


def part(sources: Sources) -> Part:
    """One entry a machine, from its evidence; without evidence, that there is none."""
    kinds = _kinds(sources)
    return Part(
        ID,
        "The machine",
        {
            "chosen": list(sources.filing.documents),
            "machines": [
                {"id": name, "command": REMEDY}
                | ({"verdict": None} if piece is None else _machine(sources, piece, kinds))
                for name, piece in sources.machines.items()
            ],
            "page": PAGE,
            "not_shown": _not_shown(sources) if sources.machines else [],
        },
        tuple(_troubles(sources)),
    )


def _troubles(sources: Sources) -> Iterator[Trouble]:
    for name, piece in sources.machines.items():
        if piece is None:
            what = f"{name}: there is no evidence in build/evidence/{name}/ that can be read"
            yield Trouble(HOLE, ID, what, REMEDY)
        elif piece.changed or piece.gone:
            what = f"{name}: the evidence is of another text ({few((*piece.changed, *piece.gone), 2)})"
            yield Trouble(HOLE, ID, what, REMEDY, (*piece.changed, *piece.gone))


def _kinds(sources: Sources) -> dict[str, str]:
    """For the id of each clause, finding and assumption, which of them it is."""
    found: dict[str, str] = {}
    for document in sources.documents.values():
        found |= dict.fromkeys((row.id for row in document.clauses), "clause")
        found |= dict.fromkeys((row.id for row in document.findings), "finding")
        found |= dict.fromkeys((row.id for row in document.assumptions), "assumption")
    return found


def _machine(sources: Sources, piece: Evidence, kinds: Mapping[str, str]) -> dict[str, Any]:
    record, result = as_it_counts(piece), piece.result
    head = {
        "verdict": record["verdict"],
        "good": {0: True, 1: False}.get(status_of(record)),
        "reason": record["reason"],
        "seconds": piece.figure("seconds", unit="s"),
        "made": False,
    }
    if not result:  # the wiring was refused
        return head
    rows = machine_rows(piece)
    killers = {row["property"]: row for row in result["killers"]}
    trial = result["trial"]
    return head | {
        "made": True,
        "title": result["title"],
        "basis": result["basis"],
        "scan_ms": result["scan_ms"],
        "cycle_ms": result["cycle_ms"],
        "order": result["order"],
        "count": Figure(len(rows), piece.path),
        "proved": Figure(sum(row["verdict"] == "PROVED" for row in rows), piece.path),
        "falling": Figure(len(killers), piece.path),
        "cpu": piece.figure("result", "work", "cpu_s", unit="s"),
        "trusted": result["trusted"],
        "tools": {
            name: entry["version"] for name, entry in record["tools"].items() if name in ("z3", "cvc5")
        },
        "picture": _picture(str(record["document"]), result),
        "matrix": result["matrix"],
        "rows": [
            {
                "id": row["id"],
                "sentence": row["sentence"],
                "property": row["property"],
                "hazard": row["hazard"],
                "cites": [{"id": id, "kind": kinds.get(id, "")} for id in row["cites"]],
                "verdict": row["verdict"],
                "good": {"PROVED": True, "REFUTED": False}.get(row["verdict"]),
                "how": row["how"],
                "reached": Figure(_latest(row), piece.path),
                "falls": Figure(trial["falls"].get(row["id"], 0), piece.path),
            }
            for row in rows
        ],
        "models": [
            {**row, "checks": len(row["checks"]), "distinct": Figure(row["distinct"], piece.path)}
            for row in result.get("models", ())
        ],
        "mistakes": [{**row, "count": Figure(len(row["scans"]), piece.path)} for row in result["killers"]],
        "trial": {
            "edits": Figure(trial["edits"], piece.path),
            "judged": Figure(trial["judged"], piece.path),
            "counts": {word: Figure(count, piece.path) for word, count in trial["counts"].items()},
            "left": trial["left"],
        },
    }


def _latest(row: Mapping[str, Any]) -> int | None:
    """After how many scans of a run all that the property is about had occurred."""
    reached = row["reached_in_scans"]
    return max(reached, default=0) if None not in reached else None


def _picture(name: str, result: Mapping[str, Any]) -> Picture:
    boxes = [Box(row["id"], row["title"], row["outside"]) for row in result["picture"]["boxes"]]
    cables = [
        Cable(row["source"], row["target"], tuple(Wire(signal, "") for signal in row["names"]))
        for row in result["picture"]["wires"]
    ]
    title = f"The wiring of {name}: who sends what to whom"
    return Picture(title, system_picture(boxes, cables, id=f"machine-{name}", title=title))


def _not_shown(sources: Sources) -> list[dict[str, Any]]:
    """What the page of the wiring says that is not shown."""
    text = (sources.content(PAGE) or b"").decode("utf-8", "replace")
    _, _, rest = text.partition(f"\n{NOT_SHOWN}\n")
    return blocks(rest.partition("\n## ")[0])

"""Recorded counterexamples as the page plays them: row by row, each with what changed in it.

They come from the evidence of this tree and its walks, where both are there and of the present text. Where
not, from scenes/<document>/recorded.jsonl, which `modeproof renew` writes from them: one line a run, with the
SHA-256 of its trace and the beginning of the meaning of each module that it was checked with.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meaning
from modeproof.ground.places import build
from modeproof.registers.replay import Traces, has_replay, load_replay
from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.registers.stale import renew_command
from modeproof.report.scan_table_cells import Cells
from modeproof.report.story import digest_of, from_walk
from modeproof.simulate.program.play import GROUPS

SHOWN_OF_HASH = 12
KEPT = ("run", "trace_sha256", "modules", "loop", "rows")


def shown(document: Document) -> list[dict[str, Any]]:
    """The counterexamples that the page can play, in the order of the runs; `rows` is JSON, read when played.

    `fresh` says that its modules are as they were, and its length is the one that is pinned. Raises Unjudged
    where the file cannot be read.
    """
    old, new = _kept(document), _of_evidence(document)
    sentences = {property.tla: property.sentence for property in document.properties}
    found = []
    for run in document.runs:
        row = new.get(run.id) or old.get(run.id)
        if row is None or run.kind != "NEG":
            continue
        head = {"run": run.id, "property": run.property, "says": sentences.get(run.property, "")}
        fresh = _is_fresh(document, run, row)
        found.append({**head, "fresh": fresh, "loop": row["loop"], "rows": _json(row["rows"])})
    return found


def unrecorded(document: Document) -> list[str]:
    """The negative runs whose record is missing or of another specification; none without a record at all.

    Raises Unjudged where the file cannot be read.
    """
    old = _kept(document)
    wanted = [run for run in document.runs if run.kind == "NEG"] if old else []
    return [run.id for run in wanted if run.id not in old or not _is_fresh(document, run, old[run.id])]


def known(document: Document) -> frozenset[str]:
    """The runs that have a record, of this specification or of another one."""
    return frozenset(_kept(document))


def _is_fresh(document: Document, run: Run, row: Mapping[str, Any]) -> bool:
    same = all(_hash(document.root, file) == known for file, known in row["modules"].items())
    return same and run.trace_length in (None, len(row["rows"]))


def findings(document: Document, there: Sequence[str]) -> list[dict[str, Any]]:
    """Every finding, the runs of it that can be played (that of its story first), and why where none can."""
    return [_finding(document, finding, there) for finding in document.findings]


def _finding(document: Document, finding: Finding, there: Sequence[str]) -> dict[str, Any]:
    told = finding.telling
    fails = [
        run.id
        for run in document.runs
        if run.kind == "NEG" and (run.id in finding.evidence or finding.id in run.findings)
    ]
    runs = sorted((run for run in fails if run in there), key=lambda run: told is None or run != told.run)
    why = ""
    if missing := [run for run in fails if run not in there]:
        why = f"Not recorded: {', '.join(missing)}. {renew_command(document.name)} makes it."
    elif not fails:
        checks = f" Its evidence is {', '.join(finding.evidence)}." if finding.evidence else ""
        reason = finding.evidence_open or "no run fails for it"
        why = f"No counterexample belongs to it: {reason}.{checks}"
    return {
        "id": finding.id,
        "title": finding.title,
        "story": told.story if told and runs[:1] == [told.run] else finding.consequence,
        "runs": runs,
        "why": why,
    }


def record(document: Document) -> tuple[int, list[str], list[str]]:
    """Write the file anew. Returns how many it holds, those with other rows now, and those missing."""
    old, new = _kept(document), _of_evidence(document)
    wanted = [run.id for run in document.runs if run.kind == "NEG"]
    kept = [found for id in wanted if (found := new.get(id) or old.get(id))]
    write_whole(_path(document), "".join(f"{_json(row)}\n" for row in kept).encode("utf-8"))
    changed = [id for id in wanted if id in new and id in old and new[id]["rows"] != old[id]["rows"]]
    return len(kept), changed, [id for id in wanted if id not in new and id not in old]


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False)


def _path(document: Document) -> Path:
    return document.root / "scenes" / document.name / "recorded.jsonl"


def _kept(document: Document) -> dict[str, dict[str, Any]]:
    path = _path(document)
    if not path.is_file():
        return {}
    try:
        rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
        return {row["run"]: {key: row[key] for key in KEPT} for row in rows}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unjudged(f"{path}: cannot be read: {error}; modeproof renew writes it") from None


def _hash(root: Path, file: str) -> str:
    path = root / file
    return meaning(path)[:SHOWN_OF_HASH] if path.is_file() else ""


def _of_evidence(document: Document) -> dict[str, dict[str, Any]]:
    """The runs whose evidence is of the present text, as expected, and has a walk of this very trace."""
    if not has_replay(document.root, document.name):
        return {}
    traces = load_replay(document.root, document.name)
    made = {run.id: _of_run(document, traces, run) for run in document.runs if run.kind == "NEG"}
    return {id: row for id, row in made.items() if row is not None}


def _of_run(document: Document, traces: Traces, run: Run) -> dict[str, Any] | None:
    place = document.root
    try:
        record = evidence.read(evidence.evidence_path(place, document.name, run.id))
        walk = json.loads((build(place) / "walks" / document.name / f"{run.id}.json").read_bytes())
    except (Unjudged, OSError, ValueError):
        return None
    trace = record["result"].get("trace")
    if not (isinstance(walk, dict) and trace and record["as_expected"]):
        return None
    if walk.get("trace_sha256") != digest_of(trace) or walk.get("module") not in traces.tops:
        return None
    modules = {
        file: (digest, _hash(place, file))
        for file, digest in record["inputs"].items()
        if file.startswith("spec/") and file.endswith(".tla")
    }
    for file, (digest, now) in modules.items():
        if not now or (digest != evidence.sha256(place / file) and not digest.startswith(now)):
            return None
    return {
        "run": run.id,
        "trace_sha256": walk["trace_sha256"],
        "modules": {file: now for file, (_, now) in modules.items()},
        "loop": record["result"].get("loop", ""),
        "rows": _rows(document, traces, walk),
    }


def _rows(document: Document, traces: Traces, walk: dict[str, Any]) -> list[dict[str, Any]]:
    """Each row without what is as in the row before, and with what the decided device does instead."""
    cells = Cells(document.interface, traces, walk["tables"])
    top, first = traces.tops[walk["module"]], walk["rows"][0]["variables"]
    states = {
        name: cells.state_variable(name, first)
        for name, device in document.interface.devices.items()
        if device.memory and cells.state_variable(name, first) in first
    }
    known = {
        name for device in document.interface.devices.values() for name in (*device.inputs, *device.outputs)
    }
    also = [column for column in cells.columns(top.columns, list(first)) if column.of in ("variable", "wire")]
    also = [column for column in also if column.id not in known and column.id != "dt"]
    story = from_walk(document, traces, walk)
    stands: dict[str, dict[str, Any]] = {group: {} for group in GROUPS}
    made: list[dict[str, Any]] = []
    for row, told in zip(walk["rows"], story.rows, strict=True):
        now: dict[str, dict[str, Any]] = {
            "wires": {name: value for name, value in row["wires"].items() if name in known},
            "states": {name: row["variables"][of] for name, of in states.items()},
            "also": {column.heading: cells.show(column, row["wires"], row["variables"]) for column in also},
        }
        ticks = row["wires"].get("dt", row["variables"].get("took", 0)) if made else 0
        made.append(
            {
                "step": row["step"],
                "who": row["who"],
                "by": told.by,
                **({"ticks": ticks} if ticks else {}),
                **({"instead": list(told.instead)} if told.instead else {}),
                **{
                    group: changes
                    for group in GROUPS
                    if (changes := _changes(stands[group], now[group])) or not made
                },
            }
        )
        stands = now
    return made


def _changes(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in after.items() if name not in before or before[name] != value}

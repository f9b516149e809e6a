"""Whether the evidence of a run still fits: who reads a printed graph, and a lane that goes on, ask here.

It fits when it is as expected, and nothing has changed since: the run's declaration with its pins, every file
that TLC read, the printed graph. A lane that goes on asks for the same tools too. TLC's own checkpoints are
not used (docs/decisions-models.md).
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import msgspec

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.registers.runs import Run
from modeproof.tlc.start_up import entries
from modeproof.tlc.toolchain import Toolchain


def declaration_sha256(run: Run) -> str:
    """SHA-256 of all that runs.toml says of a run, pins included; another run's pins do not matter."""
    text = json.dumps(msgspec.to_builtins(run), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def current_tools(tools: Toolchain) -> dict[str, Mapping[str, str | None]]:
    """What the evidence of a run made now would say of its tools, without the version that TLC prints."""
    made = entries(tools)
    return {**evidence.own_tools(), "java": made["java"], "tlc": {"sha256": tools.jar_sha256}}


def why_stale(place: Path, run: Run, tools: Toolchain | None = None) -> str:
    """Why the evidence of a run, and the graph that it printed, fit no longer; empty when they do.

    With `tools` these must be the same too.
    """
    path = evidence.evidence_path(place, run.document, run.id)
    if not path.is_file():
        return "no evidence"
    try:
        record = evidence.read(path)
    except Unjudged:
        return "its evidence cannot be read"
    result = record["result"]
    if record["kind"] != "tlc" or not record["as_expected"]:
        return f"its evidence says {record['verdict']}, not as expected"
    if result.get("declaration") != declaration_sha256(run):
        return "its declaration has changed"
    now = {} if tools is None else current_tools(tools)
    for name in sorted(now):
        then = record["tools"].get(name, {})
        if any(then.get(key) != value for key, value in now[name].items()):
            return f"{name} has changed"
    register = f"spec/{run.document}/runs.toml"
    files = {name: digest for name, digest in record["inputs"].items() if name != register}
    if not files:
        return "its evidence names no input"
    if run.graph is not None:
        graph = result.get("graph", {})
        if "sha256" not in graph:
            return "its evidence names no graph"
        files[graph["file"]] = graph["sha256"]
    for name, digest in files.items():
        if not (place / name).is_file() or evidence.hashes(place, [place / name])[name] != digest:
            return f"{name} has changed"
    return ""

"""Which runs of an interrupted lane need not be run again: those whose evidence still fits.

It fits when it is as expected, and nothing has changed since: the run's declaration with its pins, every file
that TLC read, the tools, the printed graph. TLC's own checkpoints are not used (docs/decisions.md).
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.registers.runs import Run
from modeproof.tlc.toolchain import Toolchain


def declaration_sha256(run: Run) -> str:
    """SHA-256 of all that runs.toml says of a run, pins included; another run's pins do not matter."""
    text = json.dumps(msgspec.to_builtins(run), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def current_tools(tools: Toolchain) -> dict[str, Mapping[str, str | None]]:
    """What the evidence of a run made now would say of its tools, without the version that TLC prints."""
    own = evidence.own_tools()
    java = evidence.tool(tools.java_version, tools.java)
    return {**own, "java": java, "tlc": {"sha256": tools.jar_sha256}}


def why_again(place: Path, run: Run, tools: Toolchain) -> str:
    """Why a run must be run again; empty when its evidence still fits."""
    path = evidence.evidence_path(place, run.document, run.id)
    if not path.is_file():
        return "no evidence"
    try:
        record = evidence.read(path)
    except Unjudged:
        return "its evidence cannot be read"
    return _changed(place, run, tools, record)


def _changed(place: Path, run: Run, tools: Toolchain, record: Mapping[str, Any]) -> str:
    result = record["result"]
    if record["kind"] != "tlc" or not record["as_expected"]:
        return f"its evidence says {record['verdict']}, not as expected"
    if result.get("declaration") != declaration_sha256(run):
        return "its declaration has changed"
    now = current_tools(tools)
    for name in sorted(now):
        then = record["tools"].get(name, {})
        if any(then.get(key) != value for key, value in now[name].items()):
            return f"{name} has changed"
    register = f"spec/{run.document}/runs.toml"
    files = {name: digest for name, digest in record["inputs"].items() if name != register}
    if not files:
        return "its evidence names no input"
    if graph := result.get("graph", {}).get("file"):
        files[graph] = result["graph"]["sha256"]
    for name, digest in files.items():
        if not (place / name).is_file() or evidence.hashes(place, [place / name])[name] != digest:
            return f"{name} has changed"
    return ""

"""Judges logs that tests make, several in one run of TLC."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.ground.places import root
from modeproof.tlc.toolchain import find_toolchain
from modeproof.trace.exact import Scans
from modeproof.trace.lines import read_lines
from modeproof.trace.log import Log
from modeproof.trace.log_judge import Graphs, Judgement, judge_logs
from modeproof.trace.table import read_table
from modeproof.trace.targets import find_target

LOGS = root() / "examples" / "logs"


def _recorder() -> ModuleType:
    spec = spec_from_file_location("examples_logs_record", LOGS / "record.py")
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    sys.modules["examples_logs_record"] = module
    spec.loader.exec_module(module)
    return module


record: Any = _recorder()
"""The recorder of examples/logs."""


def example(target: str, name: str) -> Log:
    """A log of examples/logs."""
    path = LOGS / name
    read = read_table if path.suffix == ".csv" else read_lines
    return read(path, find_target(root(), target))


def log_of(folder: Path, target: str, rows: Sequence[Any], params: Any = None) -> Log:
    """A log of these rows, as JSON Lines."""
    path = folder / f"{target}.jsonl"
    header = [] if params is None else [{"target": target, "params": params}]
    path.write_text("".join(json.dumps(row) + "\n" for row in [*header, *rows]))
    return read_lines(path, find_target(root(), target))


def judge(
    target: str, logs: Sequence[Log], graphs: Graphs, *, anywhere: bool = False, samples: Scans | None = None
) -> tuple[Judgement, ...]:
    """Both judgements of each log."""
    found, _ = judge_logs(
        root(),
        find_target(root(), target),
        logs,
        graphs,
        find_toolchain(),
        anywhere=anywhere,
        samples=samples,
    )
    return found

"""One case as a table for a vendor's trace tool (CSV)."""

from __future__ import annotations

import csv
import io
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.kit.vectors import Case, Suite


def as_csv(suite: Suite, case: Case) -> str:
    """A row for each scan: time in ms since the reset, inputs, expected outputs; words in hex, bits 0 and 1.

    Raises Unjudged for a case with requests to be refused: they are messages, not scans.
    """
    if case.requests:
        raise Unjudged(f"{case.id}: holds a request that must be refused; a trace cannot show it")
    stream = io.StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(["time_ms", *suite.inputs, *suite.outputs])
    time_ms = 0
    for scan in case.scans:
        time_ms += scan.dt_ms
        ins = [_cell(scan.inputs[name]) for name in suite.inputs]
        table.writerow([time_ms, *ins, *[_cell(scan.outputs[name]) for name in suite.outputs]])
    return stream.getvalue()


def _cell(value: Any) -> str:
    if type(value) is bool:
        return str(int(value))
    if isinstance(value, list):
        return " ".join(map(str, value))
    return "" if value is None else str(value)

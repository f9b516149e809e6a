"""What properties.toml of a toy document says of times: a row with a bound, one without, and a chain."""

from __future__ import annotations

ROWS = """
[example]
cycle = {{ {device} = 10 }}
times = {{ T_HOLD_ms = 200 }}
transfer = 5

[[response]]
id = "{prefix}R-1"
device = "{device}"
from = "the door opens"
to = "the bolt is in"
clauses = ["{prefix}-1-1"]
calls = 2
times = {{ T_HOLD_ms = 1 }}

[[response]]
id = "{prefix}R-2"
device = "{device}"
from = "the bolt is in"
to = "somebody closes the door"
clauses = ["{prefix}-1-1"]
unbounded = "a person is waited for"

[[chain]]
id = "{prefix}C-1"
title = "door to lamp"
steps = ["{prefix}R-1", "{document} {prefix}R-1"]
then = "the lamp"
then_ms = 7
"""


def stated_times(document: str, device: str, prefix: str) -> str:
    """The rows of a document whose clause ids begin with `prefix`."""
    return ROWS.format(document=document, device=device, prefix=prefix)

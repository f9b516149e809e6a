"""A register of response times of a toy document: a row with a bound, one without, and a chain."""

from __future__ import annotations


def response_rows(document: str, prefix: str, device: str, hold_ms: int) -> str:
    """The file. prefix: of the ids, and of its clause; device: what has the parameter T_HOLD_ms."""
    return f"""
document = "{document}"
[example]
cycle = {{ {device} = 10 }}
times = {{ T_HOLD_ms = {hold_ms} }}
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

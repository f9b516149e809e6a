"""What the safety function blocks share: edges of inputs, and a timer that stops at its limit.

A block is called once a cycle; ``step`` is one call. It takes at most one transition out of the state of the
call before, and the outputs are those of the state after it. Which edge or time a block waits for is said in
its own file.
"""

from __future__ import annotations


def rises(now: bool, before: bool) -> bool:
    """The input was FALSE in the call before and is TRUE in this one."""
    return now and not before


def held(now: bool, before: bool) -> bool:
    """The input was TRUE in the call before and is TRUE in this one: held, or stuck."""
    return now and before


def counted(elapsed_ms: int, dt_ms: int, limit_ms: int) -> int:
    """The time on a timer after ``dt_ms`` more, in milliseconds; it stops at ``limit_ms`` (elapsed)."""
    if elapsed_ms + dt_ms >= limit_ms:
        return limit_ms
    return elapsed_ms + dt_ms

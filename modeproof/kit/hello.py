"""What a program says about itself in its answer to hello."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass
from typing import Any

from modeproof.kit.errors import Unjudged, plain
from modeproof.kit.signals import shown
from modeproof.kit.vectors import EXACT, MONITOR, SETTLED

LONGEST_NAME = 100
"""Characters of what a program calls itself."""


@dataclass(frozen=True)
class Hello:
    """What a program said about itself."""

    name: str
    version: str
    unobserved: tuple[str, ...] = ()
    lists: bool = False
    latency: int = 0
    real_time: bool = False


def read_hello(answer: Mapping[str, Any], outputs: Container[str], relation: str = EXACT) -> Hello:
    """Check the answer to hello of a target with these outputs. Raises Unjudged when the relation is not
    possible with it.
    """
    if not isinstance(answer, Mapping) or answer.get("ok") is not True:
        raise Unjudged(f"hello was answered with {shown(answer, 200)}")
    offered = answer.get("relations", [EXACT])
    # Who answers scan by scan also settles, and who settles can be watched.
    enough = {EXACT: (EXACT,), SETTLED: (EXACT, SETTLED), MONITOR: (EXACT, SETTLED, MONITOR)}[relation]
    if not isinstance(offered, list) or not any(accepted in offered for accepted in enough):
        raise Unjudged(f"the adapter does not offer relation {relation}: {shown(offered)}")
    time_is = answer.get("time", "virtual")
    if time_is not in ("virtual", "real") or (relation == EXACT and time_is != "virtual"):
        raise Unjudged(f"relation {relation} needs virtual time, the adapter has {shown(time_is)}")
    latency = answer.get("max_latency_scans", 0)
    if type(latency) is not int or latency < 0 or (relation == EXACT and latency != 0):
        raise Unjudged(f"relation {relation} allows no latency, the adapter has {shown(latency)} scans")
    unobserved = answer.get("unobserved", [])
    if not isinstance(unobserved, list) or not all(
        isinstance(name, str) and name in outputs for name in unobserved
    ):
        raise Unjudged(f"unobserved must list outputs of the target, got {shown(unobserved)}")
    lists = answer.get("scans", False)
    if type(lists) is not bool:
        raise Unjudged(f"scans must be true or false, got {shown(lists)}")
    return Hello(
        name=plain(answer.get("name", ""), LONGEST_NAME) or "unnamed",
        version=plain(answer.get("version", ""), LONGEST_NAME),
        unobserved=tuple(dict.fromkeys(unobserved)),
        lists=lists,
        latency=latency,
        real_time=time_is == "real",
    )

"""Attributes of declarations, `{attribute 'name' := 'value'}`: what each does to what a program computes.

Dropped is what cannot change it: how a tool shows a name, what its checks report, where data lie in memory
(no pointer is read), to which terminal an input is linked (inputs are free). What is not listed is refused.
"""

from __future__ import annotations

import re
from typing import Final

RETAINED: Final = frozenset({"tcretain", "tcpersistent", "tcinitsymbol"})
"""The variable behind it keeps its value, or gets one from outside, before the first scan."""
DROPPED: Final = frozenset({
    "analysis", "displaymode", "hide", "no_check", "hide_all_locals", "linkalways", "naming", "obsolete",
    "pack_mode", "qualified_only", "reflection", "strict", "to_string",
    "tcdisplayscale", "tchidesubitems", "tcignorepersistent", "tclinkto", "tclinktooso", "tcnosymbol",
})  # fmt: skip
_DROPPED_WITH: Final = {"symbol": ("none", "read"), "monitoring": ("variable",), "opc.ua.da": ("0",)}
"""By their values: others let a client write, or carry out code while somebody watches."""
_OPEN: Final = ("symbol", "opc", "pytmc")
_WAYS: Final = re.compile(r"\bio\s*:\s*(\w+)")


def dropped(name: str, value: str) -> bool:
    """Whether an attribute changes nothing."""
    key = name.strip().lower()
    if key == "pytmc":  # what EPICS shows of it; without `io: i` it writes as well
        ways = _WAYS.findall(value.lower())
        return bool(ways) and set(ways) <= {"i", "ro"}
    return key in DROPPED or value.strip().lower() in _DROPPED_WITH.get(key, ())


def retained(name: str) -> bool:
    """Whether the variable behind an attribute may hold any value at power-up."""
    return name.strip().lower() in RETAINED


def refusal(name: str) -> str:
    """Why an attribute is refused, and what to do."""
    if name.strip().lower().startswith(_OPEN):
        return f"attribute '{name}' lets a client write the variable; take it out, or make it an input"
    return f"attribute '{name}' may change what the program does; take it out"

"""The standard blocks and functions: their pins and arguments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from programs.language.tree import BOOL, SCALARS, TIME, Expression, Function, Scalar

SHIFTS = ("SHL", "SHR", "ROL", "ROR")
FUNCTIONS = ("ABS", "MIN", "MAX", "LIMIT", "SEL", "MOVE", *SHIFTS)
"""The standard functions; conversions such as INT_TO_WORD are known beside them."""


def _counters(kind: str) -> Iterator[tuple[str, tuple[Mapping[str, Scalar], Mapping[str, Scalar]]]]:
    number = SCALARS[kind[1:] or "INT"]
    out = {"Q": BOOL, "CV": number}
    yield f"CTU{kind}", ({"CU": BOOL, "R": BOOL, "PV": number}, out)
    yield f"CTD{kind}", ({"CD": BOOL, "LD": BOOL, "PV": number}, out)
    both = {"CU": BOOL, "CD": BOOL, "R": BOOL, "LD": BOOL, "PV": number}
    yield f"CTUD{kind}", (both, {"QU": BOOL, "QD": BOOL, "CV": number})


BLOCKS: Mapping[str, tuple[Mapping[str, Scalar], Mapping[str, Scalar]]] = {
    **{name: ({"IN": BOOL, "PT": TIME}, {"Q": BOOL, "ET": TIME}) for name in ("TON", "TOF", "TP")},
    **{name: ({"CLK": BOOL}, {"Q": BOOL}) for name in ("R_TRIG", "F_TRIG")},
    "SR": ({"S1": BOOL, "R": BOOL}, {"Q1": BOOL}),
    "RS": ({"S": BOOL, "R1": BOOL}, {"Q1": BOOL}),
    **{name: pins for kind in ("", "_INT", "_DINT", "_UDINT") for name, pins in _counters(kind)},
}
"""The standard blocks: inputs in their order, and outputs.

A counter stays at the lowest and the highest value of its type, that of CV and PV.
"""
_PARAMETERS = {
    **dict.fromkeys(("MIN", "MAX"), ("IN1", "IN2")),
    "LIMIT": ("MN", "IN", "MX"),
    "SEL": ("G", "IN0", "IN1"),
    **dict.fromkeys(SHIFTS, ("IN", "N")),
}


def conversion(name: str) -> tuple[str, str] | None:
    """From what to what a conversion such as INT_TO_WORD goes; TO_WORD: from anything; None: it is none."""
    start, there, end = f"_{name}".partition("_TO_")
    return (start.removeprefix("_"), end) if there else None


def converted_from(name: str) -> Scalar | None:
    """The type from which a conversion such as INT_TO_WORD starts; None: it takes any (TO_WORD)."""
    ends = conversion(name)
    return None if ends is None else SCALARS.get(ends[0])


def arguments(node: Function) -> list[Expression]:
    """The arguments in their order, whether they are given by position or by name."""
    names = _PARAMETERS.get(node.name, ("IN",))
    if len(node.arguments) != len(names):
        raise node.place.refuse(f"{node.name} has {len(names)} arguments here, not {len(node.arguments)}")
    if all(not name for name, _ in node.arguments):
        return [value for _, value in node.arguments]
    given = dict(node.arguments)
    if set(given) != set(names):
        raise node.place.refuse(f"the arguments of {node.name} are {', '.join(names)}")
    return [given[name] for name in names]

"""Values of a program as solver terms: its memory slot by slot, and the standard blocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import z3

from programs.language.memory import default, elements
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import BOOL, TIME, Scalar, Source, Type, Unit

TRUE, FALSE = z3.BoolVal(True), z3.BoolVal(False)
Env = dict[str, Any]
"""Terms by the path of the variable, such as `TIMER.ET` or `WORDS[2]`."""
EDGES = {"CU": "up", "CD": "down"}
"""Of counters: what an input was in the call before, below this name."""
INT = Scalar("DINT", "int", -(2**31), 2**31 - 1)


@dataclass(frozen=True)
class Slot:
    """One single value of memory: its path, its type, its value at power-up (None: any, it is retained)."""

    path: str
    type: Scalar
    initial: bool | int | None
    section: str
    given: bool = False
    """Whether it is an input of the program itself."""


def symbol(kind: Scalar, name: str) -> Any:
    """A symbol for a value of this type."""
    if kind.kind == "bool":
        return z3.Bool(name)
    return z3.BitVec(name, kind.width) if kind.kind == "bits" else z3.Int(name)


def constant(kind: Scalar, value: bool | int) -> Any:
    """A value of this type as a term."""
    if kind.kind == "bool":
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), kind.width) if kind.kind == "bits" else z3.IntVal(int(value))


def in_range(kind: Scalar, term: Any) -> z3.BoolRef:
    """The values of this type; TRUE where the sort says it all."""
    if kind.kind in ("bool", "bits"):
        return TRUE
    return z3.And(term >= kind.low, term <= kind.high)


def slots(source: Source, unit: Unit, above: str = "") -> Iterator[Slot]:
    """Every single value of a unit's memory, inputs and outputs, without VAR_TEMP and without constants."""
    if unit.device is not None:
        yield from unit.device.slots(above.removesuffix("."))
    for key, variable in unit.variables.items():
        if variable.section in ("temp", "constant", "external"):
            continue
        given = variable.section == "input" and not above
        for place, kind, initial in elements(variable.type, f"{above}{key}", variable.initial):
            if isinstance(kind, Scalar):
                value = None if variable.retained else default(kind, initial)
                yield Slot(place, kind, value, variable.section, given)
            elif kind.block.upper() in source.units:
                yield from slots(source, source.units[kind.block.upper()], f"{place}.")
            else:
                yield from _standard(kind.block.upper(), place)


def parts(terms: Iterable[Any]) -> Iterator[Any]:
    """The terms and all that they are made of, each of them once."""
    seen: set[int] = set()
    waiting = list(terms)
    while waiting:
        term = waiting.pop()
        if term.get_id() not in seen:
            seen.add(term.get_id())
            yield term
            waiting += term.children()


def names_in(terms: Iterable[Any]) -> set[str]:
    """The names of the symbols in terms."""
    return {
        term.decl().name()
        for term in parts(terms)
        if z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED
    }


def compared_with(terms: Iterable[Any]) -> set[int]:
    """The whole numbers above 1 that something is compared with in these terms."""
    compared = (z3.is_le, z3.is_ge, z3.is_lt, z3.is_gt)
    return {
        abs(side.as_long())
        for part in parts(terms)
        if any(kind(part) for kind in compared)
        for side in part.children()
        if z3.is_int_value(side)
    } - {0, 1}


def live(asked: Iterable[Any], after: Mapping[str, tuple[str, Any]]) -> set[str]:
    """The paths on which the terms that are asked for depend, in this scan or a later one.

    after: for each path the name of its symbol before a scan, and its term after it.
    """
    paths = {name: path for path, (name, _) in after.items()}
    found: set[str] = set()
    seen: set[int] = set()
    waiting = list(asked)
    while waiting:
        term = waiting.pop()
        if term.get_id() in seen:
            continue
        seen.add(term.get_id())
        waiting += term.children()
        if z3.is_const(term) and (path := paths.get(term.decl().name())) is not None and path not in found:
            found.add(path)
            waiting.append(after[path][1])
    return found


def singles(kind: Type, path: str, initial: object) -> Iterator[tuple[str, Scalar, Any]]:
    """The single values of a variable: path, type, and the value at power-up."""
    for place, single, value in elements(kind, path, initial):
        if isinstance(single, Scalar):
            yield place, single, default(single, value)


def _standard(block: str, path: str) -> Iterator[Slot]:
    pins: dict[str, Scalar] = {}
    if block in ("TON", "TOF", "TP"):
        pins = {"IN": BOOL, "PT": TIME, "Q": BOOL, "ET": TIME, "before": BOOL, "age": INT}
        if block != "TON":
            pins["running"] = BOOL
    elif block in ("R_TRIG", "F_TRIG"):
        pins = {"CLK": BOOL, "Q": BOOL, "before": BOOL}
    elif block.startswith("CT"):
        ins, outs = BLOCKS[block]
        pins = {**ins, **outs, **{edge: BOOL for name, edge in EDGES.items() if name in ins}}
    elif block == "SR":
        pins = {"S1": BOOL, "R": BOOL, "Q1": BOOL}
    else:
        pins = {"S": BOOL, "R1": BOOL, "Q1": BOOL}
    for name, kind in pins.items():
        yield Slot(f"{path}.{name}", kind, kind is not BOOL and 0, "var")


def standard_call(block: str, path: str, env: Env) -> None:
    """One call of a standard block. `age` is the time since its last start, in ms."""

    def pin(name: str) -> Any:
        return env[f"{path}.{name}"]

    def put(name: str, term: Any) -> None:
        env[f"{path}.{name}"] = term

    if block in ("TON", "TOF", "TP"):
        signal, before = pin("IN"), pin("before")
        if block == "TON":
            put("age", z3.If(both(signal, negated(before)), z3.IntVal(0), pin("age")))
            put("ET", z3.If(signal, _limited(pin("age"), pin("PT")), z3.IntVal(0)))
            put("Q", both(signal, pin("age") >= pin("PT")))
        elif block == "TOF":
            starts = both(negated(signal), before)
            put("age", z3.If(starts, z3.IntVal(0), pin("age")))
            runs = both(negated(signal), either(starts, pin("running")))
            put("ET", z3.If(signal, z3.IntVal(0), z3.If(runs, _limited(pin("age"), pin("PT")), pin("ET"))))
            put("Q", either(signal, z3.If(runs, pin("age") < pin("PT"), pin("Q"))))
            put("running", both(runs, pin("age") < pin("PT")))
        else:
            starts = z3.And(negated(pin("running")), signal, negated(before))
            put("age", z3.If(starts, z3.IntVal(0), pin("age")))
            runs = either(starts, pin("running"))
            goes_on = both(runs, pin("age") < pin("PT"))
            shown = z3.If(runs, _limited(pin("age"), pin("PT")), pin("ET"))
            put("ET", z3.If(both(negated(goes_on), negated(signal)), z3.IntVal(0), shown))
            put("Q", z3.If(runs, goes_on, pin("Q")))
            put("running", goes_on)
        put("before", signal)
    elif block in ("R_TRIG", "F_TRIG"):
        clock, before = pin("CLK"), pin("before")
        put("Q", both(clock, negated(before)) if block == "R_TRIG" else both(negated(clock), before))
        put("before", clock)
    elif block.startswith("CT"):
        _count(block, path, env)
    elif block == "SR":
        put("Q1", either(pin("S1"), both(negated(pin("R")), pin("Q1"))))
    else:
        put("Q1", both(negated(pin("R1")), either(pin("S"), pin("Q1"))))


def _count(block: str, path: str, env: Env) -> None:
    """One call of a counter; CV stays at the limits of its type."""
    number = BLOCKS[block][1]["CV"]
    before, wanted = env[f"{path}.CV"], env[f"{path}.PV"]
    edges = []
    for name, edge in EDGES.items():
        signal = env.get(f"{path}.{name}", FALSE)
        edges.append(both(signal, negated(env.get(f"{path}.{edge}", FALSE))))
        if f"{path}.{edge}" in env:
            env[f"{path}.{edge}"] = signal
    more = z3.If(before >= number.high, before, before + 1)
    less = z3.If(before <= number.low, before, before - 1)
    steps = z3.If(edges[0] == edges[1], before, z3.If(edges[0], more, less))
    loaded = z3.If(env.get(f"{path}.LD", FALSE), wanted, steps)
    after = z3.If(env.get(f"{path}.R", FALSE), z3.IntVal(0), loaded)
    env[f"{path}.CV"] = after
    if block.startswith("CTUD"):
        env[f"{path}.QU"], env[f"{path}.QD"] = after >= wanted, after <= 0
    else:
        env[f"{path}.Q"] = after <= 0 if block.startswith("CTD") else after >= wanted


def _limited(age: Any, limit: Any) -> Any:
    return z3.If(age <= limit, age, z3.If(limit >= 0, limit, z3.IntVal(0)))


def between(kind: Scalar, term: Any, low: int, high: int) -> z3.BoolRef:
    if low == high:
        return term == constant(kind, low)
    if kind.kind == "bits":
        return z3.And(z3.UGE(term, low), z3.ULE(term, high))
    return z3.And(term >= low, term <= high)


def truncated(left: Any, right: Any) -> Any:
    """IEC division rounds towards zero; that of SMT-LIB leaves a remainder of 0 or more."""
    size = z3.If(left < 0, -left, left) / z3.If(right < 0, -right, right)
    return z3.If((left < 0) == (right < 0), size, -size)


def rotated(term: Any, by: int) -> Any:
    """A bit string whose bits go round to the left."""
    by %= term.size()
    if by == 0:
        return term
    return z3.Concat(
        z3.Extract(term.size() - by - 1, 0, term), z3.Extract(term.size() - 1, term.size() - by, term)
    )


def merge(env: Env, condition: z3.BoolRef, yes: Env, no: Env) -> None:
    for key, term in yes.items():
        if key in no:
            env[key] = choose(condition, term, no[key])


def choose(condition: z3.BoolRef, yes: Any, no: Any) -> Any:
    if yes is no or z3.is_true(condition) or yes.eq(no):
        return yes
    return no if z3.is_false(condition) else z3.If(condition, yes, no)


def negated(term: z3.BoolRef) -> z3.BoolRef:
    if z3.is_true(term) or z3.is_false(term):
        return FALSE if z3.is_true(term) else TRUE
    return z3.Not(term)


def both(left: z3.BoolRef, right: z3.BoolRef) -> z3.BoolRef:
    if z3.is_false(left) or z3.is_false(right):
        return FALSE
    if z3.is_true(left):
        return right
    return left if z3.is_true(right) else z3.And(left, right)


def either(left: z3.BoolRef, right: z3.BoolRef) -> z3.BoolRef:
    return negated(both(negated(left), negated(right)))


def shifted(name: str, term: Any, by: Any) -> Any:
    """A bit string shifted or rotated by a number of bits below its width, of the same width."""
    match name:
        case "SHL":
            return term << by
        case "SHR":
            return z3.LShR(term, by)
    rest = term.size() - by
    if name == "ROL":
        return (term << by) | z3.LShR(term, rest)
    return z3.LShR(term, by) | (term << rest)

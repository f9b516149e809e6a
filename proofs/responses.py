"""Response times: a bound of the register, proved of the shipped step, and shown to be no longer than it is.

Both functions take the bound from a row of properties.toml, so it is typed there alone. A row with a smaller
bound is refuted. With a greater one the control at the end finds no example, so nothing is proved either.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import z3

from modeproof.registers import Response
from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.records import terms
from proofs.explorer.scanned import Property, Scanned, Scans, control
from proofs.sentences import Judge
from proofs.theorem import Queries, Query, TheoremError, claim
from proofs.theorem import control as control_query


def within_calls(judge: Judge, row: Response, asks: Property, answered: Property) -> Queries:
    """Of `row.calls` calls in a row that all ask, one answers, from any state of the invariant.

    With more than one call neither property may look at what an observer has seen.
    """
    if row.calls is None or row.times:
        raise TheoremError(f"{row.id}: the theorem counts calls; give `calls`, and no `times`")
    anyway, short = [], []
    for scans in judge.scans():
        if z3.is_false(z3.simplify(asked := scans.some(asks))):
            continue
        given = {**judge.premises(scans), "it is asked for": asked}
        then = z3.Not(_unanswered(judge, scans, row.calls, asks, answered))
        yield from claim(f"from {scans.control}", given, then, LOGIC)
        one_less = _unanswered(judge, scans, row.calls - 1, asks, answered)
        short.append(z3.And(*given.values(), one_less))
        always = _unanswered(judge, scans, row.calls, lambda scan: TRUE, answered)
        anyway.append(z3.And(*judge.premises(scans).values(), always))
    yield control_query(f"control: {row.calls - 1} calls are not enough", {"some wait": z3.Or(*short)}, LOGIC)
    yield control_query("control: nor any number, unasked", {"some wait": z3.Or(*anyway)}, LOGIC)


def _unanswered(judge: Judge, scans: Scans, calls: int, asks: Property, answered: Property) -> z3.BoolRef:
    """So many calls in a row ask, and none of them answers."""
    if calls < 1:
        return TRUE

    def goes_on(scan: Scanned) -> z3.BoolRef:
        waits = z3.And(asks(scan), z3.Not(answered(scan)))
        if calls == 1 or z3.is_false(z3.simplify(waits)):
            return waits
        then = judge.begin(control(judge.device, scan.after))
        rest = z3.And(then.scan.premise, _unanswered(judge, then, calls - 1, asks, answered))
        return z3.And(waits, z3.substitute(rest, *_moved(scan, then, calls)))

    return scans.some(goes_on)


def _moved(scan: Scanned, then: Scans, calls: int) -> list[tuple[z3.ExprRef, z3.ExprRef]]:
    """The memory of the next scan is what this one leaves; its inputs are new."""
    left = zip(terms(then.scan.state), terms(scan.result), strict=True)
    pairs = [(was, now) for (_, was), (_, now) in left if isinstance(was, z3.ExprRef)]
    new = [symbol for _, symbol in terms(then.scan.inputs) if isinstance(symbol, z3.ExprRef)]
    pairs += [(symbol, z3.Const(f"{symbol}, {calls - 1} left", symbol.sort())) for symbol in new]
    return [
        (was, now) for was, now in pairs if z3.is_const(was) and was.decl().kind() == z3.Z3_OP_UNINTERPRETED
    ]


def within_time(
    judge: Judge, row: Response, asks: Property, clock: Callable[[Any], z3.ArithRef], answered: Property
) -> Queries:
    """While every call asks, the first one that comes `row.times` after the first that asked answers.

    `clock`: of what an observer has seen, the ms since the first call that asked; below 0 before it.
    """
    if row.calls != 1 or not row.times:
        raise TheoremError(f"{row.id}: the theorem waits for a time; give `times`, and calls = 1")

    def limit(scan: Scanned) -> z3.ArithRef:
        return waited_for(row, scan.params)

    def passed(scan: Scanned) -> z3.ArithRef:
        return clock(judge.seen) + scan.inputs.dt_ms

    def late(scan: Scanned) -> z3.BoolRef:
        return z3.And(asks(scan), clock(judge.seen) >= 0, passed(scan) >= limit(scan))

    def counted(scan: Scanned) -> z3.BoolRef:
        after = clock(judge.sees(scan))
        goes_on = z3.Implies(clock(judge.seen) >= 0, after >= passed(scan))
        return z3.Implies(z3.And(asks(scan), z3.Not(answered(scan))), z3.And(after >= 0, goes_on))

    early, due = [], []
    for scans in judge.scans():
        given = judge.premises(scans)
        if z3.is_false(z3.simplify(asked := scans.some(asks))):
            continue
        yield from claim(
            f"time counts in {scans.control}", {**given, "asked": asked}, scans.always(counted), LOGIC
        )
        then = scans.always(lambda scan: z3.Implies(late(scan), answered(scan)))
        yield from claim(f"from {scans.control}", {**given, "asked": asked}, then, LOGIC)
        waits = scans.some(
            lambda scan: z3.And(asks(scan), passed(scan) + 1 == limit(scan), z3.Not(answered(scan)))
        )
        due.append(z3.And(*given.values(), scans.some(late)))
        early.append(z3.And(*given.values(), clock(judge.seen) >= 0, waits))
    yield control_query("control: it gets late", {"it is late": z3.Or(*due)}, LOGIC)
    yield control_query("control: a millisecond earlier it may wait", {"it waits": z3.Or(*early)}, LOGIC)


def waits_without_end(judge: Judge, row: Response, asks: Property, answered: Property) -> Queries:
    """A call that asks, is not answered and changes no memory does so again and again, whatever time passes.

    The claim is made for each control state that `asks` speaks of, and its twin shows that there is such a
    call. Neither property may look at what an observer has seen.
    """
    if row.calls is not None or row.times:
        raise TheoremError(
            f"{row.id}: the theorem shows that there is no bound; give neither calls nor times"
        )
    later, some_time = z3.Int("a later call comes after"), []
    for scans in judge.scans():
        passed = scans.scan.inputs.dt_ms.term
        waits = scans.some(lambda scan: z3.And(asks(scan), z3.Not(answered(scan)), _stands_still(scan)))
        some_time.append(z3.And(*judge.premises(scans).values(), scans.some(answered)))
        if z3.is_false(z3.simplify(waits)):
            continue
        given = {**judge.premises(scans), "it waits": z3.And(passed >= 1, waits), "time passes": later >= 1}
        yield from claim(f"for ever in {scans.control}", given, z3.substitute(waits, (passed, later)), LOGIC)
    yield control_query("control: it can be answered", {"it is": z3.Or(*some_time)}, LOGIC)


def _stands_still(scan: Scanned) -> z3.BoolRef:
    """The memory after the scan is that before it, the control state too."""
    if not scan.becomes(control(scan.device, scan.before)):
        return FALSE
    pairs = zip(terms(scan.before), terms(scan.after), strict=True)
    return z3.And(*(was == now for (_, was), (_, now) in pairs if isinstance(was, z3.ExprRef)))


def needs_all(judge: Judge, row: Response, calls_left: Callable[..., z3.ArithRef]) -> Query:
    """A control for a theorem that lowers a number in each call: somewhere it is `row.calls`.

    calls_left: the number, of a scan and whether its memory before the scan is meant.
    """
    found = []
    for scans in judge.scans():
        scan = next(iter(scans.read.values()))
        found.append(z3.And(*judge.premises(scans).values(), calls_left(scan, before=True) == row.calls))
    return control_query(f"control: the number is {row.calls} somewhere", {"it is": z3.Or(*found)}, LOGIC)


def waited_for(row: Response, params: Any) -> z3.ArithRef:
    """The times of the row together, in ms."""
    return sum((often * getattr(params, name) for name, often in row.times.items()), z3.IntVal(0))

"""A log of one device beside the reference implementation, where no TLC is installed.

It has one answer for each scan, so a log from power-up that shows every input and time needs no model
checker. That the reference has the transitions of the specification is what `modeproof verify` compares.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from modeproof.graph.implementation import REFERENCE, load_implementation
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import adding
from modeproof.trace.exact import MOST_STATES, Matched
from modeproof.trace.follow import NotFollowed
from modeproof.trace.log import LONGEST_MS, Log, Row
from modeproof.trace.log_judge import BY_REFERENCE, Judgement, compared
from modeproof.trace.targets import Target
from modeproof.trace.why import Taken, Why


def judge_by_reference(target: Target, log: Log) -> tuple[Judgement, Why | None]:
    """The judgement, and what was expected in the first scan that does not fit.

    Raises Unjudged where a line leaves something open, so that only TLC can judge.
    """
    share = compared(target, log, {})
    if not share.lines:
        raise Unjudged(f"{log.name}: nothing to compare: no line shows an output of {target.id}")
    device = target.only.device
    code = load_implementation(REFERENCE, target.document, device.id)
    params = log.params[device.id]
    states = [code.start(device, target.forms, params)]
    limits = [params.get(of.name, of.default) for of in device.parameters.values() if of.type == "ms"]
    times = dict.fromkeys([0, 1, *limits, LONGEST_MS])
    followed = NotFollowed("TLC, which makes the graph, is not installed")
    open_since: Row | None = None
    for number, row in enumerate(log.rows):
        _whole(target, log, row)
        if row.dt_ms is None:
            open_since = open_since or row
        given = {device.inputs[name].python: value for name, value in row.inputs.items()}
        after = []
        wrong: dict[str, Any] = {}
        for before in states:
            for dt_ms in times if row.dt_ms is None else [row.dt_ms]:
                try:
                    state, out = code.step(before, code.inputs(dt_ms, **given))
                except (TypeError, ValueError, AttributeError) as error:
                    raise Unjudged(f"{log.name}: line {row.line}: {error}") from None
                gives = {name: getattr(out, device.outputs[name].python) for name in row.outputs}
                if gives == dict(row.outputs):
                    after.append(state)
                else:
                    wrong = wrong or gives
        if not after and open_since is None:
            found = Judgement(log, followed, Matched(number, ()), share, BY_REFERENCE)
            return found, _why(target, states[0], row, wrong)
        states = list(dict.fromkeys(after))
        if open_since is not None and (wrong or len(states) > MOST_STATES):  # another time may lead elsewhere
            raise _open(log, open_since, ["the time"])
        if len(states) == 1:  # whatever the time was
            open_since = None
    return Judgement(log, followed, Matched(len(log.rows), ()), share, BY_REFERENCE), None


def _why(target: Target, before: Any, row: Row, gives: Mapping[str, Any]) -> Why:
    device = target.only.device
    memory = {name: str(getattr(before, of.python)) for name, of in device.memory.items()}
    wrong = tuple(name for name, value in row.outputs.items() if gives[name] != value)
    return Why(device.id, 1, memory, (Taken("", None, (), gives, wrong, (), ()),), ())


def _whole(target: Target, log: Log, row: Row) -> None:
    """Refuse a line that leaves an input open. Raises Unjudged."""
    missing = [name for name in target.only.device.inputs if name not in row.inputs]
    if missing:
        raise _open(log, row, missing)


def _open(log: Log, row: Row, missing: Sequence[str]) -> Unjudged:
    return Unjudged(
        f"{log.name}: line {row.line} leaves {', '.join(missing)} open, so only TLC can judge it: "
        f"{adding('tlc', 'TLC and its Java')}"
    )

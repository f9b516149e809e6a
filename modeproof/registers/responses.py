"""Response times: whether each bound is proved by the theorem that names it, and how it reads in ms.

In ms a row takes one longest cycle C until a call sees what happened, C for each further call, for each time
that time and up to C more, and C until the last call ends: (calls + times + 1) C and the times. Inputs are
read when a call begins, outputs are there when it ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.citations import Sources
from modeproof.registers.files import markdown
from modeproof.registers.load import load_responses
from modeproof.registers.rows import Chain, Document, Problem, Response, Responses


@dataclass(frozen=True)
class Bound:
    """A row or a chain as a reader needs it: what, the sum in symbols, the example in ms, what shows it."""

    id: str
    start: str
    end: str
    formula: str
    example: str
    shown: tuple[str, ...]
    clauses: tuple[str, ...] = ()


def check_responses(document: Document, sources: Sources) -> list[Problem]:
    """Rows without a proof, proofs without a row, unknown names, examples that leave something out."""
    file = document.source("properties")
    problems = [Problem(file, place, text) for place, text in _faults(document, sources)]
    known = [row.id for row in document.responses.rows]
    for module in sources.proofs:
        for theorem in module.theorems:
            for name in theorem.responses:
                if name not in known:
                    text = f"proves the unknown response {name!r}; {suggestion(name, known)}"
                    problems.append(Problem(module.file, theorem.name, text))
    return problems


def _faults(document: Document, sources: Sources) -> Iterator[tuple[str, str]]:
    found, devices = document.responses, document.interface.devices
    for row in found.rows:
        if row.device not in devices:
            yield row.id, f"unknown device {row.device!r}; {suggestion(row.device, devices)}"
            continue
        parameters = devices[row.device].parameters
        for name in row.times:
            if name not in parameters or parameters[name].type != "ms":
                yield row.id, f"times: {name!r} is no time among the parameters of {row.device}"
        if (row.calls is None) == (not row.unbounded.strip()):
            yield row.id, "give either `calls`, or in `unbounded` why there is no bound"
        try:
            _bound(document, sources, row)
        except Unjudged as error:
            yield row.id, error.message
        proofs = theorems_of(sources, row)
        if len(proofs) != 1:
            some = (
                f"{len(proofs)} theorems name it ({', '.join(proofs)})" if proofs else "no theorem names it"
            )
            yield row.id, f"{some}; exactly one must, with responses=[{row.id!r}]"
    for chain in found.chains:
        try:
            _chain(document, chain)
        except Unjudged as error:
            yield chain.id, error.message
        if bool(chain.then) != bool(chain.then_ms):
            yield chain.id, "give both `then` and `then_ms`, or neither"
    used = {row.device for row in found.rows if row.calls}.union(*(row.times for row in found.rows))
    for name in (*found.example.cycle, *found.example.times):
        if name not in used:
            yield "[example]", f"no row with a bound needs {name}"


def theorems_of(sources: Sources, row: Response) -> tuple[str, ...]:
    """The theorems that name the row."""
    named = (theorem for module in sources.proofs for theorem in module.theorems)
    return tuple(theorem.name for theorem in named if row.id in theorem.responses)


def _steps(document: Document, chain: Chain) -> list[tuple[Response, Responses]]:
    """The rows of a chain, each with its register. Raises Unjudged: a name that is nowhere, a row without a
    bound.
    """
    found = []
    for step in chain.steps:
        name, _, row_id = step.rpartition(" ")
        register = load_responses(document.root, name) if name else document.responses
        rows = {row.id: row for row in register.rows}
        if row_id not in rows:
            raise Unjudged(f"steps: there is no response {step!r}; {suggestion(row_id, rows)}")
        if rows[row_id].calls is None:
            raise Unjudged(f"{row_id} has no bound, so the chain has none")
        found.append((rows[row_id], register))
    return found


def bounds(document: Document, sources: Sources) -> list[Bound]:
    """One for each row, in its order; what has no bound says so."""
    return [_bound(document, sources, row) for row in document.responses.rows]


def _bound(document: Document, sources: Sources, row: Response) -> Bound:
    if row.calls is None:
        said = (f"none: {row.unbounded}", "none")
    else:
        said = (_formula([row]), f"{_ms([(row, document.responses)])} ms")
    return Bound(row.id, row.start, row.end, *said, theorems_of(sources, row), row.clauses)


def chain_bounds(document: Document) -> list[Bound]:
    """The sum of each chain: its rows, a transfer between each two, and what comes last."""
    return [_chain(document, chain) for chain in document.responses.chains]


def _chain(document: Document, chain: Chain) -> Bound:
    steps = _steps(document, chain)
    rows = [row for row, _ in steps]
    formula, total = _formula(rows), _ms(steps) + chain.then_ms
    if transfers := len(rows) - 1:
        formula += f" + {_times(transfers, 't')}"
        total += transfers * document.responses.example.transfer
    last = f" + {chain.then}" if chain.then else ""
    return Bound(chain.id, chain.title, "", formula + last, f"{total} ms", chain.steps)


def _formula(rows: Sequence[Response]) -> str:
    times: dict[str, int] = {}
    for row in rows:
        for name, often in row.times.items():
            times[name] = times.get(name, 0) + often
    parts = [_times(often, name.removesuffix("_ms")) for name, often in times.items()]
    return " + ".join([*parts, *(_times(_cycles(row), f"C({row.device})") for row in rows)])


def _times(number: int, name: str) -> str:
    return name if number == 1 else f"{number} {name}"


def _cycles(row: Response) -> int:
    return (row.calls or 0) + row.waits + 1


def _ms(steps: Sequence[tuple[Response, Responses]]) -> int:
    """The example: each row with the numbers of its own register. Raises Unjudged where one is missing."""
    total = 0
    for row, register in steps:
        given = {**register.example.cycle, **register.example.times}
        needed = {row.device: _cycles(row), **row.times}
        if lost := [name for name in needed if name not in given]:
            raise Unjudged(
                f"[example] of {register.source} has no ms for {', '.join(lost)}, which {row.id} needs"
            )
        total += sum(often * given[name] for name, often in needed.items())
    return total


def example_of(document: Document) -> str:
    """The numbers of the worked example in one line."""
    example = document.responses.example
    said = [f"C({device}) = {ms} ms" for device, ms in example.cycle.items()]
    said += [f"{name.removesuffix('_ms')} = {ms} ms" for name, ms in example.times.items()]
    then = {f"{chain.then} in {chain.then_ms} ms" for chain in document.responses.chains if chain.then}
    return ", ".join([*said, f"t = {example.transfer} ms", *sorted(then)])


EXPLAINED = (
    "These times follow from the steps of the devices. C is the longest time from the beginning of one "
    "call of a device to that of the next. A call reads its inputs when it begins, and its outputs are set "
    "when it ends, before the next. So an answer in one call takes two cycles: one until a call sees what"
    " happened, and one until it ends. t is the longest transfer from one device to the next, with input "
    "filters; what lies before the first device comes on top. Each bound is typed once, in the register: "
    "the theorem takes it from there, and refuses any other. Where there is none, the theorem shows calls"
    " that go on like that for ever, whatever time passes. A chain is a sum of rows, with a transfer "
    "between each two: that the devices are wired so, and how long the last part takes, is assumed."
)
"""How the table is to be read."""


def section(document: Document, sources: Sources) -> Iterator[str]:
    """How soon the devices answer, in symbols and in an example."""
    if not document.responses.rows:
        return
    rows = [
        [
            row.id,
            f"{row.start} **to** {row.end}",
            row.formula,
            row.example,
            " ".join(f"`{name}`" for name in row.shown),
        ]
        for row in bounds(document, sources)
    ]
    yield (
        f"## Response times\n\n{EXPLAINED}\n\nThe example has {example_of(document)}. Register: "
        f"[properties.toml](../{document.source('properties')}).\n\n"
        + markdown(["id", "from, to", "longest time", "example", "theorem"], rows)
    )
    if chains := chain_bounds(document):
        sums = [[row.id, row.start, row.formula, row.example, ", ".join(row.shown)] for row in chains]
        yield markdown(["id", "chain", "longest time", "example", "sum of"], sums)

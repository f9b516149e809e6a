"""The first answer of `prove-program --target`: does the program follow the page? In lines and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from programs.demands.verdicts import TYPES, Found, Judgement
from programs.demands.watched import Broken
from programs.equality.comparison import numbers_of, times_of
from programs.equality.product import Product
from programs.language.tool_differences import assumed
from programs.semantics.reference import Reference

Word = Literal["FOLLOWS", "BREAKS", "UNKNOWN"]
EXIT: Mapping[Word, Literal[0, 1, 2]] = {"FOLLOWS": 0, "BREAKS": 1, "UNKNOWN": 2}


@dataclass(frozen=True)
class Followed:
    """The verdicts on the demands of the page. product: the program as it was bound."""

    product: Product
    judgement: Judgement
    found: Sequence[Found]

    @property
    def word(self) -> Word:
        """FOLLOWS: all demands are proved. BREAKS: one is broken. UNKNOWN: neither."""
        words = {one.word for one in self.found}
        if "BROKEN" in words:
            return "BREAKS"
        whole = bool(self.rows) and not self.judgement.beside.unjudged
        return "FOLLOWS" if whole and words == {"PROVED"} else "UNKNOWN"

    @property
    def rows(self) -> list[Found]:
        """The verdicts on the demands of the page."""
        return [one for one in self.found if one.asked.id != TYPES]

    @property
    def by_equality(self) -> bool:
        """Some demand is proved of the reference, with which the program is proved to be equal."""
        return any(one.by_equality for one in self.found)

    @property
    def broken(self) -> list[Found]:
        """Those that are broken."""
        return [one for one in self.found if one.word == "BROKEN"]

    @property
    def reference(self) -> Reference:
        """The target."""
        return self.product.binding.reference

    @property
    def subject(self) -> str:
        """The program in words."""
        binding = self.product.binding
        return f"{binding.unit.kind} {binding.unit.name} of {', '.join(binding.source.files)}"

    @property
    def counts(self) -> str:
        """How many demands are proved, of how many."""
        proved = sum(one.word == "PROVED" for one in self.rows)
        return f"{proved} of {len(self.rows) + len(self.judgement.beside.unjudged)} demands"

    @property
    def sentence(self) -> str:
        """The verdict in a sentence."""
        page = f"the page of {self.reference.device.name} ({self.reference.document})"
        if self.word == "FOLLOWS":
            return f"FOLLOWS: {self.subject} follows {page}: {self.counts}, proved for ever"
        if self.word == "BREAKS":
            names = ", ".join(named(one) for one in self.broken)
            return f"BREAKS {names}: {self.subject} does not follow {page}"
        return f"UNKNOWN: {self.subject} and {page}: {self.counts} proved, and none seen to be broken"


def named(found: Found) -> str:
    """A demand with its clauses."""
    clauses = f" ({', '.join(found.asked.clauses)})" if found.asked.clauses else ""
    return f"{found.asked.id}{clauses}"


# ---------------------------------------------------------------- lines


def text_of(followed: Followed, seconds: float) -> Iterator[str]:
    """The verdict in lines."""
    judgement, product = followed.judgement, followed.product
    yield followed.sentence
    for one in followed.broken:
        yield from _break(followed.reference, one)
    for one in followed.found:
        if one.word == "UNKNOWN":
            yield f"  not shown   {one.asked.id}: {one.how}"
    for row in judgement.beside.unjudged:
        hidden = ", ".join(sorted(row.outputs & {*judgement.beside.unobserved}))
        yield f"  not judged  {row.id}: the output {hidden} is left out"
    for label, by_equality in (("proved", False), ("by equality", True)):
        rows = [one for one in followed.found if one.word == "PROVED" and one.by_equality == by_equality]
        if rows:
            yield f"  {label:<11} {', '.join(one.asked.id for one in rows)}"
    if followed.by_equality:
        yield "              proved of the reference, of which the program is proved to be the same"
    latency = judgement.beside.latency
    yield f"  latency     {latency} scan{'s' * (latency != 1)} for a reaction"
    yield f"  parameters  {parameters_of(product)}"
    for text in judgement.beside.assumed.words():
        yield f"  assumed     {text}"
    yield f"  inputs      every value, {times_of(product)}"
    yield f"  numbers     {numbers_of(product)}"
    if choices := list(assumed(product.binding.source, product.binding.unit, product.binding.steady)):
        yield f"  assumed     {'; '.join(choices)}"
    replays = judgement.replays
    if replays.cases:
        yield f"  vectors     the inputs of {replays.cases} published cases, {replays.scans:,} scans"
        unseen = [row.id for row in judgement.beside.rows if row.id not in replays.seen]
        if unseen and followed.word == "FOLLOWS":
            yield f"  not asked   in these: {', '.join(unseen)}"
    yield f"  effort      {seconds:.1f} s CPU"


def parameters_of(product: Product) -> str:
    """The parameters of the page, and for which values the verdict is."""
    binding = product.binding
    signals = binding.reference.signals("parameters")
    narrowed = {text.partition(" ")[0]: text for text in binding.narrowed()}
    printed = [name for name, of in signals.items() if not of.project and of.cautious is None]
    free = [narrowed.get(name, name) for name in printed if name in binding.free_parameters]
    fixed = [f"{name} = {binding.values[name]}" for name in printed if name in binding.values]
    return "; ".join([f"any {', '.join(free)}" if free else "none is an input of the program", *fixed])


def _break(reference: Reference, found: Found) -> Iterator[str]:
    broken = found.broken
    assert broken is not None
    yield f"  the page    {found.asked.id}: {found.asked.says}"
    if found.asked.text:
        yield f"  demand      {found.asked.text}"
    yield f"  found by    {broken.found_by}; {found.how}; replayed on the program's interpreter"
    parameters = reference.to_wire("parameters", broken.run.parameters)
    yield "  set         " + (row_of(parameters) or "no parameters")
    if broken.run.retained:
        yield "  retained    " + row_of(broken.run.retained)
    before: Mapping[str, Any] = {}
    shown: Mapping[str, Any] = {}
    for number, step in enumerate(broken.steps, 1):
        changed = row_of(_new(before, step.inputs)) or "the same inputs"
        yield f"  scan {number:<6} after {step.dt_ms} ms: {changed}"
        before = step.inputs
        if not step.stopped:
            yield f"              gives {row_of(_new(shown, step.outputs)) or 'the same outputs'}"
            shown = step.outputs
    if broken.stopped:
        yield f"              stops: {broken.stopped}"


def _new(before: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name not in before or before[name] != value}


def row_of(values: Mapping[str, Any]) -> str:
    """Values of the wire in a line."""
    return ", ".join(
        f"{name}={int(value) if isinstance(value, bool) else value}" for name, value in values.items()
    )


def at_once(found: Broken, id: str, clauses: Sequence[str]) -> str:
    """What is printed of a break before fewer scans are looked for."""
    where = f" ({', '.join(clauses)})" if clauses else ""
    return (
        f"breaks {id}{where} in scan {len(found.run.scans)} of the {found.found_by}; looking for fewer scans"
    )


# ---------------------------------------------------------------- JSON


def record_of(followed: Followed) -> dict[str, Any]:
    """The verdicts as JSON."""
    beside = followed.judgement.beside
    return {
        "verdict": followed.word,
        "latency": beside.latency,
        "assumed": list(beside.assumed.words()),
        "demands": [_row(followed.reference, one) for one in followed.found],
        "unjudged": [row.id for row in beside.unjudged],
        "vectors": {"cases": followed.judgement.replays.cases, "scans": followed.judgement.replays.scans},
    }


def _row(reference: Reference, found: Found) -> dict[str, Any]:
    row: dict[str, Any] = {
        "id": found.asked.id,
        "says": found.asked.says,
        "clauses": list(found.asked.clauses),
        "verdict": found.word,
        "how": found.how,
        "searched_scans": found.scans or None,
    }
    if found.broken is not None:
        row["broken"] = {
            "found_by": found.broken.found_by,
            "parameters": reference.to_wire("parameters", found.broken.run.parameters),
            "retained": dict(found.broken.run.retained),
            "scans": [
                {"dt_ms": step.dt_ms, "in": dict(step.inputs), "out": dict(step.outputs)}
                for step in found.broken.steps
            ],
            "stopped": found.broken.stopped,
        }
    return row

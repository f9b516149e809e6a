"""The demands of a target as an observer: what it remembers of the wires, and which demand a scan breaks.

The same code runs with terms and with plain values. What it remembers is single values by their names, all
of them bools, numbers and words: the wires of the scan before, what the rules remember, and how long a demand
that must come has waited.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged
from modeproof.kit.demands import BEFORE, Demand, Demands, Rule
from modeproof.kit.signals import Signal
from programs.demands.expressions import Evaluation, Items, Text, every, negated, some, true

LATENCY = 1
"""Scans that a reaction may take, if no other number is given."""
WIDTH = 16


@dataclass(frozen=True)
class Watched:
    """One scan: what is remembered after it, and for each demand whether it is asked, and broken."""

    after: Mapping[str, Any]
    asked: Mapping[str, Any]
    broken: Mapping[str, Any]


def leaves(value: Any, name: str, form: Any) -> Iterator[tuple[str, Any]]:
    """The single values of a value, by their names. form: a value of the same form, which is always taken."""
    if isinstance(form, Items):
        if not isinstance(value, Items) or len(value.entries) != len(form.entries):
            raise Unjudged(f"{name}: a list whose length is open is remembered")
        pairs = zip(value.entries, form.entries, strict=True)
        for place, ((there, one), (is_there, part)) in enumerate(pairs):
            if is_there is not True:
                yield f"{name}[{place}]?", there
            yield from leaves(one, f"{name}[{place}]", part)
    else:
        yield name, value.term if isinstance(value, Text) else value


def rebuilt(like: Any, name: str, values: Mapping[str, Any]) -> Any:
    """A value of this form out of single values."""
    if isinstance(like, Items):
        entries = []
        for place, (there, one) in enumerate(like.entries):
            is_there = True if there is True else values[f"{name}[{place}]?"]
            entries.append((is_there, rebuilt(one, f"{name}[{place}]", values)))
        return Items(tuple(entries))
    return Text(values[name], like.values) if isinstance(like, Text) else values[name]


def first_value(signal: Signal) -> Any:
    """What stands on a wire before the first scan."""
    match signal.type:
        case "bool":
            return False
        case "word":
            return z3.BitVecVal(0, WIDTH)
        case "mode":
            return -1
        case "modes":
            return Items(tuple((z3.BoolVal(False), mode) for mode in signal.modes))
        case "text":
            return Text(z3.IntVal(signal.values.index("") if "" in signal.values else -1), signal.values)
    return 0


def cleared(value: Any) -> Any:
    """A value of the same form, with nothing in it."""
    if isinstance(value, Items):
        return Items(tuple((there is True, cleared(one)) for there, one in value.entries))
    if isinstance(value, Text):
        return Text(-1, value.values)
    if isinstance(value, bool | z3.BoolRef):
        return False
    return z3.BitVecVal(0, value.size()) if isinstance(value, z3.BitVecRef) else 0


def symbol_like(value: Any, name: str) -> Any:
    """A symbol of the sort of a single value."""
    if isinstance(value, bool | z3.BoolRef):
        return z3.Bool(name)
    return z3.BitVec(name, value.size()) if isinstance(value, z3.BitVecRef) else z3.Int(name)


def constant_like(term: Any, value: Any) -> Any:
    """A plain value, or a term, in the sort of a term."""
    if isinstance(value, z3.ExprRef):
        if z3.is_bool(term) or not z3.is_bool(value):
            if z3.is_int(term) and z3.is_bv(value):
                return z3.BV2Int(value)
            return value
        return z3.If(value, z3.IntVal(1), z3.IntVal(0))
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), term.size()) if z3.is_bv(term) else z3.IntVal(int(value))


@dataclass(frozen=True)
class Observer:
    """The demands that rest on what is observed.

    wires, steady: terms of each input and output, and of each parameter. latency: scans that a reaction may
    take.
    """

    demands: Demands
    rows: Sequence[Demand]
    wires: Mapping[str, Any]
    steady: Mapping[str, Any]
    latency: int = LATENCY

    @cached_property
    def rules(self) -> tuple[Rule, ...]:
        """The rules on which the demands rest."""
        by_name = {rule.name: rule for rule in self.demands.rules}
        found: set[str] = set()
        waiting = [name for row in self.rows for name in (*row.when.names, *row.holds.names)]
        while waiting:
            name = waiting.pop()
            if name in by_name and name not in found:
                found.add(name)
                waiting += by_name[name].expression.names
        return tuple(rule for rule in self.demands.rules if rule.name in found)

    @cached_property
    def before(self) -> dict[str, Signal]:
        """The wires whose values before are looked at, by their names."""
        read = [rule.expression.names for rule in self.rules]
        read += [names for row in self.rows for names in (row.when.names, row.holds.names)]
        known = {**self.demands.inputs, **self.demands.outputs}
        wanted = frozenset[str]().union(*read)
        return {name: of for name, of in known.items() if BEFORE + name in wanted}

    @cached_property
    def starts(self) -> dict[str, Any]:
        """The value of each memory at power-up."""
        found = {}
        for rule in self.rules:
            if rule.kind == "memory":
                found[rule.name] = Items.of(rule.starts) if isinstance(rule.starts, list) else rule.starts
        return found

    @cached_property
    def _fixed(self) -> dict[str, tuple[Any, Any]]:
        """What is remembered but of rules that are recent."""
        found: dict[str, tuple[Any, Any]] = {}
        for name, signal in self.before.items():
            found |= _remembered(BEFORE + name, self.wires[name], first_value(signal))
        for name, start in self.starts.items():
            found |= _remembered(name, start, start)
        if any(rule.kind == "recent" for rule in self.rules):
            for back in self._back:
                found |= _remembered(f"scans before: {back}", False, False)
        for row in self.rows:
            for back in self._back if row.comes else ():
                found |= _remembered(f"{row.id} waits: {back}", False, False)
        return found

    @property
    def _back(self) -> range:
        return range(1, self.latency + 1)

    @cached_property
    def forms(self) -> dict[str, Any]:
        """A value of each rule that is recent, for its form."""
        memory = {name: symbol for name, (symbol, _) in self._fixed.items()}
        return self._scan(self.wires, self.steady, memory, z3.IntVal(0), {})[1]

    @cached_property
    def state(self) -> dict[str, tuple[Any, Any]]:
        """Each single value that it remembers: its symbol, and its value at power-up."""
        found = dict(self._fixed)
        for name, form in self.forms.items():
            for back in self._back:
                found |= _remembered(f"{name} {back} before", form, cleared(form))
        return found

    # ------------------------------------------------------------ one scan

    def terms(self, wires: Mapping[str, Any], dt_ms: Any) -> Watched:
        """One scan from any memory, as terms over the symbols."""
        memory = {name: symbol for name, (symbol, _) in self.state.items()}
        found = self._scan(wires, self.steady, memory, dt_ms, self.forms)[0]
        after = {name: constant_like(symbol, found.after[name]) for name, symbol in memory.items()}
        return Watched(after, _formulas(found.asked), _formulas(found.broken))

    def plain(
        self, wires: Mapping[str, Any], steady: Mapping[str, Any], memory: Mapping[str, Any], dt_ms: int
    ) -> Watched:
        """One scan with plain values."""
        found = self._scan(wires, steady, memory, dt_ms, self.forms)[0]
        after = {
            name: bool(found.after[name]) if z3.is_bool(symbol) else int(found.after[name])
            for name, (symbol, _) in self.state.items()
        }
        return Watched(after, found.asked, found.broken)

    def _scan(
        self,
        wires: Mapping[str, Any],
        steady: Mapping[str, Any],
        memory: Mapping[str, Any],
        dt_ms: Any,
        forms: Mapping[str, Any],
    ) -> tuple[Watched, dict[str, Any]]:
        constants = self.demands.constants.items()
        names = {name: Items.of(value) if isinstance(value, list) else value for name, value in constants}
        names |= {**steady, **wires, "dt_ms": dt_ms, "latency": self.latency}
        for name in self.before:
            names[BEFORE + name] = rebuilt(self.wires[name], BEFORE + name, memory)
        for name, start in self.starts.items():
            names[name] = rebuilt(start, name, memory)
        at, after, met = Evaluation(names), dict[str, Any](), dict[str, Any]()
        for name in self.before:
            after |= leaves(wires[name], BEFORE + name, self.wires[name])
        for rule in self.rules:
            value = at.value(rule.expression.text, f"rule {rule.name}")
            if rule.kind == "memory":
                after |= leaves(value, rule.name, self.starts[rule.name])
            elif rule.kind == "recent":
                met[rule.name] = value
                known = [(True, value)]
                for back in self._back if rule.name in forms else ():
                    name, form = f"{rule.name} {back} before", forms[rule.name]
                    after |= leaves(known[0][1], name, form)
                    known.insert(0, (memory[f"scans before: {back}"], rebuilt(form, name, memory)))
                value = Items(tuple(known))
            at.names[rule.name] = value
        for back in self._back:
            after[f"scans before: {back}"] = back == 1 or memory.get(f"scans before: {back - 1}", False)
        asked, broken, of_rules = dict[str, Any](), dict[str, Any](), tuple(at.wrong)
        for row in self.rows:
            at.wrong = []
            asked[row.id] = true(at.value(row.when.text, row.id))
            late = False
            if asked[row.id] is not False:
                holds = true(at.value(row.holds.text, row.id, asked[row.id]))
                late = every(asked[row.id], negated(holds))
            for back in self._back if row.comes else ():
                after[f"{row.id} waits: {back}"] = late
                late = every(late, memory[f"{row.id} waits: {back}"])
            # Without a value the demand cannot be said to hold.
            broken[row.id] = some(late, *of_rules, *at.wrong)
        return Watched(after, asked, broken), met


def _remembered(name: str, form: Any, start: Any) -> dict[str, tuple[Any, Any]]:
    """The symbol and the first value of each single value."""
    starts = dict(leaves(start, name, form))
    found = {}
    for leaf, value in leaves(form, name, form):
        if isinstance(value, str):
            raise Unjudged(f"{name}: a memory of texts")
        symbol = symbol_like(value, leaf)
        found[leaf] = symbol, constant_like(symbol, starts[leaf])
    return found


def _formulas(values: Mapping[str, Any]) -> dict[str, z3.BoolRef]:
    return {id: z3.BoolVal(value) if isinstance(value, bool) else value for id, value in values.items()}

"""One scan of a program as solver terms: the memory after it, its outputs, and what must not happen.

BOOL is a Bool, bit strings are bit vectors, integers, enumerations and times are unbounded integers with an
obligation for each range that the program must not leave. A timer that is called once in every scan needs no
clock; any other one remembers how long ago it was started.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.calls import in_outs
from programs.run import default
from programs.terms import (
    FALSE,
    TRUE,
    Env,
    between,
    both,
    constant,
    either,
    in_range,
    merge,
    negated,
    singles,
    standard_call,
)
from programs.tree import (
    Assign,
    Body,
    Call,
    Case,
    Expression,
    For,
    If,
    Instance,
    Place,
    Return,
    Scalar,
    Source,
    Stop,
    Type,
    Unit,
)
from programs.types import Types
from programs.values import Context


@dataclass(frozen=True)
class Obligation:
    """What must hold in every scan so that the program stays within its types."""

    formula: z3.BoolRef
    text: str
    place: Place


@dataclass(frozen=True)
class Scan:
    """A scan from any memory: terms over the symbols of memory, of the inputs and of `dt_ms`.

    after, outputs: by the path of each single value, in upper case.
    """

    after: Mapping[str, Any]
    outputs: Mapping[str, Any]
    obligations: tuple[Obligation, ...]


@dataclass
class Translator:
    """Translates one scan of a unit. wrap: integers and times wrap instead of owing their range."""

    source: Source
    unit: Unit
    wrap: bool = False
    obligations: list[Obligation] = field(default_factory=list)

    def scan(self, memory: Mapping[str, Any], dt_ms: Any) -> Scan:
        """One scan from this memory, inputs included."""
        env: Env = dict(memory)
        for path in memory:
            if path.endswith(".age"):
                env[path] = env[path] + dt_ms
        self.call(self.unit, "", env, TRUE)
        outputs = {
            path: env[path]
            for name, variable in self.unit.of("output").items()
            if not isinstance(variable.type, Instance)
            for path, _, _ in singles(variable.type, name.upper(), default(variable.type, None))
        }
        return Scan({path: env[path] for path in memory}, outputs, tuple(self.obligations))

    def call(self, unit: Unit, above: str, env: Env, here: z3.BoolRef) -> None:
        """One call of a unit; `here`: the condition under which it happens."""
        if unit.device is not None:
            unit.device.terms(above.removesuffix("."), env)
            return
        for name, variable in unit.of("temp").items():
            for path, kind, value in singles(
                variable.type, f"{above}{name.upper()}", default(variable.type, variable.initial)
            ):
                env[path] = constant(kind, value)
        self.body(Context(self, Types(self.source, unit), above), unit.body, env, here)

    def body(self, at: Context, body: Body, env: Env, here: z3.BoolRef) -> z3.BoolRef:
        """Carry out a body in `env`; returns the condition under which RETURN was met in it."""
        returned = FALSE
        for n, statement in enumerate(body):
            if not z3.is_false(returned):
                rest = dict(env)
                more = self.body(at, body[n:], rest, both(here, negated(returned)))
                merge(env, returned, dict(env), rest)
                return either(returned, more)
            returned = self.statement(at, statement, env, here)
            if z3.is_true(returned):
                return returned
        return returned

    def statement(self, at: Context, statement: Any, env: Env, here: z3.BoolRef) -> z3.BoolRef:
        match statement:
            case Assign(target, value, place):
                kind = at.types.of(target)
                assert isinstance(kind, Scalar)
                given = at.types.of(value, kind)
                term = self.fitted(at.value(value, env, here, kind), given, kind, place, here)
                at.store(target, term, env, here)
            case If(branches, otherwise, _):
                return self.branches(at, list(branches), otherwise, env, here)
            case Case(subject, clauses, otherwise, _):
                term = at.value(subject, env, here)
                kind = at.types.of(subject)
                assert isinstance(kind, Scalar)
                asked = []
                for ranges, inner in clauses:
                    hits = [
                        between(kind, term, at.types.constant(low), at.types.constant(high))
                        for low, high in ranges
                    ]
                    asked.append((z3.Or(*hits) if len(hits) > 1 else hits[0], inner))
                return self.branches(at, asked, otherwise, env, here)
            case For(control, start, end, step, inner, place):
                low, high = at.types.constant(start), at.types.constant(end)
                by = 1 if step is None else at.types.constant(step)
                if by == 0 or abs(high - low) // abs(by) > 1000:
                    raise place.refuse("FOR: at most 1,000 turns, and a step other than 0")
                turns = range(low, high + (1 if by > 0 else -1), by)
                path = f"{at.above}{control.name.upper()}"
                for number in turns:
                    env[path] = z3.IntVal(number)
                    returned = self.body(at, inner, env, here)
                    if not z3.is_false(returned):
                        raise place.refuse("RETURN within FOR is not supported")
                env[path] = z3.IntVal(low + by * len(turns))
            case Call(instance, inputs, outputs, place):
                self.invoke(at, instance, inputs, outputs, env, here)
            case Stop(text, place):
                self.owe(negated(here), text, place)
            case Return():
                return TRUE
        return FALSE

    def branches(
        self, at: Context, branches: list[Any], otherwise: Body, env: Env, here: z3.BoolRef
    ) -> z3.BoolRef:
        if not branches:
            return self.body(at, otherwise, env, here)
        asked, inner = branches[0]
        condition = asked if isinstance(asked, z3.ExprRef) else at.value(asked, env, here)
        condition = z3.simplify(condition)
        if z3.is_true(condition):
            return self.body(at, inner, env, here)
        if z3.is_false(condition):
            return self.branches(at, branches[1:], otherwise, env, here)
        yes, no = dict(env), dict(env)
        first = self.body(at, inner, yes, both(here, condition))
        second = self.branches(at, branches[1:], otherwise, no, both(here, negated(condition)))
        merge(env, condition, yes, no)
        return either(both(condition, first), both(negated(condition), second))

    def invoke(
        self, at: Context, instance: Expression, inputs: Any, outputs: Any, env: Env, here: z3.BoolRef
    ) -> None:
        path = at.path(instance, env, here)
        kind = at.types.of(instance)
        assert isinstance(kind, Instance)
        for name, expression in inputs:
            wanted = at.types.member(kind, name, instance.place, True)
            assert isinstance(wanted, Scalar)
            given = at.types.of(expression, wanted)
            term = self.fitted(at.value(expression, env, here, wanted), given, wanted, instance.place, here)
            env[f"{path}.{name.upper()}"] = term
        if kind.block.upper() in self.source.units:
            self.call(self.source.units[kind.block.upper()], f"{path}.", env, here)
        else:
            standard_call(kind.block.upper(), path, env)
        kept = in_outs(self.source, kind)
        back = [(name, target) for name, target in inputs if name.upper() in kept]
        for name, target in (*back, *outputs):
            at.store(target, env[f"{path}.{name.upper()}"], env, here)

    def fitted(self, term: Any, given: Type, kind: Scalar, place: Place, here: z3.BoolRef) -> Any:
        """A term of the type `given` as a value of the type `kind`."""
        assert isinstance(given, Scalar)
        inside = kind.low <= given.low and given.high <= kind.high
        return self.widened(term, given, kind) if inside else self.ranged(term, kind, place, here)

    def widened(self, term: Any, given: Type, kind: Scalar) -> Any:
        """A bit string as a longer one."""
        if kind.kind == "bits" and isinstance(given, Scalar) and given.width < kind.width:
            return z3.ZeroExt(kind.width - given.width, term)
        return term

    def ranged(self, term: Any, kind: Scalar, place: Place, here: z3.BoolRef) -> Any:
        """The term within the range of its type: as an obligation, or wrapped."""
        if kind.kind not in ("int", "time") or (
            z3.is_int_value(term) and kind.low <= term.as_long() <= kind.high
        ):
            return term
        if self.wrap:
            return (term - kind.low) % (kind.high - kind.low + 1) + kind.low
        self.owe(z3.Implies(here, in_range(kind, term)), f"a value stays within {kind.name}", place)
        return term

    def owe(self, formula: z3.BoolRef, text: str, place: Place) -> None:
        """Note an obligation."""
        self.obligations.append(Obligation(formula, text, place))

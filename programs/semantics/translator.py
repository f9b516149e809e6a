"""One scan of a program as solver terms: the memory after it, its outputs, and what must not happen.

BOOL is a Bool, bit strings are bit vectors, integers, enumerations and times are unbounded integers with an
obligation for each range that the program must not leave. A timer that is called once in every scan needs no
clock; any other one remembers how long ago it was started.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import z3

from programs.language.calls import function_of, handed_to_block, handed_to_function, in_outs
from programs.language.memory import leaves
from programs.language.tree import (
    MOST_TURNS,
    Assign,
    Body,
    Call,
    Case,
    For,
    If,
    Instance,
    Leave,
    Loop,
    Return,
    Scalar,
    Unit,
)
from programs.language.types import Types
from programs.semantics.obligations import Obligation, Obliged
from programs.semantics.terms import (
    FALSE,
    TRUE,
    Env,
    between,
    both,
    constant,
    either,
    merge,
    negated,
    singles,
    standard_call,
)
from programs.semantics.translator_expressions import Context, frame


@dataclass(frozen=True)
class Scan:
    """A scan from any memory: terms over the symbols of memory, of the inputs and of `dt_ms`.

    after, outputs: by the path of each single value, in upper case.
    """

    after: Mapping[str, Any]
    outputs: Mapping[str, Any]
    obligations: tuple[Obligation, ...]


@dataclass(frozen=True)
class Left:
    """The conditions under which a body was left before its end."""

    returned: z3.BoolRef = FALSE
    ended: z3.BoolRef = FALSE
    """By EXIT: so is the loop around it."""
    turned: z3.BoolRef = FALSE
    """By CONTINUE: the next turn of the loop comes."""

    @property
    def early(self) -> z3.BoolRef:
        return either(either(self.returned, self.ended), self.turned)

    def then(self, rest: Left) -> Left:
        """With what follows where this part was not left."""
        stayed = negated(self.early)
        return Left(
            either(self.returned, both(stayed, rest.returned)),
            either(self.ended, both(stayed, rest.ended)),
            either(self.turned, both(stayed, rest.turned)),
        )

    def chosen(self, condition: z3.BoolRef, other: Left) -> Left:
        """This where the condition is true, else the other."""
        no = negated(condition)
        return Left(
            either(both(condition, self.returned), both(no, other.returned)),
            either(both(condition, self.ended), both(no, other.ended)),
            either(both(condition, self.turned), both(no, other.turned)),
        )


class Translator(Obliged):
    """Translates one scan of a unit."""

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
            for path, _, _ in singles(variable.type, name.upper(), None)
        }
        return Scan({path: env[path] for path in memory}, outputs, tuple(self.obligations))

    def call(self, unit: Unit, above: str, env: Env, here: z3.BoolRef, root: str = "") -> None:
        """One call of a unit; `here`: the condition under which it happens; root: the path above globals."""
        root = above if unit.whole else root
        if unit.device is not None:
            unit.device.terms(above.removesuffix("."), env)
            return
        for name, variable in unit.of("temp").items():
            for path, kind, value in singles(variable.type, f"{above}{name.upper()}", variable.initial):
                env[path] = constant(kind, value)
        self.body(Context(self, Types(self.source, unit), above, root), unit.body, env, here)

    def body(self, at: Context, body: Body, env: Env, here: z3.BoolRef) -> Left:
        """Carry out a body in `env`; returns where it was left before its end."""
        left = Left()
        for n, statement in enumerate(body):
            if not z3.is_false(left.early):
                rest = dict(env)
                more = self.body(at, body[n:], rest, both(here, negated(left.early)))
                merge(env, left.early, dict(env), rest)
                return left.then(more)
            left = self.statement(at, statement, env, here)
            if z3.is_true(left.early):
                return left
        return left

    def statement(self, at: Context, statement: Any, env: Env, here: z3.BoolRef) -> Left:
        match statement:
            case Assign(target, value, place):
                terms = at.handed(value, at.types.declared(target), place, env, here)
                at.assign(target, terms, env, here)
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
            case For():
                return self.counted(at, statement, env, here)
            case Loop():
                return self.turns(at, statement, MOST_TURNS, env, here)
            case Call():
                self.invoke(at, statement, env, here)
            case Return():
                return Left(returned=TRUE)
            case Leave(turn, _):
                return Left(turned=TRUE) if turn else Left(ended=TRUE)
        return Left()

    def counted(self, at: Context, loop: For, env: Env, here: z3.BoolRef) -> Left:
        """FOR, turn by turn. After EXIT the control variable keeps its value."""
        low, high = at.types.constant(loop.start), at.types.constant(loop.end)
        by = 1 if loop.step is None else at.types.constant(loop.step)
        if by == 0 or abs(high - low) // abs(by) > 1000:
            raise loop.place.refuse("FOR: at most 1,000 turns, and a step other than 0")
        numbers = range(low, high + (1 if by > 0 else -1), by)
        ((_, path),) = at.places(loop.control, env, here)
        before = Left()  # without `turned`
        for number in (*numbers, None):
            if z3.is_true(before.early):
                break
            turn = dict(env)
            turn[path] = z3.IntVal(low + by * len(numbers) if number is None else number)
            left = Left()
            if number is not None:
                left = self.body(at, loop.body, turn, both(here, negated(before.early)))
            merge(env, before.early, dict(env), turn)
            before = before.then(Left(left.returned, left.ended))
        return Left(before.returned)

    def turns(self, at: Context, loop: Loop, most: int, env: Env, here: z3.BoolRef) -> Left:
        """WHILE and REPEAT, turn by turn; after the last one nothing may be left to do."""
        if loop.first:
            left = self.body(at, loop.body, env, here)
            before = Left(left.returned, left.ended)
        else:
            before = Left()
        for number in range(most + 1):
            stayed = both(here, negated(before.early))
            if z3.is_true(before.early):
                break
            going = z3.simplify(both(negated(before.early), at.value(loop.going, env, stayed)))
            if number == most:
                text = f"the loop ends after {MOST_TURNS} turns at most"
                self.owe(negated(both(here, going)), text, loop.place)
            if number == most or z3.is_false(going):
                break
            turn = dict(env)
            left = self.body(at, loop.body, turn, both(here, going))
            merge(env, going, turn, dict(env))
            before = before.then(Left(both(going, left.returned), both(going, left.ended)))
        return Left(before.returned)

    def branches(self, at: Context, branches: list[Any], otherwise: Body, env: Env, here: z3.BoolRef) -> Left:
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
        return first.chosen(condition, second)

    def invoke(self, at: Context, call: Call, env: Env, here: z3.BoolRef) -> None:
        if (unit := function_of(self.source, at.types.unit, call)) is not None:
            inputs, outputs = handed_to_function(unit, call)
            given = {name.upper(): value for name, value in inputs}
            back = {name.upper(): variable.type for name, variable in unit.of("in_out").items()}
            lent = [(key, at.places(given[key], env, here)) for key in back]
            inner = at.called(given, unit, call.place, env, here)
            env |= {path: inner[path] for path in env}
            for key, spots in lent:
                at.put(spots, {leaf: inner[f"{frame(unit)}{key}{leaf}"] for leaf in leaves(back[key])}, env)
            for name, target in outputs:
                at.assign(target, {"": inner[f"{frame(unit)}{name.upper()}"]}, env, here)
            return
        instances = at.places(call.instance, env, here)
        kind = at.types.of(call.instance)
        assert isinstance(kind, Instance)
        inputs, outputs = handed_to_block(self.source, kind, call)
        for name, expression in inputs:
            wanted = at.types.member(kind, name, call.instance.place, True)
            terms = at.handed(expression, wanted, call.instance.place, env, here)
            at.put([(there, f"{path}.{name.upper()}") for there, path in instances], terms, env)
        kept = in_outs(self.source, kind)
        lent = [(name, at.places(of, env, here)) for name, of in inputs if name.upper() in kept]
        for there, path in instances:
            made = env if z3.is_true(there) else dict(env)
            if kind.block.upper() in self.source.units:
                self.call(self.source.units[kind.block.upper()], f"{path}.", made, both(here, there), at.root)
            else:
                standard_call(kind.block.upper(), path, made)
            if made is not env:
                merge(env, there, made, dict(env))

        def pin(name: str) -> Mapping[str, Any]:
            declared = at.types.member(kind, name, call.instance.place, True)
            where = [(there, f"{path}.{name.upper()}") for there, path in instances]
            return {leaf: at.read(where, leaf, env) for leaf in leaves(declared)}

        for name, spots in lent:
            at.put(spots, pin(name), env)
        for name, target in outputs:
            at.assign(target, pin(name), env, here)

"""What a document demands of a target, judged scan by scan on what is on its wires, whatever its steps.

The demands are data:

    {"constants": {"CODES": [240, 15]},
     "rules": [{"name": "level", "kind": "value", "is": "index(CODES, W) if ON else -1"},
               {"name": "levels", "kind": "recent", "is": "level"},
               {"name": "seen", "kind": "memory", "starts": false, "is": "ON and (seen or level >= 0)"}],
     "demands": [{"id": "LampNeedsLevel", "says": "..", "clauses": [".."], "when": "LAMP", "holds": "seen"},
                 {"id": "LampComes", "says": "..", "clauses": [".."], "when": "seen", "comes": "LAMP"}]}

Rules are evaluated in their order in every scan. Of kind `value` is what is there now; a `memory` keeps
its value until its place comes in the next scan, and starts with `starts`; `recent` is the list of the values
in this scan and as many before it as the program may need to show what its inputs have done (`latency`, from
0). A demand `holds` in every scan in which its `when` does; or what it asks for `comes`: as long as `when`
stays true, at the latest `latency` scans after the first of them.

Beside them, `"constant": {"ON": ["TOY-2"]}` has the inputs that the document calls constant, each with the
clauses that do.

An expression is one in Python's notation, of: and or not, comparisons, in, + and -, `x if c else y`, lists,
list[number], and the functions count index len max min sum. Names: inputs, outputs, parameters, `was_NAME`
for an input or output in the scan before (0, false, or none before the first), constants, rules that are
before (of kind `memory` all), `dt_ms` and `latency`. Words are numbers; a mode that is not there is -1, an
absent text "".
"""

from __future__ import annotations

import ast
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import CodeType
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal

KINDS = ("value", "memory", "recent")
BEFORE = "was_"
_NODES = (
    ast.Expression,
    ast.BoolOp,
    ast.And,
    ast.Or,
    ast.UnaryOp,
    ast.Not,
    ast.USub,
    ast.BinOp,
    ast.Add,
    ast.Sub,
    ast.Compare,
    ast.Eq,
    ast.NotEq,
    ast.Lt,
    ast.LtE,
    ast.Gt,
    ast.GtE,
    ast.In,
    ast.NotIn,
    ast.Call,
    ast.Name,
    ast.Load,
    ast.Constant,
    ast.List,
    ast.Subscript,
    ast.IfExp,
)


def _count(*values: object) -> int:
    return sum(1 for value in values if value)


def _index(values: Sequence[object], value: object) -> int:
    for n, one in enumerate(values):
        if one == value:
            return n
    return -1


_FUNCTIONS = {"count": _count, "index": _index, "len": len, "max": max, "min": min, "sum": sum}


@dataclass(frozen=True)
class Expression:
    """A checked expression; `names` are the names that it uses, without functions."""

    text: str
    code: CodeType
    names: frozenset[str]


@dataclass(frozen=True)
class Rule:
    """What is derived from the wires in every scan, in the order of the rules."""

    name: str
    kind: str
    starts: Any
    expression: Expression


@dataclass(frozen=True)
class Demand:
    """What must hold whenever `when` does, or come where `comes`. `outputs` are those that it rests on, rules
    included.
    """

    id: str
    says: str
    clauses: tuple[str, ...]
    when: Expression
    holds: Expression
    outputs: frozenset[str]
    comes: bool = False


@dataclass(frozen=True)
class Demands:
    """Rules and demands of one target; `parameters` gives types and default values on the wire."""

    inputs: Mapping[str, Signal]
    outputs: Mapping[str, Signal]
    parameters: Mapping[str, Mapping[str, Any]]
    constants: Mapping[str, Any]
    rules: tuple[Rule, ...]
    rows: tuple[Demand, ...]
    constant: tuple[str, ...] = ()
    """The inputs that the document calls constant."""
    own: Mapping[str, Any] = field(default_factory=dict)
    """Of parameters that are ours and no profile has another value of: the one value that pages speak of."""

    def speak_of(self, params: Mapping[str, Any]) -> bool:
        """Whether a page says what a program with these parameters does."""
        return all(params.get(name, value) == value for name, value in self.own.items())


def read_demands(
    table: Mapping[str, Any],
    inputs: Mapping[str, Signal],
    outputs: Mapping[str, Signal],
    parameters: Mapping[str, Mapping[str, Any]],
    place: str,
) -> Demands:
    """Check demands. Raises Unjudged naming the rule or demand and what is wrong with it."""
    try:
        constants = dict(table["constants"])
        signals = [*inputs, *outputs]
        known = {*signals, *(BEFORE + name for name in signals), *parameters, *constants, "dt_ms", "latency"}
        memory = {row["name"] for row in table["rules"] if row["kind"] == "memory"}
        rules = []
        printed = frozenset(name for name, of in outputs.items() if not of.project)
        rests_on: dict[str, frozenset[str]] = {name: frozenset((name,)) for name in outputs}
        rests_on |= {BEFORE + name: frozenset((name,)) for name in outputs}
        for row in table["rules"]:
            where = f"{place}: rule {row['name']!r}"
            if row["kind"] not in KINDS or not str(row["name"]).isidentifier() or row["name"] in known:
                raise Unjudged(f"{where}: a new name and one of the kinds {', '.join(KINDS)} expected")
            expression = _expression(row["is"], known | memory, where)
            known.add(row["name"])
            # A memory may be used before its place: then what it rests on is not known yet, and it rests on
            # all outputs that the document prints.
            early = expression.names & memory - set(rests_on)
            rests_on[row["name"]] = printed if early - {row["name"]} else _rest(expression.names, rests_on)
            rules.append(Rule(row["name"], row["kind"], row.get("starts"), expression))
        demands = []
        for row in table["demands"]:
            where = f"{place}: demand {row['id']!r}"
            if ("holds" in row) == ("comes" in row):
                raise Unjudged(f"{where}: it has either `holds` or `comes`")
            asked = "comes" if "comes" in row else "holds"
            when, holds = (_expression(row[part], known, where) for part in ("when", asked))
            rest = _rest(when.names | holds.names, rests_on)
            clauses = tuple(row["clauses"])
            demands.append(Demand(row["id"], row["says"], clauses, when, holds, rest, asked == "comes"))
        steady = tuple(table.get("constant", ()))
    except (KeyError, TypeError, AttributeError) as error:
        raise Unjudged(f"{place}: {type(error).__name__} {error}") from None
    if strange := [name for name in steady if name not in inputs]:
        raise Unjudged(f"{place}: constant: no input {strange[0]}")
    if not demands:
        raise Unjudged(f"{place}: no demand, so nothing is judged")
    return Demands(inputs, outputs, parameters, constants, tuple(rules), tuple(demands), steady)


def _rest(names: Iterable[str], rests_on: Mapping[str, frozenset[str]]) -> frozenset[str]:
    return frozenset().union(*(rests_on.get(name, frozenset()) for name in names))


def _expression(text: str, known: Iterable[str], where: str) -> Expression:
    try:
        tree = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, RecursionError) as error:
        raise Unjudged(f"{where}: {error}: {text}") from None
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    names = set()
    for node in ast.walk(tree):
        if not isinstance(node, _NODES):
            raise Unjudged(f"{where}: {type(node).__name__} is not for demands: {text}")
        if isinstance(node, ast.Call) and (node.keywords or not isinstance(node.func, ast.Name)):
            raise Unjudged(f"{where}: a call of another kind: {text}")
        if isinstance(node, ast.Constant) and type(node.value) not in (bool, int, str):
            raise Unjudged(f"{where}: a constant of another kind: {text}")
        if isinstance(node, ast.Name):
            allowed = _FUNCTIONS if id(node) in called else known
            if node.id not in allowed:
                raise Unjudged(f"{where}: unknown name {node.id!r}: {text}")
            if id(node) not in called:
                names.add(node.id)
    return Expression(text, compile(tree, where, "eval"), frozenset(names))


class Watch:
    """Follows one program through its cases. `counts` says in how many scans each demand was put to it.

    Demands that rest on an output which is not observed are in `unjudged`, and never judged.
    """

    def __init__(self, demands: Demands, latency: int = 0, unobserved: Iterable[str] = ()) -> None:
        hidden = frozenset(unobserved)
        self.demands, self.latency = demands, latency
        self.judged = tuple(prop for prop in demands.rows if not prop.outputs & hidden)
        self.unjudged = tuple(prop.id for prop in demands.rows if prop.outputs & hidden)
        self.counts = dict.fromkeys((rule.id for rule in self.judged), 0)
        self._hidden = hidden
        self._signals = {**demands.inputs, **demands.outputs}
        self._words = [name for name, of in self._signals.items() if of.type == "word"]
        self._gaps = {
            name: -1 if of.type == "mode" else ""
            for name, of in self._signals.items()
            if of.type in ("mode", "text")
        }
        self._renamed = [(name, BEFORE + name) for name in self._signals]
        self._env: dict[str, Any] = {}
        self._waited: dict[str, int] = {}
        self._asked = True
        self.reset({})

    def reset(self, params: Mapping[str, Any]) -> None:
        """Begin a case with these parameters (wire values; those left out take their defaults)."""
        env: dict[str, Any] = {"__builtins__": {}, **_FUNCTIONS, **self.demands.constants}
        env["latency"] = self.latency
        for name, row in self.demands.parameters.items():
            env[name] = params.get(name, row.get("default"))
        for name, of in self._signals.items():
            env[name] = {"word": 0, "bool": False, "mode": -1, "modes": [], "text": ""}.get(of.type, 0)
        for rule in self.demands.rules:
            if rule.kind == "memory":
                env[rule.name] = rule.starts
            elif rule.kind == "recent":
                env[rule.name] = deque(maxlen=self.latency + 1)
        self._env = env
        self._waited = {}
        self._asked = self.demands.speak_of(params)

    def scan(self, dt_ms: int, inputs: Mapping[str, Any], outputs: Mapping[str, Any]) -> Demand | None:
        """The first demand that is broken in this scan, if any. Values are those of the wire.

        A program whose parameters no page speaks of breaks none.
        """
        if not self._asked:
            return None
        env = self._env
        for name, before in self._renamed:
            env[before] = env[name]
        env.update(inputs)
        if self._hidden:
            env.update((name, value) for name, value in outputs.items() if name not in self._hidden)
        else:
            env.update(outputs)
        env["dt_ms"] = dt_ms
        for name in self._words:
            value = env[name]
            if type(value) is str:
                env[name] = int(value, 16)
        for name, gap in self._gaps.items():
            if env[name] is None:
                env[name] = gap
        name, broken = "", None
        try:
            for rule in self.demands.rules:
                name = rule.name
                value = eval(rule.expression.code, env)
                if rule.kind == "recent":
                    env[name].append(value)
                else:
                    env[name] = value
            for one in self.judged:
                name = one.id
                if not eval(one.when.code, env):
                    self._waited.pop(name, None)
                    continue
                self.counts[name] += 1
                if eval(one.holds.code, env):
                    self._waited.pop(name, None)
                elif one.comes and self._waited.get(name, 0) < self.latency:
                    self._waited[name] = self._waited.get(name, 0) + 1
                elif broken is None:
                    broken = one
        except (TypeError, ValueError, IndexError, KeyError, ArithmeticError) as error:
            raise Unjudged(f"demands: {name}: {type(error).__name__} {error}") from None
        return broken

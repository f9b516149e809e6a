"""Actions of a POU: parts of its body that are apart and are called by their names, without arguments.

A call is replaced by the body of the action. An action that is not called does nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

from programs.language.calls import inner_bodies
from programs.language.tree import Body, Call, Case, For, If, Leave, Loop, Name, Place, Return, Statement

MOST = 1000
"""Calls of actions in one body."""


@dataclass
class Actions:
    """The actions of one unit by their names in upper case; each is read when it is called."""

    bodies: dict[str, Callable[[], Body]]
    calls: int = 0

    def inlined(self, body: Body, above: tuple[str, ...] = ()) -> Body:
        """The body with the actions that it calls. Raises Unjudged: an action that is not supported."""
        return tuple(found for statement in body for found in self._inlined(statement, above))

    def _inlined(self, statement: Statement, above: tuple[str, ...]) -> Iterable[Statement]:
        match statement:
            case Call(Name(name, place), _, _, _) if name.upper() in self.bodies:
                return self._called(statement, name.upper(), place, above)
            case If(branches, otherwise, _):
                inner = tuple((asked, self.inlined(part, above)) for asked, part in branches)
                return (replace(statement, branches=inner, otherwise=self.inlined(otherwise, above)),)
            case Case(_, clauses, otherwise, _):
                parts = tuple((ranges, self.inlined(part, above)) for ranges, part in clauses)
                return (replace(statement, clauses=parts, otherwise=self.inlined(otherwise, above)),)
            case For() | Loop():
                return (replace(statement, body=self.inlined(statement.body, above)),)
        return (statement,)

    def _called(self, call: Call, name: str, place: Place, above: tuple[str, ...]) -> Body:
        self.calls += 1
        if call.inputs or call.outputs:
            raise place.refuse(f"{name} is an action: it has no arguments")
        if name in above:
            raise place.refuse(f"{' calls '.join((*above, name))}: an action must not call itself")
        if self.calls > MOST:
            raise place.refuse(f"more than {MOST:,} calls of actions")
        body = self.bodies[name]()
        for leaving in _leaving(body):
            raise leaving.refuse(f"RETURN or EXIT that ends the action {name} is not supported: use IF")
        return self.inlined(body, (*above, name))


def _leaving(body: Body, looped: bool = False) -> Iterator[Place]:
    """Where a body is left before its end; looped: within a loop of its own."""
    for statement in body:
        if isinstance(statement, Return) or (isinstance(statement, Leave) and not looped):
            yield statement.place
        for inner in inner_bodies(statement):
            yield from _leaving(inner, looped or isinstance(statement, For | Loop))

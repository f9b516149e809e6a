"""A module of the shipped code: its text, its syntax tree, and what can be named in it."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass, field

from modeproof.strength.mutant import cut
from modeproof.tlc.parse_tree import Place


@dataclass
class Module:
    """A module's text and syntax tree."""

    name: str
    text: str
    tree: ast.Module = field(init=False)
    lines: list[str] = field(init=False)

    def __post_init__(self) -> None:
        self.tree = ast.parse(self.text)
        self.lines = self.text.splitlines()

    def at(self, first: ast.AST, last: ast.AST) -> Place:
        """The place from the beginning of one node to the end of another."""
        start = self._column(first.lineno, first.col_offset)  # type: ignore[attr-defined]
        end = self._column(last.end_lineno, last.end_col_offset)  # type: ignore[attr-defined]
        return Place(self.name, first.lineno, start + 1, last.end_lineno, end)  # type: ignore[attr-defined]

    def _column(self, line: int, offset: int) -> int:
        return len(self.lines[line - 1].encode("utf-8")[:offset].decode("utf-8"))

    def source(self, first: ast.AST, last: ast.AST | None = None) -> str:
        """The text of a node, or of all from one to another."""
        return cut(self.lines, self.at(first, last or first))

    @property
    def functions(self) -> dict[str, ast.FunctionDef]:
        """The functions of the module by name."""
        return {
            statement.name: statement
            for statement in self.tree.body
            if isinstance(statement, ast.FunctionDef)
        }

    @property
    def classes(self) -> dict[str, tuple[str, ...]]:
        """The classes of the module and the names that each declares or assigns, in order."""
        found: dict[str, tuple[str, ...]] = {}
        for statement in self.tree.body:
            if isinstance(statement, ast.ClassDef):
                names = [
                    target.id
                    for part in statement.body
                    for target in _targets(part)
                    if isinstance(target, ast.Name)
                ]
                found[statement.name] = tuple(names)
        return found

    @property
    def constants(self) -> dict[str, ast.expr]:
        """What the module assigns to a name once, and not inside a function."""
        found: dict[str, ast.expr] = {}
        for statement in self.tree.body:
            if (
                isinstance(statement, ast.Assign)
                and len(statement.targets) == 1
                and isinstance(statement.targets[0], ast.Name)
            ):
                found[statement.targets[0].id] = statement.value
        return found

    @property
    def names(self) -> frozenset[str]:
        """Everything that a function of the module can name."""
        imported = [
            alias.asname or alias.name
            for statement in self.tree.body
            if isinstance(statement, (ast.Import, ast.ImportFrom))
            for alias in statement.names
        ]
        return frozenset([*imported, *self.functions, *self.classes, *self.constants])


def _targets(part: ast.stmt) -> Sequence[ast.expr]:
    if isinstance(part, ast.AnnAssign):
        return [part.target]
    return part.targets if isinstance(part, ast.Assign) else []

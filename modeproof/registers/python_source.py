"""Reads Python modules as syntax trees: definitions with their comments, classes, fields, theorems, imports.

Nothing is imported or run, so a register can be judged even when the code cannot be loaded.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_text, shown

Take = Callable[[int, int], list[str]]


@dataclass(frozen=True)
class PythonDefinition:
    """A function, class or named constant of a module. `kind` is one of function, method, class, constant."""

    name: str
    kind: str
    line: int
    comment: str


@dataclass(frozen=True)
class PythonTheorem:
    """A function with the decorator `theorem`, with the ids that the decorator lists."""

    name: str
    line: int
    sentence: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    properties: tuple[str, ...] = ()
    responses: tuple[str, ...] = ()


@dataclass(frozen=True)
class PythonModule:
    """One module. `stray` is its docstring and all comments that belong to no definition."""

    name: str
    file: str
    definitions: tuple[PythonDefinition, ...]
    theorems: tuple[PythonTheorem, ...]
    tree: ast.Module
    stray: str


def read_python(root: Path, folder: Path) -> tuple[PythonModule, ...]:
    """The modules directly in a folder, in alphabetical order. Raises Unjudged when one is not Python."""
    return tuple(
        scan_python(read_text(root, path), path.stem, shown(root, path))
        for path in sorted(folder.glob("*.py"))
    )


def scan_python(text: str, name: str, file: str) -> PythonModule:
    """Read one module. Raises Unjudged with the line when it is not Python."""
    try:
        tree = ast.parse(text)
    except SyntaxError as error:
        raise Unjudged(f"{file}: line {error.lineno}: not valid Python: {error.msg}") from None
    comments = _comments(text)
    own_lines = {line for line, (_, alone) in comments.items() if alone}
    definitions: list[PythonDefinition] = []
    used: set[int] = set()

    def take(first: int, last: int) -> list[str]:
        """The comments of these lines and of the comment lines directly before them."""
        while first - 1 in own_lines:
            first -= 1
        lines = [line for line in range(first, last + 1) if line in comments and line not in used]
        used.update(lines)
        return [comments[line][0] for line in lines]

    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            definitions.append(_function(node, node.name, "function", take))
        elif isinstance(node, ast.ClassDef):
            methods = [
                statement
                for statement in node.body
                if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef)
            ]
            for method in methods:
                definitions.append(_function(method, f"{node.name}.{method.name}", "method", take))
            strings = [
                statement.value.value
                for statement in node.body
                if isinstance(statement, ast.Expr)
                and isinstance(statement.value, ast.Constant)
                and isinstance(statement.value.value, str)
            ]
            text_of_class = [*strings, *take(_first_line(node), node.end_lineno or node.lineno)]
            definitions.append(PythonDefinition(node.name, "class", node.lineno, "\n".join(text_of_class)))
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            label = next((target.id for target in targets if isinstance(target, ast.Name)), "")
            if label:
                lines = take(node.lineno, node.end_lineno or node.lineno)
                definitions.append(PythonDefinition(label, "constant", node.lineno, "\n".join(lines)))
    theorems = [
        found
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and (found := _theorem(node, file)) is not None
    ]
    stray = [
        ast.get_docstring(tree) or "",
        *(words for line, (words, _) in comments.items() if line not in used),
    ]
    return PythonModule(
        name=name,
        file=file,
        definitions=tuple(sorted(definitions, key=lambda definition: definition.line)),
        theorems=tuple(theorems),
        tree=tree,
        stray="\n".join(stray),
    )


def _comments(text: str) -> dict[int, tuple[str, bool]]:
    """Comments by line, each with whether it is alone on its line."""
    found: dict[int, tuple[str, bool]] = {}
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            found[token.start[0]] = (token.string, not token.line[: token.start[1]].strip())
    return found


def _first_line(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> int:
    return min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])


def _function(
    node: ast.FunctionDef | ast.AsyncFunctionDef, name: str, kind: str, take: Take
) -> PythonDefinition:
    words = [ast.get_docstring(node) or "", *take(_first_line(node), node.end_lineno or node.lineno)]
    return PythonDefinition(name, kind, node.lineno, "\n".join(words))


def _theorem(node: ast.FunctionDef, file: str) -> PythonTheorem | None:
    for decorator in node.decorator_list:
        if not isinstance(decorator, ast.Call):
            continue
        target = decorator.func
        label = target.id if isinstance(target, ast.Name) else getattr(target, "attr", "")
        if label != "theorem":
            continue
        keywords = {keyword.arg: keyword.value for keyword in decorator.keywords if keyword.arg}
        document = (ast.get_docstring(node) or "").strip().split("\n\n")[0]
        return PythonTheorem(
            name=node.name,
            line=node.lineno,
            sentence=" ".join(document.split()),
            clauses=_literal(keywords.get("clauses"), f"{file}: line {node.lineno}: {node.name}: clauses"),
            findings=_literal(keywords.get("findings"), f"{file}: line {node.lineno}: {node.name}: findings"),
            properties=_literal(
                keywords.get("properties"), f"{file}: line {node.lineno}: {node.name}: properties"
            ),
            responses=_literal(
                keywords.get("responses"), f"{file}: line {node.lineno}: {node.name}: responses"
            ),
        )
    return None


def _literal(node: ast.expr | None, place: str) -> tuple[str, ...]:
    """A literal list of texts. Raises Unjudged for anything that would need to be run."""
    if node is None:
        return ()
    try:
        value = ast.literal_eval(node)
    except ValueError:
        raise Unjudged(
            f"{place} must be a literal list of ids, so that it can be read without running the code"
        ) from None
    if not isinstance(value, list | tuple) or not all(isinstance(entry, str) for entry in value):
        raise Unjudged(f"{place} must be a list of texts")
    return tuple(value)

"""Signals of a wiring: TRUE, FALSE, names, output pins of blocks, AND, OR, NOT and brackets.

Written separately from the reader of programs/, with Python's own parser: the two are compared.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from typing import Any

from refimpl.errors import ParameterError

Value = bool | int
Values = Mapping[str, Value]
Signal = Callable[[Values], Value]
"""What a signal shows, given the inputs and the output pins (`guard.Ready`) of this moment."""

_WORDS = {"AND": "and", "OR": "or", "NOT": "not", "TRUE": "True", "FALSE": "False"}


def signal(text: str, named: Mapping[str, str]) -> Signal:
    """The signal of a text. ``named`` are the texts of the signals with a name.

    Raises ParameterError for what is no such text, and for a signal that reads itself.
    """
    found: Signal = _function(_made(text, named, ()))
    return found


def signals(texts: Mapping[str, str], named: Mapping[str, str]) -> Callable[[Values], dict[str, Value]]:
    """What the signals of several texts show, all at once, by their names. Raises ParameterError."""
    names: list[ast.expr | None] = [ast.Constant(name) for name in texts]
    found: Callable[[Values], dict[str, Value]] = _function(
        ast.Dict(names, [_made(text, named, ()) for text in texts.values()])
    )
    return found


def _function(body: ast.expr) -> Any:
    values = ast.arguments([], [ast.arg("values")], None, [], [], None, [])
    made = ast.fix_missing_locations(ast.Expression(ast.Lambda(values, body)))
    return eval(compile(made, "<signal>", "eval"), {})  # of nodes that `_of` has let through


def _made(text: str, named: Mapping[str, str], above: tuple[str, ...]) -> ast.expr:
    plain = re.sub(r"[A-Za-z_]\w*", lambda word: _WORDS.get(word[0].upper(), word[0]), text)
    try:
        node = ast.parse(plain.strip(), mode="eval").body
    except SyntaxError:
        raise ParameterError("signal", text, "TRUE, FALSE, names, AND, OR, NOT and brackets") from None
    return _of(node, text, named, above)


def _of(node: ast.expr, text: str, named: Mapping[str, str], above: tuple[str, ...]) -> ast.expr:
    """The same with each name as what ``values`` has under it; nothing else of Python is let through."""
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        return node
    if isinstance(node, ast.Name):
        if node.id in above:
            raise ParameterError("signal", node.id, "no loop without memory")
        if node.id in named:
            return _made(named[node.id], named, (*above, node.id))
        return _shown(node.id)
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        return _shown(f"{node.value.id}.{node.attr}")
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return ast.UnaryOp(ast.Not(), _of(node.operand, text, named, above))
    if isinstance(node, ast.BoolOp):
        return ast.BoolOp(node.op, [_of(part, text, named, above) for part in node.values])
    raise ParameterError("signal", text, "TRUE, FALSE, names, AND, OR, NOT and brackets")


def _shown(name: str) -> ast.expr:
    return ast.Subscript(ast.Name("values", ast.Load()), ast.Constant(name), ast.Load())

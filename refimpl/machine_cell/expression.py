"""Signals of a wiring: TRUE, FALSE, names, output pins of blocks, AND, OR, NOT and brackets.

Written separately from the reader of programs/, with Python's own parser: the two are compared.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping

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
    return _made(text, named, ())


def _made(text: str, named: Mapping[str, str], above: tuple[str, ...]) -> Signal:
    plain = re.sub(r"[A-Za-z_]\w*", lambda word: _WORDS.get(word[0].upper(), word[0]), text)
    try:
        node = ast.parse(plain.strip(), mode="eval").body
    except SyntaxError:
        raise ParameterError("signal", text, "TRUE, FALSE, names, AND, OR, NOT and brackets") from None
    return _of(node, text, named, above)


def _of(node: ast.expr, text: str, named: Mapping[str, str], above: tuple[str, ...]) -> Signal:
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        constant = node.value
        return lambda values: constant
    if isinstance(node, ast.Name):
        name = node.id
        if name in above:
            raise ParameterError("signal", name, "no loop without memory")
        if name in named:
            return _made(named[name], named, (*above, name))
        return lambda values: values[name]
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        pin = f"{node.value.id}.{node.attr}"
        return lambda values: values[pin]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        operand = _of(node.operand, text, named, above)
        return lambda values: not operand(values)
    if isinstance(node, ast.BoolOp):
        parts = [_of(part, text, named, above) for part in node.values]
        if isinstance(node.op, ast.And):
            return lambda values: all(part(values) for part in parts)
        return lambda values: any(part(values) for part in parts)
    raise ParameterError("signal", text, "TRUE, FALSE, names, AND, OR, NOT and brackets")

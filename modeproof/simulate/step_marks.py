"""Functions of a reference implementation in which each marked line reports the step that it takes.

The source marks it with a comment, `return ...  # StepName` (or an assignment). The copy holds `step` and
what leads from it to a mark, and no other function; it is executed beside the code itself and never in its
place.
"""

from __future__ import annotations

import ast
import re
import tokenize
from collections.abc import Iterable
from io import StringIO

from modeproof.simulate.program.device import TOOK

_NAMES = re.compile(r"#\s*([A-Za-z]\w*(?:, [A-Z]\w*)*)")


def labelled(source: str, steps: Iterable[str]) -> tuple[str, frozenset[str]]:
    """The copy's text, and the steps that it can report.

    Of two steps on one line the first is taken where the state changes, the second where it stays. A step
    that stands on a line alone is that of the marks below it in the function.
    """
    known = frozenset(steps)
    marks: dict[int, tuple[str, ...]] = {}
    alone: dict[int, tuple[str, ...]] = {}
    for token in tokenize.generate_tokens(StringIO(source).readline):
        found = _NAMES.match(token.string) if token.type == tokenize.COMMENT else None
        names = tuple(name for name in found.group(1).split(", ") if name in known) if found else ()
        if names:
            (marks if token.line[: token.start[1]].strip() else alone)[token.start[0]] = names
    functions = {node.name: node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)}
    marked: set[str] = set()
    reported: set[str] = set()
    for name, function in functions.items():
        for node in ast.walk(function):
            if isinstance(node, ast.Return | ast.Assign) and node.value is not None:
                above = [line for line in alone if function.lineno < line < node.lineno]
                taken = marks.get(node.end_lineno or 0)
                if taken is None and above and isinstance(node, ast.Return):
                    taken = alone[max(above)]
                if taken is not None:
                    given: list[ast.expr] = [ast.Tuple([ast.Constant(step) for step in taken]), node.value]
                    node.value = ast.Call(ast.Name(TOOK), given, [])
                    marked.add(name)
                    reported |= {*taken}
    leads = _leading(functions, marked)
    kept = [_bare(functions[name]) for name in functions if name in leads]
    return ast.unparse(ast.fix_missing_locations(ast.Module(kept, []))), frozenset(reported)


def _leading(functions: dict[str, ast.FunctionDef], marked: set[str]) -> set[str]:
    """The functions from which a mark can be reached."""
    named = {
        name: {node.id for node in ast.walk(function) if isinstance(node, ast.Name)} & set(functions)
        for name, function in functions.items()
    }
    leads = set(marked)
    while more := {name for name, uses in named.items() if name not in leads and uses & leads}:
        leads |= more
    return leads


def _bare(function: ast.FunctionDef) -> ast.stmt:
    """Without its docstring and annotations."""
    if isinstance(function.body[0], ast.Expr) and isinstance(function.body[0].value, ast.Constant):
        del function.body[0]
    function.returns = None
    for argument in function.args.args:
        argument.annotation = None
    return function

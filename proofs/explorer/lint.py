"""Refuses what no symbolic value can notice, in everything that a function reaches.

The proxies raise when the code asks too much of them, but Python never asks them about `is`, `isinstance`,
`type(x)` or `match` on None, True and False, and a path that depends on the past looks like any other. So the
source of every function that is called, followed through the modules of the same top package, is read, and
only a plain language is let through: constants, local names, comparisons, `and`/`or`/`not`, `if`, loops,
`return`, `raise`, frozen dataclasses, enums. Each fault is one line: file:line, what, why, what to write.
"""

from __future__ import annotations

import ast
import builtins
import dataclasses
import hashlib
import inspect
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from types import FunctionType, ModuleType
from typing import Any, Final

from proofs.explorer.errors import LintError

BUILTINS: Final = frozenset({"all", "any", "bool", "enumerate", "len", "max", "min", "range", "tuple", "zip"})
"""They only iterate and compare, so a symbolic value decides or refuses there by itself."""
CONSTANTS: Final = (bool, int, str, type(None), Enum)
ADVICE: Final = {
    "isinstance": "it is False for every symbolic value; check types when Inputs is built",
    "issubclass": "types are no input; check them when Inputs is built",
    "type": "a symbolic value has another type; check types when Inputs is built",
    "id": "two equal values have different ids; compare with ==",
    "hash": "equal symbolic values have no common hash; compare with ==",
    "dict": "a look-up hashes; write one comparison for each key",
    "set": "a look-up hashes; write one comparison for each member",
    "frozenset": "a look-up hashes; write one comparison for each member",
    "float": "floats round; count in whole milliseconds",
    "int": "it would need the value; keep the value as it is",
    "getattr": "what it reads cannot be followed; write the attribute",
    "setattr": "step must not change anything; build a new record",
    "print": "step must not write anything",
    "open": "step must not read or write files",
}
NODES: Final = {
    ast.Try: ("try", "it could swallow a refusal; check before, and let errors end the scan"),
    ast.TryStar: ("try", "it could swallow a refusal; check before, and let errors end the scan"),
    ast.With: ("with", "it can swallow errors and keep state; call functions instead"),
    ast.Global: ("global", "step must depend on its arguments alone; pass it in State"),
    ast.Nonlocal: ("nonlocal", "step must depend on its arguments alone; pass it in State"),
    ast.Delete: ("del", "nothing that step reads may change; leave it out"),
    ast.Import: ("import", "imports belong at the top of the module"),
    ast.ImportFrom: ("import", "imports belong at the top of the module"),
    ast.Lambda: ("lambda", "calls of it cannot be followed; write a function of the module"),
    ast.FunctionDef: ("a nested function", "calls of it cannot be followed; write a function of the module"),
    ast.AsyncFunctionDef: ("async", "step must not wait; write a plain function"),
    ast.ClassDef: ("a nested class", "write it in the module"),
    ast.Yield: ("yield", "a generator keeps state between calls; return a value"),
    ast.YieldFrom: ("yield", "a generator keeps state between calls; return a value"),
    ast.Await: ("await", "step must not wait; write a plain function"),
    ast.Dict: ("a dictionary", "a look-up hashes the value; write one comparison for each key"),
    ast.Set: ("a set", "a look-up hashes the value; write one comparison for each member"),
    ast.DictComp: ("a dictionary", "a look-up hashes the value; write one comparison for each key"),
    ast.SetComp: ("a set", "a look-up hashes the value; write one comparison for each member"),
    ast.List: ("a list", "it can change; write a tuple"),
    ast.ListComp: ("a list", "it can change; write a tuple"),
    ast.JoinedStr: ("an f-string", "it would need the value; texts are for error messages alone"),
    ast.Is: ("is", "no symbolic value can notice it; compare with =="),
    ast.IsNot: ("is not", "no symbolic value can notice it; compare with !="),
    ast.In: ("in", "it looks up or compares by identity first; write one comparison with == for each member"),
    ast.NotIn: ("not in", "it looks up or compares by identity first; write one comparison with != for each"),
    ast.Div: ("/", "floats round; use whole numbers, + and -"),
    ast.MatchSingleton: ("match on None, True or False", "it is `is` in disguise; compare with =="),
    ast.MatchClass: ("match on a class", "it is `isinstance` in disguise; compare with =="),
    ast.MatchMapping: ("match on a dictionary", "it looks up; write one comparison for each key"),
    ast.MatchSequence: ("match on a sequence", "it looks at the type; unpack into names instead"),
}
"""What is refused wherever it stands: how it is called, why and what to write."""
PLAIN: Final = (
    *(
        ast.Return,
        ast.Assign,
        ast.AnnAssign,
        ast.AugAssign,
        ast.If,
        ast.For,
        ast.While,
        ast.Break,
        ast.Continue,
    ),
    *(ast.Pass, ast.Assert, ast.Expr, ast.Match, ast.match_case, ast.MatchValue, ast.MatchOr, ast.MatchAs),
    *(ast.BoolOp, ast.UnaryOp, ast.Compare, ast.IfExp, ast.BinOp, ast.Constant, ast.Name, ast.Attribute),
    *(ast.Subscript, ast.Slice, ast.Tuple, ast.Starred, ast.Call, ast.keyword, ast.NamedExpr),
    *(ast.GeneratorExp, ast.comprehension),
)


@dataclass(frozen=True, order=True)
class Fault:
    """One place that the explorer cannot take."""

    file: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


@dataclass(frozen=True)
class Reach:
    """Every function that a function calls, itself first; the faults in them; what all of it depends on."""

    functions: tuple[FunctionType, ...]
    faults: tuple[Fault, ...]
    stand_ins: tuple[str, ...]
    """Functions that were not followed, for something stands in for them."""
    fingerprint: str
    """Changes with the code of any function and the value of any constant."""

    def refuse_faults(self) -> None:
        """Raise LintError with one line a fault."""
        if self.faults:
            raise LintError("\n".join(str(fault) for fault in self.faults))


def reach_of(function: Callable[..., Any], stand_ins: Iterable[str] = ()) -> Reach:
    """Everything reachable from `function`, linted. stand_ins: names of functions that are not followed."""
    return _Reading(frozenset(stand_ins)).read(function)


class _Reading:
    """The walk over functions still to be read."""

    def __init__(self, stand_ins: frozenset[str]) -> None:
        self.stand_ins = stand_ins
        self.stood_in: set[str] = set()
        self.faults: set[Fault] = set()
        self.functions: dict[FunctionType, None] = {}
        self.waiting: list[FunctionType] = []
        self.constants: dict[str, str] = {}
        self.package = ""
        self.rebound: dict[str, frozenset[str]] = {}
        self.known_methods: dict[str, list[FunctionType]] = {}

    def read(self, function: Callable[..., Any]) -> Reach:
        if not isinstance(function, FunctionType):
            raise LintError(f"{function!r} is no function with a source; give a function of a module")
        self.package = function.__module__.split(".")[0]
        self.follow(function)
        while self.waiting:
            _Function(self, self.waiting.pop()).lint()
        return Reach(
            tuple(self.functions),
            tuple(sorted(self.faults)),
            tuple(sorted(self.stood_in)),
            self._fingerprint(),
        )

    def follow(self, function: FunctionType) -> None:
        if function not in self.functions:
            self.functions[function] = None
            self.waiting.append(function)

    def follow_class(self, record: type) -> str:
        """Follow the code that builds a record. Returns the empty text, or why it cannot be followed."""
        if issubclass(record, Enum):
            return "it looks the member up; write one comparison for each member"
        if type(record) is not type:
            return "its metaclass cannot be followed; use a plain dataclass"
        for base in record.__mro__[:-1]:
            parameters = vars(base).get("__dataclass_params__")
            if parameters is None or not parameters.frozen:
                return f"{base.__name__} is no frozen dataclass, so it can change; freeze it"
            for name, value in vars(base).items():
                function = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
                if not (name.startswith("__") and callable(function)) or _made_by_dataclass(function):
                    continue
                if name == "__post_init__" and isinstance(function, FunctionType):
                    self.follow(function)
                elif name not in ("__repr__", "__str__"):
                    return f"it defines {name}, which cannot be followed; use a plain dataclass"
        for field in dataclasses.fields(record):  # type: ignore[arg-type]
            if field.default_factory is not dataclasses.MISSING:
                return f"the default of {field.name} is made anew by a call; write a constant"
            if field.default is not dataclasses.MISSING and _changeable(field.default):
                return f"the default of {field.name} can change; write a constant"
        return ""

    def methods(self, name: str) -> list[FunctionType]:
        """Every method and property of that name in all classes of the package that are loaded."""
        if name not in self.known_methods:
            spaces = [
                vars(module) for key, module in sys.modules.items() if key.split(".")[0] == self.package
            ]
            found: dict[FunctionType, None] = {}
            for value in [value for space in spaces for value in space.values()]:
                if isinstance(value, type) and value.__module__.split(".")[0] == self.package:
                    member = vars(value).get(name)
                    member = member.fget if isinstance(member, property) else member
                    if isinstance(member, FunctionType):
                        found[member] = None
            self.known_methods[name] = list(found)
        return self.known_methods[name]

    def rebound_names(self, module: ModuleType) -> frozenset[str]:
        """Names of the module that are assigned more than once, or by `global` in a function."""
        if module.__name__ not in self.rebound:
            tree = ast.parse(inspect.getsource(module))
            names = [node.id for node in _outside_functions(tree) if _stores(node)]
            twice = {name for name in names if names.count(name) > 1}
            said = {name for node in ast.walk(tree) if isinstance(node, ast.Global) for name in node.names}
            self.rebound[module.__name__] = frozenset(twice | said)
        return self.rebound[module.__name__]

    def _fingerprint(self) -> str:
        text = [repr(sorted(self.constants.items()))]
        for function in sorted(
            self.functions, key=lambda function: (function.__module__, function.__qualname__)
        ):
            name = f"{function.__module__}.{function.__qualname__}"
            text.append(f"{name} {function.__defaults__!r} {_code(function.__code__)}")
        return hashlib.sha256("\n".join(text).encode()).hexdigest()


def _code(code: Any) -> str:
    """What a code object does and where its lines are."""
    constants = [
        _code(constant) if hasattr(constant, "co_code") else repr(constant) for constant in code.co_consts
    ]
    return f"{code.co_code.hex()} {constants} {code.co_names} {code.co_varnames} {code.co_firstlineno}"


def _outside_functions(node: ast.AST) -> Iterator[ast.Name]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Name):
            yield child
        elif not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda)):
            yield from _outside_functions(child)


def _stores(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)


class _Function:
    """One function being read."""

    def __init__(self, reading: _Reading, function: FunctionType) -> None:
        self.reading = reading
        self.function = function
        self.code = function.__code__
        self.module = inspect.getmodule(function)
        self.locals = frozenset(self.code.co_varnames + self.code.co_cellvars)
        self.stored: set[str] = set()

    def lint(self) -> None:
        if self.module is None:
            return self.fault(
                self.code.co_firstlineno, "its module", "it cannot be found; write it in a file"
            )
        if self.function.__closure__:
            names = ", ".join(self.code.co_freevars)
            return self.fault(
                self.code.co_firstlineno,
                f"the outer variable {names}",
                "it can change; pass it as an argument",
            )
        try:
            source = textwrap.dedent(inspect.getsource(self.function))
        except (OSError, TypeError):
            return self.fault(self.code.co_firstlineno, "its source", "it cannot be read; write it in a file")
        (tree,) = ast.parse(source).body
        ast.increment_lineno(tree, self.code.co_firstlineno - 1)
        if not isinstance(tree, ast.FunctionDef):
            return self.fault(tree.lineno, "a lambda or async function", "write a plain function")
        for decorator in tree.decorator_list:
            if not (isinstance(decorator, ast.Name) and decorator.id == "property"):
                self.fault(
                    decorator.lineno, "a decorator", "it may keep state, as a cache does; leave it out"
                )
        self.stored = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and _stores(node)}
        self.locals |= self.stored  # the names of a generator's loop too
        for value in (*(self.function.__defaults__ or ()), *(self.function.__kwdefaults__ or {}).values()):
            self.constant(tree.lineno, "a default value", value)
        for statement in tree.body:
            self.visit(statement)
        return None

    def fault(self, line: int, what: str, advice: str) -> None:
        file = self.code.co_filename
        where = f"in {self.function.__qualname__}"
        self.reading.faults.add(Fault(file, line, f"{what} {where}: {advice}"))

    # ---- nodes

    def visit(self, node: ast.AST) -> None:
        line = getattr(node, "lineno", self.code.co_firstlineno)
        if isinstance(node, (ast.operator, ast.cmpop, ast.boolop, ast.unaryop, ast.expr_context)):
            return None  # judged with the expression that it stands in
        if isinstance(node, ast.Raise):
            return self.raised(node)
        if isinstance(node, ast.Compare):
            for operator in node.ops:
                if type(operator) in NODES:
                    self.fault(line, *NODES[type(operator)])
        elif type(node) in NODES:
            return self.fault(line, *NODES[type(node)])
        elif not isinstance(node, PLAIN):
            return self.fault(
                line, type(node).__name__.lower(), "it is not in the language that can be followed"
            )
        if isinstance(node, (ast.Attribute, ast.Subscript)) and not isinstance(node.ctx, ast.Load):
            return self.fault(
                line, "a change of a record", "step must not change anything; build a new record"
            )
        if isinstance(node, (ast.BinOp, ast.AugAssign)) and isinstance(node.op, ast.Div):
            self.fault(line, *NODES[ast.Div])
        if isinstance(node, ast.Constant) and isinstance(node.value, (float, complex)):
            self.fault(line, f"the float {node.value}", "floats round; count in whole milliseconds")
        if isinstance(node, ast.keyword) and node.arg is None:
            self.fault(line, "**", "what it passes cannot be followed; name the arguments")
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            self.name(node)
        elif isinstance(node, ast.Call):
            return self.call(node)
        elif isinstance(node, ast.Attribute):
            return self.attribute(node)
        elif isinstance(node, ast.AnnAssign):
            return self.parts([node.target, node.value])
        elif isinstance(node, ast.GeneratorExp):
            self.fault(
                line, "a generator", "it keeps state; use it only as the one argument of any, all or tuple"
            )
        self.parts(ast.iter_child_nodes(node))
        return None

    def parts(self, nodes: Iterable[ast.AST | None]) -> None:
        for node in nodes:
            if node is not None:
                self.visit(node)

    def raised(self, node: ast.Raise) -> None:
        """A raise ends the path; what its message says does not matter, if it is built by the exception."""
        what = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        known = self.resolve(what) if what is not None else None
        if not (isinstance(known, type) and issubclass(known, Exception)):
            self.fault(node.lineno, "raise", "name the exception's class there, so that it can be followed")
        if isinstance(node.exc, ast.Call):
            self.spoken([*node.exc.args, *[keyword.value for keyword in node.exc.keywords]])

    def spoken(self, message: Iterable[ast.expr]) -> None:
        """A message may show any value. It must not call or assign anything, because that would go unseen."""
        for expression in [inner for part in message for inner in ast.walk(part)]:
            if isinstance(expression, (ast.Call, ast.NamedExpr, ast.Await, ast.Yield, ast.YieldFrom)):
                self.fault(
                    expression.lineno, "a call in a message", "it cannot be followed; show the value itself"
                )

    def name(self, node: ast.Name) -> None:
        if node.id not in self.locals:
            self.constant(node.lineno, f"the global {node.id}", self.resolve(node))
            if self.module is not None and node.id in self.reading.rebound_names(self.module):
                self.fault(
                    node.lineno,
                    f"the global {node.id}",
                    "it is assigned more than once; pass it as an argument",
                )

    def constant(self, line: int, what: str, value: object) -> None:
        if callable(value) or isinstance(value, ModuleType):
            advice = "it is used as a value, so that calls of it cannot be followed; call it by its name"
            self.fault(line, what, advice)
        elif _changeable(value):
            self.fault(line, what, f"a {type(value).__name__} can change; write a tuple of constants")
        elif isinstance(value, Enum) and (name := _own_comparison(type(value))):
            self.fault(line, what, f"its class defines {name}, which cannot be followed; use a plain Enum")
        else:
            self.reading.constants[f"{self.function.__module__} {what}"] = repr(value)

    def attribute(self, node: ast.Attribute) -> None:
        known = self.resolve(node)
        if known is not _UNKNOWN:
            if isinstance(self.resolve(node.value), ModuleType):
                module = self.resolve(node.value)
                self.constant(node.lineno, f"the global {node.attr}", known)
                if node.attr in self.reading.rebound_names(module):
                    self.fault(
                        node.lineno, f"the global {node.attr}", "it is assigned more than once; pass it"
                    )
            elif _changeable(known):
                self.fault(node.lineno, f"the attribute {node.attr}", "it can change; write a constant")
            else:
                self.constant(node.lineno, ast.unparse(node), known)
            return
        if node.attr.startswith("__"):
            self.fault(node.lineno, node.attr, "what it gives cannot be followed; use the fields alone")
        for method in self.reading.methods(node.attr):
            self.reading.follow(method)
        self.visit(node.value)

    def call(self, node: ast.Call) -> None:
        called = self.resolve(node.func)
        line, name = node.lineno, ast.unparse(node.func)
        generators = [argument for argument in node.args if isinstance(argument, ast.GeneratorExp)]
        if isinstance(node.func, ast.Name) and node.func.id in self.locals:
            self.fault(line, f"the call of {name}", "it cannot be followed; call a function of the module")
        elif isinstance(called, FunctionType) and called.__name__ in self.reading.stand_ins:
            self.reading.stood_in.add(called.__name__)
        elif called is dataclasses.replace:
            self.replaced(node)
        elif isinstance(called, FunctionType) and called.__module__.split(".")[0] == self.reading.package:
            self.reading.follow(called)
        elif isinstance(called, type) and called.__module__.split(".")[0] == self.reading.package:
            why = self.reading.follow_class(called)
            if why:
                self.fault(line, f"the call of {name}", why)
        elif called is not _UNKNOWN and called is vars(builtins).get(name):
            if name not in BUILTINS:
                self.fault(line, f"the call of {name}", ADVICE.get(name, "it is none that can be followed"))
        elif called is _UNKNOWN and isinstance(node.func, ast.Attribute):
            self.method(node.func)
        else:
            self.fault(
                line, f"the call of {name}", "it cannot be followed; call functions of the same package"
            )
        for generator in generators:
            if len(node.args) == 1 and name in ("all", "any", "tuple", "min", "max"):
                self.parts(ast.iter_child_nodes(generator))
            else:
                self.visit(generator)
        self.parts([*(argument for argument in node.args if argument not in generators), *node.keywords])

    def replaced(self, node: ast.Call) -> None:
        """dataclasses.replace builds a record of the class that an annotation names, else of any class."""
        record = self.annotated(node.args[0]) if node.args else _UNKNOWN
        if not isinstance(record, type):
            for method in self.reading.methods("__post_init__"):
                self.reading.follow(method)
        elif why := self.reading.follow_class(record):
            self.fault(node.lineno, f"the record {record.__name__} replaced", why)

    def annotated(self, node: ast.AST) -> Any:
        """What mypy holds a value to: a parameter that keeps its value, or what a function returns."""
        function, name = self.function, "return"
        if isinstance(node, ast.Name) and node.id not in self.stored:
            name = node.id
        elif isinstance(node, ast.Call) and isinstance(self.resolve(node.func), FunctionType):
            function = self.resolve(node.func)
        else:
            return _UNKNOWN
        said = function.__annotations__.get(name, _UNKNOWN)
        return function.__globals__.get(said, _UNKNOWN) if isinstance(said, str) else said

    def method(self, node: ast.Attribute) -> None:
        """A method of a record: all methods of that name are followed."""
        methods = self.reading.methods(node.attr)
        if not methods:
            advice = "it cannot be followed; call a function of the module, or a method of its records"
            self.fault(node.lineno, f"the call of .{node.attr}", advice)
        for method in methods:
            self.reading.follow(method)
        self.visit(node.value)

    def resolve(self, node: ast.AST) -> Any:
        """What a name or dotted name means before the function runs; _UNKNOWN for what it computes."""
        if isinstance(node, ast.Name):
            if node.id in self.locals:
                return _UNKNOWN
            space = self.function.__globals__
            return space.get(node.id, vars(builtins).get(node.id, _UNKNOWN))
        if isinstance(node, ast.Attribute):
            owner = self.resolve(node.value)
            if isinstance(owner, (ModuleType, type)):
                return getattr(owner, node.attr, _UNKNOWN)
        return _UNKNOWN


_UNKNOWN: Final = object()


def _made_by_dataclass(function: object) -> bool:
    """The decorator wrote it, or it is one of its own."""
    if not isinstance(function, FunctionType):
        return False
    return function.__code__.co_filename == "<string>" or function.__module__ == "dataclasses"


def _own_comparison(kind: type) -> str:
    """Names what an Enum redefines of the comparison of its members; the empty text for a plain Enum."""
    for base in kind.__mro__[: kind.__mro__.index(Enum)]:
        for name in ("__eq__", "__ne__", "__lt__", "__le__", "__gt__", "__ge__", "__bool__"):
            if name in vars(base):
                return name
    return ""


def _changeable(value: object) -> bool:
    """Whether a global value could be another one at the next call."""
    if isinstance(value, tuple):
        return any(_changeable(part) for part in value)
    if isinstance(value, CONSTANTS):
        return False
    parameters = getattr(value, "__dataclass_params__", None)
    if parameters is None or not parameters.frozen or isinstance(value, type):
        return True
    return any(_changeable(getattr(value, field.name)) for field in dataclasses.fields(value))  # type: ignore[arg-type]

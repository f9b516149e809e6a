"""What no symbolic value can notice is refused with one line: where, what, why, what to write instead."""

import importlib
import itertools
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from proofs.explorer.errors import LintError
from proofs.explorer.lint import reach_of
from refimpl.mode_selection import eks, fplc, hmi, plc

HEAD = """
from __future__ import annotations
import time
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cache

class Step(Enum):
    IDLE = 1
    BUSY = 2

@dataclass(frozen=True)
class State:
    state: Step
    n: int
    def doubled(self):
        return self.n + self.n

@dataclass
class Loose:
    n: int

@dataclass(frozen=True)
class Checked:
    n: int
    def __post_init__(self):
        if type(self.n) is not int:
            raise ValueError("n")

@dataclass(frozen=True)
class Counted:
    n: int
    def __new__(cls, n):
        LIST.append(n)
        return super().__new__(cls)

@dataclass(frozen=True)
class Inherits(Counted):
    m: int

@dataclass(frozen=True)
class Made:
    n: int
    seen: tuple = field(default_factory=lambda: (len(LIST),))

@dataclass(frozen=True)
class Odd:
    n: int
    def __eq__(self, other):
        return len(LIST) == 1

class Strange(Enum):
    ONE = 1
    def __eq__(self, other):
        return len(LIST) == 1

def noted(n):
    LIST.append(n)
    return n

TABLE = {1: 2}
CODES = (1, 2, 3)
COUNT = 0
LIST = [1]
LATER = 1
LATER = 2

"""
NUMBERS = itertools.count()
Planted = Callable[[str], ModuleType]


@pytest.fixture
def planted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Planted:
    monkeypatch.syspath_prepend(str(tmp_path))

    def write(source: str) -> ModuleType:
        name = f"planted_{next(NUMBERS)}"
        (tmp_path / f"{name}.py").write_text(HEAD + source, encoding="utf-8")
        importlib.invalidate_caches()
        module = importlib.import_module(name)
        monkeypatch.delitem(sys.modules, name)
        monkeypatch.setitem(sys.modules, name, module)
        return module

    return write


GOOD = (
    "def step(w):\n    return 1 if w == CODES[0] else 2",
    "def step(w):\n    for code in CODES:\n        if w == code:\n            return code\n    return 0",
    "def step(w):\n    return inner(w)\ndef inner(w):\n    return any(w == c for c in CODES)",
    "def step(w):\n    return State(Step.IDLE, w)",
    "def step(w):\n    return State(Step.IDLE, w).doubled()",
    "def step(s: State):\n    return replace(s, n=1)",
    "def step(s: State):\n    return replace(one(s), n=1)\ndef one(s) -> State:\n    return s",
    "def step(w):\n    if w > 3:\n        raise ValueError(f'too large: {w!r}')\n    return w",
    "def step(w):\n    match w:\n        case 1 | 2:\n            return 1\n    return 2",
    "def step(w):\n    total = 0\n    total += w\n    assert total == w\n    return total if w > 2 else -1",
)

BAD = {
    "is None": ("def step(w):\n    return 1 if w is None else 2", "is", "compare with =="),
    "is not": ("def step(w):\n    return w is not True", "is not", "compare with !="),
    "in a tuple": ("def step(w):\n    return w in (1, 2)", "in", "one comparison with =="),
    "not in": ("def step(w):\n    return w not in CODES", "not in", "one comparison with !="),
    "match True": (
        "def step(w):\n    match w:\n        case True:\n            return 1\n    return 2",
        "match on None, True or False",
        "compare with ==",
    ),
    "match a class": (
        "def step(w):\n    match w:\n        case int():\n            return 1\n    return 2",
        "match on a class",
        "compare with ==",
    ),
    "match a sequence": (
        "def step(w):\n    match w:\n        case [a, b]:\n            return 1\n    return 2",
        "match on a sequence",
        "unpack",
    ),
    "isinstance": ("def step(w):\n    return isinstance(w, int)", "isinstance", "when Inputs is built"),
    "type": ("def step(w):\n    return type(w) == int", "the call of type", "when Inputs is built"),
    "id": ("def step(w):\n    return id(w) == 3", "the call of id", "compare with =="),
    "a dictionary of the module": ("def step(w):\n    return TABLE[w]", "the global TABLE", "tuple"),
    "a method of a dictionary": ("def step(w):\n    return TABLE.get(w)", ".get", "cannot be followed"),
    "a dictionary": ("def step(w):\n    return {1: 2}[1]", "a dictionary", "one comparison for each key"),
    "a set": ("def step(w):\n    return w == {1}", "a set", "one comparison for each member"),
    "a list": ("def step(w):\n    x = []\n    return x", "a list", "tuple"),
    "a list of the module": ("def step(w):\n    return LIST[0]", "the global LIST", "tuple"),
    "a float": ("def step(w):\n    return w == 1.5", "the float 1.5", "milliseconds"),
    "a division": ("def step(w):\n    return w / 2", "/", "whole numbers"),
    "a division in place": ("def step(w):\n    w /= 2\n    return w", "/", "whole numbers"),
    "global": (
        "def step(w):\n    global COUNT\n    COUNT = COUNT + 1\n    return COUNT",
        "global",
        "pass it in State",
    ),
    "a global that another function changes": (
        "def step(w):\n    return COUNT\ndef other():\n    global COUNT\n    COUNT = 3",
        "the global COUNT",
        "pass it as an argument",
    ),
    "a global that is assigned twice": (
        "def step(w):\n    return LATER",
        "the global LATER",
        "more than once",
    ),
    "try": (
        "def step(w):\n    try:\n        return CODES[w]\n    except TypeError:\n        return 0",
        "try",
        "swallow",
    ),
    "a changed field": ("def step(s):\n    s.n = 1\n    return s", "a change of a record", "new record"),
    "a changed item": ("def step(s):\n    s[0] = 1\n    return s", "a change of a record", "new record"),
    "a lambda": (
        "def step(w):\n    f = lambda x: x\n    return f(w)",
        "lambda in step",
        "function of the module",
    ),
    "a nested function": (
        "def step(w):\n    def f(x):\n        return x\n    return f(w)",
        "a nested function",
        "function of the module",
    ),
    "a generator": ("def step(w):\n    yield w", "yield", "keeps state"),
    "a stored generator": (
        "def step(w):\n    g = (w == c for c in CODES)\n    return any(g)",
        "a generator",
        "any, all or tuple",
    ),
    "a function as a value": (
        "def step(w):\n    f = inner\n    return f(w)\ndef inner(w):\n    return w",
        "inner",
        "by its name",
    ),
    "an argument that is called": ("def step(f):\n    return f(1)", "the call of f", "cannot be followed"),
    "a call that cannot be followed": (
        "def step(w):\n    return time.monotonic()",
        "the call of time.monotonic",
        "cannot be followed",
    ),
    "a cache": (
        "@cache\ndef step_(w):\n    return w\ndef step(w):\n    return step_(w)",
        "step_",
        "cannot be followed",
    ),
    "an f-string": ("def step(w):\n    return f'{w}'", "an f-string", "error messages"),
    "str": ("def step(w):\n    return str(w)", "the call of str", "followed"),
    "int": ("def step(w):\n    return int(w)", "the call of int", "keep the value"),
    "print": ("def step(w):\n    print(w)\n    return w", "the call of print", "must not write"),
    "an enum looked up": ("def step(w):\n    return Step(w)", "the call of Step", "one comparison"),
    "a record that can change": ("def step(w):\n    return Loose(w)", "the call of Loose", "freeze it"),
    "a record that checks types": (
        "def step(w):\n    return Checked(w)",
        "the call of type",
        "Inputs is built",
    ),
    "a record replaced that checks types": (
        "def step(s):\n    return replace(s, n=1)",
        "the call of type",
        "Inputs is built",
    ),
    "a record replaced whose class checks types": (
        "def step(s: Checked):\n    return replace(s, n=1)",
        "the call of type",
        "Inputs is built",
    ),
    "a record replaced after its name was given to another": (
        "def step(s: State):\n    s = checked(s)\n    return replace(s, n=1)\ndef checked(s):\n    return s",
        "the call of type",
        "Inputs is built",
    ),
    "a record replaced that a function without a type returns": (
        "def step(s: State):\n    return replace(checked(s), n=1)\ndef checked(s):\n    return s",
        "the call of type",
        "Inputs is built",
    ),
    "a record replaced that can change": (
        "def step(s: Loose):\n    return replace(s, n=1)",
        "the record Loose replaced",
        "freeze it",
    ),
    "a record that is made by a function of its own": (
        "def step(w):\n    return Counted(w)",
        "the call of Counted",
        "it defines __new__",
    ),
    "a record that inherits one": (
        "def step(w):\n    return Inherits(w, w)",
        "the call of Inherits",
        "it defines __new__",
    ),
    "a record with a default that is made anew": (
        "def step(w):\n    return Made(w)",
        "the call of Made",
        "the default of seen",
    ),
    "a record that compares by itself": (
        "def step(w):\n    return Odd(w) == Odd(w)",
        "the call of Odd",
        "it defines __eq__",
    ),
    "an enum that compares by itself": (
        "def step(w):\n    return 1 if w == Strange.ONE else 2",
        "Strange.ONE",
        "its class defines __eq__",
    ),
    "a message that does something": (
        "def step(w):\n    if w == 1:\n        raise ValueError(noted(w))\n    return w",
        "a call in a message",
        "show the value itself",
    ),
    "a default that can change": ("def step(w, seen=[]):\n    return w", "a default value", "tuple"),
    "an import": ("def step(w):\n    import os\n    return w", "import", "top of the module"),
    "a named exception elsewhere": ("def step(w):\n    e = w\n    raise e", "raise", "class"),
    "two calls deep": (
        "def step(w):\n    return one(w)\ndef one(w):\n    return two(w)\ndef two(w):\n    return w is None",
        "is in two",
        "compare with ==",
    ),
}


@pytest.mark.parametrize("source", GOOD)
def test_the_plain_language_is_let_through(planted: Planted, source: str) -> None:
    assert reach_of(planted(source).step).faults == ()


@pytest.mark.parametrize("name", BAD)
def test_it_is_refused_with_the_line_and_the_advice(planted: Planted, name: str) -> None:
    source, what, advice = BAD[name]
    module = planted(source)
    with pytest.raises(LintError) as caught:
        reach_of(module.step).refuse_faults()
    lines = [line for line in str(caught.value).splitlines() if what in line and advice in line]
    assert lines, str(caught.value)
    assert all(line.startswith(f"{module.__file__}:") for line in lines)
    first = HEAD.count("\n") + 1
    assert all(int(line.removeprefix(f"{module.__file__}:").split(":")[0]) > first - 60 for line in lines)


def test_a_property_of_a_class_in_another_module_is_followed(
    planted: Planted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The record comes in as an argument; the module of step does not know its class."""
    other = planted(
        "@dataclass(frozen=True)\nclass Key:\n    n: int\n    @property\n"
        "    def level(self):\n        return self.n is None"
    )
    module = planted("def step(key):\n    return key.level")
    package = module.__name__
    monkeypatch.setitem(sys.modules, f"{package}.other", other)
    monkeypatch.setattr(other.Key, "__module__", f"{package}.other")
    with pytest.raises(LintError, match=r"is in Key\.level"):
        reach_of(module.step).refuse_faults()


def test_the_line_is_the_one_in_the_file(planted: Planted) -> None:
    module = planted("def step(w):\n    x = w\n    return x is None")
    (fault,) = reach_of(module.step).faults
    assert fault.line == HEAD.count("\n") + 3


def test_a_function_with_outer_variables_is_refused() -> None:
    outer = 3

    def step(w: int) -> bool:
        return w == outer

    with pytest.raises(LintError, match="outer variable outer"):
        reach_of(step).refuse_faults()


@pytest.mark.parametrize("module", [fplc, plc, hmi])
def test_three_devices_are_written_in_the_plain_language(module: ModuleType) -> None:
    reach = reach_of(module.step)
    assert reach.faults == ()
    assert len(reach.functions) >= 6


def test_the_eks_is_too_except_for_its_secret_checksum() -> None:
    assert reach_of(eks.step, ["checksum_agrees"]).faults == ()
    assert reach_of(eks.step, ["checksum_agrees"]).stand_ins == ("checksum_agrees",)
    with pytest.raises(LintError, match="to_bytes"):
        reach_of(eks.step).refuse_faults()


def test_the_fingerprint_changes_with_a_constant_and_with_code(planted: Planted) -> None:
    source = "LIMIT = 3\ndef step(w):\n    return w == LIMIT"
    module = planted(source)
    before = reach_of(module.step).fingerprint
    assert reach_of(module.step).fingerprint == before
    module.LIMIT = 4
    assert reach_of(module.step).fingerprint != before

"""Random small programs: the explorer and the interpreter agree on every one."""

import random

import pytest
import z3

from proofs.explorer.device import no_two_paths, some_path
from proofs.explorer.explore import explore
from proofs.explorer.records import evaluated
from proofs.explorer.values import FlagProxy, NumberProxy, Proxy, WordProxy, flag, number, text, word

WORDS, FLAGS, TIMES, LEVELS, TEXTS = ("w", "v"), ("a", "b"), ("t", "u"), ("m", "n"), ("s",)
SYMBOLS = {
    **{name: word(name) for name in WORDS},
    **{name: flag(name) for name in FLAGS},
    **{name: number(name, 0) for name in TIMES},
    **{name: number(name, -1, 4) for name in LEVELS},
    **{name: text(name, ("", "yes", "no")) for name in TEXTS},
}
CODES = (0, 1, 0x00FF, 0x0F0F, 0x0FF0, 0x3333, 0xFFFF)
ORDERS = ("==", "!=", "<", "<=", ">", ">=")
PROGRAMS = 60
MEMBERS = 6


class _Writer:
    """Writes a random program in the language of the shipped functions."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def program(self) -> str:
        return "\n".join([f"def program({', '.join(SYMBOLS)}):", *self.block(3, 1), "    return 'end', a, t"])

    def block(self, depth: int, indent: int) -> list[str]:
        return [line for _ in range(self.random.randint(1, 2)) for line in self.statement(depth, indent)]

    def statement(self, depth: int, indent: int) -> list[str]:
        pick, pad = self.random.random(), "    " * indent
        if depth == 0 or pick < 0.25:
            return [f"{pad}{self.assignment()}"]
        if pick < 0.4:
            return [f"{pad}if {self.condition(1)}:", f"{pad}    return {self.result()}"]
        if pick < 0.47:
            return [f"{pad}if {self.condition(1)}:", f"{pad}    raise ValueError('planted')"]
        lines = [f"{pad}if {self.condition(2)}:", *self.block(depth - 1, indent + 1)]
        if pick > 0.6:
            lines += [f"{pad}elif {self.condition(1)}:", *self.block(depth - 1, indent + 1)]
        if pick > 0.75:
            lines += [f"{pad}else:", *self.block(depth - 1, indent + 1)]
        return lines

    def assignment(self) -> str:
        which = self.random.randint(0, 3)
        if which == 0:
            return f"{self.random.choice(TIMES)} = {self.time()}"
        if which == 1:
            return f"{self.random.choice(FLAGS)} = {self.comparison()}"
        if which == 2:
            return f"{self.random.choice(WORDS)} = {self.word()}"
        return f"{self.random.choice(LEVELS)} = {self.level()}"

    def condition(self, depth: int) -> str:
        if depth == 0 or self.random.random() < 0.4:
            one = self.random.choice((self.comparison, lambda: self.random.choice(FLAGS)))()
            return one if self.random.random() < 0.8 else f"not ({one})"
        joint = self.random.choice((" and ", " or "))
        return "(" + joint.join(self.condition(depth - 1) for _ in range(self.random.randint(2, 3))) + ")"

    def comparison(self) -> str:
        order = self.random.choice(ORDERS)
        which = self.random.randint(0, 4)
        if which == 0:
            return f"({self.time()} {order} {self.time()})"
        if which == 1:
            return f"({self.level()} {order} {self.level()})"
        if which == 2:
            return f"(s {self.random.choice(('==', '!='))} {self.random.choice(('', 'yes', 'no'))!r})"
        if which == 3:
            return f"({self.random.choice(CODES)} {order} {self.random.choice(WORDS)})"
        return f"({self.word()} {order} {self.word()})"

    def word(self) -> str:
        one = self.random.choice(WORDS)
        other = self.random.choice((*WORDS, *map(str, CODES)))
        return self.random.choice(
            (one, one, other, f"({one} & {other})", f"({other} | {one})", f"({one} ^ {other})")
        )

    def time(self) -> str:
        one = self.random.choice(TIMES)
        other = self.random.choice((*TIMES, "1", "500", "1000"))
        return self.random.choice((one, other, f"{one} + {other}", f"{other} - {one}"))

    def level(self) -> str:
        return self.random.choice((*LEVELS, "-1", "0", "3", "4"))

    def result(self) -> str:
        parts = (
            self.time(),
            self.word(),
            self.level(),
            self.comparison(),
            self.random.choice(FLAGS),
            "s",
            "7",
        )
        return ", ".join(self.random.sample(parts, self.random.randint(2, 4)))


def _function(source: str):  # type: ignore[no-untyped-def]
    space: dict[str, object] = {}
    exec(compile(source, "<random program>", "exec"), space)
    return space["program"]


def _interpreted(function, values):  # type: ignore[no-untyped-def]
    try:
        return function(**values)
    except ValueError:
        return "raised"


def _values(random_: random.Random) -> dict[str, object]:
    return {
        **{name: random_.choice((*CODES, random_.randrange(0x10000))) for name in WORDS},
        **{name: random_.random() < 0.5 for name in FLAGS},
        **{name: random_.choice((0, 1, 499, 500, 501, 999, 1000, random_.randrange(5000))) for name in TIMES},
        **{name: random_.randint(-1, 4) for name in LEVELS},
        **{name: random_.choice(("", "yes", "no")) for name in TEXTS},
    }


def _in_the_solver(values: dict[str, object]) -> z3.Solver:
    solver = z3.Solver()
    for name, value in values.items():
        symbol = SYMBOLS[name]
        solver.add(symbol.term == (symbol.values.index(value) if name in TEXTS else value))
    return solver


def _agree(seed: int) -> bool:
    """Whether explorer and interpreter say the same of a program: on a member of each path, and at random."""
    source = _Writer(seed).program()
    function = _function(source)
    found = explore(function, tuple(SYMBOLS.values()), max_paths=3000)
    for path in found.paths:
        model = path.example
        values = {name: s.python(model.eval(s.term, model_completion=True)) for name, s in SYMBOLS.items()}
        if _interpreted(function, values) != ("raised" if path.raised else evaluated(path.result, model)):
            return False
    random_ = random.Random(seed)
    for _ in range(MEMBERS):
        values = _values(random_)
        solver = _in_the_solver(values)
        assert solver.check() == z3.sat
        model = solver.model()
        applies = [p for p in found.paths if z3.is_true(model.eval(p.condition, model_completion=True))]
        if len(applies) != 1:
            return False
        path = applies[0]
        if _interpreted(function, values) != ("raised" if path.raised else evaluated(path.result, model)):
            return False
    return True


@pytest.mark.parametrize("seed", range(PROGRAMS))
def test_explorer_and_interpreter_agree_on_a_random_program(seed: int) -> None:
    assert _agree(seed), _Writer(seed).program()


PLANTS = {
    "<= of numbers is <": (NumberProxy, "__le__", NumberProxy.__lt__),
    "> of words is >=": (WordProxy, "__gt__", WordProxy.__ge__),
    "words have a sign": (WordProxy, "__lt__", lambda a, b: FlagProxy(a.term < a._number(b), a._run)),
    "+ is -": (NumberProxy, "__add__", NumberProxy.__sub__),
    "- has its sides exchanged": (NumberProxy, "__sub__", NumberProxy.__rsub__),
    "& is |": (WordProxy, "__and__", WordProxy.__or__),
    "!= is ==": (Proxy, "__ne__", Proxy.__eq__),
    "a flag decides the other way": (FlagProxy, "__bool__", lambda a: not a._run.decide(a.term)),
}


@pytest.mark.parametrize("name", PLANTS)
def test_a_fault_in_the_explorer_makes_them_disagree(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kind, method, wrong = PLANTS[name]
    monkeypatch.setattr(kind, method, wrong)
    assert not all(_agree(seed) for seed in range(PROGRAMS))


def test_the_random_programs_have_many_paths_and_some_raise() -> None:
    counts = []
    raising = 0
    for seed in range(0, PROGRAMS, 4):
        found = explore(_function(_Writer(seed).program()), tuple(SYMBOLS.values()), max_paths=3000)
        counts.append(len(found.paths))
        raising += any(path.raised for path in found.paths)
    assert max(counts) > 30
    assert sorted(counts)[len(counts) // 2] >= 4
    assert raising >= 3


@pytest.mark.parametrize("seed", range(PROGRAMS // 4))
def test_the_paths_of_a_random_program_are_exhaustive_and_disjoint(seed: int) -> None:
    found = explore(_function(_Writer(seed).program()), tuple(SYMBOLS.values()), max_paths=3000)
    conditions = [path.condition for path in found.paths]
    for claim in (some_path(conditions), no_two_paths(conditions)):
        solver = z3.Solver()
        solver.add(found.premise, z3.Not(claim))
        assert solver.check() == z3.unsat

"""Mutants of the shipped code, judged by theorems: each KILLED by one, proved EQUIVALENT, or a survivor.

What is edited in which function is a rule (python_operators.py). The room of the document in proofs/ says
which functions some step reaches, and judges (the bench); `strength.toml` in that room says what is put in
the place of a name, and why survivors survive. Each mutant is judged in a process of its own, from the text,
and no file of the code is touched.
"""

from __future__ import annotations

import ast
import time
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any, Protocol

from modeproof.errors import Unjudged
from modeproof.processes import in_forks
from modeproof.progress import Progress
from modeproof.strength.campaign import Judged, so_far
from modeproof.strength.mutant import Mutant, applied
from modeproof.strength.python_operators import Module, PythonMutant, PythonRule, python_mutants
from modeproof.strength.register import Explained, read_explained, refuse_unknown
from modeproof.strength.results import Results, digest

LIMIT_S = 600.0
"""Wall-clock time for one mutant; what takes longer is UNMEASURED."""


class Code(Protocol):
    """What the room of proofs says of the code: see proofs/mutants/bench.py."""

    def reached(self, document: str) -> Mapping[str, tuple[Path, frozenset[str]]]:
        """The modules that some step reaches: file and functions."""

    def texts(self, document: str) -> Sequence[tuple[str, ...]]:
        """The lists of texts that the devices' interfaces declare."""

    def theorems(self, document: str) -> Mapping[str, str]:
        """Every theorem that judges, in order, and its module."""

    def bench_of(self, document: str) -> Any:
        """The bench: explores the shipped code once."""

    def judged(self, bench: Any, change: Mapping[str, Any], complete: bool) -> Mapping[str, Any]:
        """What becomes of a change, as JSON."""


@dataclass(frozen=True)
class Register:
    """strength.toml of the room of proofs, as read."""

    rule: PythonRule
    explained: tuple[Explained, ...]


def register_path(place: Path, document: str) -> Path:
    """Where the register lies."""
    return place / "proofs" / document / "strength.toml"


def read_register(place: Path, document: str, texts: Sequence[tuple[str, ...]]) -> Register:
    """Read the register. Raises Unjudged with place and cause for whatever is not understood."""
    path = register_path(place, document)
    source = f"proofs/{document}/strength.toml"
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise Unjudged(f"{source}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None
    refuse_unknown(source, data, {"rule", "survivor"})
    rule = data.get("rule", {})
    refuse_unknown(f"{source}: rule", rule, {"cycles", "turns"})
    return Register(
        PythonRule(
            cycles=tuple(tuple(one) for one in rule.get("cycles", [])),
            turns=tuple((before, after) for before, after in rule.get("turns", [])),
            texts=tuple(texts),
        ),
        tuple(read_explained(source, values) for values in data.get("survivor", [])),
    )


@dataclass
class Implementation:
    """The shipped code of one document, its mutants, and what judges them."""

    place: Path
    document: str
    code: Code
    register: Register = field(init=False)

    def __post_init__(self) -> None:
        self.register = read_register(self.place, self.document, self.code.texts(self.document))

    @cached_property
    def reached(self) -> Mapping[str, tuple[Path, frozenset[str]]]:
        """The modules that some step reaches, by name: so is the order of the mutants and of the pages."""
        return dict(sorted(self.code.reached(self.document).items()))

    @cached_property
    def modules(self) -> dict[str, Module]:
        """The modules by their whole names; mutants carry the last part."""
        return {
            name: Module(name.rpartition(".")[2], file.read_text(encoding="utf-8"))
            for name, (file, _) in self.reached.items()
        }

    @cached_property
    def mutants(self) -> dict[str, tuple[str, PythonMutant]]:
        """Every mutant by its id, with the name of its module. Raises Unjudged when a module has none."""
        read = frozenset(
            node.id
            for name, module in self.modules.items()
            for function in self.reached[name][1]
            for node in ast.walk(module.functions[function])
            if isinstance(node, ast.Name)
        )
        found: dict[str, tuple[str, PythonMutant]] = {}
        for name, module in self.modules.items():
            of_module = python_mutants(module, sorted(self.reached[name][1]), read, self.register.rule)
            if not of_module:
                raise Unjudged(f"module {name} has no mutants")
            for one in of_module:
                if one.mutant.id in found:
                    raise Unjudged(f"two mutants have the id {one.mutant.id}")
                found[one.mutant.id] = name, one
        return found

    @property
    def every(self) -> tuple[Mutant, ...]:
        """Every mutant."""
        return tuple(one.mutant for _, one in self.mutants.values())

    def lines_of(self, mutant: Mutant) -> list[str]:
        """The shipped text of a mutant's module."""
        return self.modules[self.mutants[mutant.id][0]].lines

    def change(self, mutant: Mutant) -> dict[str, Any]:
        """What the bench is given."""
        name, one = self.mutants[mutant.id]
        return {
            "module": name,
            "definition": mutant.definition,
            "text": applied(self.modules[name].lines, mutant.edit),
            "lines": one.lines,
            "file": str(self.reached[name][0]),
        }

    # ---- what a judgement rests on

    @cached_property
    def _theorems(self) -> Mapping[str, str]:
        return self.code.theorems(self.document)

    @cached_property
    def base(self) -> str:
        """A hash of the code, of what explores and compares it, and of its interface."""
        interface = self.place / "spec" / self.document / "interface.toml"
        starts = ["proofs.mutants.bench", f"proofs.{self.document}.subjects"]
        told = [version("z3-solver"), interface.read_text(encoding="utf-8") if interface.is_file() else ""]
        return digest([*told, *sources(self.place, starts)])

    @cached_property
    def _stamps(self) -> dict[str, str]:
        """For each theorem a hash of the modules that it is made of."""
        modules = {name: digest(sources(self.place, [name])) for name in set(self._theorems.values())}
        return {theorem: modules[module] for theorem, module in self._theorems.items()}

    def stamp(self, record: Mapping[str, Any]) -> str:
        """The hash of what a judgement rests on now; empty when a theorem of it is gone.

        One killed rests on the theorems asked, one proved equivalent on none, any other on all.
        """
        asked: Iterable[str] = [one["theorem"] for one in record["answers"]]
        if record["verdict"] == "EQUIVALENT":
            asked = ()
        elif record["verdict"] != "KILLED" or record["complete"]:
            asked = self._stamps
        if any(name not in self._stamps for name in asked):
            return ""
        return digest([self.base, *sorted({f"{name} {self._stamps[name]}" for name in asked})])

    def find(self, results: Results, mutant: Mutant, complete: bool = False) -> dict[str, Any] | None:
        """The judgement that holds for the code and the theorems as they are now."""
        found = None
        for record in results.of(mutant.id):
            if record["inputs"] == self.stamp(record) and (record["complete"] or not complete):
                found = record
        return found

    def known(self, results: Results) -> list[Judged]:
        """The mutants that are judged for the code and the theorems as they are now."""
        found = ((one, self.find(results, one)) for one in self.every)
        return [Judged(one, record) for one, record in found if record is not None]


def sources(place: Path, names: Iterable[str]) -> list[str]:
    """The programs of these modules and of all that they import of proofs/ and refimpl/, without comments."""
    return [f"{name} {text}" for name, text in sorted(closure(place, names).items())]


def closure(place: Path, names: Iterable[str]) -> dict[str, str]:
    """These modules and all of the tree that they import, by name, each as its program without comments."""
    found: dict[str, str] = {}
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        path = place / Path(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found[name] = ast.dump(tree)
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                waiting += [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module:
                waiting += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return found


def judge_implementation(
    code: Implementation,
    chosen: Sequence[Mutant],
    results: Results,
    progress: Progress,
    jobs: int,
    complete: bool = False,
    limit_s: float = LIMIT_S,
) -> list[Judged]:
    """The judgement of each chosen mutant, in their order; what is known already is not judged again.

    Ctrl-C ends the processes; what was judged stays. A mutant that takes longer than limit_s, or whose
    process dies, is UNMEASURED.
    """
    known = {one.id: found for one in chosen if (found := code.find(results, one, complete)) is not None}
    waiting = [one for one in chosen if one.id not in known]
    if results.remark:
        progress.say(results.remark)
    if known:
        progress.say(f"{len(known)} of {len(chosen)} mutants were judged before")
    if not waiting:
        return [Judged(one, known[one.id]) for one in chosen]
    progress.expect(1)
    progress.begin("mutants")
    try:
        progress.update("mutants", "exploring the shipped code")
        bench = code.code.bench_of(code.document)
        began, done = time.monotonic(), 0

        def work(mutant: Mutant) -> dict[str, Any]:
            started = time.monotonic()
            found = dict(code.code.judged(bench, code.change(mutant), complete))
            return {**found, "seconds": round(time.monotonic() - started, 2)}

        for outcome in in_forks(work, waiting, jobs, limit_s):
            if outcome is not None:
                mutant = waiting[outcome.number]
                record = _record(mutant, outcome.result, outcome.why, complete, limit_s)
                record["inputs"] = code.stamp(record)
                results.add(record)  # at once, so that an interruption loses nothing that was judged
                known[mutant.id] = record
                done += 1
            progress.update("mutants", so_far(len(waiting), done, time.monotonic() - began, known))
    finally:
        progress.end("mutants")
    return [Judged(one, known[one.id]) for one in chosen]


def _record(
    mutant: Mutant, found: Mapping[str, Any] | None, why: str, complete: bool, limit_s: float
) -> dict[str, Any]:
    unmeasured = {
        "verdict": "UNMEASURED",
        "killers": [],
        "reason": why,
        "witness": "",
        "answers": [],
        "seconds": limit_s,
    }
    return {
        "mutant": mutant.id,
        "module": mutant.module,
        "operator": mutant.operator,
        "definition": mutant.definition,
        "complete": complete,
        **(unmeasured if found is None else found),
    }

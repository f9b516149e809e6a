"""The shipped code of a document and its mutants. by_theorems.py and by_vectors.py judge them.

What is edited in which function is a rule (python_operators.py). The room of proofs says which functions
some step reaches; `proofs/<document>/strength.toml` says what is put in the place of a name. No file of the
code is touched: a mutant is a text.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

from modeproof.ground.errors import Unjudged
from modeproof.strength.mutant import Mutant, applied
from modeproof.strength.python_module import Module
from modeproof.strength.python_operators import PythonMutant, PythonRule, python_mutants
from modeproof.strength.register import CodeStrength, load_code


class Room(Protocol):
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


@dataclass
class Code:
    """The shipped code of one document and its mutants."""

    place: Path
    document: str
    room: Room
    register: CodeStrength = field(init=False)

    def __post_init__(self) -> None:
        self.register = load_code(self.place, self.document)

    @cached_property
    def reached(self) -> Mapping[str, tuple[Path, frozenset[str]]]:
        """The modules that some step reaches, by name: so is the order of the mutants."""
        return dict(sorted(self.room.reached(self.document).items()))

    @property
    def files(self) -> list[Path]:
        """The files of these modules."""
        return [file for file, _ in self.reached.values()]

    @cached_property
    def modules(self) -> dict[str, Module]:
        """The modules by their whole names; mutants carry the last part."""
        return {
            name: Module(name.rpartition(".")[2], file.read_text(encoding="utf-8"))
            for name, (file, _) in self.reached.items()
        }

    @cached_property
    def _by_id(self) -> dict[str, tuple[str, PythonMutant]]:
        """Every mutant by its id, with the name of its module. Raises Unjudged when a module has none."""
        read = frozenset(
            node.id
            for name, module in self.modules.items()
            for function in self.reached[name][1]
            for node in ast.walk(module.functions[function])
            if isinstance(node, ast.Name)
        )
        texts = tuple(self.room.texts(self.document))
        rule = PythonRule(self.register.cycles, self.register.turns, texts)
        found: dict[str, tuple[str, PythonMutant]] = {}
        for name, module in self.modules.items():
            of_module = python_mutants(module, sorted(self.reached[name][1]), read, rule)
            if not of_module:
                raise Unjudged(f"module {name} has no mutants")
            for made in of_module:
                if made.mutant.id in found:
                    raise Unjudged(f"two mutants have the id {made.mutant.id}")
                found[made.mutant.id] = name, made
        return found

    @property
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant."""
        return tuple(made.mutant for _, made in self._by_id.values())

    def module_of(self, mutant: Mutant) -> str:
        """The whole name of the module that a mutant edits."""
        return self._by_id[mutant.id][0]

    def lines_of(self, mutant: Mutant) -> Sequence[str]:
        """The shipped text of a mutant's module."""
        return self.modules[self.module_of(mutant)].lines

    def change(self, mutant: Mutant) -> dict[str, Any]:
        """The edit as the room of proofs takes it."""
        name, made = self._by_id[mutant.id]
        return {
            "module": name,
            "definition": mutant.definition,
            "text": applied(self.modules[name].lines, mutant.edit),
            "lines": made.lines,
            "file": str(self.reached[name][0]),
        }


def files_of(place: Path, names: Iterable[str]) -> dict[str, Path]:
    """The files of these modules and of all modules of the tree that they import, by name."""
    found: dict[str, Path] = {}
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        path = place / Path(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found[name] = path
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                waiting += [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.module:
                waiting += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return dict(sorted(found.items()))


def programs(place: Path, names: Iterable[str]) -> list[str]:
    """The programs of these modules and of all that they import, without comments, each behind its name."""
    found = files_of(place, names).items()
    return [f"{name} {ast.dump(ast.parse(path.read_text(encoding='utf-8')))}" for name, path in found]

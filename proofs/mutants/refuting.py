"""Asks theorems of edited code: does each have a counterexample there?

The edited text is put in the place of its module before anything imports it, so that whatever the theorems
need sees it: this is for a process of its own, which has loaded neither the code nor its proofs. No file is
touched.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import Any, Final

LIMIT_MS: Final = 20_000
"""For one question; a counterexample is found in a small part of it."""
REFUTED, HOLDS, UNKNOWN = "refuted", "holds", "no theorem has this name"


class _Edited(SourceFileLoader):
    """Loads a module from another text than its file has."""

    def __init__(self, name: str, path: str, text: str) -> None:
        super().__init__(name, path)
        self._text = text

    def get_code(self, fullname: str) -> CodeType:
        """Compiled from the text; what is kept beside the file is not looked at."""
        return compile(self._text, self.path, "exec", dont_inherit=True)


class Editing(MetaPathFinder):
    """Finds one module, and says that its text is another one."""

    def __init__(self, module: str, text: str) -> None:
        self._module, self._text = module, text

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The spec of that module; None for any other."""
        spec = PathFinder.find_spec(fullname, path, target) if fullname == self._module else None
        if spec is None or spec.origin is None:
            return None
        spec.loader = _Edited(fullname, spec.origin, self._text)
        return spec


def answers(document: str, names: Sequence[str]) -> dict[str, str]:
    """What each theorem says of the code as it is loaded."""
    import z3

    from proofs.theorem import theorems_of

    there = {one.name: one for one in theorems_of(document)}
    subjects = getattr(_room(document, "subjects"), "SUBJECTS", ())
    answered = {subject.answered for subject in subjects}
    return {name: _answer(z3, there[name], name in answered) if name in there else UNKNOWN for name in names}


def _room(document: str, name: str) -> Any:
    """A module of the document's proofs; None where it has none of this name."""
    from modeproof.kit.by_name import module_named

    try:
        return module_named(f"proofs.{document}.{name}")
    except ModuleNotFoundError:
        return None


def _answer(z3: Any, item: Any, answered: bool) -> str:
    """Refuted: some claim has a counterexample. A scan that raises refutes the theorem that every scan ends
    with a state and outputs (`answered`); of another theorem it says nothing.
    """
    from proofs.theorem import TheoremError

    unknown = ""
    try:
        for query in item.build(*item.rows()):
            if query.expected != "unsat":
                continue
            solver = z3.Solver()
            solver.set("timeout", LIMIT_MS)
            solver.add(*query.formulas.values())
            answer = solver.check()
            if answer == z3.sat:
                return REFUTED
            if answer == z3.unknown:
                unknown = unknown or f"{query.name}: {solver.reason_unknown()}"
    except TheoremError as error:
        return REFUTED if answered and " step raises: " in str(error) else f"TheoremError: {error}"[:300]
    except Exception as error:
        return " ".join(f"{type(error).__name__}: {error}".split())[:300]
    return unknown or HOLDS


def main(document: str, file: str, text: str, theorems: Sequence[str]) -> dict[str, str]:
    """By theorem: refuted, holds, or why nothing can be said, where `file` has this text.

    file: the path of a module below the root. Never raises: an edit that cannot be loaded refutes nothing.
    """
    sys.meta_path.insert(0, Editing(file.removesuffix(".py").replace("/", "."), text))
    try:
        return answers(document, theorems)
    except Exception as error:
        said = " ".join(f"{type(error).__name__}: {error}".split())[:300]
        return dict.fromkeys(theorems, said)

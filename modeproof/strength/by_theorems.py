"""Mutants of the shipped code, judged by theorems: proofs/mutants/copy_judge.py says what."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.strength.campaign import Answers, Judges
from modeproof.strength.code import Code, programs
from modeproof.strength.mutant import Mutant
from modeproof.strength.register import code_path
from modeproof.strength.results import digest

LIMIT_S = 600.0
"""Wall-clock time for one mutant; what takes longer is UNMEASURED."""


class ByTheorems(Judges):
    """The code of one document and the theorems that judge its mutants."""

    what = "impl"
    suffix = "py"
    limit_s = LIMIT_S

    def __init__(self, code: Code) -> None:
        self.code = code
        self.place, self.document = code.place, code.document
        self.command = f"modeproof mutate impl --document {self.document}"
        self.register = code_path(self.place, self.document)
        self.explained = code.register.explained("theorems")
        self._bench: Any = None

    @property
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant of the code."""
        return self.code.mutants

    @cached_property
    def _theorems(self) -> Mapping[str, str]:
        return self.code.room.theorems(self.document)

    @property
    def names(self) -> Sequence[str]:
        """The theorems."""
        return tuple(self._theorems)

    @property
    def rests_on(self) -> Sequence[Path]:
        """The register, the code, and the document's room of proofs."""
        proofs = sorted((self.place / "proofs" / self.document).glob("*.py"))
        return [self.register, *self.code.files, *proofs]

    @property
    def tools(self) -> Mapping[str, Mapping[str, str | None]]:
        """The solver."""
        return {"z3": evidence.package("z3-solver")}

    def lines_of(self, mutant: Mutant) -> Sequence[str]:
        """The module without the edit."""
        return self.code.lines_of(mutant)

    # ---- judging

    def prepare(
        self, waiting: Sequence[Mutant], complete: bool, jobs: int, tell: Callable[[str], None]
    ) -> None:
        """Explore the shipped code."""
        tell("exploring the shipped code")
        self._bench = self.code.room.bench_of(self.document)

    def judge(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any]:
        """What becomes of a mutant."""
        return dict(self.code.room.judged(self._bench, self.code.change(mutant), complete))

    # ---- what a judgement rests on

    @property
    def _starts(self) -> list[str]:
        return ["proofs.mutants.bench", f"proofs.{self.document}.subjects"]

    @cached_property
    def base(self) -> str:
        """A hash of the code, of what explores and compares it, and of its interface."""
        interface = self.place / "spec" / self.document / "interface.toml"
        told = [version("z3-solver"), interface.read_text(encoding="utf-8") if interface.is_file() else ""]
        return digest([*told, *programs(self.place, self._starts)])

    @cached_property
    def _stamps(self) -> dict[str, str]:
        """For each theorem a hash of the modules that it is made of."""
        modules = {name: digest(programs(self.place, [name])) for name in set(self._theorems.values())}
        return {theorem: modules[module] for theorem, module in self._theorems.items()}

    def stamp(self, record: Answers) -> str:
        """The hash of what a judgement rests on now; empty when a theorem of it is gone.

        A killed mutant rests on the theorems asked, one proved equivalent on none, any other mutant on all.
        """
        asked: Iterable[str] = [answer["theorem"] for answer in record["answers"]]
        if record["verdict"] == "EQUIVALENT":
            asked = ()
        elif record["verdict"] != "KILLED" or record["complete"]:
            asked = self._stamps
        if any(name not in self._stamps for name in asked):
            return ""
        return digest([self.base, *sorted({f"{name} {self._stamps[name]}" for name in asked})])

    def asked(self, record: Answers) -> Iterable[str]:
        """The theorems that were asked."""
        return (answer["theorem"] for answer in record["answers"])

    def shown(self, mutant: Mutant, record: Answers) -> Iterable[str]:
        """Where it differs, and what each theorem said."""
        if record["witness"]:
            yield f"    {record['witness']}"
        for answer in record["answers"]:
            where = f": {answer['where']}" if answer["where"] else ""
            yield f"    {answer['theorem']}: {answer['result']}{where}, {answer['seconds']} s"

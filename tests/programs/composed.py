"""The specifications of a public collection of composed programs, as properties of `prove-program`.

The folder `Benchmark/sac18_cyclebmc/programs/st` of `LeonOss/CycleBoundedModelCheckingTest` (GitHub) has
programs after PLCopen's safety examples, and one file for each specification: `AG f`, f holds after every
scan, or `EF f`, it holds after some scan; and the bound in scans up to which it was checked.
"""

from __future__ import annotations

import re
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from programs.commands.prove_properties import judged
from programs.properties.property_verdicts import Found

LIBRARY = "plcopen.st"
SCAN_TIME = "[1, 100]"
FORMS = {"!": " NOT ", "&": " AND ", "|": " OR ", "0x": "16#", "\n": " "}


@dataclass(frozen=True)
class Specification:
    """One file `*.spec`: the program, the unit meant, the formula, and the bound of the collection."""

    file: str
    unit: str
    formula: str
    bound: int

    @staticmethod
    def read(path: Path) -> Specification:
        """The specification in a file."""
        found = dict(line.split(":", 1) for line in path.read_text("utf-8").splitlines() if ":" in line)
        unit = found["main"].strip().rpartition(".")[2]
        return Specification(found["file"].strip(), unit, found["formula"].strip(), int(found["bound"]))

    @property
    def reachable(self) -> bool:
        """Whether it asks for a scan, and not for all."""
        return self.formula.startswith("EF")

    @cached_property
    def row(self) -> str:
        """The property in TOML."""
        left, implies, right = self.formula[2:].strip().removeprefix("(").partition("=>")
        if implies:
            parts = {"holds": left, "only_if": right.removesuffix(")")}
        else:
            parts = {"never" if self.reachable else "always": self.formula[2:]}
        lines = [f'{key} = "{_in_st(text)}"' for key, text in parts.items()]
        return "\n".join(["[[property]]", 'id = "asked"', 'sentence = "As specified."', *lines, ""])


def _in_st(formula: str) -> str:
    """A formula of the collection in Structured Text."""
    text = as_iec(formula)
    for of, to in FORMS.items():
        text = text.replace(of, to)
    return " ".join(text.split())


def as_iec(text: str) -> str:
    """Sums of BOOLs as sums of numbers."""
    return re.sub(
        r"[\w.]+(?:\s*\+\s*[\w.]+)+",
        lambda found: " + ".join(f"BOOL_TO_INT({part.strip()})" for part in found[0].split("+")),
        text,
    )


def program(path: Path) -> str:
    """A program of the collection in the language that the reader knows."""
    text = re.sub(r"\b(TON|SF_\w+)X\b", r"\1", path.read_text("utf-8"))
    return re.sub(r"\bEND_(PROGRAM|FUNCTION_BLOCK)", r"END_\1\n", as_iec(text))


def specifications(folder: Path) -> Iterator[Specification]:
    """All of them, by program."""
    return (Specification.read(path) for path in sorted(folder.glob("*.spec")))


def judge(of: Specification, folder: Path, seconds: float) -> tuple[Found, float]:
    """The verdict on a specification, and the CPU seconds from the reading on."""
    began = time.process_time()
    with tempfile.TemporaryDirectory() as place:
        files = []
        for name in dict.fromkeys((LIBRARY, of.file)):
            files.append(Path(place, name))
            files[-1].write_text(program(folder / name), "utf-8")
        asked = Path(place, "asked.toml")
        asked.write_text(f"scan_time_ms = {SCAN_TIME}\n{of.row}", "utf-8")
        _, found = judged(files, asked, of.unit, False, seconds, lambda text: None)
    return found[-1], time.process_time() - began

"""The tables were written down twice, in TLA+ and in Python; here the two are compared.

The numbers are read from the text of `spec/mode_selection/CodeTables.tla`, by a reader that knows one form
only (`TLCEval` may be left out):

    RE == TLCEval([m \\in MSO |-> CASE m = 0 -> \\h0F0F [] m = 1 -> \\h0FF0 ... [] m = 4 -> \\h3C3C])

TLC's own reading of the same module is compared in the tests.
"""

import re
from pathlib import Path
from typing import Final

import z3

from proofs.mode_selection.ranges import FLAG_WORD, MODES, free_mode, mode_of, word_of
from proofs.theorem import Queries, claim, theorem
from proofs.words import constant

SPECIFICATION: Final = Path(__file__).resolve().parents[2] / "spec/mode_selection/CodeTables.tla"

_DEFINITION = re.compile(
    r"^(\w+)\s*==\s*(?:TLCEval\()?\[\s*m\s+\\in\s+MSO\s*\|->\s*CASE\b((?:[^\[\]]|\[\])*)\]", re.M
)
_BRANCH = re.compile(r"\s*m\s*=\s*([0-9]+)\s*->\s*\\[hH]([0-9A-Fa-f]{4})\s*")


class TranscriptionError(ValueError):
    """The module's text does not have the one form that the reader knows."""


def tables_in(text: str) -> dict[str, tuple[int, ...]]:
    """The four ranges in the text of CodeTables.tla, each as five words by mode.

    Raises TranscriptionError: a range is missing or defined twice, a branch is missing, twice, or in another
    form.
    """
    code = re.sub(r"\(\*.*?\*\)|\\\*[^\n]*", "", text, flags=re.S)
    found: dict[str, tuple[int, ...]] = {}
    for name, body in _DEFINITION.findall(code):
        if name in found:
            raise TranscriptionError(f"CodeTables.tla: {name} is defined twice")
        found[name] = _words(name, body)
    if set(found) != set(FLAG_WORD):
        raise TranscriptionError(f"CodeTables.tla: expected {sorted(FLAG_WORD)}, found {sorted(found)}")
    return found


def _words(name: str, body: str) -> tuple[int, ...]:
    branches: dict[int, int] = {}
    for part in body.split("[]"):
        match = _BRANCH.fullmatch(part)
        if match is None:
            raise TranscriptionError(f"CodeTables.tla: {name}: cannot read {part.strip()!r}")
        mode, value = int(match[1]), int(match[2], 16)
        if mode in branches:
            raise TranscriptionError(f"CodeTables.tla: {name}: mode {mode} has two words")
        branches[mode] = value
    if sorted(branches) != list(MODES):
        raise TranscriptionError(
            f"CodeTables.tla: {name}: words for the modes {sorted(branches)}, not 0 to 4"
        )
    return tuple(branches[mode] for mode in MODES)


@theorem(clauses=["EKS-T1", "EKS-T2", "EKS-KS-10"], findings=[])
def the_specification_and_the_implementation_have_the_same_tables() -> Queries:
    """The four ranges in CodeTables.tla and in the reference implementation give every mode the same word.

    Both were written from Table 2, neither from the other. A misreading that both share would not be seen
    here.
    """
    mode, is_mode = free_mode("mode")
    for name, table in tables_in(SPECIFICATION.read_text(encoding="utf-8")).items():
        specified: z3.BitVecRef = constant(0)
        for number, value in enumerate(table):
            specified = z3.If(mode == number, constant(value), specified)
        given = {"mode is 0 to 4": is_mode}
        same = z3.And(word_of(name, mode) == specified, mode_of(name, specified) == mode)
        yield from claim(f"{name}: the same word for every mode", given, same)

"""The registers of a document: what it says, what must be true, what was decided; and who cites what.

Load with `load_document` (all registers) or `load_interface` (names only); both raise `Unjudged` with one
line. `judge` finds contradictions, unresolved citations and orphans; `matrix` is clause -> action -> step ->
property -> theorem -> vector. Everything is read from text: no code of a document is run.
"""

from __future__ import annotations

from modeproof.ground.errors import Unjudged
from modeproof.registers.citations import Citation, citations, read_sources
from modeproof.registers.crosscheck import cross_check, value_fault
from modeproof.registers.load import load_document, load_interface, load_responses, read_register
from modeproof.registers.matrix import Row
from modeproof.registers.register_judge import Judgement, check_document, judge, judge_tree, matrix
from modeproof.registers.rows import (
    About,
    Assumption,
    Clause,
    Device,
    Document,
    Finding,
    Interface,
    Problem,
    Property,
    Response,
    Signal,
)
from modeproof.registers.runs import Graph, Run, load_runs

__all__ = [
    "About",
    "Assumption",
    "Citation",
    "Clause",
    "Device",
    "Document",
    "Finding",
    "Graph",
    "Interface",
    "Judgement",
    "Problem",
    "Property",
    "Response",
    "Row",
    "Run",
    "Signal",
    "Unjudged",
    "check_document",
    "citations",
    "cross_check",
    "judge",
    "judge_tree",
    "load_document",
    "load_interface",
    "load_responses",
    "load_runs",
    "matrix",
    "read_register",
    "read_sources",
    "value_fault",
]

"""What the kit says of a faulty program leads to the fault: to a step, a signal or a time that it touches."""

from __future__ import annotations

import re
from pathlib import Path

from examples.faulty.run import PACK, ROOT, Fault, build, load_faults, open_all, programs
from modeproof.kit.adapter import Adapter
from modeproof.kit.diagnosis import state_name, unseen
from modeproof.kit.suite_judge import Plan, run_suite
from modeproof.kit.vectors import Case, Suite
from modeproof.kit.verdict import Difference

PACKS = {program.target: program for program in programs()}
BESIDE = 2
"""Lines of the program before and after a fault that are looked at."""
_TIME = re.compile(r"T_[A-Z]+|_ms|elapsed|now|dt|[Tt]ime")


def touched(fault: Fault) -> str:
    """What the fault is about: its words, its edit, and the lines of the program beside it."""
    source = (ROOT / fault.file).read_text(encoding="utf-8")
    before, after = source.split(fault.old)
    beside = [*before.splitlines()[-BESIDE:], *after.splitlines()[: BESIDE + 1]]
    return "\n".join([fault.old, fault.new, fault.mistake, *beside])


def named(suite: Suite, found: Difference) -> set[str]:
    """States and signals that the kit shows: of the scan, and inputs changed since an output changed."""
    case, names = found.case, set(found.expected)
    first = found.scan - 1
    while first > 1 and case.scans[first - 1].outputs == case.scans[first - 2].outputs:
        first -= 1
    for at in range(first, found.scan):
        names |= {name for name, value in case.scans[at].inputs.items() if _changed(case, at, name, value)}
    states = {
        case.scans[found.scan - 2].to if found.scan > 1 else case.initial,
        case.scans[found.scan - 1].to,
    }
    return names | {state_name(suite, case, state) for state in states}


def _changed(case: Case, at: int, name: str, value: object) -> bool:
    return at == 0 or case.scans[at - 1].inputs[name] != value


def leads_there(suite: Suite, fault: Fault, found: Difference) -> bool:
    """Whether what is named is touched: a step by what it cites, the rest by its name; a time by any time."""
    steps = {*found.step.split(" > "), *unseen(suite, found)}
    cited = {id for step in suite.steps if step.name in steps for id in (*step.clauses, *step.findings)}
    text = touched(fault)
    names = any(
        re.search(rf"\b{re.sub('_[0-9]$', '', name)}(\b|_[0-9])", text) for name in named(suite, found)
    )
    return bool(cited & set(fault.breaks)) or names or bool(found.time and _TIME.search(text))


def test_a_diagnosis_that_leads_elsewhere_is_counted_as_missed(tmp_path: Path) -> None:
    """The mistake of another fault is not what the kit names."""
    program = PACKS["sf_edm"]
    faults = [fault for fault in load_faults(program.pack) if not fault.reason and fault.suite == "brief"]
    made = build(tmp_path / "made", faults[0], program=program)
    suite = open_all(program)["brief"]
    found = run_suite(suite, lambda: Adapter([str(made)]), plan=Plan(effort=60)).difference
    assert found is not None and leads_there(suite, faults[0], found)
    assert not all(leads_there(suite, fault, found) for fault in faults)
    assert PACK.is_file()

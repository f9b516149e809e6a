"""Each property of properties.toml falls to a fault of a device, and holds when nothing is planted."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from modeproof.ground.places import root
from modeproof.registers.load import load_document
from tests.spec.mode_selection.faults import FAULTS, Falls
from tests.spec.mode_selection.planted import DOCUMENT, SPEC, Finding, Trial

PROPERTIES = {one.id: one for one in load_document(root(), DOCUMENT).properties}
MODULES = {path.stem: path.read_text() for path in SPEC.glob("*.tla")}


def checked(names: tuple[str, ...], falls: Falls, planted: bool) -> Trial:
    invariants = tuple(name for name in names if PROPERTIES[name].kind == "invariant")
    return Trial(
        falls.base,
        falls.fault if planted else None,
        invariants=invariants,
        properties=tuple(name for name in names if name not in invariants),
    )


TRIALS = [(falls, checked((falls.property,), falls, planted=True)) for falls in FAULTS]
# A base of liveness that is edited in nothing is its control itself: `modeproof check` judges it.
CONTROLS = [
    checked(tuple(dict.fromkeys(one.property for one in FAULTS if one.base == base)), falls, planted=False)
    for base, falls in {falls.base: falls for falls in FAULTS}.items()
    if base.edits or not base.run.startswith("LIVE_")
]


@pytest.mark.sampled(16)
@pytest.mark.parametrize(("falls", "trial"), TRIALS, ids=[str(trial) for _, trial in TRIALS])
def test_the_property_falls_to_the_fault(
    falls: Falls, trial: Trial, trials: Callable[[Trial], Finding]
) -> None:
    found = trials(trial)
    log, kind = found.outcome.log, PROPERTIES[falls.property].kind
    assert log.errors == []
    if kind == "invariant":
        assert (found.outcome.status, log.violations) == (12, [("invariant", falls.property)])
        return
    assert found.outcome.status == 13
    assert found.judgement.verdict == "VIOLATED" and len(log.trace) > 0
    if kind == "action":
        assert log.violations == [("property", falls.property)]
    elif kind == "liveness":  # TLC does not name it, but checked no other
        assert log.violations == [("temporal", "")] and found.judgement.violated == falls.property
    else:
        assert kind == "refinement" and log.violations == [("property", "")]
        place = re.search(
            r"^Action property line (\d+), .* of module ModeSelection is violated", found.log, re.M
        )
        assert place is not None
        assert "[][Next]_vars" in MODULES["ModeSelection"].splitlines()[int(place[1]) - 1]


@pytest.mark.sampled(16)
@pytest.mark.parametrize("trial", CONTROLS, ids=str)
def test_without_a_fault_the_properties_hold(trial: Trial, trials: Callable[[Trial], Finding]) -> None:
    found = trials(trial)
    assert (found.judgement.verdict, found.outcome.status) == ("HOLDS", 0)


def test_no_property_is_without_a_fault() -> None:
    assert {falls.property for falls in FAULTS} == set(PROPERTIES)


def extended(module: str) -> set[str]:
    """The module and all that it extends."""
    declared = re.search(r"^EXTENDS (.*)$", MODULES.get(module, ""), re.M)
    names = [] if declared is None else re.split(r",\s*", declared[1])
    return {module}.union(*(extended(name) for name in names))


def test_each_definition_of_a_property_has_a_fault() -> None:
    """Some properties are defined for the F-PLC alone and again for all devices together."""
    defined = {
        (name, module)
        for name in PROPERTIES
        for module, text in MODULES.items()
        if re.search(rf"^{name} ==", text, re.M)
    }
    assert {name for name, _ in defined} == set(PROPERTIES)
    seen = {(falls.property, module) for falls in FAULTS for module in extended(falls.base.checks)}
    assert defined - seen == set()

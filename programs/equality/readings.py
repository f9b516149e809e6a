"""Which reading a program has where it differs from the reference: by runs with plain values."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from modeproof.ground.places import root
from modeproof.kit.readings import Reading, Tried, in_words, readings
from modeproof.registers.load import load_document
from modeproof.registers.profiles import choices_of, profiles_of, rows_of
from programs.equality.product import Product
from programs.equality.replay import Difference, Run, published_runs
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow

LOOKING_S = 5.0
"""CPU seconds; no run is begun after this time."""


def reading_of(product: Product, difference: Difference, vectors: Path) -> str:
    """What is said of a difference: nothing where the target leaves no choice that the binding has made.

    A reading is taken for the program's if the reference, with it, has the same outputs in all scans of the
    difference; then the published vectors are asked as well. Raises Unjudged as reading vectors does.
    """
    binding = product.binding
    reference = binding.reference
    given = {
        name: binding.values[name] for name in choices_of(reference.device.register) if name in binding.values
    }
    if not given:
        return ""
    if difference.stopped:
        return "none: the program stops"
    choices = {name: of.values or (False, True) for name, of in choices_of(reference.device.register).items()}
    tried = readings(
        {name: values for name, values in choices.items() if name in given},
        given,
        {signal.name: finding.id for signal, finding in rows_of(load_document(root(), reference.document))},
        profiles_of(reference.device.register),
    )
    until = time.process_time() + LOOKING_S
    own = list(difference.given)
    agree = [one for one in tried if _same(product, difference.run, one, own)]
    found = {str(one): Tried(one, 1) for one in agree}
    for id, run in published_runs(product.binding, vectors, every=True) if agree else ():
        if time.process_time() > until or all(one.wrong for one in found.values()):
            break
        own = _given(product, run)
        for name, one in found.items():
            if not one.wrong:
                right = _same(product, run, one.reading, own)
                found[name] = replace(one, cases=one.cases + right, wrong="" if right else id)
    return in_words(list(found.values()), tried)


def _given(product: Product, run: Run) -> list[Mapping[str, Any]]:
    """The outputs of the program in the scans of a run, as far as it comes."""
    binding = product.binding
    given: list[Mapping[str, Any]] = []
    machine = Machine(binding.source, binding.unit, product.wrap)
    try:
        for dt_ms, inputs in run.scans:
            own = machine.scan(binding.plain_inputs(inputs, run.parameters, dt_ms), dt_ms)
            given.append(binding.plain_outputs(own))
    except Overflow:
        pass
    return given


def _same(product: Product, run: Run, reading: Reading, own: Sequence[Mapping[str, Any]]) -> bool:
    """Whether the reference with this reading has the outputs that the program has: these."""
    reference, compared = product.binding.reference, product.binding.compared
    state = reference.start({**run.parameters, **reading.changed})
    for (dt_ms, inputs), given in zip(run.scans, own, strict=False):
        state, row = reference.scan(state, dt_ms, inputs)
        if any(given[name] != row[name] for name in compared):
            return False
    return len(own) == len(run.scans)

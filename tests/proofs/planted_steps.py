"""Copies of a shipped device with one planted fault, and examples of the solver run on the real code."""

import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import z3

from proofs.explorer.device import Device, Scan, explored_from
from proofs.explorer.ends import End, ends
from proofs.explorer.records import evaluated, filled
from proofs.explorer.scanned import Scans
from proofs.mode_selection.devices import CHECKSUM_AGREES
from proofs.sentences import Judge, Sentence, demanded
from proofs.theorem import Query, Theorem

_NUMBER = itertools.count()
Example = tuple[Query, Scans, Sentence]
"""A question that must have an example, the scans that it is asked of, and the sentence that it breaks."""


@cache
def built(item: Theorem) -> tuple[tuple[Query, ...], tuple[Example, ...]]:
    """The questions of a theorem, built once for all tests, and its examples."""
    kept: list[Example] = []
    shipped = Judge._broken

    def remembered(self: Judge, what: str, scans: Scans, given: Any, sentence: Sentence) -> Query:
        query = shipped(self, what, scans, given, sentence)
        kept.append((query, scans, sentence))
        return query

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Judge, "_broken", remembered)
        return item.queries(), tuple(kept)


@contextmanager
def planted(device: Device, *edits: tuple[str, str]) -> Iterator[Device]:
    """The device with a copy of its module in which each text is replaced wherever it stands."""
    source = Path(device.module.__file__ or "").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in source, old
        source = source.replace(old, new)
    module = ModuleType(f"planted_{device.name}_{next(_NUMBER)}")
    sys.modules[module.__name__] = module
    try:
        exec(compile(source, module.__name__, "exec"), vars(module))
        stand_ins = tuple(replace(one, module=module) for one in device.stand_ins)
        yield replace(device, module=module, stand_ins=stand_ins)
    finally:
        del sys.modules[module.__name__]


def begun_in(device: Device, control: str) -> Scan:
    """The scans of a device from one control state, explored anew."""
    return explored_from(device, next(one for one in device.module.Step if one.value == control))


def kept(judge: Judge) -> Sentence:
    """The sentence that a scan keeps the invariant."""
    return lambda scan: (z3.BoolVal(True), judge.kept()(scan))


def refuted(judge: Judge, sentence: Sentence, control: str) -> bool:
    """A scan from this control state breaks the sentence, and so does its example in the real step.

    The example is a state of the invariant with inputs in their ranges, built by the code's constructors.
    """
    (scans,) = [one for one in judge.scans() if one.control == control]
    solver = z3.SimpleSolver()
    solver.add(*judge.premises(scans).values(), z3.Not(scans.always(demanded(sentence))))
    answer = solver.check()
    assert answer != z3.unknown
    if answer == z3.unsat:
        return False
    assert breaks(scans, sentence, solver.model())
    return True


def breaks(scans: Scans, sentence: Sentence, model: z3.ModelRef) -> bool:
    """Run the example on the real step: it ends where the explorer says, and there the sentence is false."""
    state, inputs = _state(scans, model), filled(scans.scan.inputs, model)
    end = _end_of(scans, model)
    assert scans.device.module.step(state, inputs) == _plain(end, model, state)
    return z3.is_false(
        model.eval(z3.simplify(demanded(sentence)(scans.read[id(end)])), model_completion=True)
    )


def _end_of(scans: Scans, model: z3.ModelRef) -> End:
    node: Any = scans.root
    while not isinstance(node, End):
        yes = z3.is_true(model.eval(node.question, model_completion=True))
        node = node.yes if yes else node.no
    assert node in ends(scans.root)
    return node


def _state(scans: Scans, model: z3.ModelRef) -> Any:
    """The state of the example; a checksum that is a parameter says what the example says."""
    symbolic, module = scans.scan.state, scans.device.module
    if not hasattr(symbolic.params, "checksum"):
        return filled(symbolic, model)
    agrees = z3.is_true(model.eval(CHECKSUM_AGREES.term, model_completion=True))
    key = filled(symbolic.key, model)
    params = module.Params(
        checksum=lambda data: key.KEYCRC if agrees else key.KEYCRC ^ 1,
        operating_state=filled(symbolic.params.operating_state, model),
        dip_switches=filled(symbolic.params.dip_switches, model),
        T_PULSE_ms=filled(symbolic.params.T_PULSE_ms, model),
    )
    return module.State(params, symbolic.state, key, filled(symbolic.elapsed_ms, model))


def _plain(end: End, model: z3.ModelRef, state: Any) -> Any:
    """The end of a path with the example's values; parameters are never written."""
    after, outputs = end.result
    values = {
        name: state.params if name == "params" else evaluated(getattr(after, name), model)
        for name in after.__dataclass_fields__
    }
    return type(after)(**values), evaluated(outputs, model)

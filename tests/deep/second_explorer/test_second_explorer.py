"""A second explorer, CrossHair, judges a sentence on a step of each device; ours must not see less than it.

It shares with our explorer Python and z3 alone: it makes its own symbolic values, follows the whole code, and
its states and inputs are built by hand.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from proofs.edm.block_safety import stop_at_once
from proofs.edm.devices import BLOCK
from proofs.edm.invariant import JUDGE
from proofs.explorer import device as explorer
from proofs.explorer.device import Device
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from refimpl.mode_selection import fplc
from tests.deep.second_explorer import sentences
from tests.proofs.planted_steps import begun_in, planted, refuted

pytest.importorskip("crosshair", reason="crosshair-tool has a wheel for x86_64 alone")
pytestmark = pytest.mark.deep

SENTENCES: tuple[Callable[..., bool], ...] = (
    sentences.plc_copies_its_sources,
    sentences.panel_without_authorization_sends_zeros,
    sentences.reader_without_a_key_signals_none,
    sentences.contactors_stop_at_once,
    sentences.switch_enables_at_stage_1_alone,
    sentences.guard_is_closed_and_locked,
    sentences.sensor_enables_over_a_free_sensor,
)
LIMIT_S = 900.0
"""Of the clock, for one sentence; the longest, F-PLC from CheckAcknowledgment, takes 95 s of CPU time."""


def judged(sentence: Callable[..., bool]) -> tuple[str, str]:
    """What CrossHair says: CONFIRMED over all paths, POST_FAIL with an example, or that it does not know."""
    from crosshair.core_and_libs import AnalysisKind, analyze_function, run_checkables
    from crosshair.options import AnalysisOptionSet

    options = AnalysisOptionSet(
        analysis_kind=[AnalysisKind.PEP316],
        per_condition_timeout=LIMIT_S,
        per_path_timeout=LIMIT_S,
        max_uninteresting_iterations=sys.maxsize,
        report_all=True,
    )
    messages = list(run_checkables(analyze_function(sentence, options)))
    assert len(messages) == 1, messages
    return messages[0].state.name, messages[0].message


@pytest.mark.parametrize("sentence", SENTENCES, ids=lambda sentence: str(sentence.__name__))
def test_a_second_explorer_confirms_the_sentence_over_all_paths(sentence: Callable[..., bool]) -> None:
    assert judged(sentence)[0] == "CONFIRMED", judged(sentence)


QUICK = frozenset({fplc.Step.ERROR, fplc.Step.ONE_OUTPUT, fplc.Step.SETTLE})
"""Of the others six take one to two minutes of CPU time each."""


@pytest.mark.parametrize(
    "step",
    [pytest.param(step, marks=[pytest.mark.long] * (step not in QUICK), id=step.value) for step in fplc.Step],
)
def test_a_second_explorer_confirms_the_f_plc_from_every_state(
    step: fplc.Step, monkeypatch: pytest.MonkeyPatch
) -> None:
    """State by state: all of them in one question take several minutes of the processor."""
    monkeypatch.setattr(sentences, "chosen", lambda steps, number: steps(step.value))
    assert judged(sentences.fplc_switches_on_the_pair)[0] == "CONFIRMED"


FAULTS = (
    (
        FPLC,
        "fplc",
        sentences.fplc_switches_on_the_pair,
        "return MW03 == SE[2]  # EKS-7-6",
        "return MW03 == SE[3]",
    ),
    (
        PLC,
        "plc",
        sentences.plc_copies_its_sources,
        "s.ReadAuthorization, s.MW03, i.MW05,",
        "s.ReadAuthorization, s.MW03, i.MW01,",
    ),
    (
        HMI,
        "hmi",
        sentences.panel_without_authorization_sends_zeros,
        "if level == NONE or level != s.offered:",
        "if level != NONE and level != s.offered:",
    ),
    (
        EKS,
        "eks",
        sentences.reader_without_a_key_signals_none,
        "if not i.inserted or not _same_key(s.key, i):",
        "if (not i.inserted and i.dt_ms < 7000) or not _same_key(s.key, i):",
    ),
    (BLOCK, "sf_edm", sentences.contactors_stop_at_once, "elif not inputs.Activate:", "elif False:"),
)
"""Of each device of the note and of a block: device, its name there, sentence, and what is planted."""


@pytest.fixture
def long_call() -> Iterator[Device]:
    """SF_EDM whose end of Activate counts only in calls of less than six seconds."""
    edit = ("elif not inputs.Activate:", "elif not inputs.Activate and inputs.dt_ms < 6000:")
    with planted(BLOCK, edit) as device:
        yield device


@pytest.mark.parametrize(("device", "name", "sentence", "old", "new"), FAULTS, ids=[one[1] for one in FAULTS])
def test_the_second_explorer_finds_a_planted_fault(
    device: Device,
    name: str,
    sentence: Callable[..., bool],
    old: str,
    new: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with planted(device, (old, new)) as faulty:
        monkeypatch.setattr(sentences, name, faulty.module)
        if device is FPLC:
            monkeypatch.setattr(sentences, "chosen", lambda steps, number: steps("Switch"))
        assert judged(sentence)[0] == "POST_FAIL"


def test_an_explorer_that_sees_5_seconds_disagrees_with_it(
    long_call: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sentences, "sf_edm", long_call.module)
    assert judged(sentences.contactors_stop_at_once)[0] == "POST_FAIL"
    start = "OutputEnable"
    ours = replace(JUDGE, device=long_call, explored=(begun_in(long_call, start),))
    assert refuted(ours, stop_at_once, start)
    number = explorer.number
    monkeypatch.setattr(
        explorer,
        "number",
        lambda name, low, high=None: number(name, low, 5000 if name == "in.dt_ms" else high),
    )
    limited = replace(JUDGE, device=long_call, explored=(begun_in(long_call, start),))
    assert not refuted(limited, stop_at_once, start)

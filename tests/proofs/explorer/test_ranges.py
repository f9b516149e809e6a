"""An explorer that sees only some values, or some states, cannot say that one path applies in every scan."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import z3

from proofs.edm.devices import BLOCK
from proofs.explorer import device as explorer
from proofs.explorer.device import Device
from proofs.explorer.explore import conjunction
from proofs.explorer.explore import explore as shipped
from proofs.mode_selection.devices import PLC
from proofs.sentences import exactly_one_path
from proofs.theorem import TheoremError, control


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """What is explored here is forgotten."""
    monkeypatch.setattr(explorer, "_EXPLORED", {})
    return


def met(device: Device) -> set[str]:
    """The answers to the questions that ask for the ends of the ranges."""
    found = set()
    for query in exactly_one_path(device):
        if query.expected == "sat" and not query.twin_of:
            solver = z3.SimpleSolver()
            solver.add(*query.formulas.values())
            found.add(str(solver.check()))
    return found


def limited(premise: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The explorer sees only the values that a formula admits."""

    def explore(function: Any, arguments: Any, premise_: Any = None, *rest: Any) -> Any:
        words = {"in.MW01": z3.BitVec("in.MW01", 16), "in.dt_ms": z3.Int("in.dt_ms")}
        name, _, most = premise.partition(" <= ")
        term = words[name]
        less = z3.ULE(term, int(most)) if z3.is_bv(term) else term <= int(most)
        return shipped(function, arguments, conjunction([premise_, less]), *rest)

    monkeypatch.setattr(explorer, "explore", explore)


@pytest.mark.parametrize("device", [BLOCK, PLC], ids=["sf_edm", "plc"])
def test_the_explorer_sees_both_ends_of_every_range(device: Device) -> None:
    assert met(device) == {"sat"}


@pytest.mark.parametrize(
    ("device", "premise"), [(BLOCK, "in.dt_ms <= 5000"), (PLC, "in.MW01 <= 255"), (PLC, "in.dt_ms <= 5000")]
)
def test_an_explorer_that_sees_some_values_only_is_found_out(
    device: Device, premise: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    limited(premise, monkeypatch)
    assert "unsat" in met(device)


def test_an_elapsed_time_with_a_limit_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    number = explorer.number
    monkeypatch.setattr(
        explorer,
        "number",
        lambda name, low, high=None: number(name, low, 5000 if name == "in.dt_ms" else high),
    )
    assert "unsat" in met(BLOCK)


def test_an_explorer_that_leaves_out_a_state_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from proofs import sentences

    every = sentences.scans_from(BLOCK)
    monkeypatch.setattr(sentences, "scans_from", lambda device: every[1:])
    with pytest.raises(TheoremError, match=r"explored from .*; the interface has"):
        list(exactly_one_path(BLOCK))


def test_a_control_that_finds_no_example_is_no_pass() -> None:
    from proofs.runner import QueryResult, judge

    asked = control("every value at its greatest", {"a": z3.BoolVal(False)})
    result = QueryResult(asked.name, asked.expected, "unsat", "unsat", 0.0, Path("x"))
    assert judge([result])[0] == "UNJUDGED"

"""What the feasible paths of a step pass through: all but the refusals of states that cannot be."""

import pytest

from proofs.explorer.coverage import coverage_of
from proofs.mode_selection.devices import EKS, HMI, PLC
from refimpl.mode_selection import plc


def test_every_line_of_the_plc_and_the_eks_but_one_refusal_lies_on_a_feasible_path() -> None:
    for device in (PLC, EKS):
        found = coverage_of(device)
        (missing,) = found.missing_lines()
        assert "raise StateError" in missing
        (branch,) = found.branches - found.passed_branches
        assert branch[2] is False
        assert found.passed_guards == found.guards


def test_what_no_scan_of_the_panel_passes_is_refusals_and_the_permissions_of_no_level() -> None:
    found = coverage_of(HMI)
    assert [line.split(": ", 1)[1] for line in found.missing_lines()] == [
        'raise InputError("mode", mode, "a mode 0..4 or -1 for none")',
        'raise StateError("state", s.state, "a Step of the HMI")',
        "return NO_MODES",
    ]
    assert len(found.branches - found.passed_branches) == 3


def _never(s: plc.State, i: plc.Inputs) -> plc.State:
    if i.dt_ms < 5 and i.dt_ms > 5:
        return s
    return s


def test_a_dead_line_is_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_never, "__module__", "refimpl.mode_selection.plc")
    monkeypatch.setattr(plc, "_copy_mw03", _never)
    found = coverage_of(PLC)
    assert [line for line in found.missing_lines() if line.startswith("test_coverage.py")]
    assert found.passed_guards != found.guards or found.passed_lines != found.lines

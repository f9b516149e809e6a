"""What the feasible paths of a step pass through: all but what the register explains."""

from pathlib import Path

import pytest

from proofs.explorer.coverage import coverage_of, explained
from proofs.explorer.errors import ExplorationError
from proofs.mode_selection.devices import DEVICES, EKS, FPLC, HMI, PLC
from refimpl.mode_selection import plc

REGISTER = Path(__file__).parents[3] / "proofs" / "mode_selection" / "strength.toml"


@pytest.mark.deep
@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_exactly_what_no_path_of_a_device_passes_is_explained(device: object) -> None:
    assert device in (FPLC, PLC, HMI, EKS)
    found = explained(device, REGISTER)  # type: ignore[arg-type]
    assert (found.unexplained, found.idle) == ((), ())
    assert len(found.reasons) == len(found.coverage.missing()) > 0


def test_feasible_paths_cover_plc_and_eks_but_for_one_refusal() -> None:
    for device in (PLC, EKS):
        found = coverage_of(device)
        line, branch = found.missing()
        assert "raise StateError" in line
        assert branch.startswith("branch ")
        assert found.passed_guards == found.guards


def _never(s: plc.State, i: plc.Inputs) -> plc.State:
    if i.dt_ms < 5 and i.dt_ms > 5:
        return s
    return plc.State(s.params, plc.Step.COPY_CHECK_MSO, s.ReadAuthorization, i.SelectMSO, s.CheckMSO, s.MW07)


@pytest.fixture
def _dead_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_never, "__module__", "refimpl.mode_selection.plc")
    monkeypatch.setattr(plc, "_copy_mw03", _never)


@pytest.mark.usefixtures("_dead_line")
def test_a_dead_line_its_branch_and_guard_are_named() -> None:
    assert [name for name in coverage_of(PLC).missing() if "_never" in name] == [
        "line _never: return s",
        "branch _never: if i.dt_ms < 5 and i.dt_ms > 5: yes",
        "guard CopyMW03: _never: i.dt_ms > 5: yes",
    ]
    found = explained(PLC, REGISTER)
    assert len(found.unexplained) == 3
    assert found.idle == ()


def _without(text: str, line: str) -> str:
    assert line in text
    return text.replace(line, "")


def test_a_place_that_the_register_forgets_is_unexplained(tmp_path: Path) -> None:
    changed = tmp_path / "strength.toml"
    text = REGISTER.read_text(encoding="utf-8")
    changed.write_text(_without(text, "    'branch step: elif state.turn == Step.COPY_MW07: no',\n"))
    assert explained(PLC, changed).unexplained == ("branch step: elif state.turn == Step.COPY_MW07: no",)


def test_an_explanation_of_what_is_passed_is_idle(tmp_path: Path) -> None:
    changed = tmp_path / "strength.toml"
    text = REGISTER.read_text(encoding="utf-8")
    changed.write_text(
        f'{text}\n[[unreached]]\ndevices = ["plc"]\nplaces = ["line step: pass"]\nwhy = "planted"\n'
    )
    assert explained(PLC, changed).idle == ("line step: pass",)


@pytest.mark.parametrize(
    "text",
    ["", "[[unreached]]\n", '[[unreached]]\ndevices = ["plc"]\nplaces = ["x"]\nwhy = ""\n', "unreached = ["],
)
def test_a_register_that_explains_nothing_cannot_be_judged(text: str, tmp_path: Path) -> None:
    changed = tmp_path / "strength.toml"
    changed.write_text(text)
    with pytest.raises(ExplorationError, match=r"strength\.toml"):
        explained(PLC, changed)

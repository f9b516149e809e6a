"""From the guarantees of each device to the properties of all, and the faults that must be seen."""

from __future__ import annotations

import dataclasses
import inspect
import random
from collections.abc import Callable, Iterator
from enum import Enum
from functools import cache
from types import ModuleType
from typing import Any

import pytest
import z3

from modeproof.registers import load_document
from proofs.explorer.device import Device, explored_from
from proofs.explorer.records import filled, unvalidated
from proofs.mode_selection import agreement, composition, composition_guarantees
from proofs.mode_selection.composition import ARGUMENT, BROKEN, INTENT, INTENT_ANYWAY, ZEROS
from proofs.mode_selection.composition_argument import Argument, Invariant
from proofs.mode_selection.composition_guarantees import GUARANTEES
from proofs.mode_selection.composition_system import ASSUMPTIONS, Assumption, Step, System
from proofs.mode_selection.composition_views import ends_in
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC, ROOT
from proofs.solvers import ask_z3
from proofs.theorem import Query, Theorem, TheoremError, theorems_of
from refimpl.mode_selection import eks, fplc, hmi, key_flows, plc
from tests.any_machine import LONG_MS
from tests.proofs.mode_selection.composed_flow import (
    OFF,
    Moment,
    as_system,
    beginning,
    insert,
    is_true,
    random_step,
    remove,
    scan,
    touch,
)

SYSTEM_THEOREMS = [value for value in vars(composition).values() if isinstance(value, Theorem)]
PANEL = composition_guarantees.every_scan_of_the_panel_keeps_its_guarantees
PLC_COPIES = composition_guarantees.every_scan_of_the_plc_keeps_its_guarantees
EKS_SIGNALS = composition_guarantees.every_scan_of_the_eks_keeps_its_guarantees


@cache
def _queries(item: Theorem) -> tuple[Query, ...]:
    return item.queries()


@cache
def _wrong(item: Theorem) -> tuple[str, ...]:
    """The queries of a theorem to which z3 gives another answer than the expected one."""
    return tuple(
        query.name for query in _queries(item) if ask_z3(query, "", LONG_MS).answer != query.expected
    )


# ---------------------------------------------------------------- proved


@pytest.mark.parametrize("item", SYSTEM_THEOREMS, ids=lambda item: item.name)
def test_theorems_on_all_devices_have_every_answer_they_expect(item: Theorem) -> None:
    assert _wrong(item) == ()


@pytest.mark.parametrize("item", [PANEL, PLC_COPIES, EKS_SIGNALS], ids=lambda item: item.name)
def test_the_shipped_device_keeps_its_guarantees(item: Theorem) -> None:
    assert _wrong(item) == ()


def test_every_assumed_formula_has_a_theorem_that_proves_it() -> None:
    theorems = {one.name: one for one in theorems_of("mode_selection")}
    for guarantee in GUARANTEES:
        assert guarantee.theorem in theorems
    for proved in ARGUMENT.proved:
        item = next(
            system_theorem for system_theorem in SYSTEM_THEOREMS if system_theorem.name == proved.theorem
        )
        assert item == theorems[proved.theorem]
        assert proved.name in {query.name.split(":")[0] for query in _queries(item)}


def test_every_assumption_of_the_argument_stands_in_a_register() -> None:
    document = load_document(ROOT, "mode_selection")
    known = {one.id for one in (*document.assumptions, *document.findings)}
    for assumption in ASSUMPTIONS:
        assert assumption.register
        assert set(assumption.register) <= known


# ---------------------------------------------------------------- the order


def _true(system: System) -> z3.BoolRef:
    return z3.BoolVal(True)


def _of_step(step: Step) -> z3.BoolRef:
    return z3.BoolVal(True)


GIVEN = Assumption("given", ("A-21",), _of_step, ("fplc",))


def test_a_circle_is_refused() -> None:
    circle = (Invariant("one", _true, ("two", "given"), ""), Invariant("two", _true, ("one",), ""))
    with pytest.raises(TheoremError, match="'one' assumes 'two', which is only proved later or from it"):
        Argument((), (GIVEN,), circle)


def test_a_formula_that_assumes_itself_is_refused() -> None:
    with pytest.raises(TheoremError, match="only proved later or from it"):
        Argument((), (GIVEN,), (Invariant("one", _true, ("one", "given"), ""),))


def test_an_assumption_that_nothing_discharges_is_refused() -> None:
    with pytest.raises(TheoremError, match="'one' assumes 'hope', which nothing discharges"):
        Argument((), (GIVEN,), (Invariant("one", _true, ("hope", "given"), ""),))


def test_an_assumption_that_no_proof_uses_is_reported() -> None:
    with pytest.raises(TheoremError, match="no proof uses 'given'"):
        Argument((), (GIVEN,), (Invariant("one", _true, (), ""),))


def test_two_formulas_of_one_name_are_refused() -> None:
    with pytest.raises(TheoremError, match="two formulas are called 'given'"):
        Argument((), (GIVEN,), (Invariant("given", _true, ("given",), ""),))


def test_without_an_unneeded_assumption_there_is_no_counterexample() -> None:
    argument = Argument(
        GUARANTEES,
        ASSUMPTIONS,
        tuple(
            dataclasses.replace(one, assumes=(*one.assumes, "outputs are wired"))
            if one.name == ZEROS
            else one
            for one in ARGUMENT.proved
        ),
    )
    assert ask_z3(argument.without(ZEROS, "outputs are wired"), "", LONG_MS).answer == "unsat"
    assert ask_z3(ARGUMENT.without(ZEROS, "words arrive within the dwell time"), "", LONG_MS).answer == "sat"


def test_what_a_formula_rests_on_is_followed_to_the_end() -> None:
    assert {"words arrive within the dwell time", "a removal is noticed before LA comes again"} <= set(
        ARGUMENT.rests_on(INTENT)
    )
    assert "outputs are wired" not in ARGUMENT.rests_on(ZEROS)


# ---------------------------------------------------------------- the formulas and the real devices


def _walks() -> Iterator[tuple[int, Moment]]:
    """Random flows from power-up, some with a switchover: each moment, with the number of its flow."""
    for seed in (0, 5, 17, 19, 20, 47):
        rng = random.Random(seed)
        moment = beginning("once" if seed % 2 else "again")
        for _ in range(1500):
            _, _, moment = random_step(moment, rng)
            yield seed, moment


def _looks_like(moment: Moment) -> tuple[object, ...]:
    flow = moment.flow
    words = tuple(word != 0 for word in dataclasses.astuple(flow.plc_out))
    return flow.fplc_state.state, flow.hmi_state.state, words


def test_the_invariants_hold_in_real_flows_of_the_shipped_devices() -> None:
    invariants = [one for one in ARGUMENT.proved if isinstance(one, Invariant)]
    seen: dict[tuple[object, ...], Moment] = {}
    for _, moment in _walks():
        seen[_looks_like(moment)] = moment
    assert len(seen) >= 50
    assert {moment.flow.fplc_state.state for moment in seen.values()} == set(fplc.Step)
    for moment in seen.values():
        system = as_system(moment)
        for invariant in invariants:
            assert is_true(invariant.of(system)), (invariant.name, moment)


def test_flows_switch_only_to_what_was_touched_seen_and_confirmed() -> None:
    switched = [moment for _, moment in _walks() if moment.switched]
    assert len(switched) >= 3
    for moment in switched:
        mode = moment.flow.fplc_state.mode
        assert moment.touched == moment.seen == moment.confirmed == mode


def test_the_words_are_wired_as_in_key_flows() -> None:
    """Each word that a device reads is the one that the argument says, and no other."""
    moment = beginning().flow
    plc_out = plc.Outputs(1, 2, 3, 4)
    fplc_out = fplc.Outputs(5, 6, False, False, False, True, False, False)
    hmi_out = dataclasses.replace(moment.hmi_out, SelectMSO=7, SwitchMSO=8)
    eks_out = eks.Outputs(True, False, True, False, True, False)
    flow = dataclasses.replace(moment, plc_out=plc_out, fplc_out=fplc_out, hmi_out=hmi_out, eks_out=eks_out)
    read = key_flows.fplc_inputs(flow, 0)
    assert (read.MW03, read.MW07) == (plc_out.MW03, plc_out.MW07)
    assert (read.LA, read.A, read.B, read.C, read.D, read.STR) == (True, False, True, False, True, False)
    to_plc = key_flows.plc_inputs(flow, 0)
    assert (to_plc.MW01, to_plc.MW05) == (fplc_out.MW01, fplc_out.MW05)
    assert (to_plc.SelectMSO, to_plc.SwitchMSO) == (hmi_out.SelectMSO, hmi_out.SwitchMSO)
    to_hmi = key_flows.hmi_inputs(flow, 0)
    assert (to_hmi.ReadAuthorization, to_hmi.CheckMSO) == (plc_out.ReadAuthorization, plc_out.CheckMSO)
    assert to_hmi.ActiveMSO == 3


def test_a_scan_of_one_device_leaves_the_others_alone() -> None:
    moment = beginning().flow
    for device, changes in (
        ("eks", {"eks_state", "eks_out"}),
        ("fplc", {"fplc_state", "fplc_out"}),
        ("plc", {"plc_state", "plc_out"}),
        ("hmi", {"hmi_state", "hmi_out", "touch"}),
    ):
        source = inspect.getsource(getattr(key_flows, f"scan_{device}"))
        after = key_flows.scan(moment, device, 0)
        kept = {field.name for field in dataclasses.fields(moment)} - changes
        assert all(getattr(after, name) is getattr(moment, name) for name in kept)
        assert all(f"{name}=" in source for name in changes)


# ---------------------------------------------------------------- an assumption is dropped: on real devices


def _scans(moment: Any, text: str) -> Any:
    """Scans and touches in order: `fplc fplc plc*4 hmi:confirm`; the F-PLC and the EKS with 200 ms each."""
    for word in text.split():
        name, _, field = word.partition(":")
        device, _, times = name.partition("*")
        if field:
            moment = touch(moment, field)
        for _ in range(int(times or 1)):
            moment = scan(moment, device, 200 if device == "eks" else 0)
    return moment


READ = "eks*5 fplc eks fplc eks fplc eks fplc*3"
"""From an empty reader with a key put in to AwaitSelection: read, LA, all outputs, none, the one."""


def test_with_late_words_a_mode_that_nobody_touched_becomes_active() -> None:
    """A-06: the panel still shows the screen of the key before, with its selection."""
    moment = scan(beginning(T_DWELL_ms=0), "fplc")
    moment = _scans(insert(moment, 1), READ)
    assert moment.flow.fplc_state.state == fplc.Step.AWAIT_SELECTION
    moment = _scans(moment, "plc*4 hmi hmi:select:1")
    assert moment.touched == 1
    moment = _scans(remove(moment), "eks*4 fplc*3")
    assert moment.flow.fplc_state.state == fplc.Step.IDLE
    assert not is_true(next(one for one in ARGUMENT.proved if one.name == ZEROS).of(as_system(moment)))
    moment = _scans(insert(moment, 1), READ)
    moment = _scans(moment, "plc*4 fplc*3 plc*4 hmi hmi:confirm plc*4 fplc*3")
    assert moment.flow.fplc_state.state == fplc.Step.SWITCH
    moment = scan(moment, "fplc")
    assert moment.switched
    assert moment.flow.fplc_state.mode == 1
    assert (moment.touched, moment.confirmed) == (-1, -1)


def _switching(moment: Any) -> Any:
    moment = _scans(insert(scan(moment, "fplc", 500), 1), READ)
    moment = _scans(moment, "plc*4 hmi hmi:select:1 plc*4 fplc*3 plc*4 hmi hmi:confirm plc*4 fplc*3")
    assert moment.flow.fplc_state.state == fplc.Step.SWITCH
    return moment


def test_with_all_assumptions_the_same_flow_keeps_the_intent() -> None:
    moment = scan(_switching(beginning()), "fplc")
    assert moment.switched
    assert (moment.touched, moment.seen, moment.confirmed) == (1, 1, 1)


def test_with_an_unnoticed_removal_one_key_switches_for_another_user() -> None:
    """A-07: the reader was empty, LA was low, and the F-PLC did not look."""
    moment = _scans(remove(_switching(beginning())), "eks*3")
    assert not moment.flow.eks_out.LA
    moment = _scans(insert(moment, 1), "eks*8")
    assert moment.unseen
    assert moment.flow.eks_out.LA
    moment = scan(moment, "fplc")
    assert moment.switched
    assert (moment.touched, moment.seen, moment.confirmed) == (-1, -1, -1)


# ---------------------------------------------------------------- a wire is broken: on real devices


def _broken_wire(moment: Moment, rng: random.Random) -> dict[str, bool]:
    """What the F-PLC sees of one broken wire, or of a test pulse that is missing."""
    if moment.flow.eks_state.state == eks.Step.TEST_ONES and rng.random() < 0.5:
        return dict.fromkeys(("A", "B", "C", "D", "STR"), False)
    return {rng.choice(("LA", "A", "B", "C", "D", "STR")): rng.random() < 0.5}


def _walks_with_broken_wires() -> Iterator[Moment]:
    """Random flows in which each scan of the F-PLC may find another wire broken."""
    for seed in (9, 12, 13, 21):
        rng = random.Random(seed)
        moment = beginning()
        for _ in range(1500):
            actor, dt_ms, after = random_step(moment, rng)
            if actor == "fplc" and rng.random() < 0.05:
                after = scan(moment, "fplc", dt_ms, _broken_wire(moment, rng))
            moment = after
            yield moment


def test_the_ground_of_intent_holds_with_one_broken_wire() -> None:
    names = ARGUMENT.rests_on(INTENT_ANYWAY)
    invariants = [one for one in ARGUMENT.proved if isinstance(one, Invariant) and one.name in names]
    seen: dict[tuple[object, ...], Moment] = {}
    switched = 0
    for moment in _walks_with_broken_wires():
        seen[(*_looks_like(moment), moment.low, moment.unseen)] = moment
        switched += moment.switched
        if moment.switched:
            mode = moment.flow.fplc_state.mode
            assert moment.touched == moment.seen == moment.confirmed == mode
    assert switched >= 2
    assert fplc.Step.ERROR in {moment.flow.fplc_state.state for moment in seen.values()}
    for moment in seen.values():
        system = as_system(moment)
        for invariant in invariants:
            assert is_true(invariant.of(system)), (invariant.name, moment)


def _swapped_behind_broken_wires(**wires: bool) -> Moment:
    """A key is exchanged for another one while the F-PLC is about to switch, and scans beside these wires."""
    moment = _scans(remove(_switching(beginning())), "eks*4")
    assert moment.flow.eks_out == OFF
    for _ in range(2):
        moment = scan(moment, "fplc", 0, wires)
    moment = _scans(insert(moment, 1), "eks*8")
    return scan(moment, "fplc", 0, wires)


@pytest.mark.parametrize("wires", [{}, {"LA": True}, {"B": True}, {"LA": False}, {"B": False}, {"A": True}])
def test_one_broken_wire_switches_nothing_for_another_user(wires: dict[str, bool]) -> None:
    moment = _swapped_behind_broken_wires(**wires)
    assert moment.flow.fplc_state.mode == -1
    assert not moment.switched


def test_two_broken_wires_switch_one_users_mode_for_another() -> None:
    """The assumption that one wire is broken is dropped: LA and the output of the level stay on."""
    moment = _scans(remove(_switching(beginning())), "eks*4")
    moment = _scans(insert(moment, 1), "eks*2")
    assert moment.unseen
    moment = scan(moment, "fplc", 0, {"LA": True, "B": True})
    assert moment.switched
    assert (moment.touched, moment.seen, moment.confirmed) == (-1, -1, -1)
    seen_anyway = composition.SEEN_ANYWAY
    assert ask_z3(ARGUMENT.without(seen_anyway, BROKEN), "", LONG_MS).answer == "sat"


# ---------------------------------------------------------------- a fault is planted in a device


def _plant(patch: pytest.MonkeyPatch, module: ModuleType, name: str, function: Callable[..., object]) -> None:
    patch.setattr(function, "__module__", module.__name__)
    patch.setattr(module, name, function)


def _broken(device: Device, control: Enum) -> dict[str, tuple[Any, Any, Any]]:
    """The guarantees that a scan from this control state breaks: for each the memory, what was read, and what
    the code, as it now is, returns.
    """
    ends = ends_in(device, explored_from(device, control))
    found = {}
    for one in composition_guarantees.guarantees_of(device):
        solver = z3.SimpleSolver()
        solver.add(ends.scan.premise, z3.Not(ends.always(one.of)))
        if solver.check() == z3.sat:
            record = ends.scan.state
            if device is EKS:
                values = {
                    field.name: getattr(record.params, field.name) for field in dataclasses.fields(eks.Params)
                }
                opaque = unvalidated(eks.Params, values | {"checksum": lambda data: 0})
                record = dataclasses.replace(record, params=opaque)
            state, read = filled(record, solver.model()), filled(ends.scan.inputs, solver.model())
            found[one.name] = (state, read, device.module.step(state, read))
    return found


def _asks_by_any_echo(s: hmi.State, i: hmi.Inputs) -> hmi.State:
    if i.CheckMSO == 0:
        return s
    return hmi.State(s.params, hmi.Step.CONFIRM, s.offered, s.selection)


def test_a_panel_that_asks_by_any_echo_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _broken(HMI, hmi.Step.AWAIT_ECHO) == {}
    _plant(monkeypatch, hmi, "_await_echo", _asks_by_any_echo)
    broken = _broken(HMI, hmi.Step.AWAIT_ECHO)
    assert set(broken) == {"the panel asks by the echo"}
    before, read, (after, _) = broken["the panel asks by the echo"]
    assert after.state == hmi.Step.CONFIRM
    assert read.CheckMSO != hmi.encode(hmi.CH, before.selection)


def _acknowledges_unasked(s: hmi.State, i: hmi.Inputs) -> hmi.State:
    if i.CheckMSO == 0:
        return s
    if i.CheckMSO == hmi.encode(hmi.CH, s.selection):
        return hmi.State(s.params, hmi.Step.AWAIT_SWITCH, s.offered, s.selection)
    return hmi.State(s.params, hmi.Step.WITHDRAWN, s.offered, -1)


def test_a_panel_that_asks_nobody_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    _plant(monkeypatch, hmi, "_await_echo", _acknowledges_unasked)
    broken = _broken(HMI, hmi.Step.AWAIT_ECHO)
    assert set(broken) == {"the panel acknowledges by a touch"}
    _, _, (after, out) = broken["the panel acknowledges by a touch"]
    assert after.state == hmi.Step.AWAIT_SWITCH
    assert out.SwitchMSO != 0


def _crosses_two_words(s: plc.State, i: plc.Inputs) -> plc.State:
    return plc.State(s.params, plc.Step.COPY_CHECK_MSO, s.ReadAuthorization, i.SwitchMSO, s.CheckMSO, s.MW07)


def test_a_plc_that_crosses_two_words_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _broken(PLC, plc.Step.COPY_MW03) == {}
    _plant(monkeypatch, plc, "_copy_mw03", _crosses_two_words)
    before, read, (_, out) = _broken(PLC, plc.Step.COPY_MW03)["the PLC copies or keeps"]
    assert out.MW03 not in (before.MW03, read.SelectMSO)


def test_a_planted_fault_falls_in_the_theorem_of_the_device(monkeypatch: pytest.MonkeyPatch) -> None:
    _plant(monkeypatch, plc, "_copy_mw03", _crosses_two_words)
    asked = [one for one in PLC_COPIES.build() if one.expected == "unsat"]
    fallen = [one.name for one in asked if ask_z3(one, "", LONG_MS).answer == "sat"]
    assert fallen == ["CopyMW03: the PLC copies or keeps"]


def _crosses_outputs_c_and_d(s: eks.State) -> eks.Outputs:
    level = eks.decode(eks.RE, s.key.authorization_level)
    if s.state == eks.Step.SIGNAL:
        return eks.Outputs(True, level == 0, level == 1, level == 3, level == 2, level == 4)
    return eks.Outputs(False, False, False, False, False, False)


def test_an_eks_that_signals_another_level_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _broken(EKS, eks.Step.SIGNAL) == {}
    _plant(monkeypatch, eks, "outputs", _crosses_outputs_c_and_d)
    broken = _broken(EKS, eks.Step.SIGNAL)
    assert set(broken) == {"the EKS signals the level read"}
    _, _, (after, out) = broken["the EKS signals the level read"]
    assert out.LA
    assert (after.key.authorization_level == eks.RE[3]) == out.C


def _switches_to_what_was_acknowledged(s: fplc.State, i: fplc.Inputs) -> fplc.State:
    mode = fplc.decode(fplc.SW, i.MW07)
    return fplc.State(s.params, fplc.SETTLE, s.accepted, s.authority, -1, mode, 0)


def test_an_fplc_that_switches_as_acknowledged_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _broken(FPLC, fplc.SWITCH) == {}
    _plant(monkeypatch, fplc, "_switch", _switches_to_what_was_acknowledged)
    before, read, (after, _) = _broken(FPLC, fplc.SWITCH)["the F-PLC switches on a pair"]
    assert after.state == fplc.SETTLE
    assert before.selection == -1 or fplc.encode(fplc.SW, before.selection) != read.MW07


def _settles_at_once(s: fplc.State, i: fplc.Inputs, elapsed: int) -> fplc.State:
    return fplc.State(s.params, fplc.AWAIT_SELECTION, s.accepted, s.authority, s.selection, s.mode, 0)


def test_an_fplc_without_the_wait_for_zeros_breaks_its_guarantee(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _broken(FPLC, fplc.SETTLE) == {}
    _plant(monkeypatch, fplc, "_settle", _settles_at_once)
    before, read, (after, _) = _broken(FPLC, fplc.SETTLE)["the F-PLC offers after a key or over zeros"]
    assert after.state == fplc.AWAIT_SELECTION
    waited = before.elapsed_ms + read.dt_ms >= before.params.T_DWELL_ms
    assert not (waited and read.MW03 == 0 and read.MW07 == 0)


# ---------------------------------------------------------------- beside TLC's results


def test_every_property_of_the_whole_system_has_a_row() -> None:
    rows = agreement.rows()
    document = load_document(ROOT, "mode_selection")
    judged = {
        name
        for run in document.runs
        if run.module == "KeyFlows" and run.kind == "MC"
        for name in run.properties
        if name != "TypeOK"
    }
    assert judged <= {row.id for row in rows}
    assert len(rows) >= 50


def test_tlc_and_the_theorems_agree_property_by_property() -> None:
    """Where TLC says HOLDS the theorem is proved, or the row says why there is none."""
    by_name = {one.name: one for one in theorems_of("mode_selection")}
    for row in agreement.rows():
        assert row.tlc == "HOLDS"
        assert bool(row.theorem) != bool(row.reason)
        if row.theorem:
            assert _wrong(by_name[row.theorem]) == (), row
            assert row.id in by_name[row.theorem].properties


def test_exactly_these_properties_are_listed_as_not_proved() -> None:
    missing = {(row.id, row.environment) for row in agreement.rows() if not row.theorem}
    assert missing == {
        ("GoalReached", "honest"),
        ("NeverBeyondTheKey", "faulty_eks"),
        ("NoErrorWithoutFault", "honest"),
        ("GoalReachedAfterFault", "corrupting"),
        ("NothingButTheTouch", "corrupting"),
        ("RecoversFully", "corrupting"),
        ("RecoversFully", "faulty_eks"),
        ("RemovalLeadsToIdle", "honest"),
        ("SettleEnds", "honest"),
        ("UserIntent", "corrupting"),
    }


def test_a_proof_rests_on_assumptions_whose_break_fells_the_property() -> None:
    assert len(agreement.broken()) >= 10
    assert agreement.disagreements() == ()


def test_a_proof_that_forgets_an_assumption_disagrees_with_tlc() -> None:
    """The assumption stays where it is needed, and is said to stand in another row of the register."""
    forgetful = [
        dataclasses.replace(assumption, register=("A-19",))
        if assumption.name == "words arrive within the dwell time"
        else assumption
        for assumption in ASSUMPTIONS
    ]
    found = agreement.disagreements(argument=Argument(GUARANTEES, forgetful, ARGUMENT.proved))
    assert any(one.startswith("UserIntent (honest)") and "A-06" in one for one in found)
    assert all("TLC finds a counterexample (NEG_" in one for one in found)


def test_a_proof_covers_the_environments_of_which_it_assumes_nothing() -> None:
    environments = agreement.environments
    assert environments("one mode output") == {"honest", "corrupting", "faulty_eks"}
    assert environments(ZEROS) == {"honest", "faulty_eks"}
    assert environments("the mode is permitted by the key") == {"honest", "corrupting"}
    assert environments(INTENT) == {"honest"}
    assert environments(INTENT_ANYWAY) == {"honest", "faulty_eks"}


def test_a_property_without_formula_and_reason_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer = {name: one for name, one in agreement.FORMULA.items() if name != "UserIntent"}
    monkeypatch.setattr(agreement, "FORMULA", fewer)
    with pytest.raises(TheoremError, match="UserIntent: neither a formula"):
        agreement.rows()


def test_a_proof_that_does_not_cover_its_environment_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(agreement, "NOT_PROVED_IN", {})
    with pytest.raises(TheoremError, match="rests on what environment"):
        agreement.rows()

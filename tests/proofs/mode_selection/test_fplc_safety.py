"""The F-PLC's theorems are proved, what they rest on is needed, and each sees a fault in a copied step."""

from pathlib import Path
from typing import Any

import pytest
import z3

from proofs.mode_selection import every_device, fplc_invariant, fplc_order, fplc_prompt, fplc_safety
from proofs.mode_selection.devices import DEVICES, FPLC
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.invariants import FPLC_INVARIANT
from proofs.runner import prove_all
from proofs.sentences import Judge, Sentence
from proofs.solvers import ask_z3
from proofs.theorem import Theorem
from tests.any_machine import LONG_MS
from tests.proofs.planted_steps import begun_in, breaks, built, kept, planted, refuted

SAFETY = [
    value
    for module in (fplc_safety, fplc_prompt, fplc_order)
    for value in vars(module).values()
    if isinstance(value, Theorem)
]
QUICK = [
    fplc_invariant.the_invariant_of_the_fplc_is_true_at_power_up,
    every_device.every_device_is_safe_from_the_first_moment,
]


@pytest.mark.parametrize("item", QUICK, ids=lambda item: item.name)
def test_both_solvers_prove_what_is_said_of_power_up(item: Theorem, tmp_path: Path) -> None:
    (result,) = prove_all([item], tmp_path, lambda line: None, LONG_MS)
    assert (result.verdict, result.reason) == ("PROVED", "")


@pytest.mark.sampled(10)
@pytest.mark.parametrize("item", SAFETY, ids=lambda item: item.name)
def test_every_claim_holds_and_every_control_has_an_example(item: Theorem) -> None:
    queries, _ = built(item)
    assert item.properties
    assert {query.name for query in queries if query.name.startswith("control")}
    assert not [query.name for query in queries if ask_z3(query, "", LONG_MS).answer != query.expected]


def test_every_scan_keeps_the_invariant() -> None:
    queries = fplc_invariant.every_scan_of_the_fplc_keeps_its_invariant.queries()
    assert not [query.name for query in queries if ask_z3(query, "", LONG_MS).answer != query.expected]


@pytest.mark.deep
def test_the_examples_of_all_controls_happen_in_the_real_step() -> None:
    kept = [example for item in SAFETY for example in built(item)[1]]
    assert len(kept) >= len(SAFETY)
    for query, scans, sentence in kept:
        solver = z3.SimpleSolver()
        solver.add(*query.formulas.values())
        assert solver.check() == z3.sat, query.name
        assert breaks(scans, sentence, solver.model()), query.name


@pytest.mark.deep
def test_every_conjunct_of_the_invariant_is_needed_by_some_theorem() -> None:
    """The ranges are needed in another way: they are the premise under which the step is explored."""
    dropped = {
        name.name
        for item in SAFETY
        for query in built(item)[0]
        if query.name.startswith("control: without")
        for name in FPLC_INVARIANT
        if name.name in query.name
    }
    assert dropped == {one.name for one in FPLC_INVARIANT} - {"ValuesInRange"}


_state = JUDGE.after_a_scan
_kept = kept(JUDGE)
ANY_CODE = ("if not within_authority(s.params, s.authority, i.MW03):", "if echo(i.MW03) == ZERO:")
ANY_WORD = ("if i.MW03 != encode(SE, s.selection):", "if i.MW03 == ZERO:")
ANY_OUTPUT = ("if output != s.accepted:", "if output == NO_OUTPUT:")
A_SCAN_LATE = ("if elapsed >= s.params.T_SEQ_ms:", "if elapsed > s.params.T_SEQ_ms:")
EXPIRY_FIRST = """    if elapsed >= s.params.T_REM_ms:
        return _enter_error(s)  # DeadlineExpired: E-30
    if _no_key_and_zeros_returned(s, i, output, elapsed):
"""
SUCCESS_FIRST = "    if _no_key_and_zeros_returned(s, i, output, elapsed):\n"

FAULTS = [
    ("AtMostOneModeOutput", "Settle", _state(fplc_safety.at_most_one_mode_output), [("m == 1,", "m <= 1,")]),
    (
        "EchoIsTheSelection",
        "EchoSelection",
        _state(fplc_safety.echo_is_the_selection),
        [("MW05 = echo(encode(SE, s.selection))", "MW05 = echo(encode(SE, s.authority))")],
    ),
    (
        "WordsZeroWithoutKey",
        "Settle",
        _state(fplc_safety.words_zero_without_key),
        [
            ("elif c == AWAIT_SELECTION or", "elif c == CLEAR or c == AWAIT_SELECTION or"),
            ("_forget(s, CLEAR, 0)", "replace(_forget(s, CLEAR, 0), authority=s.authority)"),
        ],
    ),
    (
        "SelectionWithinAuthority",
        "CheckSelection",
        _state(fplc_safety.selection_within_authority),
        [ANY_CODE],
    ),
    (
        "ErrorDropsMode",
        "Idle",
        _state(fplc_safety.error_drops_mode),
        [('if s.params.ON_ERROR == "none":', 'if s.params.ON_ERROR == "hold":')],
    ),
    ("SwitchNeedsMatchingPair", "Switch", fplc_safety.switch_needs_matching_pair, [ANY_WORD]),
    ("AuthorizationRespected", "Switch", fplc_safety.authorization_respected, [ANY_OUTPUT]),
    (
        "AuthorizationByTheText",
        "Switch",
        fplc_safety.authorization_by_the_text,
        [("_enter_settle(s), mode=s.selection)", "_enter_settle(s), mode=0)")],
    ),
    (
        "NoChangeWithoutLA",
        "Switch",
        fplc_safety.no_change_without_la,
        [
            (
                "if not i.LA:\n        return _enter_clear",
                "if not i.LA and c != SWITCH:\n        return _enter_clear",
            )
        ],
    ),
    (
        "NoChangeBesideSwitchover",
        "Match",
        fplc_safety.no_change_beside_switchover,
        [("_enter(s, SETTLE), selection=NONE)", "_enter(s, SETTLE), selection=NONE, mode=s.selection)")],
    ),
    (
        "TwoOutputsLeadToError",
        "Clear",
        fplc_safety.two_outputs_lead_to_error,
        [("c != PULSE_ZEROS and _too_many", "c != PULSE_ZEROS and c != CLEAR and _too_many")],
    ),
    ("RemovalSeenAtOnce", "AwaitSelection", fplc_safety.removal_seen_at_once, [ANY_OUTPUT]),
    (
        "IdleOnlyOverZeros",
        "AwaitZeros",
        fplc_safety.idle_only_over_zeros,
        [("return output == NO_OUTPUT and _zeros", "return _zeros")],
    ),
    (
        "ErrorOnlyOverZeros",
        "Error",
        fplc_safety.error_only_over_zeros,
        [("i.MW03 == ZERO and i.MW07 == ZERO and elapsed", "i.MW03 == ZERO and elapsed")],
    ),
    ("SelectionNeedsLevel", "CheckSelection", fplc_safety.selection_needs_level, [ANY_CODE]),
    ("EchoNeedsSelection", "AwaitAcknowledgment", fplc_safety.echo_needs_selection, [ANY_WORD]),
    (
        "LevelNeedsPulse",
        "PulseOnes",
        fplc_safety.level_needs_pulse,
        [
            (
                "_forget(s, PULSE_ZEROS, elapsed)",
                "replace(_forget(s, AWAIT_SELECTION, 0), accepted=0, authority=0)",
            )
        ],
    ),
    ("NoWaitBeyondDeadline", "OneOutput", _state(fplc_safety.no_wait_beyond_deadline), [A_SCAN_LATE]),
    ("NoWaitBeyondDeadline", "AwaitZeros", fplc_safety.expiry_ends_the_wait, [(EXPIRY_FIRST, SUCCESS_FIRST)]),
    *(
        ("NoWaitBeyondDeadline", control, fplc_safety.expiry_ends_the_wait, [(deadline, "    if False:\n")])
        for control, deadline in (
            ("PulseOnes", "    if elapsed >= s.params.T_ON_ms:\n"),
            ("PulseZeros", "    if elapsed >= s.params.T_SEQ_ms:\n"),
            ("OneOutput", "    if elapsed >= s.params.T_SEQ_ms:\n"),
            ("Clear", "    if elapsed >= s.params.T_REM_ms:\n"),
            ("AwaitZeros", "    if elapsed >= s.params.T_REM_ms:\n"),
            ("Settle", "    if elapsed >= s.params.T_REM_ms:\n"),
        )
    ),
    (
        "OneSelectionWhereSet",
        "Switch",
        fplc_safety.one_selection_where_set,
        [('if s.params.SELECTIONS == "once":', 'if s.params.SELECTIONS == "again":')],
    ),
    (
        "OneSelectionWhereSet",
        "Complete",
        fplc_safety.one_selection_where_set,
        [("return s  # AwaitRemoval", "return _enter_settle(s)  # AwaitRemoval")],
    ),
    (
        "StuckWordIsReported",
        "Settle",
        _state(fplc_safety.stuck_word_is_reported),
        [("return _enter_error(s)  # DeadlineExpired: E-15", "return _wait(s, elapsed)")],
    ),
    ("SharedDeadlineHolds", "OneOutput", _state(fplc_safety.shared_deadline_holds), [A_SCAN_LATE]),
    ("OneTimeForThePulse", "PulseZeros", _state(fplc_safety.shared_deadline_holds), [A_SCAN_LATE]),
    (
        "RemovalTimerGoesOn",
        "Clear",
        fplc_safety.removal_timer_goes_on,
        [("_forget(s, AWAIT_ZEROS, elapsed)", "_forget(s, AWAIT_ZEROS, 0)")],
    ),
    (
        "NoNeedlessWait",
        "PulseZeros",
        fplc_prompt.no_needless_wait,
        [
            (
                "if output == NO_OUTPUT:\n        return _forget(s, ONE",
                "if output == NO_OUTPUT and elapsed > 0:\n        return _forget(s, ONE",
            )
        ],
    ),
    (
        "ErrorNeedsCause",
        "AwaitSelection",
        fplc_prompt.error_needs_cause,
        [
            (
                "if i.MW07 != ZERO:\n        return _enter_error(s)  # UnexpectedAcknowledgment\n",
                "if i.MW07 != ZERO or s.mode == NONE:\n        return _enter_error(s)\n",
            )
        ],
    ),
    (
        "RemovalNeedsCause",
        "AwaitSelection",
        fplc_prompt.removal_needs_cause,
        [("if output != s.accepted:", "if output != s.accepted or i.MW03 == ZERO:")],
    ),
    (
        "InsertionNeedsKey",
        "Idle",
        fplc_prompt.insertion_needs_key,
        [
            (
                "if i.LA:\n        return _enter(s, PULSE",
                "if i.LA or output == 0:\n        return _enter(s, PULSE",
            )
        ],
    ),
    (
        "NothingIsKept",
        "AwaitSelection",
        _state(fplc_prompt.nothing_is_kept),
        [("_forget(s, CLEAR, 0)", "replace(_forget(s, CLEAR, 0), accepted=s.accepted)")],
    ),
    (
        "StepsInOrder",
        "EchoSelection",
        fplc_order.steps_in_order,
        [("_enter(s, AWAIT_ACKNOWLEDGMENT)", "_enter(s, MATCH)")],
    ),
    (
        "TimeGoesOn",
        "AwaitZeros",
        fplc_order.time_goes_on,
        [("_wait(s, elapsed)  # AwaitReturnedZeros", "_wait(s, s.elapsed_ms)")],
    ),
    (
        "AcknowledgmentNeedsEcho",
        "EchoSelection",
        fplc_order.acknowledgment_needs_echo,
        [
            (
                "    if i.MW07 != ZERO:\n        return _enter_error(s)  # UnexpectedAcknowledgment: E-15\n"
                "    return _enter(s, AWAIT",
                "    return _enter(s, AWAIT",
            )
        ],
    ),
    (
        "ChangedSelectionIsWithdrawn",
        "Match",
        fplc_order.changed_selection_is_withdrawn,
        [
            (
                "return _enter_settle(s)  # WithdrawSelection\n",
                "return _enter_error(s) if i.MW03 == ZERO else _enter_settle(s)\n",
            )
        ],
    ),
    (
        "NoCodeIsReported",
        "Match",
        fplc_order.no_code_is_reported,
        [
            (
                "return _enter_error(s)  # RefuseSelection\n    return _enter_settle",
                "return s\n    return _enter_settle",
            )
        ],
    ),
    (
        "AcknowledgmentIsJudged",
        "CheckAcknowledgment",
        fplc_order.acknowledgment_is_judged,
        [("return _enter_error(s)  # RefuseAcknowledgment", "return _enter_settle(s)")],
    ),
    # what breaks no property in the scan itself breaks the invariant
    (
        "NoTimeWhereNoneRuns",
        "OneOutput",
        _kept,
        [("_forget(s, AUTHORIZE, 0)", "_forget(s, AUTHORIZE, elapsed)")],
    ),
    (
        "TimerIsTheTimeWaited",
        "PulseZeros",
        _kept,
        [("_forget(s, ONE_OUTPUT, elapsed)", "_forget(s, ONE_OUTPUT, 0)")],
    ),
    (
        "PulseWasSeen",
        "PulseZeros",
        _kept,
        [
            (
                "== NO_OUTPUT:\n        return _forget(s, ONE",
                "!= ALL_OUTPUTS:\n        return _forget(s, ONE",
            )
        ],
    ),
    (
        "NothingWithoutKey",
        "Error",
        _kept,
        [("_forget(s, IDLE, 0)", "replace(_forget(s, IDLE, 0), accepted=0)")],
    ),
    (
        "ZerosWereSeen",
        "Settle",
        _kept,
        [("return i.MW03 == ZERO and i.MW07 == ZERO and elapsed", "return elapsed")],
    ),
    (
        "SelectionWasSeen",
        "CheckSelection",
        _kept,
        [("    selection = decode(SE, i.MW03)\n", "    selection = 0\n")],
    ),
    (
        "EchoWasSeen",
        "EchoSelection",
        _kept,
        [("_enter(s, AWAIT_ACKNOWLEDGMENT)", "_enter(s, CHECK_ACKNOWLEDGMENT)")],
    ),
    (
        "OneOutputAccepted",
        "OneOutput",
        _kept,
        [("accepted=output)", "accepted=NONE)")],
    ),
    (
        "ValuesInRange",
        "OneOutput",
        _kept,
        [("accepted=output)", "accepted=5)")],
    ),
]


@pytest.mark.sampled(10)
@pytest.mark.parametrize(
    ("name", "control", "sentence", "edits"), FAULTS, ids=lambda scan: scan if isinstance(scan, str) else ""
)
def test_a_planted_fault_is_refuted_with_an_example_that_happens(
    name: str, control: str, sentence: Sentence, edits: list[tuple[str, str]]
) -> None:
    with planted(FPLC, *edits) as device:
        scan = begun_in(device, control)
        judge = Judge(device, FPLC_INVARIANT, JUDGE.seen, JUDGE.sees, JUDGE.nothing, (scan,))
        assert refuted(judge, sentence, control)
    assert not refuted(JUDGE, sentence, control) or name == "AuthorizationByTheText"


def test_every_property_that_an_fplc_theorem_names_has_a_fault() -> None:
    named = {name for item in SAFETY for name in item.properties}
    assert named <= {name for name, *_ in FAULTS}
    assert {one.name for one in FPLC_INVARIANT} - named <= {name for name, *_ in FAULTS} | {
        "AuthorityIsTheAcceptedLevel",
        "SelectionIsPermitted",
        "SelectionOnlyInATransaction",
        "ErrorDropsTheModeWhereSet",
    }


POWER_UP = {
    "fplc": ("mode=NONE, elapsed_ms=0)", "mode=0, elapsed_ms=0)"),
    "plc": ("ZERO, ZERO, ZERO, ZERO)", "ZERO, 0x0FF0, ZERO, ZERO)"),
    "hmi": ("Step.INHIBITED, NONE, NONE)", "Step.SELECT, 0, NONE)"),
    "eks": ("Step.EMPTY, NO_KEY, 0)", "Step.TEST_ONES, NO_KEY, 0)"),
}


@pytest.mark.parametrize("device", DEVICES, ids=lambda device: device.name)
def test_a_device_that_wakes_up_otherwise_is_seen(device: Any) -> None:
    with planted(device, POWER_UP[device.name]) as other:
        claims = [*Judge(other, ()).at_power_up(every_device.SAFE[device.name])]
        assert ask_z3(claims[0], "", LONG_MS).answer == "sat"

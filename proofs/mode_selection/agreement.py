"""Each property of the whole system with TLC's verdict and ours, side by side; none is left out.

TLC's rows are read from runs.toml: every run of the whole system that must hold, with our reading of the
note, and every run that breaks an assumption. Which environments a proof covers is computed from what it
rests on: where it assumes nothing of words, it holds with any words (`corrupting`); where nothing of the
wires from the EKS but that one is broken, with faults there (`faulty_eks`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from modeproof.registers import Document, Run, load_document
from proofs.mode_selection import composition_system as system
from proofs.mode_selection.composition import (
    ARGUMENT,
    GOES_IN,
    INTENT,
    INTENT_ANYWAY,
    NOTICED,
    ONLY_BY_SWITCHING,
    OUTPUTS_WIRED,
    WIRED,
    WITHIN_KEY,
    ZEROS,
)
from proofs.mode_selection.composition_argument import Argument
from proofs.mode_selection.composition_guarantees import Guarantee
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC, ROOT
from proofs.theorem import TheoremError

FORMULA: Final[Mapping[str, str]] = {
    "AtMostOneModeOutput": "one mode output",
    "OneOutputOutsideThePulse": "one output outside the pulse",
    "NoOutputWithoutLA": "no output without LA",
    "EchoIsTheSelection": "the echo is the selection",
    "WordsZeroWithoutKey": "words zero without key",
    "SelectionWithinAuthority": "selection within authority",
    "SelectionWithinOffer": "selection within offer",
    "InhibitedSendsZeros": "inhibited sends zeros",
    "EchoIsTheTouch": "the echo is the touch",
    "IdleMeansZeros": ZEROS,
    "DisplayIsTheMode": "the panel displays the mode",
    "SwitchNeedsMatchingPair": "the pair",
    "AuthorizationRespected": WITHIN_KEY,
    "NeverBeyondTheKey": WITHIN_KEY,
    "NoChangeWithoutLA": "with LA",
    "NoChangeBesideSwitchover": ONLY_BY_SWITCHING,
    "UserIntent": INTENT,
    "NothingButTheTouch": "nothing but the touch",
    "NoWordIsRefused": "no word is refused",
    "NoOfferBeyondTheLevel": "no offer beyond the level",
    "RefinesModeSelection": "the contract",
}
"""Each property of properties.toml that is proved here, with the formula that says it."""

FORMULA_IN: Final[Mapping[tuple[str, str], tuple[str, str]]] = {
    ("SwitchNeedsMatchingPair", "corrupting"): (
        "the pair read",
        "of the words that the F-PLC reads, whoever wrote them, with any number of faults; TLC speaks of the"
        " words that stand, with one fault (A-32)",
    ),
    ("UserIntent", "faulty_eks"): (INTENT_ANYWAY, ""),
}
"""Where another formula says it in an environment, and what is then said otherwise than TLC says it."""

MUST_HOLD: Final[Mapping[str, str]] = {"MC": "HOLDS", "LIVE": "HOLDS"}
"""Kinds of runs that must hold, with TLC's verdict on them."""
OF_A_DEVICE: Final[Mapping[str, str]] = {
    "LAOnlyForAcceptedKeys": "the_eks_sets_la_only_for_an_accepted_key",
}
"""Properties of one device's memory, with the theorem on that device alone."""
SOUND: Final[Mapping[str, tuple[str, ...]]] = {
    FPLC.name: ("A-18",),
    HMI.name: ("A-13", "A-23"),
    PLC.name: ("A-12",),
    EKS.name: (),
}
"""What it means of a device, in assumptions.toml, that it is refimpl's."""
POWER_UP: Final = "A-19"
"""Every step is a scan or the user's: no device starts again by itself."""
LIVENESS: Final = "something must happen: that needs fairness and a measure that shrinks; TLC alone"
BELOW_DISTANCE: Final = (
    "with any words it is false; TLC tries one word that turns into no code, which a proof has yet to follow"
)
NOT_PROVED: Final[Mapping[str, str]] = {
    "GoalReached": LIVENESS,
    "GoalReachedAfterFault": LIVENESS,
    "RemovalLeadsToIdle": LIVENESS,
    "SettleEnds": LIVENESS,
    "RecoversFully": LIVENESS,
    "NoErrorWithoutFault": "it needs all devices to keep their deadlines (A-08, A-09), and time has no"
    " durations here; proved of it is that no word is refused",
}
NOT_PROVED_IN: Final[Mapping[tuple[str, str], str]] = {
    (
        "NeverBeyondTheKey",
        "faulty_eks",
    ): "it rests on the test pulse and on A-31 (slow users)",
    ("UserIntent", "corrupting"): BELOW_DISTANCE,
    ("NothingButTheTouch", "corrupting"): BELOW_DISTANCE,
}


@dataclass(frozen=True)
class Row:
    """One property in one environment.

    theorem: what proves it, or "". reason: why nothing does. note: what the theorem says otherwise than TLC.
    rests_on: assumptions of the register.
    """

    id: str
    environment: str
    runs: tuple[str, ...]
    tlc: str
    theorem: str
    rests_on: tuple[str, ...]
    reason: str
    note: str = ""


def rows(document: Document | None = None, argument: Argument = ARGUMENT) -> tuple[Row, ...]:
    """A row for each property and environment that a run of the whole system judges, in the register's order.

    Raises TheoremError for a property that has neither a formula nor a reason.
    """
    known = document or load_document(ROOT, "mode_selection")
    ids = [known_property.id for known_property in known.properties]
    judged: dict[tuple[str, str], list[Run]] = {}
    for run in known.runs:
        if run.module.startswith("KeyFlows") and run.kind in MUST_HOLD and not run.readings:
            for name in run.properties:
                if name in ids:
                    judged.setdefault((name, run.environment), []).append(run)
    order = sorted(judged, key=lambda key: (ids.index(key[0]), key[1]))
    return tuple(_row(name, environment, judged[name, environment], argument) for name, environment in order)


def _row(name: str, environment: str, runs: list[Run], argument: Argument) -> Row:
    tlc = MUST_HOLD[runs[0].kind]
    names = tuple(run.id for run in runs)
    if name in OF_A_DEVICE:
        return Row(name, environment, names, tlc, OF_A_DEVICE[name], (POWER_UP,), "")
    reason = NOT_PROVED.get(name, "") or NOT_PROVED_IN.get((name, environment), "")
    formula, note = FORMULA_IN.get((name, environment), (FORMULA.get(name, ""), ""))
    if not reason and not formula:
        raise TheoremError(f"{name}: neither a formula proves it nor a reason says why none does")
    if reason:
        return Row(name, environment, names, tlc, "", (), reason)
    if environment not in environments(formula, argument):
        raise TheoremError(f"{name}: {formula!r} rests on what environment {environment} does not keep")
    theorem = next(invariant.theorem for invariant in argument.proved if invariant.name == formula)
    return Row(name, environment, names, tlc, theorem, register_of(formula, argument), "", note)


def environments(formula: str, argument: Argument = ARGUMENT) -> frozenset[str]:
    """The environments in which a proved formula holds, by what it rests on."""
    rests_on = argument.rests_on(formula)
    found = {"honest"}
    if WIRED not in rests_on:
        found.add("corrupting")
    if not {OUTPUTS_WIRED, GOES_IN, NOTICED} & set(rests_on):
        found.add("faulty_eks")
    return frozenset(found)


def register_of(formula: str, argument: Argument = ARGUMENT) -> tuple[str, ...]:
    """The assumptions and findings of the registers that a proved formula rests on."""
    found: set[str] = set()
    for name in (formula, *argument.rests_on(formula)):
        premise = argument.premises[name]
        if isinstance(premise, system.Assumption):
            found.update(premise.register)
        elif isinstance(premise, Guarantee):
            found.update((*SOUND[premise.device.name], POWER_UP))
    return tuple(sorted(found))


def broken(document: Document | None = None) -> tuple[tuple[str, Run], ...]:
    """Where TLC finds that a property falls when an assumption breaks: the assumption, and the run."""
    known = document or load_document(ROOT, "mode_selection")
    runs = {run.id: run for run in known.runs}
    return tuple(
        (assumption.id, runs[name])
        for assumption in known.assumptions
        for name in assumption.breaks
        if runs[name].module.startswith("KeyFlows") and runs[name].property in FORMULA
    )


def disagreements(document: Document | None = None, argument: Argument = ARGUMENT) -> tuple[str, ...]:
    """One line for each theorem that does not rest on an assumption without which TLC finds that it is false.

    A theorem that says something else than TLC in this environment is left out: its note says what.
    """
    proved = {(row.id, row.environment): row for row in rows(document, argument) if row.theorem}
    found = []
    for assumption, run in broken(document):
        row = proved.get((run.property, run.environment))
        if row is not None and not row.note and assumption not in row.rests_on:
            found.append(
                f"{row.id} ({row.environment}): {row.theorem} does not rest on {assumption}, and without that"
                f" TLC finds a counterexample ({run.id})"
            )
    return tuple(found)

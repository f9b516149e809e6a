"""Inductive invariants of the devices: what is true after every scan, whatever the inputs were.

`FPLC_INVARIANT` holds in every reachable state of the F-PLC in the environment `arbitrary`: any LA and
outputs, all 65,536 words in MW03 and MW07, any elapsed time, all parameters that the code accepts. Each
conjunct is a sentence and a formula over the memory (`s`), the parameters (`p`) and what an observer of the
wires has seen (`seen`, observer.py). In words: no level, output or selection is kept while no key is
accepted; from Authorize on there is an accepted output, and the authority is its level; a selection is kept
only while a transaction runs, or after its one switchover, and the machine permits it to that level; and what
the F-PLC relies on was really on the wires in this insertion. Every conjunct is needed: a control of some
theorem drops it.

The panel and the EKS have one each below, the PLC needs none. For other proofs:
`Judge.known` is the whole as one formula, `conjuncts(..)` the same by name. That
they are true at power-up and after every scan are theorems of fplc_invariant.py, panel_safety.py and
eks_safety.py.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import TRUE
from proofs.explorer.invariant import Conjunct
from proofs.mode_selection.devices import KEY_ID_MAX
from proofs.mode_selection.observer import INSERTION, REMOVAL, SETTLING, Seen
from proofs.mode_selection.ranges import codes
from proofs.mode_selection.vocabulary import NONE, is_mode, permits
from proofs.words import one_of

TRANSACTION: Final = frozenset(
    {"EchoSelection", "AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch"}
)
AUTHORIZED: Final = TRANSACTION | {"AwaitSelection", "CheckSelection"}
CHOSEN: Final = TRANSACTION | {"Complete"}
"""The states in which a selection is kept."""
HOLDING: Final = AUTHORIZED | CHOSEN | {"Authorize", "Settle"}
"""The states in which one output is accepted."""
CLOCKED: Final = INSERTION | REMOVAL | SETTLING | {"Start", "Error"}
"""The states in which time is counted."""
ON_ERROR_NONE: Final = 1
"""The value "none" of ON_ERROR in terms: its place in interface.toml."""
ONCE: Final = 1
"""The value "once" of SELECTIONS in terms: its place in interface.toml."""

# ---------------------------------------------------------------- F-PLC


def _values_in_range(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    modes = (s.accepted, s.authority, s.selection, s.mode)
    return z3.And(s.elapsed_ms >= 0, *[z3.And(mode >= NONE, mode <= 4) for mode in modes])


def _nothing_without_key(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in HOLDING:
        return TRUE
    return z3.And(s.accepted == NONE, s.authority == NONE, s.selection == NONE)


def _one_output_accepted(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return is_mode(s.accepted) if c in HOLDING else TRUE


def _authority_is_the_accepted_level(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c not in HOLDING:
        return TRUE
    return s.authority == (NONE if c == "Authorize" else s.accepted)


def _selection_only_in_a_transaction(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return s.selection == NONE if c in HOLDING - CHOSEN else TRUE


def _selection_is_permitted(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return permits(p, s.authority, s.selection) if c in CHOSEN else TRUE


def _one_selection_where_set(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.And(p.SELECTIONS == ONCE, s.mode == s.selection) if c == "Complete" else TRUE


def _error_drops_the_mode_where_set(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.Implies(p.ON_ERROR == ON_ERROR_NONE, s.mode == NONE) if c == "Error" else TRUE


def _pulse_was_seen(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c == "PulseZeros":
        return seen.pulse == 1
    return seen.pulse == 2 if c in HOLDING or c == "OneOutput" else TRUE


def _zeros_were_seen(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return seen.cleared if c in AUTHORIZED else TRUE


def _selection_was_seen(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return seen.selected == s.selection if c in TRANSACTION else TRUE


def _echo_was_seen(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return seen.echoed if c in ("CheckAcknowledgment", "Match", "Switch") else TRUE


def _timer_is_the_time_waited(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    timed = INSERTION | REMOVAL | SETTLING
    return seen.waited == s.elapsed_ms if c in timed else TRUE


def _no_time_where_none_runs(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return TRUE if c in CLOCKED else s.elapsed_ms == 0


FPLC_INVARIANT: Final = (
    Conjunct(
        "ValuesInRange", "Levels and modes are 0 to 4 or none, times are not negative.", _values_in_range
    ),
    Conjunct(
        "NothingWithoutKey",
        "Before an output is accepted, in the removal and in the error mode no output, level or selection is "
        "kept.",
        _nothing_without_key,
    ),
    Conjunct("OneOutputAccepted", "From Authorize to Settle one output is accepted.", _one_output_accepted),
    Conjunct(
        "AuthorityIsTheAcceptedLevel",
        "The authority is the level of the accepted output; in Authorize there is none yet.",
        _authority_is_the_accepted_level,
    ),
    Conjunct(
        "SelectionOnlyInATransaction",
        "Outside EchoSelection to Complete no selection is kept.",
        _selection_only_in_a_transaction,
    ),
    Conjunct(
        "SelectionIsPermitted",
        "A kept selection is one that the machine permits to the authority.",
        _selection_is_permitted,
    ),
    Conjunct(
        "OneSelectionWhereSet",
        "Complete is there with SELECTIONS = once alone, and the kept selection is the active mode.",
        _one_selection_where_set,
    ),
    Conjunct(
        "ErrorDropsTheModeWhereSet",
        "With ON_ERROR = none no mode is active in Error.",
        _error_drops_the_mode_where_set,
    ),
    Conjunct(
        "PulseWasSeen",
        "In PulseZeros all outputs were seen in this insertion; from OneOutput on also none after all.",
        _pulse_was_seen,
    ),
    Conjunct(
        "ZerosWereSeen",
        "From AwaitSelection to Switch both words were zero beside LA and one output, since the last echo.",
        _zeros_were_seen,
    ),
    Conjunct(
        "SelectionWasSeen",
        "The kept selection stood in MW03 after those zeros, while MW07 was still zero.",
        _selection_was_seen,
    ),
    Conjunct("EchoWasSeen", "From CheckAcknowledgment on MW05 has shown it.", _echo_was_seen),
    Conjunct(
        "TimerIsTheTimeWaited",
        "In the insertion, in the removal and in Settle the timer is the time since it began.",
        _timer_is_the_time_waited,
    ),
    Conjunct(
        "NoTimeWhereNoneRuns", "In a state that counts no time the timer is zero.", _no_time_where_none_runs
    ),
)


# ---------------------------------------------------------------- panel

PENDING: Final = frozenset({"AwaitEcho", "Confirm", "AwaitSwitch"})
"""The states of the panel in which a selection is sent."""


def _panel_values_in_range(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return z3.And(*[z3.And(mode >= NONE, mode <= 4) for mode in (s.offered, s.selection)])


def _selection_is_offered(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return permits(p, s.offered, s.selection) if c in PENDING else s.selection == NONE


def _open_at_a_level(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return s.offered == NONE if c == "Inhibited" else is_mode(s.offered)


HMI_INVARIANT: Final = (
    Conjunct(
        "ValuesInRange", "The level offered and the selection are 0 to 4 or none.", _panel_values_in_range
    ),
    Conjunct(
        "SelectionIsOffered",
        "A selection is kept only while it is sent, and is one that the machine permits to the level with "
        "which the screen was opened.",
        _selection_is_offered,
    ),
    Conjunct(
        "OpenAtALevel", "A level is offered exactly while the screen is not inhibited.", _open_at_a_level
    ),
)

# ---------------------------------------------------------------- EKS

SIGNALLING: Final = frozenset({"StartTest", "TestOnes", "TestZeros", "Signal"})
"""The states of the EKS in which LA is on."""
WORKING: Final = SIGNALLING | {"Read", "CheckChecksum", "CheckLevel", "SetLA", "Rejected"}
"""The states of the EKS in which a key is in the reader."""
REMEMBERING: Final = WORKING | {"ClearOutputs"}
"""The states of the EKS in which a key is in memory."""


def no_key(key: Any) -> z3.BoolRef:
    """The memory (in terms) is that of no key: zeros everywhere."""
    words = (key.operating_state, key.authorization_level, key.access_code, key.KEYCRC, key.KeyID)
    return z3.And(*[word == 0 for word in words])


def key_accepted(p: Any, key: Any) -> z3.BoolRef:
    """Operating state, access code and level of a key (in terms) are right. EKS-KS-2 to EKS-KS-5, E-48"""
    code_fits = z3.If(
        p.operating_state == 6, key.access_code == p.dip_switches, key.access_code & p.dip_switches != 0
    )
    ten_bits = z3.ULE(key.access_code, 0x3FF)
    level = one_of(key.authorization_level, codes("RE"))
    return z3.And(key.operating_state == p.operating_state, ten_bits, code_fits, level)


def _checksum_was_right(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return seen.agrees if c in SIGNALLING | {"CheckLevel", "SetLA"} else TRUE


def _key_was_accepted(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return key_accepted(p, s.key) if c in SIGNALLING | {"SetLA"} else TRUE


def _timer_is_the_time_of_this_half(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return seen.lasted == s.elapsed_ms if c in ("TestOnes", "TestZeros") else TRUE


def _key_in_range(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    number = z3.And(s.key.KeyID >= 0, s.key.KeyID <= KEY_ID_MAX)
    return z3.And(s.elapsed_ms >= 0, z3.ULE(s.key.operating_state, 0xFF), number)


def _key_is_forgotten(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return TRUE if c in REMEMBERING else no_key(s.key)


def _pulse_alone_takes_time(c: str, s: Any, p: Any, seen: Any) -> z3.BoolRef:
    return TRUE if c in ("TestOnes", "TestZeros") else s.elapsed_ms == 0


EKS_INVARIANT: Final = (
    Conjunct("ValuesInRange", "The key in memory is one that fits into 15 bytes.", _key_in_range),
    Conjunct(
        "ChecksumWasRight", "From CheckLevel to Signal the checksum agrees with the key.", _checksum_was_right
    ),
    Conjunct(
        "KeyWasAccepted",
        "From SetLA to Signal the key in memory has the right operating state and access code and a level.",
        _key_was_accepted,
    ),
    Conjunct(
        "TimerIsTheTimeOfThisHalf",
        "In the test pulse the timer is the time for which the outputs have stood.",
        _timer_is_the_time_of_this_half,
    ),
    Conjunct("KeyIsForgotten", "In Empty, CheckRegisters and Fault no key is in memory.", _key_is_forgotten),
    Conjunct("PulseAloneTakesTime", "Outside the test pulse the timer is zero.", _pulse_alone_takes_time),
)

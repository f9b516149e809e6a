"""The inductive invariant of the block: true before the first call, and after every call.

Each conjunct is a sentence and a formula over the memory (`s`), the parameters (`p`) and what an observer of
the wires has seen (`seen`, observer.py). Every conjunct is needed: a control of some theorem drops it.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.enable_switch.devices import SWITCH
from proofs.enable_switch.observer import NOTHING, SEEN, Seen, sees
from proofs.enable_switch.vocabulary import ERRORS, NONE, TIMED
from proofs.explorer.invariant import Conjunct
from proofs.sentences import Judge

LAST: Final = {
    "Stage0": (0,),
    "ChangeToStage1": (0,),
    "Stage1": (1,),
    "Stage2": (2,),
    "ChangeToStage0": (1, 2),
}
"""The last stage that was seen, by state; none in every other."""


def _last_stage_is_known(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.Or(*[seen.last_stage == stage for stage in LAST.get(c, (NONE,))])


def _disagreement_is_timed(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in ERRORS:
        return seen.apart >= NONE
    return z3.And(seen.apart >= NONE, seen.apart <= (s.elapsed_ms if c in TIMED else NONE))


def _contradiction_is_timed(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in ERRORS:
        return seen.contrary >= NONE
    return z3.And(seen.contrary >= NONE, seen.contrary <= (s.elapsed_ms if c in TIMED else NONE))


def _reset_is_remembered(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    remembered: z3.BoolRef = s.reset_before == seen.last_reset
    return remembered


INVARIANT: Final = (
    Conjunct(
        "LastStageIsKnown",
        "the state says which stage was seen last in this run of the mode",
        _last_stage_is_known,
    ),
    Conjunct(
        "DisagreementIsTimed",
        "channels 1 and 3 have not differed for longer than the timer has run",
        _disagreement_is_timed,
    ),
    Conjunct(
        "ContradictionIsTimed",
        "the three channels have not been TRUE together for longer than the timer has run",
        _contradiction_is_timed,
    ),
    Conjunct(
        "ResetIsRemembered",
        "the block remembers Reset of the call before, whether it was active in it or not",
        _reset_is_remembered,
    ),
)
JUDGE: Final = Judge(SWITCH, INVARIANT, SEEN, sees, NOTHING)

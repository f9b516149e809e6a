"""The fail-safe PLC: it accepts a key, checks what the panel selected, shows it back, and switches the mode.

Covers the F-PLC's steps of the insert flow (6-12, 17-20, 27-29, with Figures 3 to 7) and of the remove flow
(3, 6, 11-14, 18, with Figure 9). One call of ``step`` is one scan: the elapsed time is added, the guards are
judged, at most one numbered step is taken, and the outputs are those of the state after the scan (EKS-GP-3).
A name at the start of a comment, such as "SeeOnes", is the step as spec/mode_selection/interface.toml calls
it.

All decisions stand on this scan's inputs and on private memory; MW01 and MW05 are only written and never read
back (E-18).
"""

# ruff: noqa: SIM109, SIM300 -- the names of words are upper case, and each comparison is one of the note's
from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from refimpl.errors import ParameterError, StateError, check_bool, check_int, check_text, check_word
from refimpl.mode_selection.code_tables import CH, NONE, RE, SE, SW, ZERO, decode, encode
from refimpl.mode_selection.permissions import (
    UP_TO_0,
    UP_TO_1,
    UP_TO_2,
    UP_TO_3,
    UP_TO_4,
    check_permits,
    is_among,
    permitted_modes,
)

# What the five EKS outputs say, besides a level 0..4 when exactly one is set.
NO_OUTPUT = NONE
SEVERAL_OUTPUTS = 5
ALL_OUTPUTS = 6

T_MAX_MS = 3_600_000


class Step(Enum):
    """The control state: each is named after the step that is executed next. EKS-GP-3"""

    START = "Start"
    IDLE = "Idle"
    PULSE_ONES = "PulseOnes"
    PULSE_ZEROS = "PulseZeros"
    ONE_OUTPUT = "OneOutput"
    AUTHORIZE = "Authorize"
    AWAIT_SELECTION = "AwaitSelection"
    CHECK_SELECTION = "CheckSelection"
    ECHO_SELECTION = "EchoSelection"
    AWAIT_ACKNOWLEDGMENT = "AwaitAcknowledgment"
    CHECK_ACKNOWLEDGMENT = "CheckAcknowledgment"
    MATCH = "Match"
    SWITCH = "Switch"
    COMPLETE = "Complete"
    SETTLE = "Settle"
    CLEAR = "Clear"
    AWAIT_ZEROS = "AwaitZeros"
    ERROR = "Error"


START = Step.START
IDLE = Step.IDLE
PULSE_ONES = Step.PULSE_ONES
PULSE_ZEROS = Step.PULSE_ZEROS
ONE_OUTPUT = Step.ONE_OUTPUT
AUTHORIZE = Step.AUTHORIZE
AWAIT_SELECTION = Step.AWAIT_SELECTION
CHECK_SELECTION = Step.CHECK_SELECTION
ECHO_SELECTION = Step.ECHO_SELECTION
AWAIT_ACKNOWLEDGMENT = Step.AWAIT_ACKNOWLEDGMENT
CHECK_ACKNOWLEDGMENT = Step.CHECK_ACKNOWLEDGMENT
MATCH = Step.MATCH
SWITCH = Step.SWITCH
COMPLETE = Step.COMPLETE
SETTLE = Step.SETTLE
CLEAR = Step.CLEAR
AWAIT_ZEROS = Step.AWAIT_ZEROS
ERROR = Step.ERROR


@dataclass(frozen=True, slots=True)
class Params:
    """Times in milliseconds, what Error does to the active mode, and what a level permits.

    T_ON_ms: deadline from LA to all outputs set (EKS-2-6). T_SEQ_ms: deadline of the sequence up to the one
    output (EKS-4-2). T_SEQ_FROM: it counts from "LA", and is then at least T_ON_ms, or anew from all "ones"
    (E-38). T_REM_ms: deadline of the removal (EKS-8-3) and of Settle (E-15). T_DWELL_ms: least time
    before zeros count as returned (E-52); less than T_REM_ms. ON_ERROR: "hold" the mode or set "none" (E-24).
    SELECTIONS: after a switchover "again" another one with the same key, or "once" for each insertion (E-15).
    PERMITS_0 to PERMITS_4: the modes that a level permits, itself and none above it (E-47). Raises
    ParameterError.
    """

    T_ON_ms: int = 1000
    T_SEQ_ms: int = 1000
    T_SEQ_FROM: str = "ones"
    T_REM_ms: int = 1000
    T_DWELL_ms: int = 0
    ON_ERROR: str = "hold"
    SELECTIONS: str = "once"
    PERMITS_0: tuple[bool, bool, bool, bool, bool] = UP_TO_0
    PERMITS_1: tuple[bool, bool, bool, bool, bool] = UP_TO_1
    PERMITS_2: tuple[bool, bool, bool, bool, bool] = UP_TO_2
    PERMITS_3: tuple[bool, bool, bool, bool, bool] = UP_TO_3
    PERMITS_4: tuple[bool, bool, bool, bool, bool] = UP_TO_4

    def __post_init__(self) -> None:
        check_int("T_ON_ms", self.T_ON_ms, 1, T_MAX_MS, ParameterError)
        check_int("T_SEQ_ms", self.T_SEQ_ms, 1, T_MAX_MS, ParameterError)
        check_text("T_SEQ_FROM", self.T_SEQ_FROM, ("LA", "ones"), ParameterError)
        check_int("T_REM_ms", self.T_REM_ms, 1, T_MAX_MS, ParameterError)
        check_int("T_DWELL_ms", self.T_DWELL_ms, 0, T_MAX_MS, ParameterError)
        check_text("ON_ERROR", self.ON_ERROR, ("hold", "none"), ParameterError)
        check_text("SELECTIONS", self.SELECTIONS, ("again", "once"), ParameterError)
        check_permits("PERMITS_0", self.PERMITS_0, 0)
        check_permits("PERMITS_1", self.PERMITS_1, 1)
        check_permits("PERMITS_2", self.PERMITS_2, 2)
        check_permits("PERMITS_3", self.PERMITS_3, 3)
        check_permits("PERMITS_4", self.PERMITS_4, 4)
        if self.T_SEQ_FROM == "LA" and self.T_SEQ_ms < self.T_ON_ms:
            expected = f"at least T_ON_ms ({self.T_ON_ms}), as T_SEQ_FROM is 'LA'"
            raise ParameterError("T_SEQ_ms", self.T_SEQ_ms, expected)
        if self.T_DWELL_ms >= self.T_REM_ms:
            raise ParameterError("T_DWELL_ms", self.T_DWELL_ms, f"less than T_REM_ms ({self.T_REM_ms})")


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the F-PLC between two scans. Modes and levels are 0..4, or -1 for none.

    ``accepted`` is the one EKS output accepted in this insertion, as its level; ``authority`` the level
    published for it; ``selection`` the mode latched from MW03 (E-16); ``mode`` the active mode;
    ``elapsed_ms`` the time since the timer of this state was started.
    """

    params: Params
    state: Step
    accepted: int
    authority: int
    selection: int
    mode: int
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan reads. Building it checks every field and raises InputError; nothing is coerced.

    ``dt_ms``: time since the previous scan, >= 0. ``LA``: switching channel LA (FI1). ``A``..``STR``: the
    five EKS outputs. ``MW03``, ``MW07``: flag words 0..65535 from the PLC, sampled once.
    """

    dt_ms: int
    LA: bool
    A: bool
    B: bool
    C: bool
    D: bool
    STR: bool
    MW03: int
    MW07: int

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("LA", self.LA)
        check_bool("A", self.A)
        check_bool("B", self.B)
        check_bool("C", self.C)
        check_bool("D", self.D)
        check_bool("STR", self.STR)
        check_word("MW03", self.MW03)
        check_word("MW07", self.MW07)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one scan writes: two flag words, one output for each mode, and the error signal."""

    MW01: int
    MW05: int
    MSO_0: bool
    MSO_1: bool
    MSO_2: bool
    MSO_3: bool
    MSO_4: bool
    ERROR: bool


def power_up(params: Params) -> State:
    """The state after power-up: no mode, no key, and no zeros seen yet. E-25c"""
    return State(params, START, accepted=NONE, authority=NONE, selection=NONE, mode=NONE, elapsed_ms=0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan: the state after it, and the outputs of that state. EKS-GP-2-FPLC, EKS-GP-3"""
    after = _next_state(state, inputs, output_signalled(inputs), state.elapsed_ms + inputs.dt_ms)
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The row of outputs that belongs to a state.

    MW01 carries the authorization level from the end of step 12 until the switchover, removal or error
    (EKS-2-12, EKS-8-6); zero is the word of no key (EKS-KS-8). It is zero in Settle too, so that the panel
    closes and a quick next touch cannot overtake the return to zero (E-59).
    MW05 carries the echo from step 20 until the switchover (Figure 6, from the latched selection), and is
    zeroed in the same scan as MW01 on removal (EKS-2-20, E-27). With one selection for each insertion both
    stay as they are after the switchover (E-15). The mode outputs are one of five, none before
    the first switchover; removal does not touch them (EKS-2-29, EKS-8-8). ERROR is the one error mode (E-22).
    """
    c = s.state
    MW01 = ZERO
    MW05 = ZERO
    if c == AWAIT_ACKNOWLEDGMENT or c == CHECK_ACKNOWLEDGMENT or c == MATCH or c == SWITCH or c == COMPLETE:
        MW01 = encode(RE, s.authority)
        MW05 = echo(encode(SE, s.selection))
    elif c == AWAIT_SELECTION or c == CHECK_SELECTION or c == ECHO_SELECTION:
        MW01 = encode(RE, s.authority)
    m = s.mode
    return Outputs(MW01, MW05, m == 0, m == 1, m == 2, m == 3, m == 4, c == ERROR)


# ---------------------------------------------------------------- what the inputs say


def output_signalled(i: Inputs) -> int:
    """The EKS outputs as one number: level 0..4 when exactly one is set, else none, several or all five.

    EKS-2-11, EKS-KS-5, EKS-T2; STR counts like the other four (E-06b); output D, not C, is level 3 (E-02).
    """
    if i.A:
        if i.B and i.C and i.D and i.STR:
            return ALL_OUTPUTS
        if i.B or i.C or i.D or i.STR:
            return SEVERAL_OUTPUTS
        return 0
    if i.B:
        if i.C or i.D or i.STR:
            return SEVERAL_OUTPUTS
        return 1
    if i.C:
        if i.D or i.STR:
            return SEVERAL_OUTPUTS
        return 2
    if i.D:
        if i.STR:
            return SEVERAL_OUTPUTS
        return 3
    if i.STR:
        return 4
    return NO_OUTPUT


def permitted(MW01: int, MW03: int) -> bool:
    """Figure 5: whether the level in MW01 permits the selection in MW03.

    True is row EKS-5-9, False row EKS-5-10. The order of the levels is total: EKS-T2-2, E-47. The figure lets
    every word of MW01 pass when MSO 0 is selected, and every non-code of MW03; so both words must mean
    something before the last row says yes (E-12). Words are 0..65535; MW01 is the word of the private
    authority, not the flag word read back (E-18).
    """
    if echo(MW03) == ZERO:
        return False
    if MW01 == RE[4]:  # EKS-5-1
        return True
    if MW03 == SE[4]:  # EKS-5-2, constant as in Table 2: E-01
        return False
    if MW01 == RE[3]:  # EKS-5-3
        return True
    if MW03 == SE[3]:  # EKS-5-4
        return False
    if MW01 == RE[2]:  # EKS-5-5
        return True
    if MW03 == SE[2]:  # EKS-5-6
        return False
    if MW01 == RE[1]:  # EKS-5-7, constant as in Table 2: E-01
        return True
    if MW03 == SE[1]:  # EKS-5-8
        return False
    return MW01 == RE[0]


def within_authority(params: Params, authority: int, MW03: int) -> bool:
    """Step 18: whether MW03 (0..65535) is a code and its mode permitted by ``authority`` (0..4, -1 none).

    EKS-2-18, E-14. Figure 5 comes first and with the private authority (E-18); then the machine may permit
    less by its parameters. They cannot permit more, and by default take nothing away (E-47).
    """
    if not permitted(encode(RE, authority), MW03):
        return False
    return is_among(
        decode(SE, MW03),
        permitted_modes(
            authority,
            params.PERMITS_0,
            params.PERMITS_1,
            params.PERMITS_2,
            params.PERMITS_3,
            params.PERMITS_4,
        ),
    )


def echo(MW03: int) -> int:
    """Figure 6: the word for MW05 that means the selection in MW03; zero when MW03 is no code.

    A word of the range CH is row EKS-6-11 (no error), zero is row EKS-6-12 (error). Constants of Table 2:
    E-01
    """
    if MW03 == SE[4]:  # EKS-6-1
        return CH[4]  # EKS-6-2
    if MW03 == SE[3]:  # EKS-6-3
        return CH[3]  # EKS-6-4
    if MW03 == SE[2]:  # EKS-6-5
        return CH[2]  # EKS-6-6
    if MW03 == SE[1]:  # EKS-6-7
        return CH[1]  # EKS-6-8
    if MW03 == SE[0]:  # EKS-6-9
        return CH[0]  # EKS-6-10
    return ZERO


def permissible_acknowledgment(MW07: int) -> bool:
    """Figure 7, odd rows, as step 27 uses them: whether MW07 is one of the five acknowledgment words.

    EKS-7-1, EKS-7-3, EKS-7-5, EKS-7-7, EKS-7-9; row 5 with the constant of Table 2 (E-01).
    """
    return MW07 == SW[4] or MW07 == SW[3] or MW07 == SW[2] or MW07 == SW[1] or MW07 == SW[0]


def matches(MW03: int, MW07: int) -> bool:
    """Figure 7: whether MW07 acknowledges the mode selected in MW03.

    True is row EKS-7-11, False row EKS-7-12. Row 5 has the constant of Table 2, not the printed one (E-01).
    When an even row says NO, the chain ends with the error; it does not fall through to the next odd row
    (E-13).
    """
    if MW07 == SW[4]:  # EKS-7-1
        return MW03 == SE[4]  # EKS-7-2
    if MW07 == SW[3]:  # EKS-7-3
        return MW03 == SE[3]  # EKS-7-4
    if MW07 == SW[2]:  # EKS-7-5
        return MW03 == SE[2]  # EKS-7-6
    if MW07 == SW[1]:  # EKS-7-7
        return MW03 == SE[1]  # EKS-7-8
    if MW07 == SW[0]:  # EKS-7-9
        return MW03 == SE[0]  # EKS-7-10
    return False


def _zeros_returned(s: State, i: Inputs, elapsed: int) -> bool:
    """Whether both words came back as zero, long enough after the F-PLC wrote its own zeros.

    EKS-8-11, EKS-8-12, EKS-8-14, EKS-8-18, EKS-SD-9

    The dwell is ours: without it zeros that were there all along would pass as an answer (E-52).
    """
    return i.MW03 == ZERO and i.MW07 == ZERO and elapsed >= s.params.T_DWELL_ms


def _no_key_and_zeros_returned(s: State, i: Inputs, output: int, elapsed: int) -> bool:
    """Whether the removal is complete: LA off (E-29), no output set, zeros back. EKS-8-13, E-06b, E-31"""
    if i.LA:
        return False
    return output == NO_OUTPUT and _zeros_returned(s, i, elapsed)


# ---------------------------------------------------------------- entering a state


def _enter(s: State, to: Step) -> State:
    """Go on to the next step with all memory kept and the timer at 0. EKS-3-3, EKS-9-3"""
    return replace(s, state=to, elapsed_ms=0)


def _forget(s: State, to: Step, elapsed: int) -> State:
    """Go to a step with nothing of this insertion in memory; the mode stays. EKS-GP-5"""
    return replace(s, state=to, accepted=NONE, authority=NONE, selection=NONE, elapsed_ms=elapsed)


def _enter_idle(s: State) -> State:
    """Ready for the next key; nothing of the last insertion is left. E-17, EKS-GP-5"""
    return _forget(s, IDLE, 0)


def _enter_settle(s: State) -> State:
    """Drop the selection and the echo, keep the authority: the next selection starts from zeros. E-15"""
    return replace(_enter(s, SETTLE), selection=NONE)


def _enter_clear(s: State) -> State:
    """Start the "Electronic-Key is removed" routine: MW01 and MW05 drop in this scan, the mode stays.

    EKS-3-4-FPLC, EKS-8-6, E-27. The timer of the removal starts, by LA going off and not by its setting:
    EKS-8-3, E-06.
    """
    return _forget(s, CLEAR, 0)


def _enter_error(s: State) -> State:
    """The one error mode: nothing published, nothing remembered, the mode held or dropped by parameter.

    EKS-KS-6, E-22, E-24
    """
    if s.params.ON_ERROR == "none":
        return replace(_forget(s, ERROR, 0), mode=NONE)
    return _forget(s, ERROR, 0)


def _wait(s: State, elapsed: int) -> State:
    """Stay, and let the timer run on."""
    return replace(s, elapsed_ms=elapsed)


def _wait_dwelling(s: State, elapsed: int) -> State:
    """Stay, and let the timer run up to T_DWELL_ms; more says nothing new in Start and Error. E-52"""
    if elapsed >= s.params.T_DWELL_ms:
        return _wait(s, s.params.T_DWELL_ms)
    return _wait(s, elapsed)


# ---------------------------------------------------------------- one scan


def _next_state(s: State, i: Inputs, output: int, elapsed: int) -> State:
    """The check that comes before every single step, then the step. EKS-3-0, EKS-9-0, EKS-GP-4

    Order: several outputs (Error), no LA (removal), another output than the accepted one (removal), deadline
    (Error), the step.
    """
    c = s.state
    if c == START:
        return _start(s, i, output, elapsed)
    if c == IDLE:
        return _idle(s, i, output)
    if c == ERROR:
        return _error(s, i, output, elapsed)

    if c != PULSE_ONES and c != PULSE_ZEROS and _too_many(output):
        return _enter_error(s)  # TooManyOutputs: EKS-KS-6, EKS-2-11, also in removal (E-09, E-28)
    if c == CLEAR:
        return _clear(s, elapsed)
    if c == AWAIT_ZEROS:
        return _await_zeros(s, i, output, elapsed)

    if not i.LA:
        return _enter_clear(s)  # KeyGone: EKS-3-1-FPLC, EKS-3-4-FPLC; without LA alone, until step 11 (E-07)
    if c == PULSE_ONES:
        return _pulse_ones(s, output, elapsed)
    if c == PULSE_ZEROS:
        return _pulse_zeros(s, output, elapsed)
    if c == ONE_OUTPUT:
        return _one_output(s, output, elapsed)

    if output != s.accepted:
        return _enter_clear(s)  # VectorChanged: EKS-3-1-FPLC, EKS-3-4-FPLC, E-28, E-41
    return _insert_step(s, i, elapsed)


def _insert_step(s: State, i: Inputs, elapsed: int) -> State:
    """The step of the insert flow that comes next, the key check being passed. EKS-3-2"""
    c = s.state
    if c == AUTHORIZE:
        return _authorize(s, i)
    if c == AWAIT_SELECTION:
        return _await_selection(s, i)
    if c == CHECK_SELECTION:
        return _check_selection(s, i)
    if c == SETTLE:
        return _settle(s, i, elapsed)
    if c == COMPLETE:
        return s  # AwaitRemoval: EKS-2-29, EKS-GP-5, E-15

    if i.MW03 != encode(SE, s.selection):
        return _another_word(s, i)
    if c == ECHO_SELECTION:
        return _echo_selection(s, i)
    if c == AWAIT_ACKNOWLEDGMENT:
        return _await_acknowledgment(s, i)

    if i.MW07 == ZERO:
        return _enter_settle(s)  # WithdrawAcknowledgment
    if c == CHECK_ACKNOWLEDGMENT:
        return _check_acknowledgment(s, i)
    if c == MATCH:
        return _match(s, i)
    if c == SWITCH:
        return _switch(s, i)
    raise StateError("state", c, "a Step of the F-PLC")


def _too_many(output: int) -> bool:
    """Two or more outputs set. EKS-KS-6"""
    return output == SEVERAL_OUTPUTS or output == ALL_OUTPUTS


def _start(s: State, i: Inputs, output: int, elapsed: int) -> State:
    """After power-up: wait until no key is in and zeros have come back.

    A key that is in must be put in again (E-25c). The dwell counts here too: after a restart of the F-PLC
    alone the panel may still show its old screen (E-52).
    """
    if _too_many(output):
        return _enter_error(s)  # TooManyOutputs: EKS-KS-6
    if _no_key_and_zeros_returned(s, i, output, elapsed):
        return _enter_idle(s)  # LeaveStart
    return _wait_dwelling(s, elapsed)  # AwaitPowerUpZeros


def _idle(s: State, i: Inputs, output: int) -> State:
    """No key is in. LA alone starts the insert flow and its deadline.

    EKS-2-6, EKS-9-1-FPLC, EKS-9-2, EKS-9-4-FPLC, EKS-GP-5

    The outputs may already be switching when LA is seen, so any of them is taken with LA; without LA one
    output alone is ignored (E-73) and several are an error.
    """
    if i.LA:
        return _enter(s, PULSE_ONES)  # DetectKey
    if _too_many(output):
        return _enter_error(s)  # TooManyOutputs: EKS-KS-6
    return s  # AwaitKey


def _pulse_ones(s: State, output: int, elapsed: int) -> State:
    """Wait until all five outputs are set at once, until T_ON_ms after LA.

    EKS-2-6, EKS-2-8, EKS-2-10, EKS-4-1, EKS-4-2, E-10

    The deadline is judged before success, and ends in Error: the F-PLC cannot reset the EKS (EKS-2-9, E-25d).
    By parameter the timer goes on from LA, so that T_SEQ_ms limits the whole sequence, or starts anew (E-38).
    """
    if elapsed >= s.params.T_ON_ms:
        return _enter_error(s)  # DeadlineExpired: EKS-2-8
    if output == ALL_OUTPUTS:
        if s.params.T_SEQ_FROM == "ones":
            return _enter(s, PULSE_ZEROS)  # SeeOnes: the timer starts anew, EKS-4-2
        return _forget(s, PULSE_ZEROS, elapsed)  # SeeOnes: it goes on, EKS-2-6
    return _wait(s, elapsed)  # AwaitOnes


def _pulse_zeros(s: State, output: int, elapsed: int) -> State:
    """Wait until all five outputs are off again; the timer of the sequence goes on.

    EKS-2-10, EKS-4-3, EKS-4-4, E-10
    """
    if elapsed >= s.params.T_SEQ_ms:
        return _enter_error(s)  # DeadlineExpired: EKS-4-4, EKS-4-8 read as "no valid result" (E-03)
    if output == NO_OUTPUT:
        return _forget(s, ONE_OUTPUT, elapsed)  # SeePulseZeros
    return _wait(s, elapsed)  # AwaitPulseZeros


def _one_output(s: State, output: int, elapsed: int) -> State:
    """Wait for the one output that stays, and accept it. EKS-2-7, EKS-2-11, EKS-4-5, EKS-4-6, EKS-4-7

    Several outputs were sorted out before. EKS-4-8 is read as "no valid result has been signalled" and leads
    to Error (E-03).
    """
    if elapsed >= s.params.T_SEQ_ms:
        return _enter_error(s)  # DeadlineExpired: EKS-4-6, EKS-4-8
    if output == NO_OUTPUT:
        return _wait(s, elapsed)  # AwaitOneOutput
    return replace(_forget(s, AUTHORIZE, 0), accepted=output)  # AcceptOutput: EKS-4-7


def _authorize(s: State, i: Inputs) -> State:
    """Step 12: publish the authorization level of the accepted output in MW01. EKS-2-12, E-06b

    Nothing has been offered yet, so a word from the panel cannot be an answer: it is refused.
    """
    if i.MW03 != ZERO or i.MW07 != ZERO:
        return _enter_error(s)  # RefuseEarlyWord
    return replace(_enter(s, AWAIT_SELECTION), authority=s.accepted, selection=NONE)  # PublishAuthority


def _await_selection(s: State, i: Inputs) -> State:
    """Step 17: wait for a selection, which is any word but zero in MW03. EKS-2-17

    An acknowledgment may only appear after the echo was shown; one that is there already is refused (E-65).
    """
    if i.MW07 != ZERO:
        return _enter_error(s)  # UnexpectedAcknowledgment
    if i.MW03 != ZERO:
        return _enter(s, CHECK_SELECTION)  # SeeSelection
    return s  # AwaitMW03


def _check_selection(s: State, i: Inputs) -> State:
    """Steps 18 and 19 in one scan: MW03 must be a code and within the authority; then it is latched.

    EKS-2-18, EKS-2-19, E-14, E-16

    The check uses the private authority, not MW01 as others may have left it (E-18).
    """
    if i.MW07 != ZERO:
        return _enter_error(s)  # UnexpectedAcknowledgment: E-15
    if i.MW03 == ZERO:
        return _enter_settle(s)  # WithdrawSelection: E-21
    if not within_authority(s.params, s.authority, i.MW03):
        return _enter_error(s)  # RefuseSelection
    selection = decode(SE, i.MW03)
    return replace(_enter(s, ECHO_SELECTION), selection=selection)  # AcceptSelection


def _echo_selection(s: State, i: Inputs) -> State:
    """Step 20: only now, the checks being passed, is the selection shown back in MW05. EKS-2-20"""
    if i.MW07 != ZERO:
        return _enter_error(s)  # UnexpectedAcknowledgment: E-15
    return _enter(s, AWAIT_ACKNOWLEDGMENT)  # PublishEcho


def _another_word(s: State, i: Inputs) -> State:
    """Before step 29 MW03 no longer shows the latched selection. EKS-2-19, EKS-2-25, E-16, E-21, E-61

    Zero and another selection take the first one back; a word that is neither is a fault.
    """
    if i.MW03 != ZERO and decode(SE, i.MW03) == NONE:
        return _enter_error(s)  # RefuseSelection
    return _enter_settle(s)  # WithdrawSelection


def _await_acknowledgment(s: State, i: Inputs) -> State:
    """Wait for the acknowledgment; the note has no step for it, and step 27 would refuse the zero. E-11"""
    if i.MW07 == ZERO:
        return s  # AwaitMW07
    return _enter(s, CHECK_ACKNOWLEDGMENT)  # SeeAcknowledgment


def _check_acknowledgment(s: State, i: Inputs) -> State:
    """Step 27: MW07 must be one of the five acknowledgment words. EKS-2-27"""
    if not permissible_acknowledgment(i.MW07):
        return _enter_error(s)  # RefuseAcknowledgment
    return _enter(s, MATCH)  # AcceptAcknowledgment


def _match(s: State, i: Inputs) -> State:
    """Step 28: the acknowledged mode must be the selected one. EKS-2-28

    MW03 still equals the latched selection here, that was checked in this very scan (E-16).
    """
    if not matches(encode(SE, s.selection), i.MW07):
        return _enter_error(s)  # RefuseMatch
    return _enter(s, SWITCH)  # MatchWords


def _switch(s: State, i: Inputs) -> State:
    """Step 29: switch over, with LA, output, MW03 and MW07 judged once more in this very scan.

    EKS-2-29, EKS-SD-2, E-16, E-42

    The mode that becomes active is the latched selection (E-01). By parameter another selection may
    follow, or only the check before every step goes on until the key goes (E-15).
    """
    if not matches(encode(SE, s.selection), i.MW07):
        return _enter_error(s)  # RefuseMatch
    if s.params.SELECTIONS == "once":
        return replace(_enter(s, COMPLETE), mode=s.selection)  # SwitchMode
    return replace(_enter_settle(s), mode=s.selection)  # SwitchMode


def _settle(s: State, i: Inputs, elapsed: int) -> State:
    """Between two selections: wait, at most T_REM_ms, for zeros in both words. E-15, E-52, EKS-GP-5"""
    if elapsed >= s.params.T_REM_ms:
        return _enter_error(s)  # DeadlineExpired: E-15
    if _zeros_returned(s, i, elapsed):
        return _enter(s, AWAIT_SELECTION)  # LeaveSettle
    return _wait(s, elapsed)  # AwaitSettled


def _clear(s: State, elapsed: int) -> State:
    """Step 6 of the removal: MW01 and MW05 are zero on the outputs; the timer of the removal goes on.

    EKS-8-3, EKS-8-6, E-27
    """
    if elapsed >= s.params.T_REM_ms:
        return _enter_error(s)  # DeadlineExpired: E-30
    return _forget(s, AWAIT_ZEROS, elapsed)  # ClearWords


def _await_zeros(s: State, i: Inputs, output: int, elapsed: int) -> State:
    """Steps 11 to 14 and 18 of the removal: wait, at most T_REM_ms, until the zeros have gone round.

    EKS-8-11, EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-30, E-31, E-32. A new key is not taken before the
    removal is complete, against the literal Figure 9 (EKS-9-1-FPLC, EKS-9-4-FPLC, E-17, E-36).
    """
    if elapsed >= s.params.T_REM_ms:
        return _enter_error(s)  # DeadlineExpired: E-30
    if _no_key_and_zeros_returned(s, i, output, elapsed):
        return _enter_idle(s)  # LeaveAwaitZeros
    return _wait(s, elapsed)  # AwaitReturnedZeros


def _error(s: State, i: Inputs, output: int, elapsed: int) -> State:
    """Error mode: left only when the key is out and zeros have come back, which is checked here too.

    EKS-3-0, EKS-9-0, E-23, E-25
    """
    if _no_key_and_zeros_returned(s, i, output, elapsed):
        return _enter_idle(s)  # LeaveError
    return _wait_dwelling(s, elapsed)  # StayInError

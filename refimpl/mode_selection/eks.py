"""The EKS Light FSA: it reads the key, sets LA and, after a test pulse on all outputs, the one output of the
key's level.

Covers steps 1 to 5, 7, 9, 10 of the insert flow with the device's part of Figure 4, and steps 1, 2, 4, 5 of
the remove flow. One call of ``step`` is one scan. The note gives the key's structure and the outputs; the
maker's checksum is not public, so it is a parameter that the caller must bring.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from refimpl.errors import KeyDataError, ParameterError, StateError, check_bool, check_int, check_word
from refimpl.mode_selection.code_tables import NONE, RE, decode

ACCESS_CODE_MAX = 0x3FF
KEY_ID_MAX = 0xFFFF_FFFF_FFFF_FFFF
KEY_BYTES = 15

Checksum = Callable[[bytes], int]


class Step(Enum):
    """The step that is executed next. EKS-GP-3"""

    EMPTY = "Empty"
    READ = "Read"
    CHECK_CHECKSUM = "CheckChecksum"
    CHECK_LEVEL = "CheckLevel"
    SET_LA = "SetLA"
    START_TEST = "StartTest"
    TEST_ONES = "TestOnes"
    TEST_ZEROS = "TestZeros"
    SIGNAL = "Signal"
    REJECTED = "Rejected"
    CLEAR_OUTPUTS = "ClearOutputs"
    CHECK_REGISTERS = "CheckRegisters"
    FAULT = "Fault"


# ---------------------------------------------------------------- the Electronic-Key


@dataclass(frozen=True, slots=True)
class KeyMemory:
    """Bytes 109 to 123 of an Electronic-Key; words have their high byte first. EKS-KS-1

    ``operating_state`` byte 109, 0..255 · ``authorization_level`` bytes 110-111 · ``access_code`` bytes
    112-113, of which 10 bits are used · ``KEYCRC`` bytes 114-115 · ``KeyID`` bytes 116-123, 0..2**64-1. Any
    content is a possible key; whether the device accepts it is judged in ``step``.
    """

    operating_state: int
    authorization_level: int
    access_code: int
    KEYCRC: int
    KeyID: int


NO_KEY = KeyMemory(0, 0, 0, 0, 0)


def key_from_bytes(data: bytes) -> KeyMemory:
    """Read a key from its 15 bytes 109..123. Raises KeyDataError for anything but 15 bytes. EKS-KS-1"""
    if type(data) is not bytes or len(data) != KEY_BYTES:
        raise KeyDataError("key bytes 109 to 123", data, f"{KEY_BYTES} bytes")
    return KeyMemory(
        data[0],
        int.from_bytes(data[1:3], "big"),
        int.from_bytes(data[3:5], "big"),
        int.from_bytes(data[5:7], "big"),
        int.from_bytes(data[7:15], "big"),
    )


def key_to_bytes(key: KeyMemory) -> bytes:
    """The 15 bytes 109..123 of a key. Raises KeyDataError naming a field that does not fit. EKS-KS-1"""
    check_int("operating_state", key.operating_state, 0, 0xFF, KeyDataError)
    check_word("authorization_level", key.authorization_level, KeyDataError)
    check_word("access_code", key.access_code, KeyDataError)
    check_word("KEYCRC", key.KEYCRC, KeyDataError)
    check_int("KeyID", key.KeyID, 0, KEY_ID_MAX, KeyDataError)
    return _data_bytes(key) + key.KEYCRC.to_bytes(2, "big") + key.KeyID.to_bytes(8, "big")


def written_key(
    operating_state: int, authorization_level: int, access_code: int, KeyID: int, checksum: Checksum
) -> KeyMemory:
    """A key as the administration program must write it.

    EKS-KS-2, EKS-KS-5, EKS-KS-7, EKS-KS-8, EKS-KS-10, EKS-T1, EKS-T2

    Raises KeyDataError for an operating state other than 6 or 7, a level that is not in Table 1 (zero never
    is), an access code of more than 10 bits, or a KeyID of more than 8 bytes. KEYCRC comes from ``checksum``.
    """
    check_int("operating_state", operating_state, 6, 7, KeyDataError)
    check_word("authorization_level", authorization_level, KeyDataError)
    if decode(RE, authorization_level) == NONE:
        raise KeyDataError("authorization_level", authorization_level, "one of the five words of Table 1")
    check_int("access_code", access_code, 0, ACCESS_CODE_MAX, KeyDataError)
    check_int("KeyID", KeyID, 0, KEY_ID_MAX, KeyDataError)
    blank = KeyMemory(operating_state, authorization_level, access_code, 0, KeyID)
    crc = checksum(checksum_data(blank))
    check_word("KEYCRC", crc, KeyDataError)
    return KeyMemory(operating_state, authorization_level, access_code, crc, KeyID)


def checksum_data(key: KeyMemory) -> bytes:
    """What the checksum is taken over: bytes 109..113 and 116..123, thus all but KEYCRC itself.

    EKS-2-2, EKS-KS-7

    Which part it is the note does not say; that the key's own number is in it is what makes it a protection
    against copies.
    """
    return _data_bytes(key) + key.KeyID.to_bytes(8, "big")


def _data_bytes(key: KeyMemory) -> bytes:
    """Bytes 109..113."""
    words = key.authorization_level.to_bytes(2, "big") + key.access_code.to_bytes(2, "big")
    return key.operating_state.to_bytes(1, "big") + words


# ---------------------------------------------------------------- the device


@dataclass(frozen=True, slots=True)
class Params:
    """Settings of the device. Raises ParameterError.

    checksum: required, bytes -> 0..65535 (EKS-KS-7). operating_state: 6 or 7 (EKS-KS-2). dip_switches:
    0..1023, the access code set on the device (EKS-KS-3, EKS-KS-4). T_PULSE_ms: length of each half of the
    test pulse (EKS-4-2, EKS-4-3, E-39).
    """

    checksum: Checksum
    operating_state: int = 6
    dip_switches: int = 1
    T_PULSE_ms: int = 200

    def __post_init__(self) -> None:
        if not callable(self.checksum):
            raise ParameterError("checksum", self.checksum, "a function from bytes to a word")
        check_int("operating_state", self.operating_state, 6, 7, ParameterError)
        check_int("dip_switches", self.dip_switches, 0, ACCESS_CODE_MAX, ParameterError)
        check_int("T_PULSE_ms", self.T_PULSE_ms, 1, 60_000, ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the device between two scans: the key as read when it was inserted (NO_KEY in Empty,
    CheckRegisters and Fault), and the time in the running half of the test pulse (0 elsewhere).
    """

    params: Params
    state: Step
    key: KeyMemory
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan sees of the reader. Building it checks every field (InputError); nothing is coerced.

    ``dt_ms`` >= 0. ``inserted``: a key is in the reader; then the five fields of ``KeyMemory`` are its
    content, else they mean nothing. ``registers_zero``: channel B found all internal data zero.
    """

    dt_ms: int
    inserted: bool
    operating_state: int
    authorization_level: int
    access_code: int
    KEYCRC: int
    KeyID: int
    registers_zero: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("inserted", self.inserted)
        check_int("operating_state", self.operating_state, 0, 0xFF)
        check_word("authorization_level", self.authorization_level)
        check_word("access_code", self.access_code)
        check_word("KEYCRC", self.KEYCRC)
        check_int("KeyID", self.KeyID, 0, KEY_ID_MAX)
        check_bool("registers_zero", self.registers_zero)


@dataclass(frozen=True, slots=True)
class Outputs:
    """Switching channel LA and the five outputs."""

    LA: bool
    A: bool
    B: bool
    C: bool
    D: bool
    STR: bool


def power_up(params: Params) -> State:
    """The state after power-up: no key seen. EKS-8-1"""
    return State(params, Step.EMPTY, NO_KEY, 0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan: is the same key still in, then one step. EKS-GP-3"""
    after = _next_state(state, inputs)
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The outputs that belong to a state; only one of the five is ever set outside the test pulse.

    EKS-KS-5, EKS-2-5, EKS-2-7, EKS-T2; the outputs tell the level (EKS-SD-1), LA that the key is valid
    (EKS-SD-2).

    LA is on from step 5 to the removal. A key that fails a check gives no LA and no output (EKS-2-3,
    EKS-2-9). On removal LA goes first (EKS-8-2), the output a scan later (EKS-8-5). Output D, not C, is level
    3 (E-02).
    """
    c = s.state
    if c == Step.TEST_ONES:
        return Outputs(True, True, True, True, True, True)
    if c == Step.SIGNAL or c == Step.CLEAR_OUTPUTS:
        level = decode(RE, s.key.authorization_level)
        return Outputs(c == Step.SIGNAL, level == 0, level == 1, level == 2, level == 3, level == 4)
    LA = c == Step.START_TEST or c == Step.TEST_ZEROS
    return Outputs(LA, False, False, False, False, False)


def _next_state(s: State, i: Inputs) -> State:
    """A key that is taken out or exchanged is a removal, in every step after it was seen. EKS-8-1, EKS-8-2"""
    c = s.state
    if c == Step.EMPTY:
        return _empty(s, i)
    if c == Step.CLEAR_OUTPUTS:
        return _clear_outputs(s)
    if c == Step.CHECK_REGISTERS:
        return _check_registers(s, i)
    if c == Step.FAULT:
        return s  # StayInFault: EKS-8-4, until power is switched off

    if not i.inserted or not _same_key(s.key, i):
        return _removal(s)  # SeeRemoval
    if c == Step.READ:
        return _enter(s, Step.CHECK_CHECKSUM)  # ReadKey: EKS-2-2
    if c == Step.CHECK_CHECKSUM:
        return _check_checksum(s)
    if c == Step.CHECK_LEVEL:
        return _check_level(s)
    if c == Step.SET_LA:
        return _enter(s, Step.START_TEST)  # RaiseLA: EKS-2-5
    if c == Step.START_TEST:
        return _enter(s, Step.TEST_ONES)  # StartOnes: EKS-2-10, pulse after LA (E-40)
    if c == Step.TEST_ONES:
        return _test_ones(s, i)
    if c == Step.TEST_ZEROS:
        return _test_zeros(s, i)
    if c == Step.SIGNAL:
        return s  # HoldOneOutput: EKS-2-7
    if c == Step.REJECTED:
        return s  # StayRejected: EKS-2-3, EKS-2-9
    raise StateError("state", c, "a Step of the EKS")


def _same_key(key: KeyMemory, i: Inputs) -> bool:
    """Whether the key in the reader still has the content that was read, its KeyID included. E-41"""
    return (
        key.operating_state == i.operating_state
        and key.authorization_level == i.authorization_level
        and key.access_code == i.access_code
        and key.KEYCRC == i.KEYCRC
        and key.KeyID == i.KeyID
    )


def _enter(s: State, to: Step) -> State:
    """Go on to the next step with the timer at 0."""
    return State(s.params, to, s.key, 0)


def _empty(s: State, i: Inputs) -> State:
    """Wait for a key, and read it. EKS-2-1, EKS-2-2"""
    if not i.inserted:
        return s  # AwaitInsertion
    key = KeyMemory(i.operating_state, i.authorization_level, i.access_code, i.KEYCRC, i.KeyID)
    return State(s.params, Step.READ, key, 0)  # SeeInsertion


def _check_checksum(s: State) -> State:
    """Only a key whose checksum is right goes on; any other gives no LA and no output. EKS-2-3, EKS-KS-7"""
    if checksum_agrees(s.params, s.key):
        return _enter(s, Step.CHECK_LEVEL)  # AcceptChecksum
    return _enter(s, Step.REJECTED)  # RefuseChecksum


def checksum_agrees(params: Params, key: KeyMemory) -> bool:
    """Whether the calculated checksum is the saved one. EKS-2-2, EKS-2-3, EKS-KS-7

    The only place where the maker's algorithm is called; proofs may put an arbitrary answer here. Raises
    ParameterError when the algorithm gives no word.
    """
    calculated = params.checksum(checksum_data(key))
    check_word("checksum", calculated, ParameterError)
    return calculated == key.KEYCRC


def _check_level(s: State) -> State:
    """Operating state, access code and level must all be right; the note has no other exit here.

    EKS-2-4, EKS-2-9, E-25e

    The level must be one of the five values of Table 1; zero is none of them. EKS-KS-2, EKS-KS-5, EKS-KS-8,
    EKS-KS-10, EKS-T1
    """
    if s.key.operating_state != s.params.operating_state:
        return _enter(s, Step.REJECTED)  # RefuseLevel
    if not access_code_accepted(s.params.operating_state, s.params.dip_switches, s.key.access_code):
        return _enter(s, Step.REJECTED)  # RefuseLevel
    if decode(RE, s.key.authorization_level) == NONE:
        return _enter(s, Step.REJECTED)  # RefuseLevel
    return _enter(s, Step.SET_LA)  # AcceptLevel


def access_code_accepted(operating_state: int, dip_switches: int, access_code: int) -> bool:
    """Operating state 6: all ten bits equal (EKS-KS-3).

    Operating state 7: a 1 in at least one common bit (EKS-KS-4, E-48).

    A code with a bit above the ten is not accepted in either.
    """
    if access_code > ACCESS_CODE_MAX:
        return False
    if operating_state == 6:
        return access_code == dip_switches
    return access_code & dip_switches != 0


def _test_ones(s: State, i: Inputs) -> State:
    """First half of the test pulse: all outputs set for T_PULSE_ms. EKS-2-10, EKS-4-1, EKS-4-2, E-39"""
    elapsed = s.elapsed_ms + i.dt_ms
    if elapsed >= s.params.T_PULSE_ms:
        return _enter(s, Step.TEST_ZEROS)  # StartZeros
    return State(s.params, Step.TEST_ONES, s.key, elapsed)  # HoldOnes


def _test_zeros(s: State, i: Inputs) -> State:
    """Second half: all outputs off for T_PULSE_ms, then the one output of the level.

    EKS-2-7, EKS-2-10, EKS-4-3, EKS-4-5, E-39
    """
    elapsed = s.elapsed_ms + i.dt_ms
    if elapsed >= s.params.T_PULSE_ms:
        return _enter(s, Step.SIGNAL)  # SetOneOutput
    return State(s.params, Step.TEST_ZEROS, s.key, elapsed)  # HoldZeros


def _removal(s: State) -> State:
    """LA goes off at once, and so does a test pulse; the one output goes off in a step of its own.

    EKS-8-1, EKS-8-2, EKS-8-5, EKS-SD-8
    """
    if s.state == Step.SIGNAL:
        return _enter(s, Step.CLEAR_OUTPUTS)
    return State(s.params, Step.CHECK_REGISTERS, NO_KEY, 0)


def _clear_outputs(s: State) -> State:
    """The outputs go to zero; only then are the registers checked, or each removal would be a fault.

    EKS-8-5, E-26
    """
    return State(s.params, Step.CHECK_REGISTERS, NO_KEY, 0)  # ResetOutputs


def _check_registers(s: State, i: Inputs) -> State:
    """Channel B must find all internal data zero; else the fault is latched. EKS-8-4"""
    if i.registers_zero:
        return State(s.params, Step.EMPTY, NO_KEY, 0)  # PassRegisterCheck
    return State(s.params, Step.FAULT, NO_KEY, 0)  # LatchFault

"""The four devices and the user together: whole insert and remove flows, for demonstrations and tests.

There is no scheduler here. A ``System`` is a frozen record of the four states, of what each device last
wrote, and of what the user does; each ``scan_`` function lets one device take one scan and leaves the others
alone. In which order and how often is for the caller to choose: the devices are asynchronous (E-43).

EKS --LA, A..STR--> F-PLC --MW01, MW05--> PLC --ReadAuthorization, CheckMSO--> HMI F-PLC <--MW03, MW07-- PLC
<--SelectMSO, SwitchMSO--------- HMI F-PLC --active mode, for display only (E-25)------------> HMI
"""

from __future__ import annotations

import json
from dataclasses import dataclass, fields, replace

from refimpl.errors import check_text
from refimpl.mode_selection import eks, fplc, hmi, plc
from refimpl.mode_selection.code_tables import NONE


@dataclass(frozen=True, slots=True)
class System:
    """All four devices, what the others see of them, the key in the reader, and a touch not seen yet.

    ``touch`` is consumed by the next scan of the HMI. ``registers_zero`` is what channel B of the EKS will
    find on removal.
    """

    eks_state: eks.State
    fplc_state: fplc.State
    plc_state: plc.State
    hmi_state: hmi.State
    eks_out: eks.Outputs
    fplc_out: fplc.Outputs
    plc_out: plc.Outputs
    hmi_out: hmi.Outputs
    key: eks.KeyMemory | None = None
    touch: str = hmi.NO_TOUCH
    registers_zero: bool = True


def power_up(eks_params: eks.Params, fplc_params: fplc.Params) -> System:
    """All four devices just switched on, no key in the reader.

    The panel takes what a level permits from the F-PLC's parameters, for it must offer what the F-PLC accepts
    (E-47).
    """
    eks_state = eks.power_up(eks_params)
    fplc_state = fplc.power_up(fplc_params)
    plc_state = plc.power_up(plc.Params())
    p = fplc_params
    permits = hmi.Params(p.PERMITS_0, p.PERMITS_1, p.PERMITS_2, p.PERMITS_3, p.PERMITS_4)
    hmi_state = hmi.power_up(permits)
    return System(
        eks_state,
        fplc_state,
        plc_state,
        hmi_state,
        eks.outputs(eks_state),
        fplc.outputs(fplc_state),
        plc.outputs(plc_state),
        hmi.outputs(hmi_state),
    )


# ---------------------------------------------------------------- what the user does


def insert_key(system: System, key: eks.KeyMemory) -> System:
    """Put a key into the reader; a key that was in is thereby exchanged, between two scans. EKS-2-1"""
    return replace(system, key=key)


def remove_key(system: System) -> System:
    """Take the key out. EKS-8-1"""
    return replace(system, key=None)


def touch(system: System, field: str) -> System:
    """Touch a field of the screen, "select:0".."select:4", "confirm" or "reject".

    EKS-2-14, EKS-2-23, EKS-2-25

    The touch counts in the next scan of the HMI; an earlier one not yet seen is lost. Raises InputError.
    """
    check_text("touch", field, hmi.TOUCHES)
    return replace(system, touch=field)


# ---------------------------------------------------------------- what each device sees


def eks_inputs(system: System, dt_ms: int) -> eks.Inputs:
    """The reader, as the EKS sees it."""
    key = eks.NO_KEY if system.key is None else system.key
    return eks.Inputs(
        dt_ms,
        system.key is not None,
        key.operating_state,
        key.authorization_level,
        key.access_code,
        key.KEYCRC,
        key.KeyID,
        system.registers_zero,
    )


def fplc_inputs(system: System, dt_ms: int) -> fplc.Inputs:
    """The wires from the EKS and the flag words from the PLC. EKS-BD-1"""
    e, p = system.eks_out, system.plc_out
    return fplc.Inputs(dt_ms, e.LA, e.A, e.B, e.C, e.D, e.STR, p.MW03, p.MW07)


def plc_inputs(system: System, dt_ms: int) -> plc.Inputs:
    """The flag words from the F-PLC and the words from the panel. EKS-BD-2"""
    f, h = system.fplc_out, system.hmi_out
    return plc.Inputs(dt_ms, f.MW01, f.MW05, h.SelectMSO, h.SwitchMSO)


def hmi_inputs(system: System, dt_ms: int) -> hmi.Inputs:
    """The words from the PLC, the active mode, and the touch. EKS-8-8"""
    p = system.plc_out
    return hmi.Inputs(dt_ms, p.ReadAuthorization, p.CheckMSO, active_mode(system), system.touch)


def active_mode(system: System) -> int:
    """The mode whose output the F-PLC sets, 0..4, or -1 while none is. EKS-2-29"""
    f = system.fplc_out
    for mode, is_set in enumerate((f.MSO_0, f.MSO_1, f.MSO_2, f.MSO_3, f.MSO_4)):
        if is_set:
            return mode
    return NONE


# ---------------------------------------------------------------- one scan of one device


def scan_eks(system: System, dt_ms: int) -> System:
    """One scan of the EKS, dt_ms after its last one. Raises InputError."""
    state, outputs = eks.step(system.eks_state, eks_inputs(system, dt_ms))
    return replace(system, eks_state=state, eks_out=outputs)


def scan_fplc(system: System, dt_ms: int) -> System:
    """One scan of the F-PLC, dt_ms after its last one. Raises InputError."""
    state, outputs = fplc.step(system.fplc_state, fplc_inputs(system, dt_ms))
    return replace(system, fplc_state=state, fplc_out=outputs)


def scan_plc(system: System, dt_ms: int) -> System:
    """One scan of the PLC, dt_ms after its last one: one word is copied. Raises InputError."""
    state, outputs = plc.step(system.plc_state, plc_inputs(system, dt_ms))
    return replace(system, plc_state=state, plc_out=outputs)


def scan_hmi(system: System, dt_ms: int) -> System:
    """One scan of the HMI, dt_ms after its last one; it consumes the touch. Raises InputError."""
    state, outputs = hmi.step(system.hmi_state, hmi_inputs(system, dt_ms))
    return replace(system, hmi_state=state, hmi_out=outputs, touch=hmi.NO_TOUCH)


# ---------------------------------------------------------------- logs


DEVICES = ("eks", "fplc", "plc", "hmi")

WORDS = (
    "MW01",
    "MW03",
    "MW05",
    "MW07",
    "ReadAuthorization",
    "SelectMSO",
    "CheckMSO",
    "SwitchMSO",
    "authorization_level",
    "access_code",
    "KEYCRC",
)


def scan(system: System, device: str, dt_ms: int) -> System:
    """One scan of the named device. Raises InputError for an unknown name."""
    check_text("device", device, DEVICES)
    if device == "eks":
        return scan_eks(system, dt_ms)
    if device == "fplc":
        return scan_fplc(system, dt_ms)
    if device == "plc":
        return scan_plc(system, dt_ms)
    return scan_hmi(system, dt_ms)


def log_line(before: System, device: str, dt_ms: int) -> str:
    """One line of JSON: what the named device reads and writes when it scans in the situation ``before``.

    The form is that of the adapter protocol: words as four hex digits, none as null, a set of modes as a
    list.
    """
    check_text("device", device, DEVICES)
    after = scan(before, device, dt_ms)
    read: eks.Inputs | fplc.Inputs | plc.Inputs | hmi.Inputs
    wrote: eks.Outputs | fplc.Outputs | plc.Outputs | hmi.Outputs
    if device == "eks":
        read, wrote = eks_inputs(before, dt_ms), after.eks_out
    elif device == "fplc":
        read, wrote = fplc_inputs(before, dt_ms), after.fplc_out
    elif device == "plc":
        read, wrote = plc_inputs(before, dt_ms), after.plc_out
    else:
        read, wrote = hmi_inputs(before, dt_ms), after.hmi_out
    record = {"device": device, "dt_ms": dt_ms, "in": _wire(read), "out": _wire(wrote)}
    return json.dumps(record, separators=(",", ":"))


def _wire(record: object) -> dict[str, object]:
    """The fields of Inputs or Outputs, without dt_ms, in the form of the adapter protocol."""
    wire: dict[str, object] = {}
    for field in fields(record):  # type: ignore[arg-type]
        value = getattr(record, field.name)
        if field.name in WORDS:
            wire[field.name] = f"{value:04X}"
        elif field.name == "enabled":
            wire[field.name] = [mode for mode, enabled in enumerate(value) if enabled]
        elif field.name == "touch":
            wire[field.name] = value or None
        elif field.name in ("shown", "active", "ActiveMSO"):
            wire[field.name] = None if value == NONE else value
        elif field.name != "dt_ms":
            wire[field.name] = value
    return wire

"""The four devices as the explorer runs them: what their parameters must fulfil, and what stands in."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import z3

from modeproof.registers import load_interface
from proofs.explorer.device import Device
from proofs.explorer.explore import StandIn
from proofs.explorer.records import unvalidated
from proofs.explorer.values import Flag, flag, number, word
from refimpl.mode_selection import eks, fplc, hmi, plc

ROOT: Final = Path(__file__).parents[2]
LEVELS: Final = range(5)
KEY_ID_MAX: Final = 0xFFFF_FFFF_FFFF_FFFF
CHECKSUM_AGREES: Final = flag("checksum_agrees")
"""What the maker's checksum says of the key in memory; it is not public, so both answers are possible."""


def permits_fit(params: Any) -> z3.BoolRef:
    """Each level permits itself and none above it. EKS-T2-2, E-47"""
    rows: list[tuple[Flag, ...]] = [getattr(params, f"PERMITS_{level}") for level in LEVELS]
    own = [rows[level][level].term for level in LEVELS]
    above = [z3.Not(rows[level][mode].term) for level in LEVELS for mode in LEVELS if mode > level]
    return z3.And(*own, *above)


def fplc_parameters_fit(params: Any) -> z3.BoolRef:
    """Permissions as above; T_SEQ from LA is no shorter than T_ON (E-38); the dwell is below the removal."""
    from_la = params.T_SEQ_FROM.term == params.T_SEQ_FROM.values.index("LA")
    return z3.And(
        permits_fit(params),
        z3.Implies(from_la, params.T_SEQ_ms.term >= params.T_ON_ms.term),
        params.T_DWELL_ms.term < params.T_REM_ms.term,
    )


def _key_in_memory() -> Any:
    """Any content that a reader can have read."""
    return unvalidated(
        eks.KeyMemory,
        {
            "operating_state": word("before.operating_state", 0, 0xFF),
            "authorization_level": word("before.authorization_level"),
            "access_code": word("before.access_code"),
            "KEYCRC": word("before.KEYCRC"),
            "KeyID": number("before.KeyID", 0, KEY_ID_MAX),
        },
    )


_REGISTERS: Final = load_interface(ROOT, "mode_selection").devices

FPLC: Final = Device(fplc, _REGISTERS["fplc"], fplc_parameters_fit)
PLC: Final = Device(plc, _REGISTERS["plc"])
HMI: Final = Device(hmi, _REGISTERS["hmi"], permits_fit)
EKS: Final = Device(
    eks,
    _REGISTERS["eks"],
    memory={"key": _key_in_memory()},
    stand_ins=(StandIn(eks, "checksum_agrees", CHECKSUM_AGREES),),
)
DEVICES: Final = (FPLC, PLC, HMI, EKS)

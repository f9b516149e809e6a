"""Which modes an authorization level permits on a machine. F-PLC and panel have the same five parameters.

PERMITS_0 to PERMITS_4 are five booleans each, one a mode. A machine may permit less than the total order of
Figure 5, never more: each level permits its own mode, and none above it (EKS-T2-2, EKS-5-1, E-47).
"""

from __future__ import annotations

from refimpl.errors import ParameterError

# Figure 5, row by row: a level permits itself and all below. EKS-T2-2, E-47
UP_TO_0 = (True, False, False, False, False)
UP_TO_1 = (True, True, False, False, False)
UP_TO_2 = (True, True, True, False, False)
UP_TO_3 = (True, True, True, True, False)
UP_TO_4 = (True, True, True, True, True)

NO_MODES = (False, False, False, False, False)


def check_permits(field: str, value: object, level: int) -> None:
    """Refuse all but five booleans with ``level`` (0..4) itself and none above it. Raises ParameterError.

    EKS-T2-2, E-47
    """
    if type(value) is not tuple or len(value) != 5 or any(type(flag) is not bool for flag in value):
        raise ParameterError(field, value, "a tuple of five booleans, one a mode")
    if not value[level] or any(value[level + 1 :]):
        raise ParameterError(field, value, f"mode {level}, and none above it")


def permitted_modes(
    level: int,
    PERMITS_0: tuple[bool, bool, bool, bool, bool],
    PERMITS_1: tuple[bool, bool, bool, bool, bool],
    PERMITS_2: tuple[bool, bool, bool, bool, bool],
    PERMITS_3: tuple[bool, bool, bool, bool, bool],
    PERMITS_4: tuple[bool, bool, bool, bool, bool],
) -> tuple[bool, bool, bool, bool, bool]:
    """The modes that ``level`` permits; no level (-1), no mode. E-47"""
    if level == 0:
        return PERMITS_0
    if level == 1:
        return PERMITS_1
    if level == 2:
        return PERMITS_2
    if level == 3:
        return PERMITS_3
    if level == 4:
        return PERMITS_4
    return NO_MODES


def is_among(mode: int, modes: tuple[bool, bool, bool, bool, bool]) -> bool:
    """Whether ``mode`` is one of ``modes``; no mode (-1) never is."""
    if mode == 0:
        return modes[0]
    if mode == 1:
        return modes[1]
    if mode == 2:
        return modes[2]
    if mode == 3:
        return modes[3]
    if mode == 4:
        return modes[4]
    return False

"""Tables 1 and 2 of the note: the five words, and which mode each of them means in each range.

The meaning of a word changes from range to range (EKS-T2-1), so a word says nothing without its range. Zero
is in no range: it means "nothing" everywhere (EKS-KS-8).
"""

from __future__ import annotations

from refimpl.errors import InputError

ZERO = 0x0000
NONE = -1

# Table 1: the set of values for authorization levels, in the order of the table. EKS-T1
SET_OF_VALUES = (0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C)

# Table 2: one range for each pair of flag word and bus variable; the position in a range is the mode. EKS-T2
RE = (0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C)  # MW01, ReadAuthorization, Electronic-Key
SE = (0x0FF0, 0x3333, 0x33CC, 0x3C3C, 0x0F0F)  # MW03, SelectMSO
CH = (0x3333, 0x33CC, 0x3C3C, 0x0F0F, 0x0FF0)  # MW05, CheckMSO
SW = (0x33CC, 0x3C3C, 0x0F0F, 0x0FF0, 0x3333)  # MW07, SwitchMSO

RANGES = {"RE": RE, "SE": SE, "CH": CH, "SW": SW}

MODE_NAMES = (
    "Manual mode",
    "Automatic mode",
    "Setup mode",
    "Automatic mode with manual intervention",
    "Service: operation mode for servicing and setup",
)


def encode(codes: tuple[int, ...], mode: int) -> int:
    """The word that means ``mode`` in the range ``codes``. EKS-T2, EKS-T2-1, EKS-KS-10, EKS-KS-8

    ``mode`` is 0..4, or -1 (none), whose word is zero. Any other number raises InputError.
    """
    if mode == 0:
        return codes[0]
    if mode == 1:
        return codes[1]
    if mode == 2:
        return codes[2]
    if mode == 3:
        return codes[3]
    if mode == 4:
        return codes[4]
    if mode == NONE:
        return ZERO
    raise InputError("mode", mode, "a mode 0..4 or -1 for none")


def decode(codes: tuple[int, ...], word: int) -> int:
    """The mode that ``word`` means in the range ``codes``, or -1 when it is not one of its five words.

    EKS-T2, EKS-KS-9

    ``word`` is 0..65535. Zero and every word that is no code mean none; a word is never repaired to the
    nearest code.
    """
    if word == codes[0]:
        return 0
    if word == codes[1]:
        return 1
    if word == codes[2]:
        return 2
    if word == codes[3]:
        return 3
    if word == codes[4]:
        return 4
    return NONE

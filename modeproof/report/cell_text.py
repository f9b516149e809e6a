"""Texts as other programs may read them: no formula in a spreadsheet, no character that XML forbids."""

from __future__ import annotations

import re

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def for_csv(text: str) -> str:
    """A cell that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(_FORMULA) else text


def for_xml(text: str) -> str:
    """A text without characters that XML 1.0 has no way to write."""
    return _FORBIDDEN.sub("\ufffd", text)

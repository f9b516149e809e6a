"""Ids of test cases."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import Any

_ENCODE = json.JSONEncoder(sort_keys=True, separators=(",", ":")).encode


def case_id(target: str, params: Mapping[str, Any], going_in: Sequence[tuple[int | str, Any]]) -> str:
    """The id of a case: a hash of what goes in, so that it survives when expectations or order change.

    `going_in` holds for each scan the time and the inputs that change, or "refuse" and the request.
    """
    return id_of_text(target, params, _ENCODE(going_in)[1:-1])


def id_of_text(target: str, params: Mapping[str, Any], going_in: str) -> str:
    """As `case_id`, for changes that are written already: `[10,{"A":true}],[10,{}]`."""
    text = f"[{_ENCODE(params)},[{going_in}]]"
    return f"{target}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"

"""What the proofs of a document rest on, from their evidence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Record = Mapping[str, Any]


def never_needed(records: Sequence[Record]) -> list[str]:
    """Premises, by name, that some theorem has and no proof of any theorem needs."""
    names = dict.fromkeys(name for record in records for name in record["result"]["unused"])
    needed = {
        name
        for record in records
        for name in record["result"]["premises"]
        if name not in record["result"]["unused"]
    }
    return [name for name in names if name not in needed]

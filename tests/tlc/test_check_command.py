"""`check --trace`: words stand in hex, with what they mean where they stand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from modeproof.ground.places import TREE
from modeproof.tlc import check_command as command

TABLES = {"RE": [[0, 0x0F0F], [1, 0x0FF0]], "SE": [[0, 0x0FF0]]}
WIRES = {"MW01": 0x0FF0, "MW03": 0x0FF0, "MW05": 0, "MW07": 0x1234, "LA": True, "dt": 15, "active": [1]}
SHOWN = {"MW01": "0FF0 (level 1)", "MW03": "0FF0 (mode 0)", "MW05": "0000", "MW07": "1234"}


def test_words_are_shown_with_what_they_mean_there(monkeypatch: pytest.MonkeyPatch) -> None:
    walk = {"tables": TABLES, "rows": [{"wires": WIRES}]}
    monkeypatch.setattr(command, "recorded", lambda record: record)
    monkeypatch.setattr(command, "read_walk", lambda place, document, trace: walk)
    checked: Any = SimpleNamespace(run=SimpleNamespace(document="mode_selection"), record={})
    tools: Any = None
    (row,) = command.on_the_wires(TREE, checked, tools)
    assert row == {**SHOWN, "LA": "TRUE", "dt": "15", "active": "[1]"}
    TABLES["SW"] = [[0, 0x33CC]]
    (row,) = command.on_the_wires(TREE, checked, tools)
    assert row["MW07"] == "1234 (no code)"

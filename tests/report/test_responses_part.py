"""The part of the response times: each row with its bound and its theorem, and what no theorem shows."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.report.parts.responses import part
from modeproof.report.sources import HOLE, gather
from tests.report.paper import change, make_paper

ROWS = """
document = "box"
[example]
cycle = { box = 10 }
times = { T_HOLD_ms = 7 }
transfer = 5

[[response]]
id = "BXR-1"
device = "box"
from = "a door is there"
to = "it shuts"
clauses = ["BX-1-1"]
calls = 1
times = { T_HOLD_ms = 1 }

[[response]]
id = "BXR-2"
device = "box"
from = "it is open"
to = "a door comes"
clauses = ["BX-1-2"]
unbounded = "nobody brings it"

[[chain]]
id = "BXC-1"
title = "door to shut to shut"
steps = ["BXR-1", "box BXR-1"]
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with response times, and its theorem names them."""
    root = make_paper(tmp_path)
    (root / "spec" / "box" / "response.toml").write_text(ROWS)
    change(root / "proofs" / "box" / "box_safety.py", '["E-01"],', '["E-01"], responses=["BXR-1", "BXR-2"],')
    return root


def test_each_row_has_its_time_and_its_theorem(root: Path) -> None:
    found = part(gather(root))
    (document,) = found.data["documents"]
    first, second = document["rows"]
    assert (first.formula, first.example) == ("T_HOLD + 3 C(box)", "37 ms")
    assert (second.formula, second.example) == ("none: nobody brings it", "none")
    assert first.shown == second.shown == ("it_shuts_over_the_door_only",)
    assert [chain.example for chain in document["chains"]] == ["79 ms"]
    assert found.troubles == ()


@pytest.mark.parametrize("named", ["BXR-1", "BXR-2"])
def test_a_row_that_no_theorem_names_is_a_hole(root: Path, named: str) -> None:
    other = {"BXR-1": "BXR-2", "BXR-2": "BXR-1"}[named]
    change(root / "proofs" / "box" / "box_safety.py", '["BXR-1", "BXR-2"]', f'["{named}"]')
    (trouble,) = part(gather(root)).troubles
    assert (trouble.status, trouble.what) == (HOLE, f"box: no theorem names {other}")

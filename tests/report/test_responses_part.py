"""The part of the response times: each row with its bound and its theorem, and what no theorem shows."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.report.parts.responses import part
from modeproof.report.sources import HOLE, gather
from tests.report.paper import change, make_paper
from tests.stated_times import stated_times


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with response times, and its theorem names them."""
    root = make_paper(tmp_path)
    with (root / "spec" / "box" / "properties.toml").open("a") as file:
        file.write(stated_times("box", "box", "BX"))
    change(root / "proofs" / "box" / "box_safety.py", '["E-01"],', '["E-01"], responses=["BXR-1", "BXR-2"],')
    return root


def test_each_row_has_its_time_and_its_theorem(root: Path) -> None:
    found = part(gather(root))
    (document,) = found.data["documents"]
    first, second = document["rows"]
    assert (first.formula, first.example) == ("T_HOLD + 4 C(box)", "240 ms")
    assert (second.formula, second.example) == ("none: a person is waited for", "none")
    assert first.shown == second.shown == ("it_shuts_over_the_door_only",)
    assert [chain.example for chain in document["chains"]] == ["492 ms"]
    assert found.troubles == ()


@pytest.mark.parametrize("named", ["BXR-1", "BXR-2"])
def test_a_row_that_no_theorem_names_is_a_hole(root: Path, named: str) -> None:
    other = {"BXR-1": "BXR-2", "BXR-2": "BXR-1"}[named]
    change(root / "proofs" / "box" / "box_safety.py", '["BXR-1", "BXR-2"]', f'["{named}"]')
    (trouble,) = part(gather(root)).troubles
    assert (trouble.status, trouble.what) == (HOLE, f"box: no theorem names {other}")

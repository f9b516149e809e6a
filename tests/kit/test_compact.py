"""The compact form gives the same rows, or is refused; what was done to its bytes is noticed or harmless."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modeproof.kit.compact import compact, expand, same
from modeproof.kit.errors import Unjudged
from modeproof.kit.suite_judge import run_suite
from modeproof.kit.vectors import open_suite, read_lines
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import write_suite
from tests.any_machine import SHARED_FIXTURE
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp, Late


def lines(folder: Path, name: str) -> list[bytes]:
    write_suite(folder / f"{name}.jsonl", name, [lamp_graph(folder)])
    return list(read_lines(folder / f"{name}.jsonl"))


@pytest.mark.parametrize("name", [name for name, kind in SUITES.items() if kind.always or name == "words"])
def test_a_suite_comes_back_row_by_row_or_is_refused(name: str, tmp_path: Path) -> None:
    before = lines(tmp_path, name)
    if name in ("refusals", "sic"):
        with pytest.raises(ValueError, match="another kind"):
            compact(before)
        return
    data = compact(before)
    assert data == compact(before) and same(before, data)
    assert list(expand(data)) == [json.loads(line) for line in before]


def test_in_an_archive_it_is_a_suite_like_any_other(tmp_path: Path) -> None:
    before = lines(tmp_path, "tour")
    with zipfile.ZipFile(tmp_path / "kit.pyz", "w") as archive:
        archive.writestr("tour.compact", compact(before))
    plain, packed = open_suite(tmp_path / "tour.jsonl"), open_suite(tmp_path / "kit.pyz", "tour.compact")
    assert list(plain.cases()) == list(packed.cases())
    assert run_suite(packed, Lamp).word == "CONFORMS"
    wrong = run_suite(packed, Late).difference
    assert wrong is not None and wrong.case.id == next(plain.cases()).id
    with pytest.raises(Unjudged, match=r"none\.compact"):
        open_suite(tmp_path / "kit.pyz", "none.compact")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"to":1', '"to":2'),
        ('"column":3', '"column":4'),
        ('"LAMP":true', '"LAMP":false'),
        ('"dt_ms":250', '"dt_ms":0'),
    ],
)
def test_another_row_is_another_file(tmp_path: Path, old: str, new: str) -> None:
    before = lines(tmp_path, "tour")
    data = compact(before)
    other = [before[0], before[1].replace(old.encode(), new.encode(), 1), *before[2:]]
    assert other != before and not same(other, data)


def test_what_it_is_not_for_is_refused(tmp_path: Path) -> None:
    before = lines(tmp_path, "tour")
    row = json.loads(before[1])
    row["scans"][-1]["to"] = 2 - row["scans"][-1]["to"]
    with pytest.raises(ValueError, match=r"lead to two states|show two rows"):
        compact([before[0], *before[1:], json.dumps(row).encode()])


@settings(suppress_health_check=SHARED_FIXTURE, deadline=None, max_examples=60)
@given(st.data())
def test_damage_is_noticed_or_changes_nothing(tmp_path: Path, data: st.DataObject) -> None:
    before = lines(tmp_path, "brief")
    packed = compact(before)
    at = data.draw(st.integers(0, len(packed) - 1))
    byte = data.draw(st.integers(0, 255))
    harmed = data.draw(st.sampled_from([packed[:at], packed[:at] + bytes([byte]) + packed[at + 1 :]]))
    try:
        rows = list(expand(harmed))
    except Unjudged as error:
        assert "\n" not in str(error)
    else:
        assert rows == [json.loads(line) for line in before]

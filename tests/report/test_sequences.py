"""The sequences of a document in the report: scan by scan, what changed, whose answer it is, and a hole where
there are none.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.report.build import make
from modeproof.report.parts.traces import part
from modeproof.report.sources import Figure, Trouble, gather
from tests.report.box_vectors import CASES, FILE, FIRST, SHUTS, WAITS, case, put_vectors, scan
from tests.report.paper import change, make_paper

LINK = f"trace-box-{SHUTS}"
REMEDY = "modeproof renew"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with its sequences."""
    make_paper(tmp_path)
    put_vectors(tmp_path)
    return tmp_path


def told(root: Path, link: str = LINK) -> dict[str, Any]:
    """What the viewer reads of a sequence."""
    found: dict[str, Any] = json.loads(part(gather(root)).payload["trace-stories"])[link]
    return found


def listed(root: Path) -> dict[str, Any]:
    """What the page says of the sequences of the box."""
    (found,) = part(gather(root)).data["documents"][0]["sequences"]
    assert isinstance(found, dict)
    return found


def holes(root: Path) -> list[Trouble]:
    """The troubles that the sequences make; the counterexamples of the paper have one of their own."""
    return [one for one in part(gather(root)).troubles if one.remedy == REMEDY]


def test_a_scan_shows_all_values_though_files_hold_only_changes(root: Path) -> None:
    one = told(root)
    assert one["columns"] == ["after", "door", "box is in", "WORD", "LAMP"]
    assert [row["cells"] for row in one["rows"]] == [
        ["", "", "Open", "", ""],
        ["10 ms", "0", "Open", "0", "0"],
        ["20 ms", "1", "Shut", "0F10 = code 1", "1"],
        ["0 ms", "0", "Shut", "0F10 = code 1", "1"],
    ]
    assert [row["step"] for row in one["rows"]] == ["power-up", "Wait", "Close", "Stay"]
    assert one["constant"] == "SPARE 0"


def test_only_a_changed_cell_is_marked(root: Path) -> None:
    assert [row["changed"] for row in told(root)["rows"]] == [[], [], [1, 2, 3, 4], [1]]
    html = make(root).html
    marked = '<b><span aria-hidden="true">▸</span>{}</b>'
    cells = f"<td>20 ms</td><td>{marked.format(1)}</td><td>{marked.format('Shut')}</td>"
    assert cells in html
    assert f"<td>0 ms</td><td>{marked.format(0)}</td><td>Shut</td>" in html


def test_changes_run_from_inputs_through_the_device_to_outputs(root: Path) -> None:
    one = told(root)
    assert [lane["title"] for lane in one["lanes"]] == ["inputs", "box", "outputs"]
    _, device, end = (lane["id"] for lane in one["lanes"])
    assert one["rows"][2]["messages"] == [
        {"source": "", "target": device, "signals": ["door 1"]},
        {"source": device, "target": end, "signals": ["LAMP 1", "WORD 0F10 = code 1"]},
    ]
    assert [len(row["messages"]) for row in one["rows"]] == [0, 2, 2, 1]
    assert [row["states"][device] for row in one["rows"]] == ["Open", "Open", "Shut", "Shut"]


def test_a_sequence_says_what_happens_who_demands_it_and_clauses(root: Path) -> None:
    first, second = told(root), told(root, f"trace-box-{WAITS}")
    assert (first["kind"], first["document"], first["run"]) == ("sequence", "box", SHUTS)
    assert (first["why"], first["basis"]) == ("The door comes and the box shuts.", "document")
    assert (first["clauses"], first["parameters"], first["findings"]) == (["BX-1-1"], "T_HOLD_ms 1", [])
    assert (second["clauses"], second["findings"]) == (["BX-1-1", "BX-1-2"], ["E-01"])
    html = make(root).html
    row = html.split(f'<tr id="trace-box-{WAITS}">')[1].split("</tr>")[0]
    assert f'<a class="trace" href="#trace-box-{WAITS}">' in row and "No door comes." in row
    for link in ("#clause-BX-1-1", "#clause-BX-1-2", "#finding-E-01"):
        assert f'href="{link}"' in row
    assert f'data-source="{FILE}">1</span>' in row


def test_its_file_is_one_that_the_report_rests_on(root: Path) -> None:
    sources = gather(root)
    found = part(sources)
    assert FILE in sources.files and not [one for one in found.troubles if one.remedy == REMEDY]
    rows = found.data["documents"][0]["sequences"][0]["cases"]
    assert [one["scans"] for one in rows] == [Figure(3, FILE), Figure(1, FILE)]


def test_paper_has_the_first_sequence_and_all_keep_file_order(root: Path) -> None:
    found = listed(root)
    assert [one["case"] for one in found["cases"]] == [one["id"] for one in CASES] == [SHUTS, WAITS]
    assert [one["case"] for one in found["first"]] == [SHUTS] and len(found["first"][0]["rows"]) == 4


def test_a_word_without_meaning_in_its_place_is_no_code(root: Path) -> None:
    put_vectors(root, case(SHUTS, "A wrong word.", FIRST, scan(0, "Wait", 0, {}, {"WORD": "0F11"})))
    assert told(root)["rows"][2]["cells"] == ["0 ms", "0F11 = no code"]
    assert told(root)["constant"] == "door 0, box is in Open, LAMP 0, SPARE 0"


def _cut(root: Path) -> None:
    path = root / FILE
    path.write_bytes(path.read_bytes()[:-20])


def _plain(root: Path) -> None:
    (root / FILE).write_text("{}")


def _gone(root: Path) -> None:
    (root / FILE).unlink()
    change(root / "spec/box/interface.toml", "published = false", "published = true")


def _other_text(root: Path) -> None:
    with (root / "spec/box/Box.tla").open("a") as stream:
        stream.write("\n")  # layout is no change
    (root / "spec/box/sequences.toml").write_text("")


FAULTS: dict[str, Callable[[Path], Any]] = {
    "is no file of vectors (EOFError)": _cut,
    "is no file of vectors (BadGzipFile)": _plain,
    "is not there": _gone,
    "is of another text: spec/box/sequences.toml has changed": _other_text,
    "is of another text: spec/box/interface.toml and 3 more": lambda root: (
        root / "vectors/SHA256SUMS"
    ).unlink(),
    "holds 2 cases and says 3": lambda root: put_vectors(root, cases=3),
    "holds other vectors: box box brief": lambda root: put_vectors(root, suite="brief"),
    "is no file of vectors (KeyError)": lambda root: put_vectors(root, steps=[{}, {}, {}]),
    "is no file of vectors (IndexError)": lambda root: put_vectors(root, steps=[]),
    "is no file of vectors (TypeError)": lambda root: put_vectors(root, graphs=None),
    "is no file of vectors (ValueError)": lambda root: put_vectors(
        root, case(SHUTS, "It says nothing of the door.", {**FIRST, "in": {}})
    ),
}


@pytest.mark.parametrize("what", FAULTS)
def test_a_damaged_missing_or_foreign_file_is_a_hole(root: Path, what: str) -> None:
    assert not holes(root)
    FAULTS[what](root)
    (hole,) = holes(root)
    assert f"box: the sequences of box cannot be shown: {FILE} {what}" in hole.what
    found = listed(root)
    assert what in found["hole"] and found["cases"] == found["first"] == []
    assert "sequence" not in {
        one["kind"] for one in json.loads(part(gather(root)).payload["trace-stories"]).values()
    }


def test_the_hole_replaces_the_sequences_and_leaves_the_report_incomplete(root: Path) -> None:
    _cut(root)
    report = make(root)
    place = report.html.split('<h4 id="sequences-box-box">')[1].split("<h4")[0]
    assert f"{FILE} is no file of vectors" in place and f"<code>{REMEDY}</code>" in place
    assert report.status == 2


def test_a_device_without_diagrams_needs_no_file(root: Path) -> None:
    _gone(root)
    assert len(holes(root)) == 1
    (root / "spec/box/sequences.toml").write_text("")
    assert not holes(root)


def test_hostile_text_of_a_file_is_escaped(root: Path) -> None:
    evil = "</script><script>alert(1)</script>"
    put_vectors(
        root,
        case(f'{SHUTS}"{evil}', evil, FIRST, clauses=[evil], basis=f"finding:{evil}", params={evil: evil}),
        guarantees=evil,
        does_not_show=evil,
    )
    assert told(root, f'{LINK}"{evil}')["why"] == evil
    html = make(root).html
    assert "<script>alert(1)" not in html and "&lt;script&gt;alert(1)" in html

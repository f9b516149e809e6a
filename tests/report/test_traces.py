"""Traces in the report: who did what, what ran between whom, what changed, and a hole where one is cut."""

from __future__ import annotations

import gzip
import json
from base64 import b64decode
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.registers.load import load_document
from modeproof.report.build import make
from modeproof.report.parts.traces import part
from modeproof.report.sources import HOLE, NOTE, gather
from modeproof.report.story import digest_of, in_flow
from modeproof.tlc.walk import trace_digest
from tests.report.paper import RESULT, make_paper, put
from tests.report.test_system import WATCH

OPEN: dict[str, str] = {"boxState": '"Open"', "shut": "0", "step": '""', "door": "FALSE"}
SHUT: dict[str, str] = {"boxState": '"Shut"', "shut": "1", "step": '"Close"', "door": "FALSE"}
WIRES = {"door": False, "dt": 1, "WORD": 0, "LAMP": False, "SPARE": False}
ON = {**WIRES, "WORD": 3856, "LAMP": True}
LINK = "trace-box-NEG_Box_eager"


def recorded(*states: Mapping[str, str]) -> list[dict[str, Any]]:
    """A trace as the model checker records it."""
    return [
        {"number": n, "action": "Next" if n > 1 else "Initial predicate", "variables": dict(one)}
        for n, one in enumerate(states, 1)
    ]


TRACE = recorded(OPEN, SHUT)


def walk(**changes: Any) -> dict[str, Any]:
    """The walk of that trace."""
    rows = [
        {
            "at": 1,
            "step": "",
            "who": "",
            "wires": WIRES,
            "variables": {"boxState": "Open", "shut": 0, "door": False},
        },
        {
            "at": 2,
            "step": "Close",
            "who": "box",
            "wires": ON,
            "variables": {"boxState": "Shut", "shut": 1, "door": False},
        },
    ]
    scan = {"at": 2, "step": "Wait", "memory": {"boxState": "Open", "shut": 0}, "read": {}}
    scan["outputs"] = {"WORD": 0, "LAMP": False, "SPARE": False}
    return {
        "module": "BoxOpen",
        "run": "NEG_Box_eager",
        "rows": rows,
        "decided": {"box": [scan]},
        "departures": {"box": [{"at": 2, "step": "Wait"}]},
        "tables": {"CODE": [[0, 3855], [1, 3856]]},
        "outputs": ["LAMP", "SPARE", "WORD"],
        "after": [],
        "inputs": {},
        "trace_sha256": digest_of(TRACE),
        **changes,
    }


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with two counterexamples, one of them walked."""
    make_paper(tmp_path)
    for name in ("NEG_Box_eager", "NEG_Box_hasty"):
        put(tmp_path, name, result={"trace": TRACE})
    lay(tmp_path, walk())
    return tmp_path


def lay(root: Path, content: dict[str, Any]) -> None:
    """Write the walk of the first counterexample."""
    path = root / "build/walks/box/NEG_Box_eager.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content))


def told(root: Path, link: str = LINK) -> dict[str, Any]:
    """What the viewer reads of a trace."""
    found: dict[str, Any] = json.loads(part(gather(root)).payload["trace-stories"])[link]
    return found


def test_a_step_says_who_executed_what_where_and_what_changed(root: Path) -> None:
    one = told(root)
    assert [lane["title"] for lane in one["lanes"]] == ["environment", "box"]
    assert one["columns"] == ["box is in", "WORD", "lamps"]
    first, second = one["rows"]
    assert (first["step"], first["cells"], first["changed"]) == ("power-up", ["Open", "0", "none"], [])
    assert (second["step"], second["who"], second["by"]) == ("Close", "box", "box")
    assert second["cells"] == ["Shut", "0F10 = code 1", "lamp"]
    assert second["states"] == {"box": "Shut"}
    assert second["messages"] == [
        {"source": "box", "target": "", "signals": ["WORD 0F10 = code 1", "LAMP 1"]}
    ]
    assert one["constant"] == "door 0, SPARE 0"
    assert (one["property"], one["findings"], one["wires"]) == ("ShutsOverDoor", ["E-01"], True)


def test_only_a_changed_cell_is_marked(root: Path) -> None:
    assert told(root)["rows"][1]["changed"] == [0, 1, 2]
    assert '<td><b><span aria-hidden="true">▸</span>Shut</b></td>' in make(root).html
    still = walk()
    still["rows"] = [
        *still["rows"],
        {**still["rows"][1], "at": 3, "step": "Stay", "wires": {**ON, "door": True}},
    ]
    put(root, "NEG_Box_eager", result={"trace": recorded(OPEN, SHUT, SHUT), "trace_length": 3})
    lay(root, {**still, "trace_sha256": digest_of(recorded(OPEN, SHUT, SHUT))})
    one = told(root)
    assert one["columns"][0] == "door" and one["rows"][2]["changed"] == [0]
    assert one["rows"][2]["messages"] == [{"source": "", "target": "box", "signals": ["door 1"]}]


def test_a_row_says_how_the_decided_device_does_otherwise(root: Path) -> None:
    (text,) = told(root)["rows"][1]["instead"]
    assert text == "box, as decided: Wait instead of Close; WORD 0, not 0F10 = code 1; LAMP 0, not 1"
    assert told(root)["rows"][0]["instead"] == []


def test_the_digest_of_a_trace_is_that_of_its_walk() -> None:
    assert digest_of(TRACE) == trace_digest({"result": {"trace": TRACE}})


@pytest.mark.parametrize(
    "changes", [{"trace_sha256": "0" * 64}, {"inputs": {"spec/box/Box.tla": "0" * 64}}, {"rows": []}]
)
def test_a_foreign_walk_is_hidden_but_its_variables_are_shown(root: Path, changes: dict[str, Any]) -> None:
    lay(root, walk(**changes))
    one = told(root)
    assert not one["wires"] and one["columns"] == ["boxState", "shut"]
    assert one["rows"][1]["cells"] == ['"Shut"', "1"] and one["rows"][1]["states"] == {"box": "Shut"}
    assert one["rows"][1]["who"] == "box" and one["rows"][1]["changed"] == [0, 1]
    notes = [trouble for trouble in part(gather(root)).troubles if trouble.status == NOTE]
    assert notes[0].items == ("NEG_Box_eager", "NEG_Box_hasty")


def test_a_shown_walk_is_a_file_the_report_rests_on(root: Path) -> None:
    sources = gather(root)
    part(sources)
    assert "build/walks/box/NEG_Box_eager.json" in sources.files


@pytest.mark.parametrize(
    "trace",
    [
        None,
        [],
        "text",
        TRACE[:1],
        [TRACE[1]],
        [TRACE[0], {"number": 2}],
        [TRACE[0], {"number": 2, "variables": {"boxState": '"Shut"'}}],
        [TRACE[0], {"number": 2, "variables": {**SHUT, "shut": 1}}],
    ],
)
def test_a_trace_that_is_cut_is_a_hole(root: Path, trace: Any) -> None:
    put(root, "NEG_Box_eager", result={"trace": trace})
    found = part(gather(root))
    (hole,) = [one for one in found.troubles if one.status == HOLE]
    assert hole.items == ("NEG_Box_eager",) and "without a whole counterexample" in hole.what
    assert LINK not in json.loads(found.payload["trace-stories"])
    assert "NEG_Box_eager" in make(root).html


def test_each_trace_has_its_link_and_the_page_its_story(root: Path) -> None:
    html = make(root).html
    assert f'<tr id="{LINK}"><td><a class="trace" href="#{LINK}">' in html
    packed = html.split('<script type="application/gzip" id="trace-stories">')[1].split("<")[0]
    assert json.loads(gzip.decompress(b64decode(packed)))[LINK]["run"] == "NEG_Box_eager"


def test_the_shortest_trace_of_a_finding_stands_on_paper(root: Path) -> None:
    (one,) = part(gather(root)).data["documents"][0]["shortest"]
    assert (one["findings"], one["run"]) == (["E-01"], "NEG_Box_eager")
    put(root, "NEG_Box_eager", result={"trace": recorded(OPEN, OPEN, SHUT), "trace_length": 3})
    (one,) = part(gather(root)).data["documents"][0]["shortest"]
    assert one["run"] == "NEG_Box_hasty"


def test_hostile_text_of_the_evidence_is_escaped(root: Path) -> None:
    evil = '"</script><script>alert(1)</script>"'
    trace = recorded(OPEN, {**SHUT, "boxState": evil})
    put(root, "NEG_Box_hasty", result={"trace": trace, "violated": evil})
    put(root, "NEG_Box_eager", result={"trace": recorded(OPEN, OPEN, SHUT), "trace_length": 3})
    assert told(root, "trace-box-NEG_Box_hasty")["rows"][1]["cells"][0] == evil
    assert "<script>alert(1)" not in make(root).html


def test_lanes_stand_so_that_signals_run_short_ways(root: Path) -> None:
    with (root / "spec/box/interface.toml").open("a") as stream:
        stream.write(WATCH.replace("LAMP =", "seen ="))
    document = load_document(root, "box")
    # one signal from outside to the watch, three from the box to the outside: the box stands next to it
    assert in_flow(document, ("watch", "box")) == ("box", "watch")


def test_without_any_trace_the_page_says_so(tmp_path: Path) -> None:
    make_paper(tmp_path)
    for run in ("NEG_Box_eager", "NEG_Box_hasty"):
        put(tmp_path, run, result={"trace": RESULT[run]["trace"][:1]})
    found = part(gather(tmp_path))
    assert found.payload == {} and [one.status for one in found.troubles] == [HOLE]
    html = make(tmp_path).html
    assert "There is no counterexample in the evidence of this document." in html
    assert 'id="trace-viewer"' not in html


def test_a_counterexample_that_only_another_lane_runs_is_no_hole(root: Path) -> None:
    (root / "build/evidence/box/NEG_Box_eager.json").unlink()
    holes = [one for one in part(gather(root)).troubles if one.status == HOLE]
    assert [one.items for one in holes] == [("NEG_Box_eager",)]
    runs = root / "spec/box/runs.toml"
    text = runs.read_text()
    at = text.index("lane", text.index('id = "NEG_Box_eager"'))
    end = text.index("\n", at)
    runs.write_text(f'{text[:at]}lanes = ["exhaustive"]{text[end:]}')
    assert [one for one in part(gather(root)).troubles if one.status == HOLE] == []

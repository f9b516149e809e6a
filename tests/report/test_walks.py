"""`modeproof walks` follows every counterexample once, and says which it could not follow."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from modeproof.cli import main
from modeproof.ground.places import root
from modeproof.registers.load import load_interface
from modeproof.registers.replay import load_replay
from modeproof.registers.tla import read_modules
from modeproof.report.parts.traces import part
from modeproof.report.sources import gather
from modeproof.tlc.walk_module import Plan, everywhere, present
from tests.report.paper import change


def test_each_counterexample_is_walked_once_and_its_wires_shown(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = checked / "build/walks/box"
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(before) == {"NEG_Box_eager.json", "NEG_Box_hasty.json"}
    (folder / "NEG_Box_eager.json").unlink()
    kept = (folder / "NEG_Box_hasty.json").stat().st_mtime_ns
    assert main(["walks", "--quiet"]) == 0
    assert "box/BoxOpen: 2 traces followed" in capsys.readouterr().out
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert (folder / "NEG_Box_hasty.json").stat().st_mtime_ns == kept
    told = json.loads(part(gather(checked)).payload["trace-stories"])["trace-box-NEG_Box_eager"]
    assert told["wires"] and told["rows"][1]["messages"][0]["signals"] == ["LAMP 1", "WORD 0F10 = code 1"]
    assert told["rows"][1]["instead"] == [
        "box, as decided: Wait instead of Close; LAMP 0, not 1; WORD 0, not 0F10 = code 1"
    ]


def test_a_walk_asks_only_for_what_it_needs(checked: Path) -> None:
    """What TLC would evaluate anew wherever it is named: instances that nothing uses, and whole tables."""
    folder = checked / "build/walk/box/BoxOpen"
    shutil.rmtree(checked / "build/walks")
    assert main(["walks", "--quiet"]) == 0
    text = (folder / "Walk_BoxOpen.tla").read_text()
    assert re.findall(r"^(\w+) == INSTANCE", text, re.MULTILINE) == ["A1", "L1", "D1_box"]
    assert "CONSTANT TLCEval <- [Box]walk_TLCEval\n" in (folder / "Walk_BoxOpen.cfg").read_text()


def test_a_module_with_copies_alone_stays_out_of_the_cfg() -> None:
    """TLC refuses a cfg that names a module which no instance has under its own name."""
    plan = cast(Plan, SimpleNamespace(modules=read_modules(root(), "edm")))
    there = present(plan, "L1 == INSTANCE Walk_EDMOpen__1\nD1_sf_edm == INSTANCE EDM WITH state <- d_state")
    assert there == {"EDM", "CyclicBlock", "StepName"}
    assert everywhere([], "TLCEval", "EDMOpen", there) == ""
    assert everywhere([], "TLCEval", "EDM", there) == "CONSTANT TLCEval <- [EDM]walk_TLCEval\n"


def test_a_scan_without_a_step_has_its_device() -> None:
    """Where a model has one device; in the whole system nobody can say whose it would be."""
    traces = load_replay(root(), "mode_selection")
    for module, who in (("PlcDemands", "plc"), ("KeyFlows", "")):
        interface, modules = load_interface(root(), "mode_selection"), read_modules(root(), "mode_selection")
        plan = Plan("mode_selection", module, traces.tops[module], traces, interface, modules)
        assert plan.who({"step": '"CopyMW03"'}, {"step": '"NoStep"'}) == who


def test_a_module_that_the_register_does_not_declare_is_named(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    replay = checked / "spec/box/replay.toml"
    replay.write_text(replay.read_text().replace("tops.BoxOpen", "tops.BoxShut"))
    assert main(["walks", "--quiet", "--document", "box"]) == 2
    assert "box/BoxOpen: 2 traces: UNJUDGED: spec/box/replay.toml declares no top BoxOpen" in (
        capsys.readouterr().out
    )


def test_a_trace_the_specification_forbids_is_not_followed(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(
        checked / "spec/box/Box.tla",
        "boxState' = \"Shut\" /\\ shut' = 1",
        "boxState' = \"Shut\" /\\ shut' = 0",
    )
    assert main(["walks", "--quiet"]) == 2
    assert "UNJUDGED: " in capsys.readouterr().out


def test_an_unknown_document_is_one_line(checked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["walks", "--document", "bax"]) == 2
    assert "unknown document 'bax'; did you mean 'box'?" in capsys.readouterr().err

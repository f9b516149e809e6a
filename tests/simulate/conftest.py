"""The page of this tree, made once, opened once for the tests that only play; and scenes without a page."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

from modeproof.cli import main
from modeproof.ground import evidence
from modeproof.ground.places import documents
from modeproof.registers.load import load_document
from modeproof.report.story import digest_of
from modeproof.simulate import facts
from modeproof.simulate.program.block import Block
from scenes.mode_selection.scene import Scene
from tests.report.browser.opened import Opened, open_page

ROOT = Path(__file__).resolve().parents[2]
READY = "() => window.modeproofReady !== undefined"
SCENE = "mode_selection"


@pytest.fixture(scope="session")
def known() -> dict[str, Any]:
    """The facts of every document."""
    return {name: facts.of_document(load_document(ROOT, name)) for name in documents(ROOT)}


@pytest.fixture(scope="session")
def told() -> dict[str, Any]:
    """The stories by their ids."""
    return {story["id"]: story for story in facts.stories(ROOT, [SCENE])}


@pytest.fixture(scope="session")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of this tree."""
    path = tmp_path_factory.mktemp("simulate") / "simulate.html"
    assert main(["simulate", "--out", str(path)]) == 0
    return path


RUN = "NEG_Fplc_figure7"
WIRES = {
    "LA": True, "A": False, "B": False, "C": True, "D": False, "STR": False, "MW01": 0x3333,
    "MW03": 0x33CC,
         "MW05": 0x3C3C, "MW07": 0x0FF0, "MSO_0": False, "MSO_1": False, "MSO_2": False, "MSO_3": False,
         "MSO_4": False, "ERROR": False,
}  # fmt: skip


@pytest.fixture
def recorded_place(tmp_path: Path) -> Path:
    """A tree with one counterexample of two states in its evidence, and the walk of it."""
    for folder in ("spec", "refimpl", "scenes", "proofs"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    states = [{"fplcState": "Switch"}, {"fplcState": "Settle"}]
    trace = [
        {"number": n, "variables": {"fplcState": f'"{one["fplcState"]}"'}} for n, one in enumerate(states, 1)
    ]
    record = evidence.make(
        kind="tlc", id=RUN, document=SCENE, verdict="VIOLATED", expected="VIOLATED", as_expected=True,
        command=f"modeproof check {RUN}", started=0.0, seconds=1.0, result={"trace": trace},
    )  # fmt: skip
    evidence.write(tmp_path, record)
    wires = [WIRES, {**WIRES, "MSO_3": True, "MW01": 0, "MW05": 0}]
    steps = [("", ""), ("SwitchMode", "fplc")]
    rows = [
        {"at": n, "step": step, "who": who, "wires": wires[n], "variables": states[n]}
        for n, (step, who) in enumerate(steps)
    ]
    walk = {"rows": rows, "module": "FplcOpen", "decided": {}, "departures": {}, "tables": {}}
    walk |= {"trace_sha256": digest_of(trace)}
    path = tmp_path / "build/walks" / SCENE / f"{RUN}.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps(walk), encoding="utf-8")
    return tmp_path


@pytest.fixture(scope="module")
def opened(browser: Browser, page_file: Path) -> Iterator[Opened]:
    """The page, ready, opened once for a module."""
    with open_page(browser, page_file) as page:
        page.page.wait_for_function(READY)
        yield page


def scenes_of(story: dict[str, Any], known: dict[str, Any]) -> list[Any]:
    """The scenes that a story is played in, without a browser."""
    cells = [cell["params"] for cell in story.get("cell", [{"params": {}}])]
    if story["of"] == SCENE:
        return [Scene(known[SCENE], params) for params in cells]
    about = next(about for about in known.values() if story["of"] in about["devices"])
    return [Block(story["of"], about, params) for params in cells]

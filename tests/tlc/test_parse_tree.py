"""The parse tree names every definition, takes actions apart, and says where each part stands."""

from __future__ import annotations

import subprocess
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.tlc.parse_tree import ParseTree, conjuncts, disjuncts, read_tree
from modeproof.tlc.toolchain import find_toolchain

SPEC = Path(__file__).resolve().parents[2] / "spec"

BASE = r"""
---- MODULE Base ----
EXTENDS Naturals
CONSTANTS N, STEP
VARIABLE x
ASSUME N \in Nat /\ STEP > 0
\* AB-1-1: a comment with a /\ in it
LOCAL Room(d) == x + d <= N   \* and another
Up(d) ==
    /\ Room(d) /\ x < 7     \* not part of the text
    /\ \/ x = 0
       \/ LET y == x + d IN y > 1 /\ y < 9
    /\ x' = IF d = 2 THEN x + d ELSE x
=====================
"""
TOP = r"""
---- MODULE Top ----
EXTENDS Base, Sequences
VARIABLE y
Next == \E d \in 1..2 : Up(d) /\ (Up(1) \/ Room2(<<d>>) \/ y = "a") /\ UNCHANGED y
====================
"""


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> ParseTree:
    folder, library = tmp_path_factory.mktemp("spec"), tmp_path_factory.mktemp("common")
    (library / "Base.tla").write_text(BASE)
    (folder / "Top.tla").write_text(TOP.replace(r"\/ Room2(<<d>>)", ""))
    return read_tree(folder, "Top", find_toolchain(), library)


def test_each_parser_unpacks_into_a_folder_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What one removes is not missed by the other."""
    run, places = subprocess.run, list[list[str]]()

    def told(command: list[str], **options: Any) -> Any:
        if "tla2sany.xml.XMLExporter" in command:
            places.append([one for one in command if one.startswith("-Djava.io.tmpdir=")])
        return run(command, **options)

    monkeypatch.setattr(subprocess, "run", told)
    (tmp_path / "Base.tla").write_text(BASE)
    for _ in range(2):
        read_tree(tmp_path, "Base", find_toolchain())
    [one], [other] = places
    assert one != other and not {one, other} & {f"-Djava.io.tmpdir={tempfile.gettempdir()}"}


def test_the_tree_has_all_our_definitions_and_no_standard_ones(tree: ParseTree) -> None:
    assert {module: list(found) for module, found in tree.definitions.items()} == {
        "Base": ["Room", "Up"],
        "Top": ["Next"],
    }
    assert (tree.constants["Base"], tree.variables) == (("N", "STEP"), {"Base": ("x",), "Top": ("y",)})
    assert [tree.text(one.place) for one in tree.assumes["Base"]] == [r"N \in Nat /\ STEP > 0"]
    up, room = tree.find("Up"), tree.find("Room")
    assert up is not None and room is not None and tree.find("Sideways") is None
    assert (up.params, up.local, up.level, str(up.place)) == (("d",), False, 2, "Base.tla:9")
    assert (room.local, room.level, tree.text(room.place)) == (True, 1, "LOCAL Room(d) == x + d <= N")


def test_an_action_is_taken_apart_whatever_its_layout(tree: ParseTree) -> None:
    up, following = tree.find("Up"), tree.find("Next")
    assert up is not None and following is not None
    parts = conjuncts(up.body)
    assert [(tree.text(one.place), one.place.first_line, one.level) for one in parts] == [
        ("Room(d)", 10, 1),
        ("x < 7", 10, 1),
        (r"\/ x = 0 \/ LET y == x + d IN y > 1 /\ y < 9", 11, 1),
        ("x' = IF d = 2 THEN x + d ELSE x", 13, 2),
    ]
    assert parts[0].kind == "defined" and parts[0].operator == "Room"
    assert [tree.text(one.place) for one in disjuncts(parts[2])] == [
        "x = 0",
        r"LET y == x + d IN y > 1 /\ y < 9",
    ]
    let = disjuncts(parts[2])[1]
    assert (let.kind, let.definitions[0].name) == ("let", "y")
    assert following.body.bound[0][0] == ("d",) and following.body.operator == "$BoundedExists"
    names = [one.operator for one in following.body.walk() if one.kind == "defined"]
    assert names == ["..", "Up", "Up"]
    assert any(one.kind == "string" and one.operator == "a" for one in following.body.walk())


def test_a_text_of_several_lines_is_had_as_it_stands(tree: ParseTree) -> None:
    up = tree.find("Up")
    assert up is not None
    text = tree.text(up.place, joined=False)
    assert text.startswith("Up(d) ==\n    /\\ Room(d)") and text.endswith("ELSE x")


def test_a_wrong_text_is_unjudged_and_its_place_is_named(tmp_path: Path) -> None:
    (tmp_path / "Base.tla").write_text(BASE)
    (tmp_path / "Top.tla").write_text(TOP)
    with pytest.raises(Unjudged, match=r"Top: cannot be parsed: line 5.*Room2"):
        read_tree(tmp_path, "Top", find_toolchain())
    (tmp_path / "Top.tla").write_text(TOP.replace("Next ==", "Next == )"))
    with pytest.raises(Unjudged, match=r"Top: cannot be parsed: .*Top"):
        read_tree(tmp_path, "Top", find_toolchain())
    with pytest.raises(Unjudged, match=r"Nothing.tla is missing"):
        read_tree(tmp_path, "Nothing", find_toolchain())


def test_the_steps_of_a_device_of_every_document_are_found() -> None:
    for document in sorted(path.parent.name for path in SPEC.glob("*/interface.toml")):
        devices = tomllib.loads((SPEC / document / "interface.toml").read_text())["devices"]
        device = next(iter(devices.values()))
        tree = read_tree(SPEC / document, device["module"], find_toolchain(), SPEC / "common")
        for step in device["steps"]:
            found = tree.find(step)
            assert found is not None and len(conjuncts(found.body)) > 1, step

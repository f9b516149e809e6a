"""The command: exit status, tables, and pages whose tables may not drift."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.registers import Unjudged, load_document
from modeproof.registers.findings_page import findings_pages
from modeproof.registers.tables import check_pages, pages, render_blocks
from tests.registers.test_document_page import made

Command = Callable[..., int]


def render(root: Path, page: str) -> str:
    """Render the blocks of a page; its text then."""
    loaded, path = [load_document(root, "door")], root / page
    assert path in pages(root)
    text = render_blocks(path.read_text(encoding="utf-8"), loaded, page)
    path.write_text(text, encoding="utf-8")
    return text


def test_a_sound_tree_gives_status_0_and_the_counts(
    tree: Any, registers_command: Command, capsys: pytest.CaptureFixture[str]
) -> None:
    assert registers_command(tree.root, "--matrix") == 0
    shown = capsys.readouterr().out
    assert (
        "door: 4 clauses (1 with action, 1 with step, 2 with property, 1 with theorem, 1 with vector)"
        in shown
    )
    assert "0 unresolved; 1 properties (1 by construction); 0 problems" in shown
    assert "Latch!CloseLatch +1" in shown and "latch/tour:CloseLatch +1" in shown


def test_a_problem_gives_status_1_and_its_line(
    tree: Any, registers_command: Command, capsys: pytest.CaptureFixture[str]
) -> None:
    tree.edit("spec/door/assumptions.toml", "DR-1-3", "DR-1-9")
    assert registers_command(tree.root) == 1
    assert "spec/door/assumptions.toml: A-01: cites DR-1-9" in capsys.readouterr().out


def test_what_cannot_be_read_is_never_a_pass(tree: Any, registers_command: Command) -> None:
    tree.write("spec/door/runs.toml", "")
    with pytest.raises(Unjudged):
        registers_command(tree.root)


def test_an_unknown_document_and_an_empty_tree_are_refused(tree: Any, registers_command: Command) -> None:
    with pytest.raises(Unjudged, match="did you mean 'door'"):
        registers_command(tree.root, "--document", "dooor")
    (tree.root / "spec/door/clauses.toml").unlink()
    with pytest.raises(Unjudged, match=r"spec/door/clauses\.toml: not found"):
        registers_command(tree.root)
    shutil.rmtree(tree.root / "spec/door")
    with pytest.raises(Unjudged, match="holds no document; there is nothing to do"):
        registers_command(tree.root)


def test_json_and_csv_hold_every_clause_in_full(tree: Any, registers_command: Command) -> None:
    out = tree.root / "build"
    assert registers_command(tree.root, "--json", str(out / "m.json"), "--csv", str(out / "m.csv")) == 0
    record = json.loads((out / "m.json").read_text(encoding="utf-8"))
    rows = record["documents"][0]["matrix"]
    assert [row["clause"] for row in rows] == ["DR-1-1", "DR-1-2", "DR-1-3", "DR-1-4"]
    assert rows[0]["vector"] == ["latch/tour:CloseLatch", "latch/tour:OpenLatch"]
    table = list(csv.DictReader((out / "m.csv").read_text(encoding="utf-8").splitlines()))
    assert len(table) == 4 and table[0]["vector"] == "latch/tour:CloseLatch latch/tour:OpenLatch"
    assert sorted(path.name for path in out.iterdir()) == ["m.csv", "m.json"]


def test_a_place_that_cannot_be_written_is_one_line(tree: Any, registers_command: Command) -> None:
    with pytest.raises(Unjudged, match="cannot be written"):
        registers_command(tree.root, "--json", str(tree.root / "README.md" / "m.json"))


def test_a_block_without_end_is_found(tree: Any) -> None:
    tree.write("README.md", "<!-- begin documents -->\n")
    problems = check_pages(tree.root, [load_document(tree.root, "door")])
    assert [str(problem) for problem in problems] == [
        "README.md: a rendered block has no end, or is malformed"
    ]


def test_a_picture_that_lost_signals_is_found_and_drawn_anew(tree: Any, registers_command: Command) -> None:
    tree.write("README.md", "<!-- begin picture door -->\n<!-- end picture -->\n")
    assert registers_command(tree.root) == 1
    text = render(tree.root, "README.md")
    latch = load_document(tree.root, "door").interface.devices["latch"]
    assert text.startswith("<!-- begin picture door -->\n```mermaid\nflowchart TB\n")
    assert all(name in text for name in [*latch.inputs, *latch.outputs])
    assert registers_command(tree.root) == 0
    tree.write("README.md", text.replace(next(iter(latch.inputs)), "lost"))
    assert registers_command(tree.root) == 1


def test_an_index_lists_each_document_with_its_page(tree: Any, registers_command: Command) -> None:
    tree.write("docs/README.md", "<!-- begin documents -->\n<!-- end documents -->\n")
    assert "- **`door`** A door. Targets: `latch`. [registers and TLA+](../spec/door).\n" in render(
        tree.root, "docs/README.md"
    )
    tree.write("docs/door.md", made(tree.root))
    for name, text in findings_pages(load_document(tree.root, "door")).items():
        tree.write(name, text)
    assert registers_command(tree.root) == 1, "a page that the index does not name"
    assert "[what was shown and found](door.md), [registers and TLA+]" in render(tree.root, "docs/README.md")
    assert registers_command(tree.root) == 0

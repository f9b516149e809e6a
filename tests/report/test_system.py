"""The system picture shows every signal of the registers once for each reader, from where it comes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from modeproof.report.build import make
from modeproof.report.parts.system import part
from modeproof.report.sources import gather
from tests.report.paper import change, make_paper

WATCH = """
[devices.watch]
title = "a watch: it looks at the lamp & tells"
module = "Box"
published = false
states = ["On"]
steps = ["Look"]
[devices.watch.memory]
[devices.watch.inputs]
LAMP = { type = "bool", clauses = ["BX-1-2"], why = "the lamp, as seen" }
[devices.watch.outputs]
door = { type = "bool", clauses = [], why = "it holds the door" }
[devices.watch.parameters]
"""


def document(root: Path) -> dict[str, Any]:
    """The data of the only document."""
    found: dict[str, Any] = part(gather(root)).data["documents"][0]
    return found


def test_a_single_block_shows_each_pin_at_its_side(tmp_path: Path) -> None:
    one = document(make_paper(tmp_path))
    assert [(row["from"], row["id"], row["to"]) for row in one["signals"]] == [
        ("box", "WORD", ""),
        ("box", "LAMP", ""),
        ("box", "SPARE", ""),
        ("", "door", "box"),
    ]
    svg = one["picture"].svg
    places = {
        name: float(re.search(rf'<text x="([\d.]+)"[^>]*>{name}: ', svg).group(1))  # type: ignore[union-attr]
        for name in ("door", "WORD", "LAMP", "SPARE")
    }
    assert places["door"] < places["WORD"] == places["LAMP"] == places["SPARE"]
    assert svg.count("marker-end") == 4 and ">BX-1-1</text>" in svg


def test_a_signal_runs_from_its_output_to_each_reading_device(tmp_path: Path) -> None:
    root = make_paper(tmp_path)
    with (root / "spec/box/interface.toml").open("a") as stream:
        stream.write(WATCH)
    one = document(root)
    rows = {row["id"]: row for row in one["signals"]}
    assert (rows["LAMP"]["from"], rows["LAMP"]["to"]) == ("box", "watch")
    assert rows["LAMP"]["clauses"] == ("BX-1-1", "BX-1-2")
    assert rows["LAMP"]["why"] == "it is shut; the lamp, as seen"
    assert (rows["door"]["from"], rows["door"]["to"]) == ("watch", "box")
    assert [row["id"] for row in one["signals"] if not row["to"]] == ["WORD", "SPARE"]
    svg = one["picture"].svg
    for ends in (("box", "watch"), ("watch", "box"), ("box", " to outside")):
        assert f'data-from="{ends[0]}" data-to="{ends[1]}"' in svg
    assert svg.count('class="link"') == 3 and "from outside" not in svg
    assert "lamp &amp;</text>" in svg


def test_a_renamed_signal_goes_outside(tmp_path: Path) -> None:
    root = make_paper(tmp_path)
    with (root / "spec/box/interface.toml").open("a") as stream:
        stream.write(WATCH.replace("LAMP =", "LIGHT ="))
    rows = {row["id"]: (row["from"], row["to"]) for row in document(root)["signals"]}
    assert rows["LAMP"] == ("box", "") and rows["LIGHT"] == ("", "watch")


def test_hostile_text_of_a_register_is_escaped(tmp_path: Path) -> None:
    root = make_paper(tmp_path)
    change(root / "spec/box/interface.toml", "a box: it shuts", "<script>alert(1)</script>")
    html = make(root).html
    assert "<script>alert(1)" not in html and "&lt;script&gt;alert(1)" in html

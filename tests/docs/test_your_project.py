"""What docs/your-project.md says of the project file is so, and its two commands judge a repository."""

from __future__ import annotations

import gzip
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from modeproof.ground.places import TREE
from modeproof.project.entries import KINDS, Row
from modeproof.project.file import read
from tests.machines.test_small_machine import CLOSED, USE, WIRING, asked

PAGE = (TREE / "docs/your-project.md").read_text("utf-8")


def fenced(language: str) -> list[str]:
    """The blocks of a language."""
    every = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return [inner for of, inner in every if of == language]


def test_the_example_of_the_page_is_a_project_file(tmp_path: Path) -> None:
    (example,) = fenced("toml")
    (tmp_path / "modeproof.toml").write_text(example, "utf-8")
    listed = read(tmp_path / "modeproof.toml", "modeproof.toml").entries
    assert [f"{entry.row.KIND}.{entry.name}" for entry in listed] == [
        *("program.contactors", "program.cell", "machine.press", "log.monday"),
    ]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.KIND)
def test_the_page_names_every_key(kind: type[Row]) -> None:
    row = re.split(r"\n(?:- |\n)", PAGE.partition(f"- **`[{kind.KIND}.NAME]`**\n")[2])[0]
    _, needs, may = re.split(r"  - (?:needs|may have): ", row)
    fields = msgspec.structs.fields(kind)
    assert set(re.findall(r"`([\w-]+)`", needs + may)) == {field.encode_name for field in fields}
    assert {field.encode_name for field in fields if field.required} <= set(re.findall(r"`([\w-]+)`", needs))


def log_of(target: str, scans: int) -> str:
    """The first scans of the longest published case, as a recorder writes them."""
    with gzip.open(TREE / f"vectors/{target}/sequences.jsonl.gz", "rt") as lines:
        _, *cases = map(json.loads, lines)
    case = max(cases, key=lambda case: len(case["scans"]))
    inputs: dict[str, object] = {}
    outputs: dict[str, object] = {}
    rows = [json.dumps({"target": target, "params": case["params"]})]
    for scan in case["scans"][:scans]:
        inputs |= scan["in"]
        outputs |= scan["out"]
        rows.append(json.dumps({"dt_ms": scan["dt_ms"], "in": inputs, "out": outputs}))
    return "\n".join([*rows, ""])


@pytest.mark.deep
def test_a_foreign_repository_is_listed_and_judged_once(tmp_path: Path) -> None:
    for name in ("plc", "logs"):
        (tmp_path / name).mkdir()
    block = (TREE / "examples/st/sf_edm.st").read_text("utf-8").replace("SF_EDM", "Contactors")
    (tmp_path / "plc/contactors.st").write_text(block.replace("S_OutControl", "Demand"), "utf-8")
    cell = (TREE / "examples/st/cell.toml").read_text("utf-8").split("\n[[property]]")
    (tmp_path / "plc/cell.st").write_bytes((TREE / "examples/st/cell.st").read_bytes())
    (tmp_path / "plc/cell.toml").write_text("\n[[property]]".join(cell[:3]), "utf-8")
    for name, text in {"press": WIRING, "press-safety": asked(CLOSED), "press-use": USE}.items():
        (tmp_path / f"{name}.toml").write_text(text, "utf-8")
    (tmp_path / "logs/monday.jsonl").write_text(log_of("sf_edm", 30), "utf-8")

    init, judge = (line.split("#")[0].split()[1:] for line in fenced("sh")[0].splitlines())
    said = run(init, tmp_path)
    assert (
        "is written, with 4 entries" in said
        and "not listed" not in said
        and "Demand is taken for S_OutControl" in said
    )
    first = run(judge, tmp_path)
    assert re.findall(r"^(\w+) +(PROVED|FOLLOWS|CONFORMS) .* judged ", first, re.MULTILINE) == [
        *[("cell", "PROVED"), ("contactors", "FOLLOWS"), ("press", "PROVED"), ("monday", "CONFORMS")],
    ]
    assert first.splitlines()[-1] == "4 entries: 4 as expected; 0 kept"
    assert run(judge, tmp_path).splitlines()[-1] == "4 entries: 4 as expected; 4 kept"
    assert {path.name for path in tmp_path.iterdir()} == {
        *("plc", "logs", "press.toml", "press-safety.toml", "press-use.toml", "modeproof.toml", ".modeproof"),
    }


def run(words: list[str], folder: Path) -> str:
    """What a command prints; it succeeds."""
    env = {**os.environ, "PYTHONPATH": str(TREE)}
    done = subprocess.run(
        [sys.executable, "-m", "modeproof", *words], cwd=folder, env=env, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout

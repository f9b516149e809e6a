"""docs/for-assessors.md: its commands run as they stand there, on a finished build, and say what it says."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.lane.conformance import _over_protocol

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "for-assessors.md").read_text(encoding="utf-8")
FENCED = re.findall(r"^```\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
LINES = [line for block in FENCED for line in block.splitlines()]
MINUTES = re.findall(r"^- \*\*\d+\*\*\n  - part: (.+)$", PAGE, re.MULTILINE)
PARTS = [part.strip() for cell in MINUTES for part in cell.split(",")]
PROPERTY = re.findall(r"\(`(\w+)` of `(\w+)`", PAGE)
RUNS = ("edm/MC_SF_EDM_arbitrary", "edm/NEG_SF_EDM_reset_by_level")
THEOREM = "neither_inhibit_nor_error_goes_without_an_edge"
ADAPTER = shlex.quote(shlex.join([sys.executable, "examples/adapters/refimpl_adapter.py", "sf_edm"]))
FAILS = "# VIOLATED ("
"""So the page marks the command that must end with 1."""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A checkout with one document, what the page's claim rests on, and the report of that."""
    place = tmp_path_factory.mktemp("checkout")
    for room in (
        "spec/edm",
        "spec/common",
        "refimpl",
        "proofs",
        "docs",
        "examples/adapters",
        "vectors/sf_edm",
    ):
        shutil.copytree(ROOT / room, place / room, ignore=shutil.ignore_patterns("__pycache__"))
    (place / "modeproof").symlink_to(ROOT / "modeproof")
    shutil.copyfile(ROOT / "vectors/SHA256SUMS", place / "vectors/SHA256SUMS")
    programs = place / ".venv" / "bin"
    programs.mkdir(parents=True)
    start = f'#!/bin/sh\nexec "{sys.executable}" -m modeproof "$@"\n'
    (programs / "modeproof").write_text(start)
    (programs / "modeproof").chmod(0o755)
    git = "git -c user.name=test -c user.email=test@example.org"
    for command in ("git init -q .", "git add spec", f"{git} commit -qm start"):
        done(place, command)
    done(place, f".venv/bin/modeproof check {' '.join(RUNS)} --quiet")
    done(place, f".venv/bin/modeproof prove --document edm {THEOREM} --quiet")
    assert _over_protocol(place, "edm", "sf_edm", "brief")["verdict"] == "CONFORMS"
    assert run(place, ".venv/bin/modeproof report").returncode == 2, "what the claim does not need is missing"
    return place


def run(place: Path, command: str) -> subprocess.CompletedProcess[str]:
    env = {"PATH": os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1", "HOME": str(place)}
    env["MODEPROOF_ROOT"] = str(place)  # its modeproof is a link to ours
    return subprocess.run(
        ["bash", "-c", command], cwd=place, capture_output=True, text=True, env=env, check=False
    )


def done(place: Path, command: str) -> str:
    """What a command says that must end with 0."""
    ended = run(place, command)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


def wrong(place: Path, lines: list[str]) -> list[str]:
    """What the commands do otherwise than the remarks beside them say."""
    found = []
    for line in lines:
        ended = run(place, line)
        if ended.returncode != (1 if FAILS in line else 0):
            found.append(f"status {ended.returncode}: {line}\n{ended.stdout}\n{ended.stderr}")
        remark = line.partition(" # ")[2]
        words = re.findall(r"HOLDS|PROVED|VIOLATED(?:, as expected)? \(\w+\)|\d+ made again .*", remark)
        found += [f"not said: {word}: {line}\n{ended.stdout}" for word in words if word not in ended.stdout]
    return found


@pytest.mark.deep
def test_every_command_of_the_page_does_what_the_page_says(built: Path) -> None:
    kept = built / "build/evidence/edm/MC_SF_EDM_arbitrary.json"
    shown = hashlib.sha256(kept.read_bytes()).hexdigest()
    assert shown in (built / "build/report/report.html").read_text(encoding="utf-8")
    assert shown in done(built, LINES[0])
    assert wrong(built, LINES) == []
    planted = [f"{LINES[1].partition('#')[0]} # VIOLATED (OutputNeedsAll)", "false # HOLDS"]
    assert [text.partition(":")[0] for text in wrong(built, planted)] == [
        "status 0", "not said", "status 1", "not said"
    ]  # fmt: skip


@pytest.mark.deep
def test_each_run_repeated_as_the_report_says_is_reproduced(built: Path) -> None:
    report = json.loads((built / "build/report/report.json").read_text(encoding="utf-8"))
    rows = [row for of in report["parts"]["reproduce"]["documents"] for row in of["evidence"]]
    assert {row["kind"] for row in rows} == {"tlc", "proof", "conformance"} and len(rows) == 4
    for row in rows:
        done(built, f".venv/bin/{row['command']}")
    said = done(built, ".venv/bin/modeproof report --verify").splitlines()
    assert said[-1].endswith("as it was made; 4 made again since: reproduced, same result")
    done(built, ".venv/bin/modeproof conform sf_edm --suite brief --name mine --adapter " + ADAPTER)
    assert (built / "build/yours/edm/mine_sf_edm_brief.json").is_file()
    assert done(built, ".venv/bin/modeproof report --verify").splitlines() == said


@pytest.mark.deep
def test_the_report_has_every_part_of_the_ten_minutes(built: Path) -> None:
    page = (built / "build/report/report.html").read_text(encoding="utf-8")
    titles = re.findall(r'<h2 id="[\w-]+-title">(?:<a [^>]*>)?([^<]+)', page)
    assert len(PARTS) >= 10 and not [
        part for part in PARTS if not any(title.startswith(part) for title in titles)
    ]


def test_the_commands_of_the_page_judge_its_claim() -> None:
    ((name, document),) = PROPERTY
    from modeproof.registers.load import load_document

    loaded = load_document(ROOT, document)
    (claim,) = [prop for prop in loaded.properties if prop.id == name]
    runs = {run.name: run for run in loaded.runs}
    assert " ".join(claim.sentence.lower().rstrip(".").split()) in " ".join(PAGE.lower().split())
    assert claim.tla in runs[RUNS[0]].properties and runs[RUNS[1]].property == claim.tla
    assert len(LINES) == 9 and all(any(one in line for line in LINES) for one in (*RUNS, THEOREM))
    proofs = "".join(path.read_text() for path in (ROOT / "proofs" / document).glob("*.py"))
    assert re.search(rf'properties=\["{name}"\],\s+slow=True,\n\)\ndef {THEOREM}', proofs)

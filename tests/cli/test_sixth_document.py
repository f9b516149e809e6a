"""A document that the tool has never seen, as files alone: from clauses to verdicts, and to what is wrong.

tests/sixth holds the folders that docs/add-a-document.md lists, for a sluice with a gate and a beacon. They
are put beside the tool in an empty root, where no other document is. Commands run one after another in one
process.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
SIXTH = ROOT / "tests" / "sixth"
DRIVER = """
import contextlib, io, json, sys
from modeproof.cli import main
found = []
for words in json.loads(sys.argv[1]):
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        status = main(words)
    found.append([status, out.getvalue()])
print(json.dumps(found))
"""
Answers = list[tuple[int, str]]


def empty_root(root: Path) -> Path:
    """The tool and what all documents share, without any document."""
    (root / "spec").mkdir(parents=True)
    (root / "examples").mkdir()
    (root / "modeproof").symlink_to(ROOT / "modeproof")
    for shared in ("spec/common", "examples/adapters", "proofs/explorer", "proofs/mutants"):
        shutil.copytree(ROOT / shared, root / shared, ignore=shutil.ignore_patterns("__pycache__"))
    for package in ("proofs", "refimpl"):
        (root / package).mkdir(exist_ok=True)
        for path in (ROOT / package).glob("*.py"):
            shutil.copy(path, root / package)
    return root


def with_the_sixth(root: Path) -> Path:
    """The folders of the new document put in their rooms, and nothing else."""
    shutil.copytree(SIXTH, root, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    return root


def modeproof(root: Path, *commands: str | Sequence[str]) -> Answers:
    """Exit status and output of each command, one after another in one process."""
    words = [one.split() if isinstance(one, str) else list(one) for one in commands]
    env = {**os.environ, "MODEPROOF_ROOT": str(root), "PYTHONPATH": str(root), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", DRIVER, json.dumps(words)], cwd=root, env=env, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return [(int(status), str(text)) for status, text in json.loads(done.stdout.splitlines()[-1])]


def edit(root: Path, name: str, old: str, new: str) -> None:
    text = (root / name).read_text(encoding="utf-8")
    assert text.count(old) == 1, f"{name} has {old!r} {text.count(old)} times"
    (root / name).write_text(text.replace(old, new), encoding="utf-8")


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return with_the_sixth(empty_root(tmp_path_factory.mktemp("sixth") / "root"))


@pytest.fixture(scope="module")
def done(root: Path) -> dict[str, tuple[int, str]]:
    """The whole way, once."""
    adapter = f'"{sys.executable}" examples/adapters/refimpl_adapter.py'
    commands: list[Sequence[str]] = [
        ["verify", "--quiet"],
        ["prove", "--coverage", "--quiet"],
        ["render"],
        ["conform", "gate", "--adapter", f"{adapter} gate", "--suite", "fast", "--quiet"],
        ["conform", "beacon", "--adapter", f"{adapter} beacon", "--suite", "tour", "--quiet"],
        ["conform", "beacon", "--adapter", f"{adapter} beacon", "--suite", "tour", "--codes", "--quiet"],
        ["vectors", "lint"],
        ["vectors", "stats"],
        ["registers"],
    ]
    names = [" ".join(words[:2]) + (" --codes" if "--codes" in words else "") for words in commands]
    return dict(zip(names, modeproof(root, *commands), strict=True))


def test_without_a_document_there_is_nothing_to_verify(tmp_path: Path) -> None:
    ((status, text),) = modeproof(empty_root(tmp_path / "root"), "verify")
    assert status == 2 and "no document" in text


def test_files_alone_take_a_new_document_from_clauses_to_verdicts(done: dict[str, Any]) -> None:
    assert {name: status for name, (status, _) in done.items()} == dict.fromkeys(done, 0), done
    screen = done["verify --quiet"][1]
    for line in (
        "== sluice",
        "negatives    1 of 1 VIOLATED, as expected, by the named property",
        "witnesses    1 of 1 REACHED",
        "graphs       2 of 2 complete",
        "refimpl_OPEN_Gate: EQUAL; 4 states, 32 of 32 transitions, 6 of 6 steps in full",
        "adapter_beacon_brief: CONFORMS; relation exact",
        "proofs       3 of 3 PROVED",
        "registers    1 of 1 consistent",
        "result       as expected",
    ):
        assert line in screen, screen
    assert "OpensOverBeacon HOLDS   honest" in screen and "MotorOnlyOpen   HOLDS   arbitrary" in screen


def test_the_report_shows_the_new_document_without_changing_the_status(
    done: dict[str, Any], root: Path
) -> None:
    status, screen = done["verify --quiet"]
    assert status == 0 and "report       build/report/report.html: not there: " in screen, screen
    content = json.loads((root / "build/report/report.json").read_text(encoding="utf-8"))
    (document,) = content["parts"]["verdict"]["documents"]
    cells = {row["id"]: [cell and cell["verdict"] for cell in row["cells"]] for row in document["rows"]}
    assert cells["OpensOverBeacon"] == ["HOLDS", None] or cells["OpensOverBeacon"] == [None, "HOLDS"]
    assert [one["what"] for one in content["troubles"] if one["status"] == 1] == []
    holes = {one["part"] for one in content["troubles"] if one["status"] == 2}
    assert {"limits", "glossary"} <= holes and "verdict" not in holes  # their pages were not put there


def test_its_verdicts_name_what_the_document_does_not_give(done: dict[str, Any]) -> None:
    assert "\nCONFORMS(exact, tour; not compared: LAMP_CODE)\n" in done["conform beacon"][1]
    assert "\nCONFORMS(exact, tour)\n" in done["conform beacon --codes"][1]
    assert "\nCONFORMS(exact, brief refusals sic times sequences parameters)\n" in done["conform gate"][1]


def test_its_page_is_rendered_and_told_of(done: dict[str, Any], root: Path) -> None:
    page = (root / "docs/sluice.md").read_text(encoding="utf-8")
    findings = " ".join((root / "docs/sluice-findings.md").read_text(encoding="utf-8").split())
    assert "`OpensOverBeacon` fails after 2 steps" in findings
    assert "theorems about our program for all words and times, by two solvers | 3 |" in page
    assert "| 2 | `OpenGate` |" in page, page
    assert "in scan 2 the gate reads the same, and it executes `AwaitBeacon`, not `OpenGate`" in page
    (root / "README.md").write_text("<!-- begin documents -->\n<!-- end documents -->\n", encoding="utf-8")
    ((status, _),) = modeproof(root, "render")
    text = (root / "README.md").read_text(encoding="utf-8")
    assert status == 0 and "(docs/sluice.md)" in text and "`gate`, `beacon`" in text


FAULTS = (
    # what is planted, where, old, new, the command that finds it, what it says
    (
        "a function of the code that cites no clause",
        "refimpl/sluice/gate.py",
        "The gate waits for the beacon. SL-1-3, SLF-01",
        "The gate waits for the beacon.",
        "registers",
        "_calling",
    ),
    (
        "an action of the specification that cites no clause",
        "spec/sluice/Beacon.tla",
        "\\* SL-1-2\nLightUp",
        "LightUp",
        "registers",
        "LightUp",
    ),
    (
        "a clause that nothing carries out",
        "spec/sluice/clauses.toml",
        '[clause.SL-2-3]\ntitle = "colour"\ntext = "The beacon is amber."\nkind = "not modelled"\n'
        'device = []\nbecause = "no colour decides anything"',
        '[clause.SL-2-3]\ntitle = "colour"\ntext = "The beacon is amber."\nkind = "behaviour"\n'
        'device = ["beacon"]',
        "registers",
        "SL-2-3",
    ),
    (
        "a transition of the code that is one scan late",
        "refimpl/sluice/gate.py",
        "if elapsed >= s.params.T_OPEN_ms:",
        "if elapsed > s.params.T_OPEN_ms:",
        "conform gate --builtin refimpl --quiet",
        "DIFFERS",
    ),
    (
        "the same, seen through the adapter",
        "refimpl/sluice/gate.py",
        "if elapsed >= s.params.T_OPEN_ms:",
        "if elapsed > s.params.T_OPEN_ms:",
        "conform gate --suite brief --quiet --adapter",
        "step:    ShutGate (clauses: SL-1-4)",
    ),
    (
        "code that opens over a dark beacon",
        "refimpl/sluice/gate.py",
        "if i.BeaconLit:",
        "if i.OpenRequest:",
        "prove the_gate_opens_only_over_a_lit_beacon --quiet",
        "NOT: the_gate_opens_only_over_a_lit_beacon",
    ),
    (
        "a specification that opens over a dark beacon",
        "spec/sluice/Gate.tla",
        "Ready(i) == i.BeaconLit\n",
        "Ready(i) == i.OpenRequest\n",
        "check MC_Sluice --quiet",
        "VIOLATED (OpensOverBeacon)",
    ),
)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("fault", FAULTS, ids=[fault[0].replace(" ", "_") for fault in FAULTS])
def test_what_is_wrong_in_a_new_document_is_found(
    fault: tuple[str, ...], root: Path, done: dict[str, Any]
) -> None:
    _, name, old, new, command, says = fault
    kept = (root / name).read_bytes()
    words = command.split()
    if words[-1] == "--adapter":
        words.append(f'"{sys.executable}" examples/adapters/refimpl_adapter.py gate')
    try:
        edit(root, name, old, new)
        ((status, text),) = modeproof(root, words)
    finally:
        (root / name).write_bytes(kept)
    assert status == 1 and says in text, text

"""TLC's distributed mode gives the verdict and the counts of a local run, or says that it cannot.

Every fault is planted for real: workers and servers are killed, a port is taken, nobody comes.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from msgspec.structs import replace as with_values

from modeproof.cli import main
from modeproof.ground.progress import Progress
from modeproof.tlc import children, distributed
from modeproof.tlc.check import Checked, check_one, select
from modeproof.tlc.distributed import WORKER, Where
from modeproof.tlc.messages import SUCCESS, WORKER_REGISTERED
from modeproof.tlc.toolchain import find_toolchain
from tests.any_machine import PATIENCE_S, until
from tests.toy_tree import sha256

GRID = r"""
------------------------------- MODULE Grid -------------------------------
EXTENDS Naturals, Lines
CONSTANTS N, SLOW
VARIABLES a, b, step
vars == <<a, b, step>>
View == <<a, b>>

ASSUME N < 1000

Init == a = 0 /\ b = 0 /\ step = ""
Right == a < N /\ a' = a + 1 /\ b' = b /\ step' = "Right"
Up == b < N /\ b' = b + 1 /\ a' = a /\ step' = "Up"
Back == a = N /\ b = N /\ a' = 0 /\ b' = 0 /\ step' = "Back"
Next == Right \/ Up \/ Back
Spec == Init /\ [][Next]_vars

TypeOK == a \in 0..N /\ b \in 0..N /\ (SLOW => \A n \in 1..3000 : n > 0)
Forward == [][\/ a' >= a
              \/ step' = "Back"]_View
Abstract == INSTANCE Sum WITH total <- a + b
Refines == Abstract!Spec
\* breaks on a transition to the first state alone, which is not new
NeverBack == [][a' >= a]_View
NoFarCorner == a + b < N + 2
Always == []<>(a = 0)
Half == a <= b
Narrow == a' <= b' + 2
Whole == ~(a = 3 /\ b = 5)
===========================================================================
"""
SUM = r"""
-------------------------------- MODULE Sum --------------------------------
EXTENDS Naturals
VARIABLE total
vars == <<total>>
Init == total = 0
Next == total' \in {0, total + 1}
Spec == Init /\ [][Next]_vars
============================================================================
"""
HEAD = """CONSTANTS N = {n} SLOW = {slow}
SPECIFICATION Spec VIEW View ACTION_CONSTRAINT Narrow CONSTRAINT Whole
INVARIANT TypeOK
"""
SLOW_DISTINCT = 61 * 61 - 58 * 59 // 2 - 1
"""Of MC_slow: the pairs with a <= b + 2, but for one."""
RUNS = {
    "MC_grid": (12, "FALSE", "PROPERTIES Forward Refines\n"),
    "MC_slow": (60, "TRUE", "PROPERTY Forward\n"),
    "MC_back": (12, "FALSE", "PROPERTIES Forward NeverBack\n"),
    "MC_corner": (12, "FALSE", "INVARIANT NoFarCorner\n"),
    "MC_assume": (1000, "FALSE", ""),
    "MC_always": (12, "FALSE", "PROPERTY Always\n"),
    "LIVE_always": (12, "FALSE", "PROPERTY Always\n"),
}


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("a grid")
    folder = root / "spec/toy"
    (folder / "models").mkdir(parents=True)
    (folder / "Grid.tla").write_text(GRID)
    (folder / "Sum.tla").write_text(SUM)
    (root / "spec/common").mkdir()
    (root / "spec/common/Lines.tla").write_text("---- MODULE Lines ----\n====\n")
    lines: list[str] = []
    for name, (n, slow, rest) in RUNS.items():
        cfg = HEAD.format(n=n, slow=slow) + rest
        (folder / "models" / f"{name}.cfg").write_text(cfg)
        names = ["TypeOK", *rest.split()[1:]]
        lines += [
            f'[[run]]\nid = "{name}"\nmodule = "Grid"\ncfg = "models/{name}.cfg"',
            'lanes = ["exhaustive"]\nworkers = 1\nheap_mb = 256\ntimeout_s = 600\nenvironment = "honest"',
            f'strength = "a grid"\nproperties = {names!r}\ncfg_sha256 = "{sha256(cfg)}"'.replace("'", '"'),
        ]
        if name == "LIVE_always":
            lines.append('property = "Always"')
    (folder / "runs.toml").write_text("\n".join(lines))
    return root


def spread(
    root: Path, name: str, where: Where, meanwhile: Callable[[], None] | None = None, **pins: int
) -> Checked:
    """Check a run in distributed mode; `meanwhile` runs beside it, from when workers are at work."""
    (run,) = select(root, [name])
    run = with_values(run, **pins)
    thread = threading.Thread(target=meanwhile) if meanwhile is not None else None
    if thread is not None:
        thread.start()
    try:
        return check_one(root, run, find_toolchain(), Progress(quiet=True), where)
    finally:
        if thread is not None:
            thread.join()


def command_of(pid: int) -> str:
    path = Path(f"/proc/{pid}/cmdline")
    return path.read_bytes().replace(b"\0", b" ").decode() if path.exists() else ""


def killed(root: Path, name: str, most: int) -> Checked:
    """A run of which the first processes of this name, up to `most`, are killed while both workers work.

    Where the run was over before they were, nothing was planted, and it is tried again.
    """
    log = root / "build/tlc/toy/MC_slow.log"

    def said(message: int) -> int:
        return log.read_text().count(f"ENDMSG {message} ") if log.is_file() else 0

    for _ in range(20):
        log.unlink(missing_ok=True)
        struck: list[int] = []

        def strike(struck: list[int] = struck) -> None:
            until(lambda: said(WORKER_REGISTERED) == 2 or said(SUCCESS) > 0, "two workers")
            time.sleep(0.3)
            found = [pid for pid in children.running() if name in command_of(pid)][:most]
            for pid in found:
                os.kill(pid, signal.SIGKILL)
            if not said(SUCCESS):
                struck += found

        one = spread(root, "MC_slow", Where(2), strike)
        if struck:
            return one
    raise AssertionError("the run was always over before its processes could be killed")


@pytest.fixture(scope="module")
def local(root: Path) -> Checked:
    (run,) = select(root, ["MC_grid"])
    return check_one(root, run, find_toolchain(), Progress(quiet=True))


def counts_of(checked: Checked) -> dict[str, int]:
    result = checked.record["result"]
    return {"distinct": result["distinct"], "generated": result["generated"]}


def test_workers_from_elsewhere_give_the_local_verdict_and_counts(
    root: Path, local: Checked, tmp_path: Path
) -> None:
    pins = counts_of(local)
    tools = find_toolchain()
    port = distributed._free_port("127.0.0.1")
    other = [str(tools.java), f"-Djava.io.tmpdir={tmp_path}", f"-D{distributed.SERVER}.port={port}"]
    other += ["-Djava.rmi.server.hostname=127.0.0.1", f"-D{WORKER}.threadCount=2", "-XX:TieredStopAtLevel=1"]
    other += ["-cp", str(tools.jar), WORKER, "127.0.0.1"]
    with (tmp_path / "log").open("wb") as log, subprocess.Popen(other, stdout=log, stderr=log) as elsewhere:
        try:
            one = spread(root, "MC_grid", Where(1, port=port, wait_for=2), **pins)
            assert elsewhere.wait(timeout=PATIENCE_S) == 0, "the server sends its workers home"
        finally:
            elsewhere.kill()
    assert (one.judgement.verdict, one.judgement.reason) == ("HOLDS", "")
    assert counts_of(one) == pins
    how = one.record["result"]["how"]
    assert (how["mode"], how["lost"]) == ("distributed", 0)
    assert how["registered"] >= 2, "both threads from elsewhere; the run may be over before ours begins"
    assert {Path(name).name for name in one.record["inputs"]} == {
        *("Grid.tla", "Sum.tla", "Lines.tla", "MC_grid.cfg", "runs.toml")
    }
    assert one.record["command"] == "modeproof check --distributed toy/MC_grid"


@pytest.mark.deep
def test_a_property_broken_on_a_way_back_is_named(root: Path) -> None:
    one = spread(root, "MC_back", Where(1))
    assert (one.judgement.verdict, one.judgement.violated) == ("VIOLATED", "NeverBack")
    assert one.record["result"]["trace"][-1]["action"] == "Back"
    assert one.record["result"]["how"]["confirmed"] is True


@pytest.mark.deep
def test_without_the_assertions_tlc_alone_would_call_it_fine(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = distributed.rewrite

    def silent(*arguments: object) -> object:
        made = whole(*arguments)  # type: ignore[arg-type]
        return replace(made, text=made.text.replace("Assert(", "LET Id(x, y) == TRUE IN Id("))

    monkeypatch.setattr(distributed, "rewrite", silent)
    one = spread(root, "MC_back", Where(1))
    assert one.judgement.verdict == "HOLDS"


def test_an_assumption_that_is_false_is_not_overlooked(root: Path) -> None:
    one = spread(root, "MC_assume", Where(1))
    assert one.judgement.verdict == "UNJUDGED" and "Assumption" in one.judgement.reason


@pytest.mark.deep
def test_a_killed_worker_neither_ends_nor_passes_the_run(root: Path) -> None:
    one = killed(root, WORKER, 1)
    assert one.judgement.verdict == "HOLDS" and one.status == 1
    assert "1 of 2 workers lost on the way" in one.judgement.reason
    assert one.record["result"]["distinct"] == SLOW_DISTINCT


@pytest.mark.deep
def test_without_any_worker_the_run_is_inconclusive(root: Path) -> None:
    one = killed(root, WORKER, 2)
    assert (one.judgement.verdict, one.status) == ("INCONCLUSIVE", 2)
    assert one.judgement.reason == "all workers are gone (2 registered)"
    assert children.running() == ()


@pytest.mark.deep
def test_a_killed_server_is_unjudged_and_takes_its_workers_along(root: Path) -> None:
    one = killed(root, f"{distributed.SERVER} ", 1)
    assert (one.judgement.verdict, one.judgement.reason) == ("UNJUDGED", "TLC was killed by signal 9")
    assert children.running() == ()


@pytest.mark.deep
def test_workers_that_cannot_start_are_inconclusive(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distributed, "WORKER", "tlc2.tool.distributed.OfAnotherJar")
    one = spread(root, "MC_grid", Where(1))
    assert one.judgement.verdict == "INCONCLUSIVE"
    assert "all workers are gone (0 registered): Error: " in one.judgement.reason
    assert "OfAnotherJar" in one.judgement.reason


@pytest.mark.deep
def test_workers_of_other_machines_that_do_not_come_are_inconclusive(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(distributed, "WAIT_S", 0.5)
    one = spread(root, "MC_grid", Where(0, wait_for=1))
    assert one.judgement.verdict == "INCONCLUSIVE"
    assert one.judgement.reason == "0 of 1 workers of other machines registered within 0 s"


def test_a_port_that_is_taken_is_said(root: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        one = spread(root, "MC_grid", Where(1, port=taken.getsockname()[1]))
    assert one.judgement.verdict == "UNJUDGED" and "Port already in use" in one.judgement.reason


@pytest.mark.deep
def test_no_java_is_left_when_modeproof_is_ended(root: Path) -> None:
    command = [sys.executable, "-m", "modeproof", "check", "--distributed", "MC_slow", "--quiet"]
    environment = {**os.environ, "MODEPROOF_ROOT": str(root)}
    running = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)

    def alive() -> list[str]:
        listed = subprocess.run(["ps", "-wweo", "args"], capture_output=True, text=True, check=True).stdout
        return [line for line in listed.splitlines() if str(root) in line and "java" in line]

    until(lambda: any(WORKER in line for line in alive()), "a worker")
    running.terminate()
    _, said = running.communicate(timeout=PATIENCE_S)
    expected = "modeproof: interrupted: no verdict; what was finished before is kept\n"
    assert (running.returncode, said) == (2, expected)
    until(lambda: not alive(), "the end of all")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["LIVE_always", "--distributed"], "does not check liveness"),
        (["MC_grid", "--workers", "2"], "--workers belongs to --distributed"),
        (["MC_grid", "--distributed", "--workers", "0"], "together at least 1"),
        (["MC_grid", "--distributed", "--listen", "127.0.0.1:port"], "--listen takes ADDRESS"),
        (["MC_grid", "--distributed", "--repin"], "pins are taken from local runs"),
    ],
)
def test_what_cannot_be_judged_so_is_refused_before_anything_starts(
    root: Path,
    arguments: list[str],
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("MODEPROOF_ROOT", str(root))
    monkeypatch.delenv("CI", raising=False)
    assert main(["check", *arguments]) == 2
    assert words in capsys.readouterr().err


def test_a_property_of_another_form_is_refused(root: Path) -> None:
    one = spread(root, "MC_always", Where(1))
    assert one.judgement.verdict == "UNJUDGED"
    assert "property Always: `[]<>(a = 0)` cannot be judged in distributed mode" in one.judgement.reason

"""The command line: exit status 0, 1, 2, and one clear line for every expected error."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.cli import COMMANDS, GROUPS, main
from modeproof.ground.evidence import own_tools
from modeproof.ground.lock import only_one
from modeproof.ground.places import TREE
from modeproof.suites import conform_command as command
from tests.any_machine import PATIENCE_S, until
from tests.toy_tree import CFGS, toy_tree

LOGS = TREE / "examples" / "logs"


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    monkeypatch.delenv("CI", raising=False)
    return toy_tree(tmp_path, "MC_toy", "NEG_small", "MC_big")


def only_line(capsys: pytest.CaptureFixture[str]) -> str:
    captured = capsys.readouterr()
    lines = captured.err.splitlines()
    assert len(lines) == 1 and "Traceback" not in captured.err + captured.out
    return lines[0]


def test_an_expected_run_ends_with_0_and_can_be_json(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = toy / "out.json"
    assert main(["check", "MC_toy", "--quiet", "--json", str(target)]) == 0
    assert "ok  toy/MC_toy: HOLDS; 16 distinct, 33 generated" in capsys.readouterr().out
    written = json.loads(target.read_text())
    assert written["status"] == 0 and written["runs"][0]["verdict"] == "HOLDS"


def test_a_different_count_ends_with_1_until_it_is_repinned(
    toy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = toy / "spec/toy/runs.toml"
    path.write_text(path.read_text().replace("distinct = 16", "distinct = 18"))
    assert main(["check", "MC_toy", "--quiet", "--repin", "--reason", "planted"]) == 0
    out = capsys.readouterr().out
    assert "distinct states: 16, pinned 18" in out and "distinct: 18 -> 16" in out
    assert "distinct = 16" in path.read_text() and "planted" in path.read_text()
    monkeypatch.setenv("CI", "1")
    before = path.read_text()
    assert main(["check", "MC_toy", "--repin", "--reason", "planted"]) == 2
    assert "refused in CI" in only_line(capsys) and path.read_text() == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "MC_tyo"], "no run 'MC_tyo'"),
        (["check", "MC_toy", "MC_tyo", "--lane", "smoke"], "no run 'MC_tyo'"),
        (["check", "--document", "none"], "no document 'none'"),
        (["check", "--lane", "exhaustive"], "no run to check in the lane exhaustive"),
        (["check", "--repin"], "--repin needs the runs by name"),
        (["check", "MC_toy", "--reason", "x"], "--reason belongs to --repin"),
        (["prove", "--document", "toy"], "proofs of toy"),
        (["verify", "--document", "none"], "unknown document 'none'"),
        (["verify", "--document", "toy", "--document", "none"], "unknown document 'none'"),
    ],
)
def test_what_cannot_be_judged_is_one_line_and_status_2(
    toy: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(arguments) == 2
    assert words in only_line(capsys)


def test_a_run_outside_the_lane_is_not_dropped(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = toy / "spec/toy/runs.toml"
    head, _, tail = path.read_text().partition('"NEG_small"')
    path.write_text(f'{head}"NEG_small"' + tail.replace('["smoke", "full"]', '["full"]', 1))
    assert main(["check", "MC_toy", "NEG_small", "--lane", "smoke"]) == 2
    assert only_line(capsys).endswith("NEG_small is not in the lane smoke, but in full")


def test_a_misspelt_theorem_is_not_dropped(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "--document", "edm", "no_*", "it_nevr_proved", "--quiet"]) == 2
    assert "no theorem is called 'it_nevr_proved'" in only_line(capsys)


def test_a_root_without_a_specification_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    assert main(["check"]) == 2
    assert "no folder `spec` here" in only_line(capsys)


def test_a_spec_folder_of_somebody_else_means_nothing(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(toy / "spec" / "toy")
    assert main(["check", "MC_toy", "--quiet", "--json", "out.json"]) == 0
    assert capsys.readouterr().out.startswith(f"tree         {toy}\n")
    assert json.loads(Path("out.json").read_text())["tree"] == str(toy)
    monkeypatch.delenv("MODEPROOF_ROOT")
    assert main(["check", "MC_toy", "--quiet"]) == 2
    assert "no run 'MC_toy' in runs.toml of edm" in only_line(capsys)


@pytest.mark.parametrize("named", [True, False])
def test_a_copied_checkout_is_not_judged_by_another_ones_tool(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], named: bool
) -> None:
    shutil.copytree(TREE / "modeproof", toy / "modeproof")
    monkeypatch.chdir(toy)
    if not named:
        monkeypatch.delenv("MODEPROOF_ROOT")
    assert main(["check", "MC_toy", "--quiet"]) == 2
    assert f"{toy} has a modeproof of its own, and this is the one of {TREE}" in only_line(capsys)
    own = [sys.executable, "-m", "modeproof", "check", "--list"]
    done = subprocess.run(own, cwd=toy, capture_output=True, text=True, check=True)
    assert done.stdout.startswith(f"tree         {toy}\n")


def test_a_missing_java_is_one_line(
    toy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MODEPROOF_JAVA", str(toy / "no-java"))
    assert main(["check", "MC_toy"]) == 2
    assert "Java is missing" in only_line(capsys)


def test_a_second_run_at_once_is_one_line(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with only_one(toy):
        assert main(["check", "MC_toy"]) == 2
    assert "another modeproof is running here" in only_line(capsys)


def test_an_unlisted_cfg_spoils_a_lane(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = toy / "spec/toy/runs.toml"
    path.write_text(path.read_text().split('[[run]]\nid = "NEG_small"')[0])
    (toy / "spec/toy/models/MC_big.cfg").unlink()
    assert main(["check", "--lane", "smoke", "--quiet"]) == 1
    assert only_line(capsys) == "modeproof: toy: models/NEG_small.cfg is in no run"


def test_ctrl_c_ends_tlc_too_and_is_one_line(toy: Path) -> None:
    command = [sys.executable, "-m", "modeproof", "check", "MC_big", "--quiet"]
    running = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    log = toy / "build/tlc/toy/MC_big.log"
    until(lambda: log.is_file() and "2185" in log.read_text(), "TLC at work")
    running.terminate()
    _, err = running.communicate(timeout=PATIENCE_S)
    assert running.returncode == 2
    assert err == "modeproof: interrupted: no verdict; what was finished before is kept\n"

    def all_ended() -> bool:
        alive = subprocess.run(["ps", "-wweo", "args"], capture_output=True, text=True, check=True).stdout
        return str(toy) not in alive

    until(all_ended, "the end of TLC")
    assert not (toy / "build/evidence/toy/MC_big.json").exists()


def test_our_own_defect_is_one_line_and_never_a_pass(
    toy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> None:
        raise ZeroDivisionError("planted")

    monkeypatch.setattr("modeproof.cli.root", broken)
    assert main(["check"]) == 2
    assert "internal error: ZeroDivisionError: planted" in only_line(capsys)
    with pytest.raises(ZeroDivisionError):
        main(["--debug", "check"])


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0 and "usage: modeproof" in capsys.readouterr().out


def test_the_runs_can_be_listed(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--list"]) == 0
    assert capsys.readouterr().out.count("toy/") == 3 <= len(CFGS)


def test_a_command_whose_packages_are_missing_says_so(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(COMMANDS, "check", "modeproof.no_such_module")
    assert main(["check", "MC_x"]) == 2
    assert "check cannot be loaded: No module named" in only_line(capsys)


def test_the_help_names_each_command_in_its_group(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    said = capsys.readouterr().out
    groups = said[said.index("\ncommands:") :].split("\n\n")
    assert ended.value.code == 0 and len(GROUPS) == 2
    for (title, names), text in zip(GROUPS.items(), groups, strict=False):
        head, *lines = text.strip().splitlines()
        assert head == f"{title}:"
        assert [line.split()[0] for line in lines if line[:3] == "  " + line[2:3].strip()] == list(names)
    assert {"verify", "conform", "prove-program", "trace", "report", "doctor"} <= set(GROUPS["commands"])


def test_the_help_loads_no_command() -> None:
    loaded = "from modeproof.cli import main; main(['--help'])"
    said = "import atexit, sys; atexit.register(lambda: print('loaded:', *sys.modules)); " + loaded
    done = subprocess.run([sys.executable, "-c", said], cwd=TREE, capture_output=True, text=True, check=True)
    assert all(f"  {name}" in done.stdout for name in COMMANDS)
    modules = set(done.stdout.partition("loaded:")[2].split())
    assert "modeproof.ground.places" in modules and modules.isdisjoint({*COMMANDS.values(), "msgspec", "z3"})


def test_the_version_names_the_tool_as_evidence_does(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    own = own_tools()["modeproof"]
    assert ended.value.code == 0
    assert f"modeproof {own['version']}, sha256 {str(own['sha256'])[:12]}, " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["confrom", "fplc"], "no command 'confrom'; did you mean 'conform'?"),
        (["check", "MC_KeyFlow_smoke"], "no run 'MC_KeyFlow_smoke' in"),
        (["check", "MC_KeyFlow_smoke"], "did you mean 'MC_KeyFlows_smoke'? "),
        (["prove", "every_state_has_it_row"], "did you mean 'every_state_has_its_row'? "),
        (["conform", "F-PLC", "--builtin", "refimpl"], "no target 'F-PLC'; did you mean 'fplc'? "),
        (["trace", "F-PLC", "x.csv"], "no log can be of 'F-PLC'; did you mean 'fplc'? "),
        (["conform", "fplc", "--adapter", "x", "--suite", "breif"], "did you mean 'brief'? "),
        (
            ["trace", "plc", f"{LOGS}/fplc_good.csv"],
            f"those of fplc: modeproof trace fplc {LOGS}/fplc_good.csv",
        ),
        (
            ["trace", "fplc", f"{LOGS}/key_flows_good.jsonl"],
            "its names are those of key_flows: modeproof trace ",
        ),
        (
            ["trace", "fplc", f"{LOGS}/fplc_good.csv", "--param", "T_ms=1"],
            "no parameter 'T_ms'; did you mean",
        ),
        (["trace", "hmi", f"{LOGS}/none.csv"], "none.csv: No such file or directory"),
        (["vectors", "build", "F_PLC"], "no target 'F_PLC'; did you mean 'fplc'? "),
        ([], "the following arguments are required: COMMAND"),
        (["conform", "fplc"], "--help` says what is allowed"),
        (["machine", "--bad"], "no option --bad (`modeproof machine --help` says what is allowed)"),
        (["machine", "x.toml", "--propertis", "y"], "no option --propertis; did you mean --properties? (`mo"),
        (["conform", "fplc", "--adapt=x"], "no option --adapt; did you mean --adapter? (`modeproof conform"),
        (["prove", "--cov"], "no option --cov; did you mean --coverage? (`modeproof prove --help`"),
        (["vectors", "build", "--ane"], "did you mean --anew? (`modeproof vectors build --help`"),
        (["--vers"], "no option --vers; did you mean --version? (`modeproof --help`"),
        (["check", "MC_x", "--debug"], "no option --debug (`modeproof check --help`"),
        (["doctor", "now"], "too much: now (`modeproof doctor --help`"),
    ],
)
def test_a_slip_is_one_line_with_what_was_meant(
    capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(arguments) == 2
    assert words in only_line(capsys)


@pytest.mark.parametrize("adapter", ["false", f"{sys.executable} -c print('hi')", "no-such-program"])
def test_an_adapter_is_greeted_before_a_suite_is_made(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, adapter: str
) -> None:
    def slow(*given: object) -> None:
        raise AssertionError("TLC was asked for a graph")

    monkeypatch.setattr(command, "make_graphs", slow)
    assert main(["conform", "fplc", "--adapter", adapter, "--suite", "tour"]) == 2
    assert "modeproof: hello: " in (line := only_line(capsys)) or "the adapter cannot be started" in line

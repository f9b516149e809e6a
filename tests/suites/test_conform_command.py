"""`conform` from the registers to the verdict, on a document that modeproof has never heard of."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.graph.device import load_device_graph, open_runs
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.kit.__main__ import main as kit_main
from modeproof.suites.build import ready_suite
from tests.graph.printed import SEQUENCES, WORDS, lines, vouch, write
from tests.kit.programs import program

INTERFACE = """
document = "toy"
[devices.lamp]
title = "a lamp"
module = "Lamp"
published = true
states = ["Off", "On"]
steps = ["StayOff", "SwitchOn", "StayOn", "Expire"]
[devices.lamp.memory]
[devices.lamp.inputs]
press = { type = "bool", clauses = ["TOY-1"], why = "the button" }
word = { type = "word", clauses = ["TOY-1"], why = "the code" }
[devices.lamp.outputs]
LAMP = { type = "bool", clauses = ["TOY-1"], why = "the light" }
MW = { type = "word", clauses = ["TOY-1"], why = "the echo" }
[devices.lamp.parameters]
T_ms = { type = "ms", min = 1, max = 60000, default = 500, clauses = ["TOY-1"], why = "how long it shines" }
"""

RUNS = """
[[run]]
id = "OPEN_Lamp"
module = "Lamp"
cfg = "models/OPEN_Lamp.cfg"
lanes = ["full"]
environment = "arbitrary"
strength = "all of it"
workers = 1
properties = ["PrintState"]
[run.graph]
device = "lamp"
tick_ms = 250
params = { T_ms = 500 }
states = 3
edges = 54
"""


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    room = tmp_path / "spec" / "toy"
    room.mkdir(parents=True)
    (room / "interface.toml").write_text(INTERFACE + WORDS)
    (room / "runs.toml").write_text(RUNS)
    (room / "models").mkdir()
    (room / "models/OPEN_Lamp.cfg").write_text("SPECIFICATION Spec\nINVARIANT PrintState\n")
    (room / "sequences.toml").write_text(SEQUENCES)
    graphs = tmp_path / "build" / "graphs" / "toy"
    graphs.mkdir(parents=True)
    write(graphs / "OPEN_Lamp.txt", lines())
    (room / "Lamp.tla").write_text("---- MODULE Lamp ----\n====\n")
    vouch(tmp_path, "toy")
    for package, limit in (("toyimpl", "params.T_ms"), ("brokenimpl", "params.T_ms + 1")):
        code = tmp_path / package / "toy"
        code.mkdir(parents=True)
        source = Path(__file__).parents[1].joinpath("graph", "printed.py").read_text(encoding="utf-8")
        source = source.replace("elapsed < state.params.T_ms", f"elapsed < state.{limit}")
        (code / "lamp.py").write_text(source, encoding="utf-8")
        monkeypatch.delitem(sys.modules, package, raising=False)
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    for name in [name for name in sys.modules if name.startswith(("toyimpl", "brokenimpl"))]:
        monkeypatch.delitem(sys.modules, name)
    return tmp_path


def yours(toy: Path, id: str) -> Path:
    """Where what a user found out is kept."""
    return evidence.evidence_path(toy, "toy", id, evidence.YOURS)


def test_a_builtin_is_compared_both_ways(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["conform", "lamp", "--builtin", "toyimpl", "--quiet", "--json", str(toy / "v.json")]) == 0
    said = capsys.readouterr().out
    assert "3 states, 54 transitions, EQUAL" in said and "SwitchOn          3 / 3" in said
    assert json.loads((toy / "v.json").read_text())["runs"][0]["verdict"] == "EQUAL"
    record = evidence.read(yours(toy, "toyimpl_OPEN_Lamp"))
    assert record["kind"] == "conformance" and record["as_expected"] is True


@pytest.mark.parametrize(
    "command",
    [
        "conform lamp --builtin toyimpl",
        "conform lamp --builtin toyimpl --suite tour",
        "vectors build lamp --suite tour",
    ],
)
@pytest.mark.parametrize(
    "edit", ["spec/toy/Lamp.tla", "spec/toy/runs.toml", "build/graphs/toy/OPEN_Lamp.txt"]
)
def test_a_graph_of_another_text_is_never_read(
    toy: Path, command: str, edit: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (toy / edit).read_text()
    changed = text.replace("tick_ms = 250", "tick_ms = 200").replace("----\n====", "----\nA == 1\n====")
    changed += "\n" if edit.endswith(".txt") else ""
    assert text != changed
    (toy / edit).write_text(changed)
    assert main(command.split()) == 2
    said = capsys.readouterr()
    assert "TLC makes OPEN_Lamp first" in said.err and "its graph cannot be used" in said.err
    assert "EQUAL" not in said.out and "CONFORMS" not in said.out
    assert not list(toy.glob("build/vectors/**/*.gz")) and not (toy / "vectors").exists()


def test_no_name_of_a_suite_or_target_is_dropped(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["vectors", "build", "lamp", "--suite", "tour"]) == 0
    vectors = "build/vectors/toy/lamp/tour.jsonl.gz"
    for command, words in (
        ("vectors lint lamp lmap", "no vector file of lmap"),
        ("vectors stats lamp --suite tour --suite sic", "no vector file of sic.jsonl.gz"),
        (f"conform lamp --builtin toyimpl --suite tour --vectors {toy / vectors}", "give one of them"),
        ("conform lamp --builtin toyimpl --relation settled", "--builtin alone is exact"),
    ):
        assert main(command.split()) == 2
        assert words in capsys.readouterr().err


def test_a_reader_of_graphs_names_what_has_changed(toy: Path) -> None:
    (run,) = open_runs(toy, "toy")
    assert load_device_graph(toy, run).graph.views
    (toy / "spec/toy/Lamp.tla").write_text("---- MODULE Lamp ----\nA == 1\n====\n")
    for read in (load_device_graph, lambda place, run: ready_suite(place, "toy", "lamp", "tour")):
        with pytest.raises(Unjudged, match=r"no graph of the present text: spec/toy/Lamp.tla has changed"):
            read(toy, run)


def test_a_wrong_builtin_differs(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["conform", "lamp", "--builtin", "brokenimpl", "--quiet"]) == 1
    said = capsys.readouterr().out
    assert "DIFFERS" in said and "first difference: outputs in Expire after 2 scans" in said
    assert evidence.read(yours(toy, "brokenimpl_OPEN_Lamp"))["verdict"] == "DIFFERS"


def test_a_suite_built_once_judges_an_adapter(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = " ".join(f'"{word}"' for word in program(toy))
    assert main(["conform", "lamp", "--adapter", command, "--quiet"]) == 0
    first = capsys.readouterr()
    assert "CONFORMS(exact, tour)" in first.out and "cases," in first.err
    vectors = toy / "build" / "vectors" / "toy" / "lamp" / "tour.jsonl.gz"
    stamp = vectors.stat().st_mtime_ns
    assert main(["conform", "lamp", "--adapter", command, "--quiet"]) == 0
    assert vectors.stat().st_mtime_ns == stamp
    found = evidence.read(yours(toy, "lamp-1_lamp_tour"))
    assert found["verdict"] == "CONFORMS"
    assert "every transition" in found["result"]["says"]["guarantees"]

    (toy / "spec" / "toy" / "interface.toml").write_text(INTERFACE)
    assert main(["conform", "lamp", "--adapter", command, "--quiet"]) == 0
    assert vectors.stat().st_mtime_ns != stamp, "a suite older than its sources is built anew"
    assert kit_main(["conform", "lamp", "--adapter", command, "--vectors", str(vectors), "--quiet"]) == 0


def test_a_wrong_adapter_differs_and_the_command_given_repeats_it(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = " ".join(f'"{word}"' for word in program(toy, "LIMIT = 501"))
    assert main(["conform", "lamp", "--adapter", command, "--quiet", "--json", str(toy / "v.json")]) == 1
    assert "again:   modeproof conform lamp --adapter" in capsys.readouterr().out
    case = json.loads((toy / "v.json").read_text())["difference"]["case"]
    assert main(["conform", "lamp", "--adapter", command, "--quiet", "--case", case]) == 1


def test_own_parameters_need_a_suite_to_be_put_in(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["conform", "lamp", "--builtin", "toyimpl", "--quiet", "--param", "T_ms=1"]) == 2
    assert "--param and --relation need --suite or --vectors" in capsys.readouterr().err


def test_a_broken_adapter_is_unjudged(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = " ".join(f'"{word}"' for word in program(toy, "sys.exit('no licence')"))
    assert main(["conform", "lamp", "--adapter", command, "--quiet"]) == 2
    assert "hello: the adapter ended with status 1; it said: no licence" in capsys.readouterr().err
    assert not list(toy.glob("build/vectors/**/*.gz")), "it was greeted before the suite was made"
    assert (
        not (toy / "build/yours").exists()
        and not (toy / "build/evidence/toy/adapter_lamp_tour.json").exists()
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["lmap", "--builtin", "toyimpl"], "no target 'lmap'; did you mean 'lamp'?"),
        (["/etc/passwd", "--adapter", "x"], "no target '/etc/passwd'; allowed: lamp"),
        (["", "--adapter", "x"], "no target ''; allowed: lamp"),
        (["lamp", "--builtin", "noimpl"], "noimpl.toy.lamp cannot be imported"),
        (["lamp", "--builtin", "toyimpl", "--document", "other"], "no target 'lamp' in other"),
        (
            ["lamp", "--adapter", "x", "--suite", "toru"],
            "no suite 'toru'; did you mean 'tour'? allowed: fast, tour, brief, wp, words, refusals",
        ),
        (["lamp", "--adapter", "x", "--vectors", "none.jsonl"], "No such file"),
    ],
)
def test_what_cannot_be_judged_is_one_line(
    toy: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    assert main(["conform", *arguments, "--quiet"]) == 2
    assert said in capsys.readouterr().err


def test_a_graph_that_lost_an_edge_is_no_basis(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(toy / "build" / "graphs" / "toy" / "OPEN_Lamp.txt", lines()[:-1])
    vouch(toy, "toy")
    assert main(["conform", "lamp", "--builtin", "toyimpl", "--quiet"]) == 2
    assert "OPEN_Lamp.txt: 1 edges are missing" in capsys.readouterr().err
    assert not yours(toy, "toyimpl_OPEN_Lamp").exists()


def test_without_tlc_published_suites_still_judge(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MODEPROOF_JAVA", str(tmp_path / "no-java"))
    given = ["conform", "sf_edm", "--builtin", "refimpl"]
    assert main([*given, "--suite", "brief"]) == 0
    assert "CONFORMS(exact, brief" in capsys.readouterr().out
    for suite in (["--suite", "tour"], ["--suite", "brief", "--suite", "words"]):
        assert main([*given, *suite]) == 2
        said = capsys.readouterr().err
        assert (
            f"the suite {suite[-1]} has to be made, and " in said
            and "--suite NAME of brief, refusals, sic" in said
        )
